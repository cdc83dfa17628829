/// The interior: a flat of six rooms, furnished as finely as the size allows.

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>

#include "interior_flat.h"
#include "precision.h"
#include "welding.h"

namespace hedgerow {
namespace {

using detail::append;
using detail::flat;
using detail::in_precision;
using detail::Thing;

/// Adds things in order, but skips each that would make the mesh larger than `size`. The first is always
/// added.
TriangleMesh<double> furnished(const std::vector<Thing>& things, std::uint64_t level, std::uint64_t size,
                               std::uint64_t seed, const Progress& progress) {
    TriangleMesh<double> mesh;
    for (std::size_t i = 0; i < things.size(); ++i) {
        progress.look();
        progress(mesh.size(), size);
        detail::Model model(level);
        things[i](model, Random(seed, i));
        if (i == 0 || mesh.size() + model.mesh.size() <= size) append(mesh, model.mesh);
    }
    return mesh;
}

/// Whether all things together have at least `size` triangles.
bool fills(const std::vector<Thing>& things, std::uint64_t level, std::uint64_t size, std::uint64_t seed,
           const Progress& progress) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < things.size() && count < size; ++i) {
        progress.look();
        detail::Model model(level);
        things[i](model, Random(seed, i));
        count += model.mesh.size();
    }
    return count >= size;
}

TriangleMesh<double> build_interior(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    const std::vector<Thing> things = flat();
    // Find the least level that fills the size. Counts grow with the level.
    std::uint64_t below = 0, enough = 0;
    for (std::uint64_t step = 1; !fills(things, enough, size, seed, progress); step *= 2)
        below = enough + 1, enough += step;
    while (below < enough) {
        const std::uint64_t middle = below + (enough - below) / 2;
        if (fills(things, middle, size, seed, progress))
            enough = middle;
        else
            below = middle + 1;
    }
    return furnished(things, enough, size, seed, progress);
}

}  // namespace

template <class T>
TriangleMesh<T> interior(std::uint64_t size, std::uint64_t seed, const Progress& progress) {
    return in_precision<T>([&] { return build_interior(size, seed, progress); });
}
template TriangleMesh<float> interior<float>(std::uint64_t, std::uint64_t, const Progress&);
template TriangleMesh<double> interior<double>(std::uint64_t, std::uint64_t, const Progress&);

}  // namespace hedgerow
