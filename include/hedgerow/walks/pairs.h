/// The walk over pairs of nodes: of two hierarchies, or of one with itself.
///
/// A pair of nodes stands for all pairs of their primitives. The query prunes a pair, accepts it as a whole,
/// or has it opened, until two leaves are left (the dual-tree walk: Dehnen 2002 for forces, Gray and Moore
/// 2001 for statistics).
#pragma once

#include <memory>
#include <vector>

#include <hedgerow/walks/hierarchy.h>

namespace hedgerow {

/// A leaf and the box around what it holds.
template <std::floating_point T, int D>
struct BoxedLeaf {
    Leaf items;
    Box<T, D> box;
};

/// What counts as an answer to a question of pairs.
/// - `bound(a, b)` is a number that no pair of primitives in two boxes falls below: a squared distance, or
///   infinity if no pair counts.
/// - `limit` is the largest bound that can still change the answer. It may only shrink.
/// - `done`, if there is one, says that nothing can change the answer, so that no walk begins.
/// - `offer(a, b)` is called with pairs of leaves, and in a walk of a hierarchy with itself `offer(leaf)` for
///   the pairs inside of a leaf. It may stop the walk.
/// - `order` is a wish: nearest first by `bound`.
template <class Q>
concept PairQuery = requires(Q& q, const Q& asked, const typename Q::BoxType& box,
                             const BoxedLeaf<typename Q::BoxType::Scalar, Q::BoxType::dimension>& leaf) {
    { Q::order } -> std::convertible_to<Order>;
    { asked.bound(box, box) } -> std::convertible_to<typename Q::BoxType::Scalar>;
    { asked.limit() } -> std::convertible_to<typename Q::BoxType::Scalar>;
    { q.offer(leaf, leaf) } -> std::same_as<Flow>;
};
/// A query of the pairs within one hierarchy.
template <class Q>
concept SelfPairQuery = PairQuery<Q> &&
    requires(Q& q, const BoxedLeaf<typename Q::BoxType::Scalar, Q::BoxType::dimension>& leaf) {
    { q.offer(leaf) } -> std::same_as<Flow>;
};
/// A query that can take two nodes at once. In a walk of a hierarchy with itself both may be one node.
template <class Q>
concept NodePairQuery = PairQuery<Q> && requires(Q& q, NodeId node) {
    { q.accept(node, node) } -> std::same_as<Verdict>;
};

/// Two nodes of hierarchies A and B whose pairs are yet to be walked. If they are `one`, the hierarchies are
/// too, and so are the nodes.
template <BoxHierarchy A, BoxHierarchy B>
struct NodePair {
    typename A::Node a;
    typename B::Node b;
    bool one = false;
};

namespace detail {

/// The walk below a pair of nodes, by recursion: no deeper than both trees together. Allocates nothing,
/// unless it is to cut the walk off after some levels: then it appends the pairs below to `cut`.
template <BoxHierarchy A, BoxHierarchy B, PairQuery Q, class Count>
class PairWalk {
public:
    using T = typename Q::BoxType::Scalar;
    using Pair = NodePair<A, B>;

    PairWalk(const A& a, const B& b, Q& query, Count& count, std::vector<Pair>* cut = nullptr)
        : a_(a), b_(b), query_(query), count_(count), cut_(cut) {}

    /// Walks all pairs below two nodes, which need not be judged before.
    Flow begin(const Pair& pair, int levels) {
        if (!(query_.bound(pair.a.box, pair.b.box) <= query_.limit()) || !opened(pair.a.id, pair.b.id))
            return Flow::go_on;
        if constexpr (std::same_as<A, B> && SelfPairQuery<Q>)
            if (pair.one) return visit_one(pair.a, levels);
        return visit(pair.a, pair.b, levels);
    }

private:
    /// Whether the query neither prunes two nodes nor takes them whole.
    bool opened(NodeId a, NodeId b) {
        if constexpr (NodePairQuery<Q>) return query_.accept(a, b) == Verdict::open;
        return true;
    }
    bool cut_off(const typename A::Node& a, const typename B::Node& b, bool one, int levels) {
        if (cut_ == nullptr || levels > 0) return false;
        cut_->push_back({a, b, one});
        return true;
    }

    /// Opens the larger node of a pair, or tests a pair of leaves.
    Flow visit(const typename A::Node& a, const typename B::Node& b, int levels) {
        if (cut_off(a, b, false, levels)) return Flow::go_on;
        const bool leaf_a = a_.is_leaf(a), leaf_b = b_.is_leaf(b);
        if (leaf_a && leaf_b) {
            const Leaf of_a = a_.leaf(a), of_b = b_.leaf(b);
            count_.leaf(std::uint64_t(of_a.count) * of_b.count);
            return query_.offer(BoxedLeaf<T, Q::BoxType::dimension>{of_a, a.box},
                                BoxedLeaf<T, Q::BoxType::dimension>{of_b, b.box});
        }
        count_.node();
        const bool open_a = leaf_b || (!leaf_a && !(size(a.box) < size(b.box)));
        if (open_a)
            return open(
                a_, a, [&](const auto& child) { return query_.bound(child.box, b.box); },
                [&](const auto& child) { return opened(child.id, b.id); },
                [&](const auto& child) { return visit(child, b, levels - 1); });
        return open(
            b_, b, [&](const auto& child) { return query_.bound(a.box, child.box); },
            [&](const auto& child) { return opened(a.id, child.id); },
            [&](const auto& child) { return visit(a, child, levels - 1); });
    }
    static T size(const typename Q::BoxType& box) { return max_component(box.extent()); }

    /// Visits the children of one node of a pair that are within the limit, nearest first if the query wants
    /// an order.
    template <class H, class Bound, class Opened, class Visit>
    Flow open(const H& tree, const typename H::Node& node, Bound bound, Opened opened_too,
              Visit visit_child) {
        struct Entry {
            typename H::Node node;
            T at;
        };
        union Entries {
            Entries() {}  // NOLINT(modernize-use-equals-default): not cleared
            Entry entry[H::width];
        } near;
        int count = 0;
        tree.for_each_child(node, [&](const typename H::Node& child) {
            const T at = bound(child);
            if (!(at <= query_.limit()) || !opened_too(child)) return;
            int place = count++;
            if constexpr (Q::order == Order::nearest)
                for (; place > 0 && at < near.entry[place - 1].at; --place)
                    std::construct_at(&near.entry[place], near.entry[place - 1]);
            std::construct_at(&near.entry[place], Entry{child, at});
        });
        for (int i = 0; i < count; ++i)
            if (near.entry[i].at <= query_.limit() && visit_child(near.entry[i].node) == Flow::stop)
                return Flow::stop;
        return Flow::go_on;
    }

    /// Visits the pairs inside of a node: each child with itself, and with the children after it.
    Flow visit_one(const typename A::Node& node, int levels) requires std::same_as<A, B> {
        if (cut_off(node, node, true, levels)) return Flow::go_on;
        if (a_.is_leaf(node)) {
            const Leaf leaf = a_.leaf(node);
            count_.leaf(std::uint64_t(leaf.count) * (leaf.count - 1) / 2);
            return query_.offer(BoxedLeaf<T, Q::BoxType::dimension>{leaf, node.box});
        }
        count_.node();
        union Nodes {
            Nodes() {}  // NOLINT(modernize-use-equals-default): not cleared
            typename A::Node node[A::width];
        } child;
        int count = 0;
        a_.for_each_child(node,
                          [&](const typename A::Node& c) { std::construct_at(&child.node[count++], c); });
        for (int i = 0; i < count; ++i) {
            const auto& c = child.node[i];
            if (opened(c.id, c.id) && visit_one(c, levels - 1) == Flow::stop) return Flow::stop;
            for (int j = i + 1; j < count; ++j) {
                const auto& d = child.node[j];
                if (!(query_.bound(c.box, d.box) <= query_.limit()) || !opened(c.id, d.id)) continue;
                if (visit(c, d, levels - 1) == Flow::stop) return Flow::stop;
            }
        }
        return Flow::go_on;
    }

    const A& a_;
    const B& b_;
    Q& query_;
    Count& count_;
    std::vector<Pair>* cut_;
};

}  // namespace detail

/// Walks all pairs of a primitive of one hierarchy and one of the other. A pair is offered once, unless a
/// structure holds a primitive in several leaves. `count` counts pairs: `nodes` opened, `leaves` offered, and
/// the `primitives` in these.
template <BoxHierarchy A, BoxHierarchy B, PairQuery Q, class Count>
void walk_pairs(const A& a, const B& b, Q& query, Count& count) {
    if (a.empty() || b.empty() || done(query)) return;
    detail::PairWalk<A, B, Q, Count>(a, b, query, count).begin({a.root(), b.root()}, 0);
}
/// Walks all pairs of two primitives of one hierarchy. Each unordered pair is offered once, unless the
/// structure holds a primitive in several leaves; then pairs of a primitive and itself are offered too.
template <BoxHierarchy A, SelfPairQuery Q, class Count>
void walk_pairs(const A& a, Q& query, Count& count) {
    if (a.empty() || done(query)) return;
    detail::PairWalk<A, A, Q, Count>(a, a, query, count).begin({a.root(), a.root(), true}, 0);
}

/// Cuts a walk into parts, which together are the whole: pairs of nodes, at least `parts` of them unless both
/// trees are too small. The query must accept nothing (NodePairQuery), since it is asked several times.
template <BoxHierarchy A, BoxHierarchy B, PairQuery Q>
std::vector<NodePair<A, B>> parts_of_walk(const A& a, const B& b, const NodePair<A, B>& whole, Q& query,
                                          std::size_t parts) {
    static_assert(!NodePairQuery<Q>, "a query that accepts pairs of nodes would accept them twice");
    std::vector<NodePair<A, B>> cut = {whole}, before;
    NoVisits none;
    detail::PairWalk<A, B, Q, NoVisits> walk(a, b, query, none, &cut);
    for (bool again = true; again && cut.size() < parts;) {
        before.swap(cut);
        cut.clear();
        again = false;
        for (const auto& pair : before) {
            if (a.is_leaf(pair.a) && b.is_leaf(pair.b)) {
                cut.push_back(pair);
            } else {
                walk.begin(pair, 1);
                again = true;
            }
        }
    }
    return cut;
}
/// Walks one part.
template <BoxHierarchy A, BoxHierarchy B, PairQuery Q, class Count>
Flow walk_part(const A& a, const B& b, const NodePair<A, B>& part, Q& query, Count& count) {
    return detail::PairWalk<A, B, Q, Count>(a, b, query, count).begin(part, 0);
}

}  // namespace hedgerow
