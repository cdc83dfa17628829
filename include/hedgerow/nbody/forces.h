/// Forces between all charges or masses, within an error that the caller states.
#pragma once

#include <span>

#include <hedgerow/nbody/direct_sum.h>

namespace hedgerow {

struct ForceOptions {
    /// The error that is aimed at: the root of the mean square of |error of a gradient| / |gradient|, where
    /// the second is at least a hundredth of Σ |q|/r². From 1e-9 to 0.1. Potentials err by less, as shares of
    /// Σ |q|/r, but by up to 30 times as much in tight clumps, where gradients are far greater than those of
    /// all charges outside.
    double accuracy = 1e-3;
    /// About the size of each gradient, if it is known, as of a step before: less to compute, and cells are
    /// taken as a whole as far as the accuracy allows. Empty: it is estimated.
    Strided<double> sizes = {};
    /// Room for the tidal tensor at each target, if it is wanted. Its errors, as shares of Σ |q|/r³, are
    /// about those of gradients as shares of Σ |q|/r². It takes about half as long again.
    std::span<Tides> tides = {};
    Threads threads = {};
};

/// Writes the potential Σ q/r, or that of softened charges, and its gradient at each charge, of all others,
/// in the order of the charges. Where charges are masses, the acceleration is G times the gradient.
///
/// By the fast multipole method (nbody/operators.h) over an octree of the charges: its order, its precision
/// and which cells act as a whole follow from the accuracy, by estimates of the errors; where gradients turn
/// out to be much less than estimated, as within a shell, errors are measured at some charges and forces
/// found again if need be, which takes twice as long or more. Forces add up to nothing but for roundings:
/// 10⁻⁶ of the sum of their sizes where single precision suffices for pairs, down to an accuracy of 3·10⁻⁷
/// (in a periodic cube 4·10⁻⁶), else 10⁻¹³. Pairs are summed again in double where their roundings would make
/// more than half of the error that is aimed at, so it is kept however close charges are. Bare charges in one
/// place do nothing to each other. O(n), but O(n²) for charges that are nearer to each other than 2⁻⁴⁸ of the
/// extent of all; the same bits for any executor.
///
/// Throws InputError if there is not one charge and one element of `found` (and of `tides`) a place, for
/// numbers that are not finite or beyond 2⁶⁰ (in double 2⁴⁸⁰), and UsageError for an accuracy out of its
/// range, which for `float` begins at 1e-7.
///
/// In the library `nbody`; T is float or double.
template <std::floating_point T>
void forces(const Charges<T>& charges, PotentialsFound<T> found, const ForceOptions& options = {});

/// The same at other places, which may be few: a target costs about as much as a charge, and charges cost
/// little beside. A charge at a target's own place does nothing there.
template <std::floating_point T>
void forces(const Charges<T>& charges, const Targets<T>& targets, PotentialsFound<T> found,
            const ForceOptions& options = {});

}  // namespace hedgerow
