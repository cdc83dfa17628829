/// Values by node, computed from the leaves up: counts, boxes, moments. A query's `accept` can read them.
#pragma once

#include <vector>

#include <hedgerow/walks/orthants.h>
#include <hedgerow/walks/planes.h>
#include <hedgerow/walks/volumes.h>

namespace hedgerow {

namespace detail {
template <VolumeTree S, class V, class OfLeaf, class Combine>
V fold_from(const S& tree, NodeRef node, NodeId id, std::vector<V>& values, OfLeaf& of_leaf,
            Combine& combine) {
    V value{};
    if (node.leaf()) {
        value = of_leaf(tree.leaf(node));
    } else {
        for (int i = 0; i < S::width; ++i)
            if (const NodeRef child = tree.child(node, i); !child.empty())
                value =
                    combine(value, fold_from(tree, child, S::child_id(node, i), values, of_leaf, combine));
    }
    return values[id] = value;
}
template <OrthantTree S, class V, class OfLeaf, class Combine>
V fold_from(const S& tree, OrthantNode node, NodeId id, std::vector<V>& values, OfLeaf& of_leaf,
            Combine& combine) {
    if (!node.inner()) return values[id] = of_leaf(tree.leaf(node));
    V value{};
    for (unsigned left = node.occupied(); left != 0; left &= left - 1) {
        const auto i = static_cast<unsigned>(std::countr_zero(left));
        value = combine(
            value, fold_from(tree, tree.children(node)[i], S::child_id(node, i), values, of_leaf, combine));
    }
    return values[id] = value;
}
template <PlaneTree S, class V, class OfLeaf, class Combine>
V fold_from(const S& tree, NodeId node, std::vector<V>& values, OfLeaf& of_leaf, Combine& combine) {
    if (tree.is_leaf(node)) return values[node] = of_leaf(tree.leaf(node));
    const V low = fold_from(tree, tree.low_child(node), values, of_leaf, combine);
    const V high = fold_from(tree, tree.high_child(node), values, of_leaf, combine);
    values[node] = combine(low, high);
    if constexpr (HoldsInNodes<S>) values[node] = combine(values[node], of_leaf(tree.own(node)));
    return values[node];
}
}  // namespace detail

/// Computes values[node] for all nodes: of_leaf(leaf) for a leaf, else `combine` over the children (starting
/// from V{}, except in trees of planes). If inner nodes hold primitives, these are combined too. A primitive
/// in several leaves is combined several times. O(n); the recursion is no deeper than the tree.
template <class S, class OfLeaf, class Combine>
auto fold(const S& tree, OfLeaf of_leaf, Combine combine) {
    using V = decltype(of_leaf(Leaf{}));
    std::vector<V> values(tree.node_count());
    if constexpr (VolumeTree<S>) {
        if (!tree.root().empty()) detail::fold_from(tree, tree.root(), 0, values, of_leaf, combine);
    } else if constexpr (OrthantTree<S>) {
        if (!tree.root().empty()) detail::fold_from(tree, tree.root(), NodeId(0), values, of_leaf, combine);
    } else {
        if (!tree.empty()) detail::fold_from(tree, NodeId(0), values, of_leaf, combine);
    }
    return values;
}

}  // namespace hedgerow
