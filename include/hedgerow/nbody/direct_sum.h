/// Forces by a sum over all pairs.
#pragma once

#include <span>

#include <hedgerow/base/strided.h>
#include <hedgerow/nbody/operators.h>
#include <hedgerow/parallel/executor.h>

namespace hedgerow {

/// Charges, or masses, in the caller's arrays.
template <std::floating_point T>
struct Charges {
    Strided<Vec<T, 3>> places;
    Strided<T> charges;  ///< one for each place
};

/// Writes the potential Σ q/r and its gradient at each target. Sources at a target's own place do nothing
/// there, and so do those that are nearer to it than 2⁻⁴⁰ of the scene's largest coordinate (in double
/// 2⁻³²⁰).
///
/// The term of a pair errs by at most 2⁻²¹ of itself in `float` and 2⁻⁴² in `double`; where no kernel answers
/// (instruction set "plain") by some roundings. Sums are in double, of sums of at most 1,024 terms in T.
/// Answers are the same for any executor, and differ within these bounds from one instruction set to another.
/// O(sources · targets) time; 16 bytes a source and 44 a target (32 and 56) of memory.
///
/// Throws InputError if there is not one charge a place, if `found` has not one element a target, or for a
/// coordinate or charge that is not finite, or beyond 2⁶⁰ (in double 2⁴⁸⁰).
///
/// In the library `nbody`; T is float or double.
template <std::floating_point T>
void direct_sum(const Charges<T>& sources, const Strided<Vec<T, 3>>& targets, std::span<PotentialAt<T>> found,
                Threads threads = {});

}  // namespace hedgerow
