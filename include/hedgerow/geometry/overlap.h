/// Does a shape overlap a box? Closed sets: touching counts. Every test asks the shape's own box first, so
/// that its yes never lies outside what a structure knows.
#pragma once

#include <hedgerow/geometry/distance.h>

namespace hedgerow {

template <class T, int D>
constexpr bool overlap(const Box<T, D>& a, const Box<T, D>& b) {
    for (int i = 0; i < D; ++i)
        if (!(a.low[i] <= b.high[i] && b.low[i] <= a.high[i])) return false;
    return true;
}

namespace detail {
/// Do the projections on `axis` of points given from the box's center and of the box meet?
template <int D, std::size_t N>
constexpr bool meet_along(const Vec<double, D>& axis, const std::array<Vec<double, D>, N>& points,
                          const Vec<double, D>& half) {
    double low = dot(axis, points[0]), high = low;
    for (std::size_t i = 1; i < N; ++i) {
        const double x = dot(axis, points[i]);
        low = x < low ? x : low;
        high = x > high ? x : high;
    }
    const double radius = dot(abs(axis), half);
    return low <= radius && high >= -radius;
}
/// Brings everything to about 1 where products of three could over- or underflow.
template <class T, int D, std::size_t N>
void scale(Vec<double, D>& half, std::array<Vec<double, D>, N>& points) {
    Vec<double, D> most = half;
    for (const auto& p : points) most = max(most, abs(p));
    const double s = safe_scale<T>(most);
    half = half * s;
    for (auto& p : points) p = p * s;
}
}  // namespace detail

/// Separating axes: the box's, the plane's, the nine products of edges (Akenine-Möller 2001), in double. Only
/// the box's part within the triangle's own box matters; with that the error is some roundings of the
/// triangle's coordinates, however large the box.
template <class T>
bool overlap(const Triangle<T, 3>& tri, const Box<T, 3>& whole) {
    const Box<T, 3> box = intersection(whole, tri.bounds());
    if (box.empty()) return false;
    const Vec3d center = Box3d{Vec3d(box.low), Vec3d(box.high)}.center();
    Vec3d half = Vec3d(box.high) - center;
    std::array<Vec3d, 3> p = {Vec3d(tri.a) - center, Vec3d(tri.b) - center, Vec3d(tri.c) - center};
    detail::scale<T>(half, p);
    if (!detail::meet_along(cross(p[1] - p[0], p[2] - p[0]), p, half)) return false;
    for (int i = 0; i < 3; ++i) {
        const Vec3d edge = p[static_cast<std::size_t>((i + 1) % 3)] - p[static_cast<std::size_t>(i)];
        for (int k = 0; k < 3; ++k) {
            Vec3d unit;
            unit[k] = 1;
            if (!detail::meet_along(cross(unit, edge), p, half)) return false;
        }
    }
    return true;
}

template <class T>
bool overlap(const Segment<T, 2>& s, const Box<T, 2>& whole) {
    const Box<T, 2> box = intersection(whole, s.bounds());
    if (box.empty()) return false;
    const Vec2d center = Box2d{Vec2d(box.low), Vec2d(box.high)}.center();
    Vec2d half = Vec2d(box.high) - center;
    std::array<Vec2d, 2> p = {Vec2d(s.a) - center, Vec2d(s.b) - center};
    detail::scale<T>(half, p);
    const Vec2d along = p[1] - p[0];
    return detail::meet_along(Vec2d(-along[1], along[0]), p, half);
}

/// The solid ball against the box.
template <class T, int D>
bool overlap(const Sphere<T, D>& s, const Box<T, D>& box) {
    if (!overlap(s.bounds(), box)) return false;
    const Box<double, D> wide{Vec<double, D>(box.low), Vec<double, D>(box.high)};
    const Vec<double, D> outside = offset_outside(Vec<double, D>(s.center), wide);
    const double r = static_cast<double>(s.radius), unit = std::is_same_v<T, float> ? 1 : scale_to_one(r);
    return length2(outside * unit) <= product(r * unit, r * unit);
}

}  // namespace hedgerow
