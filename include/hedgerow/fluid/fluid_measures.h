/// What a flow is judged by: its energies and momentum, and how far its density is from that at rest.
#pragma once

#include <hedgerow/fluid/fluid_flow.h>

namespace hedgerow {

template <int D>
struct FluidMeasures {
    double kinetic = 0, potential = 0;  ///< energies; the potential one is 0 at the origin
    Vec<double, D> momentum;
    double fastest = 0;           ///< the highest speed
    double mean_compression = 0;  ///< of absolute values
    /// The absolute compression that 99.9% of the particles stay below whose surroundings are at least half
    /// full.
    double compression_of_most = 0;
    /// How many particles have surroundings that are at least half full, and how many of them are compressed
    /// or stretched by more than a twentieth.
    std::size_t dense = 0, far_from_rest = 0;
};

/// Neither the order of particles nor threads change a bit. O(n). D is 2 or 3.
template <int D>
FluidMeasures<D> measures(const FluidFlow<D>& flow, Threads threads = {});

}  // namespace hedgerow
