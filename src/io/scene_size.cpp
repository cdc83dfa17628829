/// Counts the primitives of scenes, by the headers of files alone.
#include <hedgerow/io/scene_size.h>

#include <type_traits>

#include <hedgerow/io/index_file.h>

#include "npy_format.h"
#include "ply_header.h"
#include "readers.h"
#include "text.h"

namespace hedgerow {

namespace {

/// The vertices of a closed mesh of so many triangles, by Euler's formula.
std::uint64_t usual_vertices(std::uint64_t triangles) {
    return triangles / 2 + 2;
}

std::optional<SceneSize> size_in_ply(const std::filesystem::path& path) {
    detail::ByteSource file(path);
    const auto header = detail::read_ply_header(file);
    const auto* const faces = header.find("face");
    const auto* const vertices = header.find("vertex");
    if (vertices == nullptr || header.find("tristrips") != nullptr) return std::nullopt;
    if (header.is_cloud()) return SceneSize{"points", 3, vertices->count};
    return SceneSize{"triangles", 3, faces != nullptr ? faces->count : 0, vertices->count};
}

std::optional<SceneSize> size_in_npy(const std::filesystem::path& path) {
    detail::ByteSource file(path);
    const auto shape = detail::read_npy_shape(file);
    if (shape.size() != 2) return std::nullopt;  // load_points names the fault
    return SceneSize{"points", shape[1] == 2 ? 2 : 3, shape[0]};
}

/// A binary file has 84 bytes, which end in the number of triangles, and 50 a triangle. Text may have any
/// length, so one that has just this one is mistaken once in 2^32.
std::optional<SceneSize> size_in_stl(const std::filesystem::path& path) {
    detail::ByteSource file(path);
    std::uint32_t count = 0;
    if (!file.skip(80) || !file.value(count, std::endian::little)) return std::nullopt;
    if (std::filesystem::file_size(path) != 84 + 50 * std::uint64_t(count)) return std::nullopt;
    return SceneSize{"triangles", 3, count, usual_vertices(count)};
}

/// The size, or none if the file is too short for it: then its reader names the fault. A primitive takes a
/// byte or more, and deflate shrinks to a 1032nd at most.
std::optional<SceneSize> believed(const std::optional<SceneSize>& size, const std::filesystem::path& path) {
    if (!size) return size;
    const std::uint64_t shrunk = detail::lower_case(path.extension().string()) == ".gz" ? 1032 : 1;
    const std::uint64_t most = shrunk * std::filesystem::file_size(path);
    return size->count <= most && size->vertices <= most ? size : std::nullopt;
}

}  // namespace

double SceneSize::bytes(std::size_t scalar) const {
    const auto n = static_cast<double>(count), number = static_cast<double>(scalar);
    const auto d = static_cast<double>(dimension);
    if (kind == "triangles") return n * sizeof(TriangleIndices) + static_cast<double>(vertices) * d * number;
    return n * number * (kind == "spheres" ? d + 1 : kind == "segments" ? 2 * d : d);
}

template <class T>
SceneSize size_of(const Scene<T>& scene) {
    return std::visit(
        []<class Set>(const Set& set) {
            SceneSize size{"points", Set::dimension, set.size()};
            if constexpr (std::is_same_v<Set, TriangleMesh<T>>)
                size.kind = "triangles", size.vertices = set.vertices.size();
            if constexpr (std::is_same_v<Set, SphereSet<T, 3>>) size.kind = "spheres";
            if constexpr (std::is_same_v<Set, SegmentSet<T>>) size.kind = "segments";
            return size;
        },
        scene);
}
template SceneSize size_of(const Scene<float>&);
template SceneSize size_of(const Scene<double>&);

SceneSize size_of(const SceneSpec& spec) {
    for (const SceneInfo& info : scene_list()) {
        if (info.name != spec.name) continue;
        const std::uint64_t count = spec.size.value_or(info.default_size);
        return {info.yields, info.dimension, count, info.yields == "triangles" ? usual_vertices(count) : 0};
    }
    return {};
}

std::optional<SceneSize> size_in_header(const std::filesystem::path& path) {
    if (names_index_file(path)) {
        const IndexFileInfo info = index_file_info(path);
        if (info.holds_points) return SceneSize{"points", info.dimension, info.points};
        return SceneSize{"triangles", 3, info.triangles, info.vertices};
    }
    const std::string format = detail::format_of(path);
    if (format == ".ply") return believed(size_in_ply(path), path);
    if (format == ".npy") return believed(size_in_npy(path), path);
    if (format == ".stl") return size_in_stl(path);
    return std::nullopt;
}

}  // namespace hedgerow
