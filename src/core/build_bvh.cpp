/// The list of BVH builders, compiled once for all sets of primitives.
#include <hedgerow/structures/bvh/builders/agglomerative.h>
#include <hedgerow/structures/bvh/builders/binned.h>
#include <hedgerow/structures/bvh/builders/build.h>
#include <hedgerow/structures/bvh/builders/equal_counts.h>
#include <hedgerow/structures/bvh/builders/lbvh.h>
#include <hedgerow/structures/bvh/builders/midpoint.h>
#include <hedgerow/structures/bvh/builders/ploc.h>
#include <hedgerow/structures/bvh/builders/reinsertion.h>
#include <hedgerow/structures/bvh/builders/spatial_splits.h>
#include <hedgerow/structures/bvh/builders/sweep.h>

namespace hedgerow {

template <std::floating_point T, int D>
BuildTree<T, D> build_tree(ReferenceList<T, D> references, CornersOf<T, D> corners, const BvhOptions& options,
                           Executor& executor) {
    const std::size_t count = references.size();
    // Top-down builders differ only in their splitter.
    const auto top_down = [&]<class Splitter>(Splitter splitter, const SahOptions& sah) {
        executor.expect(count);
        return TopDown<T, D, Splitter>(splitter, sah.max_leaf_size, executor).build();
    };
    // Build with the chosen builder, and tell the executor how much work it is.
    const auto build = [&](const SahOptions& sah) {
        switch (options.builder) {
            case BvhBuilder::sweep:
                return top_down(SweepSplitter<T, D>(std::move(references), sah, executor), sah);
            case BvhBuilder::equal_counts:
                return top_down(EqualCountsSplitter<T, D>(std::move(references), sah), sah);
            case BvhBuilder::midpoint:
                return top_down(MidpointSplitter<T, D>(std::move(references), sah), sah);
            case BvhBuilder::lbvh:
                executor.expect(count);
                return build_lbvh<T, D>(references, sah, executor);
            case BvhBuilder::ploc:
                executor.expect(2 * count);
                return build_ploc<T, D>(references, sah, options.search_radius, executor);
            case BvhBuilder::agglomerative:
                executor.expect(2 * count);
                return build_agglomerative<T, D>(references, sah, executor);
            case BvhBuilder::spatial_splits:
                return top_down(SpatialSplitter<T, D>(corners, std::move(references), sah, options.duplicates,
                                                      options.overlap),
                                sah);
            case BvhBuilder::binned:
                break;
        }
        return top_down(BinnedSplitter<T, D>(std::move(references), sah), sah);
    };
    auto tree = build(options);
    reinsert(tree, options.reinsertion, options.reinsertion_share, executor);
    return tree;
}

#define HEDGEROW_BUILD_BVH(T, D) \
    template BuildTree<T, D> build_tree(ReferenceList<T, D>, CornersOf<T, D>, const BvhOptions&, Executor&);
HEDGEROW_BUILD_BVH(float, 2)
HEDGEROW_BUILD_BVH(float, 3)
HEDGEROW_BUILD_BVH(double, 2)
HEDGEROW_BUILD_BVH(double, 3)

}  // namespace hedgerow
