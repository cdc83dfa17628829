/// Forces by a sum over all pairs.
#pragma once

#include <span>

#include <hedgerow/base/strided.h>
#include <hedgerow/nbody/operators.h>
#include <hedgerow/nbody/softening.h>
#include <hedgerow/parallel/executor.h>

namespace hedgerow {

/// Charges, or masses, in the caller's arrays.
template <std::floating_point T>
struct Charges {
    Strided<Vec<T, 3>> places;
    Strided<T> charges;  ///< one for each place
    Softening softening = {};
    Strided<T> lengths = {};  ///< each charge's own length of softening; empty: that of `softening`
    /// The side of the cube in which all repeats, along each axis without an end; 0: nothing repeats.
    ///
    /// All images of the charges act then, and as much of the opposite charge that is spread evenly, so that
    /// the mean of the potential is 0 (for charges that cancel: as in a box of tinfoil; for masses: in a
    /// universe whose mean density does not act). Places may lie in any images of the cube.
    double period = 0;
};
/// Places at which charges act, in the caller's array.
template <std::floating_point T>
struct Targets {
    Strided<Vec<T, 3>> places;
    /// Of softening, if the targets are charges themselves. Empty: none of their own, or that of `softening`
    /// if there are `charges`.
    Strided<T> lengths;
    /// Of targets that are some of the charges what each of them is: it does not act on itself, though it is
    /// softened. Empty: all charges act.
    Strided<T> charges;

    Targets(const Strided<Vec<T, 3>>& at, const Strided<T>& own_lengths = {},
            const Strided<T>& own_charges = {})
        : places(at), lengths(own_lengths), charges(own_charges) {}
    template <class R>
    requires std::convertible_to<const R&, std::span<const Vec<T, 3>>> Targets(const R& at) : places(at) {}
};

/// By which threads pairs are summed.
struct SumOptions {
    Threads threads = {};
};

/// Writes the potential Σ q/r, or that of softened charges, and its gradient at each target. A bare charge at
/// a target's own place does nothing there; a softened one has its potential there, which is finite.
///
/// The term of a pair errs by at most 2⁻²¹ of itself in `float` and 2⁻⁴² in `double` (if it is softened, 2⁻¹⁸
/// and 2⁻⁴⁰), however near the two are and however far others; where no kernel answers (instruction set
/// "plain") by some roundings. Where a pair is nearer than 2⁻⁵⁰⁰ of the scene's largest coordinate the sum is
/// infinite. Sums are in double, of sums of at most 1,024 terms in T. Answers are the same for any executor,
/// and differ within these bounds from one instruction set to another. O(sources · targets) time; 40 bytes a
/// source and 72 a target (80 and 104) of memory.
///
/// Throws InputError if there is not one charge a place (and one length, or none), if `found` has not one
/// element a target, for a coordinate or charge that is not finite, or beyond 2⁶⁰ (in double 2⁴⁸⁰), and for
/// such a length or one below 0.
///
/// In the library `nbody`; T is float or double.
template <std::floating_point T>
void direct_sum(const Charges<T>& sources, const Targets<T>& targets, PotentialsFound<T> found,
                const SumOptions& options = {});

/// The same at the charges themselves, or at as many of the first ones as `found` has room for: what all
/// others do.
template <std::floating_point T>
void direct_sum(const Charges<T>& charges, PotentialsFound<T> found, const SumOptions& options = {});

/// Writes the tidal tensor of the charges at each target, likewise, pair by pair in double. A softened charge
/// acts at its own place too, unless the target says that it is the charge (`Targets::charges`). O(sources ·
/// targets), some ten times as slow: what those of `forces` are compared with.
template <std::floating_point T>
void direct_tides(const Charges<T>& sources, const Targets<T>& targets, std::span<Tides> found,
                  const SumOptions& options = {});

}  // namespace hedgerow
