/// The readers of meshes and points, one per format. Their results are not yet validated.
#pragma once

#include <filesystem>

#include <hedgerow/parallel/progress.h>
#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/primitives/triangle_mesh.h>

#include "byte_source.h"

namespace hedgerow::detail {

template <class T>
TriangleMesh<T> read_ply_mesh(ByteSource& file);
template <class T>
TriangleMesh<T> read_stl(ByteSource& file);
template <class T>
TriangleMesh<T> read_obj(ByteSource& file);
template <class T>
TriangleMesh<T> read_off(ByteSource& file);
/// Reads buffers that have files of their own from the folder of `path`.
template <class T>
TriangleMesh<T> read_gltf(ByteSource& file, const std::filesystem::path& path);

/// Reads the positions of the primitives that are points, in the scene's coordinates, as vertices without
/// triangles.
template <class T>
TriangleMesh<T> read_gltf_points(ByteSource& file, const std::filesystem::path& path);

template <class T, int D>
PointCloud<T, D> read_ply_points(ByteSource& file);
template <class T, int D>
PointCloud<T, D> read_npy_points(ByteSource& file);
template <class T, int D>
PointCloud<T, D> read_csv_points(ByteSource& file);
/// Reads `.xyz`: lines that begin with the coordinates. Further fields are skipped.
template <class T, int D>
PointCloud<T, D> read_xyz_points(ByteSource& file);

/// The lower-case extension that names the format, without `.gz`.
std::string format_of(const std::filesystem::path& path);

}  // namespace hedgerow::detail
