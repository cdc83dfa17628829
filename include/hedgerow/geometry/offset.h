/// The origin of a new ray that leaves a surface.
#pragma once

#include <hedgerow/geometry/ray.h>
#include <hedgerow/geometry/shapes.h>

namespace hedgerow {

/// How far, along its normal, a primitive within these bounds may be from where a ray from `origin` hits it.
/// That grows with how far the whole primitive reaches, from 0 and from the origin, not with how far the hit
/// is.
template <class T>
T hit_error(const Vec<T, 3>& origin, const Box<T, 3>& bounds) {
    const auto largest = [](const Vec<T, 3>& a) { return max_component(abs(a)); };
    const T far = std::max(largest(bounds.low), largest(bounds.high));
    const T reach = std::max(largest(bounds.low - origin), largest(bounds.high - origin));
    return (far + reach) * (64 * unit_roundoff<T>);
}

/// The origin of a new ray at the hit ray.at(t), on the side of the surface that `toward` points to. On the
/// side that the ray comes from this is a point of the ray, back from the hit until the surface is as far
/// away as the hit can err, or where the ray begins. So it lies where the ray came, which is known to be
/// free: a point off the ray could be behind a neighbouring surface, where both meet at an edge. On the other
/// side the hit is moved by that error along the normal, and by as much along the ray.
///
/// `bounds` is the primitive's box; `normal` and `toward` may have any length but 0.
template <class T>
Vec<T, 3> offset_origin(const Ray<T, 3>& ray, T t, const Box<T, 3>& bounds, const Vec<T, 3>& normal,
                        const Vec<T, 3>& toward) {
    // Divide by the largest component first: its square neither overflows nor underflows.
    const auto unit = [](const Vec<T, 3>& a) { return normalized(a / max_component(abs(a))); };
    const T step = hit_error(ray.origin, bounds);
    const Vec<T, 3> n = unit(normal);
    const T along = dot(n, ray.direction);
    if ((along < 0) == (dot(n, toward) > 0)) return ray.at(std::max(ray.t_min, t - step / std::abs(along)));
    return ray.at(t) + (unit(ray.direction) + (along < 0 ? -n : n)) * step;
}
/// The origin of a new ray at a hit on a triangle of any size. The edges are scaled to 1 first, since the
/// square of the normal may be beyond the range of T.
template <class T>
Vec<T, 3> offset_origin(const Ray<T, 3>& ray, T t, const Triangle<T, 3>& hit, const Vec<T, 3>& toward) {
    const Vec<T, 3> e1 = hit.b - hit.a, e2 = hit.c - hit.a;
    const T scale = max_component(max(abs(e1), abs(e2)));
    return offset_origin(ray, t, hit.bounds(), cross(e1 / scale, e2 / scale), toward);
}

}  // namespace hedgerow
