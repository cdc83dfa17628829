#include <hedgerow/fluid/fluid_walls.h>

#include <cmath>
#include <string>

#include <hedgerow/base/error.h>

#include "lattice_cells.h"

namespace hedgerow {

using detail::Cell, detail::for_each_cell, detail::middle_of;

namespace {

/// How many spacings a box is long along each axis.
template <int D>
Cell<D> cells_of(const Box<double, D>& box, double spacing) {
    Cell<D> count{};
    for (int k = 0; k < D; ++k) {
        const double cells = (box.high[k] - box.low[k]) / spacing, whole = std::round(cells);
        if (!(spacing > 0) || !(cells >= 0.5) || !(cells < 1e6) || std::abs(cells - whole) > 1e-6 * whole)
            throw UsageError("a box that is " + std::to_string(box.high[k] - box.low[k]) +
                             " long is not a multiple of the spacing " + std::to_string(spacing) +
                             ": choose one of which its sides are multiples");
        count[static_cast<std::size_t>(k)] = static_cast<int>(whole);
    }
    return count;
}

}  // namespace

template <int D>
std::vector<Vec<double, D>> fill_box(const Box<double, D>& box, double spacing) {
    std::vector<Vec<double, D>> places;
    for_each_cell<D>({}, cells_of(box, spacing),
                     [&](const auto& cell) { places.push_back(middle_of<D>(box.low, cell, spacing)); });
    return places;
}

template <int D>
FluidWalls<D> walls_of_box(const Box<double, D>& box, double spacing, const BoxFaces<D>& faces, int layers) {
    const Cell<D> count = cells_of(box, spacing);
    Cell<D> low{}, high = count;
    for (std::size_t k = 0; k < D; ++k) {
        if (faces.low[k]) low[k] -= layers;
        if (faces.high[k]) high[k] += layers;
    }
    FluidWalls<D> walls;
    for_each_cell<D>(low, high, [&](const auto& cell) {
        bool inside = true;
        for (std::size_t k = 0; k < D; ++k) inside &= cell[k] >= 0 && cell[k] < count[k];
        if (!inside) walls.places.push_back(middle_of<D>(box.low, cell, spacing));
    });
    return walls;
}

template std::vector<Vec2d> fill_box(const Box<double, 2>&, double);
template std::vector<Vec3d> fill_box(const Box<double, 3>&, double);
template FluidWalls<2> walls_of_box(const Box<double, 2>&, double, const BoxFaces<2>&, int);
template FluidWalls<3> walls_of_box(const Box<double, 3>&, double, const BoxFaces<3>&, int);

}  // namespace hedgerow
