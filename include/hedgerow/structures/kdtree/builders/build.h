/// The list of kd-tree builders, and their options.
#pragma once

#include <string_view>

#include <hedgerow/structures/item_limit.h>
#include <hedgerow/structures/kdtree/builders/costs.h>
#include <hedgerow/walks/mailbox.h>

namespace hedgerow {

/// The most levels of any tree, and the most bins along an axis.
inline constexpr int kd_max_depth = 64, kd_most_bins = 256;

enum class KdBuilder { sah, binned, median, midpoint };
inline constexpr std::string_view kd_builder_names[] = {"sah", "binned", "median", "midpoint"};

struct KdOptions {
    KdBuilder builder = KdBuilder::sah;
    /// Cells of at most this many primitives are leaves. 0: 1 for builders by cost (sah, binned), otherwise
    /// 4.
    std::uint32_t leaf_size = 0;
    /// The most levels, leaves included. 0: chosen from the number of primitives (usual_depth).
    int max_depth = 0;
    /// Bins along each axis, for the binned builder: 2 to kd_most_bins.
    int bins = 32;
    /// The most items of a tree for each primitive, at least 1. Where planes only repeat primitives, as in a
    /// fan of slivers, cells then become leaves earlier. So the build and its memory are bounded, and such
    /// leaves are long. 0: 16 for builders by cost, otherwise 64. Meshes need 3.5 and 60.
    double items_per_primitive = 0;
    KdCosts costs = {};
    /// Skips most repeated tests of a primitive within a query. Off only to measure its effect.
    bool mailbox = true;

    /// Lists the options (option.h).
    template <class Option>
    void list(Option& option) {
        option("builder", builder, kd_builder_names, "how planes are chosen");
        option("leaf_size", leaf_size, 0, 1u << 20,
               "cells of no more primitives are leaves; 0: 1 where costs decide, else 4");
        option("max_depth", max_depth, 0, kd_max_depth, "most levels; 0: 8 + 1.3 log2(n)");
        option("bins", bins, 2, kd_most_bins, "of the binned builder");
        option("items_per_primitive", items_per_primitive, 0, most_items_per_primitive,
               "with more items a primitive cells are not divided; 0: 16 where costs decide, else 64");
        costs.list(option);
        option("mailbox", mailbox, mailbox_meaning);
    }
};

/// Builds the tree below a root cell that has every reference. `root` is called again if the tree exceeds the
/// limit of items, so that no second list is kept meanwhile. An empty root gives an empty tree. Throws
/// UsageError for fewer than one item a primitive, and InputError for too many nodes. Compiled in core
/// (src/core/build_kdtree.cpp), for float and double, in 2D and 3D.
template <std::floating_point T, int D>
CutTree<KdNode<T>> build_kd_tree(FunctionRef<KdCell<T, D>()> root, PartIn<T, D> part_in,
                                 const KdOptions& options, Executor& executor);

}  // namespace hedgerow
