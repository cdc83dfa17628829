/// The list of kd-tree builders.
#pragma once

#include <hedgerow/structures/kdtree/builders/costs.h>

namespace hedgerow {

enum class KdBuilder { sah, binned, median, midpoint };

struct KdOptions {
    KdBuilder builder = KdBuilder::sah;
    /// Cells of no more primitives are leaves. 0: 1 where costs decide, else 4.
    std::uint32_t leaf_size = 0;
    /// 0: by the number of primitives (usual_depth).
    int max_depth = 0;
    /// Of the binned builder.
    int bins = 32;
    /// The tree has at most so many items for each primitive. Where planes only repeat primitives, as in a
    /// fan of slivers, cells are then left whole: the build and its memory have a bound, and such leaves are
    /// long. 0: 16 where costs decide, else 64. Meshes need 3.5 and 60.
    double items_per_primitive = 0;
    KdCosts costs = {};
    /// Off only to show what it brings.
    bool mailbox = true;
};
/// No tree is deeper.
inline constexpr int kd_max_depth = 64;

/// The tree below a root that holds every reference; `root` is called again where the limit of items is
/// passed, so that nobody keeps a second list meanwhile. Empty, if the root is. Compiled in core
/// (src/core/build_kdtree.cpp), for float and double, in 2D and 3D.
template <std::floating_point T, int D>
CutTree<KdNode<T>> build_kd_tree(FunctionRef<KdCell<T, D>()> root, PartIn<T, D> part_in,
                                 const KdOptions& options, Executor& executor);

}  // namespace hedgerow
