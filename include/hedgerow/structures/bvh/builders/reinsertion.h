/// Improvement by reinsertion (Bittner, Hapala, Havran, CGF 2013), in batches that are searched in parallel
/// (Meister and Bittner, EG 2018): a subtree is taken out and inserted beside the node for which the areas of
/// all inner nodes have the least sum. Leaves stay as they are.
///
/// A pass searches the best place for each of the largest nodes, by branch and bound from the node's own
/// place upward. Then it makes the moves, greatest gain first. An earlier move may have changed the
/// surroundings: a move that no longer gains half of what was expected is undone, and the node's best place
/// is searched anew at once. So one pass gains what takes several passes that drop such moves, as Meister and
/// Bittner's do, and every move lowers the cost. Searches see the tree as it was before the pass, and one
/// thread makes the moves in a fixed order, so the result is the same for any number of threads. O(n log n) a
/// pass, as is observed. Left out: Bittner's order by how badly a node fits (sum, minimum and area of its
/// children).
#pragma once

#include <algorithm>
#include <cmath>

#include <hedgerow/parallel/executor.h>
#include <hedgerow/parallel/sort.h>
#include <hedgerow/structures/bvh/build_tree.h>

namespace hedgerow {

/// A tree whose subtrees are moved in place. Nodes keep their numbers.
template <std::floating_point T, int D>
class MovableTree {
public:
    using Node = std::uint32_t;
    static constexpr Node none = 0xFFFFFFFFu;

    /// The tree has at least one leaf.
    explicit MovableTree(BuildTree<T, D>& tree) : nodes_(tree.nodes), parents_(tree.nodes.size()) {
        all_.reserve(2 * std::size_t(tree.leaves) - 1);
        parents_[root()] = none;
        link(root());
    }

    static constexpr Node root() { return 0; }
    /// All nodes, in a fixed order.
    const std::vector<Node>& all() const { return all_; }
    bool leaf(Node n) const { return nodes_[n].count > 0; }
    std::pair<Node, Node> children(Node n) const { return {nodes_[n].left, nodes_[n].right}; }
    Node parent(Node n) const { return parents_[n]; }
    Node sibling(Node n) const {
        const auto [left, right] = children(parent(n));
        return left == n ? right : left;
    }
    LaneBox<T> box(Node n) const { return LaneBox<T>::of(nodes_[n].box()); }
    double area(Node n) const { return static_cast<double>(nodes_[n].box().half_area()); }
    bool below(Node n, Node top) const {
        while (n != top && n != none) n = parent(n);
        return n == top;
    }
    std::uint32_t leaves(Node n) const { return nodes_[n].leaves(); }
    /// The root's level is 1.
    int level(Node n) const {
        int level = 1;
        for (; n != root(); n = parent(n)) ++level;
        return level;
    }
    /// Whether `n` is neither the root nor a child of it.
    bool movable(Node n) const { return n != root() && parent(n) != root(); }

    /// Takes out `n`, which is movable, and inserts it as the sibling of `to`, which is neither above nor
    /// below `n`. Returns by how much the sum of the areas of all inner nodes shrinks. Moving `n` back to its
    /// old sibling undoes the move.
    double move(Node n, Node to) {
        const Node joint = parent(n), rest = sibling(n), above = parent(joint);
        replace(above, joint, rest);
        const double gain = refit(above);
        replace(parent(to), to, joint);
        nodes_[joint].left = to, nodes_[joint].right = n;
        parents_[to] = joint;
        return gain + refit(joint);
    }
    /// Halves subtrees by count where the tree would be deeper than bvh_max_depth otherwise.
    void limit_depth() { limit_depth(root(), 1); }

private:
    void link(Node n) {
        all_.push_back(n);
        if (leaf(n)) return;
        const auto [left, right] = children(n);
        parents_[left] = parents_[right] = n;
        link(left);
        link(right);
    }
    void replace(Node parent, Node child, Node by) {
        (nodes_[parent].left == child ? nodes_[parent].left : nodes_[parent].right) = by;
        parents_[by] = parent;
    }
    /// Fits an inner node and all nodes above it to their children. Returns by how much their areas shrink.
    double refit(Node n) {
        double gain = 0;
        for (; n != none; n = parent(n)) {
            gain += area(n);
            fit(n);
            gain -= area(n);
        }
        return gain;
    }
    void fit(Node n) {
        const auto [left, right] = children(n);
        LaneBox<T> around = box(left);
        around.expand(box(right));
        nodes_[n].set(around.template box<D>());
        nodes_[n].first = nodes_[left].leaves() + nodes_[right].leaves();
    }

    void limit_depth(Node n, int level) {
        if (leaf(n)) return;
        if (bvh_must_halve(level, leaves(n))) return halve(n);
        const auto [left, right] = children(n);
        limit_depth(left, level + 1);
        limit_depth(right, level + 1);
    }
    /// Makes a new tree over the leaves below `n`, in their order, of the same inner nodes.
    void halve(Node n) {
        std::vector<Node> open{n}, inner, leaves;
        while (!open.empty()) {
            const Node at = open.back();
            open.pop_back();
            (leaf(at) ? leaves : inner).push_back(at);
            if (leaf(at)) continue;
            const auto [left, right] = children(at);
            open.push_back(right);
            open.push_back(left);
        }
        auto next = inner.begin();
        const auto join = [&](auto& self, std::size_t first, std::size_t last) -> Node {
            if (last - first == 1) return leaves[first];
            const Node at = *next++;
            const std::size_t middle = first + (last - first) / 2;
            nodes_[at].left = self(self, first, middle);
            nodes_[at].right = self(self, middle, last);
            fit(at);
            return at;
        };
        join(join, 0, leaves.size());
    }

    SparseVector<BuildNode<T, D>>& nodes_;
    SparseVector<Node> parents_;
    std::vector<Node> all_;
};

template <std::floating_point T, int D>
class Reinsertion {
public:
    /// Each pass searches this share of the nodes, the largest.
    Reinsertion(BuildTree<T, D>& tree, double share, Executor& executor)
        : tree_(tree), share_(share), executor_(executor) {}

    /// Makes at most `passes` passes, and stops after one that gains no more than `least_gain` of the cost.
    void improve(int passes) {
        double cost = inner_area();
        for (int left = passes; left > 0; --left) {
            executor_.look();
            const double gain = pass();
            if (!(gain > least_gain * cost)) {
                executor_.advance(work(left - 1));
                break;
            }
            cost -= gain;
        }
        tree_.limit_depth();
    }
    /// The work of so many passes, in primitives, as `Executor::expect` counts it.
    std::size_t work(int passes) const {
        return static_cast<std::size_t>(passes) * work_a_search * searches();
    }

private:
    using Node = typename MovableTree<T, D>::Node;
    static constexpr double least_gain = 0.005;      // of a pass, as a share of the cost
    static constexpr std::size_t work_a_search = 4;  // primitives that are split in the time of one search

    struct Move {
        Node node = 0, to = 0;
        double gain = 0;  // area of inner nodes
    };

    std::size_t searches() const {
        return static_cast<std::size_t>(std::ceil(share_ * static_cast<double>(tree_.all().size())));
    }
    double inner_area() const {
        double sum = 0;
        for (const Node n : tree_.all())
            if (!tree_.leaf(n)) sum += tree_.area(n);
        return sum;
    }
    /// Returns the gain of the pass.
    double pass() {
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
        double gain = 0;
        std::vector<Open> open;
        for (std::size_t i = 0; i < moves.size(); ++i) {
            if (i % 1024 == 0) executor_.look();
            gain += make(moves[i], open);
        }
        return gain;
    }
    /// The movable nodes of largest area, in the order of their numbers.
    std::vector<Move> largest() const {
        std::vector<std::pair<double, Node>> all;
        all.reserve(tree_.all().size());
        for (const Node n : tree_.all())
            if (tree_.movable(n)) all.emplace_back(-tree_.area(n), n);
        const std::size_t count = std::min(searches(), all.size());
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
        int level;
    };
    /// The best move of a node: searches the other child of each ancestor, from the node's place upward. The
    /// gain is the area of the node's parent, which the move removes, and the area by which ancestors shrink:
    /// those that are not above the new place.
    Move best_move(Node node, std::vector<Open>& open) const {
        Move best{node, node, 0};
        double gain = tree_.area(tree_.parent(node));
        LaneBox<T> shrunk = tree_.box(tree_.sibling(node));
        int level = tree_.level(node);
        for (Node on = node; on != tree_.root(); --level) {
            const Node beside = tree_.sibling(on);
            open.push_back({gain, beside, level});
            search(open, best);
            on = tree_.parent(on);
            if (on == tree_.parent(node)) continue;
            shrunk.expand(tree_.box(beside));
            gain += tree_.area(on) - area(shrunk);
        }
        return best;
    }
    /// Branch and bound: the new parent is no smaller than the moved node, and the nodes passed on the way
    /// down only grow, so no place in a subtree gains more than `gain - own`. Places where the tree would
    /// grow too deep are left out.
    void search(std::vector<Open>& open, Move& best) const {
        const double own = tree_.area(best.node);
        const LaneBox<T> box = tree_.box(best.node);
        const std::uint32_t leaves = tree_.leaves(best.node);
        while (!open.empty()) {
            const auto [gain, at, level] = open.back();
            open.pop_back();
            if (!(gain - own > best.gain) || bvh_must_halve(level, tree_.leaves(at) + leaves)) continue;
            LaneBox<T> joint = tree_.box(at);
            joint.expand(box);
            const double left = gain - area(joint);
            if (left > best.gain) best.gain = left, best.to = at;
            if (tree_.leaf(at)) continue;
            const double below = left + tree_.area(at);
            if (!(below - own > best.gain)) continue;
            const auto [l, r] = tree_.children(at);
            open.push_back({below, l, level + 1});
            open.push_back({below, r, level + 1});
        }
    }
    /// Makes a move, or the best one of its node if that is another by now. Returns the gain.
    double make(const Move& m, std::vector<Open>& open) {
        if (!tree_.movable(m.node)) return 0;
        if (const double gain = tried(m); gain > 0) return gain;
        const Move now = best_move(m.node, open);
        return now.gain > 0 ? tried(now) : 0;
    }
    /// Makes a move that gains at least half of what is expected of it. Returns the gain, or 0.
    double tried(const Move& m) {
        const Node rest = tree_.sibling(m.node);
        if (m.to == rest || tree_.below(m.to, m.node) || tree_.below(m.node, m.to)) return 0;
        const double gain = tree_.move(m.node, m.to);
        if (gain >= m.gain / 2) return gain;
        tree_.move(m.node, rest);
        return 0;
    }
    static double area(const LaneBox<T>& box) { return static_cast<double>(box.template half_area<D>()); }

    MovableTree<T, D> tree_;
    double share_;
    Executor& executor_;
};

/// Improves a tree by at most `passes` passes over this share of its nodes, the largest. The tree never
/// costs more than before, except where it grew so deep that subtrees are halved by count.
template <std::floating_point T, int D>
void reinsert(BuildTree<T, D>& tree, int passes, double share, Executor& executor) {
    if (passes == 0 || tree.leaves < 4) return;  // fewer leaves have no other tree worth a search
    Reinsertion<T, D> reinsertion(tree, share, executor);
    executor.expect(reinsertion.work(passes));
    reinsertion.improve(passes);
}

}  // namespace hedgerow
