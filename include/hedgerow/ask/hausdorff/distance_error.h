/// What distances of closest points err by.
#pragma once

#include <algorithm>
#include <concepts>

#include <hedgerow/geometry/rounding.h>

namespace hedgerow::detail {

/// What the distances of closest points err by: a part of the distance, and a length that stands for what
/// sums of coordinates up to `reach` and underflow cost. `rounding` is that of a point.
template <std::floating_point T>
struct DistanceError {
    static constexpr double relative = std::is_same_v<T, float> ? 0x1p-22 : 0x1p-48;
    double absolute, rounding;

    explicit DistanceError(double reach)
        : absolute(product(0x1p-45, reach) + (std::is_same_v<T, float> ? 0x1p-74 : 0x1p-536)),
          rounding(2 * static_cast<double>(unit_roundoff<T>) * reach) {}
    double below(double distance) const { return std::max(0.0, product(distance, 1 - relative) - absolute); }
    double above(double distance) const { return product(distance, 1 + relative) + absolute; }
    /// The width of the narrowest interval around a distance: where points need not be rounded, and where
    /// they are.
    double of(double distance) const { return 4 * (product(distance, relative) + absolute); }
    double of_rounded(double distance) const { return of(distance) + 4 * rounding; }
};

}  // namespace hedgerow::detail
