/// Queries of pairs: what of two scenes meets, and how far apart they are.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include <hedgerow/base/error.h>
#include <hedgerow/hedgerow.h>

#include "query.h"

namespace hedgerow::cli {

namespace {

constexpr PairKind all_pair_kinds[] = {
    {"crossings", "of two meshes (--with): the pairs of triangles that share a point -> a b", true},
    {"self-intersections", "of a mesh: the pairs of triangles that meet beyond their common corners -> a b",
     false},
    {"minimum-distance",
     "of two scenes (--with): the closest two primitives -> a b distance ax ay az bx by bz", true},
};

template <class P>
auto build_pair_index(const QueryArguments& a, const std::string& scene, const P& primitives) {
    ProgressLine line("building the index of " + scene, a.quiet);
    WatchedExecutor watched(default_executor(), line.progress());
    return build<WideBvh>(primitives, {}, watched);
}

std::uint32_t id_of(const auto& index, PrimitiveId element) {
    return element == no_primitive ? no_primitive : reported_id(index.primitives(), element, 0);
}

/// Writes rows that `list(f, i)` describes: a file of `count` rows.
template <class List>
void write_all(const QueryArguments& a, std::uint64_t count, QueryReport& report, List list) {
    ColumnList columns;
    list(columns, std::nullopt);
    RowWriter out(a.output, row_format(a.output, a.output_format), columns.all, count);
    ProgressLine line("writing " + a.output, a.quiet, "rows");
    const Progress progress = line.progress();
    constexpr std::uint64_t some = 1 << 16;
    for (std::uint64_t first = 0; first < count; first += some) {
        progress.look();
        std::string records;
        const std::uint64_t end = std::min(count, first + some);
        for (std::uint64_t i = first; i < end; ++i)
            append_record(records, [&](Record& record) { list(record, i); });
        out.write(out.encode(std::move(records)), end - first);
        progress(end, count);
    }
    out.finish();
    report.output = a.output, report.answered = count;
}

/// Writes the pairs by the ids of their primitives.
template <class A, class B>
void write_pairs(const QueryArguments& a, const A& one, const B& other, const std::vector<ElementPair>& pairs,
                 QueryReport& report) {
    write_all(a, pairs.size(), report, [&](auto& f, std::optional<std::uint64_t> i) {
        const ElementPair pair = i ? pairs[*i] : ElementPair{no_primitive, no_primitive};
        f("a", id_of(one, pair.a)), f("b", id_of(other, pair.b));
    });
}
template <class T, int D>
void list_apart(auto& f, const Apart<T, D>& apart, std::uint32_t a, std::uint32_t b) {
    constexpr std::string_view of_a[] = {"ax", "ay", "az"}, of_b[] = {"bx", "by", "bz"};
    f("a", a), f("b", b);
    f("distance", rounded_to<T>(std::sqrt(static_cast<double>(apart.distance2))));
    for (int k = 0; k < D; ++k) f(of_a[k], apart.point_a[k]);
    for (int k = 0; k < D; ++k) f(of_b[k], apart.point_b[k]);
}

/// Runs `ask` between the times that the report says.
template <class F>
void timed(const QueryArguments& a, QueryReport& report, F ask) {
    ProgressLine line("looking for " + a.kind, a.quiet);
    WatchedExecutor watched(default_executor(), line.progress());
    const double start = now();
    ask(watched);
    report.seconds = now() - start;
}

[[noreturn]] void refuse(const QueryArguments& a, const std::string& scenes, const char* wanted) {
    throw InputError(fmt::format("{}: {} is asked of {}. Name such scenes", scenes, a.kind, wanted));
}

template <class A>
int query_self(const QueryArguments& a, const A& set) {
    if constexpr (TriangleSet<ViewOf<A>>) {
        QueryReport report;
        const double start = now();
        const auto index = build_pair_index(a, a.scene, set);
        report.build_seconds = now() - start, report.primitives = set.size();
        std::vector<ElementPair> pairs;
        timed(a, report, [&](Executor& executor) { self_intersections(index, pairs, executor); });
        write_pairs(a, index, index, pairs, report);
        return print_report(a, report);
    } else {
        refuse(a, a.scene, "triangles");
    }
}

template <class A, class B>
int query_two(const QueryArguments& a, const A& set, const B& with) {
    const std::string scenes = a.scene + " and " + a.with;
    constexpr bool triangles = TriangleSet<ViewOf<A>> && TriangleSet<ViewOf<B>>;
    constexpr bool same_space = A::dimension == B::dimension;
    constexpr bool points = same_space && (PointSet<ViewOf<A>> || PointSet<ViewOf<B>>);
    if constexpr (triangles || points) {
        QueryReport report;
        const double start = now();
        const auto one = build_pair_index(a, a.scene, set);
        const auto other = build_pair_index(a, a.with, with);
        report.build_seconds = now() - start, report.primitives = set.size() + with.size();
        if (a.kind == "minimum-distance") {
            Apart<typename A::Scalar, A::dimension> apart;
            timed(a, report, [&](Executor&) { apart = minimum_distance(one, other); });
            write_all(a, 1, report, [&](auto& f, std::optional<std::uint64_t>) {
                list_apart(f, apart, id_of(one, apart.element_a), id_of(other, apart.element_b));
            });
            return print_report(a, report);
        } else if constexpr (triangles) {
            std::vector<ElementPair> pairs;
            timed(a, report, [&](Executor& executor) { crossing_pairs(one, other, pairs, executor); });
            write_pairs(a, one, other, pairs, report);
            return print_report(a, report);
        }
    }
    refuse(a, scenes,
           a.kind == "crossings" ? "triangles" : "triangles, or of points and any others, in one space");
}

}  // namespace

std::span<const PairKind> pair_kinds() {
    return all_pair_kinds;
}

int query_pairs(const QueryArguments& a) {
    const bool two = std::find_if(std::begin(all_pair_kinds), std::end(all_pair_kinds), [&](const auto& k) {
                         return k.name == a.kind;
                     })->between_two;
    if (two && a.with.empty()) throw UsageError(a.kind + " needs --with: the other scene");
    if (!two && !a.with.empty()) throw UsageError(a.kind + " is asked of one scene: leave out --with");
    if (!a.from.empty()) throw UsageError(a.kind + " reads no rows: leave out --from");
    if (a.structure != "wide") throw UsageError(a.kind + " is answered by the engine: leave out --structure");
    if (a.count != 0 || a.radius >= 0) throw UsageError(a.kind + " takes neither --count nor --radius");
    return in_precision(a, [&]<class T>(T) {
        const Scene<T> scene = load<T>(a);
        if (!two) return std::visit([&](const auto& set) { return query_self(a, set); }, scene);
        Common of_other = a;
        of_other.scene = a.with;
        const Scene<T> other = load<T>(of_other);
        return std::visit([&](const auto& set, const auto& with) { return query_two(a, set, with); }, scene,
                          other);
    });
}

}  // namespace hedgerow::cli
