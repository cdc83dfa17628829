/// Filters of batches that are called once for many answers, where a call for each would cost too much: from
/// other languages, or with data in columns. A batch is first answered without the filter; the queries whose
/// answers are refused are then asked for their next ones.
#pragma once

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include <hedgerow/ask/asking.h>
#include <hedgerow/probes/ray_array.h>
#include <hedgerow/queries/filter.h>
#include <hedgerow/queries/first_hits.h>
#include <hedgerow/queries/near_rows.h>

namespace hedgerow {

/// A filter of many hits: `filter(rays, hits, keep)` sets keep[j] to whether hits[j] counts, a hit of ray
/// rays[j] of the batch. Hits stand in the order of the rays, and `keep` is true before. The filter is called
/// by the calling thread alone, in some rounds, perhaps again for the same hit; threads that the options give
/// are those of the search. Its exceptions reach the caller, with no refused answer written.
///
///   closest_hits(index, rays, hits, [&](auto of_rays, auto found, auto keep) {
///       for (std::size_t j = 0; j < found.size(); ++j) keep[j] = opaque[found[j].element];
///   });
template <class F, class T>
concept FilterOfManyHits =
    detail::Asks<F, std::span<const std::size_t>, std::span<const Hit<T>>, std::span<bool>>;
/// A filter of many primitives that are near: `filter(points, ids, distances2, keep)`, called as one of hits
/// is. The ids are positions in the set, or PlacedIds among instances.
template <class F, class T, class Id>
concept FilterOfManyNear =
    detail::Asks<F, std::span<const std::size_t>, std::span<const Id>, std::span<const T>, std::span<bool>>;

namespace detail {

/// Which elements of lists a filter keeps. List i is that of query numbers[i].
template <class C, class Filter>
std::unique_ptr<bool[]> kept_of(const Lists<C>& lists, const std::vector<std::size_t>& numbers,
                                const Filter& filter) {
    const std::size_t count = lists.count();
    std::unique_ptr<bool[]> keep(new bool[count]);
    if (count == 0) return keep;
    std::fill_n(keep.get(), count, true);
    std::vector<std::size_t> queries;
    queries.reserve(count);
    for (std::size_t i = 0; i < lists.size(); ++i) queries.resize(lists.offsets[i + 1], numbers[i]);
    const std::span<const std::size_t> of(queries);
    const std::span<bool> kept(keep.get(), count);
    const auto all = lists.row(0, count);
    if constexpr (requires { all.ids; })
        filter(of, all.ids, all.distances2, kept);
    else
        filter(of, all, kept);
    return keep;
}
/// Leaves in lists what is kept.
template <class C>
void keep_only(Lists<C>& lists, const bool* keep) {
    const std::size_t count = lists.count();
    std::size_t end = 0, begin = 0;
    for (std::size_t i = 0; i < lists.size(); ++i) {
        const std::size_t next = lists.offsets[i + 1];
        end += static_cast<std::size_t>(std::count(keep + begin, keep + next, true));
        lists.offsets[i + 1] = end, begin = next;
    }
    C::each([&](auto column) {
        auto& all = lists.*column;
        std::size_t to = 0;
        for (std::size_t j = 0; j < count; ++j)
            if (keep[j]) all[to++] = all[j];
        all.resize(to);
    });
}
inline std::vector<std::size_t> numbers_below(std::size_t count) {
    std::vector<std::size_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), std::size_t(0));
    return numbers;
}
/// Lists for each of `count` queries what list(lists) finds and a filter of many keeps.
template <class L, class Filter, class List>
void list_kept(L& lists, std::size_t count, const Filter& filter, List list) {
    list_in_own_memory(lists, [&](L& own) {
        list(own);
        try {
            keep_only(own, kept_of(own, numbers_below(count), filter).get());
        } catch (...) {
            own.clear();
            throw;
        }
    });
}

/// Some of the queries of a batch, which are asked again: their numbers, and what they leave out and count.
struct Again {
    std::vector<std::size_t> numbers;
    std::vector<PrimitiveId> without;
    std::vector<Visits> visits;

    template <class Options>
    void set(Options& options, std::span<Visits> counts) {
        without.clear();
        if (!options.leave_out.none())
            for (const std::size_t i : numbers) without.push_back(options.leave_out.of(i));
        if (!without.empty()) options.leave_out = without;
        visits.assign(counts.empty() ? 0 : numbers.size(), {});
    }
    /// Adds what was counted to the counts of the batch.
    void add_to(std::span<Visits> counts) const {
        for (std::size_t j = 0; j < visits.size(); ++j) counts[numbers[j]] += visits[j];
    }
};

/// Writes the closest hit of each ray that a filter of many keeps: the filter is asked of the closest hits of
/// all rays, then of more and more of the next hits of those rays whose hits it refused.
template <class I, class Rays, class H, class Options, class Filter>
KernelUse closest_kept(const I& index, const Rays& rays, std::span<H> hits, const Options& options,
                       const Filter& filter, std::span<Visits> visits) {
    using T = typename I::Scalar;
    static_assert(
        !requires { filter.enters(0u); }, "a filter of many enters all instances: give a mask too");
    const KernelUse use = closest_hits(index, rays, hits, options, KeepAll(), visits);
    Again asked;
    HitLists<T> lists;
    lists.clear();
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i]) continue;
        asked.numbers.push_back(i);
        lists.hits.push_back(std::exchange(hits[i], H()));
        lists.offsets.push_back(lists.hits.size());
    }
    for (std::size_t most = 1; !asked.numbers.empty();) {
        const auto keep = kept_of(lists, asked.numbers, filter);
        std::vector<Ray<T, I::dimension>> rays_again;
        std::vector<AfterHit> after;
        std::vector<std::size_t> again;
        for (std::size_t j = 0; j < lists.size(); ++j) {
            const std::size_t i = asked.numbers[j], begin = lists.offsets[j], end = lists.offsets[j + 1];
            const auto first =
                static_cast<std::size_t>(std::find(keep.get() + begin, keep.get() + end, true) - keep.get());
            if (first < end) hits[i] = lists.hits[first];
            if (first < end || end - begin < most) continue;
            again.push_back(i), rays_again.push_back(rays[i]), after.push_back(lists.hits[end - 1]);
        }
        asked.numbers = std::move(again);
        most = std::min<std::size_t>(2 * most, 64);
        HitsOptions next{
            .after = after, .leave_out = options.leave_out, .mask = options.mask, .threads = options.threads};
        asked.set(next, visits);
        first_hits(index, rays_again, most, lists, next, KeepAll(), std::span(asked.visits));
        asked.add_to(visits);
    }
    return use;
}

/// Lists the k nearest of each point that a filter of many keeps. Points whose lists would be shorter are
/// asked for more, twice as many each round and at last for all, so many points at once that their lists stay
/// small.
template <class I, class Points, class L, class Filter>
void nearest_kept(const I& index, const Points& points, std::size_t k, L& lists, const PointOptions& options,
                  const Filter& filter, std::span<Visits> visits) {
    // Beyond `many`, lists of all that is near are found faster.
    constexpr std::size_t many = 4096, elements_at_once = 1 << 20;
    struct Place {
        std::size_t begin, size;
    };
    std::vector<Place> places(points.size());
    L settled, found;  // settled lists stand in the order in which they were found
    // Settles the lists of some points that have k kept elements, or were not cut off at `most`; adds the
    // other points to `again`.
    const auto settle = [&](const std::vector<std::size_t>& numbers, std::size_t most,
                            std::vector<std::size_t>& again) {
        std::vector<bool> cut;
        for (std::size_t j = 0; j < numbers.size(); ++j) cut.push_back(found[j].size() == most);
        keep_only(found, kept_of(found, numbers, filter).get());
        for (std::size_t j = 0; j < numbers.size(); ++j) {
            const std::size_t begin = found.offsets[j], size = found.offsets[j + 1] - begin;
            if (size < k && cut[j]) {
                again.push_back(numbers[j]);
                continue;
            }
            Place& place = places[numbers[j]] = {settled.ids.size(), std::min(k, size)};
            const auto row = found.row(begin, begin + place.size);
            settled.ids.append(row.ids), settled.distances2.append(row.distances2);
        }
    };
    std::vector<std::size_t> left;
    nearest(index, points, k, found, options, KeepAll(), visits);
    settle(numbers_below(points.size()), k, left);
    for (std::size_t most = 2 * k; !left.empty(); most *= 2) {
        const bool all = most > many;
        const std::size_t at_once =
            std::max<std::size_t>(1, elements_at_once / (all ? primitives_in(index.primitives()) : most));
        std::vector<std::size_t> again;
        for (std::size_t begin = 0; begin < left.size(); begin += at_once) {
            Again asked;
            asked.numbers.assign(
                left.begin() + static_cast<std::ptrdiff_t>(begin),
                left.begin() + static_cast<std::ptrdiff_t>(std::min(begin + at_once, left.size())));
            std::vector<Vec<typename I::Scalar, I::dimension>> some;
            for (const std::size_t i : asked.numbers) some.push_back(points[i]);
            PointOptions next = options;
            asked.set(next, visits);
            if (all)
                within(index, some, PointOptions::anywhere, found, next, KeepAll(), std::span(asked.visits));
            else
                nearest(index, some, most, found, next, KeepAll(), std::span(asked.visits));
            asked.add_to(visits);
            settle(asked.numbers, all ? std::size_t(-1) : most, again);
        }
        left = std::move(again);
    }
    list_in_own_memory(lists, [&](L& own) {
        own.clear();
        for (const Place& place : places) {
            const auto row = settled.row(place.begin, place.begin + place.size);
            own.ids.append(row.ids), own.distances2.append(row.distances2);
            own.offsets.push_back(own.ids.size());
        }
    });
}

/// Writes the closest point to each point that a filter of many keeps: the nearest primitive that it keeps,
/// and then the point on that.
template <class I, class Points, class N, class Filter>
void closest_point_kept(const I& index, const Points& points, std::span<N> found, const PointOptions& options,
                        const Filter& filter, std::span<Visits> visits) {
    using Set = Identity<typename I::Primitives>;
    NearLists<typename I::Scalar, typename Set::Type> kept;
    nearest(index, points, 1, kept, options, filter, visits);
    for (std::size_t i = 0; i < points.size(); ++i) {
        found[i] = N();
        if (kept[i].empty()) continue;
        const PointOptions there{.radius2 = static_cast<double>(kept[i].distances2[0])};
        found[i] = closest_point(index, points[i], there,
                                 [id = kept[i].ids[0]](const N& near) { return Set::of(near) == id; });
    }
}

}  // namespace detail

}  // namespace hedgerow
