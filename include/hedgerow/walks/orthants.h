/// The walk through cells that are halved along every axis at once: octrees, quadtrees.
#pragma once

#include <bit>
#include <memory>

#include <hedgerow/geometry/cube.h>
#include <hedgerow/walks/query.h>
#include <hedgerow/walks/visits.h>

namespace hedgerow {

/// A node. A leaf stores its first item and their number. An inner node stores the number of its group of
/// children, which are side by side, and a bit for each child that holds anything.
struct OrthantNode {
    std::uint32_t first = 0, count = 0;

    static constexpr std::uint32_t inner_bit = 0x80000000u;
    static constexpr OrthantNode inner_over(std::uint32_t group, unsigned occupied) {
        return {group, inner_bit | occupied};
    }
    constexpr bool inner() const { return (count & inner_bit) != 0; }
    constexpr bool empty() const { return count == 0; }
    constexpr Place place() const { return {first, count}; }
    constexpr unsigned occupied() const { return count & ~inner_bit; }
    friend constexpr bool operator==(const OrthantNode&, const OrthantNode&) = default;
};

template <class S>
concept OrthantTree = requires(const S& s, OrthantNode n) {
    { S::dimension } -> std::convertible_to<int>;
    {s.bounds()};
    { s.root() } -> std::same_as<OrthantNode>;
    {s.cell()};
    { s.children(n) } -> std::same_as<const OrthantNode*>;
    { s.leaf(n) } -> std::same_as<Leaf>;
    { S::child_id(n, 0u) } -> std::same_as<NodeId>;
};

/// A node of an OrthantTree as queries see it. Its volume is its cell.
template <OrthantTree S, class Cell>
class OrthantCell {
public:
    OrthantCell(const S& tree, OrthantNode node, NodeId id, const Cell& cell)
        : tree_(tree), cell_(cell), node_(node), id_(id) {}

    NodeId id() const { return id_; }
    auto volume() const { return cell_.box(); }
    std::size_t count() const { return detail::items_below(*this); }
    /// Where the items of a node are a range, all leaves below are one.
    template <class F>
    void for_each_leaf(F f) const {
        if constexpr (requires { tree_.below(node_); })
            f(tree_.below(node_));
        else
            for_each_leaf(node_, f);
    }

private:
    template <class F>
    void for_each_leaf(OrthantNode node, F& f) const {
        if (!node.inner()) return f(tree_.leaf(node));
        for (unsigned left = node.occupied(); left != 0; left &= left - 1)
            for_each_leaf(tree_.children(node)[std::countr_zero(left)], f);
    }

    const S& tree_;
    Cell cell_;
    OrthantNode node_;
    NodeId id_;
};

namespace detail {

/// The bits of the orthants on the high side of an axis.
template <int D>
inline constexpr unsigned high_side[3] = {D == 2 ? 0xAu : 0xAAu, D == 2 ? 0xCu : 0xCCu, 0xF0u};

/// A stack of cells yet to be visited, each with what is left of the probe there.
template <OrthantTree S, Query Q>
class WaitingOrthants {
public:
    static constexpr int D = S::dimension;
    using T = typename Q::Probe::Scalar;
    using State = typename Q::Probe::State;
    struct Entry {
        OrthantNode node;
        State state;
        Cube<T, D> cell;
    };

    WaitingOrthants(const S& tree, Q& query) : tree_(tree), query_(query), probe_(query.probe()) {}

    /// Pushes the children that the probe meets within the limit, the nearest last.
    [[gnu::always_inline]] void open(const Entry& e, const OrthantNode* children) {
        const Opened node{e.node, e.cell, children, e.cell.half * T(0.5), query_.limit()};
        cut<0>(node, e.node.occupied(), e.state, e.cell.middle);
    }
    /// Pops the next cell within the limit. False if there is none.
    bool pop(Entry& e) {
        while (top_ > 0)
            if (--top_; probe_.within(stack_[top_].entry.state, query_.limit())) {
                e = stack_[top_].entry;
                return true;
            }
        return false;
    }

private:
    struct Opened {
        OrthantNode self;
        Cube<T, D> cell;
        const OrthantNode* children;
        T quarter, limit;
    };
    /// A union, so that the stack is not cleared for every query.
    union Slot {
        Slot() {}  // NOLINT(modernize-use-equals-default): a union of what has initializers
        Entry entry;
    };

    /// Cuts the cell by its middle plane across `axis`, and each side that the probe meets by the planes of
    /// the next axes. After the last axis one orthant is left in `among`, and `middle` is its middle.
    template <int axis>
    [[gnu::always_inline]] void cut(const Opened& node, unsigned among, const State& state,
                                    Vec<T, D> middle) {
        if constexpr (axis == D) {
            // Push the orthant, unless the query prunes it or takes it whole.
            const auto i = static_cast<unsigned>(std::countr_zero(among));
            if constexpr (SubtreeQuery<Q>)
                if (query_.accept(OrthantCell(tree_, node.children[i], S::child_id(node.self, i),
                                              Cube<T, D>{middle, node.quarter})) != Verdict::open)
                    return;
            tree_.prefetch(node.children[i]);
            std::construct_at(&stack_[top_++].entry, Entry{node.children[i], state, {middle, node.quarter}});
        } else {
            const auto sides = probe_.cut(state, AxisPlane<T>{axis, node.cell.middle[axis]}, node.limit);
            const unsigned high = among & high_side<D>[axis], low = among & ~high_side<D>[axis];
            const unsigned near = sides.near_is_high ? high : low, far = sides.near_is_high ? low : high;
            const T step = sides.near_is_high ? node.quarter : -node.quarter;
            // The far side first, so that the near side is on top of the stack.
            if (far != 0 && sides.to_far) {
                middle[axis] = node.cell.middle[axis] - step;
                cut<axis + 1>(node, far, sides.far, middle);
            }
            if (near != 0 && sides.to_near) {
                middle[axis] = node.cell.middle[axis] + step;
                cut<axis + 1>(node, near, sides.near, middle);
            }
        }
    }

    const S& tree_;
    Q& query_;
    const typename Q::Probe& probe_;
    int top_ = 0;
    Slot stack_[S::max_depth * ((1 << D) - 1) + 1];
};

}  // namespace detail

/// Visits children in the order in which the probe meets them. A cell is cut by its D middle planes, the near
/// side first; a cut never changes the order of cells that earlier cuts divided. For a ray that is the
/// parametric order of Revelles, Ureña and Lastra (An efficient parametric algorithm for octree traversal,
/// WSCG 2000). Of 2^D children the walk touches only those that the ray crosses, at most D + 1. The paper's
/// case tables become the two sides of a cut, which every probe has. Children that hold nothing are skipped
/// by their bits. Allocates nothing: the stack holds at most 2^D − 1 entries a level.
template <OrthantTree S, class Primitives, Query Q, class Count>
void walk_orthants(const S& tree, Primitives& primitives, Q& query, Count& count) {
    using Waiting = detail::WaitingOrthants<S, Q>;
    typename Waiting::Entry e{tree.root(), query.probe().root(tree.bounds()), tree.cell()};
    if (e.node.empty() || !query.probe().within(e.state, query.limit())) return;
    if constexpr (SubtreeQuery<Q>)
        if (query.accept(OrthantCell(tree, e.node, NodeId(0), e.cell)) != Verdict::open) return;
    Waiting waiting(tree, query);
    do {
        if (e.node.inner()) {
            count.node(e.node.place(), e.state);
            waiting.open(e, tree.children(e.node));
        } else {
            count.leaf(e.node.count, e.node.place(), e.state);
            if (test_leaf(primitives, query.probe(), tree.leaf(e.node), query) == Flow::stop) return;
        }
    } while (waiting.pop(e));
}

}  // namespace hedgerow
