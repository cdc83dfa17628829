/// Keeps the rays of a render, so that they can be traced again without it.
#pragma once

#include <cstddef>
#include <mutex>
#include <span>
#include <vector>

#include <hedgerow/render/tracer.h>

namespace hedgerow {

/// Passes calls on to another tracer, and keeps a copy of their rays and answers. First hits are passed on
/// alone. It takes 60 bytes a ray of float with its closest hit, 32 with its any hit, and some nanoseconds.
/// Calls may come from several threads, and are then kept in the order in which they end. Reading what was
/// kept must not overlap with calls.
template <std::floating_point T>
class RecordingTracer final : public Tracer<T> {
public:
    using typename Tracer<T>::Filter;
    using Tracer<T>::closest_hits;
    using Tracer<T>::any_hits;

    /// A call with `size` rays. They begin at ray `first` of those of its kind.
    struct Call {
        bool any = false;  ///< any hits; else closest hits
        std::size_t first = 0, size = 0;
    };
    /// Rays of one kind of call, one call after the other, with what the tracer answered.
    template <class Answer>
    struct Answered {
        std::vector<Ray<T, 3>> rays;
        std::vector<Answer> answers;
    };

    /// Borrows the tracer.
    explicit RecordingTracer(const Tracer<T>& tracer) : tracer_(tracer) {}

    const std::vector<Call>& calls() const { return calls_; }
    const Answered<Hit<T>>& closest() const { return closest_; }
    const Answered<bool>& any() const { return any_; }
    /// Forgets all that was kept. Memory stays for the next calls.
    void clear() {
        calls_.clear();
        closest_.rays.clear(), closest_.answers.clear();
        any_.rays.clear(), any_.answers.clear();
    }

    Box<T, 3> bounds() const override { return tracer_.bounds(); }
    KernelUse closest_hits(const RayArray<T, 3>& rays, std::span<Hit<T>> hits, std::span<Visits> visits,
                           const Filter& filter) const override {
        const KernelUse use = tracer_.closest_hits(rays, hits, visits, filter);
        keep(closest_, false, rays, hits);
        return use;
    }
    KernelUse any_hits(const RayArray<T, 3>& rays, std::span<bool> hits, std::span<Visits> visits,
                       const Filter& filter) const override {
        const KernelUse use = tracer_.any_hits(rays, hits, visits, filter);
        keep(any_, true, rays, hits);
        return use;
    }
    void first_hits(const RayArray<T, 3>& rays, std::size_t k, HitLists<T>& lists, const AfterHits& after,
                    const Filter& filter) const override {
        tracer_.first_hits(rays, k, lists, after, filter);
    }

private:
    template <class Answer>
    void keep(Answered<Answer>& kept, bool any, const RayArray<T, 3>& rays, std::span<Answer> answers) const {
        const std::lock_guard lock(mutex_);
        calls_.push_back({any, kept.rays.size(), rays.size()});
        for (std::size_t i = 0; i < rays.size(); ++i) kept.rays.push_back(rays[i]);
        kept.answers.insert(kept.answers.end(), answers.begin(),
                            answers.begin() + static_cast<std::ptrdiff_t>(rays.size()));
    }

    const Tracer<T>& tracer_;
    mutable std::mutex mutex_;
    mutable std::vector<Call> calls_;
    mutable Answered<Hit<T>> closest_;
    mutable Answered<bool> any_;
};

}  // namespace hedgerow
