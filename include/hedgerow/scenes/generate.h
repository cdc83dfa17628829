/// Scenes by name: `gen:NAME[:SIZE]`.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/particles.h>
#include <hedgerow/scenes/sets.h>

namespace hedgerow {

/// A generated scene: whichever kind of set its generator makes.
template <class T>
using Scene =
    std::variant<TriangleMesh<T>, SphereSet<T, 3>, PointCloud<T, 3>, PointCloud<T, 2>, SegmentSet<T>>;

/// A scene's name, its size (none: the default size), and the seed of its random variant. Scenes without
/// randomness ignore the seed.
struct SceneSpec {
    std::string name;
    std::optional<std::uint64_t> size;
    std::uint64_t seed = 0;
};

/// One generator. Sizes count the elements that `yields` names.
struct SceneInfo {
    template <class T>
    using Generator = Scene<T> (*)(std::uint64_t size, std::uint64_t seed, const Progress& progress);

    std::string_view name;
    std::uint64_t default_size;
    std::string_view yields;  ///< "triangles", "spheres", "points" or "segments"
    int dimension;
    std::string_view description;  ///< one line
    double bytes;                  ///< least memory that an element takes while it is made
    Generator<float> in_float;
    Generator<double> in_double;
    /// Of scenes of particles: with their velocities and masses. Else nullptr.
    Particles (*particles)(std::uint64_t size, std::uint64_t seed, const Progress& progress);
};

/// The largest size of any scene, in elements.
inline constexpr std::uint64_t largest_scene_size = std::uint64_t{1} << 31;

/// All scenes that `parse_scene_spec` accepts and `generate` makes.
std::span<const SceneInfo> scene_list();

/// Reads "gen:NAME" or "gen:NAME:SIZE". SIZE is a whole number, with k, M or G after it for thousands,
/// millions or thousands of millions. Throws UsageError for other text, for an unknown name (suggesting a
/// near one, and listing all), for a size that is not a number, and for one beyond `largest_scene_size`.
SceneSpec parse_scene_spec(std::string_view text);

/// Makes the scene, in single or double precision (T = float or double). `progress` counts the elements made,
/// and is checked for cancellation about once in 4096 of them. Throws UsageError as `parse_scene_spec` does,
/// and Cancelled if `progress` is cancelled.
template <class T>
Scene<T> generate(const SceneSpec& spec, const Progress& progress = {});

/// Makes a scene of particles, whose places `generate` gives too. Throws as `generate` does, and UsageError
/// for a scene that is none of particles.
Particles generate_particles(const SceneSpec& spec, const Progress& progress = {});

}  // namespace hedgerow
