/// The questions of a ray, one at a time or many in a batch: closest hit, any hit, all hits, the first hits,
/// how many hits. ask/asking.h tells what all questions share.
#pragma once

#include <span>
#include <vector>

#include <hedgerow/ask/asking.h>
#include <hedgerow/ask/many.h>
#include <hedgerow/ask/truths.h>
#include <hedgerow/geometry/offset.h>
#include <hedgerow/probes/ray_array.h>
#include <hedgerow/queries/all_hits.h>
#include <hedgerow/queries/any_hit.h>
#include <hedgerow/queries/closest_hit.h>
#include <hedgerow/queries/filter.h>
#include <hedgerow/queries/first_hits.h>
#include <hedgerow/queries/hit_count.h>
#include <hedgerow/queries/last_hit.h>

namespace hedgerow {

template <class I>
using RayOf = Ray<typename I::Scalar, I::dimension>;
template <class I>
using RaysOf = RayArray<typename I::Scalar, I::dimension>;
template <class I>
using HitOf = Hit<typename I::Scalar>;
template <class I>
using HitListsOf = HitLists<typename I::Scalar>;

/// A filter of hits, asked of each or of many (ask/many.h).
template <class F, class T>
concept BatchFilterOf = FilterOf<F, T> || FilterOfManyHits<F, T>;

namespace detail {
/// A filter that refuses what the options do, of one type whatever the filter of the caller.
template <std::floating_point T>
struct ByOptions {
    LeaveOut leave_out;
    Mask mask;
    FunctionRef<bool(std::size_t, const Hit<T>&)> keeps;
    FunctionRef<bool(std::uint32_t)> lets_in;

    bool operator()(std::size_t ray, const Hit<T>& hit) const {
        return hit.element != leave_out.of(ray) && mask.sees(hit.element) && keeps(ray, hit);
    }
    bool enters(std::uint32_t bits) const { return mask.enters(bits) && lets_in(bits); }
};
/// Answers some queries by f(filter): that of the caller, or one that refuses what the options do too.
template <class I, class Options, class Filter, class F>
auto with_filter(const I& index, const Options& options, const Filter& filter, F f, std::size_t queries = 1) {
    using T = typename I::Scalar;
    options.leave_out.expect(queries);
    if (options.leave_out.none() && options.mask.none()) return f(filter);
    options.mask.expect(index.primitives());
    const auto keeps = [&](std::size_t ray, const Hit<T>& hit) { return hedgerow::keeps(filter, ray, hit); };
    const auto enters = [&](std::uint32_t bits) { return hedgerow::enters(filter, bits); };
    return f(ByOptions<T>{options.leave_out, options.mask, keeps, enters});
}
}  // namespace detail

// The first queries are declared inline so that an optimising compiler can inline those that `core` has
// compiled too (mesh_index.h).

/// The hit of least t in [t_min, t_max]; a Hit that is false if nothing is hit.
template <class I, FilterOf<typename I::Scalar> Filter, class Count = const NoVisits>
inline HitOf<I> closest_hit(const I& index, const RayOf<I>& ray, const Filter& filter,
                            Count& count = no_visits) {
    return index.template answer<ClosestHit<typename I::Primitives, Filter>>(count, ray, filter);
}
template <class I>
inline HitOf<I> closest_hit(const I& index, const RayOf<I>& ray) {
    return closest_hit(index, ray, KeepAll());
}
template <class I, class Filter = KeepAll, class Count = const NoVisits>
HitOf<I> closest_hit(const I& index, const RayOf<I>& ray, const RayOptions& options,
                     const Filter& filter = {}, Count& count = no_visits) {
    return detail::with_filter(index, options, filter,
                               [&](const auto& all) { return closest_hit(index, ray, all, count); });
}

/// Whether the ray hits anything in [t_min, t_max].
template <class I, FilterOf<typename I::Scalar> Filter, class Count = const NoVisits>
inline bool any_hit(const I& index, const RayOf<I>& ray, const Filter& filter, Count& count = no_visits) {
    return index.template answer<AnyHit<typename I::Primitives, Filter>>(count, ray, filter);
}
template <class I>
inline bool any_hit(const I& index, const RayOf<I>& ray) {
    return any_hit(index, ray, KeepAll());
}
template <class I, class Filter = KeepAll, class Count = const NoVisits>
bool any_hit(const I& index, const RayOf<I>& ray, const RayOptions& options, const Filter& filter = {},
             Count& count = no_visits) {
    return detail::with_filter(index, options, filter,
                               [&](const auto& all) { return any_hit(index, ray, all, count); });
}

/// The hit of greatest t in [t_min, t_max]; a Hit that is false if nothing is hit.
template <class I, FilterOf<typename I::Scalar> Filter, class Count = const NoVisits>
HitOf<I> last_hit(const I& index, const RayOf<I>& ray, const Filter& filter, Count& count = no_visits) {
    return index.template answer<LastHit<typename I::Primitives, Filter>>(count, ray, filter);
}
template <class I, class Filter = KeepAll, class Count = const NoVisits>
HitOf<I> last_hit(const I& index, const RayOf<I>& ray, const RayOptions& options = {},
                  const Filter& filter = {}, Count& count = no_visits) {
    return detail::with_filter(index, options, filter,
                               [&](const auto& all) { return last_hit(index, ray, all, count); });
}

/// Writes every hit to `hits`, each primitive once, in the order of (t, instance, element). Returns how many
/// there are.
template <class I, FilterOf<typename I::Scalar> Filter, class Count = const NoVisits>
std::size_t all_hits(const I& index, const RayOf<I>& ray, std::vector<HitOf<I>>& hits, const Filter& filter,
                     Count& count = no_visits) {
    return index.template answer<AllHits<typename I::Primitives, Filter>>(count, ray, hits, filter);
}
template <class I, class Filter = KeepAll, class Count = const NoVisits>
std::size_t all_hits(const I& index, const RayOf<I>& ray, std::vector<HitOf<I>>& hits,
                     const RayOptions& options, const Filter& filter = {}, Count& count = no_visits) {
    return detail::with_filter(index, options, filter,
                               [&](const auto& all) { return all_hits(index, ray, hits, all, count); });
}
template <class I>
std::size_t all_hits(const I& index, const RayOf<I>& ray, std::vector<HitOf<I>>& hits) {
    return all_hits(index, ray, hits, KeepAll());
}
template <class I, FilterOf<typename I::Scalar> Filter>
std::vector<HitOf<I>> all_hits(const I& index, const RayOf<I>& ray, const Filter& filter) {
    std::vector<HitOf<I>> hits;
    all_hits(index, ray, hits, filter);
    return hits;
}
template <class I>
std::vector<HitOf<I>> all_hits(const I& index, const RayOf<I>& ray) {
    return all_hits(index, ray, KeepAll());
}
template <class I, class Filter = KeepAll, class Count = const NoVisits>
std::vector<HitOf<I>> all_hits(const I& index, const RayOf<I>& ray, const RayOptions& options,
                               const Filter& filter = {}, Count& count = no_visits) {
    std::vector<HitOf<I>> hits;
    all_hits(index, ray, hits, options, filter, count);
    return hits;
}

/// Writes the next hits to `hits`, as many as there is room for, each primitive once, in the order of (t,
/// instance, element). Returns how many there are: fewer than there is room for where the ray has no more.
/// The hits are those after a place in that order, or the first. So calls that each go on after the last hit
/// of the call before give the hits of `all_hits`, also where many have the same t:
///
///   std::array<Hit<float>, 8> some;
///   std::size_t n = first_hits(index, ray, some);
///   for (; n > 0; n = first_hits(index, ray, some, {.after = some[n - 1]})) ...
template <class I, class Filter = KeepAll, class Count = const NoVisits>
std::size_t first_hits(const I& index, const RayOf<I>& ray, std::span<HitOf<I>> hits,
                       const HitsOptions& options = {}, const Filter& filter = {}, Count& count = no_visits) {
    using T = typename I::Scalar;
    options.after.expect(1);
    const PlaceOfHit<T> after(options.after.of(0));
    return detail::with_filter(index, options, filter, [&](const auto& all) {
        using Query = FirstHits<typename I::Primitives, std::remove_cvref_t<decltype(all)>>;
        return index.template answer<Query>(count, ray, hits, after, all);
    });
}
template <class I, FilterOf<typename I::Scalar> Filter, class Count = const NoVisits>
std::size_t first_hits(const I& index, const RayOf<I>& ray, std::span<HitOf<I>> hits, const Filter& filter,
                       Count& count = no_visits) {
    return first_hits(index, ray, hits, HitsOptions(), filter, count);
}

/// The number of primitives hit (two at a shared edge). Where a primitive may be offered twice, the hits are
/// first collected, in memory that the thread keeps, and repeated ones are removed.
template <class I, FilterOf<typename I::Scalar> Filter, class Count = const NoVisits>
std::size_t hit_count(const I& index, const RayOf<I>& ray, const Filter& filter, Count& count = no_visits) {
    if (detail::offers_each_once(index)) {
        return index.template answer<HitCount<typename I::Primitives, Filter>>(count, ray, filter);
    } else {
        const Scratch<std::vector<HitOf<I>>> hits;
        return all_hits(index, ray, *hits, filter, count);
    }
}
template <class I>
std::size_t hit_count(const I& index, const RayOf<I>& ray) {
    return hit_count(index, ray, KeepAll());
}
template <class I, class Filter = KeepAll, class Count = const NoVisits>
std::size_t hit_count(const I& index, const RayOf<I>& ray, const RayOptions& options,
                      const Filter& filter = {}, Count& count = no_visits) {
    return detail::with_filter(index, options, filter,
                               [&](const auto& all) { return hit_count(index, ray, all, count); });
}

namespace detail {
/// What batches of rays share: calls ask(batch), with a filter that refuses what the options do too.
template <class I, class Options, class Filter, class Ask>
auto ask_rays(const I& index, const RaysOf<I>& rays, const Options& options, const Filter& filter,
              std::span<Visits> visits, Ask ask) {
    expect_visits(visits, rays.size());
    Executor& executor = executor_for<Filter>(options.threads, rays.size());
    return with_filter(
        index, options, filter,
        [&](const auto& all) {
            return ask(AskedBatch{options, all, executor, visits});
        },
        rays.size());
}
/// Sets answers[i] to the answer of Q, for ray i.
template <template <class, class> class Q, class I, class Answer, class Filter>
KernelUse answer_rays(const I& index, const RaysOf<I>& rays, Answer* answers, const RayOptions& options,
                      const Filter& filter, std::span<Visits> visits) {
    using P = typename I::Primitives;
    return ask_rays(
        index, rays, options, filter, visits, [&]<class All>(const AskedBatch<RayOptions, All>& batch) {
            return answer_batch<Q<P, All>>(index, rays, answers, batch, [&](std::size_t i, auto& count) {
                const auto of_ray = filter_of_ray(batch.filter, i);
                return index.template answer<Q<P, std::remove_const_t<decltype(of_ray)>>>(count, rays[i],
                                                                                          of_ray);
            });
        });
}
}  // namespace detail

/// Writes the closest hit of ray i to hits[i], as `closest_hit` finds it. The rays may have any layout in
/// memory (probes/ray_array.h); a vector or a span of rays will do. `filter(hit)` or `filter(i, hit)`, for
/// ray i, may refuse a hit (queries/hit.h); one of many hits may refuse some of them (ask/many.h). Returns
/// which algorithms answered (walks/engine.h): only indexes of float triangles in a WideBvh answer batches by
/// kernels, all others ray by ray.
///
///   closest_hits(index, rays, hits, {.threads = 4});
///   closest_hits(index, rays, hits,
///                [&](std::size_t i, const Hit<float>& h) { return h.element != starts_on[i]; });
template <class I, class Filter = KeepAll>
KernelUse closest_hits(const I& index, const RaysOf<I>& rays, std::span<HitOf<I>> hits,
                       const RayOptions& options = {}, const Filter& filter = {},
                       std::span<Visits> visits = {}) {
    detail::expect_room("rays", rays.size(), hits.size());
    if constexpr (FilterOfManyHits<Filter, typename I::Scalar>)
        return detail::closest_kept(index, rays, hits, options, filter, visits);
    else
        return detail::answer_rays<ClosestHit>(index, rays, hits.data(), options, filter, visits);
}
template <class I, BatchFilterOf<typename I::Scalar> Filter>
KernelUse closest_hits(const I& index, const RaysOf<I>& rays, std::span<HitOf<I>> hits, const Filter& filter,
                       std::span<Visits> visits = {}) {
    return closest_hits(index, rays, hits, RayOptions(), filter, visits);
}

/// Writes whether ray i hits anything to place i of `hits`: an array of bool or of bytes, or a
/// std::vector<bool>.
template <class I, class Filter = KeepAll>
KernelUse any_hits(const I& index, const RaysOf<I>& rays, const Truths& hits, const RayOptions& options = {},
                   const Filter& filter = {}, std::span<Visits> visits = {}) {
    detail::expect_room("rays", rays.size(), hits.size());
    return hits.written(rays.size(), [&](bool* answers) {
        if constexpr (FilterOfManyHits<Filter, typename I::Scalar>) {
            std::vector<HitOf<I>> closest(rays.size());
            const KernelUse use = closest_hits(index, rays, closest, options, filter, visits);
            for (std::size_t i = 0; i < rays.size(); ++i) answers[i] = bool(closest[i]);
            return use;
        } else {
            return detail::answer_rays<AnyHit>(index, rays, answers, options, filter, visits);
        }
    });
}
template <class I, BatchFilterOf<typename I::Scalar> Filter>
KernelUse any_hits(const I& index, const RaysOf<I>& rays, const Truths& hits, const Filter& filter,
                   std::span<Visits> visits = {}) {
    return any_hits(index, rays, hits, RayOptions(), filter, visits);
}

/// Writes the last hit of ray i to hits[i], as `last_hit` finds it.
template <class I, class Filter = KeepAll>
void last_hits(const I& index, const RaysOf<I>& rays, std::span<HitOf<I>> hits,
               const RayOptions& options = {}, const Filter& filter = {}, std::span<Visits> visits = {}) {
    detail::expect_room("rays", rays.size(), hits.size());
    detail::answer_rays<LastHit>(index, rays, hits.data(), options, filter, visits);
}
template <class I, FilterOf<typename I::Scalar> Filter>
void last_hits(const I& index, const RaysOf<I>& rays, std::span<HitOf<I>> hits, const Filter& filter,
               std::span<Visits> visits = {}) {
    last_hits(index, rays, hits, RayOptions(), filter, visits);
}

/// Writes a list of all hits for each of many rays.
///
///   const auto hits = all_hits(index, rays);
///   for (const Hit<float>& hit : hits[7]) ...
template <class I, class Filter = KeepAll>
void all_hits(const I& index, const RaysOf<I>& rays, HitListsOf<I>& lists, const RayOptions& options = {},
              const Filter& filter = {}, std::span<Visits> visits = {}) {
    if constexpr (FilterOfManyHits<Filter, typename I::Scalar>)
        return detail::list_kept(lists, rays.size(), filter, [&](HitListsOf<I>& own) {
            all_hits(index, rays, own, options, KeepAll(), visits);
        });
    else
        detail::ask_rays(
            index, rays, options, filter, visits,
            [&]<class All>(const detail::AskedBatch<RayOptions, All>& batch) {
                detail::list_batch<AllHits<typename I::Primitives, All>>(
                    index, rays, lists, batch,
                    detail::appending(&HitListsOf<I>::hits, [&](std::size_t i, auto& hits, auto& count) {
                        all_hits(index, rays[i], hits, filter_of_ray(batch.filter, i), count);
                    }));
            });
}
template <class I, BatchFilterOf<typename I::Scalar> Filter>
void all_hits(const I& index, const RaysOf<I>& rays, HitListsOf<I>& lists, const Filter& filter,
              std::span<Visits> visits = {}) {
    all_hits(index, rays, lists, RayOptions(), filter, visits);
}
template <class I, class Filter = KeepAll>
HitListsOf<I> all_hits(const I& index, const RaysOf<I>& rays, const RayOptions& options = {},
                       const Filter& filter = {}, std::span<Visits> visits = {}) {
    HitListsOf<I> lists;
    all_hits(index, rays, lists, options, filter, visits);
    return lists;
}
template <class I, BatchFilterOf<typename I::Scalar> Filter>
HitListsOf<I> all_hits(const I& index, const RaysOf<I>& rays, const Filter& filter) {
    return all_hits(index, rays, RayOptions(), filter);
}

/// Writes a list of the next k hits for each of many rays, as `first_hits` finds them: those after
/// options.after, which may have a place for each ray, or the first.
template <class I, class Filter = KeepAll>
void first_hits(const I& index, const RaysOf<I>& rays, std::size_t k, HitListsOf<I>& lists,
                const HitsOptions& options = {}, const Filter& filter = {}, std::span<Visits> visits = {}) {
    options.after.expect(rays.size());
    // A ray has no more hits than there are primitives.
    k = std::min(k, detail::primitives_in(index.primitives()));
    detail::ask_rays(index, rays, options, filter, visits,
                     [&]<class All>(const detail::AskedBatch<HitsOptions, All>& batch) {
                         detail::list_batch<FirstHits<typename I::Primitives, All>>(
                             index, rays, lists, batch,
                             [&](std::size_t i, HitListsOf<I>& to, auto& count) {
                                 const std::size_t before = to.hits.size();
                                 to.hits.resize(before + k);
                                 const std::size_t found = first_hits(
                                     index, rays[i], std::span(to.hits.data() + before, k),
                                     {.after = options.after.of(i)}, filter_of_ray(batch.filter, i), count);
                                 to.hits.resize(before + found);
                                 to.offsets.push_back(before + found);
                             },
                             k);
                     });
}
template <class I, FilterOf<typename I::Scalar> Filter>
void first_hits(const I& index, const RaysOf<I>& rays, std::size_t k, HitListsOf<I>& lists,
                const Filter& filter, std::span<Visits> visits = {}) {
    first_hits(index, rays, k, lists, HitsOptions(), filter, visits);
}
template <class I, class Filter = KeepAll>
HitListsOf<I> first_hits(const I& index, const RaysOf<I>& rays, std::size_t k,
                         const HitsOptions& options = {}, const Filter& filter = {},
                         std::span<Visits> visits = {}) {
    HitListsOf<I> lists;
    first_hits(index, rays, k, lists, options, filter, visits);
    return lists;
}

template <class I, FilterOf<typename I::Scalar> Filter>
HitListsOf<I> first_hits(const I& index, const RaysOf<I>& rays, std::size_t k, const Filter& filter) {
    return first_hits(index, rays, k, HitsOptions(), filter);
}

/// Writes the number of primitives that ray i hits to counts[i]. The filter may be one of many.
template <class I, class Filter = KeepAll>
void hit_counts(const I& index, const RaysOf<I>& rays, std::span<std::size_t> counts,
                const RayOptions& options = {}, const Filter& filter = {}, std::span<Visits> visits = {}) {
    detail::expect_room("rays", rays.size(), counts.size());
    if constexpr (FilterOfManyHits<Filter, typename I::Scalar>) {
        const auto kept = all_hits(index, rays, options, filter, visits);
        for (std::size_t i = 0; i < kept.size(); ++i) counts[i] = kept[i].size();
    } else {
        detail::ask_rays(index, rays, options, filter, visits,
                         [&]<class All>(const detail::AskedBatch<RayOptions, All>& batch) {
                             detail::answer_batch<HitCount<typename I::Primitives, All>>(
                                 index, rays, counts.data(), batch, [&](std::size_t i, auto& count) {
                                     return hit_count(index, rays[i], filter_of_ray(batch.filter, i), count);
                                 });
                         });
    }
}
template <class I, BatchFilterOf<typename I::Scalar> Filter>
void hit_counts(const I& index, const RaysOf<I>& rays, std::span<std::size_t> counts, const Filter& filter,
                std::span<Visits> visits = {}) {
    hit_counts(index, rays, counts, RayOptions(), filter, visits);
}

}  // namespace hedgerow
