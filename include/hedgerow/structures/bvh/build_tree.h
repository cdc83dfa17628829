/// A BVH as builders make it: plain nodes with their boxes. What is walked is packed from it (bvh.h).
#pragma once

#include <vector>

#include <hedgerow/bare_vector.h>
#include <hedgerow/structures/references.h>

namespace hedgerow {

/// A leaf (count > 0) holds items[first, first + count); an inner node has count 0, two children, and in
/// `first` how many leaves lie below. Bare, since a builder clears nothing that it does not use.
template <std::floating_point T, int D>
struct BuildNode {
    struct Corners {
        T low[D], high[D];
    } corners;
    std::uint32_t first, count;
    std::uint32_t left, right;

    std::uint32_t leaves() const { return count > 0 ? 1 : first; }
    void set(const Box<T, D>& b) {
        for (int k = 0; k < D; ++k) corners.low[k] = b.low[k], corners.high[k] = b.high[k];
    }
    Box<T, D> box() const {
        Box<T, D> b;
        for (int k = 0; k < D; ++k) b.low[k] = corners.low[k], b.high[k] = corners.high[k];
        return b;
    }
};

template <std::floating_point T, int D>
struct BuildTree {
    SparseVector<BuildNode<T, D>> nodes;  // node 0 is the root; none if there are no items; there may be gaps
    std::uint32_t leaves = 0;
    std::vector<PrimitiveId> items;
};

/// How leaf or split is decided: testing a primitive costs `intersection_cost`, opening an inner node
/// `traversal_cost`. The literature has 1 to 1; here a node costs as much as two triangles or more, as
/// measured (docs/design/001-reference-bvh.md).
struct SahOptions {
    double traversal_cost = 2;
    double intersection_cost = 1;
    /// More than this many primitives are never a leaf; fewer become one when that is cheaper.
    std::uint32_t max_leaf_size = 8;
    /// Most bins of the binned builder; a node of n primitives uses min(bins, 4 + n/20).
    int bins = 32;

    double leaf_cost(std::uint32_t count, double area) const { return intersection_cost * count * area; }
    /// Whether so many are a leaf whatever the boxes below: they cost no more than the node that would be
    /// opened.
    bool always_leaf(std::uint32_t count) const {
        return count <= max_leaf_size && intersection_cost * count <= traversal_cost;
    }
    /// Whether `count` primitives in a box of this area become a leaf, where a subtree would cost that much.
    bool makes_leaf(std::uint32_t count, double area, double subtree_cost) const {
        return count <= max_leaf_size && leaf_cost(count, area) <= subtree_cost;
    }
};

/// No tree is deeper. SAH splits stop early enough that halving by count can finish within it.
inline constexpr int bvh_max_depth = 64;

}  // namespace hedgerow
