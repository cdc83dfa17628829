/// Generated particles: places, velocities and masses of stars.
///
/// In Hénon's units: the constant of gravity is 1, and so is the total mass; the energy of a sphere in
/// equilibrium is −1/4. Particle i depends only on (size, seed, i) and has the same bits on every machine,
/// since roots are the only functions used. So the center of mass is at rest at the origin only on average.
/// Each generator takes O(size) time and memory, and throws Cancelled if `progress` is cancelled.
#pragma once

#include <cstdint>

#include <hedgerow/nbody/particles.h>
#include <hedgerow/parallel/progress.h>

namespace hedgerow {

/// A Plummer sphere of radius 3π/16 in equilibrium, without the outermost thousandth of its mass (Aarseth,
/// Hénon and Wielen, Astronomy and Astrophysics 37:183, 1974).
Particles plummer(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

/// Hernquist's model of a galaxy, of radius 1/3, out to 300 radii, in equilibrium with equal velocities in
/// all directions (Hernquist, Astrophysical Journal 356:359, 1990). Its density grows as 1/r towards the
/// center.
Particles hernquist(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

/// A uniform sphere of radius 6/5. Velocities are uniform in a ball, such that twice the kinetic energy is
/// the potential one: it swings about its equilibrium.
Particles uniform_sphere(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

/// A uniform sphere of radius 1 at rest, which falls into its center within a time of 1.11.
Particles cold_collapse(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

/// The cube from 0 to 1 at rest. Where it repeats, with a period of 1, its particles gather in clumps.
Particles cold_cube(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

/// A thin disc in the plane z = 0, Kuzmin's of radius 1 out to 10, on circles about its center.
Particles disc(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

/// Two Plummer spheres of half the mass and half the radius, which fall towards each other and merge.
Particles two_clusters(std::uint64_t size, std::uint64_t seed = 0, const Progress& progress = {});

}  // namespace hedgerow
