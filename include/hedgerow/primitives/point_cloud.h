/// Points.
#pragma once

#include <vector>

#include <hedgerow/geometry/shapes.h>
#include <hedgerow/primitives/strided.h>

namespace hedgerow {

/// Points in an array of its own. A point's id is its position.
template <std::floating_point T, int D>
struct PointCloud {
    using Scalar = T;
    static constexpr int dimension = D;

    std::vector<Vec<T, D>> points;

    std::size_t size() const { return points.size(); }
};

}  // namespace hedgerow
