/// A fractal landscape.
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>

#include "precision.h"
#include "sizing.h"
#include "steps.h"

namespace hedgerow {
namespace {

constexpr int octaves = 11;
constexpr double coarsest_cells = 3;  // lattice cells along the square's side in the first octave
constexpr double relief = 0.125;      // half the height that all octaves together can reach

/// The noise at p: random values in [0, 1) at the points of an octave's lattice, with smooth steps between
/// them. Each seed has its own noise.
double value_noise(std::uint64_t seed, const Vec2d& p) {
    std::uint64_t cell[2];
    double weight[2];
    for (int i = 0; i < 2; ++i) {
        const double shifted = p[i] + 0x1p20;  // positive, so that truncation is the floor
        cell[i] = static_cast<std::uint64_t>(shifted);
        const double f = shifted - static_cast<double>(cell[i]);
        weight[i] = product(product(f, f), 3 - 2 * f);
    }
    const auto row = [&](std::uint64_t y) {
        const double a = Random(seed, (cell[0] << 32) + y).uniform();
        const double b = Random(seed, ((cell[0] + 1) << 32) + y).uniform();
        return a + product(weight[0], b - a);
    };
    const double low = row(cell[1]), high = row(cell[1] + 1);
    return low + product(weight[1], high - low);
}

double height_at(std::uint64_t seed, Vec2d p) {
    double sum = 0, amplitude = relief;
    p = p * coarsest_cells;
    for (int i = 0; i < octaves; ++i) {
        sum += product(amplitude, value_noise(scattered(seed) + static_cast<std::uint64_t>(i), p));
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
