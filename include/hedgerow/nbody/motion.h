/// Particles that move by their gravity: leapfrog, in steps of one length or in steps of their own.
///
/// A step is a kick, a drift and a kick (Verlet 1967): velocities by half a step, places by a whole one,
/// velocities by the other half, with the new accelerations. It is of second order, and as near to reversible
/// as the forces are exact. In block steps (as in GADGET: Springel 2005) each particle has the greatest step
/// of dt/2ᵏ that is at most √(2·η·length/|a|); all drift together, and forces are found only for those whose
/// step ends.
#pragma once

#include <cstdint>
#include <vector>

#include <hedgerow/nbody/forces.h>
#include <hedgerow/nbody/particles.h>

namespace hedgerow {

struct MotionOptions {
    double accuracy = 1e-3;  ///< of forces, as ForceOptions states it
    Softening softening = {};
    double gravity = 1;  ///< the constant of gravity
    /// The side of the cube in which all repeats, as that of `Charges`; places stay from 0 to it. 0: none.
    double period = 0;
};

/// What a motion conserves, but for the errors of steps and forces; a periodic cube no angular momentum.
struct Conserved {
    double kinetic = 0, potential = 0;  ///< energies
    Vec3d momentum, angular_momentum;

    double energy() const { return kinetic + potential; }
    /// Twice the kinetic over the potential energy: 1 in equilibrium.
    double virial_ratio() const { return potential == 0 ? 0 : -2 * kinetic / potential; }
};
/// Neither the order of the particles nor threads change a bit: sums are in fixed point. O(n).
Conserved conserved(const MotionState& state, Threads threads = {});

/// A length of softening that smooths the grain of particles: 0.28 times the distance to the eighth nearest
/// other particle, as it is in the middle of a thousand particles. For a Plummer sphere that is about the
/// radius of half the mass over the cube root of the number. 0 for less than nine particles. O(n).
double usual_softening(const Particles& particles);
/// A length of step, rounded down to a power of two. With softening √(2·η·length/|a|), for the acceleration
/// that all but a thousandth of the particles stay below. Bare particles have steps by their pairs, each with
/// its eight nearest: η times the least of √(r³/(G·(m₁ + m₂))), in which a pair on a circle turns by a
/// radian, and of r/|v₁ − v₂|. 1 where nothing acts. O(n), bare O(n log n).
double usual_step(const MotionState& state, double softening, double eta = 0.025, double gravity = 1);

/// The lengths of block steps.
struct BlockSteps {
    double eta = 0.025;
    int deepest = 16;  ///< the shortest step is dt/2^deepest
};

/// Steps of bare particles: their length is size/U for a potential energy −U. So they shorten as particles
/// approach, in a way that is reversible and keeps the orbits of a pair exact but for an error of time, also
/// through a collision (Mikkola and Tanikawa 1999; Preto and Tremaine 1999).
struct BareSteps {
    double size = 0;
    double binding = 0;  ///< minus the energy of the motion, which stays

    /// Steps of a motion whose first is of length `dt`. Throws UsageError unless masses attract: none is
    /// below 0, two are above it, nothing is softened and nothing repeats.
    BareSteps(const MotionState& start, const MotionOptions& options, double dt);
    BareSteps() = default;
};

class Motion {
public:
    /// From particles at rest or moving, at time 0. Finds accelerations, as every step does: O(n).
    ///
    /// Throws InputError if the arrays of `start` have unlike lengths, and as `forces` does.
    explicit Motion(Particles start, const MotionOptions& options = {}, Threads threads = {});
    /// Goes on from a state, as a motion that had never been interrupted: the same bits.
    explicit Motion(MotionState saved, const MotionOptions& options = {}, Threads threads = {});

    /// One step of all particles.
    void step(double dt);
    /// Steps of a length of each particle's own, until all have come `dt` further. Returns how many forces
    /// were found, of particles. Throws UsageError for particles without a length of softening.
    std::uint64_t block_step(double dt, const BlockSteps& steps = {});
    /// One step of all particles, whose length follows their potential energy, but not beyond a time.
    void bare_step(const BareSteps& steps, double until);

    const MotionState& state() const { return state_; }

private:
    using Ids = std::vector<std::uint32_t>;
    void accelerate();
    void accelerate(const Ids& active);
    void kick(double dt);
    void kick(const Ids& active, const std::vector<int>& depth, double half_dt);
    void drift(double dt);
    int depth_of(std::size_t i, double dt, const BlockSteps& steps) const;

    MotionState state_;
    MotionOptions options_;
    Threads threads_;
    bool known_ = false;  // whether there are accelerations of a step before
};

}  // namespace hedgerow
