/// Values at the corners of triangles: normals, texture coordinates and colours.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <hedgerow/geometry/vec.h>
#include <hedgerow/looks/colour.h>
#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow {

/// The ordinal of a value that a corner does not have.
inline constexpr std::uint32_t no_value = 0xFFFFFFFFu;

/// A value for each corner of each triangle, by indices of their own. So a vertex can have two normals at a
/// crease, and a surface stays closed where its texture has a seam.
template <class V>
struct CornerValues {
    std::vector<V> values;
    /// The ordinals of the values of each triangle's corners, `no_value` for a corner that has none. If it is
    /// empty, there is one value per vertex, and the mesh's own indices name them.
    std::vector<TriangleIndices> corners;

    bool empty() const { return values.empty(); }
    /// The ordinals of the values at the corners of triangle `i` of `mesh`.
    template <class T>
    TriangleIndices at_corners(const TriangleMesh<T>& mesh, std::size_t i) const {
        return corners.empty() ? mesh.triangles[i] : corners[i];
    }
    /// The value at the point (1 − u − v)·a + u·b + v·c of triangle `i` of `mesh`, as of a hit. Nothing if a
    /// corner has no value. O(1).
    template <class T>
    std::optional<V> at(const TriangleMesh<T>& mesh, std::size_t i, float u, float v) const {
        if (empty()) return std::nullopt;
        const auto [a, b, c] = at_corners(mesh, i);
        if (a == no_value || b == no_value || c == no_value) return std::nullopt;
        return values[a] * (1 - u - v) + values[b] * u + values[c] * v;
    }
    /// How the value changes where u and v change by so much. Nothing if a corner has no value. O(1).
    template <class T>
    std::optional<V> difference(const TriangleMesh<T>& mesh, std::size_t i, float du, float dv) const {
        if (empty()) return std::nullopt;
        const auto [a, b, c] = at_corners(mesh, i);
        if (a == no_value || b == no_value || c == no_value) return std::nullopt;
        return (values[b] - values[a]) * du + (values[c] - values[a]) * dv;
    }
};

/// What a mesh has at its corners. Each may be empty. Without values it allocates nothing, and the mesh
/// itself knows nothing of it.
struct Attributes {
    /// Normals towards the front, in the object's space. Their length may differ from 1.
    CornerValues<Vec3f> normals;
    /// Sets of texture coordinates; a TextureSlot names one by its place. (0, 0) is the top left corner of an
    /// image.
    std::vector<CornerValues<Vec2f>> texture_coordinates;
    /// Linear colours, which multiply the base colour.
    CornerValues<Rgba> colours;
};

}  // namespace hedgerow
