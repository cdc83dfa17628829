/// Ray intersection tests: triangle (by the three usual methods), sphere, segment, box.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>

#include <hedgerow/geometry/exact_sum.h>
#include <hedgerow/geometry/ray.h>
#include <hedgerow/geometry/shapes.h>

namespace hedgerow {

/// An intersection of a ray and a surface: the ray's parameter t, and coordinates u, v on the surface. On a
/// triangle the point is (1 − u − v)·a + u·b + v·c; on a segment a + u·(b − a); on a sphere u and v are 0.
template <std::floating_point T>
struct Meeting {
    T t, u, v;
    friend constexpr bool operator==(const Meeting&, const Meeting&) = default;
};

/// The part of a ray or line inside a box or other volume, from `entry` to `exit`. Empty if entry > exit.
template <std::floating_point T>
struct Interval {
    T entry, exit;
};

/// Ray-box test by slabs (Kay and Kajiya 1986). Returns the part of the ray's own interval inside the box. A
/// flat box can be hit. A ray parallel to a slab is inside it or not, so 0·∞ is never computed. This is the
/// plain form, in the working precision; structures use the conservative RayProbe::enter.
template <class T, int D>
constexpr std::optional<Interval<T>> meet(const Ray<T, D>& ray, const Box<T, D>& box) {
    Interval<T> in{ray.t_min, ray.t_max};
    for (int i = 0; i < D; ++i) {
        if (ray.direction[i] == 0) {
            if (!(box.low[i] <= ray.origin[i] && ray.origin[i] <= box.high[i])) return std::nullopt;
            continue;
        }
        const bool down = ray.direction[i] < 0;
        const T near = ((down ? box.high[i] : box.low[i]) - ray.origin[i]) / ray.direction[i];
        const T far = ((down ? box.low[i] : box.high[i]) - ray.origin[i]) / ray.direction[i];
        in.entry = near > in.entry ? near : in.entry;
        in.exit = far < in.exit ? far : in.exit;
    }
    if (!(in.entry <= in.exit)) return std::nullopt;
    return in;
}

/// Ray-triangle test, first method: intersects the triangle's plane, then tests whether the point is on the
/// inner side of the three edges. Easy to read, but leaks where edges meet.
template <class T>
constexpr std::optional<Meeting<T>> meet_by_plane(const Ray<T, 3>& ray, const Triangle<T, 3>& tri) {
    const Vec<T, 3> n = tri.normal();
    const T approach = dot(n, ray.direction);
    if (approach == 0) return std::nullopt;
    const T t = dot(n, tri.a - ray.origin) / approach;
    if (!(ray.t_min <= t && t <= ray.t_max)) return std::nullopt;
    const Vec<T, 3> p = ray.at(t);
    const T w = dot(n, cross(tri.c - tri.b, p - tri.b));
    const T u = dot(n, cross(tri.a - tri.c, p - tri.c));
    const T v = dot(n, cross(tri.b - tri.a, p - tri.a));
    if (w < 0 || u < 0 || v < 0) return std::nullopt;
    const T area = length2(n);
    return Meeting<T>{t, u / area, v / area};
}

/// Ray-triangle test, second method (Möller and Trumbore 1997): takes the triangle as the affine image of the
/// unit triangle, and solves for (t, u, v) by Cramer's rule. Fast, but still leaks at edges.
template <class T>
constexpr std::optional<Meeting<T>> meet_by_barycentrics(const Ray<T, 3>& ray, const Triangle<T, 3>& tri) {
    const Vec<T, 3> e1 = tri.b - tri.a;
    const Vec<T, 3> e2 = tri.c - tri.a;
    const Vec<T, 3> p = cross(ray.direction, e2);
    const T det = dot(e1, p);
    if (det == 0) return std::nullopt;
    const Vec<T, 3> s = ray.origin - tri.a;
    const T u = dot(s, p) / det;
    if (!(u >= 0 && u <= 1)) return std::nullopt;
    const Vec<T, 3> q = cross(s, e1);
    const T v = dot(ray.direction, q) / det;
    if (!(v >= 0 && u + v <= 1)) return std::nullopt;
    const T t = dot(e2, q) / det;
    if (!(ray.t_min <= t && t <= ray.t_max)) return std::nullopt;
    return Meeting<T>{t, u, v};
}

/// Ray-triangle test, third method and the default: watertight (Woop, Benthin, Wald, JCGT 2013). Space is
/// sheared so that the ray runs along its longest axis. Then only the signs of three 2D edge functions
/// matter, and two triangles that share an edge compute the same number for it, with opposite signs.
template <std::floating_point T>
struct WatertightRay {
    Vec<T, 3> origin;
    int kx, ky, kz;
    T shear_x, shear_y;
    T direction_z;

    constexpr WatertightRay() = default;
    explicit constexpr WatertightRay(const Vec<T, 3>& o, const Vec<T, 3>& d) : origin(o) {
        kz = max_axis(d);
        kx = (kz + 1) % 3;
        ky = (kx + 1) % 3;
        shear_x = d[kx] / d[kz];
        shear_y = d[ky] / d[kz];
        direction_z = d[kz];
    }
};

/// A triangle's corner in the sheared space of a ray.
template <std::floating_point T>
struct ShearedCorner {
    T x, y, z;
};

template <class T>
constexpr ShearedCorner<T> shear(const WatertightRay<T>& ray, const Vec<T, 3>& corner) {
    const T x = corner[ray.kx] - ray.origin[ray.kx];
    const T y = corner[ray.ky] - ray.origin[ray.ky];
    const T z = corner[ray.kz] - ray.origin[ray.kz];
    return {x - product(ray.shear_x, z), y - product(ray.shear_y, z), z};
}

namespace detail {
/// Powers of two that scale the corners to about 1, one for each axis: a triangle may be 10³⁰⁰ times as long
/// as it is wide.
struct ShearedScale {
    double x = 1, y = 1;
};
constexpr ShearedScale scale_of(const ShearedCorner<float>&, const ShearedCorner<float>&,
                                const ShearedCorner<float>&) {
    return {};  // products of floats are exact in double without scaling
}
inline ShearedScale scale_of(const ShearedCorner<double>& a, const ShearedCorner<double>& b,
                             const ShearedCorner<double>& c) {
    const auto largest = [](double p, double q, double r) {
        return std::max({std::fabs(p), std::fabs(q), std::fabs(r)});
    };
    return {scale_to_one(largest(a.x, b.x, c.x)), scale_to_one(largest(a.y, b.y, c.y))};
}

/// The edge function p.x·q.y − p.y·q.x, exact in sign.
constexpr double edge(const ShearedCorner<float>& p, const ShearedCorner<float>& q, const ShearedScale&) {
    return product(double(p.x), double(q.y)) - product(double(p.y), double(q.x));
}
/// The edge function where the scaled products may underflow: the sign of the exact value, and a magnitude of
/// at least the smallest subnormal.
[[gnu::noinline]] inline double tiny_edge(const ShearedCorner<double>& p, const ShearedCorner<double>& q,
                                          double value) {
    if ((p.x == 0 || q.y == 0) && (p.y == 0 || q.x == 0)) return 0;  // common: both products are 0
    const int sign = ExactSum().add(p.x, q.y).subtract(p.y, q.x).sign();
    return sign * std::max(std::fabs(value), std::numeric_limits<double>::denorm_min());
}
inline double edge(const ShearedCorner<double>& p, const ShearedCorner<double>& q, const ShearedScale& s) {
    const double value = difference_of_products(p.x * s.x, q.y * s.y, p.y * s.y, q.x * s.x);
    return std::fabs(value) > 0x1p-900 ? value : tiny_edge(p, q, value);
}
}  // namespace detail

/// First pass of the watertight test, a filter: the edge function in the working precision, of numbers or of
/// lanes. A rounded difference of rounded products has the right sign or is 0.
template <class N>
constexpr N edge_filter(const N& px, const N& py, const N& qx, const N& qy) {
    return product(px, qy) - product(py, qx);
}

/// Second pass of the watertight test: computes U, V, W again with exact signs, then t, u, v with real
/// divisions, always in this order. Every path to a hit (scalar, lanes, any instruction set) ends here, so
/// all paths give the same bits. Does not check t against an interval. For the remaining error see RayProbe.
template <class T>
std::optional<Meeting<T>> meet_exactly(const WatertightRay<T>& ray, const ShearedCorner<T>& a,
                                       const ShearedCorner<T>& b, const ShearedCorner<T>& c) {
    const auto scale = detail::scale_of(a, b, c);
    const double u = detail::edge(c, b, scale);
    const double v = detail::edge(a, c, scale);
    const double w = detail::edge(b, a, scale);
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return std::nullopt;
    const double det = u + v + w;
    if (det == 0) return std::nullopt;  // the triangle is seen edge-on or has no area
    const double wa = u / det, wb = v / det, wc = w / det;
    const double z = (product(wa, double(a.z)) + product(wb, double(b.z))) + product(wc, double(c.z));
    return Meeting<T>{rounded_to<T>(z / double(ray.direction_z)), rounded_to<T>(wb), rounded_to<T>(wc)};
}

/// The watertight test for any t.
template <class T>
std::optional<Meeting<T>> meet(const WatertightRay<T>& ray, const Triangle<T, 3>& tri) {
    const auto a = shear(ray, tri.a), b = shear(ray, tri.b), c = shear(ray, tri.c);
    const T u = edge_filter(c.x, c.y, b.x, b.y);
    const T v = edge_filter(a.x, a.y, c.x, c.y);
    const T w = edge_filter(b.x, b.y, a.x, a.y);
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return std::nullopt;
    return meet_exactly(ray, a, b, c);
}

template <class T>
std::optional<Meeting<T>> meet_watertight(const Ray<T, 3>& ray, const Triangle<T, 3>& tri) {
    const auto m = meet(WatertightRay<T>(ray.origin, ray.direction), tri);
    if (!m || !(ray.t_min <= m->t && m->t <= ray.t_max)) return std::nullopt;
    return m;
}

/// The two intersections of a ray's line with a sphere's surface, in double; the caller takes the first one
/// inside its interval. The discriminant is computed from the line's point closest to the center, which stays
/// accurate for far origins (Haines et al., Ray Tracing Gems 2019, ch. 7).
template <class T, int D>
std::optional<Interval<T>> meet_line(const Vec<T, D>& origin, const Vec<T, D>& direction,
                                     const Sphere<T, D>& s) {
    if (!(s.radius > 0)) return std::nullopt;
    const double unit = 1 / static_cast<double>(max_component(abs(direction)));
    const Vec<double, D> d = Vec<double, D>(direction) * unit;
    const Vec<double, D> f = Vec<double, D>(origin) - Vec<double, D>(s.center);
    const double r = static_cast<double>(s.radius);
    const double a = length2(d);
    const double b = -dot(f, d);
    const Vec<double, D> nearest = f + d * (b / a);
    const double discriminant = product(r, r) - length2(nearest);
    if (discriminant < 0) return std::nullopt;
    const double half = std::sqrt(discriminant / a);
    return Interval<T>{rounded_to<T>((b / a - half) * unit), rounded_to<T>((b / a + half) * unit)};
}

/// Ray-segment test in the plane, for the ray's whole line. The offsets of the ends from the line are
/// computed in T, each from its end alone, and their signs decide; u and t follow in double. A segment that
/// lies along the ray is not hit, like a triangle seen edge-on.
template <class T>
std::optional<Meeting<T>> meet_line(const Vec<T, 2>& origin, const Vec<T, 2>& direction,
                                    const Segment<T, 2>& s) {
    const int k = max_axis(direction);
    const T slope = direction[1 - k] / direction[k];
    const auto offset = [&](const Vec<T, 2>& p) {
        return p[1 - k] - origin[1 - k] - product(slope, p[k] - origin[k]);
    };
    const double a = static_cast<double>(offset(s.a)), b = static_cast<double>(offset(s.b));
    if ((a < 0 && b < 0) || (a > 0 && b > 0) || a == b) return std::nullopt;
    const double u = a / (a - b);
    const double za = static_cast<double>(s.a[k] - origin[k]), zb = static_cast<double>(s.b[k] - origin[k]);
    const double z = product(1 - u, za) + product(u, zb);
    return Meeting<T>{rounded_to<T>(z / static_cast<double>(direction[k])), rounded_to<T>(u), T(0)};
}

}  // namespace hedgerow
