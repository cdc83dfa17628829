/// Linear BVH (Lauterbach, Garland, Sengupta, Luebke, Manocha, EG 2009): sorts primitives along a Morton
/// curve and splits each node at the highest bit in which its codes differ. Bisection finds the split, from
/// the root down; Karras (HPG 2012) does that from every node at once. Boxes are gathered on the way back up.
///
/// O(n), most of it the sort: the fastest build here. The tree takes no account of the sizes of primitives.
/// Primitives in one cell of the curve are halved by count.
#pragma once

#include <hedgerow/structures/bvh/builders/collapse.h>
#include <hedgerow/structures/bvh/builders/morton.h>

namespace hedgerow {

/// The tree that a Morton order implies. A node is a stretch of the curve.
template <std::floating_point T, int D>
class MortonTree {
public:
    struct Node {
        std::uint32_t first, last;
    };
    explicit MortonTree(const MortonOrder<T, D>& order) : order_(order) {}

    Node root() const { return {0, static_cast<std::uint32_t>(order_.size())}; }
    std::uint32_t size(Node n) const { return n.last - n.first; }
    std::pair<Node, Node> children(Node n) const {
        const auto middle = static_cast<std::uint32_t>(order_.split(n.first, n.last));
        const Node left{n.first, middle}, right{middle, n.last};
        if (size(n) > at_once)
            for (const Node child : {left, right})
                if (size(child) <= at_once) prefetch(child);
        return {left, right};
    }
    PrimitiveId item(Node n) const { return order_.reference(n.first).id(); }
    LaneBox<T> box(Node n) const { return order_.reference(n.first).lanes(); }

private:
    /// Subtrees of at most so many references are prefetched whole: references lie in their own order, not in
    /// the curve's, and the recursion would wait for each.
    static constexpr std::uint32_t at_once = 32;
    void prefetch(Node n) const {
        for (std::uint32_t i = n.first; i < n.last; ++i) order_.prefetch(i);
    }

    const MortonOrder<T, D>& order_;
};

template <std::floating_point T, int D>
BuildTree<T, D> build_lbvh(std::span<const Reference<T, D>> references, const SahOptions& options,
                           Executor& executor) {
    const MortonOrder<T, D> order(references, executor);
    return Collapse<T, D>(options, executor)
        .build(MortonTree<T, D>(order), static_cast<std::uint32_t>(references.size()));
}

}  // namespace hedgerow
