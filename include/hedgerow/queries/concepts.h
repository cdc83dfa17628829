/// What a query is: what counts as an answer. It is offered candidates and holds the limit, which may only
/// shrink; it knows no structure.
#pragma once

#include <cstdint>

#include <hedgerow/primitives/concepts.h>

namespace hedgerow {

/// Whether near cells are wanted first. A query that takes whatever it overlaps needs no order.
enum class Order { none, nearest };

/// Of a RayQuery that has such a member `sought`: what it has to be told of a part of the scene. Others are
/// offered everything that is met.
enum class Sought { closest, any };

template <class Q>
concept Query = requires(Q& q, const Q& asked) {
    { Q::order } -> std::convertible_to<Order>;
    { asked.probe() } -> std::convertible_to<const typename Q::Probe&>;
    { asked.limit() } -> std::convertible_to<typename Q::Probe::Scalar>;
};

/// A place in a tree: the root is 0, every other node has a number of its own below the tree's
/// `node_count()`.
using NodeId = std::uint32_t;

/// How a walk names the node that it is at: two words that no other node of the structure has, but those that
/// hold nothing. Which NodeId that is, structures/outline.h says.
struct Place {
    std::uint32_t first = 0, second = 0;
    friend constexpr bool operator==(const Place&, const Place&) = default;
};

/// What a query says of a whole subtree before it is looked into.
enum class Verdict { prune, open, accept };

/// A query that can take a subtree at once (counts, containment, multipoles). What it knows of the node, it
/// has from `fold`.
template <class Q>
concept SubtreeQuery = Query<Q> && requires(Q& q, NodeId node) {
    { q.accept(node) } -> std::same_as<Verdict>;
};

/// How much a query looked at. `nodes`: inner nodes opened (cells of a grid); `leaves`; `primitives` tested,
/// and how many a mailbox `skipped`, since they had been tested before. Walks also say where they are: the
/// place, and what is left of the probe there if they know it. Only a trace listens (trace.h).
struct Visits {
    std::uint64_t nodes = 0, leaves = 0, primitives = 0, skipped = 0;

    template <class... Where>
    void node(const Where&...) {
        ++nodes;
    }
    template <class... Where>
    void leaf(std::uint64_t count, const Where&...) {
        ++leaves, primitives += count;
    }
    void own(PrimitiveId) { ++primitives; }
    void skip(PrimitiveId) { --primitives, ++skipped; }
    Visits& operator+=(const Visits& o) {
        nodes += o.nodes, leaves += o.leaves, primitives += o.primitives, skipped += o.skipped;
        return *this;
    }
    friend bool operator==(const Visits&, const Visits&) = default;
};
/// Counts nothing and costs nothing.
struct NoVisits {
    template <class... Where>
    void node(const Where&...) const {}
    template <class... Where>
    void leaf(std::uint64_t, const Where&...) const {}
    void own(PrimitiveId) const {}
    void skip(PrimitiveId) const {}
};

}  // namespace hedgerow
