/// What a structure is: a way to divide space or primitives, and a walk through it. Read query.h first, then
/// this.
#pragma once

#include <concepts>
#include <span>
#include <string>
#include <vector>

#include <hedgerow/parallel/executor.h>
#include <hedgerow/walks/query.h>
#include <hedgerow/walks/visits.h>

namespace hedgerow {

namespace detail {
/// A query for concepts alone, which look up `walk` with it.
template <class P>
struct AnyQuery {
    using Probe = BoxProbe<typename P::Scalar, P::dimension>;
    static constexpr Order order = Order::none;
    const Probe& probe() const;
    typename P::Scalar limit() const;
    Flow offer(const CandidateOf<Probe>&);
};
}  // namespace detail

/// A structure S over primitives P, as an Index holds it. It knows no query: `walk` brings any query to each
/// leaf that can hold an answer within the query's limit.
///
/// `walk` is a template over primitives, query and count. It is called by `walk_through`, and ends where a
/// leaf's test returns Flow::stop. A structure that is none of the trees in volumes.h,
/// planes.h, orthants.h and no lattice does that by itself:
///
///     for each cell:
///         count.node(Place{number});
///         if (!query.probe().enter(box, query.limit(), at)) continue;  // the limit shrinks on the way
///         count.leaf(leaf.count, Place{number});
///         if (test_leaf(primitives, query.probe(), leaf, query) == Flow::stop) return;
///
/// and lists its cells under the same numbers by `for_each_cell(f(number, box, leaf))` (outline.h), for
/// pictures and traces.
///
/// - A default-constructed structure contains nothing.
/// - `packed_order` says how triangles are packed for rays: `of_leaves` if leaves are ranges of `items`, else
///   `of_ids`. Without it, and without a member `pack`, they are not packed.
/// - `build` throws InputError for bad primitives, and UsageError for options out of their range.
/// - `exclusive` says that each primitive is in one leaf, so that no candidate is offered twice.
/// - `items` lists the primitives, leaf by leaf. `bytes` is the memory beyond the primitives themselves.
/// - `node_count` is more than every NodeId. `depth` counts levels, leaves included; brute force has none.
/// - `validate` describes the first fault that it finds, and is empty for a sound structure.
template <class S, class P>
concept Structure = PrimitiveSet<P> &&
    requires(const S& s, const P& set, const typename S::Options& options, Executor& executor,
             detail::AnyQuery<P>& query, Visits& count) {
    { S::build(set, options, executor) } -> std::same_as<S>;
    { s.bounds() } -> std::same_as<const Box<typename P::Scalar, P::dimension>&>;
    { s.exclusive() } -> std::same_as<bool>;
    { s.items() } -> std::convertible_to<std::span<const PrimitiveId>>;
    { s.bytes() } -> std::same_as<std::size_t>;
    { s.node_count() } -> std::same_as<std::size_t>;
    { s.leaf_count() } -> std::same_as<std::size_t>;
    { s.depth() } -> std::same_as<int>;
    { s.validate(set) } -> std::same_as<std::string>;
    s.walk(set, query, count);
};

/// Whether a structure answers queries of a probe. All do, unless their `answers<Probe>` says no.
template <class S, class Probe>
concept AnswersProbe = !requires {
    requires !S::template answers<Probe>;
};

/// A structure that can insert and erase single primitives. Both return false, and change nothing, where the
/// primitive is held already or is not held.
template <class S, class P>
concept ChangesOneByOne = requires(S& s, const P& set, PrimitiveId id) {
    { s.insert(set, id) } -> std::same_as<bool>;
    { s.erase(set, id) } -> std::same_as<bool>;
};

/// Walks a query through a structure, to the leaves of its primitives, unless the query is done.
template <class S, class Leaves, Query Q, class Count>
void walk_through(const S& structure, const Leaves& leaves, Q& query, Count& count) {
    if (!done(query)) structure.walk(leaves, query, count);
}

namespace detail {
/// Copies what an insertion or erasure of primitive `id` changed into a packed copy of its set.
template <PackedOrder order, class P, class S, class Packed>
void pack_changed(const P& set, const S& structure, PrimitiveId id, Packed& packed) {
    if constexpr (order == PackedOrder::of_ids) {
        if (structure.holds(id)) set.pack(id, id, packed);
    } else {
        for (const auto place : structure.places_changed()) set.pack(structure.items()[place], place, packed);
    }
}
/// Whether a structure holds a primitive of its set. One that cannot change holds all.
template <class S>
bool holds(const S& structure, PrimitiveId id) {
    if constexpr (requires { structure.holds(id); }) return structure.holds(id);
    return true;
}
/// How many of a set's `count` primitives a structure holds.
template <class S>
std::size_t held_count(const S& structure, std::size_t count) {
    if constexpr (requires { structure.held_count(count); }) return structure.held_count(count);
    std::vector<bool> held(count);
    std::size_t found = 0;
    // Between the leaves of a tree that has changed, items are words that are no ids.
    if constexpr (requires { structure.holds(PrimitiveId(0)); }) {
        for (PrimitiveId id = 0; id < count; ++id) found += structure.holds(id);
    } else {
        for (const PrimitiveId id : structure.items())
            if (id != no_primitive && !held[id]) held[id] = true, ++found;
    }
    return found;
}
/// Whether a structure holds all of a set's `count` primitives. O(1) for one that cannot change, else
/// O(count).
template <class S>
bool holds_all(const S& structure, std::size_t count) {
    if constexpr (requires { structure.holds(PrimitiveId(0)); }) return held_count(structure, count) == count;
    return true;
}
}  // namespace detail

}  // namespace hedgerow
