/// Line segments in the plane.
#pragma once

#include <vector>

#include <hedgerow/geometry/shapes.h>
#include <hedgerow/primitives/strided.h>

namespace hedgerow {

/// Segments in an array of its own. A segment's id is its position.
template <std::floating_point T>
struct SegmentSet {
    using Scalar = T;
    static constexpr int dimension = 2;

    std::vector<Segment<T, 2>> segments;

    std::size_t size() const { return segments.size(); }
};

}  // namespace hedgerow
