/// The walk through nested volumes: BVHs of any width.
#pragma once

#include <bit>

#include <hedgerow/walks/query.h>
#include <hedgerow/walks/visits.h>

namespace hedgerow {

/// A reference to a child: a leaf (count > 0, `first` is its first item), an inner node (count 0, `first` is
/// its number), or nowhere.
struct NodeRef {
    std::uint32_t first = nowhere, count = 0;

    static constexpr std::uint32_t nowhere = 0xFFFFFFFFu;
    bool empty() const { return count == 0 && first == nowhere; }
    bool leaf() const { return count != 0; }
    Place place() const { return {first, count}; }
};

/// A tree as the walk sees it: packs of `width` volumes, and the child behind each volume.
template <class S>
concept VolumeTree = requires(const S& s, NodeRef ref) {
    { S::width } -> std::convertible_to<int>;
    { s.root() } -> std::same_as<NodeRef>;
    {s.volumes(ref)};
    { s.child(ref, 0) } -> std::same_as<NodeRef>;
    { s.leaf(ref) } -> std::same_as<Leaf>;
    { S::child_id(ref, 0) } -> std::same_as<NodeId>;
};

/// A node of a VolumeTree as queries see it: child i of `parent`, or the root if there is no parent.
template <VolumeTree S, class V>
class VolumeNode {
public:
    VolumeNode(const S& tree, NodeRef parent, int i, const V& volume)
        : tree_(tree), volume_(volume), parent_(parent), i_(i) {}

    NodeId id() const { return parent_.empty() ? 0 : S::child_id(parent_, i_); }
    const V& volume() const { return volume_; }
    std::size_t count() const {
        if constexpr (requires { tree_.count_below(parent_, i_); })
            return tree_.count_below(parent_, i_);
        else
            return detail::items_below(*this);
    }
    template <class F>
    void for_each_leaf(F f) const {
        for_each_leaf(parent_.empty() ? tree_.root() : tree_.child(parent_, i_), f);
    }
    /// Calls f with the leaves below, in the tree's order, until it returns Flow::stop.
    template <class F>
    void for_leaves_in_order(F f) const {
        for_leaves_in_order(parent_.empty() ? tree_.root() : tree_.child(parent_, i_), f);
    }

private:
    template <class F>
    Flow for_leaves_in_order(NodeRef node, F& f) const {
        if (node.empty()) return Flow::go_on;
        if (node.leaf()) return f(tree_.leaf(node));
        for (int i = 0; i < S::width; ++i)
            if (for_leaves_in_order(tree_.child(node, i), f) == Flow::stop) return Flow::stop;
        return Flow::go_on;
    }
    template <class F>
    void for_each_leaf(NodeRef node, F& f) const {
        if (node.empty()) return;
        if (node.leaf()) return f(tree_.leaf(node));
        for (int i = 0; i < S::width; ++i) for_each_leaf(tree_.child(node, i), f);
    }

    const S& tree_;
    const V& volume_;
    NodeRef parent_;
    int i_;
};

/// Culling at the pop: skips children that were pushed before the limit shrank, and begin beyond it now. Off
/// only to measure what culling saves.
enum class Culling : bool { off, on };

/// Opens the children that the probe enters, nearest first if the query wants an order. Pushes all but the
/// first on a stack, each with the place where the probe enters it. At the pop, children that begin beyond a
/// limit that has shrunk are skipped. A leaf is tested at once. The stack holds (width − 1) entries a level;
/// nothing is allocated.
template <Order order, Culling culling, VolumeTree S, class Primitives, Query Q, class Count>
void walk_volumes(const S& tree, const Primitives& primitives, Q& query, Count& count) {
    using T = typename Q::Probe::Scalar;
    struct Entry {
        std::uint32_t first, count;  // bare, unlike NodeRef, so that the stack is not cleared for every ray
        T at;
    };
    const auto kept = [](NodeRef child, T at) { return Entry{child.first, child.count, at}; };
    Entry stack[S::max_depth * (S::width - 1) + 1];
    int top = 0;
    NodeRef node = tree.root();
    if (node.empty()) return;
    if constexpr (SubtreeQuery<Q>)
        if (query.accept(VolumeNode(tree, NodeRef(), 0, tree.bounds())) != Verdict::open) return;
    const auto& probe = query.probe();
    while (true) {
        if (node.leaf()) {
            count.leaf(node.count, node.place());
            if (test_leaf(primitives, probe, tree.leaf(node), query) == Flow::stop) return;
        } else {
            count.node(node.place());
            // Test the volumes of all children. Drop those that the query prunes or takes whole.
            alignas(16) T at[S::width < 4 ? 4 : S::width];
            unsigned entered = probe.enter(tree.volumes(node), query.limit(), at);
            if constexpr (SubtreeQuery<Q>)
                for (unsigned left = entered; left != 0; left &= left - 1) {
                    const int i = std::countr_zero(left);
                    if (query.accept(VolumeNode(tree, node, i, tree.volumes(node)[i])) != Verdict::open)
                        entered &= ~(1u << i);
                }
            if constexpr (S::width == 2) {
                // Open the nearer of two children, and push the other. Branches, not selections: a guessed
                // branch lets the next node's box test begin before this one's is done, where a computed
                // address would have to wait for it.
                const NodeRef left = tree.child(node, 0), right = tree.child(node, 1);
                if (entered == 3) {
                    if (order == Order::nearest && at[1] < at[0]) [[unlikely]] {
                        tree.prefetch(left);
                        stack[top++] = kept(left, at[0]);
                        node = right;
                    } else {
                        tree.prefetch(right);
                        stack[top++] = kept(right, at[1]);
                        node = left;
                    }
                    continue;
                }
                if (entered == 1) {
                    node = left;
                    continue;
                }
                if (entered == 2) {
                    node = right;
                    continue;
                }
            } else {
                // Push the children, sorted by insertion: the nearest on top.
                const int first = top;
                for (; entered != 0; entered &= entered - 1) {
                    const int i = std::countr_zero(entered);
                    int place = top++;
                    if constexpr (order == Order::nearest)
                        for (; place > first && stack[place - 1].at < at[i]; --place)
                            stack[place] = stack[place - 1];
                    stack[place] = kept(tree.child(node, i), at[i]);
                }
            }
        }
        // Pop the next child within the limit.
        do {
            if (top == 0) return;
            --top;
        } while (culling == Culling::on && !(stack[top].at <= query.limit()));
        node = {stack[top].first, stack[top].count};
    }
}
template <VolumeTree S, class Primitives, Query Q, class Count>
void walk_volumes(const S& tree, const Primitives& primitives, Q& query, Count& count) {
    walk_volumes<Q::order, Culling::on>(tree, primitives, query, count);
}

}  // namespace hedgerow
