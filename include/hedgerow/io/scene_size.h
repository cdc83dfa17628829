/// The number of primitives in a scene file, from its header.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include <hedgerow/scenes/generate.h>

namespace hedgerow {

/// The kind and number of a scene's primitives.
struct SceneSize {
    /// "triangles", "spheres", "points" or "segments", as in SceneInfo.
    std::string_view kind;
    int dimension = 3;
    std::uint64_t count = 0;
    /// Corners of triangles; 0 for other kinds.
    std::uint64_t vertices = 0;

    /// Bytes of the scene in memory, its coordinates in numbers of `scalar` bytes.
    double bytes(std::size_t scalar) const;
};

template <class T>
SceneSize size_of(const Scene<T>& scene);

/// The size that a generator aims at.
SceneSize size_of(const SceneSpec& spec);

/// Reads the header of a file that load_scene reads. PLY, NumPy, binary STL and saved indexes say how many
/// primitives they have; a polygon of a PLY counts as one triangle. None for other files, whose primitives
/// only reading counts. O(1). Throws InputError for a file that cannot be read, or whose header is bad.
std::optional<SceneSize> size_in_header(const std::filesystem::path& path);

}  // namespace hedgerow
