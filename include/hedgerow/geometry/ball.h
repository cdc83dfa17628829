/// A ball as a region: the points within `radius` (not its square) of the center of a Sphere.
///
/// Points, segments and triangles overlap a ball if their distance from its center, as `closest_point` rounds
/// it, is within the radius by the rule of geometry/radius.h, so `within` finds the same ones. They lie in a
/// ball if they overlap it and their corners do. Solid balls are decided exactly, and overlap a ball too if
/// `within` finds their surface. A negative radius makes an empty ball, an infinite one all of space.
#pragma once

#include <hedgerow/geometry/radius.h>
#include <hedgerow/geometry/region.h>

namespace hedgerow {

namespace detail {
/// The exact sign of |p − q|² − (a + sign·b)², for a, b >= 0.
template <int D>
int compare_distance(const Vec<double, D>& p, const Vec<double, D>& q, double a, double b, double sign) {
    const double reach = a + product(sign, b), reach2 = product(reach, reach), away2 = distance2(p, q);
    // The roundings of the differences are relative to the radii, which may cancel.
    const double size = product(a + b, a + b);
    const double error = product(16 * unit_roundoff<double>, away2 + size) + underflow;
    if (std::abs(away2 - reach2) > error) [[likely]]
        return away2 > reach2 ? 1 : -1;
    ExactSum sum;
    for (int k = 0; k < D; ++k) sum.add(p[k], p[k]).subtract(2, p[k], q[k]).add(q[k], q[k]);
    return sum.subtract(a, a).subtract(b, b).subtract(product(2.0, sign), a, b).sign();
}
/// By how much the exact squared distance of a primitive within a radius exceeds the radius squared at most:
/// a share of it, and what is lost where it underflows. Both the rounding of the distance and the rule of
/// radii are in it.
template <class T>
inline constexpr double distances_round = std::is_same_v<T, float> ? 0x1p-20 : 0x1p-46;
template <class T>
inline constexpr double distances_underflow = static_cast<double>(4 * std::numeric_limits<T>::denorm_min());

/// The distance from the center beyond which nothing overlaps the ball, as distances round.
template <class T, int D>
double reach(const Sphere<T, D>& ball) {
    const double r = static_cast<double>(ball.radius);
    // The root of the underflow, below 2^-73 and 2^-535.
    constexpr double least = std::is_same_v<T, float> ? 0x1p-73 : 0x1p-535;
    return r + product(r, distances_round<T>) + least;
}
/// Whether a shape has a point within the ball, by its distance from the center.
template <class T, int D, class Shape>
bool reaches(const Sphere<T, D>& ball, const Shape& shape) {
    return within_radius(closest_point(ball.center, shape).distance2, ball.radius);
}
}  // namespace detail

/// True for a negative radius too, and for a center that is not finite.
template <class T, int D>
bool is_empty(const Sphere<T, D>& region) {
    return !(region.radius >= 0) || !finite(region.center);
}
/// Outside boxes are farther away than the distance of any primitive in them may be rounded. Inside boxes
/// have their farthest corner in the ball, by more than the roundings here and those of distances.
template <class T, class U, int D>
Containment containment(const Sphere<T, D>& region, const Box<U, D>& box) {
    const Vec<double, D> c(region.center), low(box.low), high(box.high);
    const double r = static_cast<double>(region.radius), r2 = product(r, r);
    double least2 = 0, most2 = 0;
    for (int k = 0; k < D; ++k) {
        const double below = low[k] - c[k], above = c[k] - high[k];
        const double out = std::max(0.0, std::max(below, above));
        const double far = std::max(std::abs(below), std::abs(above));
        least2 += product(out, out), most2 += product(far, far);
    }
    if (least2 > r2 + product(r2, detail::distances_round<T>) + detail::distances_underflow<T>)
        return Containment::outside;
    const bool inside = most2 < std::numeric_limits<double>::infinity() &&
                        most2 + product(most2, 0x1p-40) + detail::distances_underflow<T> <= r2;
    return inside ? Containment::inside : Containment::across;
}
template <class T, int D>
Box<double, D> bounds_in(const Sphere<T, D>& region, const Box<double, D>& box, double margin) {
    const Sphere<double, D> ball{Vec<double, D>(region.center), detail::reach(region) + margin};
    return intersection(ball.bounds(), box);
}
template <class T, int D>
Extent extent(const Sphere<T, D>& region, const Vec<double, D>& normal) {
    const Vec<double, D> c(region.center);
    const double middle = dot(normal, c);
    const double wide = product(length(normal), detail::reach(region));
    const double error = product(16 * unit_roundoff<double>, dot(abs(normal), abs(c)) + wide) + 0x1p-500;
    return {middle - wide - error, middle + wide + error};
}

template <class T, int D>
bool lies_in(const Vec<T, D>& p, const Sphere<T, D>& region) {
    return detail::reaches(region, p);
}
template <class T, int D>
bool lies_in(const Triangle<T, D>& t, const Sphere<T, D>& region) {
    return lies_in(t.a, region) && lies_in(t.b, region) && lies_in(t.c, region) && detail::reaches(region, t);
}
template <class T, int D>
bool lies_in(const Segment<T, D>& s, const Sphere<T, D>& region) {
    return lies_in(s.a, region) && lies_in(s.b, region) && detail::reaches(region, s);
}
template <class T, int D>
bool lies_in(const Sphere<T, D>& s, const Sphere<T, D>& region) {
    return s.radius <= region.radius &&
           detail::compare_distance(Vec<double, D>(s.center), Vec<double, D>(region.center),
                                    static_cast<double>(region.radius), static_cast<double>(s.radius),
                                    -1) <= 0;
}
template <class T, int D>
bool overlap(const Sphere<T, D>& s, const Sphere<T, D>& region) {
    return detail::compare_distance(Vec<double, D>(s.center), Vec<double, D>(region.center),
                                    static_cast<double>(region.radius), static_cast<double>(s.radius),
                                    1) <= 0 ||
           detail::reaches(region, s);
}
template <class T, int D>
bool overlap(const Triangle<T, D>& t, const Sphere<T, D>& region) {
    return detail::reaches(region, t);
}
template <class T, int D>
bool overlap(const Segment<T, D>& s, const Sphere<T, D>& region) {
    return detail::reaches(region, s);
}

}  // namespace hedgerow
