/// The origin of a new ray that leaves a surface.
#pragma once

#include <hedgerow/geometry/number_lanes.h>
#include <hedgerow/geometry/ray.h>
#include <hedgerow/geometry/shapes.h>

namespace hedgerow {

/// How far, along its normal, a primitive within bounds may be from where a ray from `origin` hits it. That
/// grows with how far the whole primitive reaches, from 0 and from the origin, not with how far the hit is. F
/// is float, double, or lanes of these.
template <class F>
F hit_error(const Vec<F, 3>& origin, const Vec<F, 3>& low, const Vec<F, 3>& high) {
    const auto largest = [](const Vec<F, 3>& a) { return max_component(abs(a)); };
    const F far = greater(largest(low), largest(high));
    const F reach = greater(largest(low - origin), largest(high - origin));
    return (far + reach) * (64 * unit_roundoff<NumberOf<F>>);
}
template <class T>
T hit_error(const Vec<T, 3>& origin, const Box<T, 3>& bounds) {
    return hit_error(origin, bounds.low, bounds.high);
}

/// The origin of a new ray at the hit ray.at(t), on the side of the surface that `toward` points to. On the
/// side that the ray comes from this is a point of the ray, back from the hit until the surface is as far
/// away as the hit can err (`step`), or where the ray begins. So it lies where the ray came, which is known
/// to be free: a point off the ray could be behind a neighbouring surface, where both meet at an edge. On the
/// other side the hit is moved by that error along the normal, and by as much along the ray.
///
/// `normal` and `toward` may have any length but 0. F is float, double, or lanes of these.
template <class F>
Vec<F, 3> offset_origin(const Vec<F, 3>& origin, const Vec<F, 3>& direction, F begin, F t, F step,
                        const Vec<F, 3>& normal, const Vec<F, 3>& toward) {
    // Divide by the largest component first: its square neither overflows nor underflows.
    const auto unit = [](const Vec<F, 3>& a) { return normalized(a / max_component(abs(a))); };
    const Vec<F, 3> n = unit(normal);
    const F along = dot(n, direction);
    const auto comes_in = along<0, leaves_on_front = dot(n, toward)> 0;
    const auto leaves_back = select(comes_in, leaves_on_front, !leaves_on_front);
    const Vec<F, 3> on_ray = origin + direction * greater(begin, t - step / magnitude(along));
    if (!any(!leaves_back)) return on_ray;
    const Vec<F, 3> beyond = origin + direction * t + (unit(direction) + select(comes_in, -n, n)) * step;
    return select(leaves_back, on_ray, beyond);
}
/// `bounds` is the primitive's box.
template <class T>
Vec<T, 3> offset_origin(const Ray<T, 3>& ray, T t, const Box<T, 3>& bounds, const Vec<T, 3>& normal,
                        const Vec<T, 3>& toward) {
    return offset_origin(ray.origin, ray.direction, ray.t_min, t, hit_error(ray.origin, bounds), normal,
                         toward);
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
