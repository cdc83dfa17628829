/// The checks that every loaded mesh and point cloud must pass, in one place.
#pragma once

#include <string_view>

#include <hedgerow/io/load_options.h>
#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow {

/// Throws InputError, naming `name` (a file, say) and the first bad element, if the mesh has no triangles, if
/// a triangle names a vertex that does not exist, if a coordinate is NaN, infinite or beyond
/// `largest_coordinate<T>` (even of a vertex that no face uses), or if `faces` is not empty and does not have
/// one id per triangle, never descending. T is float or double. O(vertices + triangles) time, no memory.
template <class T>
void validate_mesh(const TriangleMesh<T>& mesh, std::string_view name);

/// Throws InputError if the cloud has no points or a point has a coordinate that validate_mesh would refuse.
/// D is 2 or 3. O(points) time, no memory.
template <class T, int D>
void validate_points(const PointCloud<T, D>& cloud, std::string_view name);

/// Returns the mesh if validate_mesh accepts it, and throws what validate_mesh throws if not. With
/// `drop_bad`, bad coordinates are no error unless no face is left: vertices that have them, and faces that
/// use those vertices, are left out.
template <class T>
TriangleMesh<T> validated(TriangleMesh<T> mesh, std::string_view name, const LoadOptions& options);
/// Returns the points if validate_points accepts them, and throws what validate_points throws if not. With
/// `drop_bad`, bad points are left out, and are an error only if no point is left.
template <class T, int D>
PointCloud<T, D> validated(PointCloud<T, D> cloud, std::string_view name, const LoadOptions& options);

}  // namespace hedgerow
