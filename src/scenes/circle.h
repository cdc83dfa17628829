/// Points of a circle, with the same bits on every machine.
#pragma once

#include <cstdint>
#include <vector>

#include <hedgerow/geometry/vec.h>

namespace hedgerow::detail {

/// 8n points of the unit circle, counterclockwise from (1, 0), symmetric in x, in y and in both diagonals.
/// One octant uses the rational parametrisation (steps differ by up to 17 %), and the others mirror it.
std::vector<Vec2d> circle(std::uint64_t n);

}  // namespace hedgerow::detail
