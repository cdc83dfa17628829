/// Checks brute force by rational arithmetic.
#pragma once

#include "../rational.h"
#include "shapes.h"

namespace hedgerow::hunter {

using rational::Number;
using rational::Point;

inline Point operator-(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Point moved(const Point& a, const Point& by, const Number& times) {
    return {a[0] + by[0] * times, a[1] + by[1] * times, a[2] + by[2] * times};
}
inline Number dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline Number distance2(const Point& p, const Point& a, const Point& b) {
    const Point ab = b - a, ap = p - a;
    const Number l = dot(ab, ab);
    Number u = l == 0 ? Number(0) : Number(dot(ap, ab) / l);
    if (u < 0) u = 0;
    if (u > 1) u = 1;
    const Point away = ap - Point{ab[0] * u, ab[1] * u, ab[2] * u};
    return dot(away, away);
}
/// The squared distance to a triangle: to its plane if the foot is inside, else to the nearest edge.
inline Number distance2(const Point& p, const std::array<Point, 3>& t) {
    const Point n = cross(t[1] - t[0], t[2] - t[0]);
    const Number area = dot(n, n);
    bool inside = area != 0;
    for (std::size_t i = 0; i < 3 && inside; ++i)
        inside = dot(cross(t[(i + 1) % 3] - t[i], p - t[i]), n) >= 0;
    if (inside) {
        const Number height = dot(p - t[0], n);
        return height * height / area;
    }
    return std::min({distance2(p, t[0], t[1]), distance2(p, t[1], t[2]), distance2(p, t[2], t[0])});
}

template <class T>
Number distance2(const Vec<T, 3>& p, const Triangle<T, 3>& t) {
    return distance2(rational::point(p), {rational::point(t.a), rational::point(t.b), rational::point(t.c)});
}
template <class T>
Number distance2(const Vec<T, 2>& p, const Segment<T, 2>& s) {
    return distance2(rational::point(p), rational::point(s.a), rational::point(s.b));
}
template <class T, int D>
Number distance2(const Vec<T, D>& p, const Vec<T, D>& q) {
    const Point away = rational::point(p) - rational::point(q);
    return dot(away, away);
}

/// The bound e of the numerics contract: the most that a hit may be off its primitive, along each axis.
template <class T, int D>
double hit_error(const Ray<T, D>& ray, const Box<T, D>& box) {
    double reach = 0, from = 0;
    for (int k = 0; k < D; ++k) {
        const double o = static_cast<double>(ray.origin[k]);
        from = std::max(from, std::abs(o));
        reach = std::max({reach, std::abs(static_cast<double>(box.low[k]) - o),
                          std::abs(static_cast<double>(box.high[k]) - o)});
    }
    return static_cast<double>(unit_roundoff<T>) * (16 * reach + 4 * from) +
           64 * static_cast<double>(std::numeric_limits<T>::denorm_min());
}

/// The t at which the line of a ray crosses a triangle. Empty if the line misses it, runs along it or meets
/// the line through an edge.
inline std::optional<Number> crossing(const Point& origin, const Point& direction,
                                      const std::array<Point, 3>& t) {
    std::array<Point, 3> corner;
    for (std::size_t i = 0; i < 3; ++i) corner[i] = t[i] - origin;
    int sign = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const int side = sgn(dot(direction, cross(corner[i], corner[(i + 1) % 3])));
        if (side == 0 || (sign != 0 && side != sign)) return std::nullopt;
        sign = side;
    }
    const Point n = cross(corner[1] - corner[0], corner[2] - corner[0]);
    return Number(dot(corner[0], n) / dot(direction, n));
}

/// Describes what is wrong with a triangle's hit, or with the lack of one. Empty if nothing is. A hit lies
/// within e of the triangle. A triangle is hit if all lines within e of the ray's line cross it well inside
/// the interval.
template <class T>
std::string wrong(const Triangle<T, 3>& tri, const Ray<T, 3>& ray, const std::optional<T>& t) {
    const double e = hit_error(ray, tri.bounds());
    const std::array<Point, 3> corners{rational::point(tri.a), rational::point(tri.b),
                                       rational::point(tri.c)};
    const Point origin = rational::point(ray.origin), direction = rational::point(ray.direction);
    // Allow a hit to be off by twice the bound along each axis.
    if (t) {
        const Number away2 = distance2(moved(origin, direction, static_cast<double>(*t)), corners);
        // t may be off by the least subnormal number. A step of that along a long direction is no error of
        // the hit.
        const double step = static_cast<double>(max_component(abs(ray.direction))) *
                            static_cast<double>(std::numeric_limits<T>::denorm_min());
        const Number most = 2 * (e + step);
        return away2 <= 3 * most * most ? "" : "a hit lies farther from its triangle than the bound allows";
    }
    // A hit beyond the largest T has no t.
    const double last = static_cast<double>(std::min(ray.t_max, std::numeric_limits<T>::max()));
    // A miss is right unless the line, and the line moved by 4e both ways along each axis, all cross well
    // inside.
    for (int i = -1; i < 6; ++i) {
        Point from = origin;
        if (i >= 0) from[static_cast<std::size_t>(i / 2)] += Number(4 * e) * (i % 2 == 0 ? 1 : -1);
        const auto at = crossing(from, direction, corners);
        if (!at || *at * (1 - 0x1p-20) < static_cast<double>(ray.t_min) || *at * (1 + 0x1p-20) > last)
            return "";
    }
    return "a triangle that the ray crosses well inside is not hit";
}

/// Whether the library is right about a shape's overlap with a box, or a triangle's hit by a ray.
template <class Shape, class T, int D>
bool is_exact(const Shape& shape, const Box<T, D>& box) {
    return overlap(shape, box) == rational::overlap(shape, box);
}
template <class T>
bool is_exact(const Triangle<T, 3>& tri, const Ray<T, 3>& ray) {
    const auto meeting = meet_watertight(ray, tri);
    const bool hit = meeting && std::isfinite(meeting->t);  // queries report only finite t
    return wrong(tri, ray, hit ? std::optional(meeting->t) : std::nullopt).empty();
}

}  // namespace hedgerow::hunter
