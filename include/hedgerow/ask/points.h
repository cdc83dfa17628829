/// The questions of a point, one at a time or many in a batch: the closest point, the nearest primitives, and
/// those within a distance.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include <hedgerow/ask/asking.h>
#include <hedgerow/ask/neighbours.h>
#include <hedgerow/probes/point_batch.h>
#include <hedgerow/queries/closest_point.h>
#include <hedgerow/queries/nearest.h>
#include <hedgerow/queries/within.h>

namespace hedgerow {

template <class I>
using PointOf = Vec<typename I::Scalar, I::dimension>;
template <class I>
using NearOf = Near<typename I::Scalar, I::dimension>;

template <class I>
using NearOptionsOf = NearOptions<typename I::Scalar>;

/// The closest point of any primitive within the options' distance; a Near that is false if there is no such
/// primitive.
template <class S, class P, class Count = const NoVisits>
inline Near<typename P::Scalar, P::dimension> closest_point(
    const Index<S, P>& index, const Vec<typename P::Scalar, P::dimension>& point,
    const NearOptions<typename P::Scalar>& options = {}, Count& count = no_visits) {
    return index.template answer<ClosestPoint<P>>(count, point, options);
}
/// Writes the k nearest primitives within the options' distance to `found`, in the order of (distance²,
/// instance, element). Returns how many there are.
template <class S, class P, class Count = const NoVisits>
std::size_t nearest(const Index<S, P>& index, const Vec<typename P::Scalar, P::dimension>& point,
                    std::size_t k, std::vector<Near<typename P::Scalar, P::dimension>>& found,
                    const NearOptions<typename P::Scalar>& options = {}, Count& count = no_visits) {
    return index.template answer<Nearest<P>>(count, point, k, options, found);
}
/// Writes all primitives within the options' distance to `found`, in the order of (distance², instance,
/// element). Returns how many there are: `within(index, p, {.radius = 0.5f}, found)`.
template <class I, class Count = const NoVisits>
std::size_t within(const I& index, const PointOf<I>& point, const NearOptionsOf<I>& options,
                   std::vector<NearOf<I>>& found, Count& count = no_visits) {
    return index.template answer<Within<typename I::Primitives>>(count, point, options, found);
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
/// Answers a question Q of each of many points: by many(kernel, part), unless there is no kernel or it
/// returns false; then by one(i).
template <class Q, class S, class P, class Many, class One>
void ask_in_parts(const Index<S, P>& index, const Strided<Vec<typename P::Scalar, P::dimension>>& points,
                  Threads threads, Many many, One one) {
    for_each_part(points, index.bounds(), index.bytes(), threads.over(points.size()), [&](const auto& part) {
        if (answered_by_kernel<Q, Index<S, P>>([&](const auto& kernel) { return many(kernel, part); }))
            return;
        for (std::size_t i = 0; i < part.size(); ++i) one(part.number(i));
    });
}
}  // namespace detail

/// Writes the closest point for each of `points`, as `closest_point` finds it. The points may have any layout
/// in memory (base/strided.h); a vector or a span of points will do. Throws InputError, and writes nothing,
/// if there are fewer places for answers than points.
template <class S, class P>
void closest_points(const Index<S, P>& index, const Strided<Vec<typename P::Scalar, P::dimension>>& points,
                    std::span<Near<typename P::Scalar, P::dimension>> found, Threads threads = {},
                    const NearOptions<typename P::Scalar>& options = {}) {
    detail::expect_room("points", points.size(), found.size());
    detail::ask_in_parts<ClosestPoint<P>>(
        index, points, threads,
        [&](const auto& kernel, const auto& part) {
            return kernel.answer_many(index, part, options, found.data());
        },
        [&](std::size_t i) { found[i] = closest_point(index, points[i], options); });
}

/// The arrays of a caller in which a batch of k nearest writes its answers: k places for each point, in the
/// order of (distance², instance, element). Places beyond what is found have no primitive and an infinite
/// distance. An array that is empty is not written.
template <class P>
struct NearestColumns {
    std::span<IdOf<P>> ids;
    std::span<typename P::Scalar> distances2;
};
/// Writes the k nearest primitives for each of `points`, as `nearest` finds them: their positions in the set,
/// or PlacedIds among instances, and their squared distances. Throws InputError, and writes nothing, if an
/// array that is not empty has less room than k places for each point.
template <class S, class P>
void nearest(const Index<S, P>& index, const Strided<Vec<typename P::Scalar, P::dimension>>& points,
             std::size_t k, const NearestColumns<P>& columns, Threads threads = {},
             const NearOptions<typename P::Scalar>& options = {}) {
    using Found = Near<typename P::Scalar, P::dimension>;
    for (const std::size_t room : {columns.ids.size(), columns.distances2.size()})
        if (room > 0) detail::expect_room("places (k for each point)", k * points.size(), room);
    if (k == 0) return;
    detail::ask_in_parts<Nearest<P>>(
        index, points, threads,
        [&](const auto& kernel, const auto& part) {
            return kernel.answer_many(index, part, k, options, columns.ids.data(), columns.distances2.data());
        },
        [&](std::size_t i) {
            const Scratch<std::vector<Found>> found;
            nearest(index, points[i], k, *found, options);
            for (std::size_t j = 0; j < k; ++j) {
                const Found near = j < found->size() ? (*found)[j] : Found();
                if (!columns.ids.empty()) columns.ids[i * k + j] = Identity<P>::of(near);
                if (!columns.distances2.empty()) columns.distances2[i * k + j] = near.distance2;
            }
        });
}

/// Lists of a batch in columns: those of point i stand from offsets[i] to offsets[i + 1], in the order of
/// (distance², instance, element). The vectors are the caller's: what they hold is replaced, and their memory
/// used again.
template <class P>
struct ListColumns {
    std::vector<std::size_t> offsets;
    std::vector<IdOf<P>> ids;  ///< positions in the set, or PlacedIds among instances
    std::vector<typename P::Scalar> distances2;

    void clear() { offsets.assign(1, 0), ids.clear(), distances2.clear(); }
    /// Appends the lists of more points.
    void append(const ListColumns& more) {
        for (std::size_t i = 1; i < more.offsets.size(); ++i) offsets.push_back(ids.size() + more.offsets[i]);
        ids.insert(ids.end(), more.ids.begin(), more.ids.end());
        distances2.insert(distances2.end(), more.distances2.begin(), more.distances2.end());
    }
};

namespace detail {
/// Lists the points of a set within the options' distance of each of `points`, in the order of (distance²,
/// element), by cells that are sorted for it. Returns false, and lists nothing, where a walk may be faster.
template <PointSet P, class T>
bool listed_by_cells(const P& set, const Strided<Vec<T, P::dimension>>& points, const NearOptions<T>& options,
                     NeighbourLists<T>& lists, Threads threads) {
    if constexpr (CellNeighbours<T, P::dimension>::compiled) {
        std::vector<Vec<T, P::dimension>> copies;
        return CellNeighbours<T, P::dimension>::within(points_of(set, copies), points,
                                                       options.max_distance2(), lists, threads);
    } else {
        return false;
    }
}
}  // namespace detail

/// Writes all primitives within the options' distance of each of `points` to columns. Returns how many there
/// are in all. Over several threads the call needs the memory of the answers twice while it runs.
///
/// Many questions among points are answered by cells that are sorted for them (ask/neighbours.h) where these
/// are faster than the index; the answers are the same.
template <class S, class P>
std::size_t within(const Index<S, P>& index, const Strided<Vec<typename P::Scalar, P::dimension>>& points,
                   const NearOptions<typename P::Scalar>& options, ListColumns<P>& columns,
                   Threads threads = {}) {
    using Part = PointBatch<typename P::Scalar, P::dimension>;
    if constexpr (PointSet<P>) {
        NeighbourLists<typename P::Scalar> lists{std::move(columns.offsets), std::move(columns.ids),
                                                 std::move(columns.distances2)};
        const bool listed = detail::listed_by_cells(index.primitives(), points, options, lists, threads);
        columns = {std::move(lists.offsets), std::move(lists.ids), std::move(lists.distances2)};
        if (listed) return columns.ids.size();
    }
    const auto answer = [&](const Part& part, ListColumns<P>& to) {
        to.clear();
        if (detail::answered_by_kernel<Within<P>, Index<S, P>>([&](const auto& kernel) {
                return kernel.answer_many(index, part, options, to.offsets, to.ids, to.distances2);
            }))
            return;
        std::vector<Near<typename P::Scalar, P::dimension>> found;
        for (std::size_t i = 0; i < part.size(); ++i) {
            within(index, part[i], options, found);
            for (const auto& near : found) {
                to.ids.push_back(Identity<P>::of(near));
                to.distances2.push_back(near.distance2);
            }
            to.offsets.push_back(to.ids.size());
        }
    };
    // The executor cuts the row of pieces; the lists of each cut are joined in the order of the points.
    constexpr std::size_t piece = 256;
    std::vector<ListColumns<P>> cuts((points.size() + piece - 1) / piece);
    columns.clear();
    threads.over(points.size()).for_each_piece(cuts.size(), 1, [&](std::size_t begin, std::size_t end) {
        if (begin == end) return;
        const std::size_t first = begin * piece, last = std::min(end * piece, points.size());
        answer(Part(points).part(first, last - first), end - begin == cuts.size() ? columns : cuts[begin]);
    });
    for (const ListColumns<P>& lists : cuts) columns.append(lists);
    return columns.ids.size();
}

/// A list of primitives for each of many points (ask/asking.h).
template <class S, class P>
AnswerLists<Near<typename P::Scalar, P::dimension>> nearest(
    const Index<S, P>& index, const Strided<Vec<typename P::Scalar, P::dimension>>& points, std::size_t k,
    Threads threads = {}, const NearOptions<typename P::Scalar>& options = {}) {
    return answer_lists<Near<typename P::Scalar, P::dimension>>(
        points.size(), threads.over(points.size()),
        [&](std::size_t i, auto& found) { nearest(index, points[i], k, found, options); });
}
template <class I>
AnswerLists<NearOf<I>> within(const I& index, const Strided<PointOf<I>>& points,
                              const NearOptionsOf<I>& options, Threads threads = {}) {
    if constexpr (requires { index.primitives(); }) {
        const auto& set = index.primitives();
        NeighbourLists<typename I::Scalar> lists;
        if constexpr (PointSet<std::decay_t<decltype(set)>>)
            if (detail::listed_by_cells(set, points, options, lists, threads))
                return answer_lists<NearOf<I>>(
                    points.size(), threads.over(points.size()), [&](std::size_t i, auto& found) {
                        found.clear();
                        for (std::size_t k = lists.offsets[i]; k < lists.offsets[i + 1]; ++k)
                            found.push_back({lists.distances2[k], reported_id(set, lists.ids[k], 0),
                                             lists.ids[k], set.point(lists.ids[k])});
                    });
    }
    return answer_lists<NearOf<I>>(
        points.size(), threads.over(points.size()),
        [&](std::size_t i, auto& found) { within(index, points[i], options, found); });
}

}  // namespace hedgerow
