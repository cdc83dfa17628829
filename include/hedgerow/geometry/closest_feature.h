/// Which part of a triangle, or of a segment in the plane, is closest to a point: its inside, a side or a
/// corner.
#pragma once

#include <array>

#include <hedgerow/geometry/distance.h>

namespace hedgerow {

/// The part of a primitive that is closest to a point: corner 0, 1 or 2; for triangles the side from corner
/// 0, 1 or 2 to the next (3, 4, 5); or the primitive's inside (−1). `foot` is the closest point, if it is on
/// a corner or a side.
template <int D>
struct ClosestFeature {
    int number;
    Vec<double, D> foot;
};

/// T is the type that the coordinates had: floats need no scaling.
template <std::floating_point T = double>
ClosestFeature<2> closest_feature(const Vec2d& p, const std::array<Vec2d, 2>& s) {
    const double scale = detail::safe_scale<T>(s[1] - s[0], p - s[0]);
    const Vec2d foot = detail::foot_on_segment(p, s[0], s[1], scale).point;
    return {foot == s[0] ? 0 : (foot == s[1] ? 1 : -1), foot};
}
template <std::floating_point T = double>
ClosestFeature<3> closest_feature(const Vec3d& p, const std::array<Vec3d, 3>& t) {
    const double scale = detail::safe_scale<T>(t[1] - t[0], t[2] - t[0], p - t[0]);
    const Vec3d normal = cross((t[1] - t[0]) * scale, (t[2] - t[0]) * scale);
    const auto beside = [&](std::size_t i) {
        return dot(cross(normal, (t[(i + 1) % 3] - t[i]) * scale), (p - t[i]) * scale);
    };
    if (beside(0) > 0 && beside(1) > 0 && beside(2) > 0) return {-1, p};
    ClosestFeature<3> closest{-1, t[0]};
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t next = (i + 1) % 3;
        const auto foot = detail::foot_on_segment(p, t[i], t[next], scale);
        if (!(foot.distance2 < least)) continue;
        least = foot.distance2;
        const std::size_t number = foot.point == t[i] ? i : (foot.point == t[next] ? next : 3 + i);
        closest = {static_cast<int>(number), foot.point};
    }
    return closest;
}

}  // namespace hedgerow
