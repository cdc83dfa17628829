/// The questions of a point, one at a time or many in a batch: the closest point, the nearest primitives, and
/// those within a distance. ask/asking.h tells what all questions share.
#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <hedgerow/ask/asking.h>
#include <hedgerow/ask/many.h>
#include <hedgerow/ask/neighbours.h>
#include <hedgerow/probes/point_batch.h>
#include <hedgerow/queries/closest_point.h>
#include <hedgerow/queries/farthest_point.h>
#include <hedgerow/queries/nearest.h>
#include <hedgerow/queries/within.h>

namespace hedgerow {

template <class I>
using PointOf = Vec<typename I::Scalar, I::dimension>;
template <class I>
using PointsOf = Strided<PointOf<I>>;
template <class I>
using NearOf = Near<typename I::Scalar, I::dimension>;
template <class I>
using NearListsOf = NearLists<typename I::Scalar, IdOf<typename I::Primitives>>;

/// A filter of what is near: callable with a Near, or with the number of a query and a Near (queries/hit.h).
template <class F, class I>
concept NearFilterOf = detail::Asks<F, NearOf<I>> || detail::Asks<F, std::size_t, NearOf<I>>;

/// A filter of what is near, asked of each or of many (ask/many.h).
template <class F, class I>
concept NearBatchFilterOf =
    NearFilterOf<F, I> || FilterOfManyNear<F, typename I::Scalar, IdOf<typename I::Primitives>>;

namespace detail {
/// The answer of a query Q of a point. Engines have no filter of points, so none is named where none is
/// given.
template <template <class, class> class Q, class I, class Filter, class Count, class... Arguments>
auto answer_near(const I& index, const Filter& filter, Count& count, Arguments&&... arguments) {
    using P = typename I::Primitives;
    if constexpr (std::same_as<Filter, KeepAll>)
        return index.template answer<Q<P, KeepAll>>(count, arguments...);
    else
        return index.template answer<Q<P, Filter>>(count, arguments..., filter);
}
/// The options of one query, as its walk reads them, which views them. Throws InputError for a bad factor or
/// mask.
template <class I>
NearLimits<typename I::Scalar> limits_of(const I& index, const PointOptions& options) {
    options.leave_out.expect(1);
    options.mask.expect(index.primitives());
    return NearLimits<typename I::Scalar>(options);
}
/// The options of a question of all that is within a radius. Both radii hold; nothing is within NaN. No
/// factor makes such a list shorter.
inline PointOptions within_both(double radius, PointOptions options) {
    if (radius < options.radius || std::isnan(radius)) options.radius = radius;
    if (options.factor > 1) options.factor = 1;
    return options;
}
}  // namespace detail

/// The closest point of any primitive within the options' distance; a Near that is false if there is no such
/// primitive.
template <class I, class Filter = KeepAll, class Count = const NoVisits>
inline NearOf<I> closest_point(const I& index, const PointOf<I>& point, const PointOptions& options = {},
                               const Filter& filter = {}, Count& count = no_visits) {
    return detail::answer_near<ClosestPoint>(index, filter, count, point, detail::limits_of(index, options));
}
template <class I, NearFilterOf<I> Filter, class Count = const NoVisits>
NearOf<I> closest_point(const I& index, const PointOf<I>& point, const Filter& filter,
                        Count& count = no_visits) {
    return closest_point(index, point, PointOptions(), filter, count);
}

/// The farthest point of any primitive: of triangles and segments a corner, of a sphere the point beyond its
/// center. With a radius, of those primitives that lie within it wholly; with a factor, at least the farthest
/// distance over the factor away. Not of instances. Walks a tree, a BVH fastest; a grid looks at all cells.
template <class I, class Filter = KeepAll, class Count = const NoVisits>
NearOf<I> farthest_point(const I& index, const PointOf<I>& point, const PointOptions& options = {},
                         const Filter& filter = {}, Count& count = no_visits) {
    return detail::answer_near<FarthestPoint>(index, filter, count, point, detail::limits_of(index, options));
}
template <class I, NearFilterOf<I> Filter, class Count = const NoVisits>
NearOf<I> farthest_point(const I& index, const PointOf<I>& point, const Filter& filter,
                         Count& count = no_visits) {
    return farthest_point(index, point, PointOptions(), filter, count);
}

/// Writes the k nearest primitives within the options' distance to `found`, in the order of (distance²,
/// instance, element). Returns how many there are.
template <class I, class Filter = KeepAll, class Count = const NoVisits>
std::size_t nearest(const I& index, const PointOf<I>& point, std::size_t k, std::vector<NearOf<I>>& found,
                    const PointOptions& options = {}, const Filter& filter = {}, Count& count = no_visits) {
    return detail::answer_near<Nearest>(index, filter, count, point, k, detail::limits_of(index, options),
                                        found);
}
template <class I, NearFilterOf<I> Filter, class Count = const NoVisits>
std::size_t nearest(const I& index, const PointOf<I>& point, std::size_t k, std::vector<NearOf<I>>& found,
                    const Filter& filter, Count& count = no_visits) {
    return nearest(index, point, k, found, PointOptions(), filter, count);
}
template <class I, class Filter = KeepAll, class Count = const NoVisits>
std::vector<NearOf<I>> nearest(const I& index, const PointOf<I>& point, std::size_t k,
                               const PointOptions& options = {}, const Filter& filter = {},
                               Count& count = no_visits) {
    std::vector<NearOf<I>> found;
    nearest(index, point, k, found, options, filter, count);
    return found;
}
template <class I, NearFilterOf<I> Filter>
std::vector<NearOf<I>> nearest(const I& index, const PointOf<I>& point, std::size_t k, const Filter& filter) {
    return nearest(index, point, k, PointOptions(), filter);
}

/// Writes all primitives within a radius to `found`, in the order of (distance², instance, element). Returns
/// how many there are.
template <class I, class Filter = KeepAll, class Count = const NoVisits>
std::size_t within(const I& index, const PointOf<I>& point, double radius, std::vector<NearOf<I>>& found,
                   const PointOptions& options = {}, const Filter& filter = {}, Count& count = no_visits) {
    const PointOptions both = detail::within_both(radius, options);
    const auto limits = detail::limits_of(index, both);
    return detail::answer_near<Within>(index, filter, count, point, limits, found);
}
template <class I, NearFilterOf<I> Filter, class Count = const NoVisits>
std::size_t within(const I& index, const PointOf<I>& point, double radius, std::vector<NearOf<I>>& found,
                   const Filter& filter, Count& count = no_visits) {
    return within(index, point, radius, found, PointOptions(), filter, count);
}
template <class I, class Filter = KeepAll, class Count = const NoVisits>
std::vector<NearOf<I>> within(const I& index, const PointOf<I>& point, double radius,
                              const PointOptions& options = {}, const Filter& filter = {},
                              Count& count = no_visits) {
    std::vector<NearOf<I>> found;
    within(index, point, radius, found, options, filter, count);
    return found;
}
template <class I, NearFilterOf<I> Filter>
std::vector<NearOf<I>> within(const I& index, const PointOf<I>& point, double radius, const Filter& filter) {
    return within(index, point, radius, PointOptions(), filter);
}

namespace detail {
/// What batches of points share: checks, and ask(batch).
template <class I, class Filter, class Ask>
void ask_points(const I& index, const PointsOf<I>& points, const PointOptions& options, const Filter& filter,
                std::span<Visits> visits, Ask ask) {
    expect_visits(visits, points.size());
    options.leave_out.expect(points.size());
    options.mask.expect(index.primitives());
    static_cast<void>(NearLimits<typename I::Scalar>::of_batch(options));  // throws for a bad factor
    ask(AskedBatch{options, filter, executor_for<Filter>(options.threads, points.size()), visits});
}
/// Calls one(i) for each of many points, in an order in which walks share what the caches hold.
template <class I, class One>
void each_along_curve(const I& index, const PointsOf<I>& points, Executor& executor, One one) {
    for_each_part(points, index.bounds(), index.bytes(), executor, [&](const auto& part) {
        for (std::size_t i = 0; i < part.size(); ++i) one(part.number(i));
    });
}
}  // namespace detail

/// Writes the closest point for each of `points`, as `closest_point` finds it. The points may have any layout
/// in memory (base/strided.h); a vector or a span of points will do. The filter may be one of many
/// (ask/many.h).
template <class I, class Filter = KeepAll>
void closest_points(const I& index, const PointsOf<I>& points, std::span<NearOf<I>> found,
                    const PointOptions& options = {}, const Filter& filter = {},
                    std::span<Visits> visits = {}) {
    using T = typename I::Scalar;
    detail::expect_room("points", points.size(), found.size());
    if constexpr (FilterOfManyNear<Filter, T, IdOf<typename I::Primitives>>)
        return detail::closest_point_kept(index, points, found, options, filter, visits);
    else
        detail::ask_points(index, points, options, filter, visits, [&](const auto& batch) {
            const auto one = [&](std::size_t i) {
                found[i] = detail::with_visits(visits, i, [&](auto& count) {
                    return detail::answer_near<ClosestPoint>(index, filter_of_ray(filter, i), count,
                                                             points[i], NearLimits<T>(options, i));
                });
            };
            if (!detail::answered_by_engine<ClosestPoint<typename I::Primitives, Filter>>(
                    index, points, found.data(), batch, one))
                detail::each_along_curve(index, points, batch.executor, one);
        });
}
template <class I, NearBatchFilterOf<I> Filter>
void closest_points(const I& index, const PointsOf<I>& points, std::span<NearOf<I>> found,
                    const Filter& filter, std::span<Visits> visits = {}) {
    closest_points(index, points, found, PointOptions(), filter, visits);
}

/// Writes the farthest point for each of `points`, as `farthest_point` finds it.
template <class I, class Filter = KeepAll>
void farthest_points(const I& index, const PointsOf<I>& points, std::span<NearOf<I>> found,
                     const PointOptions& options = {}, const Filter& filter = {},
                     std::span<Visits> visits = {}) {
    detail::expect_room("points", points.size(), found.size());
    detail::ask_points(index, points, options, filter, visits, [&](const auto& batch) {
        detail::answer_batch<FarthestPoint<typename I::Primitives, Filter>>(
            index, points, found.data(), batch, [&](std::size_t i, auto& count) {
                return detail::answer_near<FarthestPoint>(index, filter_of_ray(filter, i), count, points[i],
                                                          NearLimits<typename I::Scalar>(options, i));
            });
    });
}
template <class I, NearFilterOf<I> Filter>
void farthest_points(const I& index, const PointsOf<I>& points, std::span<NearOf<I>> found,
                     const Filter& filter, std::span<Visits> visits = {}) {
    farthest_points(index, points, found, PointOptions(), filter, visits);
}

/// Writes the k nearest primitives for each of `points` to lists, as `nearest` finds them: their positions in
/// the set, or PlacedIds among instances, and their squared distances. The filter may be one of many
/// (ask/many.h).
template <class I, class Filter = KeepAll>
void nearest(const I& index, const PointsOf<I>& points, std::size_t k, NearListsOf<I>& lists,
             const PointOptions& options = {}, const Filter& filter = {}, std::span<Visits> visits = {}) {
    using P = typename I::Primitives;
    using T = typename I::Scalar;
    using Row = NearRow<T, IdOf<P>>;
    k = std::min(k, detail::primitives_in(index.primitives()));
    if constexpr (FilterOfManyNear<Filter, T, IdOf<P>>)
        return detail::nearest_kept(index, points, k, lists, options, filter, visits);
    else
        detail::ask_points(index, points, options, filter, visits, [&](const auto& batch) {
            const auto one = [&](std::size_t i, const Row& row) {
                const Scratch<std::vector<NearOf<I>>> found;
                detail::with_visits(visits, i, [&](auto& count) {
                    return detail::answer_near<Nearest>(index, filter_of_ray(filter, i), count, points[i], k,
                                                        NearLimits<T>(options, i), *found);
                });
                found->resize(row.ids.size());
                for (std::size_t j = 0; j < row.ids.size(); ++j) {
                    row.ids[j] = Identity<P>::of((*found)[j]);
                    row.distances2[j] = (*found)[j].distance2;
                }
            };
            detail::list_in_own_memory(lists, [&](NearListsOf<I>& own) {
                if (detail::listed_by_engine<Nearest<P, Filter>, const Row&>(index, points, own, batch, one,
                                                                             k))
                    return;
                detail::list_by_rows(own, points.size(), k, options, [&](const auto& rows) {
                    detail::each_along_curve(index, points, batch.executor,
                                             [&](std::size_t i) { one(i, rows[i]); });
                });
            });
        });
}
template <class I, NearBatchFilterOf<I> Filter>
void nearest(const I& index, const PointsOf<I>& points, std::size_t k, NearListsOf<I>& lists,
             const Filter& filter, std::span<Visits> visits = {}) {
    nearest(index, points, k, lists, PointOptions(), filter, visits);
}
template <class I, class Filter = KeepAll>
NearListsOf<I> nearest(const I& index, const PointsOf<I>& points, std::size_t k,
                       const PointOptions& options = {}, const Filter& filter = {},
                       std::span<Visits> visits = {}) {
    NearListsOf<I> lists;
    nearest(index, points, k, lists, options, filter, visits);
    return lists;
}
template <class I, NearBatchFilterOf<I> Filter>
NearListsOf<I> nearest(const I& index, const PointsOf<I>& points, std::size_t k, const Filter& filter) {
    return nearest(index, points, k, PointOptions(), filter);
}

/// Writes all primitives within a radius of each of `points` to lists, as `within` finds them. The filter may
/// be one of many (ask/many.h).
///
/// Many questions among points are answered by cells that are sorted for them (ask/neighbours.h) where these
/// are faster than the index; the answers are the same. Such a call takes memory for the cells.
template <class I, class Filter = KeepAll>
void within(const I& index, const PointsOf<I>& points, double radius, NearListsOf<I>& lists,
            const PointOptions& options = {}, const Filter& filter = {}, std::span<Visits> visits = {}) {
    using P = typename I::Primitives;
    using T = typename I::Scalar;
    const PointOptions both = detail::within_both(radius, options);
    if constexpr (FilterOfManyNear<Filter, T, IdOf<P>>)
        return detail::list_kept(lists, points.size(), filter, [&](NearListsOf<I>& own) {
            within(index, points, radius, own, options, KeepAll(), visits);
        });
    else
        detail::ask_points(index, points, both, filter, visits, [&](const auto& batch) {
            const auto one = [&](std::size_t i, NearListsOf<I>& to) {
                const Scratch<std::vector<NearOf<I>>> found;
                detail::with_visits(visits, i, [&](auto& count) {
                    return detail::answer_near<Within>(index, filter_of_ray(filter, i), count, points[i],
                                                       NearLimits<T>(both, i), *found);
                });
                for (const auto& near : *found) {
                    to.ids.push_back(Identity<P>::of(near));
                    to.distances2.push_back(near.distance2);
                }
                to.offsets.push_back(to.ids.size());
            };
            detail::list_in_own_memory(lists, [&](NearListsOf<I>& own) {
                if (detail::listed_by_engine<Within<P, Filter>, NearListsOf<I>&>(index, points, own, batch,
                                                                                 one))
                    return;
                if constexpr (std::same_as<Filter, KeepAll>)
                    if (visits.empty() && detail::listed_by_cells(index, points, own, both)) return;
                detail::list_in_pieces(points.size(), batch.executor, own,
                                       [&](std::size_t begin, std::size_t end, NearListsOf<I>& to) {
                                           for (std::size_t i = begin; i < end; ++i) one(i, to);
                                       });
            });
        });
}
template <class I, NearBatchFilterOf<I> Filter>
void within(const I& index, const PointsOf<I>& points, double radius, NearListsOf<I>& lists,
            const Filter& filter, std::span<Visits> visits = {}) {
    within(index, points, radius, lists, PointOptions(), filter, visits);
}
template <class I, class Filter = KeepAll>
NearListsOf<I> within(const I& index, const PointsOf<I>& points, double radius,
                      const PointOptions& options = {}, const Filter& filter = {},
                      std::span<Visits> visits = {}) {
    NearListsOf<I> lists;
    within(index, points, radius, lists, options, filter, visits);
    return lists;
}
template <class I, NearBatchFilterOf<I> Filter>
NearListsOf<I> within(const I& index, const PointsOf<I>& points, double radius, const Filter& filter) {
    return within(index, points, radius, PointOptions(), filter);
}

}  // namespace hedgerow
