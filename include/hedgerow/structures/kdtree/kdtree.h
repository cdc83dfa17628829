/// kd-tree, in its plainest form: cells are halved in the middle of their widest axis.
#pragma once

#include <bit>

#include <hedgerow/structures/references.h>
#include <hedgerow/structures/walk_planes.h>

namespace hedgerow {

/// A primitive stands in every leaf whose closed cell its box meets. Cells are never cut tighter than that,
/// so the conservative walk of a probe finds it in the cell where it is hit. A leaf has at most `leaf_size`
/// primitives, unless the depth is used up or a split would leave both sides with nearly all of them.
/// Memory: 16 bytes a node (24 for double), 4 bytes an item.
template <std::floating_point T, int D>
class KdTree {
public:
    struct Options {
        std::uint32_t leaf_size = 4;
        /// 0: 8 + 1.3·log2(n) (Pharr, Jakob, Humphreys, Physically Based Rendering, 4.4).
        int max_depth = 0;
    };
    static constexpr bool exclusive = false;
    static constexpr int max_depth = 64;

    template <PrimitiveSet P>
    static KdTree build(const P& set, const Options& options, Executor& executor) {
        const auto references = references_of(set, executor);
        KdTree tree;
        tree.count_ = references.size();
        if (references.empty()) return tree;
        for (const auto& r : references) tree.bounds_.expand(r.box());
        const int deepest =
            options.max_depth > 0
                ? std::min(options.max_depth, max_depth)
                : std::min(max_depth, 8 + static_cast<int>(
                                              1.3 * static_cast<double>(std::bit_width(references.size()))));
        std::vector<std::uint32_t> all(references.size());
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
        tree.nodes_.emplace_back();
        tree.grow(references, all, tree.bounds_, 0, deepest, 0, std::max(1u, options.leaf_size));
        return tree;
    }

    const Box<T, D>& bounds() const { return bounds_; }
    std::span<const PrimitiveId> items() const { return items_; }
    std::size_t bytes() const {
        return nodes_.capacity() * sizeof(Node) + items_.capacity() * sizeof(PrimitiveId);
    }
    std::size_t node_count() const { return nodes_.size(); }
    std::size_t leaf_count() const { return (nodes_.size() + 1) / 2; }
    int depth() const { return depth_; }

    // What the walk and `fold` ask.
    bool empty() const { return nodes_.empty(); }
    bool is_leaf(NodeId n) const { return nodes_[n].axis < 0; }
    Leaf leaf(NodeId n) const { return {items_.data(), nodes_[n].first, nodes_[n].count}; }
    AxisPlane<T> plane(NodeId n) const { return {nodes_[n].axis, nodes_[n].position}; }
    NodeId low_child(NodeId n) const { return nodes_[n].first; }
    NodeId high_child(NodeId n) const { return nodes_[n].first + 1; }

    template <class Primitives, Query Q, class Count>
    void walk(const Primitives& primitives, Q& query, Count& count) const {
        if (query.limit() < 0) return;
        walk_planes(*this, primitives, query, count);
    }

    /// What is wrong with the structure; empty if nothing is.
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        std::string fault = set.size() == count_ ? "" : "not built over these primitives";
        std::vector<std::uint8_t> seen(set.size());
        const auto visit = [&](auto& self, NodeId n, const Box<T, D>& cell) -> void {
            if (n >= nodes_.size()) return void(fault = "a child that is not there");
            if (is_leaf(n)) {
                const Leaf l = leaf(n);
                for (std::uint32_t i = l.first; i < l.first + l.count; ++i) {
                    if (items_[i] >= set.size()) return void(fault = "an item that is no primitive");
                    seen[items_[i]] = 1;
                    if (!overlap(cell, set.bounds(items_[i])))
                        fault = "a primitive in a leaf that it does not meet";
                }
                return;
            }
            const auto [low, high] = halves(cell, plane(n));
            self(self, low_child(n), low);
            self(self, high_child(n), high);
        };
        if (!empty() && fault.empty()) visit(visit, 0, bounds_);
        for (const auto s : seen)
            if (!s && fault.empty()) fault = "a primitive is in no leaf";
        return fault;
    }

private:
    struct Node {
        T position;
        std::int32_t axis = -1;  // −1: a leaf
        std::uint32_t first = 0, count = 0;
    };
    using References = ReferenceList<T, D>;

    static std::pair<Box<T, D>, Box<T, D>> halves(const Box<T, D>& cell, const AxisPlane<T>& plane) {
        auto low = cell, high = cell;
        low.high[plane.axis] = high.low[plane.axis] = plane.position;
        return {low, high};
    }

    void grow(const References& references, std::vector<std::uint32_t>& inside, const Box<T, D>& cell,
              NodeId at, int deepest, int depth, std::uint32_t leaf_size) {
        depth_ = std::max(depth_, depth + 1);
        const int axis = max_axis(cell.extent());
        const AxisPlane<T> plane{axis, cell.center()[axis]};
        if (inside.size() > leaf_size && depth + 1 < deepest && cell.low[axis] < plane.position &&
            plane.position < cell.high[axis]) {
            std::vector<std::uint32_t> low, high;
            for (const std::uint32_t i : inside) {
                const auto box = references[i].box();
                if (box.low[axis] <= plane.position) low.push_back(i);
                if (box.high[axis] >= plane.position) high.push_back(i);
            }
            if (low.size() + high.size() < 2 * inside.size() - inside.size() / 8) {
                std::vector<std::uint32_t>().swap(inside);
                const auto [low_cell, high_cell] = halves(cell, plane);
                const auto child = static_cast<NodeId>(nodes_.size());
                nodes_.resize(nodes_.size() + 2);
                nodes_[at] = {plane.position, axis, child, 0};
                grow(references, low, low_cell, child, deepest, depth + 1, leaf_size);
                grow(references, high, high_cell, child + 1, deepest, depth + 1, leaf_size);
                return;
            }
        }
        nodes_[at] = {T(0), -1, static_cast<std::uint32_t>(items_.size()),
                      static_cast<std::uint32_t>(inside.size())};
        for (const std::uint32_t i : inside) items_.push_back(references[i].id());
    }

    Box<T, D> bounds_;
    std::vector<Node> nodes_;
    std::vector<PrimitiveId> items_;
    std::size_t count_ = 0;
    int depth_ = 0;
};

}  // namespace hedgerow
