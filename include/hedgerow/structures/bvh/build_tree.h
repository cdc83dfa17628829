/// A BVH as builders make it: plain nodes with their boxes. What is walked is packed from it (bvh.h).
#pragma once

#include <vector>

#include <hedgerow/structures/references.h>

namespace hedgerow {

/// Node k's children are `left` and `right`; a leaf (count > 0) holds items[first, first + count).
template <std::floating_point T, int D>
struct BuildNode {
    Box<T, D> box;
    std::uint32_t first = 0, count = 0;
    std::uint32_t left = 0, right = 0;
};

template <std::floating_point T, int D>
struct BuildTree {
    std::vector<BuildNode<T, D>> nodes;  // node 0 is the root; there may be gaps
    std::vector<PrimitiveId> items;
};

/// How leaf or split is decided, in the field's usual units: testing a primitive costs `intersection_cost`,
/// opening an inner node `traversal_cost`.
struct SahOptions {
    double traversal_cost = 1;
    double intersection_cost = 1;
    /// More than this many primitives are never a leaf; fewer become one when that is cheaper.
    std::uint32_t max_leaf_size = 8;
    /// Most bins of the binned builder; a node of n primitives uses min(bins, 4 + n/20).
    int bins = 32;
};

/// No tree is deeper. SAH splits stop early enough that halving by count can finish within it.
inline constexpr int bvh_max_depth = 64;

}  // namespace hedgerow
