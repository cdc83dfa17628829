/// Points of a circle, with the same bits on every machine.
#pragma once

#include <cstdint>
#include <vector>

#include <hedgerow/geometry/vec.h>

namespace hedgerow::detail {

/// 8n points of the unit circle, counterclockwise from (1, 0), symmetric to all eight of its axes: one octant
/// by the rational parametrisation (steps differ by up to 17 %), the others mirrored.
std::vector<Vec2d> circle(std::uint64_t n);

}  // namespace hedgerow::detail
