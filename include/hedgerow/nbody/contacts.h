/// Contacts of hard spheres.
#pragma once

#include <cstddef>
#include <span>

#include <hedgerow/nbody/particles.h>
#include <hedgerow/parallel/executor.h>

namespace hedgerow {

/// Lets all pairs of spheres bounce that touch or overlap and come nearer to each other. Velocities along the
/// line of their centers are exchanged as momentum asks; after it the spheres part at `restitution` times the
/// speed at which they met, so that 1 keeps their energy and 0 lets them go on together. Momentum is kept.
/// Places do not change: steps should be short, so that spheres overlap by little. A pair is one contact, in
/// the order of its numbers, and so the same for any executor; of a sphere in several contacts the later ones
/// see what the earlier ones did. Returns how many there were.
///
/// By the pairs query over a tree of the centers. O(n log n) and the pairs within twice the largest radius.
///
/// Throws InputError if there is not one radius a sphere, or one is below 0, a mass not above 0 or a number
/// not finite, and UsageError for a restitution that is not from 0 to 1. In the library `nbody`.
std::size_t bounce(Particles& spheres, std::span<const double> radii, double restitution = 1,
                   Threads threads = {});

}  // namespace hedgerow
