/// The part of a surface that a pixel sees, over which textures are averaged.
#pragma once

#include <algorithm>
#include <cmath>

#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// A part of a surface around a hit: the ellipse cos(s)·a + sin(s)·b about it, in the world. A part without
/// extent is the point.
struct SurfaceFootprint {
    Vec3d a, b;
};

/// The part of a plane that a narrow cone covers, as if the cone had the width that it has where its axis
/// meets the plane (Akenine-Möller et al., Improved shader and texture level of detail using ray cones, JCGT
/// 2021, section 4). `axis` and `normal` have length 1, and `radius` is the cone's at the plane. Seen from
/// the side, the ellipse is at most 1,000 times as long as it is wide. O(1).
inline SurfaceFootprint footprint_of(const Vec3d& axis, double radius, const Vec3d& normal) {
    const Vec3d flat = cross(normal, axis);
    const double sine = length(flat);
    Vec3d beside;  // any direction across the axis, where it is the normal
    beside[std::abs(normal[0]) < 0.5 ? 0 : 1] = 1;
    const Vec3d b = sine > 0 ? flat / sine : normalized(cross(normal, beside));
    const double foreshortening = std::max(std::abs(dot(axis, normal)), 1e-3);
    return {cross(b, normal) * (radius / foreshortening), b * radius};
}

}  // namespace hedgerow
