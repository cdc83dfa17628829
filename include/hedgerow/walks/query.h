/// What a query is: what counts as an answer. A walk offers it candidates; the query holds the limit, which
/// may only shrink. A query knows no structure.
#pragma once

#include <cstdint>

#include <hedgerow/primitives/concepts.h>

namespace hedgerow {

/// Whether a walk opens near cells first. A query that reports whatever it overlaps needs no order.
enum class Order { none, nearest };

/// What a walk needs of a query.
/// - `probe` is its geometry.
/// - `limit` is the largest t (of a ray), distance² (of a point) or −distance² (of a point whose farthest is
///   asked for) that can still change the answer. It may only shrink. Infinity excludes nothing; the largest
///   number excludes distances that overflow. Of a query of a region only the sign counts.
/// - `done`, if there is one, says that nothing can change the answer, so that no walk begins and no limit is
///   asked.
/// - `offer` is called with each candidate that a primitive's test gives, and may stop the walk. A structure
///   may offer a primitive more than once. The distance of a candidate may be infinite or NaN.
/// - `order` is a wish: a walk may ignore it, and a VirtualQuery has the order of its probe.
template <class Q>
concept Query = requires(Q& q, const Q& asked, const CandidateOf<typename Q::Probe>& candidate) {
    { Q::order } -> std::convertible_to<Order>;
    { asked.probe() } -> std::convertible_to<const typename Q::Probe&>;
    { asked.limit() } -> std::convertible_to<typename Q::Probe::Scalar>;
    { q.offer(candidate) } -> std::same_as<Flow>;
};

/// Whether nothing can change the answer of a query of primitives or of pairs.
template <class Q>
bool done(const Q& query) {
    if constexpr (requires { query.done(); })
        return query.done();
    else
        return false;
}

/// A query that an Index makes, walks and reads. The Index calls the constructor Q(index, arguments...),
/// which may keep `index.primitives()` (for `reported_id`), and after the walk `answer` once.
template <class Q>
concept AnsweringQuery = Query<Q> && requires(Q& q) {
    q.answer();
};

/// The number of a node in its tree. The root is 0, and every other node has a number of its own below the
/// tree's `node_count()`.
using NodeId = std::uint32_t;

/// What a query says of a whole subtree before the walk opens it.
enum class Verdict { prune, open, accept };

/// A node of a tree, as `accept` of a query sees it before the walk opens it.
/// - `id` is the index of what `fold` computed for the node.
/// - `volume` contains all primitives below, or in trees that hold a primitive in several leaves the parts
///   that are below. In trees of planes it is the `cell` of the probe's state, if there is one.
/// - `for_each_leaf` calls a function with every Leaf below, in no particular order.
/// - `count` is the number of items in these leaves: O(1) where the tree stores it, else O(leaves below).
template <class N>
concept WalkedNode = requires(const N& node) {
    { node.id() } -> std::same_as<NodeId>;
    {node.volume()};
    { node.count() } -> std::same_as<std::size_t>;
    node.for_each_leaf([](const Leaf&) {});
};
namespace detail {
/// A node for concepts alone, which look up `accept` with it.
struct AnyNode {
    NodeId id() const;
    Box<float, 3> volume() const;
    std::size_t count() const;
    void for_each_leaf(auto f) const;
};
/// The items of all leaves of a node.
template <class Node>
std::size_t items_below(const Node& node) {
    std::size_t items = 0;
    node.for_each_leaf([&](const Leaf& leaf) { items += leaf.count; });
    return items;
}
}  // namespace detail

/// A query that can take a whole subtree at once (counts, containment, multipoles). `accept` is a template
/// over the node (WalkedNode).
template <class Q>
concept SubtreeQuery = Query<Q> && requires(Q& q, const detail::AnyNode& node) {
    { q.accept(node) } -> std::same_as<Verdict>;
};

}  // namespace hedgerow
