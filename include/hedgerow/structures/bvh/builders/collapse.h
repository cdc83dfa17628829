/// Turns any tree with one primitive a leaf into a BuildTree: subtrees become leaves where that is cheaper,
/// and no leaf lies too deep.
#pragma once

#include <concepts>
#include <span>

#include <hedgerow/structures/bvh/build_tree.h>

namespace hedgerow {

/// A binary tree over `size(root())` primitives, one primitive a leaf.
template <class S, class T>
concept FullTree = requires(const S& s, typename S::Node n) {
    { s.root() } -> std::same_as<typename S::Node>;
    { s.size(n) } -> std::convertible_to<std::uint32_t>;                               // primitives below
    { s.children(n) } -> std::same_as<std::pair<typename S::Node, typename S::Node>>;  // where size(n) > 1
    { s.item(n) } -> std::same_as<PrimitiveId>;                                        // where size(n) == 1
    { s.box(n) } -> std::convertible_to<LaneBox<T>>;                                   // where size(n) == 1
};

/// A new tree over the leaves of a subtree, in their order, halved by count: the least depth there is.
template <class Tree>
class Halves {
public:
    struct Node {
        std::uint32_t first, last;
    };
    Halves(const Tree& tree, typename Tree::Node top) : tree_(tree) {
        std::vector<typename Tree::Node> open{top};
        while (!open.empty()) {
            const auto n = open.back();
            open.pop_back();
            if (tree.size(n) == 1) {
                leaves_.push_back(n);
            } else {
                const auto [left, right] = tree.children(n);
                open.push_back(right);
                open.push_back(left);
            }
        }
    }
    Node root() const { return {0, static_cast<std::uint32_t>(leaves_.size())}; }
    std::uint32_t size(Node n) const { return n.last - n.first; }
    std::pair<Node, Node> children(Node n) const {
        const std::uint32_t middle = n.first + size(n) / 2;
        return {{n.first, middle}, {middle, n.last}};
    }
    PrimitiveId item(Node n) const { return tree_.item(leaves_[n.first]); }
    auto box(Node n) const { return tree_.box(leaves_[n.first]); }

private:
    const Tree& tree_;
    std::vector<typename Tree::Node> leaves_;
};

template <class Tree>
inline constexpr bool is_halved = false;
template <class Tree>
inline constexpr bool is_halved<Halves<Tree>> = true;

/// Bottom-up collapse: a subtree of at most `max_leaf_size` primitives becomes a leaf where that costs no
/// more by the SAH. O(n), parallel over subtrees. A node so deep that only halving by count keeps the bound
/// on depth has its primitives halved. A subtree of n primitives owns 2n − 1 places in the list of nodes and
/// n in the list of items, so the result is the same for any number of threads.
template <std::floating_point T, int D>
class Collapse {
public:
    Collapse(const SahOptions& options, Executor& executor) : options_(options), executor_(executor) {}

    /// The collapsed tree over n primitives. `cost`, if given, is set to its SAH cost times the root's half
    /// area.
    template <FullTree<T> Tree>
    BuildTree<T, D> build(const Tree& tree, std::uint32_t n, double* cost = nullptr) {
        if (n == 0) return {};
        tree_.nodes.resize(2 * std::size_t(n) - 1);
        tree_.items.resize(n);
        const Grown all = grow(tree, tree.root(), 0, 0, 1);
        tree_.leaves = all.leaves;
        if (cost != nullptr) *cost = all.cost;
        return std::move(tree_);
    }

private:
    struct Grown {
        LaneBox<T> box;
        double cost;
        std::uint32_t leaves, end;  // end: the first place after the nodes in use
    };

    /// Writes the subtree of `n`, its items from `first` on and its nodes from `at` on.
    template <class Tree>
    Grown grow(const Tree& tree, typename Tree::Node n, std::uint32_t first, std::uint32_t at, int depth) {
        const std::uint32_t size = tree.size(n);
        // Make a leaf where that is the cheapest whatever the boxes are.
        if (size == 1 || (size <= 8 && options_.always_leaf(size))) {  // 8 bounds the recursion of `fill`
            auto box = LaneBox<T>::none();
            fill(tree, n, first, box);
            return leaf(box, area(box), first, size, at);
        }
        // Halve the primitives by count where the tree would grow too deep otherwise.
        if constexpr (!is_halved<Tree>)
            if (bvh_must_halve(depth, size)) {
                const Halves<Tree> halves(tree, n);
                return grow(halves, halves.root(), first, at, depth);
            }
        // Write both children, as two tasks if the subtree is large, and join or collapse them.
        const auto [l, r] = tree.children(n);
        const std::uint32_t on_left = tree.size(l);
        Grown left, right;
        if (size > worth_a_task) {
            const std::uint32_t right_at = at + 2 * on_left;
            executor_.both([&, l = l] { left = grow_task(tree, l, first, at + 1, depth + 1); },
                           [&, r = r] { right = grow_task(tree, r, first + on_left, right_at, depth + 1); });
            return join(left, right, first, size, at, right_at);
        }
        left = grow(tree, l, first, at + 1, depth + 1);
        right = grow(tree, r, first + on_left, left.end, depth + 1);
        return join(left, right, first, size, at, left.end);
    }
    template <class Tree>
    Grown grow_task(const Tree& tree, typename Tree::Node n, std::uint32_t first, std::uint32_t at,
                    int depth) {
        const Grown grown = grow(tree, n, first, at, depth);
        if (tree.size(n) <= worth_a_task) executor_.advance(tree.size(n));
        return grown;
    }
    template <class Tree>
    void fill(const Tree& tree, typename Tree::Node n, std::uint32_t first, LaneBox<T>& box) {
        if (tree.size(n) == 1) {
            tree_.items[first] = tree.item(n);
            return box.expand(tree.box(n));
        }
        const auto [left, right] = tree.children(n);
        fill(tree, left, first, box);
        fill(tree, right, first + tree.size(left), box);
    }
    Grown leaf(const LaneBox<T>& box, double area, std::uint32_t first, std::uint32_t count,
               std::uint32_t at) {
        BuildNode<T, D>& node = tree_.nodes[at];
        node.set(box.template box<D>());
        node.first = first, node.count = count;
        return {box, options_.leaf_cost(count, area), 1, at + 1};
    }
    Grown join(const Grown& left, const Grown& right, std::uint32_t first, std::uint32_t count,
               std::uint32_t at, std::uint32_t right_at) {
        LaneBox<T> box = left.box;
        box.expand(right.box);
        const double here = area(box);
        const double cost = options_.traversal_cost * here + left.cost + right.cost;
        if (options_.makes_leaf(count, here, cost)) return leaf(box, here, first, count, at);
        BuildNode<T, D>& node = tree_.nodes[at];
        node.set(box.template box<D>());
        node.count = 0;
        node.left = at + 1, node.right = right_at;
        node.first = left.leaves + right.leaves;
        return {box, cost, left.leaves + right.leaves, right.end};
    }
    static double area(const LaneBox<T>& box) { return static_cast<double>(box.template half_area<D>()); }

    SahOptions options_;
    Executor& executor_;
    BuildTree<T, D> tree_;
};

}  // namespace hedgerow
