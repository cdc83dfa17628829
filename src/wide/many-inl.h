// Which kernel many rays want: packets of those that go the same way, where that pays, and the phased batch
// for all others. (Read once for each instruction set.)

// Packets pay where enough rays share each box that is looked at. Where they do not they rest for a while,
// twice as long each time.
class PacketsPay {
public:
    bool rest(std::size_t ray) const { return ray < rest_until_; }
    // After more boxes; `ray` is where the packets are.
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
    static constexpr double enough = 5.5;
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
        std::size_t at = 0, waiting = 0;  // rays from `waiting` to `at` go their own ways
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
    /// Answers the rays of 8 rows from `first` on, unless they make no packet. Where a row is not a multiple
    /// of 8, the last block begins earlier, and some rays are answered twice.
    bool answer_band(std::size_t first, std::size_t row) {
        constexpr int most_ways = 4;  // of 64 rays: a picture's go four where two axes change sign
        const bool is_last = rays_.size() - first < 2 * block_side * (row + block_side);
        std::size_t done = 0;  // columns up to here
        bool any = false;
        for (std::size_t column = 0; column < row && pays(first); column += block_side) {
            const std::size_t from = std::min(column, row - block_side);
            std::uint32_t ways = packet_.look(rays_, first + from, row);
            if (ways == 0 || std::popcount(ways) > most_ways) continue;
            if (!is_last) {  // what comes a band later, while this packet computes
                const std::size_t then = first + block_side * (row + column);
                prefetch_rays(rays_, then, block_size);
                prefetch_all(answers_ + then, block_size);
            }
            for (; ways != 0; ways &= ways - 1)
                packet_.answer(static_cast<std::uint32_t>(std::countr_zero(ways)), answers_);
            any = true;
            answer_columns(first, row, done, column);
            done = from + block_side;
            in_packets_ += block_side * (done - column);
        }
        if (any) answer_columns(first, row, done, row);
        return any;
    }
    /// Those between these columns, in 8 rows.
    void answer_columns(std::size_t first, std::size_t row, std::size_t begin, std::size_t end) {
        for (std::size_t r = 0; r < block_side && begin < end; ++r, first += row)
            answer_phased(first + begin, first + end);
    }
    HWY_NOINLINE void answer_phased(std::size_t begin, std::size_t end) {
        if (begin < end) Batch<W, wanted>(scene_, rays_, begin, end).answer(answers_);
    }
    bool pays(std::size_t ray) {
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
