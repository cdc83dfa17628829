/// Meshes and points behind one door.
#include <hedgerow/io/scene_file.h>

#include <hedgerow/io/mesh_file.h>
#include <hedgerow/io/point_file.h>

#include "npy_format.h"
#include "ply_header.h"
#include "readers.h"

namespace hedgerow {

namespace {

enum class Holds { mesh, points, points2d };

Holds look_into(const std::filesystem::path& path) {
    const std::string format = detail::format_of(path);
    if (format == ".csv") return Holds::points;
    if (format == ".ply") {
        detail::ByteSource file(path);
        const auto header = detail::read_ply_header(file);
        const auto* const faces = header.find("face");
        const auto* const vertices = header.find("vertex");
        const bool cloud =
            vertices != nullptr && vertices->count > 0 && (faces == nullptr || faces->count == 0);
        return cloud && header.find("tristrips") == nullptr ? Holds::points : Holds::mesh;
    }
    if (format == ".npy") {
        detail::ByteSource file(path);
        const auto shape = detail::read_npy_shape(file);
        return shape.size() == 2 && shape[1] == 2 ? Holds::points2d : Holds::points;
    }
    return Holds::mesh;
}

}  // namespace

template <class T>
Scene<T> load_scene(const std::filesystem::path& path, const LoadOptions& options, const Progress& progress) {
    switch (look_into(path)) {
        case Holds::points:
            return load_points<T, 3>(path, options, progress);
        case Holds::points2d:
            return load_points<T, 2>(path, options, progress);
        case Holds::mesh:
            break;
    }
    return load_mesh<T>(path, options, progress);
}

template Scene<float> load_scene(const std::filesystem::path&, const LoadOptions&, const Progress&);
template Scene<double> load_scene(const std::filesystem::path&, const LoadOptions&, const Progress&);

}  // namespace hedgerow
