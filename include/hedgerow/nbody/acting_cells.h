/// Which cells of charges act on one of them, and how: what the fast multipole method did for it.
#pragma once

#include <cstddef>
#include <vector>

#include <hedgerow/geometry/box.h>
#include <hedgerow/nbody/forces.h>

namespace hedgerow {

/// How a cell of charges acts on a target.
enum class ActsBy {
    conversion,  ///< by its multipole on the local expansion of a cell of targets
    multipole,   ///< by its multipole on the target itself
    points,      ///< its charges, one by one, on the local expansion of a cell of targets
    pairs,       ///< its charges, one by one, on the target itself
};
/// A cell of charges that acts on a place, with the box of its charges.
struct ActingCell {
    Box3d box;
    std::size_t count;
    ActsBy by;
};
/// The cells that act on charge number i in `forces`: each other charge is in one of them, once; in a
/// periodic cube each near image of one, too. For pictures and for learning: O(n). Empty where no kernel
/// answers (instruction set "plain"), and for an i that is not below the number of charges. Throws as
/// `forces` does.
template <std::floating_point T>
std::vector<ActingCell> acting_cells(const Charges<T>& charges, std::size_t i,
                                     const ForceOptions& options = {});

}  // namespace hedgerow
