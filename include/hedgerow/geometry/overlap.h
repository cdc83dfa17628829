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

/// A triangle, to be asked about boxes. A corner in the box, or no separating axis: the box's, the plane's,
/// the nine products of edges (Akenine-Möller 2001), in double. Only the box's part within the triangle's own
/// box matters; with that the error is some roundings of the triangle's coordinates, however large the box.
template <class T>
class TriangleOverlap {
public:
    explicit TriangleOverlap(const Triangle<T, 3>& tri)
        : tri_(tri),
          bounds_(tri.bounds()),
          scale_(detail::safe_scale<T>(Vec3d(bounds_.high) - Vec3d(bounds_.low))),
          edge_{(Vec3d(tri.b) - Vec3d(tri.a)) * scale_, (Vec3d(tri.c) - Vec3d(tri.b)) * scale_,
                (Vec3d(tri.a) - Vec3d(tri.c)) * scale_},
          normal_(cross(edge_[0], edge_[1])) {}

    bool operator()(const Box<T, 3>& whole) const {
        const Box<T, 3> box = intersection(whole, bounds_);
        if (box.empty()) return false;
        if (box.contains(tri_.a) || box.contains(tri_.b) || box.contains(tri_.c)) return true;
        const Vec3d center = Box3d{Vec3d(box.low), Vec3d(box.high)}.center();
        const Vec3d half = (Vec3d(box.high) - center) * scale_;
        const std::array<Vec3d, 3> p = {(Vec3d(tri_.a) - center) * scale_, (Vec3d(tri_.b) - center) * scale_,
                                        (Vec3d(tri_.c) - center) * scale_};
        if (!detail::meet_along(normal_, p, half)) return false;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3d &from = p[i], &beside = p[(i + 2) % 3], &edge = edge_[i], wide = abs(edge);
            for (int k = 0; k < 3; ++k) {
                const int u = (k + 1) % 3, v = (k + 2) % 3;
                // Along axis k × edge, on which the edge is one point.
                const double one = product(edge[u], from[v]) - product(edge[v], from[u]);
                const double other = product(edge[u], beside[v]) - product(edge[v], beside[u]);
                const double radius = product(wide[v], half[u]) + product(wide[u], half[v]);
                if ((one > radius && other > radius) || (one < -radius && other < -radius)) return false;
            }
        }
        return true;
    }

private:
    Triangle<T, 3> tri_;
    Box<T, 3> bounds_;
    double scale_;
    std::array<Vec3d, 3> edge_;
    Vec3d normal_;
};
template <class T>
bool overlap(const Triangle<T, 3>& tri, const Box<T, 3>& box) {
    return TriangleOverlap<T>(tri)(box);
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
