/// The list of BVH builders.
#pragma once

#include <hedgerow/structures/bvh/build_tree.h>
#include <hedgerow/structures/cells.h>

namespace hedgerow {

/// By build time, least first: lbvh, ploc and binned, agglomerative, sweep. By the visits of rays, sweep and
/// binned come first on even surfaces, and ploc and agglomerative where triangles differ much in size or are
/// long (docs/design/003-builders.md). `equal_counts` and `midpoint` are for comparison.
enum class BvhBuilder { binned, sweep, equal_counts, midpoint, lbvh, ploc, agglomerative, spatial_splits };
inline constexpr BvhBuilder bvh_builders[] = {
    BvhBuilder::binned, BvhBuilder::sweep, BvhBuilder::equal_counts,  BvhBuilder::midpoint,
    BvhBuilder::lbvh,   BvhBuilder::ploc,  BvhBuilder::agglomerative, BvhBuilder::spatial_splits};

struct BvhOptions : SahOptions {
    BvhBuilder builder = BvhBuilder::binned;
    /// Off only to show what they bring. `ordered`: visit the nearer child first. `culling`: skip nodes on
    /// the stack that a shrunken limit has put out of reach.
    bool ordered = true, culling = true;
    /// PLOC: how many neighbours to either side along the Morton curve each cluster is compared with.
    int search_radius = 10;
    /// The most passes of improvement by reinsertion, after any builder; 0 for none. Each pass takes about as
    /// long as the build itself. Passes end early once they gain too little (reinsertion.h).
    int reinsertion = 0;
    /// Spatial splits: how many references they may add, as a share of the primitives; and how much the sides
    /// of the best object split must overlap before a plane is tried, as a share of the root's area.
    double duplicates = 0.5;
    double overlap = 1e-5;
};

/// The tree over all references, by the chosen builder and improved as the options say. Only spatial splits
/// query `corners`. Compiled in core (src/core/build_bvh.cpp), for float and double, in 2D and 3D.
template <std::floating_point T, int D>
BuildTree<T, D> build_tree(ReferenceList<T, D> references, CornersOf<T, D> corners, const BvhOptions& options,
                           Executor& executor);

}  // namespace hedgerow
