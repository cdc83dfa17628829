/// Binary bounding volume hierarchy, as it is walked: a node holds the boxes of its two children.
#pragma once

#include <hedgerow/geometry/box_pair.h>
#include <hedgerow/structures/bvh/builders/build.h>
#include <hedgerow/structures/walk_volumes.h>

namespace hedgerow {

/// Nodes lie in depth-first order, so that a left child follows its parent. Memory: a node is 64 bytes
/// (float, 3D), 112 (double), and there are (leaves − 1) of them; items are 4 bytes a primitive.
template <std::floating_point T, int D>
class Bvh {
public:
    using Options = BvhOptions;
    struct alignas(D == 3 && sizeof(T) == 4 ? 64 : 16) Node {  // a cache line, where it fits
        BoxPair<T, D> boxes;
        NodeRef child[2];
    };
    static constexpr auto packed_order = PackedOrder::of_leaves;
    static constexpr int width = 2;
    static constexpr int max_depth = bvh_max_depth;

    template <PrimitiveSet P>
    static Bvh build(const P& set, const Options& options, Executor& executor) {
        return Bvh(build_tree(set, options, executor), set.size(), options, executor);
    }

    /// Whether each primitive stands in one leaf: always but after spatial splits.
    bool exclusive() const { return items_.size() == count_; }
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

    /// Expected cost of a random line that meets the root's box, by the SAH. A box without area meets no such
    /// line; then every node counts as met.
    double sah_cost() const {
        const double whole = static_cast<double>(bounds_.half_area());
        if (root_.leaf() || root_.empty()) return options_.leaf_cost(root_.count, 1);
        double cost = options_.traversal_cost;
        for (const Node& n : nodes_)
            for (int i = 0; i < 2; ++i) {
                const double share = whole > 0 ? static_cast<double>(n.boxes[i].half_area()) / whole : 1;
                cost += n.child[i].leaf() ? options_.leaf_cost(n.child[i].count, share)
                                          : options_.traversal_cost * share;
            }
        return cost;
    }

    /// Fits all boxes to primitives that have moved: `references` are those of the same ids as at the build.
    /// The tree stays as it is. O(n), parallel over subtrees, allocates nothing.
    void refit(std::span<const Reference<T, D>> references, Executor& executor) {
        if (built_cost_ < 0) built_cost_ = sah_cost();
        if (!root_.empty()) bounds_ = refitted(root_, nodes_.size(), references, executor).template box<D>();
    }
    /// How much worse the tree is for where the primitives are now than when it was built: its SAH cost as a
    /// multiple of what it was then. 1 before any refit; less, where motion happened to suit the tree.
    double drift() const { return built_cost_ > 0 ? sah_cost() / built_cost_ : 1; }

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
                    if (i >= items_.size() || items_[i] >= seen.size() ||
                        (seen[items_[i]]++ != 0 && exclusive()))
                        fault = "an item is missing or held twice";
                    else if (exclusive() ? !box.contains(set.bounds(items_[i]))
                                         : !overlap(box, set.bounds(items_[i])))
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
            if (s == 0 && fault.empty()) fault = "a primitive is in no leaf";
        return fault;
    }

private:
    Bvh(BuildTree<T, D> tree, std::size_t count, const Options& options, Executor& executor)
        : options_(options), items_(std::move(tree.items)), count_(count) {
        if (items_.empty()) return;
        bounds_ = tree.nodes[0].box();
        nodes_.resize(tree.leaves - 1);
        depth_ = pack(tree, 0, 0, root_, executor);
    }
    /// The subtree into the places from `at` on; returns its depth.
    int pack(const BuildTree<T, D>& tree, std::uint32_t from, std::uint32_t at, NodeRef& ref,
             Executor& executor) {
        const BuildNode<T, D>& n = tree.nodes[from];
        ref = {n.count > 0 ? n.first : at, n.count};
        if (n.count > 0) return 1;
        Node& node = nodes_[at];
        node.boxes.set(0, tree.nodes[n.left].box());
        node.boxes.set(1, tree.nodes[n.right].box());
        int left = 0, right = 0;
        const auto pack_left = [&] { left = pack(tree, n.left, at + 1, node.child[0], executor); };
        const auto pack_right = [&] {
            right = pack(tree, n.right, at + tree.nodes[n.left].leaves(), node.child[1], executor);
        };
        if (n.leaves() > 4096) {
            executor.both(pack_left, pack_right);
        } else {
            pack_left();
            pack_right();
        }
        return 1 + std::max(left, right);
    }

    /// The box of the subtree whose nodes lie before `end`.
    LaneBox<T> refitted(NodeRef ref, std::size_t end, std::span<const Reference<T, D>> references,
                        Executor& executor) {
        auto box = LaneBox<T>::none();
        if (ref.leaf()) {
            for (std::uint32_t i = ref.first; i < ref.first + ref.count; ++i)
                box.expand(references[items_[i]].lanes());
            return box;
        }
        Node& node = nodes_[ref.first];
        const std::size_t right_at = node.child[1].leaf() ? end : node.child[1].first;
        LaneBox<T> left, right;
        const auto fit_left = [&] { left = refitted(node.child[0], right_at, references, executor); };
        const auto fit_right = [&] { right = refitted(node.child[1], end, references, executor); };
        if (end - ref.first > 4096) {
            executor.both(fit_left, fit_right);
        } else {
            fit_left();
            fit_right();
        }
        node.boxes.set(0, left.template box<D>());
        node.boxes.set(1, right.template box<D>());
        left.expand(right);
        return left;
    }

    Options options_;
    Box<T, D> bounds_;
    NodeRef root_;
    BareVector<Node> nodes_;
    std::vector<PrimitiveId> items_;
    std::size_t count_ = 0;  // of the primitives
    int depth_ = 0;
    double built_cost_ = -1;  // not asked for before the first refit
};

}  // namespace hedgerow
