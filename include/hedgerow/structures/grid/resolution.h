/// How many cells a grid has.
#pragma once

#include <hedgerow/geometry/lattice.h>

namespace hedgerow {

/// `density`: so many cells for each primitive, as cubic as the scene allows (Cleary and Wyvill 1988); a
/// density of 1 gives about as many cells as primitives. `roots`: 3·∛n along each axis (in the plane 3·√n),
/// whatever the scene's shape.
enum class GridHeuristic { density, roots };

struct GridResolution {
    GridHeuristic heuristic = GridHeuristic::density;
    double density = 4;
    /// Cells on the longest axis, set by hand. 0: by the heuristic.
    int resolution = 0;

    /// The lattice over the box of `count` primitives. Along an axis in which the box is flat there is one
    /// cell.
    template <std::floating_point T, int D>
    Lattice<D> lattice_over(const Box<T, D>& box, std::size_t count) const {
        const Vec<double, D> extent = Vec<double, D>(box.high) - Vec<double, D>(box.low);
        const Vec<double, D> cells = cells_along(extent, static_cast<double>(count));
        typename Lattice<D>::Cell along;
        for (int a = 0; a < D; ++a)
            along[static_cast<std::size_t>(a)] =
                static_cast<std::int32_t>(std::clamp(cells[a], 1.0, double(Lattice<D>::most_cells)));
        return Lattice<D>::over(box, along);
    }

private:
    template <int D>
    Vec<double, D> cells_along(const Vec<double, D>& extent, double count) const {
        const double longest = max_component(extent);
        if (!(longest > 0)) return Vec<double, D>::all(1);
        const Vec<double, D> share = extent / longest;
        double volume = 1;
        int axes = 0;
        for (int a = 0; a < D; ++a)
            if (share[a] > 1e-3) volume = product(volume, share[a]), ++axes;
        const auto root = [&](double x) { return axes == 1 ? x : axes == 2 ? std::sqrt(x) : std::cbrt(x); };
        if (resolution > 0) return share * double(resolution);
        if (heuristic == GridHeuristic::density) return share * root(std::max(1.0, density * count) / volume);
        return map(share, [&](double s) { return s > 1e-3 ? 3 * root(count) : 1.0; });
    }
};

}  // namespace hedgerow
