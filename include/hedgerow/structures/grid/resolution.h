/// How many cells a grid has.
#pragma once

#include <string_view>

#include <hedgerow/geometry/lattice.h>

namespace hedgerow {

/// The axes along which a box is not flat, by its extents as shares of the longest one.
struct SpannedAxes {
    int count = 0;
    double volume = 1;  ///< of the box across these axes, in longest extents

    template <int D>
    explicit SpannedAxes(const Vec<double, D>& shares) {
        for (int a = 0; a < D; ++a)
            if (spans(shares[a])) volume = product(volume, shares[a]), ++count;
    }
    static bool spans(double share) { return share > 1e-3; }
    /// The side of a cube of volume x across these axes.
    double root(double x) const { return count == 1 ? x : count == 2 ? std::sqrt(x) : std::cbrt(x); }
    /// How many of `cells` cubes that fill the box lie along the longest axis.
    double cells_on_longest(double cells) const { return root(std::max(1.0, cells) / volume); }
};

/// `density`: so many cells for each primitive, as cubic as the scene allows (Cleary and Wyvill 1988); a
/// density of 1 gives about as many cells as primitives. `roots`: 3·∛n along each axis (in the plane 3·√n),
/// whatever the scene's shape.
enum class GridHeuristic { density, roots };
inline constexpr std::string_view grid_heuristic_names[] = {"density", "roots"};

struct GridResolution {
    GridHeuristic heuristic = GridHeuristic::density;
    double density = 4;
    /// Cells on the longest axis, set by hand. 0: by the heuristic.
    int resolution = 0;

    /// Lists the options (option.h) of a grid in D dimensions.
    template <int D, class Option>
    void list(Option& option) {
        option("density", density, 1e-9, 1e6, "cells a primitive");
        option("heuristic", heuristic, grid_heuristic_names,
               "density: so many cells a primitive; roots: 3 cube roots of n along each axis");
        option("resolution", resolution, 0, Lattice<D>::most_cells,
               "cells on the longest axis; 0: by the heuristic");
    }

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
        if (resolution > 0) return share * double(resolution);
        const SpannedAxes axes(share);
        if (heuristic == GridHeuristic::density) return share * axes.cells_on_longest(density * count);
        return map(share, [&](double s) { return axes.spans(s) ? 3 * axes.root(count) : 1.0; });
    }
};

}  // namespace hedgerow
