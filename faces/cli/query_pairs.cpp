/// Queries of pairs: what of two scenes meets, and how far apart they are.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include <hedgerow/ask/hausdorff.h>
#include <hedgerow/ask/neighbours.h>
#include <hedgerow/ask/pairs.h>
#include <hedgerow/base/error.h>

#include "query.h"

namespace hedgerow::cli {

namespace {

using Scenes = PairKind::Scenes;
constexpr PairKind all_pair_kinds[] = {
    {"crossings", "of two meshes (--with): the pairs of triangles that share a point -> a b", Scenes::two},
    {"self-intersections", "of a mesh: the pairs of triangles that meet beyond their common corners -> a b",
     Scenes::one},
    {"minimum-distance",
     "of two scenes (--with): the closest two primitives -> a b distance ax ay az bx by bz", Scenes::two},
    {"hausdorff",
     "of two meshes or clouds (--with): an interval around how far one is from the other at most "
     "(--tolerance)"
     " -> a b lower upper ax ay az bx by bz from_b",
     Scenes::two},
    {"pairs-within",
     "of points, or of two sets of points (--with): the pairs at most --radius apart, where space may repeat "
     "(--period) -> a b distance",
     Scenes::either, true},
    {"neighbours-within",
     "of points: the others within --radius of each, where space may repeat (--period) -> a b distance",
     Scenes::one, true},
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
        f("a", a.numbers(id_of(one, pair.a))), f("b", a.numbers_with(id_of(other, pair.b)));
    });
}
template <class T, class A, class B>
void write_pairs(const QueryArguments& a, const A& one, const B& other,
                 const std::vector<PairWithin<T>>& pairs, QueryReport& report) {
    write_all(a, pairs.size(), report, [&](auto& f, std::optional<std::uint64_t> i) {
        const PairWithin<T> pair = i ? pairs[*i] : PairWithin<T>{no_primitive, no_primitive, 0};
        f("a", a.numbers(id_of(one, pair.a))), f("b", a.numbers_with(id_of(other, pair.b)));
        f("distance", rounded_to<T>(std::sqrt(static_cast<double>(pair.distance2))));
    });
}
/// The columns of two points that a distance is between.
template <class T, int D>
void list_points(auto& f, const Vec<T, D>& of_a, const Vec<T, D>& of_b) {
    constexpr std::string_view names_a[] = {"ax", "ay", "az"}, names_b[] = {"bx", "by", "bz"};
    for (int k = 0; k < D; ++k) f(names_a[k], of_a[k]);
    for (int k = 0; k < D; ++k) f(names_b[k], of_b[k]);
}
template <class T, int D>
void list_apart(auto& f, const Apart<T, D>& apart, std::uint32_t a, std::uint32_t b) {
    f("a", a), f("b", b);
    f("distance", rounded_to<T>(std::sqrt(static_cast<double>(apart.distance2))));
    list_points(f, apart.point_a, apart.point_b);
}
template <class T, int D>
void list_hausdorff(auto& f, const Hausdorff<T, D>& far, std::uint32_t a, std::uint32_t b) {
    f("a", a), f("b", b), f("lower", far.lower), f("upper", far.upper);
    list_points(f, far.point_a, far.point_b);
    f("from_b", far.from_b);
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

/// The periods of --period: one for all axes, or one for each.
template <int D>
Periods<3> periods_of(const QueryArguments& a) {
    if (a.periods.empty()) return {};
    if (a.periods.size() != 1 && a.periods.size() != D)
        throw UsageError(
            fmt::format("--period: give one length, or {}: one for each axis, 0 where space does not "
                        "repeat",
                        D));
    Periods<3> periods;
    for (std::size_t k = 0; k < D; ++k)
        periods[static_cast<int>(k)] = a.periods[a.periods.size() == 1 ? 0 : k];
    return periods;
}
/// The pairs of points, each once, or the neighbours of each.
template <class T, int D>
int query_neighbours(const QueryArguments& a, const std::vector<Vec<T, D>>& points) {
    QueryReport report;
    report.primitives = points.size();
    NearLists<T> lists;
    NeighbourOptions options{
        .periods = periods_of<D>(a), .once = a.kind == "pairs-within", .distances = true};
    timed(a, report, [&](Executor& executor) {
        options.threads = executor;
        neighbours_within(points, static_cast<double>(rounded_to<T>(a.radius)), lists, options);
    });
    write_all(a, lists.ids.size(), report,
              [&, point = std::size_t(0)](auto& f, std::optional<std::uint64_t> i) mutable {
                  while (i && lists.offsets[point + 1] <= *i) ++point;
                  f("a", a.numbers(static_cast<std::uint32_t>(point)));
                  f("b", a.numbers(i ? lists.ids[*i] : no_primitive));
                  f("distance", i ? std::sqrt(lists.distances2[*i]) : T(0));
              });
    return print_report(a, report);
}

template <class A>
int query_self(const QueryArguments& a, const A& set) {
    const bool of_triangles = a.kind == "self-intersections";
    if constexpr (TriangleSet<ViewOf<A>>)
        if (of_triangles) {
            QueryReport report;
            const double start = now();
            const auto index = build_pair_index(a, a.scene, set);
            report.build_seconds = now() - start, report.primitives = set.size();
            std::vector<ElementPair> pairs;
            timed(a, report,
                  [&](Executor& executor) { self_intersections(index, pairs, {.threads = executor}); });
            write_pairs(a, index, index, pairs, report);
            return print_report(a, report);
        }
    if constexpr (PointSet<ViewOf<A>>)
        if (!of_triangles) return query_neighbours(a, set.points);
    refuse(a, a.scene, of_triangles ? "triangles" : "points");
}

template <class A, class B>
int query_two(const QueryArguments& a, const A& set, const B& with) {
    using T = typename A::Scalar;
    const std::string scenes = a.scene + " and " + a.with;
    constexpr bool same_space = A::dimension == B::dimension;
    constexpr bool triangles = TriangleSet<ViewOf<A>> && TriangleSet<ViewOf<B>>;
    constexpr bool point_and_any = same_space && (PointSet<ViewOf<A>> || PointSet<ViewOf<B>>);
    constexpr bool points = same_space && PointSet<ViewOf<A>> && PointSet<ViewOf<B>>;
    if constexpr (triangles || point_and_any) {
        QueryReport report;
        // Builds both indexes, asks for the answer, writes it and reports.
        const auto answer = [&](auto ask, auto write) {
            const double start = now();
            const auto one = build_pair_index(a, a.scene, set);
            const auto other = build_pair_index(a, a.with, with);
            report.build_seconds = now() - start, report.primitives = set.size() + with.size();
            decltype(ask(one, other, serial_executor())) found;
            timed(a, report, [&](Executor& executor) { found = ask(one, other, executor); });
            write(one, other, found);
            return print_report(a, report);
        };
        const auto one_row = [&](auto list) {
            return [&, list](const auto& one, const auto& other, const auto& found) {
                write_all(a, 1, report, [&](auto& f, std::optional<std::uint64_t>) {
                    list(f, found, a.numbers(id_of(one, found.element_a)),
                         a.numbers_with(id_of(other, found.element_b)));
                });
            };
        };
        const auto pairs = [&](const auto& one, const auto& other, const auto& found) {
            write_pairs(a, one, other, found, report);
        };
        if (a.kind == "minimum-distance")
            return answer(
                [](const auto& one, const auto& other, Executor&) { return minimum_distance(one, other); },
                one_row([](auto& f, const auto&... rest) { list_apart(f, rest...); }));
        if constexpr (FarFrom<ViewOf<A>, ViewOf<B>> && FarFrom<ViewOf<B>, ViewOf<A>>)
            if (a.kind == "hausdorff")
                return answer(
                    [&](const auto& one, const auto& other, Executor& executor) {
                        return hausdorff_distance(one, other, {.relative = a.tolerance, .threads = executor});
                    },
                    one_row([](auto& f, const auto&... rest) { list_hausdorff(f, rest...); }));
        if constexpr (points)
            if (a.kind == "pairs-within")
                return answer(
                    [&](const auto& one, const auto& other, Executor& executor) {
                        std::vector<PairWithin<T>> found;
                        pairs_within(one, other, static_cast<double>(rounded_to<T>(a.radius)), found,
                                     {.threads = executor});
                        return found;
                    },
                    pairs);
        if constexpr (triangles)
            if (a.kind == "crossings")
                return answer(
                    [](const auto& one, const auto& other, Executor& executor) {
                        std::vector<ElementPair> found;
                        crossing_pairs(one, other, found, {.threads = executor});
                        return found;
                    },
                    pairs);
    }
    refuse(a, scenes,
           a.kind == "crossings"      ? "triangles"
           : a.kind == "pairs-within" ? "points in one space"
           : a.kind == "hausdorff"    ? "triangles or points in one space"
                                      : "triangles, or of points and any others, in one space");
}

}  // namespace

std::span<const PairKind> pair_kinds() {
    return all_pair_kinds;
}

int query_pairs(const QueryArguments& a) {
    const PairKind& kind = *std::find_if(std::begin(all_pair_kinds), std::end(all_pair_kinds),
                                         [&](const auto& k) { return k.name == a.kind; });
    if (kind.scenes == Scenes::two && a.with.empty())
        throw UsageError(a.kind + " needs --with: the other scene");
    if (kind.scenes == Scenes::one && !a.with.empty())
        throw UsageError(a.kind + " is asked of one scene: leave out --with");
    if (!a.from.empty()) throw UsageError(a.kind + " reads no rows: leave out --from");
    if (a.structure != "wide") throw UsageError(a.kind + " is answered by the engine: leave out --structure");
    if (a.count != 0) throw UsageError(a.kind + " takes no --count");
    if (kind.takes_radius && a.radius < 0)
        throw UsageError(a.kind + " needs --radius: a distance, at least 0");
    if (!kind.takes_radius && a.radius >= 0) throw UsageError(a.kind + " takes no --radius");
    if (!a.periods.empty() && !a.with.empty())
        throw UsageError("--period is for points of one scene: leave out --with, or the period");
    if (!(a.tolerance >= 0)) throw UsageError("--tolerance: a tolerance is at least 0");
    return in_precision(a, [&]<class T>(T) {
        QueryArguments numbered = a;
        LoadReport report, report_with;
        const Scene<T> scene = load<T>(a, &report);
        numbered.numbers = numbered.numbers_with = FileNumbers(std::move(report.kept_points));
        if (a.with.empty())
            return std::visit([&](const auto& set) { return query_self(numbered, set); }, scene);
        Common of_other = a;
        of_other.scene = a.with;
        const Scene<T> other = load<T>(of_other, &report_with);
        numbered.numbers_with = FileNumbers(std::move(report_with.kept_points));
        return std::visit([&](const auto& set, const auto& with) { return query_two(numbered, set, with); },
                          scene, other);
    });
}

}  // namespace hedgerow::cli
