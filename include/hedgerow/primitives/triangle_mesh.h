/// Indexed triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <hedgerow/geometry/shapes.h>
#include <hedgerow/primitives/strided.h>

namespace hedgerow {

/// Three positions in the list of vertices, counterclockwise seen from the front.
using TriangleIndices = std::array<std::uint32_t, 3>;

/// Triangles in arrays of its own.
template <std::floating_point T>
struct TriangleMesh {
    using Scalar = T;
    static constexpr int dimension = 3;

    std::vector<Vec<T, 3>> vertices;
    std::vector<TriangleIndices> triangles;
    /// The id of each triangle: the ordinal of the face that it came from, never descending. Empty: its position.
    std::vector<std::uint32_t> faces;

    std::size_t size() const { return triangles.size(); }
};

}  // namespace hedgerow
