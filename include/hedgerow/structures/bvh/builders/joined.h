/// The tree that bottom-up builders make by joining clusters two by two.
#pragma once

#include <hedgerow/structures/bvh/builders/collapse.h>
#include <hedgerow/structures/bvh/builders/morton.h>

namespace hedgerow {

/// A subtree that is not joined yet: its box, its node, and a place where a join of it may be stored. The
/// join of a and b is stored in b's place, and the new cluster keeps a's. So each join finds a place,
/// whatever the order of joins and whichever thread makes them.
template <std::floating_point T>
struct Cluster {
    LaneBox<T> box;
    std::uint32_t node, place;
};

/// The distance of two clusters: the half area of the box around both (Walter, Bala, Kulkarni, Pingali, RT
/// 2008).
template <int D, std::floating_point T>
T distance(const LaneBox<T>& a, const LaneBox<T>& b) {
    LaneBox<T> both = a;
    both.expand(b);
    return both.template half_area<D>();
}

/// Nodes 0 to n − 1 are the primitives in Morton order. The next n nodes are places of joins, one of which
/// stays unused.
template <std::floating_point T, int D>
class JoinedTree {
public:
    using Node = std::uint32_t;

    JoinedTree(std::span<const Reference<T, D>> references, Executor& executor)
        : order_(references, executor), joins_(references.size()) {}

    const MortonOrder<T, D>& order() const { return order_; }
    Cluster<T> cluster(std::size_t i) const {
        const auto n = static_cast<Node>(i);
        return {box(n), n, n};
    }
    Cluster<T> join(const Cluster<T>& a, const Cluster<T>& b) {
        joins_[b.place] = {a.node, b.node, size(a.node) + size(b.node)};
        LaneBox<T> box = a.box;
        box.expand(b.box);
        return {box, leaves() + b.place, a.place};
    }
    void set_root(const Cluster<T>& all) { root_ = all.node; }

    Node root() const { return root_; }
    std::uint32_t size(Node n) const { return n < leaves() ? 1 : joins_[n - leaves()].size; }
    std::pair<Node, Node> children(Node n) const {
        return {joins_[n - leaves()].left, joins_[n - leaves()].right};
    }
    PrimitiveId item(Node n) const { return order_.reference(n).id(); }
    LaneBox<T> box(Node n) const { return order_.reference(n).lanes(); }

private:
    struct Join {
        Node left, right;
        std::uint32_t size;
    };
    Node leaves() const { return static_cast<Node>(order_.size()); }

    MortonOrder<T, D> order_;
    BareVector<Join> joins_;
    Node root_ = 0;
};

}  // namespace hedgerow
