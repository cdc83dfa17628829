/// What the far images of a charge in a periodic cube do near the cube: sums over a lattice.
#pragma once

#include <span>

namespace hedgerow::detail {

/// Images of a cube up to so many cubes away along each axis are near, and act as other charges do.
inline constexpr int near_images = 2;
/// The highest order of the multipoles of a cube that act from its far images, and that of what they do.
inline constexpr int most_far_order = 18;

/// Σ S(n, m)(v), the singular harmonics of harmonics.h, over the places v of all far images in cubes of side
/// 1, for n up to 2·most_far_order + 1 and m from 0 to n, in the order of `Harmonics::at`. By the cube's
/// symmetry they are real, and 0 unless n is even and m a multiple of 4.
///
/// The potential of a charge and all its images is the one whose mean is 0, of charges in as much of the
/// opposite charge, spread evenly. Near the charge it is
///
///     1/r + Σ 1/|r − v| over near images v + 2π/3·r² + Σ (harmonics of degree n in r) · (these sums);
///
/// that of degree 0 is the constant of that potential, less what near images make up of it.
std::span<const double> far_lattice_sums();

}  // namespace hedgerow::detail
