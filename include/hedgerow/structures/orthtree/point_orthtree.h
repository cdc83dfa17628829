/// Octree of points (in the plane, quadtree): each point is in one leaf, and each cell is a range of points.
#pragma once

#include <string>

#include <hedgerow/base/option.h>
#include <hedgerow/structures/orthtree/point_growth.h>

namespace hedgerow {

/// Regular subdivision of points along a Morton curve (point_growth.h). Cells are half open: a point on a
/// plane is on its high side alone, so that what is summed over cells counts each point once. The points
/// below any node are a range of `items`, which `below` gives in O(1). Every plane is a number of T (root.h).
///
/// Memory: 4 bytes a point, and 72 (40 in the plane) for each node that is divided: about 13 bytes a point in
/// all for leaves of 8. Built in O(n). For points only. Cells are divided up to 48 times: points nearer to
/// each other than the last cells are wide share a leaf, as coincident points do.
template <std::floating_point T, int D>
class PointOrthtree {
public:
    static constexpr auto packed_order = PackedOrder::of_leaves;
    static constexpr bool exclusive() { return true; }
    static constexpr int dimension = D;
    static constexpr unsigned width = 1u << D;
    static constexpr int max_depth = 48;

    struct Options {
        /// Cells of at most this many points are leaves.
        std::uint32_t leaf_size = 8;
        /// How often the first cell may be halved.
        int max_depth = PointOrthtree::max_depth;

        /// Lists the options (option.h).
        template <class Option>
        void list(Option& option) {
            option("leaf_size", leaf_size, 1, 1u << 20, "cells of no more points are leaves");
            option("max_depth", max_depth, 0, PointOrthtree::max_depth,
                   "how often the first cell may be halved");
        }
    };

    /// Throws UsageError for options out of range, InputError for bad points or 2^31 or more of them.
    template <PointSet P>
    static PointOrthtree build(const P& set, const Options& options, Executor& executor) {
        if (options.leaf_size < 1)
            throw UsageError("point-octree, point-quadtree: leaf_size=0 is not at least 1");
        if (options.max_depth < 0 || options.max_depth > max_depth)
            throw UsageError("point-octree, point-quadtree: max_depth=" + std::to_string(options.max_depth) +
                             " is not from 0 to " + std::to_string(max_depth));
        if (set.size() >= OrthantNode::inner_bit)
            throw InputError("an octree or quadtree holds fewer than 2^31 points, and was given " +
                             std::to_string(set.size()));
        PointOrthtree tree;
        tree.options_ = options;
        tree.bounds_ = bounds_of(set, executor);
        if (set.size() == 0) return tree;
        tree.cell_ = root_cube(tree.bounds_);
        const PointCellLimits limits{options.leaf_size, options.max_depth};
        tree.cells_ = PointGrowth<P>(set, limits, executor).grow(tree.cell_);
        return tree;
    }

    const Box<T, D>& bounds() const { return bounds_; }
    std::span<const PrimitiveId> items() const { return cells_.items; }
    std::size_t bytes() const {
        return cells_.items.capacity() * sizeof(PrimitiveId) +
               cells_.groups.capacity() * sizeof(cells_.groups[0]) +
               cells_.ranges.capacity() * sizeof(cells_.ranges[0]);
    }
    /// NodeIds are below this.
    std::size_t node_count() const { return 1 + width * cells_.groups.size(); }
    std::size_t leaf_count() const {
        if (!root().inner()) return root().empty() ? 0 : 1;
        std::size_t leaves = 0;
        for (const auto& group : cells_.groups)
            for (const OrthantNode n : group.child) leaves += !n.inner() && !n.empty();
        return leaves;
    }
    int depth() const { return cells_.depth; }
    const Options& options() const { return options_; }

    // For the walk and `fold`.
    OrthantNode root() const { return cells_.root; }
    const Cube<T, D>& cell() const { return cell_; }
    const OrthantNode* children(OrthantNode n) const { return cells_.groups[n.first].child.data(); }
    void prefetch(OrthantNode n) const {
        __builtin_prefetch(n.inner() ? static_cast<const void*>(&cells_.groups[n.first])
                                     : static_cast<const void*>(cells_.items.data() + n.first));
    }
    Leaf leaf(OrthantNode n) const { return {cells_.items.data(), n.first, n.count}; }
    /// All points below a node.
    Leaf below(OrthantNode n) const {
        if (!n.inner()) return leaf(n);
        const auto range = cells_.ranges[n.first];
        return {cells_.items.data(), range.first, range.count};
    }
    static NodeId child_id(OrthantNode parent, unsigned i) { return 1 + width * parent.first + i; }

    template <class Primitives, Query Q, class Count>
    void walk(const Primitives& primitives, Q& query, Count& count) const {
        walk_orthants(*this, primitives, query, count);
    }

    /// What is wrong with the structure; empty if nothing is. O(n · depth).
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        if (set.size() != items().size()) return "not built over these points";
        std::vector<std::uint8_t> seen(set.size());
        for (const PrimitiveId i : items())
            if (i >= seen.size() || seen[i]++ != 0) return "a point is held twice";
        std::string fault;
        std::size_t groups = 0;
        // Visit each node with its cell and the range of points that it must have.
        const auto visit = [&](auto& self, OrthantNode n, const Cube<T, D>& cell, const Leaf& all,
                               int levels) -> void {
            if (!fault.empty()) return;
            if (n.inner() && (n.first >= cells_.groups.size() || ++groups > cells_.groups.size()))
                return void(fault = "a child that is not there");
            const Leaf range = below(n);
            if (range.first != all.first || range.count > all.count)
                return void(fault = "a cell's points are no range of those of its parent");
            for (std::uint32_t i = range.first; i < range.first + range.count; ++i)
                if (!holds(cell, set.bounds(range.ids[i]).low)) fault = "a point lies outside of its cell";
            if (!n.inner()) return;
            if (range.count <= options_.leaf_size) fault = "a cell that should be a leaf is divided";
            if (levels >= options_.max_depth) fault = "deeper than its bound";
            if (!cell.divisible()) fault = "a cell that cannot be divided is";
            std::uint32_t first = range.first;
            for (unsigned i = 0; i < width && fault.empty(); ++i) {
                const OrthantNode child = children(n)[i];
                if (child.empty() != ((n.occupied() >> i & 1u) == 0))
                    fault = "a node is wrong about which of its children hold anything";
                if (child.empty()) continue;
                const std::uint32_t left = range.first + range.count - first;
                self(self, child, cell.orthant(i), {range.ids, first, left}, levels + 1);
                first += fault.empty() ? below(child).count : 0;
            }
            if (fault.empty() && first != range.first + range.count)
                fault = "a point of a cell is in none of its children";
        };
        visit(visit, root(), cell_, {cells_.items.data(), 0, static_cast<std::uint32_t>(set.size())}, 0);
        if (fault.empty() && groups != cells_.groups.size()) fault = "a group that nothing leads to";
        return fault;
    }

private:
    /// Whether a point is in the half-open cell.
    static bool holds(const Cube<T, D>& cell, const Vec<T, D>& p) {
        const Box<T, D> box = cell.box();
        for (int k = 0; k < D; ++k)
            if (!(p[k] >= box.low[k] && p[k] < box.high[k])) return false;
        return true;
    }

    Options options_;
    Box<T, D> bounds_;
    Cube<T, D> cell_;
    PointCells<D> cells_;
};

}  // namespace hedgerow
