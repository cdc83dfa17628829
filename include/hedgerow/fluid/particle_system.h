/// A particle system: particles that are born, fly, bounce off a mesh and off each other, and die.
///
/// After Reeves, "Particle Systems - A Technique for Modeling a Class of Fuzzy Objects" (1983): emitters draw
/// places, velocities and lives at random, forces move the particles, and each dies when its life ends. The
/// geometric questions are those of an Index: rays and closest points keep particles on their side of a mesh,
/// lists of neighbours find those that touch. Lengths, times and speeds are in any units that fit together,
/// such as metres and seconds. Angles are in radians.
#pragma once

#include <cstdint>
#include <limits>
#include <variant>
#include <vector>

#include <hedgerow/geometry/box.h>
#include <hedgerow/mesh_index.h>
#include <hedgerow/nbody/particles.h>
#include <hedgerow/parallel/executor.h>

namespace hedgerow {

/// Particles are born in one place.
struct FromPoint {
    Vec3d place;
};
/// Particles are born anywhere on a disc across the emitter's direction.
struct FromDisc {
    Vec3d middle;
    double radius = 1;
};
/// Particles are born anywhere in a box.
struct FromBox {
    Box<double, 3> box;
};
/// Particles are born anywhere on a mesh, evenly by area, and leave it along its normals. The mesh's arrays
/// are borrowed.
struct FromSurface {
    TriangleMeshView<double> mesh;
};

/// Where particles are born, and how they start. Particle k is born at the time begin + k/rate, and draws its
/// numbers from a random stream of its own.
struct ParticleEmitter {
    std::variant<FromPoint, FromDisc, FromBox, FromSurface> source;
    double rate = 100;  ///< particles per unit of time, at most 2⁴⁰
    /// Particles are born from the time `begin` on, and before the time `end`.
    double begin = 0, end = std::numeric_limits<double>::infinity();
    /// The middle of the directions in which particles start, of any length above 0, and the largest angle to
    /// it, up to π. Directions are even by solid angle. On a surface its normal takes the place of
    /// `direction`.
    Vec3d direction{0, 0, 1};
    double spread = 0;
    double speed = 1, speed_spread = 0;  ///< speeds are even from speed − spread to speed + spread
    double life = 1, life_spread = 0;    ///< lives are even from life − spread to life + spread
    double radius = 0;                   ///< of the ball that a particle is; 0: a point
};

/// Forces per mass on a particle of velocity v: gravity − (linear + quadratic·|v − wind|)·(v − wind).
struct ParticleForces {
    Vec3d gravity{0, 0, -9.81};
    Vec3d wind = {};
    double linear_drag = 0;     ///< per time
    double quadratic_drag = 0;  ///< per length
};

/// What happens where particles touch a mesh or each other.
struct ParticleContacts {
    double restitution = 0.5;  ///< speed after a contact over speed before it, along the normal; 0 to 1
    double friction = 0.3;     ///< Coulomb's coefficient, on the mesh; 0 or more
    bool each_other = false;   ///< whether particles touch each other; their radii must be above 0
};

struct ParticleSystemOptions {
    std::vector<ParticleEmitter> emitters = {};
    ParticleForces forces = {};
    ParticleContacts contacts = {};
    std::uint64_t seed = 0;
};

/// The living particles at a time, an element of each array for each of them, in the order of their births.
/// Masses are the cubes of radii, and 1 for points. What was emitted so far follows from the time.
struct ParticleState {
    double time = 0;
    Particles particles;
    std::vector<double> ages, lives, radii;
    std::vector<std::uint64_t> numbers;  ///< a particle's number among all that were ever born

    std::size_t size() const { return particles.size(); }
};

/// A particle system beside a mesh, such as one in a room or around a body.
///
/// A step moves each particle by gravity and drag: half a kick, drag as its closed form has it, half a kick,
/// and the mean velocity as the way. That is of second order; with gravity alone it is exact.
///
/// The mesh is a wall from both sides. A particle moves along segments, each of which is a ray against the
/// mesh, and stays farther from it than all rounding errors. So its center never passes the surface, however
/// fast it is, nor through edges and vertices of a closed mesh, since no ray slips between triangles that
/// share them. A ball stops where its radius reaches the surface, and a ball that rests lies a radius above
/// it. A ball that moves more than eight radii a step may clip a rim that its center misses. Contacts slower
/// than what gravity gives in two steps do not bounce, so that balls come to rest. A way has 64 legs at most:
/// a particle with more contacts in a step waits for the next one.
///
/// With `each_other` balls exchange momentum as `bounce` (nbody/contacts.h) lets them, and overlapping ones
/// are pushed apart by half of what they overlap.
///
/// The bits of a state depend on the options, the mesh, the state at the start and the ends of steps, and
/// never on threads. A system that goes on from a saved state has the bits of one that was not interrupted.
///
/// The mesh's index is the default one, of double: its rays are watertight, its queries may be asked by many
/// threads, and errors are of the size of the state's own. An index of float would err by more than a resting
/// ball sinks in a step, and one chosen at run time (AnyIndex) would add virtual calls to every leg of a path
/// for a choice that nobody makes.
///
/// In the library `fluid`.
class ParticleSystem {
public:
    /// A system at a state, by default of no particles at time 0. The mesh's index is borrowed; null: free
    /// space. O(particles), and O(triangles) for each emitter on a surface.
    ///
    /// Throws UsageError for an option out of its range, and InputError for arrays of unlike lengths, numbers
    /// that are not finite, radii below 0, masses not above 0, and emitting surfaces without area.
    explicit ParticleSystem(ParticleSystemOptions options, const MeshIndex<double>* mesh = nullptr,
                            ParticleState start = {});

    /// Moves all particles, adds new ones and removes those whose lives end. A particle near the mesh costs
    /// some closest points and at most a ray for each leg of its way, any other one closest point, and
    /// `each_other` two lists of neighbours: O(particles · log triangles + pairs within twice the largest
    /// radius).
    ///
    /// Throws UsageError for a length of time that is not above 0 and finite.
    void step(double dt, Threads threads = {});
    /// Makes one step that ends at a time.
    void step_until(double time, Threads threads = {});

    const ParticleState& state() const { return state_; }
    /// The number of particles that were born so far. O(emitters).
    std::uint64_t emitted() const;

private:
    void emit(double until);
    void move(std::size_t i, double dt, double flight);
    void separate(Threads threads);
    void remove_dead();

    ParticleSystemOptions options_;
    const MeshIndex<double>* mesh_;
    ParticleState state_;
    std::vector<std::vector<double>> areas_;  // of each emitter's triangles, summed up; empty: no surface
    std::vector<double> flights_;             // how long each particle flies in the current step
};

}  // namespace hedgerow
