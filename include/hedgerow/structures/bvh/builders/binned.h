/// Binned SAH (Wald, RT 2007): cuts the box of the centers into equal bins along each axis and considers
/// splits only at the borders of bins. O(n) a level. The number of bins shrinks with the node, as in Embree:
/// min(bins, 4 + n/20).
#pragma once

#include <algorithm>
#include <tuple>

#include <hedgerow/structures/bvh/builders/top_down.h>

namespace hedgerow {

template <std::floating_point T, int D>
class BinnedSplitter : public ReferenceSplitter<T, D> {
public:
    BinnedSplitter(ReferenceList<T, D> references, const SahOptions& options)
        : ReferenceSplitter<T, D>(std::move(references)), options_(options) {}

    bool split(const Range<T, D>& range, Range<T, D>& left, Range<T, D>& right) {
        const Binning binning = binning_of(range);
        const Bins bins = filled(binning, range);
        const Best best = cheapest(bins, range.size());
        if (best.axis < 0 || cheaper_as_leaf(range, best.cost)) return false;  // −1: all in one bin
        divide(range, binning, bins, best, left, right);
        return true;
    }

protected:
    struct Bin {
        LaneBox<T> box;
        std::uint32_t count;

        Bin() {}  // NOLINT: a node of few primitives shall not pay for bins that it does not use
        static Bin none() {
            Bin b;
            b.box = LaneBox<T>::none(), b.count = 0;
            return b;
        }
        void add(const LaneBox<T>& b, std::uint32_t n) { box.expand(b), count += n; }
    };
    struct Best {
        double cost = std::numeric_limits<double>::infinity();
        int axis = -1, border = 0;
    };
    /// The map from centers to bins.
    struct Binning {
        int count;
        Lanes<T> low, scale, last;
        T low_of[4], scale_of[4] = {};  // `low` and `scale` by axis

        Binning(const Range<T, D>& range, int most)
            : count(static_cast<int>(
                  std::min<std::uint32_t>(static_cast<std::uint32_t>(most), 4 + range.size() / 20))),
              low(range.centers2.low) {
            const Box<T, D> centers2 = range.centers2.template box<D>();
            auto& s = scale_of;
            low.store(low_of);
            for (int k = 0; k < D; ++k) {
                const T width = centers2.high[k] - centers2.low[k];
                s[k] = width > 0 ? T(count) * T(0.999) / width : T(0);
                if (!(s[k] <= std::numeric_limits<T>::max())) s[k] = T(0);  // too narrow to divide
            }
            scale = Lanes<T>::load(s);
            last = Lanes<T>::all(T(count - 1));
        }
        /// A predicate: whether a reference lies in a bin before `border`. It compares without rounding to a
        /// bin, since a border is a whole number.
        auto before(int axis, int border) const {
            return [axis, low_at = low_of[axis], scale_at = scale_of[axis], end = static_cast<T>(border)](
                       const auto& r) { return product(r.center2(axis) - low_at, scale_at) < end; };
        }
        std::array<int, 4> bin(const Reference<T, D>& r) const {
            T b[4];
            min((r.center2() - low) * scale, last).store(b);
            std::array<int, 4> result{};
            for (std::size_t k = 0; k < D; ++k) result[k] = static_cast<int>(b[k]);
            return result;
        }
    };

    Binning binning_of(const Range<T, D>& range) const {
        return Binning(range, std::clamp(options_.bins, 2, SahOptions::most_bins));
    }

    struct Bins {
        int count;  // along each axis; the places behind are not used
        Bin of[D][SahOptions::most_bins];

        explicit Bins(int bins) : count(bins) {
            for (auto& axis : of) std::fill_n(axis, count, Bin::none());
        }
        void add(const Binning& binning, const Reference<T, D>& r) {
            const auto at = binning.bin(r);
            for (int k = 0; k < D; ++k) of[k][at[static_cast<std::size_t>(k)]].add(r.lanes(), 1);
        }
        void add(const Bins& other) {
            for (int k = 0; k < D; ++k)
                for (int b = 0; b < count; ++b) of[k][b].add(other.of[k][b].box, other.of[k][b].count);
        }
    };
    /// The bins of a range. A reference that enters the bin of the one before it waits until that is written,
    /// and neighbors in the list are mostly neighbors in space: a large range fills two sets of bins in
    /// turns.
    Bins filled(const Binning& binning, const Range<T, D>& range) const {
        const Reference<T, D>* const list = this->references_.data() + range.first;
        const std::uint32_t pairs = range.size() < worth_two_sets ? 0 : range.size() / 2;
        Bins bins(binning.count);
        if (pairs > 0) {
            Bins odd(binning.count);
            for (std::uint32_t i = 0; i < pairs; ++i)
                bins.add(binning, list[2 * i]), odd.add(binning, list[2 * i + 1]);
            bins.add(odd);
        }
        for (std::uint32_t i = 2 * pairs; i < range.size(); ++i) bins.add(binning, list[i]);
        return bins;
    }
    static constexpr std::uint32_t worth_two_sets = 512;
    void divide(const Range<T, D>& range, const Binning& binning, const Bins& bins, const Best& best,
                Range<T, D>& left, Range<T, D>& right) {
        this->partition(range, left, right, binning.before(best.axis, best.border));
        std::tie(left.box, right.box) = sides(bins, best);
    }
    static std::pair<LaneBox<T>, LaneBox<T>> sides(const Bins& bins, const Best& best) {
        std::pair boxes(LaneBox<T>::none(), LaneBox<T>::none());
        for (int b = 0; b < bins.count; ++b)
            (b < best.border ? boxes.first : boxes.second).expand(bins.of[best.axis][b].box);
        return boxes;
    }
    /// Whether a leaf costs no more than a split with `cost` as its sum of area·tests over both sides.
    bool cheaper_as_leaf(const Range<T, D>& range, double cost) const {
        const double area = static_cast<double>(range.box.template half_area<D>());
        return options_.makes_leaf(range.size(), area,
                                   options_.traversal_cost * area + options_.intersection_cost * cost);
    }

    /// The split with the least sum of area·tests over both sides. Of equal ones it is the first, by axis and
    /// then by border.
    Best cheapest(const Bins& bins, std::uint32_t total) const {
        Best best;
        for (int k = 0; k < D; ++k) sweep(bins.of[k], bins.count, total, k, best);
        return best;
    }
    double cost(const LaneBox<T>& box, std::uint32_t count) const {
        return count == 0 ? 0 : static_cast<double>(box.template half_area<D>()) * options_.tests(count);
    }

private:
    void sweep(const Bin* bins, int count, std::uint32_t total, int axis, Best& best) const {
        // Compute the cost of the right side of each border, from the last border to the first.
        double right_cost[SahOptions::most_bins];
        auto box = LaneBox<T>::none();
        std::uint32_t right = 0;
        for (int b = count - 1; b > 0; --b) {
            box.expand(bins[b].box);
            right += bins[b].count;
            right_cost[b] = cost(box, right);
        }
        // Add the cost of the left side, and skip borders that have an empty side.
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
    SahOptions options_;
};

}  // namespace hedgerow
