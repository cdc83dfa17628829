/// Binned SAH (Wald, RT 2007): each axis of the centers is cut into equal bins, and only the borders of bins
/// are considered. O(n) a level. The number of bins shrinks with the node, as in Embree: min(bins, 4 + n/20).
#pragma once

#include <algorithm>

#include <hedgerow/structures/bvh/builders/top_down.h>

namespace hedgerow {

template <std::floating_point T, int D>
class BinnedSplitter : public ReferenceSplitter<T, D> {
public:
    static constexpr int max_bins = 64;

    BinnedSplitter(std::vector<Reference<T, D>> references, const SahOptions& options)
        : ReferenceSplitter<T, D>(std::move(references)), options_(options) {}

    bool split(const Range<T, D>& range, Range<T, D>& left, Range<T, D>& right) {
        const Binning binning(range, std::clamp(options_.bins, 2, max_bins));
        const Best best = cheapest(range, binning);
        if (best.axis < 0) return false;  // all centers equal
        const double area = static_cast<double>(range.box.template box<D>().half_area());
        const double split_cost = options_.traversal_cost * area + options_.intersection_cost * best.cost;
        const double leaf_cost = options_.intersection_cost * range.size() * area;
        if (leaf_cost <= split_cost && range.size() <= options_.max_leaf_size) return false;
        return this->partition(range, left, right, [&](const auto& r) {
            return binning.bin(r)[static_cast<std::size_t>(best.axis)] < best.border;
        });
    }

private:
    struct Bin {
        LaneBox<T> box;
        std::uint32_t count;

        Bin() {}  // NOLINT: a node of few primitives shall not pay for bins that it does not use
        static Bin none() {
            Bin b;
            b.box = LaneBox<T>::none(), b.count = 0;
            return b;
        }
    };
    struct Best {
        double cost = std::numeric_limits<double>::infinity();
        int axis = -1, border = 0;
    };
    /// The map from centers to bins.
    struct Binning {
        int count;
        Lanes<T> low, scale, last;

        Binning(const Range<T, D>& range, int most)
            : count(static_cast<int>(
                  std::min<std::uint32_t>(static_cast<std::uint32_t>(most), 4 + range.size() / 20))),
              low(range.centers2.low) {
            const Box<T, D> centers2 = range.centers2.template box<D>();
            T s[4] = {};
            for (int k = 0; k < D; ++k) {
                const T width = centers2.high[k] - centers2.low[k];
                s[k] = width > 0 ? T(count) * T(0.999) / width : T(0);
                if (!(s[k] <= std::numeric_limits<T>::max())) s[k] = T(0);  // too narrow to divide
            }
            scale = Lanes<T>::load(s);
            last = Lanes<T>::all(T(count - 1));
        }
        std::array<int, 4> bin(const Reference<T, D>& r) const {
            T b[4];
            min((r.center2() - low) * scale, last).store(b);
            std::array<int, 4> result{};
            for (std::size_t k = 0; k < D; ++k) result[k] = static_cast<int>(b[k]);
            return result;
        }
    };

    /// The sum of area·count over both sides, at its least. Of equal costs the first axis and border.
    Best cheapest(const Range<T, D>& range, const Binning& binning) {
        Bin bins[D][max_bins];
        for (auto& axis : bins) std::fill_n(axis, binning.count, Bin::none());
        for (std::uint32_t i = range.first; i < range.last; ++i) {
            const auto& r = this->references_[i];
            const auto at = binning.bin(r);
            for (int k = 0; k < D; ++k) {
                Bin& bin = bins[k][at[static_cast<std::size_t>(k)]];
                bin.box.expand(r.lanes());
                ++bin.count;
            }
        }
        Best best;
        for (int k = 0; k < D; ++k) sweep(bins[k], binning.count, range.size(), k, best);
        return best;
    }
    static void sweep(const Bin* bins, int count, std::uint32_t total, int axis, Best& best) {
        double right_cost[max_bins];
        auto box = LaneBox<T>::none();
        std::uint32_t right = 0;
        for (int b = count - 1; b > 0; --b) {
            box.expand(bins[b].box);
            right += bins[b].count;
            right_cost[b] = cost(box, right);
        }
        box = LaneBox<T>::none();
        std::uint32_t left = 0;
        for (int b = 1; b < count; ++b) {
            box.expand(bins[b - 1].box);
            left += bins[b - 1].count;
            if (left == 0 || left == total) continue;
            const double c = cost(box, left) + right_cost[b];
            if (c < best.cost) best = {c, axis, b};
        }
    }
    static double cost(const LaneBox<T>& box, std::uint32_t count) {
        return static_cast<double>(box.template box<D>().half_area()) * count;
    }

    SahOptions options_;
};

}  // namespace hedgerow
