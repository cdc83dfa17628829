/// Hierarchies of boxes, as walks over pairs see them: any structure as nodes that have a box, and children
/// or primitives.
#pragma once

#include <algorithm>

#include <hedgerow/walks/fold.h>
#include <hedgerow/walks/outline.h>

namespace hedgerow {

/// A node with the box around all primitives below it. `place` is whatever the hierarchy finds the node by.
template <std::floating_point T, int D, class Where>
struct BoxedNode {
    Where place;
    NodeId id;
    Box<T, D> box;
};

/// A hierarchy H of boxes. A node is a leaf or has up to `width` children. `root` may only be called if it is
/// not `empty`. Node ids are below `node_count()`; those of trees are the ids of `fold`.
template <class H>
concept BoxHierarchy = requires(const H& h, const typename H::Node& n) {
    { H::width } -> std::convertible_to<int>;
    { h.empty() } -> std::same_as<bool>;
    { h.root() } -> std::same_as<typename H::Node>;
    { h.node_count() } -> std::same_as<std::size_t>;
    { h.is_leaf(n) } -> std::same_as<bool>;
    { h.leaf(n) } -> std::same_as<Leaf>;
    h.for_each_child(n, [](const typename H::Node&) {});
};

/// A tree of nested boxes, each in its parent.
template <class S>
concept BoxTree = VolumeTree<S> && requires(const S& s, NodeRef ref) {
    { s.volumes(ref)[0] } -> std::same_as<std::remove_cvref_t<decltype(s.bounds())>>;
};

namespace detail {
struct NoPlace {};

template <class S>
using BoundsOf = std::remove_cvref_t<decltype(std::declval<const S&>().bounds())>;

/// The box around the primitives of a leaf.
template <class P>
auto box_around(const P& set, const Leaf& leaf) {
    Box<typename P::Scalar, P::dimension> box;
    for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) box.expand(set.bounds(leaf.ids[i]));
    return box;
}

/// What hierarchies of trees without boxes have in common: the tree, and the boxes of its nodes by id, folded
/// from the leaves up. Cells that share a primitive have boxes that overlap more than they do. A node is
/// found by a Where.
template <class S, class Where>
class FoldedHierarchy {
public:
    using BoxType = BoundsOf<S>;
    using Node = BoxedNode<typename BoxType::Scalar, BoxType::dimension, Where>;

    template <class P>
    FoldedHierarchy(const S& tree, const P& set)
        : tree_(tree),
          boxes_(fold(
              tree, [&](const Leaf& leaf) { return box_around(set, leaf); },
              [](const BoxType& a, const BoxType& b) { return merged(a, b); })) {}
    bool empty() const { return tree_.root().empty(); }
    Node root() const { return node(tree_.root(), 0); }
    std::size_t node_count() const { return boxes_.size(); }
    Leaf leaf(const Node& n) const { return tree_.leaf(n.place); }

protected:
    Node node(Where place, NodeId id) const { return {place, id, boxes_[id]}; }

    const S& tree_;
    std::vector<BoxType> boxes_;
};

/// A BVH, whose nodes store their children's boxes.
template <BoxTree S>
class BoxTreeHierarchy {
public:
    using BoxType = BoundsOf<S>;
    using Node = BoxedNode<typename BoxType::Scalar, BoxType::dimension, NodeRef>;
    static constexpr int width = S::width;

    template <class P>
    BoxTreeHierarchy(const S& tree, const P&) : tree_(tree) {}
    bool empty() const { return tree_.root().empty(); }
    Node root() const { return {tree_.root(), 0, tree_.bounds()}; }
    std::size_t node_count() const { return tree_.node_count(); }
    bool is_leaf(const Node& n) const { return n.place.leaf(); }
    Leaf leaf(const Node& n) const { return tree_.leaf(n.place); }
    template <class F>
    void for_each_child(const Node& n, F f) const {
        const auto& boxes = tree_.volumes(n.place);
        int children = width;
        if constexpr (requires { boxes.size(); }) children = boxes.size();
        for (int i = 0; i < children; ++i)
            f(Node{tree_.child(n.place, i), S::child_id(n.place, i), boxes[i]});
    }

private:
    const S& tree_;
};

/// A BVH of other volumes: only the children of a node are read.
template <VolumeTree S>
class VolumeHierarchy : public FoldedHierarchy<S, NodeRef> {
public:
    using typename FoldedHierarchy<S, NodeRef>::Node;
    using FoldedHierarchy<S, NodeRef>::FoldedHierarchy;
    static constexpr int width = S::width;

    bool is_leaf(const Node& n) const { return n.place.leaf(); }
    template <class F>
    void for_each_child(const Node& n, F f) const {
        for (int i = 0; i < width; ++i)
            if (const NodeRef child = this->tree_.child(n.place, i); !child.empty())
                f(this->node(child, S::child_id(n.place, i)));
    }
};

/// An octree or quadtree.
template <OrthantTree S>
class OrthantHierarchy : public FoldedHierarchy<S, OrthantNode> {
public:
    using typename FoldedHierarchy<S, OrthantNode>::Node;
    using FoldedHierarchy<S, OrthantNode>::FoldedHierarchy;
    static constexpr int width = 1 << S::dimension;

    bool is_leaf(const Node& n) const { return !n.place.inner(); }
    template <class F>
    void for_each_child(const Node& n, F f) const {
        for (unsigned left = n.place.occupied(); left != 0; left &= left - 1) {
            const auto i = static_cast<unsigned>(std::countr_zero(left));
            f(this->node(this->tree_.children(n.place)[i], S::child_id(n.place, i)));
        }
    }
};

/// A kd-tree or BSP tree. What an inner node holds itself is a leaf below it, whose id is the node's plus
/// the number of nodes; the place of a node says whether it is such a leaf.
template <PlaneTree S>
class PlaneHierarchy : public FoldedHierarchy<S, bool> {
public:
    using Base = FoldedHierarchy<S, bool>;
    using typename Base::BoxType, typename Base::Node;
    static constexpr int width = HoldsInNodes<S> ? 3 : 2;

    template <class P>
    PlaneHierarchy(const S& tree, const P& set) : Base(tree, set), own_boxes_() {
        if constexpr (HoldsInNodes<S>)
            for (NodeId n = 0; n < tree.node_count(); ++n) own_boxes_.push_back(box_around(set, tree.own(n)));
    }
    bool empty() const { return tree_.empty() || tree_.is_empty(0); }
    Node root() const { return this->node(false, 0); }
    std::size_t node_count() const { return boxes_.size() + own_boxes_.size(); }
    bool is_leaf(const Node& n) const { return n.place || tree_.is_leaf(n.id); }
    Leaf leaf(const Node& n) const {
        if constexpr (HoldsInNodes<S>)
            if (n.place) return tree_.own(n.id - static_cast<NodeId>(boxes_.size()));
        return tree_.leaf(n.id);
    }
    template <class F>
    void for_each_child(const Node& n, F f) const {
        for (const NodeId child : {tree_.low_child(n.id), tree_.high_child(n.id)})
            if (!tree_.is_empty(child)) f(this->node(false, child));
        if constexpr (HoldsInNodes<S>)
            f(Node{true, n.id + static_cast<NodeId>(boxes_.size()), own_boxes_[n.id]});
    }

private:
    using Base::tree_, Base::boxes_;
    std::vector<BoxType> own_boxes_;
};

/// A structure that is no tree: the occupied cells of a grid, or all of brute force, as the leaves of a
/// binary tree over them. A root with all cells below it would leave n² pairs of cells to two grids; halves
/// at the median leave O(log n) for each cell. O(cells · log cells) to build.
template <class S>
class CellHierarchy {
public:
    using BoxType = BoundsOf<S>;
    using Node = BoxedNode<typename BoxType::Scalar, BoxType::dimension, NoPlace>;
    static constexpr int width = 2;

    template <class P>
    CellHierarchy(const S& structure, const P& set) {
        std::vector<Cell> cells;
        visit_outline(structure, {}, [&](const OutlineCell<BoxType::dimension>& c) {
            if (c.items.empty()) return true;
            const Leaf leaf{c.items.data(), 0, static_cast<std::uint32_t>(c.items.size())};
            cells.push_back({box_around(set, leaf), leaf});
            return true;
        });
        if (cells.empty()) return;
        nodes_.reserve(2 * cells.size() - 1);
        grow(cells);
    }
    bool empty() const { return nodes_.empty(); }
    Node root() const { return node(0); }
    std::size_t node_count() const { return nodes_.size(); }
    bool is_leaf(const Node& n) const { return nodes_[n.id].second == 0; }
    Leaf leaf(const Node& n) const { return nodes_[n.id].cell.leaf; }
    template <class F>
    void for_each_child(const Node& n, F f) const {
        f(node(n.id + 1));
        f(node(nodes_[n.id].second));
    }

private:
    struct Cell {
        BoxType box;
        Leaf leaf;
    };
    struct Stored {
        Cell cell;
        NodeId second;  // the first child follows its parent; 0 for leaves
    };

    Node node(NodeId id) const { return {{}, id, nodes_[id].cell.box}; }
    /// Builds the subtree over some cells: cuts them at the median along the longest axis of their box.
    void grow(std::span<Cell> cells) {
        const std::size_t at = nodes_.size();
        nodes_.push_back({cells[0], 0});
        if (cells.size() == 1) return;
        BoxType box;
        for (const Cell& c : cells) box.expand(c.box);
        nodes_[at].cell.box = box;
        const int axis = max_axis(box.extent());
        const std::size_t half = cells.size() / 2;
        std::nth_element(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(half), cells.end(),
                         [axis](const Cell& a, const Cell& b) {
                             return a.box.low[axis] + a.box.high[axis] < b.box.low[axis] + b.box.high[axis];
                         });
        grow(cells.first(half));
        nodes_[at].second = static_cast<NodeId>(nodes_.size());
        grow(cells.subspan(half));
    }

    std::vector<Stored> nodes_;
};
}  // namespace detail

/// The hierarchy of a structure over a set, both of which must outlive it. A BVH of boxes is its own: O(1).
/// Any other structure has its boxes computed here, from the leaves up: O(n), once for as many walks as one
/// likes.
template <class S, class P>
auto hierarchy_of(const S& structure, const P& set) {
    if constexpr (requires { structure.hierarchy(set); })
        return structure.hierarchy(set);
    else if constexpr (BoxTree<S>)
        return detail::BoxTreeHierarchy<S>(structure, set);
    else if constexpr (VolumeTree<S>)
        return detail::VolumeHierarchy<S>(structure, set);
    else if constexpr (OrthantTree<S>)
        return detail::OrthantHierarchy<S>(structure, set);
    else if constexpr (PlaneTree<S>)
        return detail::PlaneHierarchy<S>(structure, set);
    else
        return detail::CellHierarchy<S>(structure, set);
}

}  // namespace hedgerow
