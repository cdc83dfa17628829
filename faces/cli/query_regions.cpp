/// Queries of regions: what lies in boxes or balls, how much overlaps them, and whether anything does.
#include <hedgerow/hedgerow.h>

#include "row_query.h"

namespace hedgerow::cli {

namespace {

constexpr EngineKind all_region_kinds[] = {
    {"contained", "low_x low_y low_z high_x high_y high_z; with --radius x y z", "query primitive"},
    {"count", "the same", "count"},
    {"any-overlap", "the same", "overlaps"},
};

/// Answers rows of one shape of regions.
template <class Region, class P, class Make>
int query_regions_of(const QueryArguments& a, Make make_index) {
    using T = typename P::Scalar;
    const RowOptions options{.radius = a.radius};
    ColumnList list;
    if (a.kind == "contained")
        list("query", std::uint64_t()), list("primitive", std::uint32_t());
    else if (a.kind == "count")
        list("count", std::uint64_t());
    else
        list("overlaps", bool());
    return answer_on_engine<Region, P>(
        a, make_index, list.all, a.kind == "contained", [&](const auto& index) {
            return [&](const T* numbers, std::uint64_t first, std::size_t count, AnsweredRows& answers) {
                if (a.kind == "contained") {
                    answer_by_lists<Region, PrimitiveId>(
                        options, numbers, first, count, answers,
                        [&](const Region& region, auto& found) { contained(index, region, found); },
                        [&](PrimitiveId element, Record& record) {
                            record("primitive", reported_id(index.primitives(), element, 0));
                        });
                } else if (a.kind == "count") {
                    answer_by_rows<Region>(
                        options, numbers, first, count, answers, std::size_t(0),
                        [&](std::span<const Region> regions, std::span<std::size_t> found) {
                            count_overlapping(index, regions, found, serial_executor());
                        },
                        [](std::size_t n, Record& record) { record("count", std::uint64_t(n)); });
                } else {
                    answer_by_rows<Region>(
                        options, numbers, first, count, answers, false,
                        [&](std::span<const Region> regions, std::span<bool> found) {
                            any_overlapping(index, regions, found, serial_executor());
                        },
                        [](bool any, Record& record) { record("overlaps", any); });
                }
            };
        });
}

}  // namespace

std::span<const EngineKind> region_kinds() {
    return all_region_kinds;
}

int query_region(const QueryArguments& a) {
    return on_engine(a, [&]<class P>(auto make_index) {
        using T = typename P::Scalar;
        if (a.radius >= 0) return query_regions_of<Sphere<T, P::dimension>, P>(a, make_index);
        return query_regions_of<Box<T, P::dimension>, P>(a, make_index);
    });
}

}  // namespace hedgerow::cli
