/// A smooth closed surface with fine detail.
#include <cmath>

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>

#include "noise.h"
#include "precision.h"
#include "steps.h"

namespace hedgerow {
namespace {

constexpr double bent = 0.7, bends = 1.5;  // how far space is bent, and the lattice cells a unit
constexpr double roughness = 0.08;         // the first octave's height
constexpr double coarsest_skin = 3;        // lattice cells a unit in the first octave
constexpr int octaves_of_skin = 7;
constexpr double height_to_width = 1.4;
constexpr double jitter = 0.15;  // of the distance between vertices

/// A point of the cube [-1, 1]³ on the unit sphere, so that a regular grid stays nearly regular.
Vec3d on_sphere(const Vec3d& p) {
    Vec3d q;
    for (int k = 0; k < 3; ++k) {
        const double a = p[(k + 1) % 3], b = p[(k + 2) % 3], a2 = product(a, a), b2 = product(b, b);
        q[k] = product(p[k], std::sqrt(1 - a2 / 2 - b2 / 2 + product(a2, b2) / 3));
    }
    return q;
}

/// Where a point of the unit sphere lies on the boulder: octaves of noise move it along the sphere's normal,
/// and three more noises bend the space around it.
Vec3d sculpted(std::uint64_t seed, const Vec3d& on) {
    double skin = 0, amplitude = roughness, scale = coarsest_skin;
    std::uint64_t stream = scattered(seed);
    for (int i = 0; i < octaves_of_skin; ++i, amplitude /= 2, scale *= 2)
        skin += product(amplitude, detail::value_noise<3>(stream++, on * scale) - 0.5);
    Vec3d p = on * (1 + skin);
    for (int k = 0; k < 3; ++k) p[k] += product(bent, detail::value_noise<3>(stream++, on * bends) - 0.5);
    return {p[0], p[1], product(height_to_width, p[2])};
}

TriangleMesh<double> build_boulder(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    TriangleMesh<double> mesh = cube<double>(size, detail::part_of(progress));
    // A side of the cube is a sixth of the triangles, two for each vertex.
    const double apart = 2 / std::sqrt(static_cast<double>(mesh.size()) / 12);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        detail::step(progress, i, mesh.vertices.size());
        // Move the vertex on the sphere, since a scanner's vertices are not regular.
        const Vec3d aside = Random(scattered(seed) - 1, i).direction<3>() * (jitter * apart);
        mesh.vertices[i] = sculpted(seed, normalized(on_sphere(mesh.vertices[i]) + aside));
    }
    return mesh;
}

}  // namespace

template <class T>
TriangleMesh<T> boulder(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return detail::in_precision<T>([&] { return build_boulder(size, seed, progress); });
}
template TriangleMesh<float> boulder<float>(std::uint64_t, std::uint64_t, const Progress&);
template TriangleMesh<double> boulder<double>(std::uint64_t, std::uint64_t, const Progress&);

}  // namespace hedgerow
