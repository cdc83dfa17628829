/// Scenes by name: `gen:NAME[:SIZE]`.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

namespace hedgerow {

/// Whatever a generator yields.
template <class T>
using Scene =
    std::variant<TriangleMesh<T>, SphereSet<T, 3>, PointCloud<T, 3>, PointCloud<T, 2>, SegmentSet<T>>;

/// Which scene, how large (none: its default size), and which of its random variants. Scenes without chance
/// ignore the seed.
struct SceneSpec {
    std::string name;
    std::optional<std::uint64_t> size;
    std::uint64_t seed = 0;
};

/// One generator. Sizes count what it yields.
struct SceneInfo {
    template <class T>
    using Generator = Scene<T> (*)(std::uint64_t size, std::uint64_t seed, const Progress& progress);

    std::string_view name;
    std::uint64_t default_size;
    std::string_view yields;  ///< "triangles", "spheres", "points" or "segments"
    int dimension;
    std::string_view description;  ///< one line
    double bytes;                  ///< of memory an element takes while it is made, at least
    Generator<float> in_float;
    Generator<double> in_double;
};

/// No scene is larger.
inline constexpr std::uint64_t largest_scene_size = std::uint64_t{1} << 31;

/// All scenes: what `parse_scene_spec` knows and `generate` makes.
std::span<const SceneInfo> scene_list();

/// Reads "gen:NAME" or "gen:NAME:SIZE"; SIZE is a whole number, with k, M or G behind it for thousands,
/// millions or thousands of millions. Throws UsageError for an unknown name (suggesting a near one, and
/// listing all), a size that is no number, or one beyond `largest_scene_size`.
SceneSpec parse_scene_spec(std::string_view text);

/// The scene, in single or double precision (T = float or double). `progress` is told of the elements that
/// are made and looked at about once in 4096 of them. Throws UsageError as `parse_scene_spec` does, and
/// Cancelled if `progress` is cancelled.
template <class T>
Scene<T> generate(const SceneSpec& spec, const Progress& progress = {});

}  // namespace hedgerow
