/// Batches of points in an order in which neighbours follow each other, so that they find the nodes that they
/// need in the cache.
#pragma once

#include <hedgerow/ask/asking.h>
#include <hedgerow/structures/bvh/builders/morton.h>

namespace hedgerow::detail {

/// A place of a batch, by the code of its point on a Morton curve.
struct PlaceOnCurve {
    std::uint32_t code, place;
};

/// The places of a batch along a Morton curve of 30 bits over a box, into which points are clamped. O(n), and
/// 16 bytes a point.
template <std::floating_point T, int D>
BareVector<PlaceOnCurve> near_order(const Strided<Vec<T, D>>& points, const Box<T, D>& box,
                                    Executor& executor) {
    const MortonCells<T, D> cells(LaneBox<T>::of(box));
    BareVector<PlaceOnCurve> order(points.size());
    executor.for_each_piece(points.size(), worth_a_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec<T, D> inside = min(box.high, max(box.low, points[i]));  // NaN as well
            order[i] = {static_cast<std::uint32_t>(cells.code(Lanes<T>::of(inside)) >> (cells.bits - 30)),
                        static_cast<std::uint32_t>(i)};
        }
    });
    radix_sort(
        order, [](const PlaceOnCurve& p) { return p.code; }, 0, 3, executor);
    return order;
}

/// Calls f(some, places) for all points of a batch, a hundred at a time: `some[k]` is points[places[k]].
/// Large batches go along the curve.
template <std::floating_point T, int D, class F>
void for_some_near(const Strided<Vec<T, D>>& points, const Box<T, D>& box, Threads threads, F f) {
    IeeeExecutor executor(threads.over(points.size()));
    const bool ordered = points.size() >= worth_a_task && points.size() < 0xFFFFFFFFu && !box.empty();
    BareVector<PlaceOnCurve> order;
    if (ordered) order = near_order(points, box, executor);
    executor.for_each_piece(points.size(), 1024, [&](std::size_t begin, std::size_t end) {
        constexpr std::size_t most = 128;
        Vec<T, D> some[most];
        std::size_t places[most];
        for (std::size_t i = begin; i < end; i += most) {
            const std::size_t count = std::min(most, end - i);
            for (std::size_t k = 0; k < count; ++k) {
                places[k] = ordered ? order[i + k].place : i + k;
                some[k] = points[places[k]];
            }
            f(std::span<const Vec<T, D>>(some, count), std::span<const std::size_t>(places, count));
        }
    });
}

}  // namespace hedgerow::detail
