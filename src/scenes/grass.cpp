/// A meadow: blades of grass on uneven ground.
#include <algorithm>
#include <cmath>

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>

#include "parts.h"
#include "precision.h"
#include "steps.h"

namespace hedgerow {
namespace {

constexpr std::uint64_t triangles_a_blade = 3;
constexpr double shortest = 0.02, longest = 0.05;
constexpr double widest_blade = 1.0 / 256;

/// A uniform random point of a triangle: a point of the parallelogram, folded over its diagonal.
Vec3d point_of(const TriangleMesh<double>& mesh, const TriangleIndices& t, Random& random) {
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Vec3d a = mesh.vertices[t[0]];
    return a + (mesh.vertices[t[1]] - a) * u + (mesh.vertices[t[2]] - a) * v;
}

/// Adds a blade: a strip of two pieces that narrows to its tip and bends over, more so further up.
void grow_blade(TriangleMesh<double>& mesh, const Vec3d& root, double width, Random& random) {
    const double height = random.uniform(shortest, longest);
    const Vec2d toward = random.direction<2>();
    const Vec3d lean = Vec3d(toward[0], toward[1], 0) * product(height, random.uniform(0.2, 0.8));
    const Vec3d side = Vec3d(-toward[1], toward[0], 0) * (width / 2);
    const Vec3d middle = root + lean * 0.25 + Vec3d(0, 0, height * 0.625);
    const Vec3d tip = root + lean + Vec3d(0, 0, height);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3d& p : {root - side, root + side, middle - side * 0.75, middle + side * 0.75, tip})
        mesh.vertices.push_back(p);
    mesh.triangles.push_back({first, first + 1, first + 3});
    mesh.triangles.push_back({first, first + 3, first + 2});
    mesh.triangles.push_back({first + 2, first + 3, first + 4});
}

TriangleMesh<double> build_grass(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    TriangleMesh<double> mesh =
        terrain<double>(detail::ground_size_of_grass(size), seed, detail::part_of(progress));
    const std::size_t ground = mesh.triangles.size();
    const std::uint64_t blades = size > ground ? (size - ground + 1) / triangles_a_blade : 0;
    // A blade is at most a third as wide as the mean distance between blades.
    const double spacing = 1 / std::sqrt(static_cast<double>(std::max<std::uint64_t>(blades, 1)));
    const double width = std::min(widest_blade, spacing / 3);
    mesh.vertices.reserve(mesh.vertices.size() + 5 * blades);
    mesh.triangles.reserve(ground + triangles_a_blade * blades);
    for (std::uint64_t i = 0; i < blades; ++i) {
        detail::step(progress, i, blades);
        Random random(~seed, i);
        const TriangleIndices under = mesh.triangles[random.bits() % ground];
        grow_blade(mesh, point_of(mesh, under, random), width, random);
    }
    return mesh;
}

}  // namespace

template <class T>
TriangleMesh<T> grass(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return detail::in_precision<T>([&] { return build_grass(size, seed, progress); });
}
template TriangleMesh<float> grass<float>(std::uint64_t, std::uint64_t, const Progress&);
template TriangleMesh<double> grass<double>(std::uint64_t, std::uint64_t, const Progress&);

}  // namespace hedgerow
