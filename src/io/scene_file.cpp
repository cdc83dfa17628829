/// Loads meshes, points and saved indexes by one function.
#include <hedgerow/io/scene_file.h>

#include <hedgerow/io/index_file.h>
#include <hedgerow/io/mesh_file.h>
#include <hedgerow/io/point_file.h>
#include <hedgerow/parallel/watched_executor.h>

#include "memory.h"
#include "no_faces.h"
#include "npy_format.h"
#include "ply_header.h"
#include "readers.h"

namespace hedgerow {

namespace {

enum class Holds { mesh, mesh_or_points, points, points2d, index };

/// What a file holds: by its extension and, for PLY and NumPy files, by its header.
Holds look_into(const std::filesystem::path& path) {
    const std::string format = detail::format_of(path);
    if (format == ".csv" || format == ".xyz") return Holds::points;
    if (names_index_file(path)) return Holds::index;
    if (format == ".ply") {
        detail::ByteSource file(path);
        const auto header = detail::read_ply_header(file);
        return header.is_cloud() ? Holds::points : Holds::mesh;
    }
    if (format == ".npy") {
        detail::ByteSource file(path);
        const auto shape = detail::read_npy_shape(file);
        return shape.size() == 2 && shape[1] == 2 ? Holds::points2d : Holds::points;
    }
    if (format == ".obj" || format == ".off" || format == ".gltf" || format == ".glb")
        return Holds::mesh_or_points;
    return Holds::mesh;
}

template <class T>
TriangleMesh<T> mesh_of(const TriangleMeshView<T>& view) {
    TriangleMesh<T> mesh;
    mesh.vertices.resize(view.vertex_count());
    for (std::size_t i = 0; i < view.vertex_count(); ++i) mesh.vertices[i] = view.vertex(i);
    mesh.triangles.resize(view.size());
    for (std::size_t i = 0; i < view.size(); ++i) mesh.triangles[i] = view.indices(i);
    mesh.faces.resize(view.faces().size());
    for (std::size_t i = 0; i < view.faces().size(); ++i) mesh.faces[i] = view.faces()[i];
    return mesh;
}

template <class T, int D>
PointCloud<T, D> cloud_of(const PointCloudView<T, D>& view) {
    PointCloud<T, D> cloud;
    cloud.points.resize(view.size());
    for (std::size_t i = 0; i < view.size(); ++i) cloud.points[i] = view.point(i);
    return cloud;
}

/// The mesh of a file, or, where nothing in it has three corners, its points.
template <class T>
Scene<T> load_mesh_or_points(const std::filesystem::path& path, const LoadOptions& options,
                             const Progress& progress) {
    try {
        return load_mesh<T>(path, options, progress);
    } catch (const detail::NoFaces& fault) {
        try {
            return load_points<T, 3>(path, options, progress);
        } catch (const InputError&) {
            throw fault;  // no points either
        }
    }
}

/// The mesh or the points of a saved index.
template <class T>
Scene<T> load_scene_of_index(const std::filesystem::path& path, const Progress& progress) {
    WatchedExecutor watched(serial_executor(), progress);
    const IndexFileInfo info = index_file_info(path);
    if (!info.holds_points) return mesh_of(load_index<T>(path, {}, watched).primitives());
    if (info.dimension == 2) return cloud_of(load_point_index<T, 2>(path, {}, watched).primitives());
    return cloud_of(load_point_index<T, 3>(path, {}, watched).primitives());
}

}  // namespace

template <class T>
Scene<T> load_scene(const std::filesystem::path& path, const LoadOptions& options, const Progress& progress) {
    switch (look_into(path)) {
        case Holds::points:
            return load_points<T, 3>(path, options, progress);
        case Holds::points2d:
            return load_points<T, 2>(path, options, progress);
        case Holds::index:
            return detail::within_memory(path, [&] { return load_scene_of_index<T>(path, progress); });
        case Holds::mesh_or_points:
            return load_mesh_or_points<T>(path, options, progress);
        case Holds::mesh:
            break;
    }
    return load_mesh<T>(path, options, progress);
}

template Scene<float> load_scene(const std::filesystem::path&, const LoadOptions&, const Progress&);
template Scene<double> load_scene(const std::filesystem::path&, const LoadOptions&, const Progress&);

}  // namespace hedgerow
