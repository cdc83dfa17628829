/// The default index over triangles: the name of its type, and what `core` compiles of it for all programs.
#pragma once

#include <hedgerow/ask.h>
#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow {

/// The index of triangles that `build(mesh)` returns, and that files hold (io/index_file.h).
template <std::floating_point T>
using MeshIndex = Index<WideBvh<T, 3>, TriangleMeshView<T>>;

// In `core` (src/core/mesh_index.cpp), so that a program that does not optimise need not compile them.
extern template class Index<WideBvh<float, 3>, TriangleMeshView<float>>;
extern template Hit<float> closest_hit(const MeshIndex<float>&, const Ray3f&, const KeepAll&,
                                       const NoVisits&);
extern template bool any_hit(const MeshIndex<float>&, const Ray3f&, const KeepAll&, const NoVisits&);
extern template Near<float, 3> closest_point(const MeshIndex<float>&, const Vec3f&, const PointOptions&,
                                             const KeepAll&, const NoVisits&);

}  // namespace hedgerow
