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

/// Rays on their way through layers: those that have not ended, of a piece of a batch.
template <class I, class Filter, class Pass>
class LayerWalk {
public:
    using T = typename I::Scalar;
    using Rays = RayArray<T, I::dimension>;

    /// `pass(i, ray, hit, through)` takes a layer of ray i into account and returns its opacity.
    LayerWalk(const I& index, const TransparencyOptions& options, const Filter& filter, const Pass& pass)
        : index_(index),
          o_(options),
          k_(std::clamp<std::size_t>(options.batch, 1, 256)),
          filter_(filter),
          pass_(pass) {}

    /// Follows rays `first` to `last − 1`, front to back.
    TransparencyCounts follow(const Rays& rays, std::size_t first, std::size_t last) {
        active_.clear(), rays_.clear(), after_.clear();
        for (std::size_t i = first; i < last; ++i)
            active_.push_back({i, 1.0, false}), rays_.push_back(rays[i]);
        after_.resize(active_.size());
        hits_.resize(k_ * active_.size()), found_.resize(active_.size());
        counts_ = {};
        while (!active_.empty()) {
            find_hits();
            std::size_t left = 0;
            for (std::size_t r = 0; r < active_.size(); ++r)
                if (goes_on(r)) keep(r, left++);
            active_.resize(left), rays_.resize(left), after_.resize(left);
        }
        return counts_;
    }

private:
    struct Active {
        std::size_t ray;  // its number in the batch
        double through;
        bool ended;  // and now counts what it has saved
    };

    void find_hits() {
        counts_.calls += active_.size();
        const FirstHitsColumns<T> columns{hits_, found_};
        if constexpr (std::same_as<Filter, KeepAll>) {
            first_hits(index_, rays_, k_, columns, after_, serial_executor());
        } else {
            const auto filter = [&](std::size_t r, const Hit<T>& hit) {
                return keeps(filter_, active_[r].ray, hit);
            };
            first_hits(index_, rays_, k_, columns, after_, serial_executor(), filter);
        }
    }
    /// Composites the hits that were found of a ray. Returns whether it may have more that matter.
    bool goes_on(std::size_t r) {
        Active& active = active_[r];
        const Hit<T>* const hits = &hits_[k_ * r];
        for (std::size_t j = 0; j < found_[r]; ++j) {
            if (active.ended) {
                ++counts_.saved;
                continue;
            }
            ++counts_.layers;
            const double opacity = pass_(active.ray, rays_[r], hits[j], active.through);
            active.through *= 1 - opacity;
            if (!(active.through < static_cast<double>(o_.ends_below))) continue;
            ++counts_.ended;
            active.ended = true;
            if (!o_.counts_saved) return false;
        }
        return found_[r] == k_;
    }
    /// Moves ray r to place `to` among those that go on, after its last hit.
    void keep(std::size_t r, std::size_t to) {
        after_[to] = hits_[k_ * r + k_ - 1];
        active_[to] = active_[r];
        rays_[to] = rays_[r];
    }

    const I& index_;
    const TransparencyOptions& o_;
    const std::size_t k_;
    const Filter& filter_;
    const Pass& pass_;
    std::vector<Active> active_;
    std::vector<RayOf<I>> rays_;
    std::vector<AfterHit<T>> after_;
    std::vector<Hit<T>> hits_;
    std::vector<std::uint32_t> found_;
    TransparencyCounts counts_;
};

/// Follows all rays through layers, in pieces over the executor.
template <class I, class Filter, class Pass>
TransparencyCounts follow_layers(const I& index, const RayArray<typename I::Scalar, I::dimension>& rays,
                                 const TransparencyOptions& options, Threads threads, const Filter& filter,
                                 const Pass& pass) {
    TransparencyCounts counts;
    std::mutex adding;
    executor_for<Filter>(threads, rays.size())
        .for_each_piece(rays.size(), 1024, [&](std::size_t begin, std::size_t end) {
            const auto more =
                LayerWalk<I, Filter, Pass>(index, options, filter, pass).follow(rays, begin, end);
            const std::lock_guard lock(adding);
            counts += more;
        });
    return counts;
}

}  // namespace detail

}  // namespace hedgerow
