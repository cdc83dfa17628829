/// The BSP builder, compiled once for all sets of primitives.
#include <hedgerow/structures/bsp/cutter.h>
#include <hedgerow/structures/item_limit.h>

namespace hedgerow {

template <std::floating_point T, int D>
CutTree<BspNode<T, D>> build_bsp_tree(const ReferenceList<T, D>& references, CornersOf<T, D> corners,
                                      const BspOptions& options, double margin, Executor& executor) {
    const int deepest =
        std::min(bsp_max_depth, options.max_depth > 0 ? options.max_depth : usual_depth(references.size()));
    const BspCutter<T, D> cutter(corners, options, margin, executor);
    const std::uint64_t most = most_items(options.items_per_primitive, references.size());
    return CutTreeGrowth<BspNode<T, D>, BspCutter<T, D>>(cutter, deepest, most, executor).grow([&] {
        return cutter.root(references);
    });
}

// NOLINTBEGIN(bugprone-macro-parentheses): T and D are arguments of templates
#define HEDGEROW_BUILD_BSP_TREE(T, D)                                                           \
    template CutTree<BspNode<T, D>> build_bsp_tree(const ReferenceList<T, D>&, CornersOf<T, D>, \
                                                   const BspOptions&, double, Executor&);
HEDGEROW_BUILD_BSP_TREE(float, 2)
HEDGEROW_BUILD_BSP_TREE(float, 3)
HEDGEROW_BUILD_BSP_TREE(double, 2)
HEDGEROW_BUILD_BSP_TREE(double, 3)
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace hedgerow
