/// Builds wide BVHs, compiled once for all sets of primitives.
#include <algorithm>
#include <cmath>

#include <hedgerow/engine/build.h>
#include <hedgerow/engine/collapse.h>
#include <hedgerow/engine/kernels.h>
#include <hedgerow/structures/bvh/builders/build.h>

namespace hedgerow {

namespace {

template <class V>
void require(bool good, const char* name, V value, const char* wanted) {
    if (good) return;
    throw UsageError(std::string(name) + "=" + std::to_string(value) + " is not " + wanted);
}

BvhOptions binary(const WideOptions& options, std::uint32_t block) {
    BvhOptions o;
    o.builder = options.builder == WideBuilder::fast ? BvhBuilder::lbvh : BvhBuilder::binned;
    if (options.builder == WideBuilder::medium) o.reinsertion = 3, o.reinsertion_share = 0.03;
    if (options.builder == WideBuilder::high) o.reinsertion = options.reinsertion, o.reinsertion_share = 0.3;
    o.max_leaf_size = options.max_leaf_size;
    o.traversal_cost = options.traversal_cost;
    o.intersection_cost = options.intersection_cost;
    o.block = block;
    return o;
}

}  // namespace

WideOptions resolved(const WideOptions& options) {
    const auto is_cost = [](double x) { return x >= 0 && std::isfinite(x); };
    const int w = options.width;
    require(w == 0 || std::ranges::count(wide_widths, w) == 1, "width", w, "0, 4, 8 or 16");
    require(options.max_leaf_size >= 1 && options.max_leaf_size <= wide_leaf_size, "max_leaf_size",
            options.max_leaf_size, "a number from 1 to 8");
    require(is_cost(options.traversal_cost), "traversal_cost", options.traversal_cost, "a cost");
    require(is_cost(options.intersection_cost), "intersection_cost", options.intersection_cost, "a cost");
    require(is_cost(options.budget), "budget", options.budget, "a number of bytes");
    require(options.reinsertion >= 0, "reinsertion", options.reinsertion, "a number of passes");
    WideOptions all = options;
    if (w == 0) all.width = preferred_wide_width();
    return all;
}

template <std::floating_point T, int D>
WideTree<T, D> build_wide_tree(ReferenceList<T, D> references, const WideOptions& options,
                               std::uint32_t block, Executor& executor) {
    const WideOptions all = resolved(options);
    const auto whole = [](PrimitiveId) { return Corners<T, D>(); };  // called by no builder that is used here
    const std::size_t count = references.size();
    executor.expect(count);  // for the collapse, which takes one step a leaf
    const auto tree = build_tree<T, D>(std::move(references), whole, binary(all, block), executor);
    if (tree.items.empty()) return {};
    if (tree.leaves > WideCollapse<T, D>::most_leaves)
        throw InputError("a wide BVH has at most 2^28 leaves, and these primitives would take " +
                         std::to_string(tree.leaves));
    // Where leaves are fewer than primitives, the collapse takes fewer steps than announced.
    executor.advance(count - std::min<std::size_t>(count, tree.leaves));
    return WideCollapse<T, D>(tree, all.width, executor).build();
}

#define HEDGEROW_BUILD_WIDE(T, D)                                                                   \
    template WideTree<T, D> build_wide_tree(ReferenceList<T, D>, const WideOptions&, std::uint32_t, \
                                            Executor&);
HEDGEROW_BUILD_WIDE(float, 2)
HEDGEROW_BUILD_WIDE(float, 3)
HEDGEROW_BUILD_WIDE(double, 2)
HEDGEROW_BUILD_WIDE(double, 3)

}  // namespace hedgerow
