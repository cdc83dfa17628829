/// Cubes at given places, and meshes of several.
#pragma once

#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow {

/// A closed cube from `low` on, whose corners are exact in T where `low` and `width` allow it.
template <class T>
TriangleMesh<T> cube_at(const Vec<T, 3>& low, T width) {
    TriangleMesh<T> mesh;
    for (unsigned i = 0; i < 8; ++i)
        mesh.vertices.push_back(low + Vec<T, 3>(T(i & 1u), T(i >> 1 & 1u), T(i >> 2)) * width);
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

/// One mesh of the triangles of two.
template <class T>
TriangleMesh<T> joined(TriangleMesh<T> a, const TriangleMesh<T>& b) {
    const auto first = static_cast<std::uint32_t>(a.vertices.size());
    a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
    for (const auto& t : b.triangles) a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    return a;
}

}  // namespace hedgerow
