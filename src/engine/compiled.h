/// What the sources of the kernels share and is compiled once for all instruction sets.
#pragma once

#include <hedgerow/engine/kernels.h>
#include <hedgerow/queries/half_angles.h>

namespace hedgerow::detail {

/// `HalfAngles::settled` for the triangle at a place of a block.
HalfAngle settled_half_angle(const HalfAngle& h, double size, const TriangleBlock<float>& block, int place,
                             const Vec<double, 3>& x);

/// `crossing` of the triangle at a place of a block.
template <std::floating_point T>
AxisCrossing crossing_of(const AxisRay<3>& ray, const TriangleBlock<T>& block, int place);

}  // namespace hedgerow::detail
