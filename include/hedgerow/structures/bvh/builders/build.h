/// The list of BVH builders.
#pragma once

#include <string_view>

#include <hedgerow/structures/bvh/build_tree.h>
#include <hedgerow/structures/cells.h>

namespace hedgerow {

/// By build time, least first: lbvh, ploc and binned, agglomerative, sweep. By the visits of rays, sweep and
/// binned come first on even surfaces, and ploc and agglomerative where triangles differ much in size or are
/// long (docs/design/003-builders.md). `equal_counts` and `midpoint` are for comparison.
enum class BvhBuilder { binned, sweep, equal_counts, midpoint, lbvh, ploc, agglomerative, spatial_splits };
inline constexpr std::string_view bvh_builder_names[] = {
    "binned", "sweep", "equal-counts", "midpoint", "lbvh", "ploc", "agglomerative", "spatial-splits"};
inline constexpr BvhBuilder bvh_builders[] = {
    BvhBuilder::binned, BvhBuilder::sweep, BvhBuilder::equal_counts,  BvhBuilder::midpoint,
    BvhBuilder::lbvh,   BvhBuilder::ploc,  BvhBuilder::agglomerative, BvhBuilder::spatial_splits};

struct BvhOptions : SahOptions {
    BvhBuilder builder = BvhBuilder::binned;
    /// Off only to show what they bring. `ordered`: visit the nearer child first. `culling`: skip nodes on
    /// the stack that a shrunken limit has put out of reach.
    bool ordered = true, culling = true;
    /// PLOC: how many neighbours to either side along the Morton curve each cluster is compared with, 1 to
    /// most_search_radius.
    int search_radius = 10;
    static constexpr int most_search_radius = 128;
    /// The most passes of improvement by reinsertion, after any builder; 0 for none. A pass over all nodes
    /// takes up to as long as the build itself. Passes end early once they gain too little (reinsertion.h).
    int reinsertion = 0;
    /// Each pass searches this share of the nodes, the largest.
    double reinsertion_share = 1;
    /// Spatial splits: how many references they may add, as a share of the primitives; and how much the sides
    /// of the best object split must overlap before a plane is tried, as a share of the root's area.
    double duplicates = 0.5;
    double overlap = 1e-5;

    /// Lists the options (option.h).
    template <class Option>
    void list(Option& option) {
        list_of_build(option);
        option("ordered", ordered, "visit the nearer child first");
        option("culling", culling, "pass over what a nearer hit has put out of reach");
    }

protected:
    template <class Option>
    void list_of_build(Option& option) {
        option("builder", builder, bvh_builder_names, "how nodes are found");
        option("bins", bins, 2, most_bins, "most bins of the binned builder");
        option("search_radius", search_radius, 1, most_search_radius,
               "neighbours that the ploc builder looks at, to either side");
        option("reinsertion", reinsertion, 0, 100, "most passes of improvement after the build");
        option("reinsertion_share", reinsertion_share, 0, 1, "of the nodes, the largest, in each pass");
        option("duplicates", duplicates, 0, 10,
               "spatial splits: what they may add, as a share of the primitives");
        option("overlap", overlap, 0, 1,
               "spatial splits: tried where sides overlap by so much of the root's area");
        option("traversal_cost", traversal_cost, 0, 1e6, "of an inner node, for the SAH");
        option("intersection_cost", intersection_cost, 1e-6, 1e6, "of a primitive, for the SAH");
        option("max_leaf_size", max_leaf_size, 1, 1u << 20, "larger nodes are always split");
    }
};

/// The tree over all references, by the chosen builder and improved as the options say. Only spatial splits
/// query `corners`. Compiled in core (src/core/build_bvh.cpp), for float and double, in 2D and 3D.
template <std::floating_point T, int D>
BuildTree<T, D> build_tree(ReferenceList<T, D> references, CornersOf<T, D> corners, const BvhOptions& options,
                           Executor& executor);

}  // namespace hedgerow
