/// Octree (in the plane, quadtree): cells are cut into 2^D equal ones. Primitives can be inserted and erased.
#pragma once

#include <cmath>

#include <hedgerow/structures/item_limit.h>
#include <hedgerow/structures/mailbox.h>
#include <hedgerow/structures/orthtree/root.h>
#include <hedgerow/structures/orthtree/validate.h>

namespace hedgerow {

/// Regular subdivision (Finkel and Bentley 1974; for rays Glassner, Space subdivision for fast ray tracing,
/// 1984). A primitive stands in every leaf that it meets (cells.h). Every plane is a number of T (root.h), so
/// a cell is the same to a build, an insertion and a walk. When cells are divided: growth.h.
///
/// `insert` and `erase` cost O(depth) a cell that the primitive meets, and what it takes to divide or join
/// the leaves that it enters or leaves; nothing depends on how many primitives there are but the depth, and
/// now and then (amortized) a list that is written anew. A leaf of more than leaf_size is divided, and leaves
/// that together hold no more are joined again, so that walks through a tree that shrank are short. What lies
/// out of the root's cell makes the tree grow upward: a root twice as wide, with the old one as an orthant;
/// where that would be too deep or not exact, the tree is built anew over what it holds. Where dividing does
/// not part primitives (equal boxes; many through one place) leaves are longer, and a change of one costs
/// O(its items).
///
/// Memory: 8 bytes a node (a group of 2^D children is 64 bytes, 32 in the plane), 4 an item, 1 bit a
/// primitive. Groups and items stay within 128 bytes a primitive (`items_per_primitive` words, see growth.h)
/// in every build: the worst case. On meshes it is about 40, on points 7. Insertions keep to it when they
/// divide a leaf, but what is large beside the cells may go beyond it, since it must stand in each. Arrays
/// that grow have an eighth more room than they need, and up to half of the items' list and of the groups may
/// wait to be used again, so after changes it is up to 2.25 times as much a primitive that is held.
template <std::floating_point T, int D>
class Orthtree {
public:
    struct Options {
        /// Cells of no more primitives are leaves.
        std::uint32_t leaf_size = 8;
        /// How often the first cell may be halved.
        int max_depth = 20;
        /// A build divides cells while groups and items together stay within so many words of 4 bytes for
        /// each primitive, so it has fewer items than that. Where primitives are as large as the scene, or
        /// many are in one place, leaves are longer. Meshes need 10.
        double items_per_primitive = 32;
        /// Test a primitive once a query, in however many cells it stands.
        bool mailbox = true;
    };
    static constexpr auto packed_order = PackedOrder::of_ids;
    static constexpr bool exclusive() { return false; }
    static constexpr int dimension = D;
    static constexpr unsigned width = 1u << D;
    /// With what it grows upward; the walk's stack has room for it.
    static constexpr int max_depth = 48;
    static constexpr int deepest_option = 32;

    /// Throws UsageError for options out of range, InputError for bad primitives.
    template <PrimitiveSet P>
    static Orthtree build(const P& set, const Options& options, Executor& executor) {
        if (options.leaf_size < 1) throw UsageError("octree, quadtree: leaf_size=0 is not at least 1");
        if (options.max_depth < 0 || options.max_depth > deepest_option)
            throw UsageError("octree, quadtree: max_depth=" + std::to_string(options.max_depth) +
                             " is not from 0 to " + std::to_string(deepest_option));
        most_items(options.items_per_primitive, set.size());  // refuses what is no limit
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

    /// Of all that was ever held since the tree was last built: no answer depends on it.
    const Box<T, D>& bounds() const { return bounds_; }
    /// The blocks of all leaves; after changes with gaps of 0xFFFFFFFF.
    std::span<const PrimitiveId> items() const { return store_.list(); }
    std::size_t bytes() const { return store_.bytes() + held_.capacity() / 8; }
    /// NodeIds are below it.
    std::size_t node_count() const { return 1 + width * store_.group_count(); }
    std::size_t leaf_count() const {
        return sum_over(root_, [](OrthantNode n) { return std::size_t(!n.inner() && !n.empty()); });
    }
    std::size_t item_count() const {
        return sum_over(root_, [](OrthantNode n) { return n.inner() ? 0 : n.count; });
    }
    int depth() const { return count_ == 0 ? 0 : depth_of(root_); }
    const Options& options() const { return options_; }

    /// How many primitives are held, and whether one is.
    std::size_t size() const { return count_; }
    bool holds(PrimitiveId id) const { return id < held_.size() && held_[id]; }
    PrimitiveId id_end() const { return static_cast<PrimitiveId>(held_.size()); }

    /// Takes up primitive `id` of the set: false, and nothing is changed, if it is held already. Throws
    /// InputError, and changes nothing, if the set has no such primitive or it is bad. `count` is told of the
    /// nodes opened, and of the leaves with the items that were looked at.
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
    /// Lets go of primitive `id`, which must be as it was when it was inserted: false, and nothing is
    /// changed, if it is not held.
    template <PrimitiveSet P, class Count>
    bool erase(const P& set, PrimitiveId id, Count& count) {
        if (!holds(id)) return false;
        const Box<T, D> box = reference_of(set, id).box();
        remove({}, cell_, id, enlarged(box, OrthantStanding<P>::margin(box)), count);
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

    // What the walk and `fold` ask.
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
        if (query.limit() < 0) return;
        Mailboxed mailed(primitives, count, options_.mailbox);
        walk_orthants(*this, mailed, query, count);
    }

    /// What is wrong with the structure; empty if nothing is.
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        return OrthtreeInspection<Orthtree, P>(*this, set).fault();
    }
    // What it asks.
    const OrthantStore<D>& store() const { return store_; }
    void gather(OrthantNode leaf, std::vector<PrimitiveId>& ids) const {
        const auto items = store_.items(leaf);
        ids.insert(ids.end(), items.begin(), items.end());
    }
    /// Brings what leaves hold in order, each once.
    bool is_more_than_a_leaf(std::vector<PrimitiveId>& ids) const {
        std::sort(ids.begin(), ids.end());
        ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
        return ids.size() > options_.leaf_size;
    }

private:
    /// In words, for what is held.
    std::uint64_t room() const { return most_items(options_.items_per_primitive, count_); }
    /// Where a node stands: which child of which group. The root: of none.
    struct Place {
        std::uint32_t group = 0xFFFFFFFFu;
        unsigned child = 0;
    };
    OrthantNode& at(Place p) {
        return p.group == Place().group ? root_ : store_.group(p.group).child[p.child];
    }

    /// Builds anew over what is held.
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

    /// Grows upward until a box is inside; false, and nothing is changed, where that does not do.
    bool enclose(const Box<T, D>& box) {
        if (!root_.inner()) return !root_.empty() && cell_.box().contains(box);
        Cube<T, D> cell = cell_;
        std::vector<unsigned> corners;  // which orthant each becomes of the next
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
        for (const unsigned i : corners) {
            const std::uint32_t group = store_.allocate_group();
            store_.group(group).child[i] = root_;
            root_ = OrthantNode::inner_over(group, 1u << i);
        }
        cell_ = cell;
        return true;
    }

    template <PrimitiveSet P, class Count>
    void add(const P& set, PrimitiveId id, Place place, const Cube<T, D>& cell, Count& count) {
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
    /// A leaf that has become too long becomes a subtree, if that parts it. One that was not parted is tried
    /// again whenever its block grows, so that its insertions cost O(1) each, amortized.
    template <PrimitiveSet P, class Count>
    void divide(const P& set, Place place, const Cube<T, D>& cell, Count& count) {
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
    void remove(Place place, const Cube<T, D>& cell, PrimitiveId id, const Box<T, D>& reach, Count& count) {
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
    /// Leaves that together fit in one become one.
    template <class Count>
    void join(Place place, Count& count) {
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
