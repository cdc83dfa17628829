#include <hedgerow/fluid/mesh_walls.h>

#include <cmath>
#include <string>

#include <hedgerow/ask/insides.h>
#include <hedgerow/base/error.h>

#include "lattice_cells.h"

namespace hedgerow {

using detail::Cell, detail::for_each_cell, detail::middle_of;

namespace {

/// The places of a lattice around a mesh whose signed distance to it, in spacings, lies from `low` to `high`.
std::vector<Vec3d> lattice_at_distances(const MeshIndex<double>& mesh, double spacing, const Vec3d& origin,
                                        double low, double high, Threads threads) {
    if (!(spacing > 0)) throw UsageError("a lattice cannot have the spacing " + std::to_string(spacing));
    const Solid solid(mesh, {}, threads);
    if (!solid.closed())
        throw InputError("the mesh is not closed: " + std::to_string(solid.boundary().open.size()) +
                         " edges are open, and a fluid has no inside to be in. Close them");
    Box3d box;
    for (std::size_t i = 0; i < mesh.size(); ++i) box.expand(mesh.primitives().bounds(i));
    std::vector<Vec3d> found;
    if (box.empty()) return found;
    Cell<3> first{}, end{};
    double cells = 1;
    for (int k = 0; k < 3; ++k) {
        const double from = std::floor((box.low[k] - origin[k]) / spacing - high),
                     to = std::ceil((box.high[k] - origin[k]) / spacing + high);
        cells *= to - from;
        if (!(cells < 0x1p31) || !(std::abs(from) < 0x1p30))
            throw UsageError("a spacing of " + std::to_string(spacing) +
                             " makes more than 2^31 cells of the mesh's box: give a longer one");
        first[static_cast<std::size_t>(k)] = static_cast<int>(from);
        end[static_cast<std::size_t>(k)] = static_cast<int>(to);
    }
    // A layer of the lattice at a time.
    std::vector<Vec3d> places;
    std::vector<double> distances;
    for (int z = first[2]; z < end[2]; ++z) {
        places.clear();
        for_each_cell<3>({first[0], first[1], z}, {end[0], end[1], z + 1},
                         [&](const Cell<3>& cell) { places.push_back(middle_of<3>(origin, cell, spacing)); });
        distances.resize(places.size());
        signed_distances(solid, Strided<Vec3d>(places), distances, {.threads = threads});
        for (std::size_t i = 0; i < places.size(); ++i)
            if (distances[i] >= low * spacing && distances[i] <= high * spacing) found.push_back(places[i]);
    }
    return found;
}
/// Room for what roundings make of distances of half a spacing.
constexpr double half = 0.5 * (1 - 0x1p-20);

}  // namespace

std::vector<Vec3d> fill_mesh(const MeshIndex<double>& mesh, double spacing, const Vec3d& origin,
                             Threads threads) {
    return lattice_at_distances(mesh, spacing, origin, -0x1p31, -half, threads);
}

FluidWalls<3> walls_behind(const MeshIndex<double>& mesh, FluidSide fluid, double spacing,
                           const Vec3d& origin, int layers, Threads threads) {
    const double near = 0x1p-20, far = layers;
    if (fluid == FluidSide::inside) return {lattice_at_distances(mesh, spacing, origin, near, far, threads)};
    return {lattice_at_distances(mesh, spacing, origin, -far, -near, threads)};
}

}  // namespace hedgerow
