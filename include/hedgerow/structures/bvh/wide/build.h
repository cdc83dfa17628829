/// How wide BVHs are built.
#pragma once

#include <hedgerow/structures/bvh/build_tree.h>
#include <hedgerow/structures/bvh/wide/wide_tree.h>

namespace hedgerow {

/// The binary tree that a wide one is collapsed from, by the time to build: linear, binned SAH, and that
/// improved by reinsertion.
enum class WideBuilder { fast, medium, high };
inline constexpr WideBuilder wide_builders[] = {WideBuilder::fast, WideBuilder::medium, WideBuilder::high};

struct WideOptions {
    WideBuilder builder = WideBuilder::medium;
    /// Children a node: 4, 8 or 16; 0 for what this processor's kernels are best at.
    int width = 0;
    /// 1 to `wide_leaf_size`.
    std::uint32_t max_leaf_size = wide_leaf_size;
    /// What the binary tree weighs by (SahOptions): a node, and a triangle. Over instances the latter counts
    /// WideBvh::instance_cost times.
    double traversal_cost = 4, intersection_cost = 1;
    /// Most passes of `high`.
    int reinsertion = 10;
    /// In bytes: a build that may take more is refused before any is spent (budget.h has the bound); 0 for
    /// none.
    double budget = 0;
};

/// The options with a width in place of 0. Throws InputError for what is out of its range.
WideOptions resolved(const WideOptions& options);

/// The tree over all references. Throws InputError where options are out of their ranges, and for more than
/// 2^28 leaves. Compiled in core (src/core/build_wide.cpp), for float and double, in 2D and 3D.
template <std::floating_point T, int D>
WideTree<T, D> build_wide_tree(ReferenceList<T, D> references, const WideOptions& options,
                               Executor& executor);

}  // namespace hedgerow
