/// Chooses kernels for the rays of a batch: packets for rays that go the same way, where packets pay, and
/// the phased batch for all others.
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
#include "packet-inl.h"
#include "picture-inl.h"
#include "reader-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Decides whether packets pay: they do where enough rays share each box that is tested. Where packets do not
// pay, they rest for a while, twice as long each time.
class PacketsPay {
public:
    bool rest(std::size_t ray) const { return ray < rest_until_; }
    // Adds the counts of more boxes and returns whether packets still pay. If not, the rest begins at `ray`.
    template <class Counts>
    bool still(const Counts& counts, std::size_t ray) {
        const double now = double(counts.rays) / double(counts.boxes);
        rays_a_box_ = rays_a_box_ == 0 ? now : (3 * rays_a_box_ + now) / 4;
        if (rays_a_box_ >= enough) {
            rest_ = shortest;
            return true;
        }
        rays_a_box_ = 0;
        rest_until_ = ray + rest_;
        rest_ = std::min(2 * rest_, longest);
        return false;
    }

private:
    // The least mean number of rays that enter a box. Rays per box predicts whether packets pay; rays per
    // leaf does not.
    static constexpr double enough = 5.5;
    // Length of a rest, in rays: it doubles from the shortest up to the longest.
    static constexpr std::size_t shortest = 1 << 12, longest = 1 << 14;

    double rays_a_box_ = 0;
    std::size_t rest_ = shortest, rest_until_ = 0;
};

template <int W, Wanted wanted, class Answer>
class ManyRays {
public:
    ManyRays(const WideScene& scene, const RayArray<float, 3>& rays, Answer* answers)
        : scene_(scene), rays_(rays), answers_(answers), packet_(scene) {}

    KernelUse answer() {
        const std::size_t n = rays_.size();
        std::size_t at = 0, waiting = 0;  // rays from `waiting` to `at` are left to the phased batch
        // Bands of 8 rows of the picture, then bands of 64 consecutive rays for what is left.
        for (const std::size_t row : {picture_row(rays_), block_side}) {
            for (const std::size_t band = block_side * row; n - at >= band; at += band) {
                if (pay_.rest(at) || !answer_band(at, row)) continue;
                answer_phased(waiting, at);
                waiting = at + band;
            }
        }
        answer_phased(waiting, n);
        return {0, n - in_packets_, in_packets_};
    }

private:
    /// Answers the rays of 8 rows from `first` on. False, and no ray is answered, if they make no packet. If
    /// a row is not a multiple of 8, the last block begins earlier, and some rays are answered twice.
    bool answer_band(std::size_t first, std::size_t row) {
        constexpr int most_ways = 4;  // of 64 rays: a picture's go four ways where two axes change sign
        const bool is_last = rays_.size() - first < 2 * block_side * (row + block_side);
        std::size_t done = 0;  // columns before this have their answers
        bool any = false;
        // Answer blocks of 8 columns by packets, while packets pay.
        for (std::size_t column = 0; column < row && pays(first); column += block_side) {
            const std::size_t from = std::min(column, row - block_side);
            std::uint32_t ways = packet_.look(rays_, first + from, row);
            // Leave blocks to the phased batch that have unusable rays, or rays that go too many ways.
            if (ways == 0 || std::popcount(ways) > most_ways) continue;
            if (!is_last) {  // prefetch the block a band later, while this packet computes
                const std::size_t then = first + block_side * (row + column);
                prefetch_rays(rays_, then, block_size);
                prefetch_all(answers_ + then, block_size);
            }
            for (; ways != 0; ways &= ways - 1)
                packet_.answer(static_cast<std::uint32_t>(std::countr_zero(ways)), answers_);
            any = true;
            // Answer the columns that were left since the packet before.
            answer_columns(first, row, done, column);
            done = from + block_side;
            in_packets_ += block_side * (done - column);
        }
        if (any) answer_columns(first, row, done, row);
        return any;
    }
    /// Answers the rays between two columns, in 8 rows, by the phased batch.
    void answer_columns(std::size_t first, std::size_t row, std::size_t begin, std::size_t end) {
        for (std::size_t r = 0; r < block_side && begin < end; ++r, first += row)
            answer_phased(first + begin, first + end);
    }
    HWY_NOINLINE void answer_phased(std::size_t begin, std::size_t end) {
        if (begin < end) Batch<W, wanted>(scene_, rays_, begin, end).answer(answers_);
    }
    bool pays(std::size_t ray) {
        // Boxes that are counted before each decision.
        constexpr std::size_t enough_boxes = 256;
        if (packet_.counts().boxes < enough_boxes) return true;
        const bool pays = pay_.still(packet_.counts(), ray);
        packet_.count_anew();
        return pays;
    }
    const WideScene& scene_;
    const RayArray<float, 3>& rays_;
    Answer* const answers_;
    Packet<W, wanted> packet_;
    PacketsPay pay_;
    std::size_t in_packets_ = 0;
};

template <int W, Wanted wanted, class Answer>
KernelUse answer_many(const WideScene& scene, const RayArray<float, 3>& rays, Answer* answers) {
    if (scene.tree.empty()) {
        std::fill_n(answers, rays.size(), Answer());
        return {0, rays.size(), 0};
    }
    return ManyRays<W, wanted, Answer>(scene, rays, answers).answer();
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
