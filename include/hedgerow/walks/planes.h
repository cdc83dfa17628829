/// The walk through space cut by planes: kd-trees, BSP trees.
#pragma once

#include <hedgerow/walks/query.h>
#include <hedgerow/walks/visits.h>

namespace hedgerow {

template <class S>
concept PlaneTree = requires(const S& s, NodeId n) {
    {s.bounds()};
    { s.empty() } -> std::same_as<bool>;
    { s.is_leaf(n) } -> std::same_as<bool>;
    { s.is_empty(n) } -> std::same_as<bool>;  // a leaf with nothing in it
    { s.leaf(n) } -> std::same_as<Leaf>;
    {s.plane(n)};  // `cut` cuts the probe by it
    { s.low_child(n) } -> std::same_as<NodeId>;
    { s.high_child(n) } -> std::same_as<NodeId>;
};

/// A tree whose inner nodes hold primitives themselves, too.
template <class S>
concept HoldsInNodes = requires(const S& s, NodeId n) {
    { s.own(n) } -> std::same_as<Leaf>;
};

/// A node of a PlaneTree as queries see it, with the probe's state there.
template <PlaneTree S, class State>
class PlaneNode {
public:
    PlaneNode(const S& tree, NodeId id, const State& state) : tree_(tree), state_(state), id_(id) {}

    NodeId id() const { return id_; }
    const auto& volume() const requires requires(const State& s) { s.cell; }
    { return state_.cell; }
    std::size_t count() const {
        if constexpr (requires { tree_.count_below(id_); })
            return tree_.count_below(id_);
        else
            return detail::items_below(*this);
    }
    template <class F>
    void for_each_leaf(F f) const {
        for_each_leaf(id_, f);
    }

private:
    template <class F>
    void for_each_leaf(NodeId node, F& f) const {
        if (tree_.is_empty(node)) return;
        if (tree_.is_leaf(node)) return f(tree_.leaf(node));
        if constexpr (HoldsInNodes<S>) f(tree_.own(node));
        for_each_leaf(tree_.low_child(node), f);
        for_each_leaf(tree_.high_child(node), f);
    }

    const S& tree_;
    const State& state_;
    NodeId id_;
};

/// Follows the near side of each cut, and pushes the far side on a stack with what is left of the probe
/// there. At the pop the far side is skipped if it begins beyond the limit by then. Allocates nothing: the
/// stack holds one entry a level.
template <PlaneTree S, class Primitives, Query Q, class Count>
void walk_planes(const S& tree, Primitives& primitives, Q& query, Count& count) {
    if (tree.empty()) return;
    const auto& probe = query.probe();
    using State = typename Q::Probe::State;
    struct Entry {
        NodeId node;
        State state;
    };
    const auto within = [&](const State& s) { return probe.within(s, query.limit()); };
    // Whether a child is opened: it is not empty, and the query neither prunes it nor takes it whole.
    const auto opened = [&](NodeId n, [[maybe_unused]] const State& s) {
        if (tree.is_empty(n)) return false;
        if constexpr (SubtreeQuery<Q>) return query.accept(PlaneNode(tree, n, s)) == Verdict::open;
        return true;
    };
    Entry stack[S::max_depth + 1];
    int top = 0;
    NodeId node = 0;
    State state = probe.root(tree.bounds());
    if (!within(state) || !opened(node, state)) return;
    while (true) {
        if (tree.is_leaf(node)) {
            const Leaf leaf = tree.leaf(node);
            count.leaf(leaf.count, Place{node}, state);
            if (test_leaf(primitives, probe, leaf, query) == Flow::stop) return;
        } else {
            count.node(Place{node}, state);
            // Test the primitives of the node itself.
            if constexpr (HoldsInNodes<S>) {
                const Leaf own = tree.own(node);
                count.own(own.ids[own.first]);
                if (test_leaf(primitives, probe, own, query) == Flow::stop) return;
            }
            // Cut the probe. Follow the near side first, and push the far side if both are met.
            const auto cut = tree.cut(probe, state, node, query.limit());
            const NodeId near = cut.near_is_high ? tree.high_child(node) : tree.low_child(node);
            const NodeId far = cut.near_is_high ? tree.low_child(node) : tree.high_child(node);
            const bool far_too = cut.to_far && opened(far, cut.far);
            if (cut.to_near && opened(near, cut.near)) {
                if (far_too) stack[top++] = {far, cut.far};
                node = near, state = cut.near;
                continue;
            }
            if (far_too) {
                node = far, state = cut.far;
                continue;
            }
        }
        // Pop the next cell within the limit.
        do {
            if (top == 0) return;
            --top;
        } while (!within(stack[top].state));
        node = stack[top].node, state = stack[top].state;
    }
}

}  // namespace hedgerow
