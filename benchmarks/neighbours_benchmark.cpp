/// Neighbours of all points within a radius, beside a cell list that is written by hand for the processor's
/// vectors: a counting sort into dense cells, and the points of the rows around a cell measured in float to
/// each of its points. Builds included, on one thread, in turns; best times. The hand-written list knows
/// neither periods nor doubles nor far-off points, and rounds as floats do.
///
///   neighbours_benchmark [COUNT ...]     points; default 100000 1000000
#include <algorithm>
#include <cmath>
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

#include "peers/hand_written.h"
#include "sizes.h"

using namespace hedgerow;
using namespace hedgerow::measure;

namespace {

constexpr int rounds = 9;

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
    NearLists<float> lists;
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
        by_hand::HandWritten<D> cells(lists.ids.size());
        const by_hand::List list = by_hand::list_for<D>(set);
        NearLists<double> of_doubles;
        Contest contest;
        contest.add("by hand", [&] { return cells.run(sorted, radius, list); });
        contest.add("float", [&] {
            return neighbours_within(sorted, radius, lists, {.order = &order, .threads = serial_executor()}),
                   lists.count();
        });
        contest.add("double", [&] {
            return neighbours_within(doubles, double(radius), of_doubles,
                                     {.order = &order, .threads = serial_executor()}),
                   of_doubles.count();
        });
        contest.add("period", [&] {
            return neighbours_within(
                       sorted, radius, lists,
                       {.periods = periods_in_space(periods), .order = &order, .threads = serial_executor()}),
                   lists.count();
        });
        contest.add("shuffled", [&] {
            return neighbours_within(floats, radius, lists, {.order = &order, .threads = serial_executor()}),
                   lists.count();
        });
        contest.add("shuffled, caller's numbers", [&] {
            return neighbours_within(floats, radius, lists, {.threads = serial_executor()}), lists.count();
        });
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
    for (const std::size_t n : sizes_of(count, arguments, {100'000, 1'000'000})) {
        measure_points<3>(n, 1.75f), measure_points<3>(n, 2.0f), measure_points<3>(n, 2.35f);
        measure_points<2>(n, 2.6f), measure_points<2>(n, 3.0f), measure_points<2>(n, 4.2f);
    }
} catch (const std::exception& error) {
    std::fprintf(stderr, "neighbours_benchmark: %s\n", error.what());
    return 3;
}
