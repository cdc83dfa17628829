/// BSP tree: space cut by arbitrary planes.
#pragma once

#include <hedgerow/structures/bsp/build.h>
#include <hedgerow/walks/mailbox.h>
#include <hedgerow/walks/planes.h>

namespace hedgerow {

/// A primitive is in every leaf that its part reaches. Primitives are stored whole: planes cut only the parts
/// that decide the leaves (Fuchs, Kedem, Naylor 1980; for rays Ize, Wald, Parker, RT 2008). Planes can follow
/// geometry that lies askew to the axes, but each of them costs more to find and to walk than a kd-tree's.
/// Memory: 24 bytes a node (40 for double), 4 an item, and a packed triangle an item. Built in O(n log n),
/// with a constant of about five times a kd-tree's for triangles, and twice for points.
template <std::floating_point T, int D>
class BspTree : public PlantedCutTree<T, D, BspNode<T, D>> {
public:
    using Options = BspOptions;
    static constexpr int max_depth = bsp_max_depth;

    template <PrimitiveSet P>
    static BspTree build(const P& set, const Options& options, Executor& executor) {
        const auto references = references_of(set, executor);
        BspTree tree;
        tree.mailbox_ = options.mailbox;
        tree.count_ = references.size();
        if (references.empty()) return tree;
        for (const auto& r : references) tree.bounds_.expand(r.box());
        // A part is clipped again on each level, and errs by a few roundings of double each time. The margin
        // of float far exceeds them; for double the margin is 16 times as large.
        tree.margin_ = static_cast<double>(cell_margin(tree.bounds_)) * (std::is_same_v<T, float> ? 1 : 16);
        const auto corners = [&](PrimitiveId id) { return corners_in(set, id); };
        tree.tree_ = build_bsp_tree<T, D>(references, corners, options, tree.margin_, executor);
        return tree;
    }

    CutPlane<D> plane(NodeId n) const { return this->tree_.nodes[n].plane().in_double(margin_); }
    /// Most planes lie across an axis, and a cut by one is as cheap as a kd-tree's.
    template <class Probe>
    auto cut(const Probe& probe, const typename Probe::State& state, NodeId n, T limit) const {
        const BspNode<T, D>& node = this->tree_.nodes[n];
        if (node.across_axis()) return probe.cut(state, node.axis_plane(), limit);
        return probe.cut(state, node.plane().in_double(margin_), limit);
    }

    template <class Primitives, Query Q, class Count>
    void walk(const Primitives& primitives, Q& query, Count& count) const {
        Mailboxed mailed(primitives, count, this->mailbox_);
        walk_planes(*this, mailed, query, count);
    }

    /// What is wrong with the structure; empty if nothing is.
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        struct AnyCell {};
        return this->fault(
            set, AnyCell{}, max_depth,
            [](NodeId, AnyCell, const std::string&) { return std::pair(AnyCell{}, AnyCell{}); },
            [](PrimitiveId, AnyCell) { return true; });
    }

private:
    double margin_ = 0;
};

}  // namespace hedgerow
