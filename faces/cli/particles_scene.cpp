/// The scene of `hedgerow particles`: the mesh with its floor, and where particles are born.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <hedgerow/base/error.h>
#include <hedgerow/render/camera/presets.h>

#include "memory.h"
#include "particles.h"

namespace hedgerow::cli {

namespace {

TriangleMesh<double> mesh_of(const ParticlesArguments& a) {
    auto scene = load<double>(a);
    auto* const mesh = std::get_if<TriangleMesh<double>>(&scene);
    if (mesh == nullptr || mesh->size() == 0)
        throw InputError(a.scene + ": particles need a mesh of triangles to bounce off");
    return std::move(*mesh);
}
void set_unless_given(double& number, double usual) {
    if (number < 0) number = usual;
}

}  // namespace

ParticlesScene::ParticlesScene(ParticlesArguments& a)
    : mesh(mesh_of(a)), upright(upright_of(a.view, a, mesh)) {
    Box3d box;
    for (std::size_t i = 0; i < mesh.size(); ++i) box.expand(mesh.view().bounds(i));
    size = length(box.extent());
    if (!(size > 0)) throw InputError(a.scene + ": the mesh has no extent: all of it is in one place");
    const std::size_t triangles = mesh.size();
    if (!a.no_floor) add_floor(box);
    choose(a, box, triangles);
    ProgressLine line("building the index", a.quiet);
    WatchedExecutor watched(default_executor(), line.progress());
    index = build(mesh, watched);
}

void ParticlesScene::choose(ParticlesArguments& a, const Box3d& box, std::size_t triangles) {
    // Numbers follow from the size of the mesh and from the time in which a particle falls about that far.
    set_unless_given(a.gravity, 4 * size);
    const double time = a.gravity > 0 ? std::sqrt(size / a.gravity) : 0.5;
    const bool sparks = a.emit == "sparks", rain = a.emit == "rain";
    set_unless_given(a.until, 8 * time);
    set_unless_given(a.every, a.until > 0 ? a.until / 8 : time);
    set_unless_given(a.dt, 0.01 * time);
    set_unless_given(a.rate, (sparks ? 2500 : rain ? 200 : 300) / time);
    set_unless_given(a.life, (sparks ? 1 : 8) * time);
    set_unless_given(a.radius, (sparks ? 0.004 : 0.012) * size);
    set_unless_given(a.speed, (sparks ? 0.7 : rain ? 0 : 0.9) * size / time);
    set_unless_given(a.spread, sparks ? 40 : rain ? 0 : 10);
    set_unless_given(a.drag, sparks ? 0.5 / time : 0);
    set_unless_given(a.restitution, sparks ? 0.3 : 0.5);
    a.alone = a.alone || sparks;
    if (a.colour == "auto") a.colour = sparks ? "age" : "speed";
    fastest = 1.5 * size / time;

    // Describe the emitter.
    const Vec3d up(scene_axes(upright.axis).up), middle = box.center();
    ParticleEmitter emitter;
    emitter.rate = a.rate, emitter.life = a.life, emitter.speed = a.speed, emitter.radius = a.radius;
    emitter.life_spread = sparks ? 0.5 * a.life : 0;
    emitter.speed_spread = sparks ? 0.5 * a.speed : 0.1 * a.speed;
    emitter.spread = a.spread * std::numbers::pi / 180;
    emitter.direction = rain ? -up : up;
    const double above = box.high[upright.axis] - middle[upright.axis];
    if (sparks) {
        // Sparks leave the mesh, not its floor.
        emitter.source = FromSurface{{std::span(mesh.vertices), std::span(mesh.triangles).first(triangles)}};
    } else if (rain) {
        FromBox cloud{box};
        cloud.box.low[upright.axis] = box.high[upright.axis] + 0.3 * size;
        cloud.box.high[upright.axis] = box.high[upright.axis] + 0.4 * size;
        emitter.source = cloud;
    } else {
        emitter.source = FromDisc{middle + up * (above + 2 * a.radius), 0.04 * size};
    }
    options.emitters = {emitter};
    options.forces.gravity = up * -a.gravity, options.forces.linear_drag = a.drag;
    options.forces.wind = {a.wind[0], a.wind[1], a.wind[2]};
    options.contacts = {a.restitution, a.friction, !a.alone};
    options.seed = a.seed;
    // Show some room around the mesh and above it.
    Box3d room = box;
    room.high[upright.axis] += 0.3 * size;
    shown = {Vec3f(room.low), Vec3f(room.high)};
    expect_memory("a run with so many particles alive at once", a.rate * (a.life + emitter.life_spread) * 300,
                  "ask for a smaller --rate or a shorter --life");
}

void ParticlesScene::add_floor(const Box3d& box) {
    const SceneAxes axes = scene_axes(upright.axis);
    const Vec3d right(axes.right), back(axes.back);
    Vec3d middle = box.center();
    middle[upright.axis] = box.low[upright.axis];
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const double half = 1.5 * size;
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
        mesh.vertices.push_back(middle + right * (half * x) + back * (half * y));
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
    mesh.faces.clear();  // which would need numbers for these
}

}  // namespace hedgerow::cli
