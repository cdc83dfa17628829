/// Fluids that flow: smoothed particle hydrodynamics of a weakly compressible fluid.
///
/// The scheme is δ-SPH (Antuono, Colagrossi, Marrone and Molteni, Free-surface flows solved by means of SPH
/// schemes with numerical diffusive terms, Computer Physics Communications 181, 2010), with the diffusion of
/// density of Molteni and Colagrossi (2009) on what is left of it without its hydrostatic part (Fourtakas,
/// Dominguez, Vacondio and Rogers, Local uniform stencil boundary condition for arbitrary 3-D boundaries,
/// Computers and Fluids 190, 2019), the C2 kernel of Wendland (1995), and walls of particles that take the
/// pressure of the fluid beside them (Adami, Hu and Adams, A generalized wall boundary condition for SPH,
/// Journal of Computational Physics 231, 2012).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <hedgerow/fluid/fluid_state.h>
#include <hedgerow/fluid/fluid_walls.h>
#include <hedgerow/geometry/periods.h>
#include <hedgerow/parallel/executor.h>

namespace hedgerow {

namespace detail {
template <int D>
Vec<double, D> downward(double size) {
    Vec<double, D> v;
    v[D - 1] = -size;
    return v;
}
}  // namespace detail

/// Lengths, times and masses in any units that agree, as metres, seconds and kilograms do.
template <int D>
struct FluidOptions {
    double spacing = 0;  ///< of particles at rest; each is spacing^D large
    /// The speed of sound. Ten times the highest speed keeps the density within about a hundredth; steps are
    /// as much shorter as sound is faster. 0: ten times what a fall from the highest to the lowest particle
    /// or wall gives, √(2·g·height).
    double sound = 0;
    /// The acceleration that acts on all particles; the last axis points up.
    Vec<double, D> gravity = detail::downward<D>(9.81);
    /// The kinematic viscosity. The fluid then clings to walls (Morris, Fox and Zhu 1997); if it is 0, they
    /// are slippery. An artificial viscosity that acts along the lines between particles (Monaghan 2005)
    /// makes up for what this is less than 0.03·h·sound/(2·(D + 2)), h being the smoothing length, and keeps
    /// the flow smooth.
    double viscosity = 0;
    double rest_density = 1000;  ///< only scales pressures
    /// Smoothing length in spacings; particles reach twice as far. 0: 1.5 in the plane and 1.2 in space,
    /// which is 28 and 58 neighbours.
    double smoothing = 0;
    double diffusion = 0.1;  ///< δ, of density
    /// Lengths after which all repeats along each axis; 0 where it does not. Places are not wrapped:
    /// particles may leave the first period.
    Periods<D> periods = {};
};

/// Options with what was left open filled in, as those of a flow from such a start: the smoothing length and
/// the speed of sound. Throws UsageError for options that are out of range, and InputError for coordinates
/// that are not finite.
template <int D>
FluidOptions<D> filled_in(FluidOptions<D> options, const FluidState<D>& start, const FluidWalls<D>& walls);

/// A fluid of equal particles between walls that moves on in steps.
///
/// A step takes O(n) time for n particles and walls, and finds all forces once: places, velocities and
/// densities are half a step ahead for that. The bits of a state depend neither on the number of threads nor
/// on the processor. Without walls and gravity momentum is kept but for roundings. D is 2 or 3.
template <int D>
class FluidFlow {
public:
    using V = Vec<double, D>;

    /// Starts from a fluid at some time, or goes on from a saved one as a flow that had never been
    /// interrupted: the same bits, with the options that `options()` tells of the first. A speed of sound
    /// that is left open is found from the start, which is another one later.
    ///
    /// Throws UsageError for options that are out of range, and InputError for arrays of unlike lengths and
    /// for coordinates that are not finite.
    FluidFlow(FluidState<D> start, FluidWalls<D> walls, const FluidOptions<D>& options, Threads threads = {});
    ~FluidFlow();
    FluidFlow(FluidFlow&&) noexcept;
    FluidFlow& operator=(FluidFlow&&) noexcept;

    /// One step, as long as `longest_step` says. Throws InputError, and leaves the state as it was, if the
    /// fluid has become faster than sound or a number is no longer finite.
    void step();
    /// Steps until a time. Returns how many.
    std::uint64_t advance(double until);
    /// One step, such that steps of about one length end at a time. Throws as `step` does, and InputError if
    /// steps have become so short that the time no longer grows.
    void step_towards(double until);

    /// Adds particles that are not compressed and have a velocity, at those of some places that are `spacing`
    /// or more away from all others, but for a tenth. So a source keeps full: a tap is a lattice (fill_mesh)
    /// whose places are poured before each step. Returns how many were added; their numbers follow the
    /// others'. Throws InputError for a place whose coordinate is not finite. O(n).
    std::size_t pour(const std::vector<V>& places, const V& velocity);

    /// The length that the next step may have: 0.35·h/(sound + the highest speed), or 0.1·h²/viscosity if
    /// that is less.
    double longest_step() const;
    const FluidState<D>& state() const;
    const FluidWalls<D>& walls() const;
    /// Options with what was left open filled in.
    const FluidOptions<D>& options() const;
    /// The pressure of a particle.
    double pressure(std::size_t i) const;
    double mass() const;  ///< of each particle
    /// The share of a particle's surroundings that was full in the middle of the last step: about 1 inside of
    /// the fluid, a half at its surface, a quarter for a drop alone. Empty before the first step.
    const std::vector<float>& fills() const;

private:
    class Steps;
    std::unique_ptr<Steps> steps_;
};

}  // namespace hedgerow
