/// What a picture asks of a scene, whatever finds the answers: any index, instances, or another ray tracer.
#pragma once

#include <functional>
#include <span>
#include <type_traits>

#include <hedgerow/ask/rays.h>
#include <hedgerow/walks/kernel.h>

namespace hedgerow {

/// Closest, first and any hits of batches of rays. A batch is answered in the calling thread. Const use is
/// thread-safe.
template <std::floating_point T>
class Tracer {
public:
    /// May refuse hits: called with a ray's number in its batch, and a hit of it. An empty one keeps all.
    using Filter = std::function<bool(std::size_t ray, const Hit<T>& hit)>;

    virtual ~Tracer() = default;
    /// The box of all that rays may hit.
    virtual Box<T, 3> bounds() const = 0;
    /// Write one hit a ray, false where nothing is hit; whether a ray hits anything. With `visits`, add what
    /// was visited to one count a ray. Return which algorithms answered; without counts and filter these are
    /// the fastest.
    virtual KernelUse closest_hits(const RayArray<T, 3>& rays, std::span<Hit<T>> hits,
                                   std::span<Visits> visits, const Filter& filter) const = 0;
    virtual KernelUse any_hits(const RayArray<T, 3>& rays, std::span<bool> hits, std::span<Visits> visits,
                               const Filter& filter) const = 0;
    /// Writes the next k hits of each ray after a place, as the function of this name in ask/rays.h does.
    virtual void first_hits(const RayArray<T, 3>& rays, std::size_t k, const FirstHitsColumns<T>& columns,
                            std::span<const AfterHit<T>> after, const Filter& filter) const = 0;

    KernelUse closest_hits(const RayArray<T, 3>& rays, std::span<Hit<T>> hits,
                           std::span<Visits> visits = {}) const {
        return closest_hits(rays, hits, visits, {});
    }
    KernelUse any_hits(const RayArray<T, 3>& rays, std::span<bool> hits,
                       std::span<Visits> visits = {}) const {
        return any_hits(rays, hits, visits, {});
    }
};

/// The Tracer that an index is: an Index of any structure over any primitives or instances, or an AnyIndex.
/// Borrows the index.
template <class I>
class IndexTracer final : public Tracer<typename I::Scalar> {
public:
    using T = typename I::Scalar;
    using typename Tracer<T>::Filter;
    using Tracer<T>::closest_hits;
    using Tracer<T>::any_hits;

    explicit IndexTracer(const I& index) : index_(index) {}
    Box<T, 3> bounds() const override { return index_.bounds(); }
    KernelUse closest_hits(const RayArray<T, 3>& rays, std::span<Hit<T>> hits, std::span<Visits> visits,
                           const Filter& filter) const override {
        return answer<ClosestHit>(rays, hits, visits, filter, [&](const auto&... filters) {
            if constexpr (requires { index_.closest_hits(rays, hits); })
                return index_.closest_hits(rays, hits);
            else
                return hedgerow::closest_hits(index_, rays, hits, serial_executor(), filters...);
        });
    }
    KernelUse any_hits(const RayArray<T, 3>& rays, std::span<bool> hits, std::span<Visits> visits,
                       const Filter& filter) const override {
        return answer<AnyHit>(rays, hits, visits, filter, [&](const auto&... filters) {
            if constexpr (requires { index_.any_hits(rays, hits); })
                return index_.any_hits(rays, hits);
            else
                return hedgerow::any_hits(index_, rays, hits, serial_executor(), filters...);
        });
    }

    void first_hits(const RayArray<T, 3>& rays, std::size_t k, const FirstHitsColumns<T>& columns,
                    std::span<const AfterHit<T>> after, const Filter& filter) const override {
        if (filter)
            hedgerow::first_hits(index_, rays, k, columns, after, serial_executor(), filter);
        else
            hedgerow::first_hits(index_, rays, k, columns, after, serial_executor());
    }

private:
    /// Whether the index answers batches with a filter: an AnyIndex does not.
    static constexpr bool filters_batches = !requires(const I& index, const RayArray<T, 3>& rays) {
        index.closest_hits(rays, std::span<Hit<T>>());
    };

    /// Answers by `batch`, or ray by ray where that counts no visits or takes no filter.
    template <template <class, class> class Q, class Answer, class Batch>
    KernelUse answer(const RayArray<T, 3>& rays, std::span<Answer> answers, std::span<Visits> visits,
                     const Filter& filter, Batch batch) const {
        if (visits.empty() && !filter) return batch();
        if constexpr (filters_batches)
            if (visits.empty()) return batch(filter);
        const auto one = [&](std::size_t i, const auto& of_ray) {
            using OfRay = std::remove_cvref_t<decltype(of_ray)>;
            using Query = Q<typename I::Primitives, OfRay>;
            return visits.empty() ? index_.template answer<Query>(no_visits, rays[i], of_ray)
                                  : index_.template answer<Query>(visits[i], rays[i], of_ray);
        };
        for (std::size_t i = 0; i < rays.size(); ++i)
            answers[i] = filter ? one(i, filter_of_ray(filter, i)) : one(i, KeepAll());
        return {rays.size(), 0, 0};
    }

    const I& index_;
};

}  // namespace hedgerow
