/// Closest points of shapes, and squared distances. Squares are always summed in the order of the axes. The
/// computed distance to a box therefore never exceeds the computed distance to a shape inside it: rounding is
/// monotone, and closest points are clamped into the box of their shape.
#pragma once

#include <algorithm>
#include <type_traits>

#include <hedgerow/geometry/shapes.h>

namespace hedgerow {

template <class T, int D>
constexpr T distance2(const Vec<T, D>& p, const Vec<T, D>& q) {
    return length2(abs(p - q));
}

/// How far p is outside the box along each axis; 0 inside.
template <class T, int D>
constexpr Vec<T, D> offset_outside(const Vec<T, D>& p, const Box<T, D>& box) {
    Vec<T, D> d;
    for (int i = 0; i < D; ++i)
        d[i] = p[i] < box.low[i] ? box.low[i] - p[i] : (p[i] > box.high[i] ? p[i] - box.high[i] : T(0));
    return d;
}
template <class T, int D>
constexpr T distance2(const Vec<T, D>& p, const Box<T, D>& box) {
    return length2(offset_outside(p, box));
}

template <class T, int D>
constexpr Vec<T, D> clamped(const Vec<T, D>& p, const Box<T, D>& box) {
    return min(max(p, box.low), box.high);
}

namespace detail {
/// A power of two that scales the vectors so that fourth powers of their lengths neither overflow nor
/// underflow. Returns 1 for floats, which need no scaling in double.
template <class T, int D, class... More>
double safe_scale(const Vec<double, D>& first, const More&... more) {
    if constexpr (std::is_same_v<T, float>) return 1;
    return scale_to_one(std::max({max_component(abs(first)), max_component(abs(more))...}));
}
}  // namespace detail

/// The closest point of a segment, in double.
template <class T, int D>
Vec<T, D> closest_point(const Vec<T, D>& query, const Segment<T, D>& s) {
    using V = Vec<double, D>;
    V ab = V(s.b) - V(s.a), ap = V(query) - V(s.a);
    const double scale = detail::safe_scale<T>(ab, ap);
    ab = ab * scale, ap = ap * scale;
    const double l = length2(ab);
    const double u = l > 0 ? std::clamp(dot(ap, ab) / l, 0.0, 1.0) : 0;
    return clamped(Vec<T, D>(V(s.a) + (V(s.b) - V(s.a)) * u), s.bounds());
}

/// The closest point of a triangle, in double: the foot of the perpendicular to its plane if the foot is
/// inside, else the closest point of the edges. In a sliver, rounding may decide whether the foot is inside,
/// so the edges are tried in either case. The point then errs by no more than the sliver's width.
template <class T, int D>
Vec<T, D> closest_point(const Vec<T, D>& query, const Triangle<T, D>& tri) {
    using V = Vec<double, D>;
    const V whole_ab = V(tri.b) - V(tri.a), whole_ac = V(tri.c) - V(tri.a);
    V ab = whole_ab, ac = whole_ac, ap = V(query) - V(tri.a);
    const double scale = detail::safe_scale<T>(ab, ac, ap);
    ab = ab * scale, ac = ac * scale, ap = ap * scale;
    // Least squares for ap = v·ab + w·ac, by Cramer's rule.
    const double bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac), pb = dot(ap, ab), pc = dot(ap, ac);
    const double area2 = product(bb, cc) - product(bc, bc);
    const double v = (product(cc, pb) - product(bc, pc)) / area2;
    const double w = (product(bb, pc) - product(bc, pb)) / area2;
    const bool inside = v >= 0 && w >= 0 && v + w <= 1;  // false if there is no area
    const Vec<T, D> foot =
        inside ? clamped(Vec<T, D>(V(tri.a) + whole_ab * v + whole_ac * w), tri.bounds()) : tri.a;
    // Return a foot that is inside unless the triangle is a sliver: sin² of its angle at a is at most 2^-8.
    if (inside && area2 > 0x1p-8 * product(bb, cc)) return foot;

    // Take the closest of the foot, if it is inside, and the edges.
    Vec<T, D> best = foot;
    for (const auto& edge : {Segment<T, D>{tri.a, tri.b}, {tri.b, tri.c}, {tri.c, tri.a}}) {
        const auto q = clamped(closest_point(query, edge), tri.bounds());
        if (distance2(query, q) < distance2(query, best)) best = q;
    }
    return best;
}

/// The closest point of the sphere's surface, in double. For the center itself, the point along the first
/// axis.
template <class T, int D>
Vec<T, D> closest_point(const Vec<T, D>& p, const Sphere<T, D>& s) {
    Vec<double, D> from = Vec<double, D>(p) - Vec<double, D>(s.center);
    from = from * detail::safe_scale<T>(from);
    double l = length(from);
    if (!(l > 0)) from = {}, from[0] = l = 1;
    return clamped(Vec<T, D>(Vec<double, D>(s.center) + from * (static_cast<double>(s.radius) / l)),
                   s.bounds());
}

}  // namespace hedgerow
