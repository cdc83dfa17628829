/// Particles that have masses and move, and their state at a time.
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

/// Particles at a time, and what acts on them: all that a motion goes on from.
struct MotionState {
    double time = 0;
    Particles particles;
    std::vector<Vec3d> accelerations;
    std::vector<double> potentials;  ///< per mass: −G·Σ m/r
};

}  // namespace hedgerow
