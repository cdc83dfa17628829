/// Cubes (squares in the plane) that are halved along every axis at once.
#pragma once

#include <hedgerow/geometry/box.h>

namespace hedgerow {

/// A cube, given by its middle and half its width, which is a power of two. Orthant i is on the high side of
/// the middle along axis k if bit k of i is set.
template <std::floating_point T, int D>
struct Cube {
    Vec<T, D> middle;
    T half = T(0);

    constexpr Box<T, D> box() const { return {middle - Vec<T, D>::all(half), middle + Vec<T, D>::all(half)}; }
    constexpr Cube orthant(unsigned i) const {
        const T quarter = half * T(0.5);
        Cube c{middle, quarter};
        for (int k = 0; k < D; ++k) c.middle[k] += i >> k & 1u ? quarter : -quarter;
        return c;
    }
    /// The cube of twice the width that has this cube as its orthant i.
    constexpr Cube doubled(unsigned i) const {
        Cube c{middle, half * 2};
        for (int k = 0; k < D; ++k) c.middle[k] += i >> k & 1u ? -half : half;
        return c;
    }
    /// Whether middle − by and middle + by are exact in T along every axis.
    constexpr bool exact(T by) const {
        for (int k = 0; k < D; ++k) {
            const T low = middle[k] - by, high = middle[k] + by;
            if (middle[k] - low != by || low + by != middle[k]) return false;
            if (high - middle[k] != by || high - by != middle[k]) return false;
        }
        return true;
    }
    /// Whether the middles and half widths of the orthants are exact in T.
    constexpr bool divisible() const {
        const T quarter = half * T(0.5);
        return quarter > 0 && quarter * 2 == half && exact(quarter);
    }
    friend constexpr bool operator==(const Cube&, const Cube&) = default;
};

}  // namespace hedgerow
