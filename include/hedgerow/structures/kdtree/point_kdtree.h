/// The original kd-tree, over points: each node is a point.
#pragma once

#include <algorithm>
#include <bit>

#include <hedgerow/structures/references.h>
#include <hedgerow/walks/planes.h>

namespace hedgerow {

/// The axes take turns from level to level. A node is the median point by its axis; the points before it are
/// in its low subtree, and the points behind it in its high subtree (Bentley 1975). The tree is as full as a
/// heap and has the layout of a heap: the children of node i are 2i + 1 and 2i + 2, so that no link is stored
/// (Jensen, Realistic image synthesis using photon mapping, 2001). Memory: 8 bytes a point (12 for double).
/// Built in O(n log n). For points only, in 1, 2 or 3 dimensions.
template <std::floating_point T, int D>
class PointKdTree {
public:
    struct Options {
        template <class Option>
        void list(Option&) {}
    };
    static constexpr auto packed_order = PackedOrder::of_leaves;
    static constexpr bool exclusive() { return true; }
    static constexpr int max_depth = 33;

    template <PointSet P>
    static PointKdTree build(const P& set, const Options&, Executor& executor) {
        PointKdTree tree;
        auto references = references_of(set, executor);
        for (const auto& r : references) tree.bounds_.expand(r.box());
        tree.items_.resize(references.size());
        tree.positions_.resize(references.size());
        executor.expect(references.size());
        tree.grow(references, 0, references.size(), 0, executor);
        return tree;
    }

    const Box<T, D>& bounds() const { return bounds_; }
    std::span<const PrimitiveId> items() const { return items_; }
    std::size_t bytes() const {
        return positions_.capacity() * sizeof(T) + items_.capacity() * sizeof(PrimitiveId);
    }
    /// NodeIds are below this: the number of points, and one more for the child that the last inner node may
    /// lack.
    std::size_t node_count() const { return items_.empty() ? 0 : items_.size() + 1; }
    std::size_t leaf_count() const { return (items_.size() + 1) / 2; }
    int depth() const { return static_cast<int>(std::bit_width(items_.size())); }

    // For the walk and `fold`.
    bool empty() const { return items_.empty(); }
    bool is_leaf(NodeId n) const { return low_child(n) >= items_.size(); }
    bool is_empty(NodeId n) const { return n >= items_.size(); }
    Leaf leaf(NodeId n) const { return {items_.data(), n, n < items_.size() ? 1u : 0u}; }
    /// The node's own point.
    Leaf own(NodeId n) const { return leaf(n); }
    /// The number of points in the subtree of n: the nodes of a level are side by side.
    std::size_t count_below(NodeId n) const {
        std::size_t points = 0;
        for (std::size_t first = n, last = n; first < items_.size();
             first = 2 * first + 1, last = 2 * last + 2)
            points += std::min(last + 1, items_.size()) - first;
        return points;
    }
    AxisPlane<T> plane(NodeId n) const { return {axis_of(n), positions_[n]}; }
    static NodeId low_child(NodeId n) { return 2 * n + 1; }
    static NodeId high_child(NodeId n) { return 2 * n + 2; }
    template <class Probe>
    auto cut(const Probe& probe, const typename Probe::State& state, NodeId n, T limit) const {
        return probe.cut(state, plane(n), limit);
    }

    template <class Primitives, Query Q, class Count>
    void walk(const Primitives& primitives, Q& query, Count& count) const {
        walk_planes(*this, primitives, query, count);
    }

    /// What is wrong with the structure; empty if nothing is.
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        if (set.size() != items_.size()) return "not built over these points";
        std::vector<std::uint8_t> seen(set.size());
        std::string fault;
        // Visit each node with the cell that the planes above it leave.
        const auto visit = [&](auto& self, NodeId n, const Box<T, D>& cell) -> void {
            if (n >= items_.size()) return;
            if (items_[n] >= seen.size() || seen[items_[n]]++) return void(fault = "a point is held twice");
            const Box<T, D> point = set.bounds(items_[n]);
            if (!cell.contains(point)) fault = "a point lies on the wrong side of a plane";
            const AxisPlane<T> p = plane(n);
            if (point.low[p.axis] != p.position) fault = "a plane is not that of its point";
            auto low = cell, high = cell;
            low.high[p.axis] = high.low[p.axis] = p.position;
            self(self, low_child(n), low);
            self(self, high_child(n), high);
        };
        visit(visit, 0, bounds_);
        return fault;
    }

private:
    static int axis_of(NodeId n) { return static_cast<int>(std::bit_width(n + 1) - 1) % D; }
    /// The size of the root's low subtree, in a tree of n nodes that is as full as a heap.
    static std::size_t low_size(std::size_t n) {
        if (n == 1) return 0;
        const std::size_t half_level = std::bit_floor(n) / 2;
        return half_level - 1 + std::min(half_level, n - (2 * half_level - 1));
    }
    /// Builds the subtree of node n over references[first, last). Equal positions are ordered by id.
    void grow(ReferenceList<T, D>& references, std::size_t first, std::size_t last, NodeId n,
              Executor& executor) {
        if (first == last) return;
        // Move the median to the middle, and store it as node n.
        const std::size_t middle = first + low_size(last - first);
        const int axis = axis_of(n);
        const auto at = [&](std::size_t i) { return references.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(first), at(middle), at(last), [axis](const auto& a, const auto& b) {
            return a.low[axis] != b.low[axis] ? a.low[axis] < b.low[axis] : a.id() < b.id();
        });
        items_[n] = references[middle].id();
        positions_[n] = references[middle].low[axis];
        // Build both subtrees, in parallel if they are large.
        const auto grow_task = [&](std::size_t from, std::size_t to, NodeId child) {
            grow(references, from, to, child, executor);
            if (to - from <= worth_a_task) executor.advance(to - from);
        };
        if (last - first > worth_a_task) {
            executor.both([&] { grow_task(first, middle, low_child(n)); },
                          [&] { grow_task(middle + 1, last, high_child(n)); });
        } else {
            grow(references, first, middle, low_child(n), executor);
            grow(references, middle + 1, last, high_child(n), executor);
        }
    }

    Box<T, D> bounds_;
    std::vector<T> positions_;  // of each node's plane
    std::vector<PrimitiveId> items_;
};

}  // namespace hedgerow
