/// Layers one behind the other, for tests of what is hit in which order.
#pragma once

#include <cstdint>

#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow {

/// Unit squares of two triangles, across z at 0, 1, 2 ..., `copies` of each in one place.
template <class T = float>
TriangleMesh<T> stack(std::uint32_t layers, std::uint32_t copies = 1) {
    TriangleMesh<T> mesh;
    for (std::uint32_t i = 0; i < layers * copies; ++i) {
        const auto at = static_cast<std::uint32_t>(mesh.vertices.size());
        const T z = T(i % layers);
        mesh.vertices.insert(mesh.vertices.end(),
                             {{T(0), T(0), z}, {T(1), T(0), z}, {T(0), T(1), z}, {T(1), T(1), z}});
        mesh.triangles.insert(mesh.triangles.end(), {{at, at + 1, at + 2}, {at + 3, at + 2, at + 1}});
    }
    return mesh;
}

}  // namespace hedgerow
