/// Blocks of elements that are near each other, for what can be said of many at once.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <hedgerow/ask/hausdorff/corners.h>
#include <hedgerow/parallel/executor.h>
#include <hedgerow/probes/point_batch.h>

namespace hedgerow::detail {

/// Puts elements in an order in which those that follow each other are mostly near: along a Morton curve.
template <class A>
void sort_along_curve(const A& set, const Box<typename A::Scalar, A::dimension>& box,
                      std::vector<PrimitiveId>& elements, Executor& executor) {
    const Corners<A> corners{set};
    const CurveOfPoints<typename A::Scalar, A::dimension> curve(box);
    BareVector<std::uint64_t> keys(elements.size());
    executor.for_each_piece(elements.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            keys[i] = curve.code(corners[corners.number(elements[i], 0)]) << 32 | elements[i];
    });
    radix_sort(
        keys, [](std::uint64_t key) { return key; }, elements.size() > std::size_t(1) << 18 ? 31 : 42,
        elements.size() > std::size_t(1) << 18 ? 33 : 22, executor);
    for (std::size_t i = 0; i < keys.size(); ++i) elements[i] = static_cast<PrimitiveId>(keys[i]);
}

/// A corner in the middle of some elements: no point of these is farther from it than `radius`.
struct Middle {
    std::size_t corner;
    PrimitiveId element;  // whose corner it is
    double radius;
};
template <class A>
Middle middle_of(const Corners<A>& corners, const PrimitiveId* elements, std::size_t count) {
    using V = Vec<double, A::dimension>;
    Box<double, A::dimension> box;
    const auto for_each_corner = [&](auto f) {
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t k = 0; k < corners.per_element; ++k) {
                const std::size_t n = corners.number(elements[i], k);
                f(n, elements[i], V(corners[n]));
            }
    };
    for_each_corner([&](std::size_t, PrimitiveId, const V& p) { box.expand(p); });
    const V center = box.low + box.extent() * 0.5;
    Middle middle{};
    double least = std::numeric_limits<double>::infinity();
    for_each_corner([&](std::size_t n, PrimitiveId element, const V& p) {
        if (const double d2 = length2(p - center); d2 < least) least = d2, middle = {n, element, 0};
    });
    const V at(corners[middle.corner]);
    double farthest2 = 0;
    for_each_corner(
        [&](std::size_t, PrimitiveId, const V& p) { farthest2 = std::max(farthest2, length2(p - at)); });
    middle.radius = product(std::sqrt(farthest2), 1 + 0x1p-40);
    return middle;
}

}  // namespace hedgerow::detail
