/// The questions of a point, one at a time or many in a batch: the closest point, the nearest primitives, and
/// those within a distance. ask/asking.h tells what all questions share.
#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <hedgerow/ask/asking.h>
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

namespace detail {
/// The answer of a query Q of a point. Kernels have no filter.
template <template <class, class> class Q, class I, class Filter, class Count, class... Arguments>
auto answer_near(const I& index, const Filter& filter, Count& count, Arguments&&... arguments) {
    using P = typename I::Primitives;
    if constexpr (std::same_as<Filter, KeepAll>)
        return index.template answer<Q<P, KeepAll>>(count, arguments...);
    else
        return index.template answer<Q<P, Filter>>(count, arguments..., filter);
}
template <class I, class Filter, class Count>
std::size_t nearest(const I& index, const PointOf<I>& point, std::size_t k, std::vector<NearOf<I>>& found,
                    const NearLimits<typename I::Scalar>& limits, const Filter& filter, Count& count) {
    if constexpr (std::same_as<Filter, KeepAll> && std::same_as<Count, const NoVisits> &&
                  requires { index.nearest_uncounted(point, k, limits, found); })
        return index.nearest_uncounted(point, k, limits, found);
    else
        return answer_near<Nearest>(index, filter, count, point, k, limits, found);
}
template <class I, class Filter, class Count>
std::size_t within(const I& index, const PointOf<I>& point, std::vector<NearOf<I>>& found,
                   const NearLimits<typename I::Scalar>& limits, const Filter& filter, Count& count) {
    if constexpr (std::same_as<Filter, KeepAll> && std::same_as<Count, const NoVisits> &&
                  requires { index.within_uncounted(point, limits, found); })
        return index.within_uncounted(point, limits, found);
    else
        return answer_near<Within>(index, filter, count, point, limits, found);
}
/// The options of a question that has a radius of its own. Both hold; nothing is within NaN.
inline PointOptions within_both(double radius, PointOptions options) {
    if (radius < options.radius || std::isnan(radius)) options.radius = radius;
    return options;
}
}  // namespace detail

/// The closest point of any primitive within the options' distance; a Near that is false if there is no such
/// primitive.
template <class I, class Filter = KeepAll, class Count = const NoVisits>
inline NearOf<I> closest_point(const I& index, const PointOf<I>& point, const PointOptions& options = {},
                               const Filter& filter = {}, Count& count = no_visits) {
    return detail::answer_near<ClosestPoint>(index, filter, count, point,
                                             NearLimits<typename I::Scalar>(options));
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
    return detail::answer_near<FarthestPoint>(index, filter, count, point,
                                              NearLimits<typename I::Scalar>(options));
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
    return detail::nearest(index, point, k, found, NearLimits<typename I::Scalar>(options), filter, count);
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

/// Writes all primitives within a radius to `found`, in the order of (distance², instance, element). Returns
/// how many there are.
template <class I, class Filter = KeepAll, class Count = const NoVisits>
std::size_t within(const I& index, const PointOf<I>& point, double radius, std::vector<NearOf<I>>& found,
                   const PointOptions& options = {}, const Filter& filter = {}, Count& count = no_visits) {
    const NearLimits<typename I::Scalar> limits(detail::within_both(radius, options));
    return detail::within(index, point, found, limits, filter, count);
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

namespace detail {
/// Answers questions Q by many(kernel), if there is a kernel in use. False if there is none, or it returns
/// false.
template <class Q, class I, class Many>
bool answered_by_kernel(Many many) {
    if constexpr (HasKernel<Q, I>) {
        const Kernel<Q, I> kernel;
        return kernel && in_ieee_mode([&] { return many(kernel); });
    } else {
        return false;
    }
}
/// Answers a question Q of each of many points: by many(kernel, part), unless there is no kernel,
/// `one_by_one` is true or it returns false; then by one(i).
template <class Q, class I, class Many, class One>
void ask_in_parts(const I& index, const PointsOf<I>& points, Executor& executor, bool one_by_one, Many many,
                  One one) {
    for_each_part(points, index.bounds(), index.bytes(), executor, [&](const auto& part) {
        if (!one_by_one && answered_by_kernel<Q, I>([&](const auto& kernel) { return many(kernel, part); }))
            return;
        for (std::size_t i = 0; i < part.size(); ++i) one(part.number(i));
    });
}
inline PrimitiveId element_of(PrimitiveId id) {
    return id;
}
inline PrimitiveId element_of(const PlacedId& id) {
    return id.element;
}

/// Moves rows together to lists, of at most `most` elements each and without those that their queries leave
/// out. begin_end(i) says where row i stands; it is called in the order of the rows, before list i is
/// written.
template <std::floating_point T, class Id, class Row>
void pack_rows(NearLists<T, Id>& rows, std::size_t count, std::size_t most, const LeaveOut& leave_out,
               Row begin_end) {
    rows.offsets.resize(count + 1);
    std::size_t* const offsets = rows.offsets.data();
    Id* const ids = rows.ids.data();
    T* const distances2 = rows.distances2.data();
    std::size_t end = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const PrimitiveId without = leave_out.of(i);
        const std::size_t first = end;
        auto [k, last] = begin_end(i);
        // A row that loses nothing, and has moved nowhere, stays as it is.
        if (without == no_primitive && k == end && last - k <= most) k = end = last;
        for (; k < last && end - first < most; ++k) {
            if (element_of(ids[k]) == without) continue;
            if (end != k) ids[end] = ids[k], distances2[end] = distances2[k];
            ++end;
        }
        offsets[i + 1] = end;
    }
    offsets[0] = 0;
    rows.ids.resize(end), rows.distances2.resize(end);
}
/// Packs rows of `width` places, which end at the first without a primitive.
template <std::floating_point T, class Id>
void pack_rows_of_places(NearLists<T, Id>& rows, std::size_t count, std::size_t width, std::size_t most,
                         const LeaveOut& leave_out) {
    pack_rows(rows, count, most, leave_out, [&](std::size_t i) {
        const std::size_t first = i * width;
        std::size_t last = first + width;  // rows are full, but for a few
        while (last > first && element_of(rows.ids[last - 1]) == no_primitive) --last;
        return std::pair(first, last);
    });
}
/// Takes the elements that queries leave out from their lists.
template <std::floating_point T, class Id>
void leave_out_of(NearLists<T, Id>& lists, const LeaveOut& leave_out) {
    if (leave_out.none()) return;
    std::size_t begin = 0;
    pack_rows(lists, lists.size(), lists.count(), leave_out, [&](std::size_t i) {
        const std::size_t end = lists.offsets[i + 1];
        return std::pair(std::exchange(begin, end), end);
    });
}
/// Lists the points of a set within the options' distance of each of `points`, in the order of (distance²,
/// element), by cells that are sorted for it. Returns false, and lists nothing, where a walk may be faster,
/// and for other primitives.
template <class P, class T>
bool listed_by_cells(const P& set, const Strided<Vec<T, P::dimension>>& points, NearLists<T, IdOf<P>>& lists,
                     const PointOptions& options) {
    if constexpr (PointSet<P> && CellNeighbours<T, P::dimension>::compiled) {
        std::vector<Vec<T, P::dimension>> copies;
        if (!CellNeighbours<T, P::dimension>::within(
                points_of(set, copies), points, NearLimits<T>(options).distance2, lists, options.threads))
            return false;
        leave_out_of(lists, options.leave_out);
        return true;
    } else {
        return false;
    }
}
}  // namespace detail

/// Writes the closest point for each of `points`, as `closest_point` finds it. The points may have any layout
/// in memory (base/strided.h); a vector or a span of points will do.
template <class I, class Filter = KeepAll>
void closest_points(const I& index, const PointsOf<I>& points, std::span<NearOf<I>> found,
                    const PointOptions& options = {}, const Filter& filter = {},
                    std::span<Visits> visits = {}) {
    using T = typename I::Scalar;
    detail::expect_room("points", points.size(), found.size());
    detail::expect_visits(visits, points.size());
    options.leave_out.expect(points.size());
    constexpr bool unfiltered = std::same_as<Filter, KeepAll>;
    if constexpr (unfiltered && requires { index.closest_points_uncounted(points, found, options); })
        if (visits.empty()) return index.closest_points_uncounted(points, found, options);
    const auto one = [&](std::size_t i) {
        const NearLimits<T> limits(options, i);
        found[i] = detail::with_visits(visits, i, [&](auto& count) {
            return detail::answer_near<ClosestPoint>(index, filter_of_ray(filter, i), count, points[i],
                                                     limits);
        });
    };
    const NearLimits<T> limits(options);
    detail::ask_in_parts<ClosestPoint<typename I::Primitives>>(
        index, points, detail::executor_for<Filter>(options.threads, points.size()),
        !unfiltered || !visits.empty() || !options.leave_out.none(),
        [&](const auto& kernel, const auto& part) {
            return kernel.answer_many(index, part, limits, found.data());
        },
        one);
}
template <class I, NearFilterOf<I> Filter>
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
    detail::expect_visits(visits, points.size());
    options.leave_out.expect(points.size());
    detail::ask_each(points.size(), detail::executor_for<Filter>(options.threads, points.size()), visits,
                     [&](std::size_t i, auto& count) {
                         found[i] = detail::answer_near<FarthestPoint>(
                             index, filter_of_ray(filter, i), count, points[i],
                             NearLimits<typename I::Scalar>(options, i));
                     });
}
template <class I, NearFilterOf<I> Filter>
void farthest_points(const I& index, const PointsOf<I>& points, std::span<NearOf<I>> found,
                     const Filter& filter, std::span<Visits> visits = {}) {
    farthest_points(index, points, found, PointOptions(), filter, visits);
}

/// Writes the k nearest primitives for each of `points` to lists, as `nearest` finds them: their positions in
/// the set, or PlacedIds among instances, and their squared distances.
template <class I, class Filter = KeepAll>
void nearest(const I& index, const PointsOf<I>& points, std::size_t k, NearListsOf<I>& lists,
             const PointOptions& options = {}, const Filter& filter = {}, std::span<Visits> visits = {}) {
    using P = typename I::Primitives;
    using T = typename I::Scalar;
    detail::expect_visits(visits, points.size());
    options.leave_out.expect(points.size());
    constexpr bool unfiltered = std::same_as<Filter, KeepAll>;
    k = std::min(k, detail::primitives_in(index.primitives()));
    // A kernel leaves nothing out, so it finds one more.
    const bool one_by_one =
        !unfiltered || !visits.empty() || (Instanced<P> && !options.leave_out.none()) || k == 0;
    const std::size_t width = options.leave_out.none() ? k : k + 1;
    NearLimits<T> of_kernel(options);
    of_kernel.leave_out = no_primitive;
    detail::list_in_own_memory(lists, [&](NearListsOf<I>& rows) {
        if constexpr (unfiltered && requires { index.nearest_uncounted(points, k, rows, options); })
            if (visits.empty()) return index.nearest_uncounted(points, k, rows, options);
        rows.ids.resize(width * points.size()), rows.distances2.resize(width * points.size());
        detail::ask_in_parts<Nearest<P>>(
            index, points, detail::executor_for<Filter>(options.threads, points.size()), one_by_one,
            [&](const auto& kernel, const auto& part) {
                return kernel.answer_many(index, part, width, of_kernel, rows.ids.data(),
                                          rows.distances2.data());
            },
            [&](std::size_t i) {
                const Scratch<std::vector<NearOf<I>>> found;
                const NearLimits<T> limits(options, i);
                detail::with_visits(visits, i, [&](auto& count) {
                    return detail::nearest(index, points[i], k, *found, limits, filter_of_ray(filter, i),
                                           count);
                });
                found->resize(width);
                for (std::size_t j = 0; j < width; ++j) {
                    rows.ids[i * width + j] = Identity<P>::of((*found)[j]);
                    rows.distances2[i * width + j] = (*found)[j].distance2;
                }
            });
        detail::pack_rows_of_places(rows, points.size(), width, k, options.leave_out);
    });
}
template <class I, NearFilterOf<I> Filter>
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

/// Writes all primitives within a radius of each of `points` to lists, as `within` finds them.
///
/// Many questions among points are answered by cells that are sorted for them (ask/neighbours.h) where these
/// are faster than the index; the answers are the same.
template <class I, class Filter = KeepAll>
void within(const I& index, const PointsOf<I>& points, double radius, NearListsOf<I>& lists,
            const PointOptions& options = {}, const Filter& filter = {}, std::span<Visits> visits = {}) {
    using P = typename I::Primitives;
    using T = typename I::Scalar;
    detail::expect_visits(visits, points.size());
    options.leave_out.expect(points.size());
    const PointOptions both = detail::within_both(radius, options);
    constexpr bool unfiltered = std::same_as<Filter, KeepAll>;
    NearLimits<T> limits(both);
    limits.leave_out = no_primitive;  // they are taken from the lists
    const bool one_by_one = !unfiltered || !visits.empty();
    detail::list_in_own_memory(lists, [&](NearListsOf<I>& rows) {
        if constexpr (unfiltered && requires { index.within_uncounted(points, rows, both); })
            if (visits.empty()) return index.within_uncounted(points, rows, both);
        if (!one_by_one && detail::listed_by_cells(index.primitives(), points, rows, both)) return;
        const auto answer = [&](std::size_t begin, std::size_t end, NearListsOf<I>& to) {
            const auto part = PointBatch<T, I::dimension>(points).part(begin, end - begin);
            if (!one_by_one && detail::answered_by_kernel<Within<P>, I>([&](const auto& kernel) {
                    return kernel.answer_many(index, part, limits, to);
                }))
                return;
            const Scratch<std::vector<NearOf<I>>> found;
            for (std::size_t i = begin; i < end; ++i) {
                detail::with_visits(visits, i, [&](auto& count) {
                    return detail::within(index, points[i], *found, limits, filter_of_ray(filter, i), count);
                });
                for (const auto& near : *found) {
                    to.ids.push_back(Identity<P>::of(near));
                    to.distances2.push_back(near.distance2);
                }
                to.offsets.push_back(to.ids.size());
            }
        };
        detail::list_in_pieces(points.size(), detail::executor_for<Filter>(options.threads, points.size()),
                               rows, answer);
        detail::leave_out_of(rows, options.leave_out);
    });
}
template <class I, NearFilterOf<I> Filter>
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

}  // namespace hedgerow
