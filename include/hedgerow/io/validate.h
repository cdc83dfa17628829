/// What every loaded mesh and point cloud is held against, in one place.
#pragma once

#include <string_view>

#include <hedgerow/io/load_options.h>
#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow {

/// Throws InputError, naming `name` (a file, say) and the first offender, if the mesh has no triangles, if a
/// triangle names a vertex that does not exist, if a coordinate is NaN, infinite or beyond
/// `largest_coordinate<T>` (a vertex that no face uses counts too), or if `faces` is neither empty nor one
/// never descending id a triangle. T is float or double. O(vertices + triangles) time, no memory.
template <class T>
void validate_mesh(const TriangleMesh<T>& mesh, std::string_view name);

/// The same for points; D is 2 or 3. No points at all are an error.
template <class T, int D>
void validate_points(const PointCloud<T, D>& cloud, std::string_view name);

/// The mesh, if it is valid; with `drop_bad` without the faces and vertices that have bad coordinates, an
/// error only if nothing is left.
template <class T>
TriangleMesh<T> validated(TriangleMesh<T> mesh, std::string_view name, const LoadOptions& options);
template <class T, int D>
PointCloud<T, D> validated(PointCloud<T, D> cloud, std::string_view name, const LoadOptions& options);

}  // namespace hedgerow
