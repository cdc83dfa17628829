/// Neighbours of all points within a radius, beside a cell list that is written by hand for the processor's
/// vectors: a counting sort into dense cells, and the points of the rows around a cell measured in float to
/// each of its points. Builds included, on one thread, in turns; best times. The hand-written list knows
/// neither periods nor doubles nor far-off points, and rounds as floats do.
///
///   neighbours_benchmark [COUNT ...]     points; default 100000 1000000
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <hedgerow/ask/neighbours.h>
#include <hedgerow/base/error.h>
#include <hedgerow/base/instruction_set.h>
#include <hedgerow/measure/contest.h>
#include <hedgerow/measure/machine.h>
#include <hedgerow/scenes/random.h>

#include "peers/cells_by_hand.h"

using namespace hedgerow;
using namespace hedgerow::measure;

namespace {

constexpr int rounds = 9;

std::size_t list_plain_row(int dimension, const by_hand::Cells& cells, std::uint32_t i, std::uint32_t first,
                           std::uint32_t last, float radius2, std::uint32_t* to) {
    std::size_t size = 0;
    for (std::uint32_t j = first; j < last; ++j) {
        float d2 = 0;
        for (int k = 0; k < dimension; ++k) {
            const float away = cells.at[k][j] - cells.at[k][i];
            d2 += away * away;
        }
        to[size] = j;
        size += d2 <= radius2 && j != i;
    }
    return size;
}
template <int D>
std::size_t list_plain(const by_hand::Cells& cells, float radius2, std::uint32_t* offsets,
                       std::uint32_t* ids) {
    return by_hand::list(cells, radius2, offsets, ids,
                         [](auto... of_row) { return list_plain_row(D, of_row...); });
}
template <int D>
by_hand::List list_for([[maybe_unused]] std::string_view set) {
#if HEDGEROW_HAS_CELLS_BY_HAND
    if (set == "avx512") return by_hand::list_avx512<D>;
    if (set == "avx2") return by_hand::list_avx2<D>;
#endif
    return list_plain<D>;
}

/// The sort of a list by hand, and its arrays, which are used again.
template <int D>
class HandWritten {
public:
    /// Room for so many neighbours.
    explicit HandWritten(std::size_t neighbours) : ids_(neighbours + neighbours / 8 + 64) {}

    std::size_t run(const std::vector<Vec<float, D>>& points, float radius, by_hand::List list) {
        const std::size_t n = points.size();
        Vec<float, D> low = points[0], high = points[0];
        for (const auto& p : points)
            for (int k = 0; k < D; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
        by_hand::Cells cells{{}, {1, 1, 1}, nullptr};
        std::size_t all = 1;
        for (int k = 0; k < D; ++k) {
            cells.count[k] = static_cast<int>((high[k] - low[k]) / radius) + 1;
            all *= static_cast<std::size_t>(cells.count[k]);
        }
        const float per_cell = 1 / radius;
        start_.assign(all + 1, 0), cell_.resize(n), offsets_.resize(n + 1);
        for (std::size_t i = 0; i < n; ++i) {
            int c = 0;
            for (int k = D; k-- > 0;) {
                const int last = cells.count[k] - 1;
                c = c * (last + 1) + std::min(last, static_cast<int>((points[i][k] - low[k]) * per_cell));
            }
            cell_[i] = static_cast<std::uint32_t>(c);
            ++start_[static_cast<std::size_t>(c) + 1];
        }
        for (std::size_t c = 0; c < all; ++c) start_[c + 1] += start_[c];
        next_.assign(start_.begin(), start_.end() - 1);
        for (auto& row : at_) row.resize(n + 16);
        for (std::size_t i = 0; i < n; ++i) {
            const std::uint32_t to = next_[cell_[i]]++;
            for (int k = 0; k < D; ++k) at_[static_cast<std::size_t>(k)][to] = points[i][k];
        }
        for (std::size_t k = 0; k < 3; ++k) cells.at[k] = at_[k].data();
        cells.start = start_.data();
        return list(cells, radius * radius, offsets_.data(), ids_.data());
    }

private:
    std::array<std::vector<float>, 3> at_;
    std::vector<std::uint32_t> start_, cell_, next_, offsets_, ids_;
};

/// A lattice of about so many points, each moved by up to 0.3 of the spacing, in no order.
template <class T, int D>
std::vector<Vec<T, D>> jittered(std::size_t count) {
    const auto side = static_cast<std::uint64_t>(std::round(std::pow(double(count), 1.0 / D)));
    std::vector<Vec<T, D>> points;
    const std::uint64_t all = D == 2 ? side * side : side * side * side;
    for (std::uint64_t i = 0, rest = 0; i < all; ++i) {
        Random random(1, i);
        Vec<T, D> p;
        rest = i;
        for (int k = 0; k < D; ++k, rest /= side)
            p[k] = static_cast<T>(static_cast<float>(double(rest % side) + 0.6 * random.uniform()));
        points.push_back(p);
    }
    Random order(2, 0);
    for (std::size_t i = points.size(); i-- > 1;) std::swap(points[i], points[order.bits() % (i + 1)]);
    return points;
}

template <int D>
void measure_points(std::size_t count, float radius) {
    auto floats = jittered<float, D>(count);
    NeighbourLists<float> lists;
    std::vector<PrimitiveId> order;
    neighbours_within(floats, radius, lists, {.order = &order});
    auto sorted = floats;
    for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = floats[order[i]];
    std::vector<Vec<double, D>> doubles;
    Periods<D> periods;
    for (int k = 0; k < D; ++k) periods[k] = std::round(std::pow(double(count), 1.0 / D));
    for (const auto& p : sorted) doubles.push_back(Vec<double, D>(p));
    std::printf("%zu points in %s, %.1f neighbours\n", sorted.size(), D == 2 ? "the plane" : "space",
                double(lists.ids.size()) / double(sorted.size()));
    for (const auto set : instruction_sets()) {
        use_instruction_set(set);
        HandWritten<D> cells(lists.ids.size());
        const by_hand::List list = list_for<D>(set);
        NeighbourLists<double> of_doubles;
        Contest contest;
        contest.add("by hand", [&] { return cells.run(sorted, radius, list); });
        contest.add("float", [&] {
            return neighbours_within(sorted, radius, lists, {.order = &order}, serial_executor());
        });
        contest.add("double", [&] {
            return neighbours_within(doubles, double(radius), of_doubles, {.order = &order},
                                     serial_executor());
        });
        contest.add("period", [&] {
            return neighbours_within(sorted, radius, lists, {.periods = periods, .order = &order},
                                     serial_executor());
        });
        contest.add("shuffled", [&] {
            return neighbours_within(floats, radius, lists, {.order = &order}, serial_executor());
        });
        contest.add("shuffled, caller's numbers",
                    [&] { return neighbours_within(floats, radius, lists, {}, serial_executor()); });
        for (const auto& run : contest.contenders) run();
        const auto seconds =
            seconds_in_turn(rounds, contest, Clock::thread, [](const std::string&) { return true; });
        const auto best = [&](std::size_t i) {
            double least = seconds[i][0];
            for (const double s : seconds[i]) least = std::min(least, s);
            return least;
        };
        std::printf("  %-7s", std::string(set).c_str());
        for (std::size_t i = 0; i < contest.names.size(); ++i)
            std::printf(i == 0 ? " %s %.2f ms" : ", %s %.2f ms %.2f x", contest.names[i].c_str(),
                        best(i) * 1e3, best(i) / best(0));
        std::printf("\n");
    }
}

}  // namespace

int main(int count, char** arguments) try {
    std::printf(
        "%s, %s, one thread, best of %d in turns; times the hand-written list's of the same vectors\n",
        processor().c_str(), compiler().c_str(), rounds);
    std::vector<std::size_t> sizes;
    for (int i = 1; i < count; ++i) {
        const double size = std::atof(arguments[i]);
        if (!(size >= 1000 && size <= 1e8))
            throw UsageError(std::string(arguments[i]) + " is not from 1000 to 1e8");
        sizes.push_back(static_cast<std::size_t>(size));
    }
    if (sizes.empty()) sizes = {100'000, 1'000'000};
    for (const std::size_t n : sizes) {
        measure_points<3>(n, 1.75f), measure_points<3>(n, 2.0f), measure_points<3>(n, 2.35f);
        measure_points<2>(n, 2.6f), measure_points<2>(n, 3.0f), measure_points<2>(n, 4.2f);
    }
} catch (const std::exception& error) {
    std::fprintf(stderr, "neighbours_benchmark: %s\n", error.what());
    return 3;
}
