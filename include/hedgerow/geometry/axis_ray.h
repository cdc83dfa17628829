/// Crossings of a ray along an axis with triangles in space, or segments in the plane: exact signs, and a
/// half-open rule, by which a closed surface is crossed as often inward as outward wherever the ray passes
/// through edges and vertices.
#pragma once

#include <hedgerow/geometry/triangles_meet.h>

namespace hedgerow {

/// A ray from a point along an axis, up (direction 1) or down (−1).
template <int D>
struct AxisRay {
    Vec<double, D> origin;
    int axis = 0, direction = 1;

    /// The axes of the plane across the ray. The triple (axis, u, v) is right-handed.
    int u() const { return after[axis]; }
    int v() const { return after[u()]; }

private:
    static constexpr int after[] = {1, D == 3 ? 2 : 0, 0};
};

/// What a primitive is to a ray. `sign` is 1 where the ray leaves through the primitive's back towards its
/// front, −1 where it goes the other way, 0 where it passes by. `on` says that the origin lies in the closed
/// primitive; `sign` is then 0.
struct AxisCrossing {
    int sign = 0;
    bool on = false;
};

/// The side of the line through p and q on which the ray passes, seen against its axis: `turn` of p, q and
/// the origin. A ray through the line counts as moved by ε along u and by ε² along v (Edelsbrunner and Mücke
/// 1990, for one point), so every ray passes on one side of every edge that is not parallel to it. The sign
/// of (q, p) is minus that of (p, q). 0 for an edge that is parallel to the ray.
inline int half_open_turn(const Vec3d& p, const Vec3d& q, const AxisRay<3>& ray, int turned) {
    if (turned != 0) return turned;
    const int u = ray.u(), v = ray.v();
    if (p[v] != q[v]) return p[v] > q[v] ? 1 : -1;
    return p[u] == q[u] ? 0 : (q[u] > p[u] ? 1 : -1);
}
inline int half_open_turn(const Vec3d& p, const Vec3d& q, const AxisRay<3>& ray) {
    return half_open_turn(p, q, ray, turn(p, q, ray.origin, ray.u(), ray.v()));
}

/// The crossing of a ray and a triangle. Exact for all finite coordinates; a triangle without area is never
/// crossed, but the origin may be on it.
inline AxisCrossing crossing(const AxisRay<3>& ray, const std::array<Vec3d, 3>& t) {
    const Vec3d& x = ray.origin;
    const auto& [a, b, c] = t;
    const int u = ray.u(), v = ray.v();
    const int ab = turn(a, b, x, u, v), bc = turn(b, c, x, u, v);
    if (ab * bc < 0) return {};
    const int ca = turn(c, a, x, u, v);
    if (ab * ca < 0 || bc * ca < 0) return {};
    const int facing = ab != 0 ? ab : (bc != 0 ? bc : ca);
    if (facing == 0) {
        // The triangle is edge-on.
        const bool around = Box3d().expand(a).expand(b).expand(c).contains(x);
        return {0, around && triangles_meet(Triangle<double, 3>{x, x, x}, Triangle<double, 3>{a, b, c})};
    }
    // The line of the ray meets the closed triangle. Find where: before, at or beyond the origin.
    const auto height = [&](const Vec3d& p) { return (p[ray.axis] - x[ray.axis]) * ray.direction; };
    if (!(height(a) > 0 && height(b) > 0 && height(c) > 0)) {
        const int of_plane = side(a, b, c, x);
        if (of_plane == 0) return {0, true};
        if (of_plane == facing * ray.direction) return {};
    }
    const bool crosses = half_open_turn(a, b, ray, ab) == facing && half_open_turn(b, c, ray, bc) == facing &&
                         half_open_turn(c, a, ray, ca) == facing;
    return {crosses ? facing * ray.direction : 0};
}
/// The crossing of a ray and a segment in the plane, whose front is to the right of the way from a to b: a
/// counterclockwise loop has its inside behind it. The ray counts as moved by ε along the other axis.
inline AxisCrossing crossing(const AxisRay<2>& ray, const std::array<Vec2d, 2>& s) {
    const Vec2d& x = ray.origin;
    const auto& [a, b] = s;
    const int u = ray.u();
    const int turned = turn(a, b, x, 0, 1);
    if (turned == 0 && Box2d().expand(a).expand(b).contains(x)) return {0, true};
    const bool a_below = a[u] <= x[u], b_below = b[u] <= x[u];
    if (a_below == b_below) return {};
    // Along the first axis a segment that goes up has its front ahead; along the second one that goes down.
    const int sign = (a_below == (ray.axis == 0) ? 1 : -1) * ray.direction;
    return {turned == sign ? sign : 0};
}

}  // namespace hedgerow
