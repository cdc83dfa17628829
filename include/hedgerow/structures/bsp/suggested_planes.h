/// The planes that a primitive suggests for the cells of a BSP tree (Ize, Wald, Parker, RT 2008).
#pragma once

#include <hedgerow/structures/bsp/bsp_node.h>

namespace hedgerow {

/// Offers the plane through a point; one along two axes is across the third exactly.
template <std::floating_point T, int D, class Offer>
void offer_plane(const Vec<double, D>& normal, const Vec<double, D>& through, Offer offer) {
    for (int axis = 0; axis < D; ++axis)
        if (std::abs(normal[axis]) > 1 - 1e-9)
            return offer(BspPlane<T, D>::across(axis, rounded_to<T>(through[axis])));
    const Vec<T, D> stored(normal);
    offer(BspPlane<T, D>{stored, rounded_to<T>(dot(Vec<double, D>(stored), through)), -1});
}
/// Offers the plane of a triangle, and the planes through its edges at right angles to it.
template <std::floating_point T, class Offer>
void for_each_plane_through(const std::array<Vec<T, 3>, 3>& corners, Offer offer) {
    const std::array<Vec3d, 3> p = {Vec3d(corners[0]), Vec3d(corners[1]), Vec3d(corners[2])};
    const Vec3d normal = normalized(cross(p[1] - p[0], p[2] - p[0]));
    if (!(length2(normal) > 0.5)) return;
    offer_plane<T>(normal, p[0], offer);
    for (std::size_t i = 0; i < 3; ++i)
        offer_plane<T>(normalized(cross(normal, p[(i + 1) % 3] - p[i])), p[i], offer);
}
/// Offers the line of a segment, and the lines through its ends at right angles to it.
template <std::floating_point T, class Offer>
void for_each_plane_through(const std::array<Vec<T, 2>, 2>& corners, Offer offer) {
    const Vec2d a(corners[0]), b(corners[1]), along = normalized(b - a);
    if (!(length2(along) > 0.5)) return;
    offer_plane<T>(Vec2d(-along[1], along[0]), a, offer);
    offer_plane<T>(along, a, offer);
    offer_plane<T>(along, b, offer);
}

}  // namespace hedgerow
