/// The list of kd-tree builders, and their options.
#pragma once

#include <hedgerow/structures/kdtree/builders/costs.h>

namespace hedgerow {

enum class KdBuilder { sah, binned, median, midpoint };

struct KdOptions {
    KdBuilder builder = KdBuilder::sah;
    /// Cells of at most this many primitives are leaves. 0: 1 for builders by cost (sah, binned), otherwise
    /// 4.
    std::uint32_t leaf_size = 0;
    /// The most levels, leaves included. 0: chosen from the number of primitives (usual_depth).
    int max_depth = 0;
    /// Bins along each axis, for the binned builder: 2 to KdBinnedPlanes::most_bins, not checked.
    int bins = 32;
    /// The most items of a tree for each primitive, at least 1. Where planes only repeat primitives, as in a
    /// fan of slivers, cells then become leaves earlier. So the build and its memory are bounded, and such
    /// leaves are long. 0: 16 for builders by cost, otherwise 64. Meshes need 3.5 and 60.
    double items_per_primitive = 0;
    KdCosts costs = {};
    /// Skips most repeated tests of a primitive within a query. Off only to measure its effect.
    bool mailbox = true;
};
/// The most levels of any tree.
inline constexpr int kd_max_depth = 64;

/// Builds the tree below a root cell that has every reference. `root` is called again if the tree exceeds the
/// limit of items, so that no second list is kept meanwhile. An empty root gives an empty tree. Throws
/// UsageError for fewer than one item a primitive, and InputError for too many nodes. Compiled in core
/// (src/core/build_kdtree.cpp), for float and double, in 2D and 3D.
template <std::floating_point T, int D>
CutTree<KdNode<T>> build_kd_tree(FunctionRef<KdCell<T, D>()> root, PartIn<T, D> part_in,
                                 const KdOptions& options, Executor& executor);

}  // namespace hedgerow
