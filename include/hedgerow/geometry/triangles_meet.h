/// Whether two triangles in space share a point. Sets are closed: touching counts. All signs are exact
/// (orientation.h), so the answers are those of exact arithmetic, for triangles without area too.
#pragma once

#include <algorithm>
#include <iterator>
#include <utility>

#include <hedgerow/geometry/orientation.h>
#include <hedgerow/geometry/shapes.h>

namespace hedgerow {

/// A triangle and its plane, prepared for tests with many others.
struct Facet : Triangle<double, 3> {
    PlaneOfPoints plane;

    explicit Facet(const Triangle<double, 3>& t) : Triangle<double, 3>(t), plane(t.a, t.b, t.c) {}
};

namespace detail {

/// The order of points by x, then y, then z. Along a line it is one of the line's two directions.
inline bool before(const Vec3d& p, const Vec3d& q) {
    return std::lexicographical_compare(std::begin(p.data), std::end(p.data), std::begin(q.data),
                                        std::end(q.data));
}
/// The ends of collinear corners.
struct Ends {
    Vec3d first, last;

    explicit Ends(const Triangle<double, 3>& t)
        : first(std::min({t.a, t.b, t.c}, before)), last(std::max({t.a, t.b, t.c}, before)) {}
};

/// A plane of two axes. In the projection along an axis the other two keep their cyclic order.
struct Projection {
    int u, v;

    static Projection along(int axis) { return {(axis + 1) % 3, (axis + 2) % 3}; }
    int turn(const Vec3d& p, const Vec3d& q, const Vec3d& x) const { return hedgerow::turn(p, q, x, u, v); }
    int turn(const Triangle<double, 3>& t) const { return turn(t.a, t.b, t.c); }
};
/// The axis along which the projection of p, q, x has the area's sign in `sign`; −1 if the three are
/// collinear.
inline int axis_of_area(const Vec3d& p, const Vec3d& q, const Vec3d& x, int& sign) {
    for (int axis = 0; axis < 3; ++axis)
        if ((sign = Projection::along(axis).turn(p, q, x)) != 0) return axis;
    return -1;
}
inline bool has_area(const Triangle<double, 3>& t) {
    int sign;
    return axis_of_area(t.a, t.b, t.c, sign) >= 0;
}

/// Whether an edge of `t` separates it from `other` in the plane: all corners of `other` are strictly outside
/// of the edge's line. A triangle without area is a segment, and both sides of its line are outside.
inline bool edge_separates(const Triangle<double, 3>& t, const Triangle<double, 3>& other, Projection plane) {
    const auto outside = [&](const Vec3d& p, const Vec3d& q, int sign) {
        return plane.turn(p, q, other.a) == -sign && plane.turn(p, q, other.b) == -sign &&
               plane.turn(p, q, other.c) == -sign;
    };
    const int sign = plane.turn(t);
    if (sign != 0) return outside(t.a, t.b, sign) || outside(t.b, t.c, sign) || outside(t.c, t.a, sign);
    const Ends ends(t);
    return outside(ends.first, ends.last, 1) || outside(ends.first, ends.last, -1);
}

/// Whether two triangles in one plane share a point, with area or without. Projects them where the plane is
/// not seen edge-on; there disjoint convex polygons are separated by an edge of one of them. On a line the
/// intervals decide.
inline bool meet_in_plane(const Triangle<double, 3>& s, const Triangle<double, 3>& t) {
    const Vec3d corners[] = {s.a, s.b, s.c, t.a, t.b, t.c};
    int sign;
    for (int i = 1; i < 6; ++i)
        for (int j = i + 1; j < 6; ++j)
            if (const int axis = axis_of_area(corners[0], corners[i], corners[j], sign); axis >= 0) {
                const auto plane = Projection::along(axis);
                return !edge_separates(s, t, plane) && !edge_separates(t, s, plane);
            }
    const Ends p(s), q(t);
    return !before(p.last, q.first) && !before(q.last, p.first);
}

/// Whether a triangle without area, the segment between `ends`, meets one that has area.
inline bool segment_meets(const Ends& ends, const Triangle<double, 3>& t) {
    const Vec3d &p = ends.first, &q = ends.last;
    const int from = side(t.a, t.b, t.c, p), to = side(t.a, t.b, t.c, q);
    if (from * to > 0) return false;
    if (from == 0 && to == 0) return meet_in_plane({p, q, q}, t);
    if (from == 0) return meet_in_plane({p, p, p}, t);
    if (to == 0) return meet_in_plane({q, q, q}, t);
    const int ab = side(p, q, t.a, t.b), bc = side(p, q, t.b, t.c), ca = side(p, q, t.c, t.a);
    return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

/// Whether triangles meet that lie in one plane, or of which one has no area.
[[gnu::noinline]] inline bool flat_triangles_meet(const Triangle<double, 3>& s,
                                                  const Triangle<double, 3>& t) {
    const bool s_has_area = has_area(s), t_has_area = has_area(t);
    if (s_has_area && t_has_area) return meet_in_plane(s, t);
    if (t_has_area) return segment_meets(Ends(s), t);
    if (s_has_area) return segment_meets(Ends(t), s);
    const Ends p(s), q(t);
    return side(p.first, p.last, q.first, q.last) == 0 && meet_in_plane(s, t);
}

/// The sides of a plane on which a triangle's corners lie.
struct Sides {
    int a, b, c;

    Sides(const PlaneOfPoints& plane, const Triangle<double, 3>& t)
        : a(plane.side(t.a)), b(plane.side(t.b)), c(plane.side(t.c)) {}
    bool one_side() const { return a == b && b == c && a != 0; }
    bool in_plane() const { return a == 0 && b == 0 && c == 0; }
};

/// Turns the corners of `t` until the first is alone on its side of a plane. Returns that side. A corner on
/// the plane counts for either side.
inline int put_lone_corner_first(Triangle<double, 3>& t, Sides s) {
    for (int i = 0; i < 3; ++i) {
        if (s.a != 0 && s.a * s.b <= 0 && s.a * s.c <= 0) return s.a;
        if (s.a == 0 && s.b * s.c > 0) return -s.b;
        t = {t.b, t.c, t.a};
        const int first = s.a;
        s.a = s.b, s.b = s.c, s.c = first;
    }
    return 0;  // all corners on the plane or on one side: the caller has excluded both
}

}  // namespace detail

/// Whether two triangles share a point. After Guigue and Devillers (Fast and robust triangle-triangle overlap
/// test using orientation predicates, 2003): unless all corners of one are strictly on one side of the
/// other's plane, both cut the line in which their planes meet, and two more signs say whether the cuts
/// overlap. At most eight signs; those of the first triangle's plane alone reject most pairs.
inline bool triangles_meet(const Facet& s, const Triangle<double, 3>& t) {
    const detail::Sides t_to_s(s.plane, t);
    if (t_to_s.one_side()) return false;
    const detail::Sides s_to_t(PlaneOfPoints(t.a, t.b, t.c), s);
    if (s_to_t.one_side()) return false;
    if (t_to_s.in_plane() || s_to_t.in_plane()) return detail::flat_triangles_meet(s, t);
    // Turn both triangles so that their first corner is alone, and in front of the other's plane.
    Triangle<double, 3> p = s, q = t;
    const int side_of_p = detail::put_lone_corner_first(p, s_to_t);
    const int side_of_q = detail::put_lone_corner_first(q, t_to_s);
    if (side_of_p < 0) std::swap(q.b, q.c);
    if (side_of_q < 0) std::swap(p.b, p.c);
    return side(p.a, p.b, q.a, q.b) <= 0 && side(p.a, p.c, q.c, q.a) <= 0;
}
inline bool triangles_meet(const Triangle<double, 3>& s, const Triangle<double, 3>& t) {
    return triangles_meet(Facet(s), t);
}

}  // namespace hedgerow
