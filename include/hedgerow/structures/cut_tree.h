/// Shared by kd-trees and BSP trees: the layout of their nodes, and the recursion that grows them.
#pragma once

#include <atomic>
#include <concepts>
#include <optional>

#include <hedgerow/structures/references.h>
#include <hedgerow/walks/query.h>

namespace hedgerow {

/// A tree as it is walked. Node 0 is the root, and node 1 is unused. An inner node's `link` is the index of
/// its low child, and the high child follows the low one. A leaf's `link` is its number of items, and `first`
/// is the index of its first item.
template <class Node>
struct CutTree {
    std::vector<Node> nodes;
    std::vector<PrimitiveId> items;
    int depth = 0;

    std::size_t bytes() const {
        return nodes.capacity() * sizeof(Node) + items.capacity() * sizeof(PrimitiveId);
    }
    std::size_t leaf_count() const { return nodes.size() / 2; }
};

/// A tree or subtree while it grows. An inner node's low child follows it, and its `link` is the index of its
/// high child.
template <class Node>
struct GrowingCutTree {
    std::vector<Node> nodes;
    std::vector<PrimitiveId> items;
    int depth = 0;

    /// Appends another subtree. Throws InputError for more than Node::most nodes or 2^32 − 1 items.
    void append(const GrowingCutTree& other) {
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
    /// Copies the tree so that siblings lie side by side, and so that small subtrees of as many pairs as fill
    /// a cache line lie together. A walk down touches fewer lines than in depth-first order (as with the
    /// treelets of Yoon and Manocha, 2006). O(n).
    CutTree<Node> packed(Executor& executor) && {
        // Pairs of siblings in a cache line of 64 bytes.
        constexpr std::size_t pairs_together = 64 / (2 * sizeof(Node)) > 1 ? 64 / (2 * sizeof(Node)) : 1;
        struct Copied {
            std::uint32_t grown, packed;
        };
        // Copy the root, and put an unused node behind it.
        CutTree<Node> tree;
        tree.nodes.reserve(nodes.size() + 1);
        tree.nodes.push_back(nodes[0]);
        tree.nodes.push_back(Node::leaf(0, 0));
        std::vector<Copied> waiting = {{0, 0}}, near;
        while (!waiting.empty()) {
            if (tree.nodes.size() % (2 * worth_a_task) == 0) executor.look();
            near.assign(1, waiting.back());
            waiting.pop_back();
            // Copy the pairs below one node breadth first, as many as fill a line.
            std::size_t next = 0;
            for (; next < near.size() && next < pairs_together; ++next) {
                const Copied at = near[next];
                if (nodes[at.grown].is_leaf()) continue;
                const auto pair = static_cast<std::uint32_t>(tree.nodes.size());
                tree.nodes[at.packed].set_link(pair);
                const std::uint32_t children[] = {at.grown + 1, nodes[at.grown].link()};
                for (std::uint32_t i = 0; i < 2; ++i) {
                    tree.nodes.push_back(nodes[children[i]]);
                    if (!nodes[children[i]].is_leaf()) near.push_back({children[i], pair + i});
                }
            }
            // Push the nodes whose children are not copied yet: each starts another small subtree.
            waiting.insert(waiting.end(), near.rbegin(), near.rend() - static_cast<std::ptrdiff_t>(next));
        }
        items.shrink_to_fit();
        tree.items = std::move(items);
        tree.depth = depth;
        return tree;
    }
};

/// What divides the cells of a tree of planes. A cell has a size, the number of its primitives, and calls
/// f(id) for each of them by `for_each_id(f)`. `choose` returns the plane to cut a cell by, or nothing if the
/// cell becomes a leaf. `cut` returns the cells on the plane's low and high sides.
template <class C>
concept CellCutter = requires(const C& c, typename C::Cell& cell, int depth) {
    { cell.size() } -> std::convertible_to<std::uint32_t>;
    cell.for_each_id([](PrimitiveId) {});
    { c.cut(cell, *c.choose(cell, depth)) } -> std::same_as<std::pair<typename C::Cell, typename C::Cell>>;
};

/// Grows a tree from the root down. The tree is the same for any number of threads.
///
/// A tree that would have more items than the limit is abandoned and grown again with rations. A cell's
/// ration is the number of items that its subtree may have. The two sides of a cell share its ration in
/// proportion to their primitives, and a cell whose sides together have more primitives than its ration
/// becomes a leaf. So a tree within the limit is the tree that would grow without one, and any other tree
/// takes at most about twice the time that its items explain.
template <class Node, CellCutter Cutter>
class CutTreeGrowth {
public:
    using Cell = typename Cutter::Cell;
    using Tree = GrowingCutTree<Node>;

    /// `most_items` must be at least the number of primitives.
    CutTreeGrowth(const Cutter& cutter, int deepest, std::uint64_t most_items, Executor& executor)
        : cutter_(cutter), deepest_(deepest), most_items_(most_items), executor_(executor) {}

    /// `root()` returns the first cell. It is called again if the tree exceeds the limit.
    template <class Root>
    CutTree<Node> grow(Root root) {
        Tree tree;
        grow_all(root(), tree);
        if (items_ > most_items_) {
            tree = {};
            rationed_ = true;
            grow_all(root(), tree);
        }
        return std::move(tree).packed(executor_);
    }

private:
    void grow_all(Cell cell, Tree& tree) {
        executor_.expect(cell.size());
        const auto work = static_cast<double>(cell.size());
        grow(std::move(cell), most_items_, 1, work, tree);
    }
    /// `work` is the cell's share of the tree's primitives, for progress. The cell's size is no measure of
    /// it, since deeper levels have more copies.
    void grow(Cell cell, std::uint64_t ration, int depth, double work, Tree& tree) {
        if (!rationed_ && items_ > most_items_) return;
        tree.depth = std::max(tree.depth, depth);
        // Choose a plane. Without one the cell becomes a leaf.
        const auto plane = depth < deepest_ ? cutter_.choose(cell, depth) : std::nullopt;
        const bool large = cell.size() > worth_a_task;
        if (!plane && large) executor_.advance(static_cast<std::size_t>(work));
        if (!plane) return add_leaf(cell, tree);
        if (large) executor_.look();
        // Cut the cell. If its sides exceed the ration, it becomes a leaf after all.
        auto [low, high] = cutter_.cut(cell, *plane);
        const std::uint64_t items = std::uint64_t(low.size()) + high.size();
        if (rationed_ && items > ration) {
            if (large) executor_.advance(static_cast<std::size_t>(work));
            return add_leaf(cell, tree);
        }
        // Share the ration between the sides by their sizes.
        const double each =
            static_cast<double>(ration) / static_cast<double>(std::max<std::uint64_t>(items, 1));
        const auto low_ration = static_cast<std::uint64_t>(each * low.size());
        const std::uint64_t high_ration = ration - low_ration;

        // Grow the low side right behind the node, then the high side. The sides of a large cell grow in
        // parallel.
        const auto at = tree.nodes.size();
        tree.nodes.push_back(Node::inner(*plane));
        cell = {};
        if (large) {
            Tree high_tree;
            const double share = work / (static_cast<double>(low.size()) + static_cast<double>(high.size()));
            executor_.both([&, &side = low] { grow_task(side, low_ration, depth + 1, share, tree); },
                           [&, &side = high] { grow_task(side, high_ration, depth + 1, share, high_tree); });
            tree.nodes[at].set_link(static_cast<std::uint32_t>(tree.nodes.size()));
            tree.append(high_tree);
        } else {
            grow(std::move(low), low_ration, depth + 1, 0, tree);
            tree.nodes[at].set_link(static_cast<std::uint32_t>(tree.nodes.size()));
            grow(std::move(high), high_ration, depth + 1, 0, tree);
        }
    }
    /// `share` is the work of one of the cell's primitives.
    void grow_task(Cell& cell, std::uint64_t ration, int depth, double share, Tree& tree) {
        const double work = share * static_cast<double>(cell.size());
        const bool last = cell.size() <= worth_a_task;
        grow(std::move(cell), ration, depth, work, tree);
        if (last) executor_.advance(static_cast<std::size_t>(work));
    }
    void add_leaf(const Cell& cell, Tree& tree) {
        tree.nodes.push_back(Node::leaf(static_cast<std::uint32_t>(tree.items.size()), cell.size()));
        cell.for_each_id([&](PrimitiveId id) { tree.items.push_back(id); });
        items_ += cell.size();
    }

    const Cutter& cutter_;
    int deepest_;
    std::uint64_t most_items_;
    Executor& executor_;
    std::atomic<std::uint64_t> items_{0};  // in all leaves so far
    bool rationed_ = false;
};

/// The functions of a structure (walks/structure.h) that kd-trees and BSP trees share.
template <std::floating_point T, int D, class Node>
class PlantedCutTree {
public:
    static constexpr auto packed_order = PackedOrder::of_leaves;
    static constexpr bool exclusive() { return false; }

    const Box<T, D>& bounds() const { return bounds_; }
    std::span<const PrimitiveId> items() const { return tree_.items; }
    std::size_t bytes() const { return tree_.bytes(); }
    std::size_t node_count() const { return tree_.nodes.size(); }
    std::size_t leaf_count() const { return tree_.leaf_count(); }
    int depth() const { return tree_.depth; }

    // For the walk and `fold`.
    bool empty() const { return tree_.nodes.empty(); }
    bool is_leaf(NodeId n) const { return tree_.nodes[n].is_leaf(); }
    bool is_empty(NodeId n) const { return tree_.nodes[n].is_empty(); }
    Leaf leaf(NodeId n) const { return {tree_.items.data(), tree_.nodes[n].first(), tree_.nodes[n].link()}; }
    NodeId low_child(NodeId n) const { return tree_.nodes[n].link(); }
    NodeId high_child(NodeId n) const { return tree_.nodes[n].link() + 1; }

protected:
    /// What is wrong with the tree; empty if nothing is. `cut(node, cell, fault)` returns the two sides of a
    /// node's cell and may set the fault. `meets(id, cell)` returns whether a primitive may be in a cell.
    template <PrimitiveSet P, class Cell, class Cut, class Meets>
    std::string fault(const P& set, const Cell& root, int deepest, Cut cut, Meets meets) const {
        if (set.size() != count_) return "not built over these primitives";
        std::vector<std::uint8_t> seen(set.size());
        std::string fault;
        std::size_t visited = 0;
        // Check that a leaf's items are primitives that meet its cell.
        const auto visit_leaf = [&](const Leaf& leaf, const Cell& cell) {
            for (std::size_t i = leaf.first; i < std::size_t(leaf.first) + leaf.count; ++i) {
                if (i >= tree_.items.size() || tree_.items[i] >= set.size())
                    return void(fault = "an item that is no primitive");
                seen[tree_.items[i]] = 1;
                if (!meets(tree_.items[i], cell)) fault = "a primitive in a leaf that it does not meet";
            }
        };
        // Visit the nodes, and stop at a wrong link or beyond the deepest level.
        const auto visit = [&](auto& self, NodeId n, const Cell& cell, int depth) -> void {
            if (!fault.empty()) return;
            if (n >= tree_.nodes.size() || ++visited > tree_.nodes.size())
                return void(fault = "a child that is not there");
            if (depth > deepest) return void(fault = "deeper than its bound");
            if (is_leaf(n)) return visit_leaf(leaf(n), cell);
            const auto [low, high] = cut(n, cell, fault);
            self(self, low_child(n), low, depth + 1);
            self(self, high_child(n), high, depth + 1);
        };
        if (!empty()) visit(visit, 0, root, 1);
        for (const auto s : seen)
            if (!s && fault.empty()) fault = "a primitive is in no leaf";
        return fault;
    }

    Box<T, D> bounds_;
    CutTree<Node> tree_;
    std::size_t count_ = 0;
    bool mailbox_ = true;
};

/// A depth limit that trees seldom reach: 8 + 1.3·⌈log2(n + 1)⌉, rounded down (after Pharr, Jakob, Humphreys,
/// Physically Based Rendering, 4.4).
inline int usual_depth(std::size_t count) {
    return 8 + static_cast<int>(1.3 * static_cast<double>(std::bit_width(count)));
}

}  // namespace hedgerow
