/// The scenes of `hedgerow flow`: fluids and what holds them.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <hedgerow/ask/insides.h>
#include <hedgerow/ask/neighbours.h>
#include <hedgerow/base/error.h>
#include <hedgerow/fluid/fluid_scenes.h>
#include <hedgerow/fluid/mesh_walls.h>
#include <hedgerow/scenes/size_text.h>

#include "flow.h"
#include "memory.h"
#include "view.h"

namespace hedgerow::cli {

namespace {

constexpr std::uint64_t usual_particles[] = {5000, 20000};  // in the plane, and in space

void expect_memory_of_particles(double particles) {
    expect_memory(fmt::format("a fluid of {:.3g} particles and its walls", particles), particles * 700,
                  "ask for fewer, or give a longer --spacing");
}

TriangleMesh<double> mesh_from(const FlowArguments& a, const std::string& file) {
    Common common = a;
    common.scene = file;
    auto scene = load<double>(common);
    auto* const mesh = std::get_if<TriangleMesh<double>>(&scene);
    if (mesh == nullptr || mesh->size() == 0)
        throw InputError(file + ": a fluid and its walls need a closed mesh of triangles");
    return std::move(*mesh);
}
Box3d box_of(const TriangleMesh<double>& mesh) {
    Box3d box;
    for (std::size_t i = 0; i < mesh.size(); ++i) box.expand(mesh.view().bounds(i));
    return box;
}
/// Names the file in what is wrong with its mesh.
template <class F>
auto of_file(const std::string& file, F f) {
    try {
        return f();
    } catch (const UsageError&) {
        throw;
    } catch (const InputError& fault) {
        throw InputError(file + ": " + fault.what());
    }
}

template <int D>
FlowScene<D> generated(const FlowArguments& a) {
    const std::string text = a.scene.substr(4);
    const std::size_t colon = text.find(':');
    const std::string name = text.substr(0, colon);
    const FluidSceneInfo& info = fluid_scene_named(name);
    const std::uint64_t particles =
        colon == std::string::npos ? usual_particles[D - 2] : parse_scene_size(name, text.substr(colon + 1));
    expect_memory_of_particles(4 * static_cast<double>(particles));
    if (a.spacing >= 0)
        throw UsageError("--spacing is for meshes; give gen:" + name +
                         " a number of particles, as gen:" + name + ":20000");
    FluidScene<D> fluid = fluid_scene<D>(name, particles);
    FlowScene<D> scene;
    scene.start = std::move(fluid.start), scene.walls = std::move(fluid.walls);
    scene.options = fluid.options, scene.tank = fluid.tank, scene.until = info.until;
    // Other gravity changes how fast the fluid becomes, and what its weight compresses.
    const double weight = a.gravity / 9.81;
    scene.options.gravity = scene.options.gravity * weight;
    if (weight > 0)
        scene.options.sound *= std::sqrt(weight), scene.until /= std::sqrt(weight);
    else
        std::fill(scene.start.compressions.begin(), scene.start.compressions.end(), 0.0);
    for (auto& v : scene.start.velocities) v = v * std::sqrt(weight);
    if (a.sound > 0)
        for (double& c : scene.start.compressions) c *= std::pow(scene.options.sound / a.sound, 2);
    return scene;
}

/// A mesh that is full of fluid, above the floor of a tank that is twice as wide.
FlowScene<3> from_mesh(const FlowArguments& a) {
    const TriangleMesh<double> mesh = mesh_from(a, a.scene);
    const Box3d box = box_of(mesh);
    FlowScene<3> scene;
    scene.up = a.up != "auto" ? a.up[0] - 'x' : upright_of(a, mesh.view()).axis;
    const Vec3d extent = box.extent();
    const double volume = extent[0] * extent[1] * extent[2];
    if (!(volume > 0)) throw InputError(a.scene + ": the mesh is flat, and has no room for a fluid");
    const double spacing =
        a.spacing > 0 ? a.spacing : std::cbrt(volume / static_cast<double>(usual_particles[1]));
    expect_memory_of_particles(volume / std::pow(spacing, 3));
    scene.options.spacing = spacing;
    scene.options.gravity = {}, scene.options.gravity[scene.up] = -a.gravity;
    {
        ProgressLine line("filling " + a.scene, a.quiet);
        WatchedExecutor watched(default_executor(), line.progress());
        const auto index = build(mesh, watched);
        scene.start.places = of_file(a.scene, [&] { return fill_mesh(index, spacing, box.low, watched); });
    }
    scene.start.resize(scene.start.places.size());
    if (scene.start.size() == 0)
        throw InputError(fmt::format(
            "{}: no particle fits into the mesh; give a --spacing shorter than {:.3g}", a.scene, spacing));
    for (int k = 0; k < 3; ++k) {
        const double cells = std::ceil(extent[k] / spacing), more = std::ceil(cells / 2);
        scene.tank.low[k] = box.low[k] - more * spacing;
        scene.tank.high[k] = box.low[k] + (cells + (k == scene.up ? 0 : more)) * spacing;
    }
    scene.walls = walls_of_box(scene.tank, spacing);
    if (a.gravity > 0) scene.until = 3 * std::sqrt(2 * scene.tank.extent()[scene.up] / a.gravity);
    return scene;
}

/// Puts the fluid into a mesh, or the mesh into the fluid's tank.
void add_walls(const FlowArguments& a, FlowScene<3>& scene) {
    TriangleMesh<double> mesh = mesh_from(a, a.walls);
    ProgressLine line("making walls of " + a.walls, a.quiet);
    WatchedExecutor watched(default_executor(), line.progress());
    scene.mesh = std::make_shared<const MeshOfWalls>(std::move(mesh), watched);
    std::vector<Side> side(scene.start.size());
    sides(scene.mesh->solid, Strided<Vec3d>(scene.start.places), side, {.threads = watched});
    const auto inside = static_cast<std::size_t>(std::count(side.begin(), side.end(), Side::inside));
    if (inside != 0 && inside != side.size())
        throw InputError(
            fmt::format("{}: {} of {} particles begin inside of this mesh and the others outside; "
                        "a fluid is on one side of its walls",
                        a.walls, inside, side.size()));
    scene.fluid_inside = inside != 0;
    const FluidSide fluid = scene.fluid_inside ? FluidSide::inside : FluidSide::outside;
    FluidWalls<3> walls = of_file(a.walls, [&] {
        return walls_behind(scene.mesh->index, fluid, scene.options.spacing, scene.tank.low, 3, watched);
    });
    if (walls.places.empty())
        throw InputError(
            fmt::format("{}: these walls are thinner than the spacing of particles, {:.3g}; give "
                        "more particles",
                        a.walls, scene.options.spacing));
    if (scene.fluid_inside) {
        scene.tank = box_of(scene.mesh->mesh);
        scene.walls = std::move(walls);
    } else {
        auto& all = scene.walls.places;
        all.insert(all.end(), walls.places.begin(), walls.places.end());
    }
}
/// Fills the mesh of --inflow. Sound is at least ten times as fast as what flows in and falls.
void add_inflow(const FlowArguments& a, FlowScene<3>& scene) {
    const TriangleMesh<double> mesh = mesh_from(a, a.inflow);
    const auto index = build(mesh);
    scene.inflow = of_file(a.inflow, [&] { return fill_mesh(index, scene.options.spacing, scene.tank.low); });
    if (scene.inflow.empty())
        throw InputError(fmt::format("{}: no particle fits into this source; they are {:.3g} apart", a.inflow,
                                     scene.options.spacing));
    const double fall = box_of(mesh).high[scene.up] - scene.tank.low[scene.up],
                 speed2 = std::pow(a.inflow_velocity[0], 2) + std::pow(a.inflow_velocity[1], 2) +
                          std::pow(a.inflow_velocity[2], 2);
    if (a.sound > 0) return;
    const double sound =
        std::max(scene.options.sound, 10 * std::sqrt(speed2 + 2 * a.gravity * std::max(0.0, fall)));
    if (scene.options.sound > 0)
        for (double& c : scene.start.compressions) c *= std::pow(scene.options.sound / sound, 2);
    scene.options.sound = sound;
}
template <int D>
void expect_room(const FlowArguments& a, const FlowScene<D>& scene) {
    if (scene.walls.places.empty()) return;
    NearLists<double> near;
    neighbours_within(scene.walls.places, scene.start.places, 0.45 * scene.options.spacing, near);
    if (near.ids.empty()) return;
    std::size_t i = 0;
    while (near.offsets[i + 1] == 0) ++i;
    std::string place;
    for (int k = 0; k < D; ++k)
        place += fmt::format("{}{:.4g}", k == 0 ? "" : ", ", scene.start.places[i][k]);
    throw InputError(
        fmt::format("{}: the fluid touches its walls at {}: {} particles begin less than half a "
                    "spacing ({:.3g}) from them. Move the walls, or give more particles",
                    a.scene, place, near.ids.size(), scene.options.spacing));
}

}  // namespace

template <int D>
double FlowScene<D>::depth() const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const auto& p : start.places) low = std::min(low, p[up]), high = std::max(high, p[up]);
    return start.places.empty() ? 0 : high - low + options.spacing;
}

template <int D>
FlowScene<D> flow_scene(const FlowArguments& a) {
    FlowScene<D> scene;
    if (a.scene.starts_with("gen:")) {
        scene = generated<D>(a);
    } else if constexpr (D == 3) {
        scene = from_mesh(a);
    } else {
        throw UsageError("--plane is for generated scenes, as gen:dam; a mesh is filled in space");
    }
    if (!a.walls.empty()) {
        if constexpr (D == 3)
            add_walls(a, scene);
        else
            throw UsageError("--walls are meshes, in space: leave --plane out");
    }
    // By the start, also where a run goes on.
    if (scene.options.sound == 0 && a.sound <= 0 && a.gravity > 0)
        scene.options = filled_in(scene.options, scene.start, scene.walls);
    if (!a.inflow.empty()) {
        if constexpr (D == 3)
            add_inflow(a, scene);
        else
            throw UsageError("--inflow is a mesh, in space: leave --plane out");
    }
    expect_room(a, scene);
    if (a.sound > 0) scene.options.sound = a.sound;
    if (a.viscosity > 0) scene.options.viscosity = a.viscosity;
    return scene;
}
template FlowScene<2> flow_scene<2>(const FlowArguments&);
template FlowScene<3> flow_scene<3>(const FlowArguments&);

template <int D>
std::size_t leaks(const FlowScene<D>& scene, const FluidState<D>& state) {
    const double allowed = 0.3 * scene.options.spacing;
    std::size_t count = 0;
    if constexpr (D == 3)
        if (scene.mesh != nullptr) {
            std::vector<double> distances(state.size());
            signed_distances(scene.mesh->solid, Strided<Vec3d>(state.places), distances);
            for (const double d : distances) count += (scene.fluid_inside ? d : -d) > allowed;
            if (scene.fluid_inside) return count;
        }
    for (const auto& p : state.places) {
        bool outside = false;
        for (int k = 0; k < D; ++k)
            outside |= p[k] < scene.tank.low[k] - allowed || p[k] > scene.tank.high[k] + allowed;
        count += outside;
    }
    return count;
}
template std::size_t leaks(const FlowScene<2>&, const FluidState<2>&);
template std::size_t leaks(const FlowScene<3>&, const FluidState<3>&);
template struct FlowScene<2>;
template struct FlowScene<3>;

}  // namespace hedgerow::cli
