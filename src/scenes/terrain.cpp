/// A fractal landscape.
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>

#include "noise.h"
#include "precision.h"
#include "sizing.h"
#include "steps.h"

namespace hedgerow {
namespace {

constexpr int octaves = 11;
constexpr double coarsest_cells = 3;  // lattice cells along the square's side in the first octave
constexpr double relief = 0.125;      // half the height that all octaves together can reach

double height_at(std::uint64_t seed, Vec2d p) {
    double sum = 0, amplitude = relief;
    p = p * coarsest_cells;
    for (int i = 0; i < octaves; ++i) {
        sum += product(amplitude, detail::value_noise<2>(scattered(seed) + static_cast<std::uint64_t>(i), p));
        amplitude /= 2;
        // Twice as fine, turned by the angle with cosine 4/5 and sine 3/5.
        p = Vec2d(product(1.6, p[0]) - product(1.2, p[1]), product(1.2, p[0]) + product(1.6, p[1]));
    }
    return sum;
}

TriangleMesh<double> build_terrain(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    const detail::Split split = detail::nearest_split(size, {2});
    const auto columns = static_cast<std::uint32_t>(split.columns),
               rows = static_cast<std::uint32_t>(split.rows);
    TriangleMesh<double> mesh;
    mesh.vertices.reserve(std::size_t{columns + 1} * (rows + 1));
    mesh.triangles.reserve(std::size_t{2} * columns * rows);
    // Add the vertices, in rows along x.
    for (std::uint32_t k = 0; k <= rows; ++k)
        for (std::uint32_t i = 0; i <= columns; ++i) {
            detail::step(progress, mesh.vertices.size(), mesh.vertices.capacity());
            const Vec2d p(static_cast<double>(i) / columns, static_cast<double>(k) / rows);
            mesh.vertices.push_back({p[0], p[1], height_at(seed, p)});
        }
    // Add two triangles per cell.
    for (std::uint32_t k = 0; k < rows; ++k) {
        progress.look();
        for (std::uint32_t i = 0; i < columns; ++i) {
            const std::uint32_t here = k * (columns + 1) + i, above = here + columns + 1;
            mesh.triangles.push_back({here, here + 1, above + 1});
            mesh.triangles.push_back({here, above + 1, above});
        }
    }
    return mesh;
}

}  // namespace

template <class T>
TriangleMesh<T> terrain(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return detail::in_precision<T>([&] { return build_terrain(size, seed, progress); });
}
template TriangleMesh<float> terrain<float>(std::uint64_t, std::uint64_t, const Progress&);
template TriangleMesh<double> terrain<double>(std::uint64_t, std::uint64_t, const Progress&);

}  // namespace hedgerow
