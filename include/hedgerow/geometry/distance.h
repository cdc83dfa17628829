/// The point of a shape closest to a given one, and squared distances. Squares are summed in the order of the
/// axes everywhere, so that a bound by a box never exceeds the distance to what is inside it (rounding is
/// monotone, and closest points are clamped into the box of their shape).
#pragma once

#include <hedgerow/geometry/shapes.h>

namespace hedgerow {

template <class T, int D>
constexpr T distance2(const Vec<T, D>& p, const Vec<T, D>& q) {
    return length2(abs(p - q));
}

/// Per axis how far p lies outside the box; 0 inside.
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

template <class T, int D>
Vec<T, D> closest_point(const Vec<T, D>& p, const Segment<T, D>& s) {
    const Vec<double, D> a(s.a), ab = Vec<double, D>(s.b) - a;
    const double l = length2(ab);
    double u = l > 0 ? dot(Vec<double, D>(p) - a, ab) / l : 0;
    u = u < 0 ? 0 : (u > 1 ? 1 : u);
    return clamped(Vec<T, D>(a + ab * u), s.bounds());
}

/// By the seven regions of the triangle's plane (Ericson, Real-Time Collision Detection, 5.1.5), in double.
template <class T, int D>
Vec<T, D> closest_point(const Vec<T, D>& query, const Triangle<T, D>& tri) {
    using V = Vec<double, D>;
    const V p(query), a(tri.a), b(tri.b), c(tri.c);
    const V ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return tri.a;
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return tri.b;
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return tri.c;
    const auto on_edge = [&](const Vec<T, D>& from, const Vec<T, D>& to) {
        return clamped(closest_point(query, Segment<T, D>{from, to}), tri.bounds());
    };
    const double vc = product(d1, d4) - product(d3, d2);
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return on_edge(tri.a, tri.b);
    const double vb = product(d5, d2) - product(d1, d6);
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return on_edge(tri.a, tri.c);
    const double va = product(d3, d6) - product(d5, d4);
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return on_edge(tri.b, tri.c);
    const double sum = va + vb + vc;
    if (!(sum > 0)) {  // no area, and rounding hid it: the best of the edges
        Vec<T, D> best = on_edge(tri.a, tri.b);
        for (const auto& q : {on_edge(tri.a, tri.c), on_edge(tri.b, tri.c)})
            if (distance2(query, q) < distance2(query, best)) best = q;
        return best;
    }
    const V inside = a + ab * (vb / sum) + ac * (vc / sum);
    return clamped(Vec<T, D>(inside), tri.bounds());
}

/// On the surface; for the center itself, the point along the first axis.
template <class T, int D>
Vec<T, D> closest_point(const Vec<T, D>& p, const Sphere<T, D>& s) {
    Vec<double, D> from = Vec<double, D>(p) - Vec<double, D>(s.center);
    double l = length(from);
    if (!(l > 0)) from = {}, from[0] = l = 1;
    return clamped(Vec<T, D>(Vec<double, D>(s.center) + from * (static_cast<double>(s.radius) / l)),
                   s.bounds());
}

}  // namespace hedgerow
