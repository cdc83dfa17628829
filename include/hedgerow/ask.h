/// The questions that an Index answers: a ray, a point or a box at a time, or many in a batch.
#pragma once

#include <atomic>
#include <optional>
#include <span>
#include <vector>

#include <hedgerow/geometry/offset.h>
#include <hedgerow/index.h>
#include <hedgerow/queries/all_hits.h>
#include <hedgerow/queries/answer_lists.h>
#include <hedgerow/queries/any_hit.h>
#include <hedgerow/queries/closest_hit.h>
#include <hedgerow/queries/closest_point.h>
#include <hedgerow/queries/filter.h>
#include <hedgerow/queries/hit_count.h>
#include <hedgerow/queries/nearest.h>
#include <hedgerow/queries/overlapping.h>
#include <hedgerow/ray_array.h>

namespace hedgerow {

template <class I>
using RayOf = Ray<typename I::Scalar, I::dimension>;
template <class I>
using HitOf = Hit<typename I::Scalar>;
template <class I>
using PointOf = Vec<typename I::Scalar, I::dimension>;
template <class I>
using NearOf = Near<typename I::Scalar, I::dimension>;

inline constexpr NoVisits no_visits{};

/// Whether kernels may answer for a ray: they do not count.
template <class S, class P, class Count = const NoVisits>
inline constexpr bool goes_to_kernels =
    (Index<S, P>::by_kernels || Index<S, P>::instances_by_kernels) && std::same_as<Count, const NoVisits>;

/// The hit of least t in [t_min, t_max], if any. `filter(hit)` may refuse; `count` may be a Visits.
template <class S, class P, class Filter = KeepAll, class Count = const NoVisits>
std::optional<Hit<typename P::Scalar>> closest_hit(const Index<S, P>& index,
                                                   const Ray<typename P::Scalar, P::dimension>& ray,
                                                   const Filter& filter = {}, Count& count = no_visits) {
    if constexpr (goes_to_kernels<S, P, Count>)
        if (const WideKernels* kernels = wide_kernels()) {
            const Hit<float> hit = in_ieee_mode(
                [&] { return kernels->closest(index.kernel_scene(ray, hit_filter(filter)), ray); });
            return hit ? std::optional(hit) : std::nullopt;
        }
    return index.template answer<ClosestHit<P, Filter>>(count, ray, filter);
}
/// Whether anything is hit.
template <class S, class P, class Filter = KeepAll, class Count = const NoVisits>
bool any_hit(const Index<S, P>& index, const Ray<typename P::Scalar, P::dimension>& ray,
             const Filter& filter = {}, Count& count = no_visits) {
    if constexpr (goes_to_kernels<S, P, Count>)
        if (const WideKernels* kernels = wide_kernels())
            return in_ieee_mode(
                [&] { return kernels->any(index.kernel_scene(ray, hit_filter(filter)), ray); });
    return index.template answer<AnyHit<P, Filter>>(count, ray, filter);
}
/// Every hit in the order of (t, id), each primitive once, into `hits`; returns how many.
template <class S, class P, class Filter = KeepAll, class Count = const NoVisits>
std::size_t all_hits(const Index<S, P>& index, const Ray<typename P::Scalar, P::dimension>& ray,
                     std::vector<Hit<typename P::Scalar>>& hits, const Filter& filter = {},
                     Count& count = no_visits) {
    return index.template answer<AllHits<P, Filter>>(count, ray, hits, filter);
}
/// How many primitives are hit (two at a shared edge). A structure that may offer a primitive twice has its
/// hits kept until they are told apart, in memory that the thread keeps.
template <class S, class P, class Filter = KeepAll, class Count = const NoVisits>
std::size_t hit_count(const Index<S, P>& index, const Ray<typename P::Scalar, P::dimension>& ray,
                      const Filter& filter = {}, Count& count = no_visits) {
    if (index.structure().exclusive() && offers_once(index.primitives())) {
        return index.template answer<HitCount<P, Filter>>(count, ray, filter);
    } else {
        static thread_local std::vector<Hit<typename P::Scalar>> hits;
        return all_hits(index, ray, hits, filter, count);
    }
}
/// The closest point of any primitive within a squared distance.
template <class S, class P, class Count = const NoVisits>
std::optional<Near<typename P::Scalar, P::dimension>> closest_point(
    const Index<S, P>& index, const Vec<typename P::Scalar, P::dimension>& point,
    typename P::Scalar max_distance2 = std::numeric_limits<typename P::Scalar>::max(),
    Count& count = no_visits) {
    return index.template answer<ClosestPoint<P>>(count, point, max_distance2);
}
/// The k nearest primitives within a squared distance, in the order of (distance², id), into `found`.
template <class S, class P, class Count = const NoVisits>
std::size_t nearest(const Index<S, P>& index, const Vec<typename P::Scalar, P::dimension>& point,
                    std::size_t k, std::vector<Near<typename P::Scalar, P::dimension>>& found,
                    typename P::Scalar max_distance2 = std::numeric_limits<typename P::Scalar>::max(),
                    Count& count = no_visits) {
    return index.template answer<Nearest<P>>(count, point, k, max_distance2, found);
}
/// The primitives that overlap a box, ascending, into `found`: their positions, among instances PlacedIds.
template <class S, class P, class Count = const NoVisits>
std::size_t overlapping(const Index<S, P>& index, const Box<typename P::Scalar, P::dimension>& box,
                        std::vector<IdOf<P>>& found, Count& count = no_visits) {
    return index.template answer<Overlapping<P>>(count, box, found);
}

namespace detail {
inline void expect_room(const std::string& asked, std::size_t count, std::size_t answers) {
    if (answers < count)
        throw InputError("there are " + std::to_string(count) + " " + asked + ", but room for " +
                         std::to_string(answers) + " answers: make the array of answers as long as that of " +
                         asked);
}
/// Rays `begin` to `end` of a batch by `by_kernels(kernels, scene, begin, end)` where kernels answer, else
/// `one(i, filter)` each; in pieces over the executor.
template <class S, class P, class Filter, class ByKernels, class One>
KernelUse answer_batch(const Index<S, P>& index, std::size_t count, Executor& executor, const Filter& filter,
                       ByKernels by_kernels, One one) {
    std::atomic<std::size_t> phased{0}, packets{0};
    executor.for_each_piece(count, 4096, [&](std::size_t begin, std::size_t end) {
        if constexpr (Index<S, P>::by_kernels)
            if (const WideKernels* kernels = wide_kernels()) {
                const WideScene scene = index.wide_scene(hit_filter(filter), begin);
                const KernelUse use = in_ieee_mode([&] { return by_kernels(*kernels, scene, begin, end); });
                phased += use.phased, packets += use.packets;
                return;
            }
        for (std::size_t i = begin; i < end; ++i) one(i, filter_of_ray(filter, i));
    });
    return {count - phased - packets, phased, packets};
}
}  // namespace detail

/// One answer a ray, in pieces over the executor. The rays may lie in memory as they like (ray_array.h); a
/// vector or a span of them will do. `filter(hit)` or `filter(i, hit)`, for ray i, may refuse
/// (queries/hit.h). Where nothing is hit, a Hit that is false. Throws InputError, and writes nothing, if
/// there are fewer places for answers than rays. Returns which algorithms answered
/// (structures/bvh/wide/kernels.h): other indexes than those of triangles of float in a WideBvh go ray by
/// ray.
///
///   closest_hits(index, rays, hits, default_executor());
///   closest_hits(index, rays, hits,
///                [&](std::size_t i, const Hit<float>& h) { return h.element != starts_on[i]; });
template <class S, class P, class Filter = KeepAll>
KernelUse closest_hits(const Index<S, P>& index, const RayArray<typename P::Scalar, P::dimension>& rays,
                       std::span<Hit<typename P::Scalar>> hits, Executor& executor = serial_executor(),
                       const Filter& filter = {}) {
    detail::expect_room("rays", rays.size(), hits.size());
    return detail::answer_batch(
        index, rays.size(), executor, filter,
        [&](const auto& kernels, const auto& wide, std::size_t begin, std::size_t end) {
            return kernels.closest_hits(wide, rays.part(begin, end - begin), hits.data() + begin);
        },
        [&](std::size_t i, const auto& own) {
            hits[i] = closest_hit(index, rays[i], own).value_or(Hit<typename P::Scalar>{});
        });
}
template <class S, class P, class Filter = KeepAll>
KernelUse any_hits(const Index<S, P>& index, const RayArray<typename P::Scalar, P::dimension>& rays,
                   std::span<bool> hits, Executor& executor = serial_executor(), const Filter& filter = {}) {
    detail::expect_room("rays", rays.size(), hits.size());
    return detail::answer_batch(
        index, rays.size(), executor, filter,
        [&](const auto& kernels, const auto& wide, std::size_t begin, std::size_t end) {
            return kernels.any_hits(wide, rays.part(begin, end - begin), hits.data() + begin);
        },
        [&](std::size_t i, const auto& own) { hits[i] = any_hit(index, rays[i], own); });
}
template <class S, class P, FilterOf<typename P::Scalar> Filter>
KernelUse closest_hits(const Index<S, P>& index, const RayArray<typename P::Scalar, P::dimension>& rays,
                       std::span<Hit<typename P::Scalar>> hits, const Filter& filter) {
    return closest_hits(index, rays, hits, serial_executor(), filter);
}
template <class S, class P, FilterOf<typename P::Scalar> Filter>
KernelUse any_hits(const Index<S, P>& index, const RayArray<typename P::Scalar, P::dimension>& rays,
                   std::span<bool> hits, const Filter& filter) {
    return any_hits(index, rays, hits, serial_executor(), filter);
}

/// The closest point for each of some points, as `closest_point` finds it; the element is none where nothing
/// lies within the distance. Points may lie in memory as they like (primitives/strided.h); a vector or a span
/// of them will do. Throws InputError, and writes nothing, if there are fewer places for answers.
template <class S, class P>
void closest_points(const Index<S, P>& index, const Strided<Vec<typename P::Scalar, P::dimension>>& points,
                    std::span<Near<typename P::Scalar, P::dimension>> found,
                    Executor& executor = serial_executor(),
                    typename P::Scalar max_distance2 = std::numeric_limits<typename P::Scalar>::max()) {
    detail::expect_room("points", points.size(), found.size());
    executor.for_each_piece(points.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            found[i] = closest_point(index, points[i], max_distance2)
                           .value_or(Near<typename P::Scalar, P::dimension>{});
    });
}

/// A list for each of many questions: `found[i]` is what the function of the same name finds for question i,
/// with the same limits (`max_distance2` is squared) and filters, which may take the ray's number too. What a
/// filter throws comes out. Takes the memory of all answers, up to three times while it runs. O(of each
/// question).
///
///   const auto hits = all_hits(index, rays);
///   for (const Hit<float>& hit : hits[7]) ...
template <class S, class P, class Filter = KeepAll>
AnswerLists<Hit<typename P::Scalar>> all_hits(const Index<S, P>& index,
                                              const RayArray<typename P::Scalar, P::dimension>& rays,
                                              Executor& executor = serial_executor(),
                                              const Filter& filter = {}) {
    return answer_lists<Hit<typename P::Scalar>>(rays.size(), executor, [&](std::size_t i, auto& hits) {
        all_hits(index, rays[i], hits, filter_of_ray(filter, i));
    });
}
template <class S, class P, FilterOf<typename P::Scalar> Filter>
AnswerLists<Hit<typename P::Scalar>> all_hits(const Index<S, P>& index,
                                              const RayArray<typename P::Scalar, P::dimension>& rays,
                                              const Filter& filter) {
    return all_hits(index, rays, serial_executor(), filter);
}
template <class S, class P>
AnswerLists<Near<typename P::Scalar, P::dimension>> nearest(
    const Index<S, P>& index, const Strided<Vec<typename P::Scalar, P::dimension>>& points, std::size_t k,
    Executor& executor = serial_executor(),
    typename P::Scalar max_distance2 = std::numeric_limits<typename P::Scalar>::max()) {
    return answer_lists<Near<typename P::Scalar, P::dimension>>(
        points.size(), executor,
        [&](std::size_t i, auto& found) { nearest(index, points[i], k, found, max_distance2); });
}
template <class S, class P>
AnswerLists<IdOf<P>> overlapping(const Index<S, P>& index,
                                 const Strided<Box<typename P::Scalar, P::dimension>>& boxes,
                                 Executor& executor = serial_executor()) {
    return answer_lists<IdOf<P>>(boxes.size(), executor,
                                 [&](std::size_t i, auto& found) { overlapping(index, boxes[i], found); });
}

}  // namespace hedgerow
