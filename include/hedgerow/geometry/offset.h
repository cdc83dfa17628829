/// Where a new ray starts that leaves a surface.
#pragma once

#include <hedgerow/geometry/ray.h>
#include <hedgerow/geometry/shapes.h>

namespace hedgerow {

/// A new ray's origin at a hit, on the side of the surface that `toward` points to: ray.at(t) moved along the
/// surface's normal by the error that it can have, which grows with how far the primitive reaches (not the
/// hit), and as far along the ray: back, or on when `toward` goes through. Along the normal alone, a hit at
/// an edge may come to lie behind the neighbouring surface; only the way that the ray came is known to be
/// free.
///
/// `bounds` is the primitive's box; `normal` and `toward` may have any length but 0.
template <class T>
Vec<T, 3> offset_origin(const Ray<T, 3>& ray, T t, const Box<T, 3>& bounds, const Vec<T, 3>& normal,
                        const Vec<T, 3>& toward) {
    const auto largest = [](const Vec<T, 3>& a) { return max_component(abs(a)); };
    // Unit vectors by way of the largest component, whose square neither over- nor underflows.
    const auto unit = [&](const Vec<T, 3>& a) { return normalized(a / largest(a)); };
    const T far = std::max(largest(bounds.low), largest(bounds.high));
    const T reach = std::max(largest(bounds.low - ray.origin), largest(bounds.high - ray.origin));
    const T step = (far + reach) * (64 * unit_roundoff<T>);
    const Vec<T, 3> n = unit(normal), d = unit(ray.direction);
    const T side = dot(n, toward) < 0 ? -step : step;
    const T way = (dot(n, d) < 0) == (side < 0) ? step : -step;
    return ray.at(t) + d * way + n * side;
}
/// The same for a triangle of any size: its normal's square may be beyond what T holds.
template <class T>
Vec<T, 3> offset_origin(const Ray<T, 3>& ray, T t, const Triangle<T, 3>& hit, const Vec<T, 3>& toward) {
    const Vec<T, 3> e1 = hit.b - hit.a, e2 = hit.c - hit.a;
    const T scale = max_component(max(abs(e1), abs(e2)));
    return offset_origin(ray, t, hit.bounds(), cross(e1 / scale, e2 / scale), toward);
}

}  // namespace hedgerow
