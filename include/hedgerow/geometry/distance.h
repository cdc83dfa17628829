/// Closest points of shapes, and squared distances. Squares are always summed in the order of the axes.
#pragma once

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <type_traits>
#include <utility>

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

/// The squared distance to the farthest corner of a box.
template <class T, int D>
constexpr T farthest_distance2(const Vec<T, D>& p, const Box<T, D>& box) {
    return length2(max(abs(p - box.low), abs(box.high - p)));
}

template <class T, int D>
constexpr Vec<T, D> clamped(const Vec<T, D>& p, const Box<T, D>& box) {
    return min(max(p, box.low), box.high);
}

/// The closest point of a shape, and its squared distance. The distance is that of the shape as it is given:
/// it is computed in double and rounded once. `point` is rounded to T, and may be farther or nearer than that
/// by a rounding of a coordinate, which is much of a small distance.
template <std::floating_point T, int D>
struct Foot {
    T distance2;
    Vec<T, D> point;
};

namespace detail {
/// A power of two that scales the vectors so that fourth powers of their lengths neither overflow nor
/// underflow. Returns 1 for floats, which need no scaling in double.
template <class T, int D, class... More>
double safe_scale(const Vec<double, D>& first, const More&... more) {
    if constexpr (std::is_same_v<T, float>) return 1;
    return scale_to_one(std::max({max_component(abs(first)), max_component(abs(more))...}));
}

/// A foot in double. The squared distance is in scaled units: that of scaled vectors.
template <int D>
using ExactFoot = Foot<double, D>;

/// The closest point of the segment from a to b, whose distance is measured to the point that is found, so it
/// errs by the square of the point's error along the segment, and never by much more than that error.
/// Measures from the same end for ab and ba, and from an end itself where that is closest: triangles with a
/// common edge are equally far away where it is closest.
template <int D>
ExactFoot<D> foot_on_segment(const Vec<double, D>& p, const Vec<double, D>& a, const Vec<double, D>& b,
                             double scale) {
    const bool turned = std::lexicographical_compare(std::begin(b.data), std::end(b.data), std::begin(a.data),
                                                     std::end(a.data));
    const Vec<double, D>&from = turned ? b : a, &to = turned ? a : b;
    const Vec<double, D> along = (to - from) * scale, x = (p - from) * scale;
    const double l = length2(along), t = l > 0 ? dot(x, along) / l : 0;
    if (!(t > 0)) return {length2(x), from};
    if (t >= 1) return {length2((p - to) * scale), to};
    return {length2(x - along * t), from + (to - from) * t};
}

/// Rounds a foot to T. The distance is at least that to the shape's box, which is exact but for roundings in
/// T, so that a structure that measures to boxes finds the shape by the same limit as brute force
/// (probes/point.h).
template <class T, int D>
Foot<T, D> rounded_foot(const Vec<T, D>& query, const ExactFoot<D>& foot, double scale,
                        const Box<T, D>& box) {
    const Box<double, D> around{Vec<double, D>(box.low), Vec<double, D>(box.high)};
    const double d2 = std::is_same_v<T, float> ? foot.distance2 : foot.distance2 / scale / scale;
    return {rounded_to<T>(std::max(d2, distance2(Vec<double, D>(query), around))),  // NaN stays NaN
            clamped(Vec<T, D>(foot.point), box)};
}
}  // namespace detail

template <class T, int D>
Foot<T, D> closest_point(const Vec<T, D>& query, const Vec<T, D>& point) {
    return {rounded_to<T>(distance2(Vec<double, D>(query), Vec<double, D>(point))), point};
}

template <class T, int D>
Foot<T, D> closest_point(const Vec<T, D>& query, const Segment<T, D>& s) {
    using V = Vec<double, D>;
    const V p(query), a(s.a), b(s.b);
    const double scale = detail::safe_scale<T>(b - a, p - a);
    return detail::rounded_foot(query, detail::foot_on_segment(p, a, b, scale), scale, s.bounds());
}

/// The foot of the perpendicular to the triangle's plane, if it is inside, else the closest point of the
/// edges. All errors are those of double, of the distance plus the longest edge: the side ac is split into a
/// part along ab and a height (Gram and Schmidt), which keeps slivers in order, and the distance is measured
/// to the foot that is found. In a sliver the foot may slip along the height, so the edges are tried too;
/// either is a point of the triangle, and one of the two is right.
template <class T, int D>
Foot<T, D> closest_point(const Vec<T, D>& query, const Triangle<T, D>& tri) {
    using V = Vec<double, D>;
    const V p(query), a(tri.a), b(tri.b), c(tri.c);
    const V whole_ab = b - a, whole_ac = c - a;
    const double scale = detail::safe_scale<T>(whole_ab, whole_ac, p - a);
    const V ab = whole_ab * scale, ac = whole_ac * scale, ap = (p - a) * scale;
    // Write ap = v·ab + w·ac + a rest that is perpendicular to both.
    const double length_ab2 = length2(ab), along_c = dot(ac, ab) / length_ab2;
    const double along_p = dot(ap, ab) / length_ab2;
    const V height = ac - ab * along_c, across = ap - ab * along_p;
    const double height2 = length2(height);
    const double w = dot(across, height) / height2, v = along_p - product(w, along_c);
    const bool inside = v >= 0 && w >= 0 && v + w <= 1;  // false if there is no area
    detail::ExactFoot<D> best{std::numeric_limits<double>::infinity(), a};
    if (inside)
        best = D == 2 ? detail::ExactFoot<D>{0, p}
                      : detail::ExactFoot<D>{length2(ap - ab * v - ac * w), a + whole_ab * v + whole_ac * w};
    // Try the edges, unless the foot is inside of a triangle that is no sliver.
    if (!(inside && height2 > 0x1p-8 * length2(ac)))
        for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
            const auto foot = detail::foot_on_segment(p, from, to, scale);
            if (!(foot.distance2 >= best.distance2)) best = foot;
        }
    return detail::rounded_foot(query, best, scale, tri.bounds());
}

/// The closest point of the sphere's surface. For the center itself, the point along the first axis.
template <class T, int D>
Foot<T, D> closest_point(const Vec<T, D>& query, const Sphere<T, D>& s) {
    using V = Vec<double, D>;
    const V p(query), center(s.center);
    const double scale = detail::safe_scale<T>(p - center);
    V from = (p - center) * scale;
    double l = length(from);
    const double radius = static_cast<double>(s.radius), away = l - product(radius, scale);
    if (!(l > 0)) from = {}, from[0] = l = 1;
    return detail::rounded_foot(query, {product(away, away), center + from * (radius / l)}, scale,
                                s.bounds());
}

namespace detail {
/// The farthest of some corners, measured in double and rounded once; of equally far ones the first.
template <class T, int D, std::size_t n>
Foot<T, D> farthest_corner(const Vec<T, D>& query, const std::array<Vec<T, D>, n>& corners) {
    Foot<T, D> farthest{};
    double most = -1;
    for (const auto& corner : corners)
        if (const double d2 = distance2(Vec<double, D>(query), Vec<double, D>(corner)); d2 > most)
            most = d2, farthest.point = corner;
    farthest.distance2 = rounded_to<T>(most);
    return farthest;
}
}  // namespace detail

// The farthest point of a shape. The distance is rounded once, and at most that to the farthest corner of the
// shape's box.

template <class T, int D>
Foot<T, D> farthest_point(const Vec<T, D>& query, const Vec<T, D>& point) {
    return detail::farthest_corner(query, std::array{point});
}
template <class T, int D>
Foot<T, D> farthest_point(const Vec<T, D>& query, const Segment<T, D>& s) {
    return detail::farthest_corner(query, std::array{s.a, s.b});
}
template <class T, int D>
Foot<T, D> farthest_point(const Vec<T, D>& query, const Triangle<T, D>& t) {
    return detail::farthest_corner(query, std::array{t.a, t.b, t.c});
}
/// From a sphere's center all of it is equally far: the answer is along the first axis.
template <class T, int D>
Foot<T, D> farthest_point(const Vec<T, D>& query, const Sphere<T, D>& s) {
    using V = Vec<double, D>;
    const V p(query), c(s.center);
    const double r = static_cast<double>(s.radius);
    V away = c - p;
    const double scale = max_component(abs(away));
    if (scale > 0)
        away = away / scale;
    else
        away[0] = 1;
    const double most = length(away);
    const double distance = scale * most + r;
    const Box<T, D> box = s.bounds();
    const Box<double, D> around{V(box.low), V(box.high)};
    const V point = c + away * (r / most);
    return {rounded_to<T>(std::min(distance * distance, farthest_distance2(p, around))),
            clamped(Vec<T, D>(point), box)};
}

}  // namespace hedgerow
