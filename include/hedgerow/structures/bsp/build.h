/// What a BSP tree is built from and by.
#pragma once

#include <hedgerow/structures/bsp/bsp_node.h>
#include <hedgerow/structures/cells.h>
#include <hedgerow/structures/cut_tree.h>

namespace hedgerow {

/// How the SAH decides. A node across an axis costs `traversal_cost`, one with any other plane `plane_cost`.
struct BspCosts {
    double traversal_cost = 4;
    double plane_cost = 6;
    double intersection_cost = 1;
    /// A plane that cuts off empty space costs that part less.
    double empty_bonus = 0.2;
};

struct BspOptions {
    BspCosts costs = {};
    /// Cells of no more primitives are leaves.
    std::uint32_t leaf_size = 1;
    /// 0: by the number of primitives (usual_depth).
    int max_depth = 0;
    /// The tree has at most so many items for each primitive. Where planes only repeat primitives, as in a
    /// fan of slivers, cells are then left whole: the build and its memory have a bound, and such leaves are
    /// long. Meshes need 2.6.
    double items_per_primitive = 16;
    /// In cells of more primitives than this, so many suggest planes.
    std::uint32_t samples = 32;
    /// Off only to show what it brings.
    bool mailbox = true;
};
/// No tree is deeper.
inline constexpr int bsp_max_depth = 64;

/// The tree over the references; the margin is cell_margin in double. Compiled in core
/// (src/core/build_bsp_tree.cpp), for float and double, in 2D and 3D.
template <std::floating_point T, int D>
CutTree<BspNode<T, D>> build_bsp_tree(const ReferenceList<T, D>& references, CornersOf<T, D> corners,
                                      const BspOptions& options, double margin, Executor& executor);

}  // namespace hedgerow
