/// Half-spaces: what lies on one side of a plane.
#pragma once

#include <hedgerow/geometry/slab.h>

namespace hedgerow {

/// The points x with normal·x <= offset. The normal may have any length. An infinite offset leaves all of
/// space.
template <std::floating_point T, int D = 3>
struct HalfSpace {
    using Scalar = T;
    static constexpr int dimension = D;

    Vec<T, D> normal;
    T offset = T(0);

    static constexpr int orthonormal = 0;
    static constexpr int slab_count() { return 1; }
    Slab<D> slab(int) const {
        return {Vec<double, D>(normal), -std::numeric_limits<double>::infinity(),
                static_cast<double>(offset)};
    }
};

}  // namespace hedgerow
