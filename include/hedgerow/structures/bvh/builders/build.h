/// The list of BVH builders.
#pragma once

#include <hedgerow/structures/bvh/builders/agglomerative.h>
#include <hedgerow/structures/bvh/builders/binned.h>
#include <hedgerow/structures/bvh/builders/equal_counts.h>
#include <hedgerow/structures/bvh/builders/lbvh.h>
#include <hedgerow/structures/bvh/builders/midpoint.h>
#include <hedgerow/structures/bvh/builders/ploc.h>
#include <hedgerow/structures/bvh/builders/reinsertion.h>
#include <hedgerow/structures/bvh/builders/spatial_splits.h>
#include <hedgerow/structures/bvh/builders/sweep.h>

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

template <PrimitiveSet P>
auto build_tree(const P& set, const BvhOptions& options, Executor& executor) {
    using T = typename P::Scalar;
    constexpr int D = P::dimension;
    ReferenceList<T, D> references = references_of(set, executor);
    const auto top_down = [&]<class Splitter>(Splitter splitter, const SahOptions& sah) {
        return TopDown<T, D, Splitter>(splitter, sah.max_leaf_size, executor).build();
    };
    const auto build = [&](const SahOptions& sah) {
        switch (options.builder) {
            case BvhBuilder::sweep:
                return top_down(SweepSplitter<T, D>(std::move(references), sah), sah);
            case BvhBuilder::equal_counts:
                return top_down(EqualCountsSplitter<T, D>(std::move(references), sah), sah);
            case BvhBuilder::midpoint:
                return top_down(MidpointSplitter<T, D>(std::move(references), sah), sah);
            case BvhBuilder::lbvh:
                return build_lbvh<T, D>(references, sah, executor);
            case BvhBuilder::ploc:
                return build_ploc<T, D>(references, sah, options.search_radius, executor);
            case BvhBuilder::agglomerative:
                return build_agglomerative<T, D>(references, sah, executor);
            case BvhBuilder::spatial_splits:
                return top_down(
                    SpatialSplitter<P>(set, std::move(references), sah, options.duplicates, options.overlap),
                    sah);
            case BvhBuilder::binned:
                break;
        }
        return top_down(BinnedSplitter<T, D>(std::move(references), sah), sah);
    };
    if (options.reinsertion == 0) return build(options);
    SahOptions single = options;  // every primitive may move on its own; leaves are made after
    single.max_leaf_size = 1;
    return reinserted(build(single), options, options.reinsertion, executor);
}

}  // namespace hedgerow
