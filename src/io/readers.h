/// The readers of single formats. What they return is not yet validated.
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
/// Buffers in files of their own are looked for beside `path`.
template <class T>
TriangleMesh<T> read_gltf(ByteSource& file, const std::filesystem::path& path);

template <class T, int D>
PointCloud<T, D> read_ply_points(ByteSource& file);
template <class T, int D>
PointCloud<T, D> read_npy_points(ByteSource& file);
template <class T, int D>
PointCloud<T, D> read_csv_points(ByteSource& file);
/// `.xyz`: lines that begin with the coordinates; what follows them is skipped.
template <class T, int D>
PointCloud<T, D> read_xyz_points(ByteSource& file);

/// Lower-case extension that says the format, without `.gz`.
std::string format_of(const std::filesystem::path& path);

}  // namespace hedgerow::detail
