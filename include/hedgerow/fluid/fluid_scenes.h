/// Scenes of fluids by name, in metres and seconds.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include <hedgerow/fluid/fluid_flow.h>

namespace hedgerow {

/// A fluid that begins, and what holds it.
template <int D>
struct FluidScene {
    FluidState<D> start;
    FluidWalls<D> walls;
    FluidOptions<D> options;
    Box<double, D> tank;  ///< the inside of the box of walls
};

struct FluidSceneInfo {
    std::string_view name, description;
    double until;  ///< a time at which the most has happened
};
/// All scenes that `fluid_scene` makes.
std::span<const FluidSceneInfo> fluid_scenes();
/// The scene with a name. Throws UsageError for an unknown one; suggests a near one, and lists all.
const FluidSceneInfo& fluid_scene_named(std::string_view name);

/// A scene with about so many particles of the fluid. Throws UsageError for a name that `fluid_scenes` lacks,
/// and for fewer than ten particles or more than 2^31. D is 2 or 3.
template <int D>
FluidScene<D> fluid_scene(std::string_view name, std::uint64_t particles);

}  // namespace hedgerow
