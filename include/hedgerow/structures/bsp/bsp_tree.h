/// BSP tree: space cut by arbitrary planes.
#pragma once

#include <hedgerow/structures/bsp/build.h>
#include <hedgerow/structures/mailbox.h>
#include <hedgerow/structures/walk_planes.h>

namespace hedgerow {

/// A primitive stands in every leaf that its part reaches; nothing is cut but the parts by which that is
/// decided (Fuchs, Kedem, Naylor 1980; for rays Ize, Wald, Parker, RT 2008). Planes can follow the geometry
/// where it lies askew; each is dearer to find and to walk than a kd-tree's. Memory: 24 bytes a node (40 for
/// double), 4 an item, and a packed triangle an item. Built in O(n log n) with a large constant: some dozens
/// of candidates a primitive and level.
template <std::floating_point T, int D>
class BspTree {
public:
    using Options = BspOptions;
    static constexpr auto packed_order = PackedOrder::of_leaves;
    static constexpr bool exclusive() { return false; }
    static constexpr int max_depth = bsp_max_depth;

    template <PrimitiveSet P>
    static BspTree build(const P& set, const Options& options, Executor& executor) {
        const auto references = references_of(set, executor);
        BspTree tree;
        tree.mailbox_ = options.mailbox;
        tree.count_ = references.size();
        if (references.empty()) return tree;
        for (const auto& r : references) tree.bounds_.expand(r.box());
        // Parts of parts err by a few roundings a level in double, which for float is nothing.
        tree.margin_ = static_cast<double>(cell_margin(tree.bounds_)) * (std::is_same_v<T, float> ? 1 : 16);
        const auto corners = [&](PrimitiveId id) { return corners_in(set, id); };
        tree.tree_ = build_bsp_tree<T, D>(references, corners, options, tree.margin_, executor);
        return tree;
    }

    const Box<T, D>& bounds() const { return bounds_; }
    std::span<const PrimitiveId> items() const { return tree_.items; }
    std::size_t bytes() const { return tree_.bytes(); }
    std::size_t node_count() const { return tree_.nodes.size(); }
    std::size_t leaf_count() const { return tree_.leaf_count(); }
    int depth() const { return tree_.depth; }

    // What the walk and `fold` ask.
    bool empty() const { return tree_.nodes.empty(); }
    bool is_leaf(NodeId n) const { return tree_.nodes[n].is_leaf(); }
    bool is_empty(NodeId n) const { return tree_.nodes[n].is_empty(); }
    Leaf leaf(NodeId n) const { return {tree_.items.data(), tree_.nodes[n].first(), tree_.nodes[n].link()}; }
    CutPlane<D> plane(NodeId n) const { return tree_.nodes[n].plane().in_double(margin_); }
    NodeId low_child(NodeId n) const { return tree_.nodes[n].link(); }
    NodeId high_child(NodeId n) const { return tree_.nodes[n].link() + 1; }
    /// Most planes lie across an axis, and are as cheap as a kd-tree's.
    template <class Probe>
    auto cut(const Probe& probe, const typename Probe::State& state, NodeId n, T limit) const {
        const BspNode<T, D>& node = tree_.nodes[n];
        if (node.across_axis()) return probe.cut(state, node.axis_plane(), limit);
        return probe.cut(state, node.plane().in_double(margin_), limit);
    }

    template <class Primitives, Query Q, class Count>
    void walk(const Primitives& primitives, Q& query, Count& count) const {
        if (query.limit() < 0) return;
        Mailboxed mailed(primitives, count, mailbox_);
        walk_planes(*this, mailed, query, count);
    }

    /// What is wrong with the structure; empty if nothing is.
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        if (set.size() != count_) return "not built over these primitives";
        std::vector<std::uint8_t> seen(set.size());
        std::string fault;
        std::size_t visited = 0;
        const auto visit = [&](auto& self, NodeId n, int depth) -> void {
            if (n >= tree_.nodes.size() || ++visited > tree_.nodes.size())
                return void(fault = "a child that is not there");
            if (depth > max_depth) return void(fault = "deeper than its bound");
            if (!is_leaf(n)) return self(self, low_child(n), depth + 1), self(self, high_child(n), depth + 1);
            const Leaf l = leaf(n);
            if (std::size_t(l.first) + l.count > tree_.items.size())
                return void(fault = "items that are not there");
            for (std::uint32_t i = l.first; i < l.first + l.count; ++i) {
                if (l.ids[i] >= set.size()) return void(fault = "an item that is no primitive");
                seen[l.ids[i]] = 1;
            }
        };
        if (!empty()) visit(visit, 0, 1);
        for (const auto s : seen)
            if (!s && fault.empty()) fault = "a primitive is in no leaf";
        return fault;
    }

private:
    Box<T, D> bounds_;
    CutTree<BspNode<T, D>> tree_;
    double margin_ = 0;
    std::size_t count_ = 0;
    bool mailbox_ = true;
};

}  // namespace hedgerow
