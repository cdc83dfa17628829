/// Passes over the nodes of a hierarchy: from the leaves up, and from the root down.
///
/// `fold` computes a value a node from the values of its children alone. These passes know the nodes too, so
/// what they pass on may depend on where both are: moments about centers, expansions.
#pragma once

#include <hedgerow/walks/hierarchy.h>

namespace hedgerow {

namespace detail {
template <BoxHierarchy H, class OfLeaf, class OfChild>
void pass_up(const H& h, const typename H::Node& node, OfLeaf& of_leaf, OfChild& of_child) {
    if (h.is_leaf(node)) return of_leaf(node, h.leaf(node));
    h.for_each_child(node, [&](const typename H::Node& child) {
        pass_up(h, child, of_leaf, of_child);
        of_child(node, child);
    });
}
template <BoxHierarchy H, class OfChild, class OfLeaf>
void pass_down(const H& h, const typename H::Node& node, OfChild& of_child, OfLeaf& of_leaf) {
    if (h.is_leaf(node)) return of_leaf(node, h.leaf(node));
    h.for_each_child(node, [&](const typename H::Node& child) {
        of_child(node, child);
        pass_down(h, child, of_child, of_leaf);
    });
}
}  // namespace detail

/// Calls of_leaf(node, leaf) for each leaf, and of_child(node, child) for each child of a node, once all
/// below the child is done. O(nodes); the recursion is no deeper than the hierarchy.
template <BoxHierarchy H, class OfLeaf, class OfChild>
void upward_pass(const H& hierarchy, OfLeaf of_leaf, OfChild of_child) {
    if (!hierarchy.empty()) detail::pass_up(hierarchy, hierarchy.root(), of_leaf, of_child);
}
/// Calls of_child(node, child) for each child of a node, before anything below the child, and of_leaf(node,
/// leaf) for each leaf. O(nodes); the recursion is no deeper than the hierarchy.
template <BoxHierarchy H, class OfChild, class OfLeaf>
void downward_pass(const H& hierarchy, OfChild of_child, OfLeaf of_leaf) {
    if (!hierarchy.empty()) detail::pass_down(hierarchy, hierarchy.root(), of_child, of_leaf);
}

}  // namespace hedgerow
