/// The options of BSP trees, and their builder.
#pragma once

#include <hedgerow/structures/bsp/bsp_node.h>
#include <hedgerow/structures/cells.h>
#include <hedgerow/structures/cut_tree.h>
#include <hedgerow/structures/item_limit.h>
#include <hedgerow/walks/mailbox.h>

namespace hedgerow {

/// Costs for the SAH. A node across an axis costs `traversal_cost`, a node with any other plane `plane_cost`,
/// and a test of a primitive `intersection_cost`.
struct BspCosts {
    double traversal_cost = 4;
    double plane_cost = 6;
    double intersection_cost = 1;
    /// The fraction by which the tests below a plane cost less if the plane cuts off empty space.
    double empty_bonus = 0.2;

    /// Lists the options (option.h).
    template <class Option>
    void list(Option& option) {
        option("traversal_cost", traversal_cost, 0, 1e6, "of an inner node across an axis, for the SAH");
        option("plane_cost", plane_cost, 0, 1e6, "of an inner node with any other plane, for the SAH");
        option("intersection_cost", intersection_cost, 1e-6, 1e6, "of a primitive, for the SAH");
        option("empty_bonus", empty_bonus, 0, 0.99, "how much less a plane costs that cuts off empty space");
    }
};
/// The most levels of any tree.
inline constexpr int bsp_max_depth = 64;

struct BspOptions {
    BspCosts costs = {};
    /// Cells of at most this many primitives are leaves.
    std::uint32_t leaf_size = 1;
    /// The most levels, leaves included. 0: chosen from the number of primitives (usual_depth).
    int max_depth = 0;
    /// The most items of a tree for each primitive, at least 1. Where planes only repeat primitives, as in a
    /// fan of slivers, cells then become leaves earlier. So the build and its memory are bounded, and such
    /// leaves are long. Meshes need 2.6.
    double items_per_primitive = 16;
    /// In cells of more primitives than this, only some suggest planes: at least this many, and fewer than
    /// twice as many.
    std::uint32_t samples = 16;
    /// Skips most repeated tests of a primitive within a query. Off only to measure its effect.
    bool mailbox = true;

    /// Lists the options (option.h).
    template <class Option>
    void list(Option& option) {
        option("leaf_size", leaf_size, 0, 1u << 20, "cells of no more primitives are leaves");
        option("max_depth", max_depth, 0, bsp_max_depth, "most levels; 0: 8 + 1.3 log2(n)");
        option("samples", samples, 1, 1u << 20, "in larger cells, so many primitives suggest planes");
        option("items_per_primitive", items_per_primitive, 1, most_items_per_primitive,
               "with more items a primitive cells are not divided");
        costs.list(option);
        option("mailbox", mailbox, mailbox_meaning);
    }
};

/// Builds the tree over the references. `margin` is the scene's cell_margin as a double, which BspTree::build
/// enlarges for T = double. Throws UsageError for fewer than one item a primitive, and InputError for too
/// many nodes. Compiled in core (src/core/build_bsp_tree.cpp), for float and double, in 2D and 3D.
template <std::floating_point T, int D>
CutTree<BspNode<T, D>> build_bsp_tree(const ReferenceList<T, D>& references, CornersOf<T, D> corners,
                                      const BspOptions& options, double margin, Executor& executor);

}  // namespace hedgerow
