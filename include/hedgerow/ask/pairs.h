/// The questions of two indexes, or of one and itself: how far apart, what meets what.
///
/// Both indexes have the same scalar and dimension; their structures may differ. A structure that is not a
/// BVH of boxes has its boxes computed in each call, in O(n) time and memory (walks/hierarchy.h).
#pragma once

#include <algorithm>
#include <tuple>
#include <vector>

#include <hedgerow/ask/asking.h>
#include <hedgerow/ask/neighbours.h>
#include <hedgerow/ask/points.h>
#include <hedgerow/queries/crossings.h>
#include <hedgerow/queries/minimum_distance.h>
#include <hedgerow/queries/point_query.h>

namespace hedgerow {

/// How far questions of two indexes look, and how exactly: as those of a point do (PointOptions).
struct DistanceOptions {
    double radius = PointOptions::anywhere, radius2 = PointOptions::anywhere;
    double factor = 1;
};
struct PairOptions {
    Threads threads = {};
};

/// The questions of whole sets, as engines know them (walks/engine.h): EngineFor<CrossingPairs, IA, IB>.
struct CrossingPairs;
struct SelfIntersections;
struct PairsWithinRadius;

namespace detail {
// An IA or IB has a structure, primitives and a size, as an Index has.

template <class IA, class IB, class Count>
auto least_distance(const IA& a, const IB& b, const DistanceOptions& options, Count& count) {
    const PointOptions near{.radius = options.radius, .radius2 = options.radius2, .factor = options.factor};
    return in_ieee_mode([&] {
        MinimumDistance query(a.primitives(), b.primitives(), NearLimits<typename IA::Scalar>(near));
        walk_pairs(hierarchy_of(a.structure(), a.primitives()), hierarchy_of(b.structure(), b.primitives()),
                   query, count);
        return query.answer();
    });
}
}  // namespace detail

/// The closest points of two sets within the options' distance, their squared distance, and the primitives
/// that they are on; an Apart that is false if there are none so close. Equal distances go to the lowest
/// (element_a, element_b). Triangles that meet are at distance 0 exactly. For triangles in space, and for
/// points and any primitives with a closest point. `count` may be a Visits, of pairs.
template <class SA, class A, class SB, class B, class Count = const NoVisits>
Apart<typename A::Scalar, A::dimension> minimum_distance(const Index<SA, A>& a, const Index<SB, B>& b,
                                                         const DistanceOptions& options = {},
                                                         Count& count = no_visits) {
    return detail::least_distance(a, b, options, count);
}

namespace detail {

/// Appends the pairs that a walk finds to `found`. The walk is cut into parts over the executor; the order of
/// the pairs may depend on that. `make(f)` makes the query that calls f(i, j) for each pair, or f with
/// whatever a Pair consists of.
template <class A, class B, class Make, class Pair>
void collect_pairs(const A& a, const B& b, const NodePair<A, B>& whole, Executor& executor, Make make,
                   std::vector<Pair>& found) {
    const auto collector = [](std::vector<Pair>& list) {
        return [&list](auto... of_pair) { return list.push_back(Pair{of_pair...}), Flow::go_on; };
    };
    auto query = make(collector(found));
    if (&executor == &serial_executor()) {
        walk_part(a, b, whole, query, no_visits);
        return;
    }
    const auto parts = parts_of_walk(a, b, whole, query, 1024);
    std::vector<std::vector<Pair>> lists(parts.size());
    IeeeExecutor threads(executor);
    threads.for_each_piece(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            auto part = make(collector(lists[i]));
            walk_part(a, b, parts[i], part, no_visits);
        }
    });
    for (const auto& list : lists) found.insert(found.end(), list.begin(), list.end());
}
/// Sorts pairs whose first ones are below a size, and drops those that a structure offered again. O(pairs +
/// size), but for sorting the pairs of one first.
template <class Pair>
std::size_t sort_pairs(std::vector<Pair>& found, std::size_t size) {
    if (found.size() < size) {
        std::sort(found.begin(), found.end());
    } else {
        // Count those of each first one, move them there, and sort each lot.
        std::vector<std::size_t> ends(size + 1, 0);
        for (const Pair& pair : found) ++ends[pair.a + 1];
        for (std::size_t i = 0; i < size; ++i) ends[i + 1] += ends[i];
        std::vector<Pair> sorted(found.size());
        for (const Pair& pair : found) sorted[ends[pair.a]++] = pair;  // each begin becomes its end
        found.swap(sorted);
        auto begin = found.begin();
        for (std::size_t i = 0; i < size; ++i) {
            const auto end = found.begin() + static_cast<std::ptrdiff_t>(ends[i]);
            std::sort(begin, end), begin = end;
        }
    }
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found.size();
}
/// Has the engine of question Q of one or two indexes find pairs, if there is one that is in use.
template <class Q, class Pair, class... I, class... Arguments>
bool found_by_engine(std::tuple<const I&...> indexes, std::vector<Pair>& found, Executor& executor,
                     const Arguments&... arguments) {
    using E = EngineFor<Q, I...>;
    if constexpr (AnswersWhole<E, std::vector<Pair>, Arguments...>) {
        if (const auto engine = std::make_from_tuple<E>(indexes); engine) {
            in_ieee_mode([&] {
                IeeeExecutor threads(executor);
                engine.answer_whole(arguments..., found, threads);
            });
            return true;
        }
    }
    return false;
}
/// Lists the pairs of two indexes, or of one, that the queries of `make` find: ascending, each once. Returns
/// how many there are. An engine of Q may find them.
template <class Q, class IA, class IB, class Make, class Pair>
std::size_t list_pairs(const IA& a, const IB& b, Threads threads, Make make, std::vector<Pair>& found) {
    found.clear();
    Executor& executor = threads.over(a.size() + b.size());
    if (found_by_engine<Q>(std::tie(a, b), found, executor)) return found.size();
    return in_ieee_mode([&] {
        const auto of_a = hierarchy_of(a.structure(), a.primitives());
        const auto of_b = hierarchy_of(b.structure(), b.primitives());
        if (of_a.empty() || of_b.empty()) return std::size_t(0);
        collect_pairs(of_a, of_b, {of_a.root(), of_b.root()}, executor, make, found);
        return sort_pairs(found, a.primitives().size());
    });
}
template <class Q, class I, class Make, class Pair>
std::size_t list_pairs(const I& index, Threads threads, Make make, std::vector<Pair>& found) {
    found.clear();
    Executor& executor = threads.over(index.size());
    if (found_by_engine<Q>(std::tie(index), found, executor)) return found.size();
    return in_ieee_mode([&] {
        const auto tree = hierarchy_of(index.structure(), index.primitives());
        if (tree.empty()) return std::size_t(0);
        collect_pairs(tree, tree, {tree.root(), tree.root(), true}, executor, make, found);
        return sort_pairs(found, index.primitives().size());
    });
}

/// A function for queries that stop at the first pair.
struct StopAtFirst {
    bool* any;
    Flow operator()(PrimitiveId, PrimitiveId) const { return *any = true, Flow::stop; }
};

template <class IA, class IB>
std::size_t list_crossings(const IA& a, const IB& b, std::vector<ElementPair>& found, Threads threads) {
    return list_pairs<CrossingPairs>(
        a, b, threads, [&](auto f) { return Crossings(triangles_of(a), triangles_of(b), f); }, found);
}
template <class IA, class IB>
bool has_crossing(const IA& a, const IB& b) {
    return in_ieee_mode([&] {
        bool any = false;
        Crossings query(triangles_of(a), triangles_of(b), StopAtFirst{&any});
        walk_pairs(hierarchy_of(a.structure(), a.primitives()), hierarchy_of(b.structure(), b.primitives()),
                   query, no_visits);
        return any;
    });
}
template <class I>
std::size_t list_self_intersections(const I& index, std::vector<ElementPair>& found, Threads threads) {
    return list_pairs<SelfIntersections>(
        index, threads, [&](auto f) { return SelfCrossings(triangles_of(index), f); }, found);
}
template <class I>
bool has_self_intersection(const I& index) {
    return in_ieee_mode([&] {
        bool any = false;
        SelfCrossings query(triangles_of(index), StopAtFirst{&any});
        walk_pairs(hierarchy_of(index.structure(), index.primitives()), query, no_visits);
        return any;
    });
}

}  // namespace detail

/// Writes the pairs of triangles of two meshes that share a point to `found`, ascending: positions in both
/// sets. Touching counts; the answers are those of exact arithmetic (geometry/triangles_meet.h). Returns how
/// many there are. Large sets are walked on all cores, or the threads of the options.
template <class SA, TriangleSet A, class SB, TriangleSet B>
std::size_t crossing_pairs(const Index<SA, A>& a, const Index<SB, B>& b, std::vector<ElementPair>& found,
                           const PairOptions& options = {}) {
    return detail::list_crossings(a, b, found, options.threads);
}
template <class SA, TriangleSet A, class SB, TriangleSet B>
std::vector<ElementPair> crossing_pairs(const Index<SA, A>& a, const Index<SB, B>& b,
                                        const PairOptions& options = {}) {
    std::vector<ElementPair> found;
    crossing_pairs(a, b, found, options);
    return found;
}
/// Whether any triangles of two meshes share a point. Stops at the first pair.
template <class SA, TriangleSet A, class SB, TriangleSet B>
bool any_crossing(const Index<SA, A>& a, const Index<SB, B>& b) {
    return detail::has_crossing(a, b);
}

/// Writes the pairs (i, j), i < j, of triangles of one mesh that intersect to `found`, ascending. Neighbours,
/// which share corners by position, intersect only if they meet beyond these: folded onto each other,
/// overlapping, piercing (geometry/meet_beyond_shared.h). Exact. Returns how many pairs there are. Large
/// meshes are walked on all cores, or the threads of the options.
template <class S, TriangleSet P>
std::size_t self_intersections(const Index<S, P>& index, std::vector<ElementPair>& found,
                               const PairOptions& options = {}) {
    return detail::list_self_intersections(index, found, options.threads);
}
template <class S, TriangleSet P>
std::vector<ElementPair> self_intersections(const Index<S, P>& index, const PairOptions& options = {}) {
    std::vector<ElementPair> found;
    self_intersections(index, found, options);
    return found;
}
/// Whether any triangles of a mesh intersect. Stops at the first pair.
template <class S, TriangleSet P>
bool any_self_intersection(const Index<S, P>& index) {
    return detail::has_self_intersection(index);
}

/// Writes all pairs (i, j), i < j, of points of one set that are within a radius of each other to `found`,
/// each once and ascending, with the squared distance: what `within` finds for each point. None if the radius
/// is negative or NaN. Returns how many there are. Takes memory for all pairs, which may be n²/2 of them, and
/// as much again while it runs. Large sets are searched on all cores, or the threads of the options; the list
/// is the same. Whatever the index, the points are sorted by cells for it (ask/neighbours.h), which is faster
/// than to walk one.
template <class S, PointSet P>
std::size_t pairs_within(const Index<S, P>& index, double radius,
                         std::vector<PairWithin<typename P::Scalar>>& found,
                         const PairOptions& options = {}) {
    if (detail::found_by_engine<PairsWithinRadius>(std::tie(index), found, options.threads.over(index.size()),
                                                   radius))
        return found.size();
    return detail::list_pairs_within(index, radius, found, options.threads);
}
template <class S, PointSet P>
std::vector<PairWithin<typename P::Scalar>> pairs_within(const Index<S, P>& index, double radius,
                                                         const PairOptions& options = {}) {
    std::vector<PairWithin<typename P::Scalar>> found;
    pairs_within(index, radius, found, options);
    return found;
}
/// Finds the pairs of a point of A and one of B.
template <class SA, PointSet A, class SB, PointSet B>
std::size_t pairs_within(const Index<SA, A>& a, const Index<SB, B>& b, double radius,
                         std::vector<PairWithin<typename A::Scalar>>& found,
                         const PairOptions& options = {}) {
    if (detail::found_by_engine<PairsWithinRadius>(std::tie(a, b), found,
                                                   options.threads.over(a.size() + b.size()), radius))
        return found.size();
    return detail::list_pairs_within(a, b, radius, found, options.threads);
}
template <class SA, PointSet A, class SB, PointSet B>
std::vector<PairWithin<typename A::Scalar>> pairs_within(const Index<SA, A>& a, const Index<SB, B>& b,
                                                         double radius, const PairOptions& options = {}) {
    std::vector<PairWithin<typename A::Scalar>> found;
    pairs_within(a, b, radius, found, options);
    return found;
}

}  // namespace hedgerow
