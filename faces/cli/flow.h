/// What the files of `hedgerow flow` share.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <hedgerow/ask/insides.h>
#include <hedgerow/fluid/fluid_flow.h>
#include <hedgerow/io/image.h>
#include <hedgerow/mesh_index.h>

#include "common.h"

namespace hedgerow::cli {

/// The options of a run. Numbers below 0 are chosen by the scene.
struct FlowArguments : Common {
    bool plane = false, resume = false, check = false, floor = false;
    std::string walls, inflow, up = "auto", colour = "pressure", size = "auto", surface;
    double until = -1, every = -1;
    double spacing = -1, sound = -1, viscosity = -1, gravity = 9.81;
    std::vector<double> inflow_velocity{0, 0, 0};
    unsigned threads = 0;
};

/// A mesh that holds a fluid, or stands in its way. Borrows from itself, so it stays where it is.
struct MeshOfWalls {
    explicit MeshOfWalls(TriangleMesh<double> triangles, Threads threads)
        : mesh(std::move(triangles)), index(build(mesh, threads)), solid(index, {}, threads) {}
    MeshOfWalls(const MeshOfWalls&) = delete;
    MeshOfWalls& operator=(const MeshOfWalls&) = delete;

    TriangleMesh<double> mesh;
    MeshIndex<double> index;
    Solid<MeshIndex<double>> solid;
};

/// A fluid that begins, what holds it, and what pictures show of it.
template <int D>
struct FlowScene {
    FluidState<D> start;
    FluidWalls<D> walls;
    FluidOptions<D> options;
    Box<double, D> tank;
    int up = D - 1;    ///< the axis
    double until = 2;  ///< a time at which the most has happened
    /// The walls of a mesh, on whose other side no fluid should be.
    std::shared_ptr<const MeshOfWalls> mesh;
    bool fluid_inside = true;
    std::vector<Vec<double, D>> inflow;  ///< places that are kept full

    /// How high the fluid stands at the start, above its lowest particle.
    double depth() const;
};

/// Generates or loads the scene, and its walls. Throws InputError for fluid outside of its walls.
template <int D>
FlowScene<D> flow_scene(const FlowArguments& a);

/// How many particles are more than 0.3 spacings behind walls.
template <int D>
std::size_t leaks(const FlowScene<D>& scene, const FluidState<D>& state);

/// Draws the particles as seen from the front: in colours of their pressure, up to that of the depth at rest,
/// or of their speed, up to that of a fall as deep.
template <int D>
Image flow_picture(const FlowArguments& a, const FlowScene<D>& scene, const FluidState<D>& state, int width,
                   int height);
/// The width and height of pictures, by --size or by the sides of the tank. None for 0x0.
template <int D>
std::optional<std::pair<int, int>> flow_picture_size(const FlowArguments& a, const FlowScene<D>& scene);

/// Runs the verb in space or in the plane. Returns the exit code.
template <int D>
int flow_run(FlowArguments a);

}  // namespace hedgerow::cli
