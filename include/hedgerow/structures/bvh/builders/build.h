/// The list of BVH builders.
#pragma once

#include <hedgerow/structures/bvh/build_tree.h>
#include <hedgerow/structures/cells.h>

namespace hedgerow {

/// By the time to build, least first: lbvh, ploc and binned, agglomerative, sweep. By the rays' visits sweep
/// and binned come first on even surfaces, ploc and agglomerative where triangles differ much in size or are
/// long (docs/design/003-builders.md). `equal_counts` and `midpoint` are for comparison.
enum class BvhBuilder { binned, sweep, equal_counts, midpoint, lbvh, ploc, agglomerative, spatial_splits };
inline constexpr BvhBuilder bvh_builders[] = {
    BvhBuilder::binned, BvhBuilder::sweep, BvhBuilder::equal_counts,  BvhBuilder::midpoint,
    BvhBuilder::lbvh,   BvhBuilder::ploc,  BvhBuilder::agglomerative, BvhBuilder::spatial_splits};

struct BvhOptions : SahOptions {
    BvhBuilder builder = BvhBuilder::binned;
    /// Only to show what they bring: visit the nearer child first; pass over what a shrunken limit has put
    /// out of reach.
    bool ordered = true, culling = true;
    /// PLOC: how many neighbours along the Morton curve, to either side, a cluster looks at.
    int search_radius = 10;
    /// Most passes of improvement by reinsertion, after any builder; 0 for none. It lengthens the build by
    /// about its own time a pass, and stops on its own.
    int reinsertion = 0;
    /// Spatial splits: how many references they may add, as a share of the primitives; and how much the sides
    /// of a split of objects must overlap before one is tried, as a share of the root's area.
    double duplicates = 0.5;
    double overlap = 1e-5;
};

/// The tree over all references, by the builder chosen and improved as asked for. `part_in` is asked by
/// spatial splits alone. Compiled in core (src/core/build_bvh.cpp), for float and double, in 2D and 3D.
template <std::floating_point T, int D>
BuildTree<T, D> build_tree(ReferenceList<T, D> references, CornersOf<T, D> corners, const BvhOptions& options,
                           Executor& executor);

}  // namespace hedgerow
