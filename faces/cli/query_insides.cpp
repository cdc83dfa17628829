/// Queries of a solid: the side of points, winding numbers and signed distances.
#include <limits>

#include <hedgerow/hedgerow.h>

#include "row_query.h"

namespace hedgerow::cli {

namespace {

constexpr EngineKind all_inside_kinds[] = {
    {"side", "x y z (--by)", "side: -1 outside, 0 on the surface, 1 inside"},
    {"winding-number", "x y z (--by)", "winding_number"},
    {"signed-distance", "x y z (--by)", "distance: negative inside"},
};

SolidOptions solid_options(const QueryArguments& a) {
    constexpr std::pair<std::string_view, SideBy> ways[] = {{"crossings", SideBy::crossings},
                                                            {"parity", SideBy::parity},
                                                            {"pseudonormal", SideBy::pseudonormal},
                                                            {"expansion", SideBy::expansion}};
    SolidOptions options{.error = a.error};
    for (const auto& [name, by] : ways)
        if (a.by == name) options.by = by;
    return options;
}

/// A solid's index, and all that answers pieces of rows.
template <class I>
struct SolidRows {
    using T = typename I::Scalar;
    using Point = Vec<T, I::dimension>;

    std::string_view kind;
    std::unique_ptr<const Solid<I>> solid;

    void operator()(const T* numbers, std::uint64_t first, std::size_t count, AnsweredRows& answers) const {
        const auto answer = [&](const char* column, auto none, auto ask_all) {
            answer_by_rows<Point>({}, numbers, first, count, answers, none, ask_all,
                                  [&](auto number, auto& record) { record(column, number); });
        };
        Executor& here = serial_executor();
        if (kind == "side") {
            answer("side", std::numeric_limits<std::int8_t>::min(),
                   [&](std::span<const Point> points, std::span<std::int8_t> found) {
                       static thread_local std::vector<Side> told;
                       told.resize(points.size());
                       sides(*solid, points, told, here);
                       for (std::size_t i = 0; i < told.size(); ++i)
                           found[i] = static_cast<std::int8_t>(static_cast<int>(told[i]) -
                                                               static_cast<int>(Side::on));
                   });
        } else if (kind == "winding-number") {
            answer("winding_number", std::numeric_limits<double>::quiet_NaN(),
                   [&](std::span<const Point> points, std::span<double> found) {
                       winding_numbers(*solid, points, found, here);
                   });
        } else {
            answer("distance", std::numeric_limits<T>::quiet_NaN(),
                   [&](std::span<const Point> points, std::span<T> found) {
                       signed_distances(*solid, points, found, here);
                   });
        }
    }
};

template <class T>
std::vector<Column> inside_columns(std::string_view kind) {
    ColumnList list;
    if (kind == "side")
        list("side", std::int8_t());
    else if (kind == "winding-number")
        list("winding_number", double());
    else
        list("distance", T());
    return list.all;
}

}  // namespace

std::span<const EngineKind> inside_kinds() {
    return all_inside_kinds;
}

int query_inside(const QueryArguments& a) {
    if (a.radius >= 0) throw UsageError(a.kind + " takes no --radius");
    if (a.kind == "winding-number" && (a.by == "parity" || a.by == "pseudonormal"))
        throw UsageError("winding numbers are told by crossings or expansion, not by " + a.by);
    const SolidOptions options = solid_options(a);
    return on_engine(a, [&]<class P>(auto make_index) -> int {
        if constexpr (FacetSet<ViewOf<P>>) {
            using Point = Vec<typename P::Scalar, P::dimension>;
            return answer_on_engine<Point, P>(
                a, make_index, inside_columns<typename P::Scalar>(a.kind), false,
                [&]<class I>(const I& index) {
                    ProgressLine line("looking for open edges", a.quiet);
                    WatchedExecutor watched(default_executor(), line.progress());
                    return SolidRows<I>{a.kind, std::make_unique<const Solid<I>>(index, options, watched)};
                });
        } else {
            throw InputError(a.scene + ": " + a.kind +
                             " is asked of triangles, or of segments in the plane. Name such a scene");
        }
    });
}

}  // namespace hedgerow::cli
