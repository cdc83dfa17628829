/// Chooses kernels for the rays of a batch: packets for rays that go the same way and bundles for rays that
/// cross the same region, where these pay, and the phased batch for all others.
#if defined(HEDGEROW_ENGINE_MANY_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_MANY_INL_H
#undef HEDGEROW_ENGINE_MANY_INL_H
#else
#define HEDGEROW_ENGINE_MANY_INL_H
#endif

#include <algorithm>
#include <bit>

#include <hwy/highway.h>

#include "batch-inl.h"
#include "bundle-inl.h"
#include "packet-inl.h"
#include "picture-inl.h"
#include "reader-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Decides whether it pays to trace rays together: it does where enough rays share each box that is tested.
// Where it does not pay, that way of tracing rests for a while, twice as long each time.
class SharingPays {
public:
    // `enough`: the least mean number of rays that share a box. `look`: boxes that are counted before each
    // decision. `rest`: the shortest rest, in rays.
    struct Terms {
        double enough;
        std::size_t look, rest;
    };
    explicit SharingPays(const Terms& terms) : terms_(terms), rest_(terms.rest) {}

    bool rests(std::size_t ray) const { return ray < rest_until_; }
    // Whether it still pays, by the counts since the last decision, which are cleared where there is a new
    // one. If not, the rest begins at `ray`.
    template <class Rays>
    bool still(Rays& rays, std::size_t ray) {
        const auto counts = rays.counts();
        if (counts.boxes < terms_.look) return true;
        rays.count_anew();
        const double now = double(counts.rays) / double(counts.boxes);
        rays_a_box_ = rays_a_box_ == 0 ? now : (3 * rays_a_box_ + now) / 4;
        if (rays_a_box_ >= terms_.enough) {
            rest_ = terms_.rest;
            return true;
        }
        rays_a_box_ = 0;
        rest_until_ = ray + rest_;
        rest_ = std::min(2 * rest_, longest * terms_.rest);
        return false;
    }

private:
    static constexpr std::size_t longest = 4;  // times the shortest rest

    const Terms terms_;
    double rays_a_box_ = 0;
    std::size_t rest_, rest_until_ = 0;
};
// A packet counts each box that it tests with all rays. Rays per box predicts whether packets pay; rays per
// leaf does not.
inline constexpr SharingPays::Terms packets_pay = {5.5, 256, 1 << 12};
// A bundle counts each node that it opens. A short look is enough, and a long rest makes up for it.
inline constexpr SharingPays::Terms bundles_pay = {10, 64, 1 << 14};

template <int W, Wanted wanted, class Answer>
class ManyRays {
public:
    ManyRays(const WideScene& scene, const RayArray<float, 3>& rays, Answer* answers)
        : scene_(scene), rays_(rays), answers_(answers), packet_(scene), bundle_(scene) {}

    KernelUse answer() {
        const std::size_t n = rays_.size();
        std::size_t at = 0, waiting = 0;  // rays from `waiting` to `at` are left to the phased batch
        // Bands of 8 rows of the picture, then bands of 64 consecutive rays for what is left.
        for (const std::size_t row : {picture_row(rays_), block_side}) {
            for (const std::size_t band = block_side * row; n - at >= band; at += band) {
                if (packets_.rests(at) || !cast_band(at, row)) continue;
                cast_phased(waiting, at);
                waiting = at + band;
            }
        }
        cast_phased(waiting, n);
        return {0, n - in_packets_, in_packets_};
    }

private:
    /// Answers the rays of 8 rows from `first` on. False, and no ray is answered, if they make no packet. If
    /// a row is not a multiple of 8, the last block begins earlier, and some rays are answered twice.
    bool cast_band(std::size_t first, std::size_t row) {
        const bool is_last = rays_.size() - first < 2 * block_side * (row + block_side);
        std::size_t done = 0;  // columns before this have their answers
        bool any = false;
        // Answer blocks of 8 columns by packets, while packets pay.
        for (std::size_t column = 0; column < row && packets_.still(packet_, first); column += block_side) {
            const std::size_t from = std::min(column, row - block_side);
            const std::uint32_t ways = packet_.look(rays_, first + from, row);
            // Leave blocks to the phased batch that have unusable rays, or rays that share too little.
            const Shared shared = shared_by(ways, first + from);
            if (shared == Shared::nothing) continue;
            if (!is_last) {  // prefetch the block a band later, while this packet computes
                const std::size_t then = first + block_side * (row + column);
                prefetch_rays(rays_, then, block_size);
                prefetch_all(answers_ + then, block_size);
            }
            if (shared == Shared::ways)
                for (std::uint32_t left = ways; left != 0; left &= left - 1)
                    packet_.answer(static_cast<std::uint32_t>(std::countr_zero(left)), answers_);
            else if constexpr (wanted == Wanted::any)
                bundle_.answer(packet_.rays(), rays_, answers_);
            any = true;
            // Answer the columns that were left since the packet before.
            cast_columns(first, row, done, column);
            done = from + block_side;
            in_packets_ += block_side * (done - column);
        }
        if (any) cast_columns(first, row, done, row);
        return any;
    }
    /// Answers the rays between two columns, in 8 rows, by the phased batch.
    void cast_columns(std::size_t first, std::size_t row, std::size_t begin, std::size_t end) {
        for (std::size_t r = 0; r < block_side && begin < end; ++r, first += row)
            cast_phased(first + begin, first + end);
    }
    HWY_NOINLINE void cast_phased(std::size_t begin, std::size_t end) {
        if (begin < end) Batch<W, wanted>(scene_, rays_, begin, end).answer(answers_);
    }
    /// What the rays of a block share: ways, few enough for packets, or only the region that they cross.
    enum class Shared { nothing, ways, region };
    Shared shared_by(std::uint32_t ways, std::size_t ray) {
        constexpr int most_ways = 4;  // of 64 rays: a picture's go four ways where two axes change sign
        if (ways == 0) return Shared::nothing;
        if (std::popcount(ways) <= most_ways) return Shared::ways;
        const bool region = wanted == Wanted::any && !bundles_.rests(ray) && bundles_.still(bundle_, ray);
        return region ? Shared::region : Shared::nothing;
    }
    const WideScene& scene_;
    const RayArray<float, 3>& rays_;
    Answer* const answers_;
    Packet<W, wanted> packet_;
    Bundle<W> bundle_;
    SharingPays packets_{packets_pay}, bundles_{bundles_pay};
    std::size_t in_packets_ = 0;
};

template <int W, Wanted wanted, class Answer>
KernelUse cast_many(const WideScene& scene, const RayArray<float, 3>& rays, Answer* answers) {
    if (scene.tree.empty()) {
        std::fill_n(answers, rays.size(), Answer());
        return {0, rays.size(), 0};
    }
    return ManyRays<W, wanted, Answer>(scene, rays, answers).answer();
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
