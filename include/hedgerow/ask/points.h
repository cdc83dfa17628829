/// The questions of a point, one at a time or many in a batch: the closest point, the nearest primitives, and
/// those within a distance.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include <hedgerow/ask/asking.h>
#include <hedgerow/queries/closest_point.h>
#include <hedgerow/queries/nearest.h>
#include <hedgerow/queries/within.h>

namespace hedgerow {

template <class I>
using PointOf = Vec<typename I::Scalar, I::dimension>;
template <class I>
using NearOf = Near<typename I::Scalar, I::dimension>;

/// The closest point of any primitive within `max_distance2` (squared, included); a Near that is false if
/// there is no such primitive.
template <class S, class P, class Count = const NoVisits>
inline Near<typename P::Scalar, P::dimension> closest_point(
    const Index<S, P>& index, const Vec<typename P::Scalar, P::dimension>& point,
    typename P::Scalar max_distance2 = std::numeric_limits<typename P::Scalar>::max(),
    Count& count = no_visits) {
    return index.template answer<ClosestPoint<P>>(count, point, max_distance2);
}
/// Writes the k nearest primitives within `max_distance2` (squared, included) to `found`, in the order of
/// (distance², instance, element). Returns how many there are.
template <class S, class P, class Count = const NoVisits>
std::size_t nearest(const Index<S, P>& index, const Vec<typename P::Scalar, P::dimension>& point,
                    std::size_t k, std::vector<Near<typename P::Scalar, P::dimension>>& found,
                    typename P::Scalar max_distance2 = std::numeric_limits<typename P::Scalar>::max(),
                    Count& count = no_visits) {
    return index.template answer<Nearest<P>>(count, point, k, max_distance2, found);
}
/// Writes all primitives within `max_distance2` (squared, included) to `found`, in the order of (distance²,
/// instance, element). Returns how many there are.
template <class I, class Count = const NoVisits>
std::size_t within(const I& index, const PointOf<I>& point, typename I::Scalar max_distance2,
                   std::vector<NearOf<I>>& found, Count& count = no_visits) {
    return index.template answer<Within<typename I::Primitives>>(count, point, max_distance2, found);
}

/// Writes the closest point for each of `points`, as `closest_point` finds it. The points may have any layout
/// in memory (base/strided.h); a vector or a span of points will do. Throws InputError, and writes nothing,
/// if there are fewer places for answers than points.
template <class S, class P>
void closest_points(const Index<S, P>& index, const Strided<Vec<typename P::Scalar, P::dimension>>& points,
                    std::span<Near<typename P::Scalar, P::dimension>> found, Threads threads = {},
                    typename P::Scalar max_distance2 = std::numeric_limits<typename P::Scalar>::max()) {
    detail::expect_room("points", points.size(), found.size());
    threads.over(points.size()).for_each_piece(points.size(), 1024, [&](std::size_t begin, std::size_t end) {
        const Kernel<ClosestPoint<P>, Index<S, P>> kernel;
        if constexpr (requires { kernel.answer_many(index, points, max_distance2, found.data()); })
            if (kernel)
                return in_ieee_mode([&] {
                    kernel.answer_many(index, points.part(begin, end - begin), max_distance2,
                                       found.data() + begin);
                });
        for (std::size_t i = begin; i < end; ++i) found[i] = closest_point(index, points[i], max_distance2);
    });
}

/// A list of primitives for each of many points (ask/asking.h). `max_distance2` is squared.
template <class S, class P>
AnswerLists<Near<typename P::Scalar, P::dimension>> nearest(
    const Index<S, P>& index, const Strided<Vec<typename P::Scalar, P::dimension>>& points, std::size_t k,
    Threads threads = {}, typename P::Scalar max_distance2 = std::numeric_limits<typename P::Scalar>::max()) {
    return answer_lists<Near<typename P::Scalar, P::dimension>>(
        points.size(), threads.over(points.size()),
        [&](std::size_t i, auto& found) { nearest(index, points[i], k, found, max_distance2); });
}
template <class I>
AnswerLists<NearOf<I>> within(const I& index, const Strided<PointOf<I>>& points,
                              typename I::Scalar max_distance2, Threads threads = {}) {
    return answer_lists<NearOf<I>>(
        points.size(), threads.over(points.size()),
        [&](std::size_t i, auto& found) { within(index, points[i], max_distance2, found); });
}

}  // namespace hedgerow
