/// A ball of hair.
#include <algorithm>
#include <cmath>

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>

#include "precision.h"
#include "steps.h"

namespace hedgerow {
namespace {

constexpr std::uint32_t steps = 16;     // of a strand; two triangles each
constexpr double step_angle = 1.0 / 8;  // in radians, about: a strand spans a third of a circle
constexpr double inner_radius = 0.5, outer_radius = 1;  // radii between which strands run
constexpr double widest_strand = 1.0 / 32, curl = 0.5;

/// Adds a strand. It wanders over a sphere and bends evenly to one side, while its radius goes evenly from
/// `from` to `to`. `at` is the direction from the middle, and `along` that of the strand: unit vectors at
/// right angles.
void grow_strand(TriangleMesh<double>& mesh, double width, Random& random) {
    Vec3d at = random.direction<3>();
    Vec3d along = normalized(cross(at, random.direction<3>()));
    const double from = random.uniform(inner_radius, outer_radius),
                 to = random.uniform(inner_radius, outer_radius);
    const double bend = product(step_angle, random.uniform(-curl, curl));
    for (std::uint32_t i = 0; i <= steps; ++i) {
        const Vec3d aside = cross(at, along);
        const double radius = from + product(to - from, static_cast<double>(i) / steps);
        // Add two vertices across the strand, and two triangles up to the next two.
        const auto left = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(at * radius + aside * (width / 2));
        mesh.vertices.push_back(at * radius - aside * (width / 2));
        if (i == steps) break;
        mesh.triangles.push_back({left, left + 1, left + 3});
        mesh.triangles.push_back({left, left + 3, left + 2});
        // Step along the sphere, and bend.
        const Vec3d next = normalized(at + along * step_angle);
        const Vec3d onward = along + aside * bend;
        along = normalized(onward - next * dot(onward, next));
        at = next;
    }
}

TriangleMesh<double> build_hairball(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    const std::uint64_t strands = std::max<std::uint64_t>(1, (size + steps) / (2 * steps));
    const double width = std::min(widest_strand, 0.5 / std::sqrt(static_cast<double>(strands)));
    TriangleMesh<double> mesh;
    mesh.vertices.reserve(strands * 2 * (steps + 1));
    mesh.triangles.reserve(strands * 2 * steps);
    for (std::uint64_t i = 0; i < strands; ++i) {
        detail::step(progress, i * steps, strands * steps, steps);
        Random random(seed, i);
        grow_strand(mesh, width, random);
    }
    return mesh;
}

}  // namespace

template <class T>
TriangleMesh<T> hairball(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return detail::in_precision<T>([&] { return build_hairball(size, seed, progress); });
}
template TriangleMesh<float> hairball<float>(std::uint64_t, std::uint64_t, const Progress&);
template TriangleMesh<double> hairball<double>(std::uint64_t, std::uint64_t, const Progress&);

}  // namespace hedgerow
