/// The answer to: which points are within a distance of each other.
#pragma once

#include <compare>

#include <hedgerow/primitives/concepts.h>

namespace hedgerow {

/// A pair of points, by their positions in their sets, and their squared distance.
template <std::floating_point T>
struct PairWithin {
    PrimitiveId a, b;
    T distance2;
    friend auto operator<=>(const PairWithin&, const PairWithin&) = default;
};

}  // namespace hedgerow
