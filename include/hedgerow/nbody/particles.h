/// Particles that have masses and move.
#pragma once

#include <cstddef>
#include <vector>

#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// Particles, an element of each array for each of them.
struct Particles {
    std::vector<Vec3d> places, velocities;
    std::vector<double> masses;

    std::size_t size() const { return places.size(); }
    /// Makes room for so many particles; new ones are at rest at the origin, without mass.
    void resize(std::size_t count) { places.resize(count), velocities.resize(count), masses.resize(count); }
};

}  // namespace hedgerow
