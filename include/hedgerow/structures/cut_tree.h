/// What kd-trees and BSP trees share as they are built: nodes in depth-first order, and the recursion.
#pragma once

#include <optional>

#include <hedgerow/structures/references.h>

namespace hedgerow {

/// A whole tree or a subtree of one. An inner node's low child follows it; its `link` is where its high child
/// stands. A leaf's `link` is its count, and it begins at `first` in the items.
template <class Node>
struct CutTree {
    std::vector<Node> nodes;
    std::vector<PrimitiveId> items;
    int depth = 0;

    /// Puts another subtree behind this one.
    void append(const CutTree& other) {
        const auto node_shift = static_cast<std::uint32_t>(nodes.size());
        const auto item_shift = static_cast<std::uint32_t>(items.size());
        if (nodes.size() + other.nodes.size() > Node::most || items.size() + other.items.size() > 0xFFFFFFFFu)
            throw InputError("the tree would hold more than " + std::to_string(Node::most) +
                             " nodes or 2^32 items: let leaf_size be larger or max_depth smaller");
        for (Node n : other.nodes) {
            if (n.is_leaf())
                n.set_first(n.first() + item_shift);
            else
                n.set_link(n.link() + node_shift);
            nodes.push_back(n);
        }
        items.insert(items.end(), other.items.begin(), other.items.end());
        depth = std::max(depth, other.depth);
    }
    std::size_t bytes() const {
        return nodes.capacity() * sizeof(Node) + items.capacity() * sizeof(PrimitiveId);
    }
    void shrink_to_fit() {
        nodes.shrink_to_fit();
        items.shrink_to_fit();
    }
};

/// Grows a tree top down. `Cutter` has a `Cell` with `size()` and `for_each_id(f)`, `choose(cell, depth) ->
/// std::optional<plane>` (none: a leaf) and `cut(cell, plane) -> std::pair<Cell, Cell>`, which may use the
/// cell up. The tree is the same however many threads build it.
template <class Node, class Cutter>
class CutTreeGrowth {
public:
    using Cell = typename Cutter::Cell;
    using Tree = CutTree<Node>;

    CutTreeGrowth(const Cutter& cutter, int deepest, Executor& executor)
        : cutter_(cutter), deepest_(deepest), executor_(executor) {}

    Tree grow(Cell root) {
        Tree tree;
        grow(std::move(root), 1, tree);
        tree.shrink_to_fit();
        return tree;
    }

private:
    void grow(Cell cell, int depth, Tree& tree) {
        tree.depth = std::max(tree.depth, depth);
        const auto plane = depth < deepest_ ? cutter_.choose(cell, depth) : std::nullopt;
        if (!plane) return add_leaf(cell, tree);

        const auto at = tree.nodes.size();
        tree.nodes.push_back(Node::inner(*plane));
        const bool large = cell.size() > 4096;
        auto [low, high] = cutter_.cut(cell, *plane);
        cell = {};
        if (large) {
            Tree high_tree;
            executor_.both([&, &side = low] { grow(std::move(side), depth + 1, tree); },
                           [&, &side = high] { grow(std::move(side), depth + 1, high_tree); });
            tree.nodes[at].set_link(static_cast<std::uint32_t>(tree.nodes.size()));
            tree.append(high_tree);
        } else {
            grow(std::move(low), depth + 1, tree);
            tree.nodes[at].set_link(static_cast<std::uint32_t>(tree.nodes.size()));
            grow(std::move(high), depth + 1, tree);
        }
    }
    void add_leaf(const Cell& cell, Tree& tree) {
        tree.nodes.push_back(Node::leaf(static_cast<std::uint32_t>(tree.items.size()), cell.size()));
        cell.for_each_id([&](PrimitiveId id) { tree.items.push_back(id); });
    }

    const Cutter& cutter_;
    int deepest_;
    Executor& executor_;
};

/// A depth that trees seldom need: 8 + 1.3·log2(n) (Pharr, Jakob, Humphreys, Physically Based
/// Rendering, 4.4).
inline int usual_depth(std::size_t count) {
    return 8 + static_cast<int>(1.3 * static_cast<double>(std::bit_width(count)));
}

}  // namespace hedgerow
