/// The binary bounding volume hierarchy that walks read: a node stores the boxes of its two children.
#pragma once

#include <optional>

#include <hedgerow/structures/bvh/builders/build.h>
#include <hedgerow/structures/bvh/editor.h>

namespace hedgerow {

/// Nodes lie in depth-first order, so that a left child follows its parent, until single primitives are
/// inserted or erased (editor.h). Memory: (leaves − 1) nodes of 64 bytes each (float, 3D) or 112 (double,
/// 3D), and 4 bytes an item.
template <std::floating_point T, int D>
class Bvh {
public:
    using Options = BvhOptions;
    using Node = BvhNode<T, D>;
    static constexpr auto packed_order = PackedOrder::of_leaves;
    static constexpr int width = 2;
    static constexpr int max_depth = bvh_max_depth;

    /// A tree without primitives.
    Bvh() = default;
    /// Builds the tree over all primitives of a set. Throws InputError as `references_of` does.
    template <PrimitiveSet P>
    static Bvh build(const P& set, const Options& options, Executor& executor) {
        const auto corners = [&](PrimitiveId id) { return corners_in(set, id); };
        return Bvh(build_tree<T, D>(references_of(set, executor), corners, options, executor), set.size(),
                   options, executor);
    }

    /// Whether each primitive is in one leaf only: always, except after spatial splits.
    bool exclusive() const { return exclusive_; }
    const Box<T, D>& bounds() const { return tree_.bounds; }
    std::span<const PrimitiveId> items() const { return tree_.items; }
    /// Includes what insert and erase need (editor.h): mainly 1 byte a node and 1 bit a primitive.
    std::size_t bytes() const {
        return tree_.nodes.capacity() * sizeof(Node) + tree_.items.capacity() * sizeof(PrimitiveId) +
               (edits_ ? edits_->bytes() : 0);
    }
    /// All NodeIds are less than this number.
    std::size_t node_count() const { return 2 * tree_.nodes.size() + (tree_.root.empty() ? 0 : 1); }
    std::size_t leaf_count() const {
        return tree_.root.empty() ? 0 : tree_.nodes.size() - (edits_ ? edits_->free_nodes.size() : 0) + 1;
    }
    std::size_t item_count() const { return tree_.items.size() - (edits_ ? edits_->free_items.size() : 0); }
    int depth() const {
        if (!edits_) return depth_;
        return tree_.root.empty() ? 0 : tree_.root.leaf() ? 1 : edits_->height[tree_.root.first] + 1;
    }
    const Options& options() const { return options_; }

    // The functions that the walk and `fold` need.
    NodeRef root() const { return tree_.root; }
    const BoxPair<T, D>& volumes(NodeRef r) const { return tree_.nodes[r.first].boxes; }
    NodeRef child(NodeRef r, int i) const { return tree_.nodes[r.first].child[i]; }
    Leaf leaf(NodeRef r) const { return {tree_.items.data(), r.first, r.count}; }
    /// Prefetches the far child, which is most often opened soon: its cache miss may pass while the near
    /// child is walked.
    void prefetch(NodeRef r) const {
        if (!r.leaf()) __builtin_prefetch(tree_.nodes.data() + r.first);
    }
    static NodeId child_id(NodeRef parent, int i) { return 2 * parent.first + 1 + static_cast<NodeId>(i); }

    template <class Primitives, Query Q, class Count>
    void walk(const Primitives& primitives, Q& query, Count& count) const {
        if (options_.ordered && options_.culling) [[likely]]
            walk_volumes(*this, primitives, query, count);
        else if (options_.ordered)
            walk_volumes<Q::order, Culling::off>(*this, primitives, query, count);
        else if (options_.culling)
            walk_volumes<Order::none, Culling::on>(*this, primitives, query, count);
        else
            walk_volumes<Order::none, Culling::off>(*this, primitives, query, count);
    }

    /// The expected cost of a random line that intersects the root's box, by the SAH. No random line
    /// intersects a box without area; every node then counts as intersected.
    double sah_cost() const {
        const double whole = static_cast<double>(tree_.bounds.half_area());
        if (tree_.root.leaf() || tree_.root.empty()) return options_.leaf_cost(tree_.root.count, 1);
        double cost = options_.traversal_cost;
        for (const Node& n : tree_.nodes)
            for (int i = 0; i < 2; ++i) {
                if (n.child[i].empty()) break;  // an unused node
                const double share = whole > 0 ? static_cast<double>(n.boxes[i].half_area()) / whole : 1;
                cost += n.child[i].leaf() ? options_.leaf_cost(n.child[i].count, share)
                                          : options_.traversal_cost * share;
            }
        return cost;
    }

    /// The number of primitives in the tree, and whether one is in it.
    std::size_t size() const { return edits_ ? edits_->count : count_; }
    bool holds(PrimitiveId id) const {
        return edits_ ? id < edits_->held.size() && edits_->held[id] : id < count_;
    }
    /// Inserts primitive `id` of the set. Returns false, and changes nothing, if it is in the tree already.
    /// Throws InputError, and changes nothing, if the set has no such primitive or it is bad. `count` counts
    /// the nodes opened. Cost: O(log n) amortized, and O(n) once for the first change (editor.h).
    template <PrimitiveSet P, class Count>
    bool insert(const P& set, PrimitiveId id, Count& count) {
        const Box<T, D> box = reference_of(set, id).box();
        if (holds(id)) return false;
        editor().insert(id, box, count);
        return true;
    }
    template <PrimitiveSet P>
    bool insert(const P& set, PrimitiveId id) {
        NoVisits none;
        return insert(set, id, none);
    }
    /// Erases primitive `id`, which must be as it was when it was inserted. Returns false, and changes
    /// nothing, if it is not in the tree. Throws InputError as `insert` does.
    template <PrimitiveSet P, class Count>
    bool erase(const P& set, PrimitiveId id, Count& count) {
        if (!holds(id)) return false;
        const Box<T, D> box = reference_of(set, id).box();
        editor().erase(set, id, box, exclusive_, count);
        return true;
    }
    template <PrimitiveSet P>
    bool erase(const P& set, PrimitiveId id) {
        NoVisits none;
        return erase(set, id, none);
    }
    /// The places in `items` that the last insertion or erasure overwrote. Only to be called after one of
    /// them.
    std::span<const std::uint32_t> places_changed() const { return edits_->placed; }

    /// Fits all boxes to primitives that have moved: `references` has the reference of each primitive, by the
    /// ids of the build. The tree's shape stays as it is; a primitive that spatial splits had cut is fitted
    /// whole. O(n), parallel over subtrees, allocates nothing.
    void refit(std::span<const Reference<T, D>> references, Executor& executor) {
        if (built_cost_ < 0) built_cost_ = sah_cost();
        if (!tree_.root.empty())
            tree_.bounds = refitted(tree_.root, tree_.nodes.size(), references, executor).template box<D>();
    }
    /// How much worse the tree has become by motion: its SAH cost as a multiple of the cost before the first
    /// refit. 1 before any refit, and less than 1 where motion happened to suit the tree.
    double drift() const { return built_cost_ > 0 ? sah_cost() / built_cost_ : 1; }

    /// Describes a fault of the structure; empty if there is none. O(n).
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        std::vector<std::uint8_t> seen(set.size());
        std::string fault;
        if ((edits_ ? edits_->held.size() : count_) > set.size()) return "not built over these primitives";
        // Check the subtree of r: its depth, its items, and that each box contains the boxes below it.
        const auto visit = [&](auto& self, NodeRef r, const Box<T, D>& box, int depth) -> void {
            if (!fault.empty()) return;
            if (depth > max_depth) fault = "deeper than its bound";
            if (r.leaf()) {
                for (std::uint32_t i = r.first; i < r.first + r.count; ++i) {
                    if (i >= tree_.items.size() || tree_.items[i] >= seen.size() ||
                        (seen[tree_.items[i]]++ != 0 && exclusive()))
                        fault = "an item is missing or held twice";
                    else if (exclusive() ? !box.contains(set.bounds(tree_.items[i]))
                                         : !overlap(box, set.bounds(tree_.items[i])))
                        fault = "a primitive reaches out of its leaf's box";
                }
                return;
            }
            if (r.first >= tree_.nodes.size()) return void(fault = "a child that is not there");
            for (int i = 0; i < 2; ++i) {
                if (!box.contains(volumes(r)[i])) fault = "a node reaches out of its parent's box";
                self(self, child(r, i), volumes(r)[i], depth + 1);
            }
        };
        if (!tree_.root.empty()) visit(visit, tree_.root, tree_.bounds, 1);
        // Check that the leaves contain every primitive of the tree, and no other.
        for (std::size_t i = 0; i < seen.size() && fault.empty(); ++i) {
            if (holds(static_cast<PrimitiveId>(i)) && seen[i] == 0) fault = "a primitive is in no leaf";
            if (!holds(static_cast<PrimitiveId>(i)) && seen[i] != 0) fault = "an item that is not held";
        }
        return fault;
    }

private:
    Bvh(BuildTree<T, D> tree, std::size_t count, const Options& options, Executor& executor)
        : options_(options), count_(count), exclusive_(tree.items.size() == count) {
        tree_.items = std::move(tree.items);
        if (tree_.items.empty()) return;
        tree_.bounds = tree.nodes[0].box();
        tree_.nodes.resize(tree.leaves - 1);
        depth_ = pack(tree, 0, 0, tree_.root, executor);
    }
    BvhEditor<T, D> editor() {
        const bool first = !edits_;
        if (first) edits_.emplace();
        BvhEditor<T, D> editor(tree_, *edits_);
        if (first) editor.begin(count_);
        return editor;
    }
    /// Packs the subtree of node `from` into the places from `at` on, and sets `ref` to it. Returns its
    /// depth.
    int pack(const BuildTree<T, D>& tree, std::uint32_t from, std::uint32_t at, NodeRef& ref,
             Executor& executor) {
        const BuildNode<T, D>& n = tree.nodes[from];
        ref = {n.count > 0 ? n.first : at, n.count};
        if (n.count > 0) return 1;
        // Store the boxes of both children, then pack the children behind the node.
        Node& node = tree_.nodes[at];
        node.boxes.set(0, tree.nodes[n.left].box());
        node.boxes.set(1, tree.nodes[n.right].box());
        int left = 0, right = 0;
        const auto pack_left = [&] { left = pack(tree, n.left, at + 1, node.child[0], executor); };
        const auto pack_right = [&] {
            right = pack(tree, n.right, at + tree.nodes[n.left].leaves(), node.child[1], executor);
        };
        if (n.leaves() > worth_a_task) {
            executor.both(pack_left, pack_right);
        } else {
            pack_left();
            pack_right();
        }
        return 1 + std::max(left, right);
    }

    /// Fits the boxes of a subtree and returns its box. In depth-first order its nodes lie before `end`, from
    /// which its size is estimated.
    LaneBox<T> refitted(NodeRef ref, std::size_t end, std::span<const Reference<T, D>> references,
                        Executor& executor) {
        // Fit a leaf to its primitives.
        auto box = LaneBox<T>::none();
        if (ref.leaf()) {
            for (std::uint32_t i = ref.first; i < ref.first + ref.count; ++i)
                box.expand(references[tree_.items[i]].lanes());
            return box;
        }
        Node& node = tree_.nodes[ref.first];
        // Fit both children, as two tasks if the subtree is large.
        const std::size_t right_at = node.child[1].leaf() ? end : node.child[1].first;
        LaneBox<T> left, right;
        const auto fit_left = [&] { left = refitted(node.child[0], right_at, references, executor); };
        const auto fit_right = [&] { right = refitted(node.child[1], end, references, executor); };
        if (end > ref.first + worth_a_task) {
            executor.both(fit_left, fit_right);
        } else {
            fit_left();
            fit_right();
        }
        // Store the boxes of the children, and return the box of both.
        node.boxes.set(0, left.template box<D>());
        node.boxes.set(1, right.template box<D>());
        left.expand(right);
        return left;
    }

    Options options_;
    BvhTree<T, D> tree_;
    std::size_t count_ = 0;  // primitives at the build
    bool exclusive_ = true;
    int depth_ = 0;
    std::optional<BvhEdits> edits_;  // empty before the first change
    double built_cost_ = -1;         // the SAH cost before the first refit; unknown until then
};

}  // namespace hedgerow
