/// Wide bounding volume hierarchy: up to 16 children a node, whose boxes are tested at once.
#pragma once

#include <string>

#include <hedgerow/engine/budget.h>
#include <hedgerow/engine/build.h>
#include <hedgerow/engine/point_blocks.h>
#include <hedgerow/engine/triangle_blocks.h>

namespace hedgerow {

namespace detail {
struct IndexParts;  // saves and restores the members (src/io/index_file.cpp)
}

/// A binary BVH, collapsed so that a node has 4, 8 or 16 children (Wald, Benthin and Boulos 2008; Dammertz,
/// Hanika and Keller 2008) and each leaf has a block of eight places (wide_tree.h). It is made for the
/// kernels (kernels.h), which test all boxes of a node, and all triangles of a leaf, at once with vector
/// instructions. The walk here answers all other queries. Rays get the same bits from both.
///
/// Memory: a node takes 32 bytes for each child that it has room for (float, in space; 56 in double), and
/// items take 32 bytes a leaf. In all that is 66 to 95 bytes a leaf whatever the width (140 in double) in
/// trees of some thousand leaves or more.
template <std::floating_point T, int D>
class WideBvh {
    friend struct detail::IndexParts;

public:
    using Options = WideOptions;
    static constexpr int width = most_wide;
    static constexpr int max_depth = bvh_max_depth;
    /// To search an instance costs as much as to test this many triangles, so most instances have a leaf of
    /// their own.
    static constexpr double instance_cost = 16;

    /// An empty tree.
    WideBvh() { options_.width = tree_.nodes.width(); }
    template <PrimitiveSet P>
    static WideBvh build(const P& set, const Options& options, Executor& executor) {
        Options all = resolved(options);
        refuse_beyond_budget<T, D>(set.size(), all);
        if constexpr (Instanced<P>) all.intersection_cost *= instance_cost;
        if constexpr (PointSet<P>) {
            if (all.builder == WideBuilder::medium) {
                PointItems<T, D> points(detail::count_of(set));
                detail::for_each_sound_box(set, executor, [&](std::size_t i, const Box<T, D>& box) {
                    points[i] = {box.low, static_cast<PrimitiveId>(i)};
                });
                return WideBvh(all, set.size(),
                               build_wide_tree_of_points<T, D>(std::move(points), all, executor), -1);
            }
        }
        constexpr bool in_blocks = requires(const WideBvh& bvh) {
            bvh.pack(set, executor);
        };
        return WideBvh(references_of(set, executor), all, in_blocks ? wide_leaf_size : 1, executor);
    }

    /// Each primitive is in exactly one leaf.
    static constexpr bool exclusive() { return true; }
    const Box<T, D>& bounds() const { return tree_.bounds; }
    /// The ids of the leaves in turn, eight places each. Places that a leaf does not fill are
    /// `no_primitive`.
    std::span<const PrimitiveId> items() const { return tree_.items; }
    std::size_t item_count() const { return count_; }
    std::size_t bytes() const { return tree_.nodes.bytes() + tree_.items.bytes(); }
    /// Every NodeId is less than this. Most numbers below it belong to no node: there are `used_node_count`
    /// nodes, leaves counted.
    std::size_t node_count() const { return tree_.empty() ? 0 : most_wide * tree_.nodes.size() + 1; }
    std::size_t used_node_count() const { return tree_.nodes.size() + leaf_count(); }
    std::size_t leaf_count() const { return tree_.leaf_count(); }
    int depth() const { return tree_.depth; }
    /// The options of the build, with the chosen width. Over instances `intersection_cost` is already
    /// multiplied.
    const Options& options() const { return options_; }
    const WideTree<T, D>& tree() const { return tree_; }

    /// Copies the triangles into the blocks of the leaves, for rays.
    TriangleBlocks<T> pack(const TriangleMeshView<T>& mesh, Executor& executor) const requires(D == 3) {
        return pack_blocks(mesh, items(), executor);
    }

    /// Copies the points into the blocks of the leaves, for points.
    PointBlocks<T, D> pack(const PointCloudView<T, D>& cloud, Executor& executor) const {
        return pack_blocks(cloud, items(), executor);
    }

    // For the walk and `fold`.
    NodeRef root() const { return tree_.empty() ? NodeRef() : NodeRef{0, 0}; }
    BoxRows<T, D> volumes(NodeRef r) const { return tree_.nodes.boxes(r.first); }
    NodeRef child(NodeRef r, int i) const {
        if (i >= tree_.nodes.width()) return {};
        const WideChild c = tree_.nodes.child(r.first, i);
        if (c.empty()) return {};
        return c.leaf() ? NodeRef{wide_leaf_size * c.block(), tree_.nodes.count(r.first, i)}
                        : NodeRef{c.word, 0};
    }
    /// The number of primitives below child i of a node, or in the whole tree if there is no node.
    std::size_t count_below(NodeRef parent, int i) const {
        return parent.empty() ? count_ : tree_.nodes.count(parent.first, i);
    }
    Leaf leaf(NodeRef r) const { return {tree_.items.data(), r.first, r.count}; }
    static NodeId child_id(NodeRef parent, int i) {
        return most_wide * parent.first + 1 + static_cast<NodeId>(i);
    }

    template <class Primitives, Query Q, class Count>
    void walk(const Primitives& primitives, Q& query, Count& count) const {
        walk_volumes(*this, primitives, query, count);
    }

    /// Expected cost of a random line that meets the root's box, by the SAH (see Bvh). A node costs
    /// `traversal_cost`, however many children it has.
    double sah_cost() const {
        const double whole = static_cast<double>(tree_.bounds.half_area());
        double cost = tree_.empty() ? 0 : options_.traversal_cost;
        for (std::uint32_t n = 0; n < tree_.nodes.size(); ++n) {
            const auto boxes = tree_.nodes.boxes(n);
            for (int i = 0; i < boxes.size(); ++i) {
                const double share = whole > 0 ? static_cast<double>(boxes[i].half_area()) / whole : 1;
                cost += share * (tree_.nodes.child(n, i).leaf()
                                     ? options_.intersection_cost * tree_.nodes.count(n, i)
                                     : options_.traversal_cost);
            }
        }
        return cost;
    }

    /// Fits all boxes to primitives that have moved. `references` is indexed by the ids of the build. The
    /// tree stays as it is. O(n), leaves in parallel, allocates nothing.
    void refit(std::span<const Reference<T, D>> references, Executor& executor) {
        refit_leaves(executor, [&](WideChild leaf, std::uint32_t count) {
            return leaf_box(leaf.block(), count, references);
        });
    }
    /// The same, of primitives that have been packed into blocks again: leaves need not look for them.
    template <class Blocks>
    requires requires(const Blocks& blocks) {
        { blocks.bounds(0) } -> std::same_as<Box<T, D>>;
    }  //
    void refit(const Blocks& blocks, Executor& executor) {
        refit_leaves(executor, [&](WideChild leaf, std::uint32_t) { return blocks.bounds(leaf.block()); });
    }
    /// The SAH cost now as a multiple of that at the build. 1 before any refit; less than 1 where motion
    /// happened to suit the tree.
    double drift() const { return built_cost_ > 0 ? sah_cost() / built_cost_ : 1; }

    /// What is wrong with the structure; empty if nothing is. O(n).
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        std::vector<std::uint8_t> seen(set.size());
        std::string fault;
        std::size_t visited = 0;
        int deepest = 0;
        if (count_ != set.size()) return "not built over these primitives";
        // Checks one node or leaf, whose box is `box`, then its children.
        const auto visit = [&](auto& self, NodeRef r, const Box<T, D>& box, int depth) -> void {
            if (!fault.empty()) return;
            if (depth > max_depth) return void(fault = "deeper than its bound");
            deepest = std::max(deepest, depth);
            ++visited;
            if (r.leaf()) return void(fault = fault_of_leaf(set, r, box, seen));
            if (r.first >= tree_.nodes.size()) return void(fault = "a child that is not there");
            const auto boxes = volumes(r);
            if (boxes.size() == 0) fault = "a node without children";
            for (int i = 0; i < tree_.nodes.width(); ++i) {
                if (const char* const bad = fault_of_place(r.first, i, boxes)) return void(fault = bad);
                if (i >= boxes.size()) continue;
                if (!box.contains(boxes[i])) fault = "a node reaches out of its parent's box";
                self(self, child(r, i), boxes[i], depth + 1);
                const WideChild below = tree_.nodes.child(r.first, i);
                if (fault.empty() && !below.leaf() &&
                    tree_.nodes.count(r.first, i) != tree_.nodes.count(below.word))
                    fault = "a node's count is not its children's";
            }
        };
        if (!tree_.empty()) visit(visit, root(), tree_.bounds, 1);
        // Check that the visits have seen every primitive, every node and the full depth.
        for (const auto s : seen)
            if (s == 0 && fault.empty()) fault = "a primitive is in no leaf";
        if (fault.empty() && visited != used_node_count()) fault = "a node or leaf that no parent leads to";
        if (fault.empty() && deepest != tree_.depth) fault = "not as deep as it says";
        return fault;
    }

private:
    WideBvh(ReferenceList<T, D> references, const Options& options, std::uint32_t block, Executor& executor)
        : options_(options),
          count_(references.size()),
          tree_(build_wide_tree<T, D>(std::move(references), options, block, executor)) {}
    WideBvh(const Options& options, std::size_t count, WideTree<T, D> tree, double built_cost)
        : options_(options), count_(count), tree_(std::move(tree)), built_cost_(built_cost) {}

    template <class F>
    void for_each_child(std::size_t node, F f) const {
        const int children = tree_.nodes.children(node);
        for (int i = 0; i < children; ++i) f(i, tree_.nodes.child(node, i));
    }
    /// Fits all boxes, where box_of(leaf, count) is the box of a leaf.
    template <class BoxOf>
    void refit_leaves(Executor& executor, BoxOf box_of) {
        if (built_cost_ < 0) built_cost_ = sah_cost();
        if (tree_.empty()) return;
        WideNodes<T, D>& nodes = tree_.nodes;
        executor.for_each_piece(nodes.size(), 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; ++n)
                for_each_child(n, [&](int i, WideChild c) {
                    if (c.leaf()) nodes.set_box(n, i, box_of(c, nodes.count(n, i)));
                });
        });
        for (std::size_t n = nodes.size(); n-- > 0;)  // parents come before their children
            for_each_child(n, [&](int i, WideChild c) {
                if (!c.leaf()) nodes.set_box(n, i, box_around(c.word));
            });
        tree_.bounds = box_around(0);
        tree_.crowded = false;
    }
    Box<T, D> leaf_box(std::uint32_t block, std::uint32_t count,
                       std::span<const Reference<T, D>> references) const {
        auto box = LaneBox<T>::none();
        const PrimitiveId* const ids = tree_.items.data() + std::size_t(wide_leaf_size) * block;
        for (std::uint32_t i = 0; i < count; ++i) box.expand(references[ids[i]].lanes());
        return box.template box<D>();
    }
    Box<T, D> box_around(std::size_t node) const {
        Box<T, D> box;
        const auto boxes = tree_.nodes.boxes(node);
        for (int i = 0; i < boxes.size(); ++i) box.expand(boxes[i]);
        return box;
    }
    /// What is wrong with place i among a node's children: above all, what would lead a walk or a kernel out
    /// of the tree. Null if nothing is.
    const char* fault_of_place(std::uint32_t node, int i, const BoxRows<T, D>& boxes) const {
        const WideChild c = tree_.nodes.child(node, i);
        if (i >= boxes.size()) return boxes[i] == Box<T, D>() ? nullptr : "a box around nothing";
        if (c.empty()) return "an empty place before a child";
        if (!c.leaf()) return c.word > node ? nullptr : "a child before its parent";
        if (c.block() >= leaf_count()) return "a leaf that is not there";
        return tree_.nodes.count(node, i) > 0 ? nullptr : "a leaf without primitives";
    }
    template <class P>
    std::string fault_of_leaf(const P& set, NodeRef r, const Box<T, D>& box,
                              std::vector<std::uint8_t>& seen) const {
        if (r.count > options_.max_leaf_size) return "a leaf of too many primitives";
        for (std::uint32_t i = 0; i < wide_leaf_size; ++i) {
            const PrimitiveId id = tree_.items[r.first + i];
            if (i >= r.count) {
                if (id != no_primitive) return "an item beyond the end of its leaf";
                continue;
            }
            if (id >= seen.size() || seen[id]++ != 0) return "an item is missing or held twice";
            if (!box.contains(set.bounds(id))) return "a primitive reaches out of its leaf's box";
        }
        return "";
    }

    Options options_;
    std::size_t count_ = 0;
    WideTree<T, D> tree_;
    double built_cost_ = -1;  // -1 until the first refit computes it
};

}  // namespace hedgerow
