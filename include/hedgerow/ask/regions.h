/// The questions of a region, one at a time or many in a batch: what overlaps it, what lies in it, how much
/// and whether anything does.
///
/// A region is a Box, a Sphere (the solid ball), or another shape of geometry/ that is a Region, of the
/// index's scalar and dimension; or a type of your own that fulfils the concept (geometry/region.h). Sets are
/// closed: touching counts. Nothing overlaps an empty region, or one with NaN. In a tree whose nodes hold
/// each primitive once, a subtree inside of the region is taken whole, without a test.
#pragma once

#include <vector>

#include <hedgerow/ask/asking.h>
#include <hedgerow/ask/truths.h>
#include <hedgerow/geometry/ball.h>
#include <hedgerow/geometry/cone.h>
#include <hedgerow/geometry/slab_region.h>
#include <hedgerow/queries/overlap_count.h>
#include <hedgerow/queries/overlapping.h>

namespace hedgerow {

/// A region that an index can be asked.
template <class R, class I>
concept RegionFor =
    Region<R> && std::same_as<typename R::Scalar, typename I::Scalar> && R::dimension == I::dimension;

template <class I>
using IdListsOf = IdLists<IdOf<typename I::Primitives>>;

/// By which threads a batch of regions is answered.
struct RegionOptions {
    Threads threads = {};
};

namespace detail {
template <template <class, class> class Q, class I, class R, class Count, class... Arguments>
auto answer_region(const I& index, const R& region, Count& count, Arguments&&... arguments) {
    if constexpr (requires { index.template answer_region<Q>(region, count, arguments...); })
        return index.template answer_region<Q>(region, count, arguments...);
    else
        return index.template answer<Q<typename I::Primitives, R>>(count, region, arguments...);
}
}  // namespace detail

/// Writes the primitives that overlap a region to `found`, ascending: their positions in the set, or
/// PlacedIds among instances. Returns how many there are.
template <class I, RegionFor<I> R, class Count = const NoVisits>
std::size_t overlapping(const I& index, const R& region, std::vector<IdOf<typename I::Primitives>>& found,
                        const RegionOptions& = {}, Count& count = no_visits) {
    return detail::answer_region<Overlapping>(index, region, count, found, Finds::overlapping);
}
template <class I, RegionFor<I> R>
std::vector<IdOf<typename I::Primitives>> overlapping(const I& index, const R& region) {
    std::vector<IdOf<typename I::Primitives>> found;
    overlapping(index, region, found);
    return found;
}
/// Writes the primitives that lie in a region wholly to `found`, as `overlapping` does. Returns how many
/// there are.
template <class I, RegionFor<I> R, class Count = const NoVisits>
std::size_t contained(const I& index, const R& region, std::vector<IdOf<typename I::Primitives>>& found,
                      const RegionOptions& = {}, Count& count = no_visits) {
    using P = typename I::Primitives;
    static_assert(Instanced<P> || LiesWithinRegions<P, R> || std::same_as<P, I>,
                  "a set of your own tells what lies in a region by `lies_within(i, region)`");
    return detail::answer_region<Overlapping>(index, region, count, found, Finds::contained);
}
template <class I, RegionFor<I> R>
std::vector<IdOf<typename I::Primitives>> contained(const I& index, const R& region) {
    std::vector<IdOf<typename I::Primitives>> found;
    contained(index, region, found);
    return found;
}
/// The number of primitives that overlap a region. Where a primitive may be offered twice, they are first
/// collected, in memory that the thread keeps, and repeated ones are removed.
template <class I, RegionFor<I> R, class Count = const NoVisits>
std::size_t overlap_count(const I& index, const R& region, const RegionOptions& options = {},
                          Count& count = no_visits) {
    if (detail::offers_each_once(index)) return detail::answer_region<OverlapCount>(index, region, count);
    const Scratch<std::vector<IdOf<typename I::Primitives>>> found;
    return overlapping(index, region, *found, options, count);
}
/// Whether any primitive overlaps a region. Stops at the first.
template <class I, RegionFor<I> R, class Count = const NoVisits>
bool any_overlap(const I& index, const R& region, const RegionOptions& = {}, Count& count = no_visits) {
    return detail::answer_region<AnyOverlap>(index, region, count);
}

// Batches. The regions of one are of one shape, in an array of any layout (base/strided.h): a vector or a
// span of them will do.

namespace detail {
template <class Rs>
struct RegionOf;
template <class R>
struct RegionOf<Strided<R>> {
    using Type = R;
};
template <class Rs>
requires requires(const Rs& rs) {
    std::span(rs);
}
struct RegionOf<Rs> {
    using Type = std::remove_const_t<typename decltype(std::span(std::declval<const Rs&>()))::element_type>;
};
}  // namespace detail
/// An array of regions that an index can be asked.
template <class Rs, class I>
concept RegionsFor = RegionFor<typename detail::RegionOf<Rs>::Type, I> &&
    std::convertible_to<const Rs&, Strided<typename detail::RegionOf<Rs>::Type>>;

namespace detail {
/// Lists what one(region, found, count) finds of each region of a batch. An engine of Q gets what is to be
/// found too.
template <template <class, class> class Q, class I, class Rs, class One>
void list_regions(const I& index, const Rs& regions, Finds finds, IdListsOf<I>& lists,
                  const RegionOptions& options, std::span<Visits> visits, One one) {
    using R = typename RegionOf<Rs>::Type;
    const Strided<R> all(regions);
    expect_visits(visits, all.size());
    list_batch<Q<typename I::Primitives, R>>(
        index, all, lists, AskedBatch{options, keep_all, options.threads.over(all.size()), visits},
        appending(&IdListsOf<I>::ids,
                  [&](std::size_t i, auto& found, auto& count) { one(all[i], found, count); }),
        finds);
}
/// Sets answers[i] to what one(region, count) answers of region i.
template <template <class, class> class Q, class I, class Rs, class Answer, class One>
KernelUse answer_regions(const I& index, const Rs& regions, Answer* answers, const RegionOptions& options,
                         std::span<Visits> visits, One one) {
    using R = typename RegionOf<Rs>::Type;
    const Strided<R> all(regions);
    expect_visits(visits, all.size());
    return answer_batch<Q<typename I::Primitives, R>>(
        index, all, answers, AskedBatch{options, keep_all, options.threads.over(all.size()), visits},
        [&](std::size_t i, auto& count) { return one(all[i], count); });
}
}  // namespace detail

/// Writes a list of primitives for each of many regions.
template <class I, RegionsFor<I> Rs>
void overlapping(const I& index, const Rs& regions, IdListsOf<I>& lists, const RegionOptions& options = {},
                 std::span<Visits> visits = {}) {
    detail::list_regions<Overlapping>(
        index, regions, Finds::overlapping, lists, options, visits,
        [&](const auto& region, auto& found, auto& count) { overlapping(index, region, found, {}, count); });
}
template <class I, RegionsFor<I> Rs>
IdListsOf<I> overlapping(const I& index, const Rs& regions, const RegionOptions& options = {},
                         std::span<Visits> visits = {}) {
    IdListsOf<I> lists;
    overlapping(index, regions, lists, options, visits);
    return lists;
}
template <class I, RegionsFor<I> Rs>
void contained(const I& index, const Rs& regions, IdListsOf<I>& lists, const RegionOptions& options = {},
               std::span<Visits> visits = {}) {
    detail::list_regions<Overlapping>(
        index, regions, Finds::contained, lists, options, visits,
        [&](const auto& region, auto& found, auto& count) { contained(index, region, found, {}, count); });
}
template <class I, RegionsFor<I> Rs>
IdListsOf<I> contained(const I& index, const Rs& regions, const RegionOptions& options = {},
                       std::span<Visits> visits = {}) {
    IdListsOf<I> lists;
    contained(index, regions, lists, options, visits);
    return lists;
}
/// Writes the number of primitives that overlap region i to counts[i].
template <class I, RegionsFor<I> Rs>
void overlap_counts(const I& index, const Rs& regions, std::span<std::size_t> counts,
                    const RegionOptions& options = {}, std::span<Visits> visits = {}) {
    detail::expect_room("regions", std::size(regions), counts.size());
    detail::answer_regions<OverlapCount>(
        index, regions, counts.data(), options, visits,
        [&](const auto& region, auto& count) { return overlap_count(index, region, {}, count); });
}
/// Writes whether any primitive overlaps region i to place i of `found`: an array of bool or of bytes, or a
/// std::vector<bool>.
template <class I, RegionsFor<I> Rs>
void any_overlaps(const I& index, const Rs& regions, const Truths& found, const RegionOptions& options = {},
                  std::span<Visits> visits = {}) {
    detail::expect_room("regions", std::size(regions), found.size());
    found.written(std::size(regions), [&](bool* answers) {
        return detail::answer_regions<AnyOverlap>(
            index, regions, answers, options, visits,
            [&](const auto& region, auto& count) { return any_overlap(index, region, {}, count); });
    });
}

}  // namespace hedgerow
