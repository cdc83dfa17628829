/// What the kernels of a flow do: sums over the neighbours of particles.
///
/// Lengths are in units of the smoothing length h, speeds of the speed of sound c, times of h/c and pressures
/// of ρ₀c²; so all numbers are of moderate size, and a pressure is the compression itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <tuple>

#include <hedgerow/base/bare_vector.h>
#include <hedgerow/base/instruction_set.h>

namespace hedgerow::detail {

/// Particles in the order of cells, a row for each number that kernels read.
///
/// Places are in fixed point, modulo 2³² units. The difference of two neighbours is then exact as a 32-bit
/// integer, wherever they are; and along an axis that repeats the period is a multiple of 2³² units, so the
/// difference is that to the nearest image.
template <int D>
struct FlowRows {
    BareVector<std::uint32_t> at[D];
    BareVector<float> velocity[D];
    BareVector<float> compression;
    BareVector<float>
        mirrored_velocity[D];  ///< of viscous walls: what keeps the fluid at the wall's velocity

    void resize(std::size_t count) {
        for (int k = 0; k < D; ++k) at[k].resize(count), velocity[k].resize(count);
        compression.resize(count);
    }
};

/// Constants of a flow.
template <int D>
struct FlowScales {
    float per_unit[D];  ///< a unit of fixed point
    float gravity[D];
    float share;                 ///< of a particle at distance 0: its volume times the kernel
    float slope;                 ///< a particle's share has the gradient -slope·(1 - r/2)³ times the offset
    float artificial_viscosity;  ///< α
    float viscosity;             ///< twice the kinematic one
    float diffusion;             ///< 2·δ
    float guard;                 ///< walls push by 2 - guard·r more, where that is above 0
};

/// Particles whose neighbours are summed over: numbers [first, end) of `own`, with lists one after the other
/// that end at `ends` in `ids`.
template <int D>
struct FlowTask {
    const FlowScales<D>* scales;
    const FlowRows<D>*own, *others;
    std::uint32_t first, end;
    const std::size_t* ends;
    const std::uint32_t* ids;
    /// Sums for each particle of `own`.
    float* acceleration[D];
    float *rate, *fill;
};

template <int D>
struct FlowKernelsOf {
    using Kernel = void(const FlowTask<D>&);
    /// What the fluid does to its particles: accelerations, rates of compression, and the share of their
    /// surroundings that it fills. The second is for viscous fluids.
    Kernel* of_fluid[2];
    /// Adds what walls do to accelerations and rates, and tells the share that they fill.
    Kernel* of_walls[2];
    /// What walls take from the fluid beside them: its velocity as `acceleration`, and the compression that
    /// its pressure and weight give as `rate`; `fill` is the sum of weights.
    Kernel* at_walls;
};
using FlowKernels = std::tuple<FlowKernelsOf<2>, FlowKernelsOf<3>>;

/// The kernels in use, or those without vectors; all give the same bits.
const FlowKernels& flow_kernels();

}  // namespace hedgerow::detail

namespace hedgerow {
template <>
const detail::FlowKernels* in_use<detail::FlowKernels>();
}  // namespace hedgerow
