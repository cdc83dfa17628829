/// Steps of a fluid: particle steps a second, and the share of them that the search of neighbours takes.
///
/// A dam breaks in space and in the plane. Its particles begin up to a fifth of a spacing off their lattice,
/// so that no distances are equal, and are timed after some steps. The search is `neighbours_within` in the
/// order of cells, of the fluid's own particles; a step searches the fluid's neighbours among the walls and
/// the walls' in the fluid too, which counts as other work. Beside it stands a cell list that is written by
/// hand for the processor's vectors: the step with that list is the step less its own search, plus the list.
///
/// A second table has the same search by other structures, builds included: `within` of all particles at
/// once, which finds the particle itself too, measures distances and sorts by them. Its shares are those of a
/// step whose other work takes as long as the flow's. Structures are of floats, of which WideBvh has a kernel
/// in space; the flow's own cells are of doubles. Brute force is timed once, and only in the plane and up to
/// 50,000 particles, since it takes 4 times as long for twice as many.
///
///   fluid_benchmark [PARTICLES ...]     default 30000
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include <hedgerow/ask/neighbours.h>
#include <hedgerow/ask/points.h>
#include <hedgerow/base/error.h>
#include <hedgerow/base/instruction_set.h>
#include <hedgerow/fluid/fluid_flow.h>
#include <hedgerow/index.h>
#include <hedgerow/measure/contest.h>
#include <hedgerow/measure/machine.h>
#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/scenes/random.h>
#include <hedgerow/structures/brute_force.h>
#include <hedgerow/structures/bvh/bvh.h>
#include <hedgerow/structures/grid/grid.h>
#include <hedgerow/structures/hash_grid/hash_grid.h>
#include <hedgerow/structures/kdtree/point_kdtree.h>

#include "peers/hand_written.h"
#include "sizes.h"

using namespace hedgerow;
using namespace hedgerow::measure;

namespace {

constexpr int rounds = 15, rounds_of_structures = 3;
constexpr int steps_before = 200;
constexpr std::size_t most_for_brute_force = 50'000;

/// Runs all contenders in turn, and returns the least seconds of each.
std::vector<double> least_seconds(int times, const Contest& contest, Clock clock) {
    std::vector<double> least;
    for (const auto& seconds :
         seconds_in_turn(times, contest, clock, [](const std::string&) { return true; }))
        least.push_back(*std::min_element(seconds.begin(), seconds.end()));
    return least;
}

/// A column of about so many particles, twice as high as wide, that has fallen for some steps in a tank three
/// times as long.
template <int D>
FluidFlow<D> broken_dam(std::size_t particles) {
    const double side = std::round(std::pow(double(particles) / 2, 1.0 / D)), spacing = 1 / side;
    Box<double, D> column, tank;
    for (int k = 0; k < D; ++k) column.low[k] = tank.low[k] = 0, column.high[k] = tank.high[k] = 1;
    column.high[1] = 2, tank.high[0] = tank.high[1] = 3;
    FluidState<D> state;
    state.places = fill_box(column, spacing);
    state.resize(state.places.size());
    for (std::size_t i = 0; i < state.size(); ++i) {
        Random random(1, i);
        for (int k = 0; k < D; ++k) state.places[i][k] += 0.2 * spacing * random.uniform(-1, 1);
    }
    FluidFlow<D> flow(std::move(state), walls_of_box(tank, spacing, BoxFaces<D>::open_above()),
                      {.spacing = spacing});
    for (int i = 0; i < steps_before; ++i) flow.step();
    return flow;
}

/// A contender that builds an index of points, and asks it for each point for those within a radius.
template <template <class, int> class S, int D>
Contender lists_by(const std::vector<Vec<float, D>>& points, float radius,
                   const typename S<float, D>::Options& options = {}) {
    return [&points, radius, options, found = std::vector<Near<float, D>>()]() mutable {
        const auto index = build<S>(PointCloudView<float, D>(points), options, serial_executor());
        std::size_t all = 0;
        for (const auto& p : points) all += within(index, p, radius, found) - 1;
        return all;
    };
}

template <int D>
class Dam {
public:
    explicit Dam(std::size_t particles)
        : flow_(broken_dam<D>(particles)),
          places_(flow_.state().places),
          radius_(2 * flow_.options().smoothing * flow_.options().spacing) {
        for (const auto& p : places_) floats_.push_back(Vec<float, D>(p));
        neighbours_within(places_, radius_, lists_, {.order = &order_, .threads = serial_executor()});
        std::printf("%zu particles in %s, %.1f neighbours, %zu particles of walls, after %d steps\n",
                    places_.size(), D == 2 ? "the plane" : "space",
                    double(lists_.count()) / double(places_.size()), flow_.walls().places.size(),
                    steps_before);
    }

    void measure_steps() {
        by_hand::HandWritten<D> cells(lists_.ids.size());
        const by_hand::List list = by_hand::list_for<D>(name_of(instruction_set()));
        auto flow = copy_of_flow(serial_executor());
        Contest contest;
        contest.add("step", [&] { return flow.step(), std::size_t(0); });
        contest.add("search", own_search());
        contest.add("by hand", [&] { return cells.run(floats_, float(radius_), list); });
        const auto least = least_seconds(rounds, contest, Clock::thread);
        const double by_hand = least[0] - least[1] + least[2];
        other_work_ = least[0] - least[1];
        std::printf("  one thread   %8.2f M particle steps/s, %.2f ms a step\n", speed(least[0]),
                    least[0] * 1e3);
        std::printf("  search       %8.2f ms, %.1f%% of a step; by hand %.2f ms, %.1f%% of a step with it\n",
                    least[1] * 1e3, 100 * least[1] / least[0], least[2] * 1e3, 100 * least[2] / by_hand);
        std::printf(
            "  same solver over the hand-written list: own step %.3f times its time, %.3f of its speed\n",
            least[0] / by_hand, by_hand / least[0]);
    }
    /// Measures wall-clock times, which other load on the machine changes.
    void measure_threads() {
        std::vector<unsigned> counts = {1, 2};
        const unsigned all = std::thread::hardware_concurrency();
        if (all > 2) counts.push_back(all);
        std::vector<FluidFlow<D>> flows;
        Contest contest;
        for (std::size_t i = 0; i < counts.size(); ++i)
            flows.push_back(copy_of_flow(i == 0 ? Threads(serial_executor()) : Threads(default_executor())));
        for (std::size_t i = 0; i < counts.size(); ++i)
            contest.add(std::to_string(counts[i]), [&flow = flows[i], threads = counts[i]] {
                const ThreadLimit limit(threads);
                return flow.step(), std::size_t(0);
            });
        const auto least = least_seconds(rounds, contest, Clock::wall);
        for (std::size_t i = 0; i < counts.size(); ++i)
            std::printf("  %2u thread%s   %8.2f M particle steps/s by the wall clock, %.2f x one\n",
                        counts[i], i == 0 ? " " : "s", speed(least[i]), least[0] / least[i]);
    }
    /// How the share of the search falls by structure.
    void measure_structures() {
        const auto radius = static_cast<float>(radius_);
        // Cells of grids are as long as the radius, which suits the search best.
        typename Grid<float, D>::Options grid;
        Box<double, D> box;
        for (const auto& p : places_) box.expand(p);
        grid.cells.density = 1 / double(places_.size());
        for (int k = 0; k < D; ++k) grid.cells.density *= box.extent()[k] / radius_;
        Contest contest;
        contest.add("hash grid", lists_by<HashGrid, D>(floats_, radius, {.cell = radius_}));
        contest.add("uniform grid", lists_by<Grid, D>(floats_, radius, grid));
        contest.add("point k-d tree", lists_by<PointKdTree, D>(floats_, radius));
        contest.add("wide BVH", lists_by<WideBvh, D>(floats_, radius));
        contest.add("cells", own_search());
        const auto least = least_seconds(rounds_of_structures, contest, Clock::thread);
        std::printf(
            "  | lists by       |         ms | of the cells | share of a step | M particle steps/s |\n"
            "  |----------------|------------|--------------|-----------------|--------------------|\n");
        const auto print = [&](const std::string& name, double seconds) {
            std::printf("  | %-14s | %10.2f | %10.1f x | %13.1f %% | %18.3f |\n", name.c_str(), seconds * 1e3,
                        seconds / least.back(), 100 * seconds / (seconds + other_work_),
                        speed(seconds + other_work_));
        };
        if (D == 2 && places_.size() <= most_for_brute_force)
            print("brute force", seconds_of(lists_by<BruteForce, D>(floats_, radius)));
        for (std::size_t i = 0; i < least.size(); ++i) print(contest.names[i], least[i]);
    }

private:
    /// A flow that goes on from where the places are.
    FluidFlow<D> copy_of_flow(Threads threads) const {
        return {flow_.state(), flow_.walls(), flow_.options(), threads};
    }
    Contender own_search() {
        return [this] {
            return neighbours_within(places_, radius_, lists_,
                                     {.order = &order_, .threads = serial_executor()}),
                   lists_.count();
        };
    }
    double speed(double seconds) const { return double(places_.size()) / seconds * 1e-6; }

    FluidFlow<D> flow_;
    std::vector<Vec<double, D>> places_;
    double radius_;
    std::vector<Vec<float, D>> floats_;
    NearLists<double> lists_;
    std::vector<PrimitiveId> order_;
    double other_work_ = 0;  // seconds of a step that are not search
};

template <int D>
void measure_dam(std::size_t particles) {
    Dam<D> dam(particles);
    dam.measure_steps();
    dam.measure_threads();
    dam.measure_structures();
}

}  // namespace

int main(int count, char** arguments) try {
    std::printf("%s, %s, %s; one thread by its processor time; best of %d in turns (structures: %d)\n",
                processor().c_str(), compiler().c_str(), std::string(name_of(instruction_set())).c_str(),
                rounds, rounds_of_structures);
    for (const std::size_t n : sizes_of(count, arguments, {30'000})) measure_dam<3>(n), measure_dam<2>(n);
} catch (const std::exception& error) {
    std::fprintf(stderr, "fluid_benchmark: %s\n", error.what());
    return 3;
}
