/// Whether two triangles of a mesh intersect, other than neighbours do.
#pragma once

#include <bit>

#include <hedgerow/geometry/triangles_meet.h>

namespace hedgerow {

namespace detail {

/// The corners of two triangles that are equal, as a table: bit 3·i + j is set if corner i of the first is
/// corner j of the second. Corners are equal by position, so that triangles need no common indices.
inline unsigned equal_corners(const Triangle<double, 3>& s, const Triangle<double, 3>& t) {
    const auto row = [&](const Vec3d& p) {
        return static_cast<unsigned>(p == t.a) | static_cast<unsigned>(p == t.b) << 1 |
               static_cast<unsigned>(p == t.c) << 2;
    };
    return row(s.a) | row(s.b) << 3 | row(s.c) << 6;
}

/// Coplanar triangles u, v, p and u, v, q that share the edge uv: they overlap if p and q lie on one side of
/// it.
[[gnu::noinline]] inline bool meet_beyond_edge(const Vec3d& u, const Vec3d& v, const Vec3d& p,
                                               const Vec3d& q) {
    int sign_p, sign_q;
    const int axis = axis_of_area(u, v, p, sign_p);
    if (axis >= 0) return Projection::along(axis).turn(u, v, q) == sign_p;
    if (axis_of_area(u, v, q, sign_q) >= 0) return false;
    // All four are on a line. The triangles are segments; see whether both reach beyond the edge at one end.
    const auto [low, high] = std::minmax(u, v, before);
    return (before(p, low) && before(q, low)) || (before(high, p) && before(high, q));
}

/// A triangle as seen from a corner that it shares: the shared corner, and the other two. A triangle without
/// area is a segment.
struct Fan {
    Vec3d tip, b, c;

    Triangle<double, 3> triangle() const { return {tip, b, c}; }
    /// Whether the direction towards x is in the angle at the tip, edges included. Looks along `axis`, where
    /// the area has the sign `sign`.
    bool holds(const Vec3d& x, int axis, int sign) const {
        const auto plane = Projection::along(axis);
        return plane.turn(tip, b, x) != -sign && plane.turn(tip, x, c) != -sign;
    }
};

/// Fans that meet in more than the common tip, where one has no area. The part of each that is farthest from
/// the tip then meets the other fan: of a triangle the opposite edge, of a segment its ends.
inline bool flat_fans_meet(const Fan& s, const Fan& t) {
    const auto reaches = [](const Fan& from, const Triangle<double, 3>& other) {
        if (has_area(from.triangle())) return triangles_meet({from.b, from.c, from.c}, other);
        const Ends ends(from.triangle());
        return (ends.first != from.tip && triangles_meet({ends.first, ends.first, ends.first}, other)) ||
               (ends.last != from.tip && triangles_meet({ends.last, ends.last, ends.last}, other));
    };
    return reaches(s, t.triangle()) || reaches(t, s.triangle());
}
/// Fans in one plane, or of which one has no area.
[[gnu::noinline]] inline bool coplanar_fans_meet(const Fan& s, const Fan& t) {
    int sign_s, sign_t;
    const int axis = axis_of_area(s.tip, s.b, s.c, sign_s);
    if (axis < 0 || axis_of_area(t.tip, t.b, t.c, sign_t) < 0) return flat_fans_meet(s, t);
    sign_t = Projection::along(axis).turn(t.triangle());
    return s.holds(t.b, axis, sign_s) || s.holds(t.c, axis, sign_s) || t.holds(s.b, axis, sign_t) ||
           t.holds(s.c, axis, sign_t);
}

/// Whether two triangles that share the corner `tip` meet elsewhere too. Their planes meet in a line through
/// the tip. A triangle whose other corners are strictly on one side of the other's plane leaves that line at
/// the tip. Any other follows it to one side, and which, that the signs say: corners b in front and c behind
/// in both triangles follow it to opposite sides.
inline bool meet_beyond_corner(const PlaneOfPoints& plane_of_s, const Fan& s, const Fan& t) {
    const int tb = plane_of_s.side(t.b), tc = plane_of_s.side(t.c);
    if (tb * tc > 0) return false;
    const PlaneOfPoints plane_of_t(t.tip, t.b, t.c);
    const int sb = plane_of_t.side(s.b), sc = plane_of_t.side(s.c);
    if (sb * sc > 0) return false;
    if ((tb == 0 && tc == 0) || (sb == 0 && sc == 0)) return coplanar_fans_meet(s, t);
    const int way_of_s = sb != 0 ? sb : -sc, way_of_t = tb != 0 ? tb : -tc;
    return way_of_s != way_of_t;
}

/// Which corners of a triangle the other triangle has too.
struct SharedCorners {
    const Vec3d* corner[3];
    bool shared[3];
    int count;

    SharedCorners(const Triangle<double, 3>& t, unsigned a, unsigned b, unsigned c)
        : corner{&t.a, &t.b, &t.c}, shared{a != 0, b != 0, c != 0}, count((a != 0) + (b != 0) + (c != 0)) {}

    /// The number of different positions among the shared corners.
    int positions() const {
        int n = 0;
        for (int i = 0; i < 3; ++i) {
            bool repeated = false;
            for (int j = 0; j < i; ++j) repeated |= shared[j] && *corner[i] == *corner[j];
            n += shared[i] && !repeated;
        }
        return n;
    }
    /// The only corner that is not shared.
    const Vec3d& lone() const { return *corner[!shared[0] ? 0 : !shared[1] ? 1 : 2]; }
    /// The triangle as seen from its first corner that is shared, or that is not.
    Fan fan(bool from_shared) const {
        const int i = shared[0] == from_shared ? 0 : shared[1] == from_shared ? 1 : 2;
        return {*corner[i], *corner[(i + 1) % 3], *corner[(i + 2) % 3]};
    }
};

}  // namespace detail

/// Whether two triangles share a point that is neither a corner of both nor on the segment between two
/// corners of both. So neighbours in a mesh do not count, unless they meet beyond the shared corner or edge:
/// folded onto each other, overlapping in a plane, or piercing one another. Two equal triangles count if they
/// have area. Corners are shared by position, not by index: a soup of triangles has the answers of the mesh.
inline bool meet_beyond_shared(const Facet& s, const Triangle<double, 3>& t) {
    const unsigned equal = detail::equal_corners(s, t);
    if (equal == 0) return triangles_meet(s, t);
    const detail::SharedCorners of_s(s, equal & 7u, equal >> 3 & 7u, equal >> 6);
    const detail::SharedCorners of_t(t, equal & 0111u, equal & 0222u, equal & 0444u);
    switch (of_s.positions()) {
        case 1:
            return detail::meet_beyond_corner(s.plane, of_s.fan(true), of_t.fan(true));
        case 2: {
            // With a repeated corner a triangle is the shared edge itself.
            if (of_s.count == 3 || of_t.count == 3) return false;
            const Vec3d& q = of_t.lone();
            if (s.plane.side(q) != 0) [[likely]]
                return false;
            const auto [p, u, v] = of_s.fan(false);
            return detail::meet_beyond_edge(u, v, p, q);
        }
        default:
            return detail::has_area(s);
    }
}
inline bool meet_beyond_shared(const Triangle<double, 3>& s, const Triangle<double, 3>& t) {
    return meet_beyond_shared(Facet(s), t);
}

/// Bit i is set if corner i of t, given by the corners' coordinates by axis, is a corner of s.
template <class T>
unsigned corners_of_both(const Triangle<T, 3>& s, const T (&t)[3][4]) {
    using L = Lanes<T>;
    const L x = L::load(t[0]), y = L::load(t[1]), z = L::load(t[2]);
    const auto apart = [&](const Vec<T, 3>& p) {
        return abs(x - L::all(p[0])) + abs(y - L::all(p[1])) + abs(z - L::all(p[2]));
    };
    return 7u & ~min(min(apart(s.a), apart(s.b)), apart(s.c)).positive();
}

/// Whether it is plain that t, given by its corners' coordinates by axis, meets s at most in corners that
/// both have or in the edge between them: its other corners are surely on one side of the plane of s. So most
/// neighbours are told from others by the signs that a test needs first anyway.
template <class T>
bool plainly_beside(const Triangle<T, 3>& s, const SideFilter<T>& plane, const T (&t)[3][4]) {
    unsigned in_front, behind;
    plane.sure_sides(t, in_front, behind);
    const unsigned sure = in_front | behind;
    // Without branches on single corners, which are not foreseen.
    return ((in_front != 0) != (behind != 0)) && ((sure | corners_of_both(s, t)) & 7u) == 7u;
}

}  // namespace hedgerow
