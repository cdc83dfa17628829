/// kd-tree: space cut by axis-aligned planes, each across one cell.
#pragma once

#include <hedgerow/structures/kdtree/builders/build.h>
#include <hedgerow/structures/mailbox.h>
#include <hedgerow/structures/walk_planes.h>

namespace hedgerow {

/// A primitive stands in every leaf that its part reaches, and is found in the cell where it is hit; a
/// mailbox keeps it from being tested again in the next. Memory: 8 bytes a node (16 for double), 4 an item,
/// and a packed triangle an item; with planes by cost there are at most 2·items nodes beside the empty ones,
/// and items are 1.5 to 3 times the primitives on meshes.
template <std::floating_point T, int D>
class KdTree {
public:
    using Options = KdOptions;
    static constexpr auto packed_order = PackedOrder::of_leaves;
    static constexpr bool exclusive() { return false; }
    static constexpr int max_depth = kd_max_depth;

    template <PrimitiveSet P>
    static KdTree build(const P& set, const Options& options, Executor& executor) {
        KdTree tree;
        tree.mailbox_ = options.mailbox;
        KdCell<T, D> root;
        root.inside = references_of(set, executor);
        tree.count_ = root.inside.size();
        if (root.inside.empty()) return tree;
        for (const auto& r : root.inside) root.box.expand(r.box());
        tree.bounds_ = root.box;
        const auto part = [&](PrimitiveId id, const Box<T, D>& box) { return part_in(set, id, box); };
        tree.tree_ = build_kd_tree<T, D>(std::move(root), part, options, executor);
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
    AxisPlane<T> plane(NodeId n) const { return tree_.nodes[n].plane(); }
    template <class Probe>
    auto cut(const Probe& probe, const typename Probe::State& state, NodeId n, T limit) const {
        return probe.cut(state, plane(n), limit);
    }
    NodeId low_child(NodeId n) const { return tree_.nodes[n].link(); }
    NodeId high_child(NodeId n) const { return tree_.nodes[n].link() + 1; }

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
        const auto visit = [&](auto& self, NodeId n, const Box<T, D>& cell, int depth) -> void {
            if (!fault.empty()) return;
            if (n >= tree_.nodes.size() || ++visited > tree_.nodes.size())
                return void(fault = "a child that is not there");
            if (depth > max_depth) return void(fault = "deeper than its bound");
            if (is_leaf(n)) return validate_leaf(set, leaf(n), cell, seen, fault);
            const auto [axis, position] = plane(n);
            auto low = cell, high = cell;
            low.high[axis] = high.low[axis] = position;
            if (!(cell.low[axis] < position && position < cell.high[axis]))
                fault = "a plane outside of its cell";
            self(self, low_child(n), low, depth + 1);
            self(self, high_child(n), high, depth + 1);
        };
        if (!empty()) visit(visit, 0, bounds_, 1);
        for (const auto s : seen)
            if (!s && fault.empty()) fault = "a primitive is in no leaf";
        return fault;
    }

private:
    template <PrimitiveSet P>
    void validate_leaf(const P& set, const Leaf& leaf, const Box<T, D>& cell, std::vector<std::uint8_t>& seen,
                       std::string& fault) const {
        const auto reach = enlarged(cell, 4 * cell_margin(bounds_));
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
            if (i >= tree_.items.size() || tree_.items[i] >= set.size())
                return void(fault = "an item that is no primitive");
            seen[tree_.items[i]] = 1;
            if (!overlap(reach, set.bounds(tree_.items[i])))
                fault = "a primitive in a leaf that it does not meet";
        }
    }

    Box<T, D> bounds_;
    CutTree<KdNode<T>> tree_;
    std::size_t count_ = 0;
    bool mailbox_ = true;
};

}  // namespace hedgerow
