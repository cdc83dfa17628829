/// The BVH that builders make: plain nodes with their boxes. The nodes that walks read are packed from it
/// (bvh.h).
#pragma once

#include <bit>
#include <vector>

#include <hedgerow/base/bare_vector.h>
#include <hedgerow/structures/references.h>

namespace hedgerow {

/// The items of a leaf (count > 0) are items[first, first + count). An inner node has count 0 and two
/// children, and its `first` is the number of leaves below it. Members have no initial values, since a
/// builder writes only the nodes that it uses.
template <std::floating_point T, int D>
struct BuildNode {
    T low[D], high[D];
    std::uint32_t first, count;
    std::uint32_t left, right;

    std::uint32_t leaves() const { return count > 0 ? 1 : first; }
    void set(const Box<T, D>& b) {
        for (int k = 0; k < D; ++k) low[k] = b.low[k], high[k] = b.high[k];
    }
    Box<T, D> box() const {
        Box<T, D> b;
        for (int k = 0; k < D; ++k) b.low[k] = low[k], b.high[k] = high[k];
        return b;
    }
};

template <std::floating_point T, int D>
struct BuildTree {
    SparseVector<BuildNode<T, D>> nodes;  // node 0 is the root; empty without items; may have gaps
    std::uint32_t leaves = 0;
    std::vector<PrimitiveId> items;
};

/// The costs that decide between a leaf and a split: `intersection_cost` to test a primitive,
/// `traversal_cost` to open an inner node. The literature has 1 to 1. Here a node costs as much as two
/// triangles or more, as measured (docs/design/001-reference-bvh.md).
struct SahOptions {
    double traversal_cost = 2;
    double intersection_cost = 1;
    /// The most primitives of a leaf. That many or fewer become a leaf where it is cheaper.
    std::uint32_t max_leaf_size = 8;
    /// The most bins of the binned builder, 2 to most_bins: a node of n primitives uses
    /// min(bins, 4 + n/20).
    int bins = 32;
    static constexpr int most_bins = 64;
    /// How many primitives one instruction tests, a power of two. They cost as much as so many, even if a
    /// leaf has fewer.
    std::uint32_t block = 1;

    /// The primitives that `count` of them cost as much as: whole blocks.
    std::uint32_t tests(std::uint32_t count) const { return (count + block - 1) & ~(block - 1); }
    double leaf_cost(std::uint32_t count, double area) const {
        return intersection_cost * tests(count) * area;
    }
    /// Whether `count` primitives are a leaf whatever the boxes below: to test each alone costs no more than
    /// to open one inner node.
    bool always_leaf(std::uint32_t count) const {
        return count <= max_leaf_size && intersection_cost * count <= traversal_cost;
    }
    /// Whether `count` primitives in a box of this area become a leaf, where a subtree over them costs
    /// `subtree_cost` (costs times areas).
    bool makes_leaf(std::uint32_t count, double area, double subtree_cost) const {
        return count <= max_leaf_size && leaf_cost(count, area) <= subtree_cost;
    }
};

/// The greatest depth of a BVH. SAH splits stop early enough that halving by count can finish within it.
inline constexpr int bvh_max_depth = 64;
/// Whether a subtree over `count` leaves, whose root is at this depth, has to be halved by count from there
/// on to end within that bound.
constexpr bool bvh_must_halve(int depth, std::uint32_t count) {
    return depth + static_cast<int>(std::bit_width(count)) >= bvh_max_depth;
}

}  // namespace hedgerow
