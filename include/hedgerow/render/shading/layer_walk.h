/// Rays that are followed through layers front to back, until hardly anything gets through: the loop that
/// transparent pictures and shadows share (transparency.h).
#pragma once

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <vector>

#include <hedgerow/ask/rays.h>

namespace hedgerow {

/// How rays are followed through layers.
struct TransparencyOptions {
    /// A ray ends where less than this share gets through. What it leaves out is less than this share of the
    /// light behind. 0 follows every ray through all layers.
    float ends_below = 1.0f / 1024;
    /// How many hits of a ray are found in a call: 1 to 256, to which others are cut. More find some in vain
    /// where a ray ends, fewer begin more walks (docs/design/038-first-hits.md).
    std::size_t batch = 8;
    /// Whether the layers behind the ends of rays are counted. They are found then, which takes the time that
    /// the ends would save.
    bool counts_saved = false;
    Threads threads = {};
};
/// What rays through layers cost.
struct TransparencyCounts {
    std::uint64_t layers = 0;  ///< shaded
    std::uint64_t saved = 0;   ///< behind the end of a ray; 0 unless TransparencyOptions::counts_saved
    std::uint64_t ended = 0;   ///< rays that ended because too little gets through
    std::uint64_t calls = 0;   ///< of first_hits for a ray

    TransparencyCounts& operator+=(const TransparencyCounts& more) {
        layers += more.layers, saved += more.saved, ended += more.ended, calls += more.calls;
        return *this;
    }
};

namespace detail {

/// Rays on their way through layers: those of a piece of a batch that have not ended. They go in waves: a
/// wave has the next layer of each of them, so that surfaces can be shaded together.
template <std::floating_point T, int D>
class LayerWalk {
public:
    /// The next layer of a ray. What shades a wave writes its opacity, 0 to 1.
    struct Step {
        std::size_t ray;  ///< its number in the batch
        Hit<T> hit;
        double through;  ///< the share of the light from here that gets through the layers before
        double opacity = 1;
    };

    explicit LayerWalk(const TransparencyOptions& options)
        : o_(options), k_(std::clamp<std::size_t>(options.batch, 1, 256)) {}

    /// Follows rays `first` to `last − 1` front to back. `find(rays, k, lists, after, number)` lists hits as
    /// the batch `first_hits` does: number(i) is the number of rays[i] in the batch. `shade(steps)` shades
    /// a wave. `known` has the first hit of each ray, or is empty.
    template <class Find, class Shade>
    TransparencyCounts follow(const RayArray<T, D>& rays, std::size_t first, std::size_t last,
                              std::span<const Hit<T>> known, const Find& find, const Shade& shade) {
        active_.clear(), rays_.clear(), after_.clear(), lists_.clear();
        for (std::size_t i = first; i < last; ++i)
            active_.push_back({i, 1.0, false}), rays_.push_back(rays[i]);
        after_.resize(active_.size());
        counts_ = {};
        std::size_t k = k_;
        if (!known.empty()) {
            k = 1;
            for (const Hit<T>& hit : known) {
                if (hit) lists_.hits.push_back(hit);
                lists_.offsets.push_back(lists_.hits.size());
            }
        }
        for (bool finds = known.empty(); !active_.empty(); finds = true, k = k_) {
            if (finds) find_hits(find);
            for (std::size_t j = 0; j < k; ++j) wave(j, shade);
            std::size_t left = 0;
            for (std::size_t r = 0; r < active_.size(); ++r)
                if (lists_[r].size() == k && (!active_[r].ended || o_.counts_saved)) keep(r, left++);
            active_.resize(left), rays_.resize(left), after_.resize(left);
        }
        return counts_;
    }

private:
    struct Active {
        std::size_t ray;  // its number in the batch
        double through;
        bool ended;
    };

    template <class Find>
    void find_hits(const Find& find) {
        counts_.calls += active_.size();
        find(RayArray<T, D>(rays_), k_, lists_, AfterHits(after_),
             [&](std::size_t r) { return active_[r].ray; });
    }
    /// Shades hit j of each ray that has it and has not ended.
    template <class Shade>
    void wave(std::size_t j, const Shade& shade) {
        steps_.clear(), places_.clear();
        for (std::size_t r = 0; r < active_.size(); ++r) {
            if (j >= lists_[r].size()) continue;
            if (active_[r].ended) {
                counts_.saved += o_.counts_saved;
                continue;
            }
            steps_.push_back({active_[r].ray, lists_[r][j], active_[r].through});
            places_.push_back(r);
        }
        if (steps_.empty()) return;
        counts_.layers += steps_.size();
        shade(std::span<Step>(steps_));
        for (std::size_t i = 0; i < steps_.size(); ++i) {
            Active& active = active_[places_[i]];
            active.through *= 1 - steps_[i].opacity;
            active.ended = active.through < static_cast<double>(o_.ends_below);
            counts_.ended += active.ended;
        }
    }
    /// Moves ray r to place `to` among those that go on, after its last hit.
    void keep(std::size_t r, std::size_t to) {
        after_[to] = lists_[r].back();
        active_[to] = active_[r];
        rays_[to] = rays_[r];
    }

    const TransparencyOptions o_;
    const std::size_t k_;
    std::vector<Active> active_;
    std::vector<Ray<T, D>> rays_;
    std::vector<AfterHit> after_;
    HitLists<T> lists_;
    std::vector<Step> steps_;
    std::vector<std::size_t> places_;  // of the steps' rays among the active
    TransparencyCounts counts_;
};

/// Follows all rays through layers, in pieces over the executor. `opacity(i, ray, hit, through)` takes a
/// layer of ray i into account and returns its opacity.
template <class I, class Filter, class OpacityOf>
TransparencyCounts follow_layers(const I& index, const RayArray<typename I::Scalar, I::dimension>& rays,
                                 const TransparencyOptions& options, const Filter& filter,
                                 const OpacityOf& opacity) {
    using Walk = LayerWalk<typename I::Scalar, I::dimension>;
    const auto find = [&](const auto& some, std::size_t k, auto& lists, const AfterHits& after,
                          const auto& number) {
        const HitsOptions alone{.after = after, .threads = serial_executor()};
        if constexpr (std::same_as<Filter, KeepAll>)
            first_hits(index, some, k, lists, alone);
        else
            first_hits(index, some, k, lists, alone,
                       [&](std::size_t r, const HitOf<I>& hit) { return keeps(filter, number(r), hit); });
    };
    const auto shade = [&](std::span<typename Walk::Step> wave) {
        for (auto& step : wave) step.opacity = opacity(step.ray, rays[step.ray], step.hit, step.through);
    };
    TransparencyCounts counts;
    std::mutex adding;
    executor_for<Filter>(options.threads, rays.size())
        .for_each_piece(rays.size(), 1024, [&](std::size_t begin, std::size_t end) {
            const auto more = Walk(options).follow(rays, begin, end, {}, find, shade);
            const std::lock_guard lock(adding);
            counts += more;
        });
    return counts;
}

}  // namespace detail

}  // namespace hedgerow
