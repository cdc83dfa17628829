/// Spheres (circles in 2D).
#pragma once

#include <vector>

#include <hedgerow/geometry/shapes.h>
#include <hedgerow/primitives/strided.h>

namespace hedgerow {

/// Spheres in an array of its own. A sphere's id is its position. Radii are >= 0.
template <std::floating_point T, int D>
struct SphereSet {
    using Scalar = T;
    static constexpr int dimension = D;

    std::vector<Sphere<T, D>> spheres;

    std::size_t size() const { return spheres.size(); }
};

}  // namespace hedgerow
