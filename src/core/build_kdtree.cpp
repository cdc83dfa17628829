/// The list of kd-tree builders, compiled once for all sets of primitives.
#include <optional>
#include <utility>

#include <hedgerow/structures/item_limit.h>
#include <hedgerow/structures/kdtree/builders/binned.h>
#include <hedgerow/structures/kdtree/builders/build.h>
#include <hedgerow/structures/kdtree/builders/plain.h>
#include <hedgerow/structures/kdtree/builders/sah.h>

namespace hedgerow {

template <std::floating_point T, int D>
CutTree<KdNode<T>> build_kd_tree(FunctionRef<KdCell<T, D>()> root, PartIn<T, D> part_in,
                                 const KdOptions& options, Executor& executor) {
    // Get the root cell, which has all primitives.
    auto first = std::optional(root());
    const std::size_t count = first->inside.size();
    if (count == 0) return {};
    // Replace options of 0 by their defaults.
    const int deepest =
        std::min(kd_max_depth, options.max_depth > 0 ? options.max_depth : usual_depth(count));
    const bool by_cost = options.builder == KdBuilder::sah || options.builder == KdBuilder::binned;
    const std::uint32_t leaf_size = options.leaf_size > 0 ? options.leaf_size : (by_cost ? 1 : 4);
    const double items_per_primitive =
        options.items_per_primitive != 0 ? options.items_per_primitive : (by_cost ? 16 : 64);
    const std::uint64_t most = most_items(items_per_primitive, count);
    // Grow the tree. If it is grown again by rations, the root cell is made anew.
    const auto grow = [&]<class Planes>(const Planes& planes) {
        const KdCutter<T, D, Planes> cutter(part_in, planes, cell_margin(first->box));
        return CutTreeGrowth<KdNode<T>, KdCutter<T, D, Planes>>(cutter, deepest, most, executor).grow([&] {
            auto cell = first ? *std::exchange(first, std::nullopt) : root();
            return cutter.root(std::move(cell), executor);
        });
    };
    // Choose the planes by the builder.
    switch (options.builder) {
        case KdBuilder::binned:
            return grow(KdBinnedPlanes<T, D>(options.costs, leaf_size, options.bins));
        case KdBuilder::median:
        case KdBuilder::midpoint:
            return grow(KdPlainPlanes<T, D>(options.builder == KdBuilder::median, leaf_size));
        case KdBuilder::sah:
            break;
    }
    return grow(KdSahPlanes<T, D>(options.costs, leaf_size));
}

// NOLINTBEGIN(bugprone-macro-parentheses): T and D are arguments of templates
#define HEDGEROW_BUILD_KD_TREE(T, D)                                                                       \
    template CutTree<KdNode<T>> build_kd_tree(FunctionRef<KdCell<T, D>()>, PartIn<T, D>, const KdOptions&, \
                                              Executor&);
HEDGEROW_BUILD_KD_TREE(float, 2)
HEDGEROW_BUILD_KD_TREE(float, 3)
HEDGEROW_BUILD_KD_TREE(double, 2)
HEDGEROW_BUILD_KD_TREE(double, 3)
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace hedgerow
