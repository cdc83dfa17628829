/// The choice of one of many by weight: cumulative sums, and a binary search in them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <hedgerow/geometry/number_lanes.h>

namespace hedgerow {

/// An entry that a random number chose. `u` is in [0, 1): the place of the number within the entry's share,
/// to be used as a new random number.
struct TableChoice {
    std::uint32_t entry;
    double probability, u;
};

/// The greatest double below 1.
inline constexpr double below_one = 1 - 0x1p-53;

/// u within [0, 1); 0 for NaN. D is double or DoubleLanes.
template <class D>
D in_unit_interval(D u) {
    return only(u > 0, lesser(u, below_one));
}

/// Replaces weights, each >= 0 and finite, by their cumulative shares: sums[i] is the share of the entries
/// before entry i. `sums` has one place more than there are entries, and the weight of entry i lies at place
/// i + 1. Returns the sum of the weights; if that is 0, all shares are 0. O(entries).
inline double accumulate_shares(std::span<double> sums) {
    sums[0] = 0;
    for (std::size_t i = 1; i < sums.size(); ++i) sums[i] += sums[i - 1];
    const double total = sums.back();
    if (total > 0)
        for (double& sum : sums) sum /= total;
    return total;
}

/// The share of an entry. `choose_entry` returns these same bits.
inline double share_of_entry(std::span<const double> sums, std::size_t entry) {
    return sums[entry + 1] - sums[entry];
}

/// An entry for each number of D, which is double or DoubleLanes, and where in [0, 1) the number lies within
/// the entry's share.
template <class D>
struct TableChoices {
    std::size_t entries[number_count<D>] = {};
    D within;
};

/// Chooses entry i where u is in [sums[i], sums[i + 1]), so never one whose share is 0; of number k of u by
/// the table sums(k). All tables have `count` entries, whose shares are not all 0. Halves the tables without
/// branches, which random numbers would make hard to predict, and side by side, since each step waits for a
/// load. O(log count).
template <class D, class Sums>
TableChoices<D> choose_entries(const Sums& sums, std::size_t count, const D& u) {
    const D place = in_unit_interval(u);
    const double* tables[number_count<D>];
    double places[number_count<D>];
    for (int k = 0; k < number_count<D>; ++k) tables[k] = sums(k), places[k] = lane(place, k);
    TableChoices<D> chosen;
    for (std::size_t left = count; left > 1;) {
        const std::size_t half = left / 2;
        for (int k = 0; k < number_count<D>; ++k)
            chosen.entries[k] += tables[k][chosen.entries[k] + half] <= places[k] ? half : 0;
        left -= half;
    }
    const D low = each_lane<D>([&](int k) { return tables[k][chosen.entries[k]]; }),
            high = each_lane<D>([&](int k) { return tables[k][chosen.entries[k] + 1]; });
    chosen.within = in_unit_interval((place - low) / (high - low));
    return chosen;
}
/// Chooses an entry of one table.
inline TableChoice choose_entry(std::span<const double> sums, double u) {
    const auto chosen = choose_entries([&](int) { return sums.data(); }, sums.size() - 1, u);
    const std::size_t entry = chosen.entries[0];
    return {static_cast<std::uint32_t>(entry), share_of_entry(sums, entry), chosen.within};
}

/// Entries with their shares. An empty table has no entry to choose.
class CumulativeTable {
public:
    CumulativeTable() = default;
    /// Weights are >= 0 and finite. Each entry has at least `least` / entries as its share, so that rounding
    /// makes none impossible. Weights that are all 0 count as equal. O(entries).
    explicit CumulativeTable(std::span<const double> weights, double least = 0x1p-20) {
        if (weights.empty()) return;
        sums_.resize(weights.size() + 1);
        double total = 0;
        for (const double w : weights) total += w;
        const double floor = total > 0 ? product(total, least / static_cast<double>(weights.size())) : 1.0;
        for (std::size_t i = 0; i < weights.size(); ++i) sums_[i + 1] = std::max(weights[i], floor);
        accumulate_shares(sums_);
    }

    std::size_t size() const { return sums_.empty() ? 0 : sums_.size() - 1; }
    bool empty() const { return sums_.empty(); }
    double probability(std::size_t entry) const { return share_of_entry(sums_, entry); }
    /// Chooses by a number in [0, 1). The table must not be empty.
    TableChoice choose(double u) const { return choose_entry(sums_, u); }

private:
    std::vector<double> sums_;
};

}  // namespace hedgerow
