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
#include <hedgerow/geometry/ball.h>
#include <hedgerow/geometry/cone.h>
#include <hedgerow/geometry/slab_region.h>
#include <hedgerow/queries/overlap_count.h>
#include <hedgerow/queries/overlapping.h>

namespace hedgerow {

/// A region that an index can be asked.
template <class R, class P>
concept RegionFor =
    Region<R> && std::same_as<typename R::Scalar, typename P::Scalar> && R::dimension == P::dimension;

/// Writes the primitives that overlap a region to `found`, ascending: their positions in the set, or
/// PlacedIds among instances. Returns how many there are.
template <class S, class P, RegionFor<P> R, class Count = const NoVisits>
std::size_t overlapping(const Index<S, P>& index, const R& region, std::vector<IdOf<P>>& found,
                        Count& count = no_visits) {
    return index.template answer<Overlapping<P, R>>(count, region, found);
}
/// Writes the primitives that lie in a region wholly to `found`, as `overlapping` does. Returns how many
/// there are.
template <class S, class P, RegionFor<P> R, class Count = const NoVisits>
std::size_t contained(const Index<S, P>& index, const R& region, std::vector<IdOf<P>>& found,
                      Count& count = no_visits) {
    static_assert(Instanced<P> || LiesWithinRegions<P, R>,
                  "a set of your own tells what lies in a region by `lies_within(i, region)`");
    return index.template answer<Overlapping<P, R>>(count, region, found, Finds::contained);
}
/// The number of primitives that overlap a region. Where a primitive may be offered twice, they are first
/// collected, in memory that the thread keeps, and repeated ones are removed.
template <class S, class P, RegionFor<P> R, class Count = const NoVisits>
std::size_t count_overlapping(const Index<S, P>& index, const R& region, Count& count = no_visits) {
    if (index.structure().exclusive() && offers_once(index.primitives())) {
        return index.template answer<OverlapCount<P, R>>(count, region);
    } else {
        const Scratch<std::vector<IdOf<P>>> found;
        return overlapping(index, region, *found, count);
    }
}
/// Whether any primitive overlaps a region. Stops at the first.
template <class S, class P, RegionFor<P> R, class Count = const NoVisits>
bool any_overlapping(const Index<S, P>& index, const R& region, Count& count = no_visits) {
    return index.template answer<AnyOverlap<P, R>>(count, region);
}

// Batches. The regions of one are of one shape, in an array of any layout (base/strided.h): a vector or a
// span of them will do.

namespace detail {
template <class Rs>
struct ElementOf;
template <class R>
struct ElementOf<Strided<R>> {
    using Type = R;
};
template <class Rs>
requires requires(const Rs& rs) {
    std::span(rs);
}
struct ElementOf<Rs> {
    using Type = std::remove_const_t<typename decltype(std::span(std::declval<const Rs&>()))::element_type>;
};
}  // namespace detail
/// An array of regions that an index can be asked.
template <class Rs, class P>
concept RegionsFor = RegionFor<typename detail::ElementOf<Rs>::Type, P> &&
    std::convertible_to<const Rs&, Strided<typename detail::ElementOf<Rs>::Type>>;

/// A list of primitives for each of many regions (ask/asking.h).
template <class S, class P, RegionsFor<P> Rs>
AnswerLists<IdOf<P>> overlapping(const Index<S, P>& index, const Rs& regions, Threads threads = {}) {
    const Strided<typename detail::ElementOf<Rs>::Type> all(regions);
    return answer_lists<IdOf<P>>(all.size(), threads.over(all.size()),
                                 [&](std::size_t i, auto& found) { overlapping(index, all[i], found); });
}
template <class S, class P, RegionsFor<P> Rs>
AnswerLists<IdOf<P>> contained(const Index<S, P>& index, const Rs& regions, Threads threads = {}) {
    const Strided<typename detail::ElementOf<Rs>::Type> all(regions);
    return answer_lists<IdOf<P>>(all.size(), threads.over(all.size()),
                                 [&](std::size_t i, auto& found) { contained(index, all[i], found); });
}
/// Writes the number of primitives that overlap each region to `counts`. Throws InputError, and writes
/// nothing, if there are fewer places than regions.
template <class S, class P, RegionsFor<P> Rs>
void count_overlapping(const Index<S, P>& index, const Rs& regions, std::span<std::size_t> counts,
                       Threads threads = {}) {
    const Strided<typename detail::ElementOf<Rs>::Type> all(regions);
    detail::expect_room("regions", all.size(), counts.size());
    threads.over(all.size()).for_each_piece(all.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) counts[i] = count_overlapping(index, all[i]);
    });
}
/// Writes whether any primitive overlaps each region, as `count_overlapping` does.
template <class S, class P, RegionsFor<P> Rs>
void any_overlapping(const Index<S, P>& index, const Rs& regions, std::span<bool> found,
                     Threads threads = {}) {
    const Strided<typename detail::ElementOf<Rs>::Type> all(regions);
    detail::expect_room("regions", all.size(), found.size());
    threads.over(all.size()).for_each_piece(all.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) found[i] = any_overlapping(index, all[i]);
    });
}

}  // namespace hedgerow
