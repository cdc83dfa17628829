/// Random triangles.
#include <string>

#include <hedgerow/base/error.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>

#include "precision.h"
#include "sizing.h"
#include "steps.h"

namespace hedgerow {
namespace {

TriangleMesh<double> build_soup(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    constexpr std::uint64_t most = (std::uint64_t{1} << 32) / 3;
    if (size > most)
        throw UsageError("gen:soup: " + std::to_string(size) + " triangles are too many; ask for at most " +
                         std::to_string(most));
    const double radius = 0.5 / detail::cube_root(static_cast<double>(size > 0 ? size : 1));
    TriangleMesh<double> mesh;
    mesh.vertices.reserve(3 * size);
    mesh.triangles.reserve(size);
    for (std::uint64_t i = 0; i < size; ++i) {
        detail::step(progress, i, size);
        Random random(seed, i);
        const Vec3d center = Vec3d::all(radius) + random.in_cube<3>() * (1 - 2 * radius);
        const auto first = static_cast<std::uint32_t>(3 * i);
        for (int k = 0; k < 3; ++k) mesh.vertices.push_back(center + random.direction<3>() * radius);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

}  // namespace

template <class T>
TriangleMesh<T> soup(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return detail::in_precision<T>([&] { return build_soup(size, seed, progress); });
}
template TriangleMesh<float> soup<float>(std::uint64_t, std::uint64_t, const Progress&);
template TriangleMesh<double> soup<double>(std::uint64_t, std::uint64_t, const Progress&);

}  // namespace hedgerow
