/// Improvement by reinsertion (Bittner, Hapala, Havran, CGF 2013), in batches that are searched in parallel
/// (Meister and Bittner, EG 2018): a subtree is taken out and inserted beside the node for which the areas of
/// all inner nodes have the least sum.
///
/// A pass searches the best place for each of the largest three tenths of the nodes, by branch and bound from
/// the node's own place upward. Then it makes the moves that gain, greatest gain first, and skips a move if
/// an earlier one touched the same nodes. Searches see the tree as it was before the pass, and one thread
/// makes the moves in a fixed order, so the result is the same for any number of threads. O(n log n) a pass,
/// as is observed. By the SAH the result never costs more than the given tree. Left out: Bittner's order by
/// how badly a node fits (sum, minimum and area of its children).
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>

#include <hedgerow/parallel/sort.h>
#include <hedgerow/structures/bvh/builders/collapse.h>

namespace hedgerow {

/// A full tree whose subtrees can be moved.
template <std::floating_point T, int D>
class MovableTree {
public:
    using Node = std::uint32_t;
    static constexpr Node none = 0xFFFFFFFFu;

    /// A copy of a tree of at least one primitive, one primitive a leaf.
    explicit MovableTree(const BuildTree<T, D>& tree) {
        const std::size_t count = 2 * tree.items.size() - 1;
        boxes_.reserve(count);
        links_.reserve(count);
        copy(tree, 0, none);
    }

    Node root() const { return 0; }
    std::uint32_t size(Node n) const { return links_[n].size; }
    std::pair<Node, Node> children(Node n) const { return {links_[n].left, links_[n].right}; }
    PrimitiveId item(Node n) const { return links_[n].right; }
    const LaneBox<T>& box(Node n) const { return boxes_[n]; }

    Node node_count() const { return static_cast<Node>(links_.size()); }
    bool leaf(Node n) const { return links_[n].left == none; }
    Node parent(Node n) const { return links_[n].parent; }
    Node sibling(Node n) const {
        const Links& p = links_[parent(n)];
        return p.left == n ? p.right : p.left;
    }
    double area(Node n) const { return static_cast<double>(boxes_[n].template half_area<D>()); }
    bool below(Node n, Node top) const {
        while (n != top && n != none) n = parent(n);
        return n == top;
    }

    /// Takes out `n`, which is neither the root nor a child of it, and inserts it as the sibling of `to`,
    /// which is not below `n`.
    void move(Node n, Node to) {
        const Node joint = parent(n), rest = sibling(n), above = parent(joint);
        replace(above, joint, rest);
        refit(above);
        const Node there = parent(to);
        replace(there, to, joint);
        links_[joint].left = to, links_[joint].right = n;
        links_[to].parent = joint;
        refit(joint);
    }

private:
    struct Links {
        Node parent, left, right;  // a leaf has none in `left` and its primitive in `right`
        std::uint32_t size;
    };

    Node copy(const BuildTree<T, D>& tree, std::uint32_t from, Node parent) {
        const auto& node = tree.nodes[from];
        const Node at = node_count();
        boxes_.push_back(LaneBox<T>::of(node.box()));
        links_.push_back({parent, none, 0, 1});
        assert(node.count <= 1);
        if (node.count == 1) {
            links_[at].right = tree.items[node.first];
        } else {
            const Node left = copy(tree, node.left, at), right = copy(tree, node.right, at);
            links_[at] = {parent, left, right, size(left) + size(right)};
        }
        return at;
    }
    void replace(Node parent, Node child, Node by) {
        (links_[parent].left == child ? links_[parent].left : links_[parent].right) = by;
        links_[by].parent = parent;
    }
    void refit(Node n) {
        for (; n != none; n = parent(n)) {
            const auto [left, right] = children(n);
            boxes_[n] = boxes_[left];
            boxes_[n].expand(boxes_[right]);
            links_[n].size = size(left) + size(right);
        }
    }

    std::vector<LaneBox<T>> boxes_;
    std::vector<Links> links_;
};

template <std::floating_point T, int D>
class Reinsertion {
public:
    Reinsertion(MovableTree<T, D>& tree, Executor& executor) : tree_(tree), executor_(executor) {}

    /// Makes at most `passes` passes, and stops after one that gains no more than `least_gain` of the cost.
    void improve(int passes) {
        double cost = inner_area();
        for (int left = passes; left > 0; --left) {
            executor_.look();
            pass();
            const double now = inner_area();
            if (!(now < (1 - least_gain) * cost)) return executor_.advance(work(left - 1));
            cost = now;
        }
    }
    /// The work of so many passes, in primitives, as `Executor::expect` counts it.
    std::size_t work(int passes) const {
        return static_cast<std::size_t>(passes) * work_a_search * searches(tree_.node_count());
    }

private:
    using Node = typename MovableTree<T, D>::Node;
    // Per pass: the share of the nodes that is searched, and the least gain as a share of the cost.
    static constexpr double share = 0.3, least_gain = 0.005;
    static constexpr std::size_t work_a_search = 4;  // primitives that are split in the time of one search

    struct Move {
        Node node = 0, to = 0;
        double gain = 0;  // area of inner nodes
    };

    static std::size_t searches(std::size_t nodes) {
        return static_cast<std::size_t>(std::ceil(share * static_cast<double>(nodes)));
    }
    double inner_area() const {
        double sum = 0;
        for (Node n = 0; n < tree_.node_count(); ++n)
            if (!tree_.leaf(n)) sum += tree_.area(n);
        return sum;
    }
    void pass() {
        // Search the best place of each large node in parallel.
        std::vector<Move> moves = largest();
        executor_.for_each_piece(moves.size(), 64, [&](std::size_t begin, std::size_t end) {
            std::vector<Open> open;
            for (std::size_t i = begin; i < end; ++i) moves[i] = best_move(moves[i].node, open);
            executor_.advance(work_a_search * (end - begin));
        });
        // Sort the moves that gain, the greatest gain first and equal gains by node.
        std::erase_if(moves, [](const Move& m) { return !(m.gain > 0); });
        sort_watched(moves.begin(), moves.end(), executor_, [](const Move& a, const Move& b) {
            return a.gain != b.gain ? a.gain > b.gain : a.node < b.node;
        });
        // Make the moves one after another.
        touched_.assign(tree_.node_count(), std::uint8_t(0));
        for (std::size_t i = 0; i < moves.size(); ++i) {
            if (i % 1024 == 0) executor_.look();
            apply(moves[i]);
        }
    }
    /// The movable nodes of largest area, in the order of their numbers.
    std::vector<Move> largest() const {
        std::vector<std::pair<double, Node>> all;
        for (Node n = 0; n < tree_.node_count(); ++n)
            if (n != tree_.root() && tree_.parent(n) != tree_.root()) all.emplace_back(-tree_.area(n), n);
        const std::size_t count = searches(all.size());
        std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end());
        std::vector<Move> moves(count);
        for (std::size_t i = 0; i < count; ++i) moves[i].node = all[i].second;
        sort_watched(moves.begin(), moves.end(), executor_,
                     [](const Move& a, const Move& b) { return a.node < b.node; });
        return moves;
    }

    /// A subtree that may contain the new place, and the gain on the way to it.
    struct Open {
        double gain;
        Node top;
    };
    /// The best move of a node: searches the other child of each ancestor, from the node's place upward. The
    /// gain is the area of the node's parent, which the move removes, and the area by which ancestors shrink:
    /// those that are not above the new place.
    Move best_move(Node node, std::vector<Open>& open) const {
        Move best{node, node, 0};
        double gain = tree_.area(tree_.parent(node));
        LaneBox<T> shrunk = tree_.box(tree_.sibling(node));
        for (Node on = node; on != tree_.root();) {
            const Node beside = tree_.sibling(on);
            open.push_back({gain, beside});
            search(open, best);
            on = tree_.parent(on);
            if (on == tree_.parent(node)) continue;
            shrunk.expand(tree_.box(beside));
            gain += tree_.area(on) - area(shrunk);
        }
        return best;
    }
    /// Branch and bound: the new parent is no smaller than the moved node, and the nodes passed on the way
    /// down only grow, so no place in a subtree gains more than `gain - own`.
    void search(std::vector<Open>& open, Move& best) const {
        const double own = tree_.area(best.node);
        while (!open.empty()) {
            const auto [gain, at] = open.back();
            open.pop_back();
            if (!(gain - own > best.gain)) continue;
            LaneBox<T> joint = tree_.box(at);
            joint.expand(tree_.box(best.node));
            const double left = gain - area(joint);
            if (left > best.gain) best.gain = left, best.to = at;
            if (tree_.leaf(at)) continue;
            const double below = left + tree_.area(at);
            if (!(below - own > best.gain)) continue;
            const auto [l, r] = tree_.children(at);
            open.push_back({below, l});
            open.push_back({below, r});
        }
    }
    /// Makes a move, unless an earlier one changed the surroundings of either place or brought `to` below the
    /// node.
    void apply(const Move& m) {
        const Node changed[] = {m.node, tree_.sibling(m.node), tree_.parent(m.node), m.to,
                                tree_.parent(m.to)};
        for (const Node n : changed)
            if (touched_[n] != 0) return;
        if (tree_.below(m.to, m.node)) return;
        for (const Node n : changed) touched_[n] = 1;
        tree_.move(m.node, m.to);
    }
    static double area(const LaneBox<T>& box) { return static_cast<double>(box.template half_area<D>()); }

    MovableTree<T, D>& tree_;
    Executor& executor_;
    std::vector<std::uint8_t> touched_;
};

/// `tree`, which must have one primitive a leaf, after at most `passes` passes. Leaves of several primitives
/// are made last. Without a gain it is the collapse of `tree` itself.
template <std::floating_point T, int D>
BuildTree<T, D> reinserted(const BuildTree<T, D>& tree, const SahOptions& options, int passes,
                           Executor& executor) {
    if (tree.items.empty()) return {};
    MovableTree<T, D> movable(tree);
    const std::uint32_t size = movable.size(movable.root());
    double before = 0, after = 0;
    Reinsertion<T, D> reinsertion(movable, executor);
    executor.expect(2 * size + reinsertion.work(passes));
    auto as_it_was = Collapse<T, D>(options, executor).build(movable, size, &before);
    reinsertion.improve(passes);
    auto improved = Collapse<T, D>(options, executor).build(movable, size, &after);
    return after < before ? std::move(improved) : std::move(as_it_was);
}

}  // namespace hedgerow
