/// The questions of a ray, one at a time or many in a batch: closest hit, any hit, all hits, the first hits,
/// how many hits.
#pragma once

#include <atomic>
#include <span>
#include <vector>

#include <hedgerow/ask/asking.h>
#include <hedgerow/geometry/offset.h>
#include <hedgerow/probes/ray_array.h>
#include <hedgerow/queries/all_hits.h>
#include <hedgerow/queries/any_hit.h>
#include <hedgerow/queries/closest_hit.h>
#include <hedgerow/queries/filter.h>
#include <hedgerow/queries/first_hits.h>
#include <hedgerow/queries/hit_count.h>

namespace hedgerow {

template <class I>
using RayOf = Ray<typename I::Scalar, I::dimension>;
template <class I>
using HitOf = Hit<typename I::Scalar>;

// The first queries are declared inline so that an optimising compiler can inline those that `core` has
// compiled too (mesh_index.h).

/// The hit of least t in [t_min, t_max]; a Hit that is false if nothing is hit. `filter(hit)` may refuse a
/// hit; `count` may be a Visits.
template <class S, class P, class Filter = KeepAll, class Count = const NoVisits>
inline Hit<typename P::Scalar> closest_hit(const Index<S, P>& index,
                                           const Ray<typename P::Scalar, P::dimension>& ray,
                                           const Filter& filter = {}, Count& count = no_visits) {
    return index.template answer<ClosestHit<P, Filter>>(count, ray, filter);
}
/// Whether the ray hits anything in [t_min, t_max].
template <class S, class P, class Filter = KeepAll, class Count = const NoVisits>
inline bool any_hit(const Index<S, P>& index, const Ray<typename P::Scalar, P::dimension>& ray,
                    const Filter& filter = {}, Count& count = no_visits) {
    return index.template answer<AnyHit<P, Filter>>(count, ray, filter);
}
/// Writes every hit to `hits`, each primitive once, in the order of (t, instance, element). Returns how many
/// there are.
template <class S, class P, class Filter = KeepAll, class Count = const NoVisits>
std::size_t all_hits(const Index<S, P>& index, const Ray<typename P::Scalar, P::dimension>& ray,
                     std::vector<Hit<typename P::Scalar>>& hits, const Filter& filter = {},
                     Count& count = no_visits) {
    return index.template answer<AllHits<P, Filter>>(count, ray, hits, filter);
}
/// Writes the next hits to `hits`, as many as there is room for, each primitive once, in the order of (t,
/// instance, element). Returns how many there are: fewer than there is room for where the ray has no more.
/// The hits are those after a place in that order, or the first. So calls that each go on after the last hit
/// of the call before give the hits of `all_hits`, also where many have the same t:
///
///   std::array<Hit<float>, 8> some;
///   std::size_t n = first_hits(index, ray, some);
///   for (; n > 0; n = first_hits(index, ray, some, some[n - 1])) ...
///
/// `index` may be an AnyIndex too, which answers as its own function of this name does where there is no
/// filter.
template <class I, class Filter = KeepAll, class Count = const NoVisits>
std::size_t first_hits(const I& index, const RayOf<I>& ray, std::span<HitOf<I>> hits,
                       const AfterHit<typename I::Scalar>& after = {}, const Filter& filter = {},
                       Count& count = no_visits) {
    if constexpr (std::same_as<Filter, KeepAll> && std::same_as<Count, const NoVisits> &&
                  requires { index.first_hits(ray, hits, after); })
        return index.first_hits(ray, hits, after);
    else
        return index.template answer<FirstHits<typename I::Primitives, Filter>>(count, ray, hits, after,
                                                                                filter);
}
/// The number of primitives hit (two at a shared edge). Where a primitive may be offered twice, the hits are
/// first collected, in memory that the thread keeps, and repeated ones are removed.
template <class S, class P, class Filter = KeepAll, class Count = const NoVisits>
std::size_t hit_count(const Index<S, P>& index, const Ray<typename P::Scalar, P::dimension>& ray,
                      const Filter& filter = {}, Count& count = no_visits) {
    if (index.structure().exclusive() && offers_once(index.primitives())) {
        return index.template answer<HitCount<P, Filter>>(count, ray, filter);
    } else {
        const Scratch<std::vector<Hit<typename P::Scalar>>> hits;
        return all_hits(index, ray, *hits, filter, count);
    }
}

namespace detail {
/// The executor of a batch. A filter may keep state, which threads would share, so a batch with a filter
/// stays on one thread unless the caller gives an executor.
template <class Filter>
Executor& executor_for(Threads threads, std::size_t rays) {
    return threads.over(std::same_as<Filter, KeepAll> ? rays : 0);
}
/// Sets answers[i] to the answer of Q for ray i, in pieces over the executor. The kernel of Q answers a piece
/// if it takes many rays, else `one(i)` answers each ray.
template <class Q, class I, class Rays, class Answer, class Filter, class One>
KernelUse answer_rays(const I& index, const Rays& rays, std::span<Answer> answers, Threads threads,
                      const Filter& filter, One one) {
    expect_room("rays", rays.size(), answers.size());
    Executor& executor = executor_for<Filter>(threads, rays.size());
    std::atomic<std::size_t> phased{0}, packets{0};
    executor.for_each_piece(rays.size(), 4096, [&](std::size_t begin, std::size_t end) {
        const Kernel<Q, I> kernel;
        const auto some = rays.part(begin, end - begin);
        if constexpr (requires { kernel.answer_many(index, begin, some, answers.data(), filter); })
            if (kernel) {
                const KernelUse use = in_ieee_mode(
                    [&] { return kernel.answer_many(index, begin, some, answers.data() + begin, filter); });
                phased += use.phased, packets += use.packets;
                return;
            }
        for (std::size_t i = begin; i < end; ++i) answers[i] = one(i);
    });
    return {rays.size() - phased - packets, phased, packets};
}
}  // namespace detail

/// Writes the closest hit of ray i to hits[i], as `closest_hit` finds it; `any_hits` writes whether ray i
/// hits anything. Large batches are cut into pieces over all cores, unless an executor is given or there is a
/// filter (Threads). The rays may have any layout in memory (probes/ray_array.h); a vector or a span of rays
/// will do. `filter(hit)` or `filter(i, hit)`, for ray i, may refuse a hit (queries/hit.h). Throws
/// InputError, and writes nothing, if there are fewer places for answers than rays. Returns which algorithms
/// answered (walks/kernel.h): only indexes of float triangles in a WideBvh answer batches by kernels, all
/// others ray by ray.
///
///   closest_hits(index, rays, hits, default_executor());
///   closest_hits(index, rays, hits,
///                [&](std::size_t i, const Hit<float>& h) { return h.element != starts_on[i]; });
template <class S, class P, class Filter = KeepAll>
KernelUse closest_hits(const Index<S, P>& index, const RayArray<typename P::Scalar, P::dimension>& rays,
                       std::span<Hit<typename P::Scalar>> hits, Threads threads = {},
                       const Filter& filter = {}) {
    return detail::answer_rays<ClosestHit<P, Filter>>(index, rays, hits, threads, filter, [&](std::size_t i) {
        return closest_hit(index, rays[i], filter_of_ray(filter, i));
    });
}
template <class S, class P, class Filter = KeepAll>
KernelUse any_hits(const Index<S, P>& index, const RayArray<typename P::Scalar, P::dimension>& rays,
                   std::span<bool> hits, Threads threads = {}, const Filter& filter = {}) {
    return detail::answer_rays<AnyHit<P, Filter>>(index, rays, hits, threads, filter, [&](std::size_t i) {
        return any_hit(index, rays[i], filter_of_ray(filter, i));
    });
}
template <class S, class P, FilterOf<typename P::Scalar> Filter>
KernelUse closest_hits(const Index<S, P>& index, const RayArray<typename P::Scalar, P::dimension>& rays,
                       std::span<Hit<typename P::Scalar>> hits, const Filter& filter) {
    return closest_hits(index, rays, hits, Threads(), filter);
}
template <class S, class P, FilterOf<typename P::Scalar> Filter>
KernelUse any_hits(const Index<S, P>& index, const RayArray<typename P::Scalar, P::dimension>& rays,
                   std::span<bool> hits, const Filter& filter) {
    return any_hits(index, rays, hits, Threads(), filter);
}

/// A list of hits for each of many rays (ask/asking.h). A filter may also take the ray's number. Exceptions
/// of a filter reach the caller.
///
///   const auto hits = all_hits(index, rays);
///   for (const Hit<float>& hit : hits[7]) ...
template <class S, class P, class Filter = KeepAll>
AnswerLists<Hit<typename P::Scalar>> all_hits(const Index<S, P>& index,
                                              const RayArray<typename P::Scalar, P::dimension>& rays,
                                              Threads threads = {}, const Filter& filter = {}) {
    return answer_lists<Hit<typename P::Scalar>>(
        rays.size(), detail::executor_for<Filter>(threads, rays.size()),
        [&](std::size_t i, auto& hits) { all_hits(index, rays[i], hits, filter_of_ray(filter, i)); });
}
template <class S, class P, FilterOf<typename P::Scalar> Filter>
AnswerLists<Hit<typename P::Scalar>> all_hits(const Index<S, P>& index,
                                              const RayArray<typename P::Scalar, P::dimension>& rays,
                                              const Filter& filter) {
    return all_hits(index, rays, Threads(), filter);
}

/// The arrays of a caller in which a batch of first hits writes its answers: k places for each ray, of which
/// counts[i] are filled for ray i. The other places become Hits that are false. `counts` may be empty.
template <std::floating_point T>
struct FirstHitsColumns {
    std::span<Hit<T>> hits;
    std::span<std::uint32_t> counts = {};
};
/// Writes the next k hits of each ray, as `first_hits` finds them: those after after[i] for ray i, or the
/// first where `after` is empty. Throws InputError, and writes nothing, if an array that is not empty is too
/// short. Threads and filters are those of `closest_hits`.
template <class I, class Filter = KeepAll>
void first_hits(const I& index, const RayArray<typename I::Scalar, I::dimension>& rays, std::size_t k,
                const FirstHitsColumns<typename I::Scalar>& columns,
                std::span<const AfterHit<typename I::Scalar>> after = {}, Threads threads = {},
                const Filter& filter = {}) {
    if (k > 0 && columns.hits.size() / k < rays.size())
        detail::expect_room("places (k for each ray)", k * rays.size(), columns.hits.size());
    if (!columns.counts.empty()) detail::expect_room("rays", rays.size(), columns.counts.size());
    if (!after.empty() && after.size() < rays.size())
        throw InputError("there are " + std::to_string(rays.size()) + " rays, but places to go on from for " +
                         std::to_string(after.size()) + ": give one for each ray, or none");
    detail::executor_for<Filter>(threads, rays.size())
        .for_each_piece(rays.size(), 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const auto hits = columns.hits.subspan(i * k, k);
                const std::size_t found = first_hits(
                    index, rays[i], hits, after.empty() ? AfterHit<typename I::Scalar>() : after[i],
                    filter_of_ray(filter, i));
                std::fill(hits.begin() + static_cast<std::ptrdiff_t>(found), hits.end(), HitOf<I>());
                if (!columns.counts.empty()) columns.counts[i] = static_cast<std::uint32_t>(found);
            }
        });
}

template <class I, FilterOf<typename I::Scalar> Filter>
void first_hits(const I& index, const RayArray<typename I::Scalar, I::dimension>& rays, std::size_t k,
                const FirstHitsColumns<typename I::Scalar>& columns, const Filter& filter) {
    first_hits(index, rays, k, columns, {}, Threads(), filter);
}

}  // namespace hedgerow
