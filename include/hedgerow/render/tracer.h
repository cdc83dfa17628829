/// What a picture asks of a scene, whatever finds the answers: any index, instances, or another ray tracer.
#pragma once

#include <functional>
#include <span>
#include <type_traits>

#include <hedgerow/ask/rays.h>
#include <hedgerow/walks/engine.h>

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
    /// Lists the next k hits of each ray after a place, as the function of this name in ask/rays.h does.
    virtual void first_hits(const RayArray<T, 3>& rays, std::size_t k, HitLists<T>& lists,
                            const AfterHits& after, const Filter& filter) const = 0;

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
        if (filter) return hedgerow::closest_hits(index_, rays, hits, alone, filter, visits);
        return hedgerow::closest_hits(index_, rays, hits, alone, KeepAll(), visits);
    }
    KernelUse any_hits(const RayArray<T, 3>& rays, std::span<bool> hits, std::span<Visits> visits,
                       const Filter& filter) const override {
        if (filter) return hedgerow::any_hits(index_, rays, hits, alone, filter, visits);
        return hedgerow::any_hits(index_, rays, hits, alone, KeepAll(), visits);
    }
    void first_hits(const RayArray<T, 3>& rays, std::size_t k, HitLists<T>& lists, const AfterHits& after,
                    const Filter& filter) const override {
        const HitsOptions options{.after = after, .threads = serial_executor()};
        if (filter)
            hedgerow::first_hits(index_, rays, k, lists, options, filter);
        else
            hedgerow::first_hits(index_, rays, k, lists, options);
    }

private:
    inline static const RayOptions alone{.threads = serial_executor()};

    const I& index_;
};

}  // namespace hedgerow
