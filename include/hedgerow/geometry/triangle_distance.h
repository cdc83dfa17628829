/// How far two triangles in space are apart, and where.
#pragma once

#include <hedgerow/geometry/distance.h>
#include <hedgerow/geometry/triangles_meet.h>

namespace hedgerow {

/// The closest points of two shapes, and their squared distance. The distance is that of the shapes as they
/// are given: it is computed in double and rounded once. The points are rounded to T.
template <std::floating_point T, int D>
struct Gap {
    T distance2;
    Vec<T, D> a, b;
};

template <class T, int D>
T distance2(const Box<T, D>& a, const Box<T, D>& b) {
    Vec<T, D> apart;
    for (int k = 0; k < D; ++k) apart[k] = std::max({a.low[k] - b.high[k], b.low[k] - a.high[k], T(0)});
    return length2(apart);
}

namespace detail {

/// Corner i of a triangle; the last is followed by the first.
template <class T>
const Vec<T, 3>& corner(const Triangle<T, 3>& t, int i) {
    return i == 0 ? t.a : i == 1 ? t.b : t.c;
}

/// The feet of the common perpendicular of two edges, if both feet are inside of the edges. Solves for the
/// foot on the first edge and projects it to the second and back, so that each errs by the square of what the
/// solution errs by. Where the edges are almost parallel the solution is of no use, but then an end of one is
/// as close. Vectors are scaled.
inline bool edge_feet(const Vec3d& along_a, const Vec3d& along_b, const Vec3d& between, double& u,
                      double& v) {
    const double aa = length2(along_a), bb = length2(along_b), ab = dot(along_a, along_b);
    const double a = dot(along_a, between), b = dot(along_b, between);
    const double area2 = product(aa, bb) - product(ab, ab);
    if (!(area2 > 0)) return false;
    u = (product(ab, b) - product(bb, a)) / area2;
    if (!(u > 0 && u < 1)) return false;
    v = (b + product(ab, u)) / bb;
    if (!(v > 0 && v < 1)) return false;
    u = (product(ab, v) - a) / aa;
    return u > 0 && u < 1;
}

/// A point of both of two triangles that meet: where an edge of one pierces the other, or a corner on it.
/// `closest` is what their corners and edges have to offer.
inline Vec3d common_point(const Triangle<double, 3>& a, const Triangle<double, 3>& b,
                          const Gap<double, 3>& closest) {
    Vec3d best = closest.a;
    double least = closest.distance2;
    const auto try_edges = [&](const Triangle<double, 3>& edges, const Triangle<double, 3>& face) {
        const double scale =
            safe_scale<double>(face.b - face.a, face.c - face.a, edges.a - face.a, edges.b - face.a);
        const Vec3d normal = cross((face.b - face.a) * scale, (face.c - face.a) * scale);
        for (int i = 0; i < 3; ++i) {
            const Vec3d &p = corner(edges, i), &q = corner(edges, (i + 1) % 3);
            const double from = dot(normal, (p - face.a) * scale), to = dot(normal, (q - face.a) * scale);
            if (!(from > 0 && to < 0) && !(from < 0 && to > 0)) continue;
            const Vec3d x = p + (q - p) * (from / (from - to));
            const double d2 = closest_point(x, face).distance2;
            if (d2 < least) least = d2, best = x;
        }
    };
    try_edges(a, b);
    try_edges(b, a);
    return best;
}

/// The closest pair among a corner of one and a point of the other, and among points of two edges.
inline Gap<double, 3> closest_features(const Triangle<double, 3>& a, const Triangle<double, 3>& b) {
    Gap<double, 3> best{std::numeric_limits<double>::infinity(), a.a, b.a};
    const auto offer = [&](double d2, const Vec3d& p, const Vec3d& q) {
        if (d2 < best.distance2) best = {d2, p, q};
    };
    for (int i = 0; i < 3; ++i) {
        const auto on_b = closest_point(corner(a, i), b);
        offer(on_b.distance2, corner(a, i), on_b.point);
        const auto on_a = closest_point(corner(b, i), a);
        offer(on_a.distance2, on_a.point, corner(b, i));
    }
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const Vec3d &p = corner(a, i), &q = corner(b, j);
            const Vec3d whole_a = corner(a, (i + 1) % 3) - p, whole_b = corner(b, (j + 1) % 3) - q;
            const double scale = safe_scale<double>(whole_a, whole_b, p - q);
            const Vec3d along_a = whole_a * scale, along_b = whole_b * scale, between = (p - q) * scale;
            double u, v;
            if (!edge_feet(along_a, along_b, between, u, v)) continue;
            const Vec3d apart = between + (along_a * u - along_b * v);
            offer(length2(apart) / scale / scale, p + whole_a * u, q + whole_b * v);
        }
    return best;
}

}  // namespace detail

/// The closest points of two triangles: of a corner and a face, or of two edges. Triangles that meet are at
/// distance 0 exactly (triangles_meet), and both points are then one point of both, but for its rounding. Any
/// other distance is more than 0, at least the least number that T has. It errs by some roundings of double,
/// of the distance plus the longest edge (closest_point, of a point and a triangle); it is never less than
/// that of the triangles' boxes.
template <class T>
Gap<T, 3> closest_points(const Triangle<T, 3>& a, const Triangle<T, 3>& b) {
    const Triangle<double, 3> p{Vec3d(a.a), Vec3d(a.b), Vec3d(a.c)}, q{Vec3d(b.a), Vec3d(b.b), Vec3d(b.c)};
    const auto gap = detail::closest_features(p, q);
    if (triangles_meet(p, q)) {
        const auto both = intersection(a.bounds(), b.bounds());
        const auto x = clamped(Vec<T, 3>(detail::common_point(p, q, gap)), both);
        return {T(0), x, x};
    }
    const T d2 = rounded_to<T>(std::max(gap.distance2, distance2(p.bounds(), q.bounds())));
    return {std::max(d2, std::numeric_limits<T>::denorm_min()), clamped(Vec<T, 3>(gap.a), a.bounds()),
            clamped(Vec<T, 3>(gap.b), b.bounds())};
}

}  // namespace hedgerow
