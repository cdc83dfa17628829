/// Octree (in the plane, quadtree): cells are cut into 2^D equal ones. Primitives can be inserted and erased.
#pragma once

#include <cmath>

#include <hedgerow/structures/item_limit.h>
#include <hedgerow/structures/orthtree/root.h>
#include <hedgerow/structures/orthtree/validate.h>
#include <hedgerow/walks/mailbox.h>

namespace hedgerow {

/// Regular subdivision (Finkel and Bentley 1974; for rays Glassner, Space subdivision for fast ray tracing,
/// 1984). A primitive is in every leaf that it meets (cells.h). Every plane is a number of T (root.h), so
/// builds, insertions and walks compute the same cells. When cells are divided: growth.h.
///
/// `insert` and `erase` cost O(depth) for each cell that the primitive meets, and the work to divide or join
/// the leaves that change. The number of primitives matters only for the depth, and for lists that are copied
/// now and then (amortized). A leaf of more than leaf_size is divided, and leaves that together have no more
/// are joined again, so that walks through a tree that shrank are short. A primitive outside of the root's
/// cell makes the tree grow upward: it gets a root twice as wide, with the old one as an orthant. Where that
/// would be too deep or not exact, or if the root is a leaf, the tree is built anew over its primitives.
/// Where division does not separate primitives (equal boxes; many through one place) leaves are longer, and a
/// change of such a leaf costs O(its items).
///
/// Memory: 8 bytes a node (a group of 2^D children is 64 bytes, 32 in the plane), 4 an item, 1 bit a
/// primitive. After every build, groups and items take at most 128 bytes a primitive (`items_per_primitive`
/// words, see growth.h). On meshes they take about 40, on points 7. Insertions keep to the limit when they
/// divide a leaf, but primitives that are large beside the cells may exceed it, since they must be in each
/// cell that they meet. Arrays that grow have an eighth more memory than they need, and up to half of the
/// items' list and of the groups may be free for reuse. So after changes the tree takes up to 2.25 times as
/// much for each primitive in it.
template <std::floating_point T, int D>
class Orthtree {
public:
    struct Options {
        /// Cells of at most this many primitives are leaves.
        std::uint32_t leaf_size = 8;
        /// How often the first cell may be halved: at most 32 times.
        int max_depth = 20;
        /// A build divides cells while groups and items together stay within so many words of 4 bytes for
        /// each primitive, so it makes fewer items than that. At least 1. Where primitives are as large as
        /// the scene, or many are in one place, leaves are longer. Meshes need 10.
        double items_per_primitive = 32;
        /// Skips most repeated tests of a primitive within a query.
        bool mailbox = true;

        /// Lists the options (option.h).
        template <class Option>
        void list(Option& option) {
            option("leaf_size", leaf_size, 1, 1u << 20, "cells of no more primitives are leaves");
            option("max_depth", max_depth, 0, deepest_option, "how often the first cell may be halved");
            option("items_per_primitive", items_per_primitive, 1, most_items_per_primitive,
                   "with more items a primitive cells are not divided");
            option("mailbox", mailbox, mailbox_meaning);
        }
    };
    static constexpr auto packed_order = PackedOrder::of_ids;
    static constexpr bool exclusive() { return false; }
    static constexpr int dimension = D;
    static constexpr unsigned width = 1u << D;
    /// The most levels, with those that the tree grows upward. The walk's stack has room for them.
    static constexpr int max_depth = 48;
    static constexpr int deepest_option = 32;

    /// Throws UsageError for options out of range, InputError for bad primitives or 2^31 or more of them.
    template <PrimitiveSet P>
    static Orthtree build(const P& set, const Options& options, Executor& executor) {
        if (options.leaf_size < 1) throw UsageError("octree, quadtree: leaf_size=0 is not at least 1");
        if (options.max_depth < 0 || options.max_depth > deepest_option)
            throw UsageError("octree, quadtree: max_depth=" + std::to_string(options.max_depth) +
                             " is not from 0 to " + std::to_string(deepest_option));
        most_items(options.items_per_primitive, set.size());  // throws UsageError for less than 1
        if (set.size() >= OrthantNode::inner_bit)
            throw InputError("an octree or quadtree holds fewer than 2^31 primitives, and was given " +
                             std::to_string(set.size()));
        Orthtree tree;
        tree.options_ = options;
        tree.bounds_ = bounds_of(set, executor);
        tree.held_.assign(set.size(), true);
        tree.count_ = set.size();
        tree.plant(set, executor);
        return tree;
    }

    /// The bounds of all primitives that were in the tree at any time since it was last built. No answer
    /// depends on them.
    const Box<T, D>& bounds() const { return bounds_; }
    /// The blocks of all leaves, and gaps between them, whose words are not ids (OrthantStore::list).
    std::span<const PrimitiveId> items() const { return store_.list(); }
    std::size_t bytes() const { return store_.bytes() + held_.capacity() / 8; }
    /// NodeIds are below this.
    std::size_t node_count() const { return 1 + width * store_.group_count(); }
    std::size_t leaf_count() const {
        return sum_over(root_, [](OrthantNode n) { return std::size_t(!n.inner() && !n.empty()); });
    }
    std::size_t item_count() const {
        return sum_over(root_, [](OrthantNode n) { return n.inner() ? 0 : n.count; });
    }
    int depth() const { return count_ == 0 ? 0 : depth_of(root_); }
    const Options& options() const { return options_; }

    /// The number of primitives in the tree, and whether `id` is one of them.
    std::size_t size() const { return count_; }
    bool holds(PrimitiveId id) const { return id < held_.size() && held_[id]; }
    PrimitiveId id_end() const { return static_cast<PrimitiveId>(held_.size()); }

    /// Inserts primitive `id` of the set. Returns false, and changes nothing, if it is already in the tree.
    /// Throws InputError, and changes nothing, if the set has no such primitive, if it is bad, or if `items`
    /// has 2^31 words or more. `count` receives the nodes opened, and the leaves with the items that were
    /// looked at.
    template <PrimitiveSet P, class Count>
    bool insert(const P& set, PrimitiveId id, Count& count) {
        const Box<T, D> box = reference_of(set, id).box();
        if (holds(id)) return false;
        if (store_.list().size() >= OrthantNode::inner_bit)
            throw InputError("an octree or quadtree of 2^31 items takes up no more: give it larger leaves");
        if (id >= held_.size()) held_.resize(std::size_t(id) + 1);
        held_[id] = true;
        ++count_;
        bounds_.expand(box);
        if (enclose(box))
            add(set, id, {}, cell_, count);
        else
            plant(set, serial_executor());
        store_.tidy(root_);
        return true;
    }
    template <PrimitiveSet P>
    bool insert(const P& set, PrimitiveId id) {
        NoVisits none;
        return insert(set, id, none);
    }
    /// Erases primitive `id`, which must be as it was when it was inserted. Returns false, and changes
    /// nothing, if it is not in the tree. Throws InputError, and changes nothing, if the set has no such
    /// primitive or it is bad.
    template <PrimitiveSet P, class Count>
    bool erase(const P& set, PrimitiveId id, Count& count) {
        if (!holds(id)) return false;
        const Box<T, D> box = reference_of(set, id).box();
        remove({}, cell_, id, enlarged(box, OrthantStanding<P>(set).margin(box)), count);
        held_[id] = false;
        --count_;
        store_.tidy(root_);
        return true;
    }
    template <PrimitiveSet P>
    bool erase(const P& set, PrimitiveId id) {
        NoVisits none;
        return erase(set, id, none);
    }

    // For the walk and `fold`.
    OrthantNode root() const { return root_; }
    const Cube<T, D>& cell() const { return cell_; }
    const OrthantNode* children(OrthantNode n) const { return store_.group(n.first).child.data(); }
    void prefetch(OrthantNode n) const {
        __builtin_prefetch(n.inner() ? static_cast<const void*>(&store_.group(n.first))
                                     : static_cast<const void*>(store_.list().data() + n.first));
    }
    Leaf leaf(OrthantNode n) const { return {store_.list().data(), n.first, n.count}; }
    static NodeId child_id(OrthantNode parent, unsigned i) { return 1 + width * parent.first + i; }

    template <class Primitives, Query Q, class Count>
    void walk(const Primitives& primitives, Q& query, Count& count) const {
        Mailboxed mailed(primitives, count, options_.mailbox);
        walk_orthants(*this, mailed, query, count);
    }

    /// What is wrong with the structure; empty if nothing is.
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        return OrthtreeInspection<Orthtree, P>(*this, set).fault();
    }
    // For OrthtreeInspection.
    const OrthantStore<D>& store() const { return store_; }
    void gather(OrthantNode leaf, std::vector<PrimitiveId>& ids) const {
        const auto items = store_.items(leaf);
        ids.insert(ids.end(), items.begin(), items.end());
    }
    /// Sorts ids and drops repeats. Returns whether more are left than a leaf is to have.
    bool is_more_than_a_leaf(std::vector<PrimitiveId>& ids) const {
        std::sort(ids.begin(), ids.end());
        ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
        return ids.size() > options_.leaf_size;
    }

private:
    /// The limit on groups and items, in words of 4 bytes.
    std::uint64_t room() const { return most_items(options_.items_per_primitive, count_); }
    /// Names a node: which child of which group. The root is in no group.
    struct ChildRef {
        std::uint32_t group = 0xFFFFFFFFu;
        unsigned child = 0;
    };
    OrthantNode& at(ChildRef p) {
        return p.group == ChildRef().group ? root_ : store_.group(p.group).child[p.child];
    }

    /// Builds the tree anew over the primitives in it.
    template <PrimitiveSet P>
    void plant(const P& set, Executor& executor) {
        std::vector<PrimitiveId> ids;
        ids.reserve(count_);
        bounds_ = {};
        for (PrimitiveId id = 0; id < id_end(); ++id)
            if (held_[id]) ids.push_back(id), bounds_.expand(set.bounds(id));
        store_ = {};
        root_ = {};
        if (ids.empty()) return;
        cell_ = root_cube(bounds_);
        limits_ = {options_.leaf_size, std::ldexp(cell_.half, -options_.max_depth)};
        executor.expect(count_);
        root_ = OrthantGrowth<P>(set, limits_, executor)
                    .grow(ids, cell_, room(), store_, static_cast<double>(count_));
        store_.shrink_to_fit();
    }

    /// Grows the tree upward until the box is in the root's cell. Returns false, and changes nothing, if the
    /// tree has to be built anew instead.
    bool enclose(const Box<T, D>& box) {
        if (!root_.inner()) return !root_.empty() && cell_.box().contains(box);
        // Double the root's cell until it contains the box, as long as it is exact and not too deep.
        Cube<T, D> cell = cell_;
        std::vector<unsigned> corners;  // which orthant of the next cell each cell becomes
        while (!cell.box().contains(box)) {
            unsigned i = 0;
            for (int k = 0; k < D; ++k)
                if (box.low[k] < cell.middle[k] - cell.half) i |= 1u << k;
            if (!cell.exact(cell.half)) return false;
            cell = cell.doubled(i);
            corners.push_back(i);
            const T deepest = std::ldexp(limits_.least_half, max_depth - 1);
            if (!cell.exact(cell.half) || cell.half >= deepest) return false;
        }
        // Make a group for each new cell, with the old root as its only occupied child.
        for (const unsigned i : corners) {
            const std::uint32_t group = store_.allocate_group();
            store_.group(group).child[i] = root_;
            root_ = OrthantNode::inner_over(group, 1u << i);
        }
        cell_ = cell;
        return true;
    }

    template <PrimitiveSet P, class Count>
    void add(const P& set, PrimitiveId id, ChildRef place, const Cube<T, D>& cell, Count& count) {
        const OrthantNode n = at(place);
        if (!n.inner()) {
            at(place) = store_.added(n, id);
            count.leaf(1);
            const bool grew = store_.capacity_for(n.count + 1) > store_.capacity_for(n.count);
            if (n.count == options_.leaf_size || (n.count > options_.leaf_size && grew))
                divide(set, place, cell, count);
            return;
        }
        count.node();
        const unsigned orthants = OrthantStanding<P>(set)(id, cell);
        at(place) = OrthantNode::inner_over(n.first, n.occupied() | orthants);
        for (unsigned left = orthants; left != 0; left &= left - 1) {
            const auto i = static_cast<unsigned>(std::countr_zero(left));
            add(set, id, {n.first, i}, cell.orthant(i), count);
        }
    }
    /// Replaces a leaf that has become too long by a subtree, if division separates its primitives. A leaf
    /// that stays whole is tried again whenever its block grows, so that its insertions cost O(1) each,
    /// amortized.
    template <PrimitiveSet P, class Count>
    void divide(const P& set, ChildRef place, const Cube<T, D>& cell, Count& count) {
        const OrthantNode leaf = at(place);
        count.leaf(leaf.count);
        std::vector<PrimitiveId> ids;
        gather(leaf, ids);
        const std::uint64_t own = store_.capacity_for(leaf.count), all = room(), used = store_.words_in_use();
        const OrthantNode grown = OrthantGrowth<P>(set, limits_, serial_executor())
                                      .grow(ids, cell, own + (all > used ? all - used : 0), store_);
        store_.free_leaf(leaf);
        at(place) = grown;
    }

    template <class Count>
    void remove(ChildRef place, const Cube<T, D>& cell, PrimitiveId id, const Box<T, D>& reach,
                Count& count) {
        const OrthantNode n = at(place);
        if (!n.inner()) {
            count.leaf(n.count);
            at(place) = store_.removed(n, id);
            return;
        }
        count.node();
        const unsigned reached = orthants_reached(reach, cell.middle) & n.occupied();
        unsigned occupied = n.occupied();
        for (unsigned left = reached; left != 0; left &= left - 1) {
            const auto i = static_cast<unsigned>(std::countr_zero(left));
            remove({n.first, i}, cell.orthant(i), id, reach, count);
            if (at({n.first, i}).empty()) occupied &= ~(1u << i);
        }
        at(place) = OrthantNode::inner_over(n.first, occupied);
        join(place, count);
    }
    /// Joins the children of a node into one leaf, if they are leaves whose primitives fit in one.
    template <class Count>
    void join(ChildRef place, Count& count) {
        const OrthantNode n = at(place);
        const std::span children(store_.group(n.first).child);
        if (std::any_of(children.begin(), children.end(),
                        [&](OrthantNode c) { return c.inner() || c.count > options_.leaf_size; }))
            return;
        std::vector<PrimitiveId> ids;
        for (const OrthantNode c : children) gather(c, ids);
        count.leaf(ids.size());
        if (is_more_than_a_leaf(ids)) return;
        for (const OrthantNode c : children) store_.free_leaf(c);
        store_.free_group(n.first);
        at(place) = store_.make_leaf(ids);
    }

    template <class F>
    std::size_t sum_over(OrthantNode n, F f) const {
        std::size_t sum = f(n);
        if (n.inner())
            for (unsigned i = 0; i < width; ++i) sum += sum_over(children(n)[i], f);
        return sum;
    }
    int depth_of(OrthantNode n) const {
        int below = 0;
        if (n.inner())
            for (unsigned i = 0; i < width; ++i) below = std::max(below, depth_of(children(n)[i]));
        return 1 + below;
    }

    Options options_;
    OrthtreeLimits<T> limits_;
    Box<T, D> bounds_;
    Cube<T, D> cell_;
    OrthantNode root_;
    OrthantStore<D> store_;
    std::vector<bool> held_;
    std::size_t count_ = 0;
};

}  // namespace hedgerow
