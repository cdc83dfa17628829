/// Binned SAH for kd-trees (Shevtsov, Soupikov, Kapustin, EG 2007): the candidates are the borders of equal
/// bins. O(n) a level.
#pragma once

#include <hedgerow/structures/kdtree/builders/build.h>

namespace hedgerow {

/// Chooses among the borders of bins. The SAH at a border needs only how many parts begin and end in each
/// bin.
template <std::floating_point T, int D>
class KdBinnedPlanes {
public:
    using Cell = KdCell<T, D>;
    struct Lists {};

    KdBinnedPlanes(const KdCosts& costs, std::uint32_t leaf_size, int bins)
        : costs_(costs), leaf_size_(leaf_size), bins_(std::clamp(bins, 2, kd_most_bins)) {}

    Lists begin(const Cell&, Executor&) const { return {}; }
    void divide(const Lists&, const std::vector<KdPlaces>&, const Cell&, const Cell&, Lists&, Lists&) const {}

    std::optional<AxisPlane<T>> choose(const Cell& cell, const Lists&, int) const {
        if (cell.size() <= leaf_size_) return std::nullopt;
        KdBest<T> best;
        for (int axis = 0; axis < D; ++axis) try_axis(cell, axis, best);
        return if_it_pays(best, cell, costs_);
    }

private:
    void try_axis(const Cell& cell, int axis, KdBest<T>& best) const {
        // Skip an axis along which the cell is too thin for bins.
        const T low = cell.box.low[axis], width = cell.box.high[axis] - low;
        const T scale = T(bins_) / width;
        if (!(width > 0) || !(scale <= std::numeric_limits<T>::max())) return;
        std::array<std::uint32_t, kd_most_bins> begins{}, ends{};
        // A coordinate is counted in a bin before a border exactly if it lies on that side of the border. So
        // the bin is found by comparison with the borders, and the rounding of `scale` does not matter.
        const auto border = [&](int b) { return low + product(width, T(b) / T(bins_)); };
        const auto bin = [&](T x, auto beyond) {
            int b = std::clamp(static_cast<int>(std::clamp(product(x - low, scale), T(0), T(bins_ - 1))), 0,
                               bins_ - 1);
            while (b > 0 && !beyond(x, border(b))) --b;
            while (b + 1 < bins_ && beyond(x, border(b + 1))) ++b;
            return static_cast<std::size_t>(b);
        };
        // Count the parts that begin and end in each bin.
        for (const auto& r : cell.inside) {
            ++begins[bin(r.low[axis], std::greater_equal<>())];
            ++ends[bin(r.high[axis], std::greater<>())];
        }
        // Offer each border, with the numbers of parts on its sides.
        const KdAxisCosts<T, D> costs(costs_, cell.box, axis);
        std::uint32_t on_low = 0, on_high = cell.size();
        for (int b = 1; b < bins_; ++b) {
            on_low += begins[static_cast<std::size_t>(b - 1)];
            on_high -= ends[static_cast<std::size_t>(b - 1)];
            costs.offer(border(b), on_low, on_high, best);
        }
    }

    KdCosts costs_;
    std::uint32_t leaf_size_;
    int bins_;
};

}  // namespace hedgerow
