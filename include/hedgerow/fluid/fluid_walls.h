/// Walls that hold a fluid, and lattices of particles that fill what they enclose.
#pragma once

#include <array>
#include <vector>

#include <hedgerow/geometry/box.h>
#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// Particles that stand still and hold a fluid: layers of them behind a wall, a spacing apart, the first half
/// a spacing behind it.
template <int D>
struct FluidWalls {
    std::vector<Vec<double, D>> places;
    /// Speeds of the wall along itself, as those of a belt, which a viscous fluid clings to: one a particle,
    /// or none where all stand.
    std::vector<Vec<double, D>> velocities = {};
};

/// Which faces of a box have a wall.
template <int D>
struct BoxFaces {
    std::array<bool, D> low = all(), high = all();

    static constexpr std::array<bool, D> all() {
        std::array<bool, D> faces{};
        faces.fill(true);
        return faces;
    }
    /// All but that above: a tank.
    static constexpr BoxFaces open_above() {
        BoxFaces faces;
        faces.high[D - 1] = false;
        return faces;
    }
};

/// Particles at the middles of the cells of a lattice that fills a box: the first is half a spacing from its
/// low corner. Throws UsageError for a spacing of which the box is not a multiple along each axis.
template <int D>
std::vector<Vec<double, D>> fill_box(const Box<double, D>& box, double spacing);

/// Layers of particles around a box, on the lattice of `fill_box`: `layers` of them behind each face that has
/// a wall, and around the edges of those. Three are as many as the usual smoothing lengths need. Throws
/// UsageError as `fill_box` does.
template <int D>
FluidWalls<D> walls_of_box(const Box<double, D>& box, double spacing, const BoxFaces<D>& faces = {},
                           int layers = 3);

}  // namespace hedgerow
