/// A hierarchy of boxes behind virtual calls, so that walks over pairs are compiled once for all structures.
#pragma once

#include <cstring>
#include <memory>

#include <hedgerow/walks/hierarchy.h>

namespace hedgerow {

namespace detail {

/// The word that a hierarchy finds a node by, in place of its own type.
using PlaceWord = std::uint64_t;
template <class Where>
PlaceWord word_of(const Where& where) {
    static_assert(std::is_trivially_copyable_v<Where> && sizeof(Where) <= sizeof(PlaceWord));
    PlaceWord word = 0;
    if constexpr (!std::is_empty_v<Where>) std::memcpy(&word, &where, sizeof where);
    return word;
}
template <class Where>
Where place_of(PlaceWord word) {
    Where where{};
    if constexpr (!std::is_empty_v<Where>) std::memcpy(static_cast<void*>(&where), &word, sizeof where);
    return where;
}

template <std::floating_point T, int D>
class HierarchyBehind {
public:
    using Node = BoxedNode<T, D, PlaceWord>;

    virtual ~HierarchyBehind() = default;
    virtual bool empty() const = 0;
    virtual Node root() const = 0;
    virtual std::size_t node_count() const = 0;
    virtual bool is_leaf(const Node& node) const = 0;
    virtual Leaf leaf(const Node& node) const = 0;
    virtual void for_each_child(const Node& node, FunctionRef<void(const Node&)> f) const = 0;
};

/// A hierarchy of known type as a HierarchyBehind.
template <BoxHierarchy H, std::floating_point T, int D>
class HierarchyOf final : public HierarchyBehind<T, D> {
public:
    using typename HierarchyBehind<T, D>::Node;

    explicit HierarchyOf(H hierarchy) : hierarchy_(std::move(hierarchy)) {}
    bool empty() const override { return hierarchy_.empty(); }
    Node root() const override { return any(hierarchy_.root()); }
    std::size_t node_count() const override { return hierarchy_.node_count(); }
    bool is_leaf(const Node& node) const override { return hierarchy_.is_leaf(own(node)); }
    Leaf leaf(const Node& node) const override { return hierarchy_.leaf(own(node)); }
    void for_each_child(const Node& node, FunctionRef<void(const Node&)> f) const override {
        hierarchy_.for_each_child(own(node), [&](const typename H::Node& child) { f(any(child)); });
    }

private:
    static Node any(const typename H::Node& node) { return {word_of(node.place), node.id, node.box}; }
    static typename H::Node own(const Node& node) {
        return {place_of<decltype(H::Node::place)>(node.place), node.id, node.box};
    }

    H hierarchy_;
};

}  // namespace detail

/// Any hierarchy behind one type.
template <std::floating_point T, int D>
class AnyHierarchy {
public:
    using BoxType = Box<T, D>;
    using Node = typename detail::HierarchyBehind<T, D>::Node;
    static constexpr int width = 16;

    /// An empty one.
    AnyHierarchy() = default;
    explicit AnyHierarchy(std::unique_ptr<const detail::HierarchyBehind<T, D>> behind)
        : behind_(std::move(behind)) {}

    bool empty() const { return !behind_ || behind_->empty(); }
    Node root() const { return behind_->root(); }
    std::size_t node_count() const { return behind_ ? behind_->node_count() : 0; }
    bool is_leaf(const Node& node) const { return behind_->is_leaf(node); }
    Leaf leaf(const Node& node) const { return behind_->leaf(node); }
    template <class F>
    void for_each_child(const Node& node, F f) const {
        behind_->for_each_child(node, f);
    }

private:
    std::unique_ptr<const detail::HierarchyBehind<T, D>> behind_;
};

}  // namespace hedgerow
