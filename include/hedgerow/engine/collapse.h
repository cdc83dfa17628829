/// Collapses a binary tree into the wide tree of least cost that has the same leaves.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <hedgerow/engine/wide_tree.h>
#include <hedgerow/structures/bvh/build_tree.h>

namespace hedgerow {

/// Collapses by dynamic programming (Ylitie, Karras and Laine, Efficient incoherent ray traversal on GPUs
/// through compressed wide BVHs, HPG 2017). Unlike theirs, leaves stay as they are and so cost nothing. The
/// cost of a tree is the sum of its inner nodes' areas, as shares of the root's; if the root has no area,
/// their number. O(n · width²), in parallel over subtrees; one thread then numbers the nodes. The children
/// of a node, inner nodes and leaves alike, lie in the order in which they may stop a ray, the likeliest
/// last: any hits open the last entered child first. The result is the same for any number of threads.
template <std::floating_point T, int D>
class WideCollapse {
public:
    /// The tree has at least one leaf, and at most `most_leaves`. It must outlive this object.
    WideCollapse(const BuildTree<T, D>& tree, int width, Executor& executor)
        : tree_(tree),
          width_(width),
          row_(static_cast<std::size_t>(width - 1)),
          executor_(executor),
          whole_(static_cast<double>(tree.nodes[0].box().half_area())) {}

    /// A limit with which every NodeId and every place among the items fits in 32 bits.
    static constexpr std::uint32_t most_leaves = 1u << 28;

    WideTree<T, D> build() {
        costs_.resize((tree_.leaves - 1) * row_);
        weigh(root());
        open(root(), 1);
        opened_.push_back(children_.size());
        return laid_out();
    }

private:
    /// A node of the binary tree. Inner nodes are also numbered, depth first, so that their costs are stored
    /// without gaps.
    struct Node {
        std::uint32_t place, number;
    };
    struct Child {
        std::uint32_t place;  // in the binary tree
        WideChild to;
    };
    /// least[i]: the least cost of a subtree that becomes at most i + 1 children of a node above it.
    using Costs = std::array<float, most_wide - 1>;
    struct Split {
        float cost;
        int left;  // children that the left side gets
    };
    struct Children {
        std::array<Node, most_wide> list;
        std::size_t count = 0;

        void add(Node n) { list[count++] = n; }
    };

    Node root() const { return {0, 0}; }
    const BuildNode<T, D>& at(Node n) const { return tree_.nodes[n.place]; }
    bool leaf(Node n) const { return at(n).count > 0; }
    Node left(Node n) const { return {at(n).left, n.number + 1}; }
    Node right(Node n) const { return {at(n).right, n.number + tree_.nodes[at(n).left].leaves()}; }

    // Costs.

    void weigh(Node n) {
        if (leaf(n)) return;
        if (at(n).leaves() > worth_a_task) {
            executor_.both([&] { weigh_task(left(n)); }, [&] { weigh_task(right(n)); });
        } else {
            weigh(left(n));
            weigh(right(n));
        }
        const Subtree on_left = subtree(left(n)), on_right = subtree(right(n));
        Costs least{};  // 0 where every leaf of the subtree may be a child
        least[0] = cost_of_opening(n) + split(on_left, on_right, width_).cost;
        const int most = std::min(width_ - 1, static_cast<int>(std::min(at(n).leaves() - 1, 15u)));
        for (int i = 2; i <= most; ++i) {
            const auto place = static_cast<std::size_t>(i - 1);
            least[place] = std::min(least[place - 1], split(on_left, on_right, i).cost);
        }
        std::copy_n(least.begin(), row_, costs_.begin() + static_cast<std::ptrdiff_t>(n.number * row_));
    }
    void weigh_task(Node n) {
        weigh(n);
        if (at(n).leaves() <= worth_a_task) executor_.advance(at(n).leaves());
    }
    /// In float, since all sums are stored in float. A node costs a little even if it has no area, so that
    /// there are as few nodes without area as possible.
    float cost_of_opening(Node n) const {
        const double share = whole_ > 0 ? static_cast<double>(at(n).box().half_area()) / whole_ : 1;
        return static_cast<float>(share + 1e-12);
    }
    Costs costs(Node n) const {
        Costs least{};
        if (!leaf(n))
            std::copy_n(costs_.begin() + static_cast<std::ptrdiff_t>(n.number * row_), row_, least.begin());
        return least;
    }
    struct Subtree {
        Costs least;
        int leaves;
    };
    Subtree subtree(Node n) const {
        return {costs(n), static_cast<int>(std::min<std::uint32_t>(at(n).leaves(), most_wide))};
    }
    /// The cheapest way to divide `children` between both sides. Each side gets at least one child, and no
    /// more than it has leaves.
    static Split split(const Subtree& left, const Subtree& right, int children) {
        const int given = std::min(children, left.leaves + right.leaves);
        Split best{std::numeric_limits<float>::infinity(), 1};
        for (int i = std::max(1, given - right.leaves); i <= std::min(given - 1, left.leaves); ++i) {
            const float cost = left.least[static_cast<std::size_t>(i - 1)] +
                               right.least[static_cast<std::size_t>(given - i - 1)];
            if (cost < best.cost) best = {cost, i};
        }
        return best;
    }

    // Nodes of the wide tree, and their children.

    void open(Node n, int level) {
        depth_ = std::max(depth_, level + 1);
        if (opened_.size() % worth_a_task == 0) executor_.look();
        // Choose the children. Only the root can be a leaf here: it becomes its own child.
        Children below;
        if (leaf(n))
            below.add(n);
        else
            divide(n, width_, below);
        sort(below);
        // Append the children. Leaves are numbered here, inner nodes when they are opened.
        const std::size_t first = children_.size();
        opened_.push_back(first);
        for (std::size_t i = 0; i < below.count; ++i) {
            const Node child = below.list[i];
            children_.push_back(
                {child.place, leaf(child) ? WideChild::of_leaf(leaves_++) : WideChild::none()});
        }
        // Open the inner children, depth first.
        for (std::size_t i = 0; i < below.count; ++i) {
            if (leaf(below.list[i])) continue;
            children_[first + i].to = {static_cast<std::uint32_t>(opened_.size())};
            open(below.list[i], level + 1);
        }
    }
    /// A child comes late if its box is large and has few leaves: as measured, area over the root of the
    /// number of leaves orders the chance to stop a ray for the work that it takes to find out. Only steps of
    /// a factor of eight count; else the children stay in the order of the binary tree, where neighbours lie
    /// together (docs/design/018-occluders-first.md).
    void sort(Children& below) const {
        std::array<float, most_wide> stops;
        float most = 0;
        for (std::size_t i = 0; i < below.count; ++i) {
            const BuildNode<T, D>& n = at(below.list[i]);
            stops[i] = static_cast<float>(n.box().half_area()) / std::sqrt(static_cast<float>(n.leaves()));
            most = std::max(most, stops[i]);
        }
        std::array<std::pair<int, std::size_t>, most_wide> keys;
        for (std::size_t i = 0; i < below.count; ++i) keys[i] = {-(std::ilogb(most / stops[i]) / 3), i};
        std::sort(keys.begin(), keys.begin() + below.count);
        const Children unsorted = below;
        for (std::size_t i = 0; i < below.count; ++i) below.list[i] = unsorted.list[keys[i].second];
    }
    /// Appends to `found` what a subtree becomes that may be up to `children` children of a node: the fewest
    /// nodes that reach the least cost.
    void gather(Node n, int children, Children& found) const {
        const Costs least = costs(n);
        while (children > 1 && !(least[static_cast<std::size_t>(children - 1)] <
                                 least[static_cast<std::size_t>(children - 2)]))
            --children;
        if (leaf(n) || children == 1)
            found.add(n);
        else
            divide(n, children, found);
    }
    void divide(Node n, int children, Children& found) const {
        const int on_left = split(subtree(left(n)), subtree(right(n)), children).left;
        gather(left(n), on_left, found);
        gather(right(n), children - on_left, found);
    }

    // The tree.

    WideTree<T, D> laid_out() const {
        WideTree<T, D> wide;
        wide.bounds = at(root()).box();
        wide.depth = depth_;
        wide.items = Stored<PrimitiveId>(leaves_ * std::size_t(wide_leaf_size));
        const std::size_t count = opened_.size() - 1;
        wide.nodes = WideNodes<T, D>(width_, count);
        executor_.for_each_piece(count, 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t node = begin; node < end; ++node) lay_out(wide, node);
        });
        // Count what is below the inner children, from the last node up: parents come before their children.
        for (std::size_t node = count; node-- > 0;)
            for (int i = 0; i < wide.nodes.children(node); ++i)
                if (const WideChild child = wide.nodes.child(node, i); !child.leaf())
                    wide.nodes.set_count(node, i, wide.nodes.count(child.word));
        return wide;
    }
    void lay_out(WideTree<T, D>& wide, std::size_t node) const {
        int i = 0;
        for (std::size_t c = opened_[node]; c < opened_[node + 1]; ++c, ++i) {
            const Child& child = children_[c];
            const BuildNode<T, D>& from = tree_.nodes[child.place];
            wide.nodes.set(node, i, from.box(), child.to, from.count);
            if (!child.to.leaf()) continue;
            PrimitiveId* const items = wide.items.data() + std::size_t(wide_leaf_size) * child.to.block();
            std::copy_n(tree_.items.data() + from.first, from.count, items);
            std::fill(items + from.count, items + wide_leaf_size, no_primitive);
        }
        for (; i < width_; ++i) wide.nodes.set(node, i, Box<T, D>(), WideChild::none(), 0);
    }

    const BuildTree<T, D>& tree_;
    int width_;
    std::size_t row_;  // costs per node
    Executor& executor_;
    double whole_;  // the root's area
    BareVector<float> costs_;
    std::vector<Child> children_;      // of all nodes, node by node
    std::vector<std::size_t> opened_;  // where each node's children begin, then the end of the last
    std::uint32_t leaves_ = 0;
    int depth_ = 0;
};

}  // namespace hedgerow
