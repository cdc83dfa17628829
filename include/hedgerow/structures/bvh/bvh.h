/// Binary bounding volume hierarchy, as it is walked: a node holds the boxes of its two children.
#pragma once

#include <hedgerow/geometry/box_pair.h>
#include <hedgerow/structures/bvh/builders/binned.h>
#include <hedgerow/structures/bvh/builders/equal_counts.h>
#include <hedgerow/structures/bvh/builders/midpoint.h>
#include <hedgerow/structures/bvh/builders/sweep.h>
#include <hedgerow/structures/walk_volumes.h>

namespace hedgerow {

enum class BvhBuilder { binned, sweep, equal_counts, midpoint };

/// Nodes lie in depth-first order, so that a left child follows its parent. Memory: a node is 64 bytes
/// (float, 3D), 112 (double), and there are (leaves − 1) of them; items are 4 bytes a primitive.
template <std::floating_point T, int D>
class Bvh {
public:
    struct Options : SahOptions {
        BvhBuilder builder = BvhBuilder::binned;
        /// Only to show what they bring: visit the nearer child first; pass over what a shrunken limit has
        /// put out of reach.
        bool ordered = true, culling = true;
    };
    struct alignas(D == 3 && sizeof(T) == 4 ? 64 : 16) Node {  // a cache line, where it fits
        BoxPair<T, D> boxes;
        NodeRef child[2];
    };
    static constexpr bool exclusive = true;
    static constexpr int width = 2;
    static constexpr int max_depth = bvh_max_depth;

    template <PrimitiveSet P>
    static Bvh build(const P& set, const Options& options, Executor& executor) {
        auto references = references_of(set, executor);
        const auto with = [&]<class Splitter>(Splitter splitter) {
            return Bvh(TopDown<T, D, Splitter>(splitter, options.max_leaf_size, executor).build(), options);
        };
        switch (options.builder) {
            case BvhBuilder::sweep:
                return with(SweepSplitter<T, D>(std::move(references), options));
            case BvhBuilder::equal_counts:
                return with(EqualCountsSplitter<T, D>(std::move(references), options));
            case BvhBuilder::midpoint:
                return with(MidpointSplitter<T, D>(std::move(references), options));
            case BvhBuilder::binned:
                break;
        }
        return with(BinnedSplitter<T, D>(std::move(references), options));
    }

    const Box<T, D>& bounds() const { return bounds_; }
    std::span<const PrimitiveId> items() const { return items_; }
    std::size_t bytes() const {
        return nodes_.capacity() * sizeof(Node) + items_.capacity() * sizeof(PrimitiveId);
    }
    std::size_t node_count() const { return 2 * nodes_.size() + (root_.empty() ? 0 : 1); }
    std::size_t leaf_count() const { return root_.empty() ? 0 : nodes_.size() + 1; }
    int depth() const { return depth_; }
    const Options& options() const { return options_; }

    // What the walk and `fold` ask.
    NodeRef root() const { return root_; }
    const BoxPair<T, D>& volumes(NodeRef r) const { return nodes_[r.first].boxes; }
    NodeRef child(NodeRef r, int i) const { return nodes_[r.first].child[i]; }
    Leaf leaf(NodeRef r) const { return {items_.data(), r.first, r.count}; }
    /// The far child is most often opened soon: its cache miss may pass while the near one is walked.
    void prefetch(NodeRef r) const {
        if (!r.leaf()) __builtin_prefetch(nodes_.data() + r.first);
    }
    static NodeId child_id(NodeRef parent, int i) { return 2 * parent.first + 1 + static_cast<NodeId>(i); }

    template <class Primitives, Query Q, class Count>
    void walk(const Primitives& primitives, Q& query, Count& count) const {
        if (query.limit() < 0) return;
        if (options_.ordered && options_.culling) [[likely]]
            walk_volumes(*this, primitives, query, count);
        else if (options_.ordered)
            walk_volumes<Q::order, Culling::off>(*this, primitives, query, count);
        else if (options_.culling)
            walk_volumes<Order::none, Culling::on>(*this, primitives, query, count);
        else
            walk_volumes<Order::none, Culling::off>(*this, primitives, query, count);
    }

    /// Expected cost of a random line that meets the root's box, by the SAH.
    double sah_cost() const {
        const double whole = static_cast<double>(bounds_.half_area());
        if (root_.leaf() || root_.empty()) return options_.intersection_cost * root_.count;
        double cost = options_.traversal_cost;
        for (const Node& n : nodes_)
            for (int i = 0; i < 2; ++i)
                cost += static_cast<double>(n.boxes[i].half_area()) / whole *
                        (n.child[i].leaf() ? options_.intersection_cost * n.child[i].count
                                           : options_.traversal_cost);
        return cost;
    }

    /// What is wrong with the structure; empty if nothing is. O(n).
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        std::vector<std::uint8_t> seen(set.size());
        std::string fault;
        const auto visit = [&](auto& self, NodeRef r, const Box<T, D>& box, int depth) -> void {
            if (!fault.empty()) return;
            if (depth > max_depth) fault = "deeper than its bound";
            if (r.leaf()) {
                for (std::uint32_t i = r.first; i < r.first + r.count; ++i) {
                    if (i >= items_.size() || items_[i] >= seen.size() || seen[items_[i]]++)
                        fault = "an item is missing or held twice";
                    else if (!box.contains(set.bounds(items_[i])))
                        fault = "a primitive reaches out of its leaf's box";
                }
                return;
            }
            if (r.first >= nodes_.size()) return void(fault = "a child that is not there");
            for (int i = 0; i < 2; ++i) {
                if (!box.contains(volumes(r)[i])) fault = "a node reaches out of its parent's box";
                self(self, child(r, i), volumes(r)[i], depth + 1);
            }
        };
        if (!root_.empty()) visit(visit, root_, bounds_, 1);
        for (const auto s : seen)
            if (s != 1 && fault.empty()) fault = "a primitive is in no leaf";
        return fault;
    }

private:
    Bvh(BuildTree<T, D> tree, const Options& options) : options_(options), items_(std::move(tree.items)) {
        if (items_.empty()) return;
        bounds_ = tree.nodes[0].box();
        nodes_.reserve(tree.leaves - 1);
        root_ = pack(tree, 0, 1);
    }
    NodeRef pack(const BuildTree<T, D>& tree, std::uint32_t from, int depth) {
        const BuildNode<T, D>& n = tree.nodes[from];
        depth_ = std::max(depth_, depth);
        if (n.count > 0) return {n.first, n.count};
        const auto at = static_cast<std::uint32_t>(nodes_.size());
        nodes_.emplace_back();
        nodes_[at].boxes.set(0, tree.nodes[n.left].box());
        nodes_[at].boxes.set(1, tree.nodes[n.right].box());
        const NodeRef left = pack(tree, n.left, depth + 1);
        const NodeRef right = pack(tree, n.right, depth + 1);
        nodes_[at].child[0] = left;
        nodes_[at].child[1] = right;
        return {at, 0};
    }

    Options options_;
    Box<T, D> bounds_;
    NodeRef root_;
    std::vector<Node> nodes_;
    std::vector<PrimitiveId> items_;
    int depth_ = 0;
};

}  // namespace hedgerow
