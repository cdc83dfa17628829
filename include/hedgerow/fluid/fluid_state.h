/// A fluid of particles at a time.
#pragma once

#include <cstddef>
#include <vector>

#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// Particles of a fluid in space (D = 3) or in the plane (D = 2), an element of each array for each: all that
/// a flow goes on from. Particles keep their numbers.
template <int D>
struct FluidState {
    double time = 0;
    std::vector<Vec<double, D>> places, velocities;
    /// By how much a particle's density exceeds that at rest, as a share of it: ρ/ρ₀ − 1. The pressure is
    /// this times ρ₀·sound².
    std::vector<double> compressions;
    /// Rates of change in the middle of the last step.
    std::vector<Vec<double, D>> accelerations;
    std::vector<double> compression_rates;

    std::size_t size() const { return places.size(); }
    /// Makes room for so many particles; new ones are at rest at the origin, not compressed.
    void resize(std::size_t count) {
        places.resize(count), velocities.resize(count), compressions.resize(count);
        accelerations.resize(count), compression_rates.resize(count);
    }
};

}  // namespace hedgerow
