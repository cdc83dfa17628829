/// Oriented boxes.
#pragma once

#include <hedgerow/geometry/slab.h>

namespace hedgerow {

/// The points x with low[i] <= axis[i]·x <= high[i]. The axes are orthonormal up to their rounding to T.
template <std::floating_point T, int D>
struct Obb {
    using Scalar = T;
    static constexpr int dimension = D;

    Vec<T, D> axis[D];
    Vec<T, D> low, high;

    static constexpr int orthonormal = D;
    static constexpr int slab_count() { return D; }
    Slab<D> slab(int i) const {
        return {Vec<double, D>(axis[i]), static_cast<double>(low[i]), static_cast<double>(high[i])};
    }
};

}  // namespace hedgerow
