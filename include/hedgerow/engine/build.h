/// Options of wide BVHs, and the function that builds one.
#pragma once

#include <string_view>

#include <hedgerow/engine/wide_tree.h>
#include <hedgerow/structures/bvh/build_tree.h>
#include <hedgerow/structures/references.h>

namespace hedgerow {

/// The builder of the binary tree that a wide tree is collapsed from, fastest first: linear (LBVH), binned
/// SAH with up to three passes of reinsertion over the largest nodes (3%), and binned SAH with passes over
/// three tenths of the nodes until they gain too little. Over points `medium` halves by number instead
/// (`build_wide_tree_of_points`).
enum class WideBuilder { fast, medium, high };
inline constexpr std::string_view wide_builder_names[] = {"fast", "medium", "high"};
constexpr std::string_view name_of(WideBuilder builder) {
    return wide_builder_names[static_cast<std::size_t>(builder)];
}
inline constexpr WideBuilder wide_builders[] = {WideBuilder::fast, WideBuilder::medium, WideBuilder::high};

struct WideOptions {
    WideBuilder builder = WideBuilder::medium;
    /// Children per node: 4, 8 or 16. 0 chooses the width that the kernels of this processor are best at.
    int width = 0;
    /// Largest number of primitives in a leaf: 1 to `wide_leaf_size`.
    std::uint32_t max_leaf_size = wide_leaf_size;
    /// Costs of the binary tree's SAH (SahOptions): to open a node, and to test a primitive. Triangles cost
    /// as much as a whole block of eight, and instances WideBvh::instance_cost times as much.
    double traversal_cost = 4, intersection_cost = 1;
    /// Largest number of passes of reinsertion, for the builder `high`.
    int reinsertion = 10;
    /// In bytes; 0 for no budget. A build that may take more is refused before it allocates (budget.h has
    /// the bound).
    double budget = 0;

    /// Lists the options (option.h).
    template <class Option>
    void list(Option& option) {
        option("builder", builder, wide_builder_names,
               "of the binary tree that it is collapsed from: lbvh, binned, binned and improved at length");
        option("width", width, 0, 16, "children a node: 4, 8 or 16; 0: what this processor is best at");
        option("reinsertion", reinsertion, 0, 100, "most passes of the builder 'high'");
        option("traversal_cost", traversal_cost, 0, 1e6, "of an inner node of the binary tree, for the SAH");
        option("intersection_cost", intersection_cost, 1e-6, 1e6, "of a primitive, for the SAH");
        option("max_leaf_size", max_leaf_size, 1, wide_leaf_size, "larger nodes are always split");
        option("budget", budget, 0, 1e15, "bytes; a build that may take more is refused; 0: none is");
    }
};

/// The options with a width chosen in place of 0. Throws UsageError for an option out of its range.
WideOptions resolved(const WideOptions& options);

/// Builds the tree over all references, whose leaves are tested by blocks of so many (SahOptions::block).
/// Throws UsageError for an option out of its range, and InputError for more than 2^28 leaves. Compiled in
/// core (src/engine/build.cpp), for float and double, in 2D and 3D.
template <std::floating_point T, int D>
WideTree<T, D> build_wide_tree(ReferenceList<T, D> references, const WideOptions& options,
                               std::uint32_t block, Executor& executor);

/// A point in a builder: its coordinates, and its id in the fourth lane.
template <std::floating_point T, int D>
struct PointItem {
    T lane[4];

    PointItem() = default;  // bare, to be filled
    PointItem(const Vec<T, D>& p, PrimitiveId id) : lane{} {
        for (int k = 0; k < D; ++k) lane[k] = p[k];
        lane[3] = number_as_lane<T>(id);
    }
    PrimitiveId id() const { return number_of_lane(lane[3]); }
};
template <std::floating_point T, int D>
using PointItems = BareVector<PointItem<T, D>>;

/// Builds the tree over points: halved by number along the longest side of their box, until leaves are full
/// (a kd-tree in wide nodes; Bentley 1975). O(n log n), in place. Only the last leaf, and the nodes that lead
/// to it, may have room left. Throws UsageError for an option out of its range. Compiled in core
/// (src/engine/build_points.cpp), for float and double, in 2D and 3D.
template <std::floating_point T, int D>
WideTree<T, D> build_wide_tree_of_points(PointItems<T, D> points, const WideOptions& options,
                                         Executor& executor);

}  // namespace hedgerow
