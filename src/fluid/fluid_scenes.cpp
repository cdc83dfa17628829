#include <hedgerow/fluid/fluid_scenes.h>

#include <cmath>
#include <numbers>
#include <string>

#include <hedgerow/base/error.h>
#include <hedgerow/base/spelling.h>

namespace hedgerow {

namespace {

/// The axis that points up.
template <int D>
constexpr int up = D - 1;

constexpr FluidSceneInfo all[] = {
    {"dam", "a column, twice as high as wide, that breaks and runs against the other wall of its tank", 2},
    {"long-dam", "a long shallow dam that breaks and runs over a dry floor", 1},
    {"column", "water at rest, compressed by its own weight", 2},
    {"drop", "a ball of water that falls into a pool", 1.5},
    {"wave", "a standing wave, half its length between two walls", 3},
};

/// Numbers of spacings along each axis that make about so many cells of a box whose first side is `unit`
/// cells long, and the other sides multiples of that side.
template <int D>
double spacing_for(std::uint64_t particles, const Vec<double, D>& shape, double unit) {
    double volume = 1;
    for (int k = 0; k < D; ++k) volume *= shape[k] / unit;
    return unit / std::max(2.0, std::round(std::pow(static_cast<double>(particles) / volume, 1.0 / D)));
}

/// The box from the origin to a corner; in space it is `depth` deep.
template <int D>
Box<double, D> box_to(double width, double height, double depth) {
    Box<double, D> box;
    box.low = {};
    box.high[1] = depth, box.high[0] = width, box.high[up<D>] = height;
    return box;
}

/// A scene whose fluid fills a box in the corner of a closed tank. All sides are multiples of `unit`.
template <int D>
FluidScene<D> boxed(std::uint64_t particles, double unit, const Box<double, D>& water,
                    const Box<double, D>& tank, double fall) {
    FluidScene<D> scene;
    FluidOptions<D>& o = scene.options;
    o.spacing = spacing_for<D>(particles, water.high, unit);
    o.sound = 10 * std::sqrt(2 * length(o.gravity) * fall);
    scene.tank = tank;
    scene.start.places = fill_box(water, o.spacing);
    scene.start.resize(scene.start.places.size());
    scene.walls = walls_of_box(tank, o.spacing);
    return scene;
}
/// Compresses the fluid as its weight does, below a level.
template <int D>
void settle(FluidScene<D>& scene, double level) {
    const FluidOptions<D>& o = scene.options;
    for (std::size_t i = 0; i < scene.start.size(); ++i)
        scene.start.compressions[i] =
            std::max(0.0, length(o.gravity) * (level - scene.start.places[i][up<D>]) / (o.sound * o.sound));
}

template <int D>
FluidScene<D> dam(std::uint64_t n) {
    return boxed<D>(n, 0.5, box_to<D>(0.5, 1, 0.5), box_to<D>(2, 2, 0.5), 1);
}
template <int D>
FluidScene<D> long_dam(std::uint64_t n) {
    FluidScene<D> scene = boxed<D>(n, 0.25, box_to<D>(1.5, 0.25, 0.25), box_to<D>(4.5, 0.5, 0.25), 0.25);
    settle(scene, 0.25);
    return scene;
}
template <int D>
FluidScene<D> column(std::uint64_t n) {
    FluidScene<D> scene = boxed<D>(n, 0.5, box_to<D>(0.5, 0.5, 0.5), box_to<D>(0.5, 1, 0.5), 0.5);
    settle(scene, 0.5);
    return scene;
}
template <int D>
FluidScene<D> drop(std::uint64_t n) {
    constexpr double level = 0.25, radius = 0.15;
    FluidScene<D> scene = boxed<D>(n, 0.25, box_to<D>(1, level, 1), box_to<D>(1, 1, 1), 0.75);
    settle(scene, level);
    Vec<double, D> middle = Vec<double, D>::all(0.5);
    middle[up<D>] = 0.6;
    std::vector<Vec<double, D>> places = fill_box(scene.tank, scene.options.spacing);
    std::erase_if(places, [&](const auto& p) { return length(p - middle) > radius; });
    auto& start = scene.start;
    start.places.insert(start.places.end(), places.begin(), places.end());
    start.resize(start.places.size());
    return scene;
}
template <int D>
FluidScene<D> wave(std::uint64_t n) {
    // The velocities of a standing wave of small height, at the moment when the surface is flat.
    constexpr double length = 1, depth = 0.5, k = std::numbers::pi / length;
    const double speed = 0.2 / std::cosh(k * depth);
    FluidScene<D> scene =
        boxed<D>(n, 0.25, box_to<D>(length, depth, 0.25), box_to<D>(length, 1, 0.25), depth);
    settle(scene, depth);
    for (std::size_t i = 0; i < scene.start.size(); ++i) {
        const double x = k * scene.start.places[i][0], y = k * scene.start.places[i][up<D>];
        scene.start.velocities[i][0] = speed * std::sin(x) * std::cosh(y);
        scene.start.velocities[i][up<D>] = -speed * std::cos(x) * std::sinh(y);
    }
    return scene;
}

}  // namespace

std::span<const FluidSceneInfo> fluid_scenes() {
    return all;
}

const FluidSceneInfo& fluid_scene_named(std::string_view name) {
    std::vector<std::string_view> names;
    std::string list;
    for (const FluidSceneInfo& info : all) {
        if (info.name == name) return info;
        names.push_back(info.name);
        list += (list.empty() ? "gen:" : ", gen:") + std::string(info.name);
    }
    throw UsageError("there is no fluid 'gen:" + std::string(name) + "'" + suggestion(name, names) +
                     "; the fluids are " + list);
}

template <int D>
FluidScene<D> fluid_scene(std::string_view name, std::uint64_t particles) {
    const std::string_view known = fluid_scene_named(name).name;
    if (particles < 10 || particles > std::uint64_t{1} << 31)
        throw UsageError("gen:" + std::string(name) + " cannot have " + std::to_string(particles) +
                         " particles: give from 10 to 2^31");
    if (known == "dam") return dam<D>(particles);
    if (known == "long-dam") return long_dam<D>(particles);
    if (known == "column") return column<D>(particles);
    if (known == "drop") return drop<D>(particles);
    return wave<D>(particles);
}
template FluidScene<2> fluid_scene<2>(std::string_view, std::uint64_t);
template FluidScene<3> fluid_scene<3>(std::string_view, std::uint64_t);

}  // namespace hedgerow
