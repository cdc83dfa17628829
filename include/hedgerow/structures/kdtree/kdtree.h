/// kd-tree: space cut by axis-aligned planes, each across one cell.
#pragma once

#include <hedgerow/structures/kdtree/builders/build.h>
#include <hedgerow/walks/mailbox.h>
#include <hedgerow/walks/planes.h>

namespace hedgerow {

/// A primitive is in every leaf that its part reaches, and is found in the cell where it is hit. A mailbox
/// skips most tests that would be repeated in the next cells. Memory: 8 bytes a node (16 for double), 4 an
/// item, and a packed triangle an item. There are at most 2 nodes for each item and each empty leaf. With
/// planes by cost, items are 1.5 to 3 times the primitives on meshes.
template <std::floating_point T, int D>
class KdTree : public PlantedCutTree<T, D, KdNode<T>> {
public:
    using Options = KdOptions;
    static constexpr int max_depth = kd_max_depth;

    template <PrimitiveSet P>
    static KdTree build(const P& set, const Options& options, Executor& executor) {
        KdTree tree;
        tree.mailbox_ = options.mailbox;
        const auto root = [&] {
            KdCell<T, D> cell;
            cell.inside = references_of(set, executor);
            for (const auto& r : cell.inside) cell.box.expand(r.box());
            tree.count_ = cell.inside.size();
            tree.bounds_ = cell.box;
            return cell;
        };
        const auto part = [&](PrimitiveId id, const Box<T, D>& box) { return part_in(set, id, box); };
        tree.tree_ = build_kd_tree<T, D>(root, part, options, executor);
        return tree;
    }

    AxisPlane<T> plane(NodeId n) const { return this->tree_.nodes[n].plane(); }
    template <class Probe>
    auto cut(const Probe& probe, const typename Probe::State& state, NodeId n, T limit) const {
        return probe.cut(state, plane(n), limit);
    }

    template <class Primitives, Query Q, class Count>
    void walk(const Primitives& primitives, Q& query, Count& count) const {
        Mailboxed mailed(primitives, count, this->mailbox_);
        walk_planes(*this, mailed, query, count);
    }

    /// What is wrong with the structure; empty if nothing is.
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        const auto cut = [&](NodeId n, const Box<T, D>& cell, std::string& fault) {
            const auto [axis, position] = plane(n);
            auto low = cell, high = cell;
            low.high[axis] = high.low[axis] = position;
            if (!(cell.low[axis] < position && position < cell.high[axis]))
                fault = "a plane outside of its cell";
            return std::pair(low, high);
        };
        const T margin = 4 * cell_margin(this->bounds_);
        return this->fault(set, this->bounds_, max_depth, cut, [&](PrimitiveId id, const Box<T, D>& cell) {
            return overlap(enlarged(cell, margin), set.bounds(id));
        });
    }
};

}  // namespace hedgerow
