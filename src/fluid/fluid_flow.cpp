#include <hedgerow/fluid/fluid_flow.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <string>
#include <utility>

#include <hedgerow/ask/neighbours.h>
#include <hedgerow/base/error.h>
#include <hedgerow/geometry/box.h>
#include <hedgerow/parallel/ieee_executor.h>
#include <hedgerow/parallel/select.h>

#include "fixed_axis.h"
#include "flow_kernels.h"
#include "neighbours/cell_lists.h"

namespace hedgerow {

namespace {

/// The kernel of Wendland at distance 0, times h^D.
template <int D>
constexpr double kernel_at_0 = D == 2 ? 7 / (4 * std::numbers::pi) : 21 / (16 * std::numbers::pi);

/// Throws UsageError unless a number is good.
void expect(bool good, const char* what, double number) {
    if (!good) throw UsageError(std::string(what) + " of a flow cannot be " + std::to_string(number));
}

template <class T>
void expect_size(const char* what, const std::vector<T>& array, std::size_t n) {
    if (array.size() != n)
        throw InputError(std::to_string(n) + " places and " + std::to_string(array.size()) + " " + what +
                         ": give one of each a particle");
}

template <int D>
void expect_finite(const char* what, const std::vector<Vec<double, D>>& places) {
    for (std::size_t i = 0; i < places.size(); ++i)
        if (!finite(places[i]))
            throw InputError(std::string(what) + " " + std::to_string(i) +
                             " has a coordinate that is NaN or infinite: leave it out");
}

}  // namespace

template <int D>
FluidOptions<D> filled_in(FluidOptions<D> o, const FluidState<D>& start, const FluidWalls<D>& walls) {
    expect_finite("particle", start.places), expect_finite("particle of the walls", walls.places);
    const auto finite = [](double x) { return std::abs(x) <= 0x1p100; };
    expect(o.spacing > 0x1p-100 && finite(o.spacing), "a spacing", o.spacing);
    expect(o.sound >= 0 && finite(o.sound), "a speed of sound", o.sound);
    expect(o.viscosity >= 0 && finite(o.viscosity), "a viscosity", o.viscosity);
    expect(o.rest_density > 0 && finite(o.rest_density), "a density", o.rest_density);
    expect(o.diffusion >= 0 && o.diffusion <= 1, "a diffusion", o.diffusion);
    for (int k = 0; k < D; ++k) expect(finite(o.gravity[k]), "a gravity", o.gravity[k]);
    if (o.smoothing == 0) o.smoothing = D == 2 ? 1.5 : 1.2;
    expect(o.smoothing >= 1 && o.smoothing <= 4, "a smoothing length in spacings", o.smoothing);
    for (int k = 0; k < D; ++k)
        expect(o.periods[k] == 0 || (o.periods[k] >= 4 * o.smoothing * o.spacing && finite(o.periods[k])),
               "a period (at least four smoothing lengths)", o.periods[k]);
    if (o.sound == 0) {
        const double g = length(o.gravity);
        expect(g > 0, "without gravity, a speed of sound", 0);
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const auto* const places : {&start.places, &walls.places})
            for (const auto& p : *places) {
                const double height = -dot(p, o.gravity) / g;
                low = std::min(low, height);
                if (places == &start.places) high = std::max(high, height);
            }
        o.sound = high > low ? 10 * std::sqrt(2 * g * (high - low)) : 10 * std::sqrt(2 * g * o.spacing);
    }
    return o;
}

/// The state of a flow, and the arrays that steps use again.
template <int D>
class FluidFlow<D>::Steps {
public:
    Steps(FluidState<D> start, FluidWalls<D> held_by, const FluidOptions<D>& given, Threads threads)
        : state(std::move(start)),
          walls(std::move(held_by)),
          options(filled_in(given, state, walls)),
          threads_(threads) {
        check();
        const FluidOptions<D>& o = options;
        h_ = o.smoothing * o.spacing;
        const double share = kernel_at_0<D> / std::pow(o.smoothing, D);
        scales_.share = static_cast<float>(share), scales_.slope = static_cast<float>(5 * share);
        // The artificial viscosity makes up for what the real one is less than.
        const double per_viscosity = 1 / (h_ * o.sound);
        scales_.viscosity = static_cast<float>(2 * o.viscosity * per_viscosity);
        scales_.artificial_viscosity = static_cast<float>(
            std::max(0.0, artificial_viscosity - 2 * (D + 2) * o.viscosity * per_viscosity));
        scales_.diffusion = static_cast<float>(2 * o.diffusion);
        scales_.guard = static_cast<float>(2 * o.smoothing / nearest_to_walls);
        for (int k = 0; k < D; ++k) {
            scales_.gravity[k] = static_cast<float>(o.gravity[k] * h_ / (o.sound * o.sound));
            axes_[static_cast<std::size_t>(k)] = detail::FixedAxis(h_, o.periods[k]);
            scales_.per_unit[k] = static_cast<float>(axes_[static_cast<std::size_t>(k)].unit() / h_);
        }
    }

    double longest_step() const {
        double fastest2 = 0;
        std::mutex joining;
        for (const auto* const all : {&state.velocities, &walls.velocities})
            threads_.over(all->size())
                .for_each_piece(all->size(), worth_a_task, [&](std::size_t begin, std::size_t end) {
                    double here = 0;
                    for (std::size_t i = begin; i < end; ++i) here = std::max(here, length2((*all)[i]));
                    const std::lock_guard lock(joining);
                    fastest2 = std::max(fastest2, here);
                });
        const double of_sound = 0.35 * h_ / (options.sound + std::sqrt(fastest2));
        return viscous() ? std::min(of_sound, 0.1 * h_ * h_ / options.viscosity) : of_sound;
    }

    void step(double dt) {
        if (state.size() > 0)
            in_ieee_mode([&] {
                IeeeExecutor executor(threads_.over(4 * state.size()));
                go_half(dt, executor);
                find_rates(executor);
                check_speeds(dt, executor);
                go_on(dt, executor);
            });
        state.time += dt;
    }

    FluidState<D> state;
    FluidWalls<D> walls;
    FluidOptions<D> options;
    std::vector<float> fills;  // of the last step, by the particles' numbers

    Threads threads() const { return threads_; }

private:
    using Order = detail::CellOrder<double, D>;
    using Rows = detail::FlowRows<D>;
    static constexpr double artificial_viscosity = 0.03;
    /// In spacings from a particle of a wall, which pushes back harder what comes nearer. At rest the fluid
    /// is a spacing away.
    static constexpr double nearest_to_walls = 0.7;

    bool viscous() const { return options.viscosity > 0; }
    /// How far particles act: twice the smoothing length, but for the last bit of that, where what they do is
    /// less than roundings, and where many pairs of a lattice would be in doubt.
    double reach() const { return (2 - 0x1p-12) * h_; }
    void check() const {
        const std::size_t n = state.size();
        expect_size("velocities", state.velocities, n);
        expect_size("compressions", state.compressions, n);
        expect_size("accelerations", state.accelerations, n);
        expect_size("rates of compression", state.compression_rates, n);
        if (!walls.velocities.empty())
            expect_size("velocities of walls", walls.velocities, walls.places.size());
    }

    /// Finds the places of particles in the middle of the step, and their box. Throws InputError for one that
    /// is too far away.
    void go_half(double dt, Executor& executor) {
        middle_.resize(state.size()), box_ = {};
        std::mutex joining;
        executor.for_each_piece(state.size(), worth_a_task, [&](std::size_t begin, std::size_t end) {
            Box<double, D> here;
            for (std::size_t i = begin; i < end; ++i) {
                middle_[i] = state.places[i] + state.velocities[i] * (dt / 2);
                here.expand(middle_[i]);
                for (int k = 0; k < D; ++k)
                    if (!axes_[static_cast<std::size_t>(k)].holds(middle_[i][k]))
                        throw InputError("particle " + std::to_string(i) +
                                         " has a coordinate that is NaN, infinite or farther from 0 than " +
                                         std::to_string(axes_[static_cast<std::size_t>(k)].farthest()));
            }
            const std::lock_guard lock(joining);
            box_.expand(here);
        });
        half_ = dt / 2;
    }

    /// Finds accelerations and rates of compression in the middle of the step, in the order of cells.
    void find_rates(Executor& executor) {
        choose_walls(executor);
        const std::array<Strided<V>, 2> sets = {Strided<V>(middle_), Strided<V>(near_walls_)};
        const detail::CellAxes<double, D> cells(std::span(sets.data(), near_walls_.empty() ? 1 : 2), reach(),
                                                options.periods, executor);
        const Order fluid(sets[0], cells, executor), wall(sets[1], cells, executor);
        write_rows(fluid, executor);
        for (auto& row : sums_) row.resize(fluid.size());
        wall_fills_.resize(fluid.size());
        for (auto& row : wall_sums_) row.resize(wall.size());
        const auto& kernels = std::get<detail::FlowKernelsOf<D>>(detail::flow_kernels());
        if (wall.size() > 0) {
            write_wall_places(wall, executor);
            for_lists(wall, fluid, executor, [&](const Lists& lists) {
                kernels.at_walls(lists.task(scales_, wall_rows_, rows_, wall_sums_));
            });
            write_wall_rows(wall, executor);
        }
        for_lists(fluid, fluid, executor, [&](const Lists& lists) {
            kernels.of_fluid[viscous()](lists.task(scales_, rows_, rows_, sums_));
        });
        if (wall.size() > 0)
            for_lists(fluid, wall, executor, [&](const Lists& lists) {
                auto task = lists.task(scales_, rows_, wall_rows_, sums_);
                task.fill = wall_fills_.data();
                kernels.of_walls[viscous()](task);
            });
        else
            std::fill(wall_fills_.begin(), wall_fills_.end(), 0.0f);
        order_.assign(fluid.order().begin(), fluid.order().end());
    }

    using Sums = std::array<BareVector<float>, D + 2>;
    /// Lists of neighbours of the particles [first, end) of an order.
    struct Lists {
        std::uint32_t first, end;
        BareVector<std::size_t> ends;
        BareVector<std::uint32_t> ids;
        BareVector<double> none;

        detail::FlowTask<D> task(const detail::FlowScales<D>& scales, const Rows& own, const Rows& others,
                                 Sums& sums) const {
            detail::FlowTask<D> t = {};
            t.scales = &scales, t.own = &own, t.others = &others;
            t.first = first, t.end = end, t.ends = ends.data(), t.ids = ids.data();
            for (std::size_t k = 0; k < D; ++k) t.acceleration[k] = sums[k].data();
            t.rate = sums[D].data(), t.fill = sums[D + 1].data();
            return t;
        }
    };
    /// Calls f(lists) for parts of an order, with the neighbours in an order over the same axes.
    template <class F>
    void for_lists(const Order& asking, const Order& asked, Executor& executor, F f) const {
        constexpr std::size_t points_each = 1024;  // whose lists stay in a processor's cache
        const auto begins = detail::parts_of(asking, points_each);
        const auto listed = &asking == &asked ? detail::Listed::others : detail::Listed::all;
        const double reach2 = reach() * reach();
        executor.for_each_piece(begins.size() - 1, 1, [&](std::size_t from, std::size_t to) {
            detail::CellLister<double, D> lister(asking, asked, reach2, listed, false);
            Lists lists;
            for (std::size_t i = from; i < to; ++i) {
                lists.first = asking.cells()[begins[i]].first,
                lists.end = asking.cells()[begins[i + 1]].first;
                lists.ends.resize(lists.end - lists.first);
                lister.list(begins[i], begins[i + 1], lists.ends.data(), lists.ids, lists.none);
                f(lists);
            }
        });
    }

    /// Chooses the walls that the fluid may reach.
    void choose_walls(Executor& executor) {
        select_numbers(walls.places.size(), wall_ids_, executor, [&](std::size_t i) {
            bool near = true;
            for (int k = 0; k < D; ++k) {
                const double x = walls.places[i][k];
                near &= options.periods[k] > 0 || (x >= box_.low[k] - reach() && x <= box_.high[k] + reach());
            }
            return near;
        });
        near_walls_.resize(wall_ids_.size());
        executor.for_each_piece(wall_ids_.size(), worth_a_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) near_walls_[i] = walls.places[wall_ids_[i]];
        });
    }

    void write_places(const V& place, Rows& rows, std::size_t i) const {
        for (int k = 0; k < D; ++k) rows.at[k][i] = axes_[static_cast<std::size_t>(k)](place[k]);
    }
    void write_rows(const Order& fluid, Executor& executor) {
        rows_.resize(fluid.size());
        const double per_sound = 1 / options.sound;
        executor.for_each_piece(fluid.size(), worth_a_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const std::size_t id = fluid.order()[i];
                write_places(middle_[id], rows_, i);
                const V velocity = state.velocities[id] + state.accelerations[id] * half_;
                for (int k = 0; k < D; ++k)
                    rows_.velocity[k][i] = static_cast<float>(velocity[k] * per_sound);
                rows_.compression[i] =
                    static_cast<float>(state.compressions[id] + state.compression_rates[id] * half_);
            }
        });
    }
    void write_wall_places(const Order& wall, Executor& executor) {
        wall_rows_.resize(wall.size());
        for (auto& row : wall_rows_.mirrored_velocity) row.resize(wall.size());
        executor.for_each_piece(wall.size(), worth_a_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                write_places(near_walls_[wall.order()[i]], wall_rows_, i);
        });
    }
    /// Writes the pressures and velocities of walls, of what they took from the fluid.
    void write_wall_rows(const Order& wall, Executor& executor) {
        const double per_sound = 1 / options.sound;
        executor.for_each_piece(wall.size(), worth_a_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                wall_rows_.compression[i] = std::max(0.0f, wall_sums_[D][i]);
                const V own = walls.velocities.empty() ? V() : walls.velocities[wall_ids_[wall.order()[i]]];
                for (int k = 0; k < D; ++k) {
                    const float v = static_cast<float>(own[k] * per_sound);
                    wall_rows_.velocity[k][i] = v;
                    wall_rows_.mirrored_velocity[k][i] = 2 * v - wall_sums_[static_cast<std::size_t>(k)][i];
                }
            }
        });
    }

    /// What the sums of particle i, in the order of cells, make of its state at the end of the step.
    struct Next {
        V acceleration, velocity;
        double compression_rate, compression;
    };
    Next next(std::size_t i, double dt) const {
        const std::size_t id = order_[i];
        const double per_time = options.sound / h_;
        Next n;
        for (int k = 0; k < D; ++k)
            n.acceleration[k] =
                static_cast<double>(sums_[static_cast<std::size_t>(k)][i]) * options.sound * per_time +
                options.gravity[k];
        n.velocity = state.velocities[id] + n.acceleration * dt;
        n.compression_rate = static_cast<double>(sums_[D][i]) * per_time;
        n.compression = state.compressions[id] + n.compression_rate * dt;
        // Where neighbours are few their sums say little of the density: it is that at rest, and no less at
        // the surface. Drops alone fall no faster than the air would let them, so that steps stay long.
        const float of_fluid = sums_[D + 1][i], of_walls = wall_fills_[i];
        if (of_fluid < alone && of_walls == 0) {
            n.compression = 0, n.compression_rate = 0;
            const double fast = length(n.velocity) / (options.sound / 2);
            if (fast > 1) n.velocity = n.velocity / fast;
        } else if (of_fluid + of_walls < at_surface) {
            n.compression = std::max(0.0, n.compression);
        }
        return n;
    }
    /// Throws InputError if a particle would move faster than sound, or nowhere.
    void check_speeds(double dt, Executor& executor) const {
        executor.for_each_piece(order_.size(), worth_a_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const Next n = next(i, dt);
                if (!(length2(n.velocity) <= options.sound * options.sound) || !std::isfinite(n.compression))
                    throw InputError("particle " + std::to_string(order_[i]) + " at time " +
                                     std::to_string(state.time) +
                                     " would move faster than sound: the fluid is faster than the speed of "
                                     "sound was chosen for, or particles began too close together. Give a "
                                     "higher speed of sound, or look at the start");
            }
        });
    }
    /// Moves the particles by what was found in the middle of the step.
    void go_on(double dt, Executor& executor) {
        fills.resize(state.size());
        executor.for_each_piece(order_.size(), worth_a_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const std::size_t id = order_[i];
                const Next n = next(i, dt);
                state.accelerations[id] = n.acceleration, state.velocities[id] = n.velocity;
                state.places[id] = middle_[id] + n.velocity * (dt / 2);
                state.compression_rates[id] = n.compression_rate, state.compressions[id] = n.compression;
                fills[id] = sums_[D + 1][i] + wall_fills_[i];
            }
        });
    }
    /// Shares of surroundings that are full below which a particle counts as alone, and as at the surface.
    static constexpr float alone = 0.4f, at_surface = 0.65f;

    Threads threads_;
    double h_ = 0, half_ = 0;
    detail::FlowScales<D> scales_ = {};
    std::array<detail::FixedAxis, D> axes_;
    // Of a step: places in its middle and their box, and the walls that the fluid may reach.
    std::vector<V> middle_, near_walls_;
    Box<double, D> box_;
    BareVector<std::uint32_t> wall_ids_, order_;
    Rows rows_, wall_rows_;
    Sums sums_, wall_sums_;
    BareVector<float> wall_fills_;
};

template <int D>
FluidFlow<D>::FluidFlow(FluidState<D> start, FluidWalls<D> walls, const FluidOptions<D>& options,
                        Threads threads)
    : steps_(std::make_unique<Steps>(std::move(start), std::move(walls), options, threads)) {}
template <int D>
FluidFlow<D>::~FluidFlow() = default;
template <int D>
FluidFlow<D>::FluidFlow(FluidFlow&&) noexcept = default;
template <int D>
FluidFlow<D>& FluidFlow<D>::operator=(FluidFlow&&) noexcept = default;

template <int D>
void FluidFlow<D>::step() {
    steps_->step(longest_step());
}
template <int D>
void FluidFlow<D>::step_towards(double until) {
    const double left = until - state().time;
    if (!(left > 0)) return;
    const double steps = std::ceil(left / longest_step()), dt = left / steps;
    if (state().time + dt == state().time)
        throw InputError("steps of " + std::to_string(dt) + " no longer move the time of " +
                         std::to_string(state().time) +
                         ": the fluid is too fast or too viscous for its spacing");
    steps_->step(dt);
    if (steps <= 1) steps_->state.time = until;
}
template <int D>
std::uint64_t FluidFlow<D>::advance(double until) {
    std::uint64_t steps = 0;
    for (; state().time < until; ++steps) step_towards(until);
    return steps;
}
template <int D>
std::size_t FluidFlow<D>::pour(const std::vector<V>& places, const V& velocity) {
    FluidState<D>& state = steps_->state;
    const double apart = 0.9 * options().spacing;
    // A place is free if neither a particle nor a place before it is near.
    NearLists<double> near_fluid, near_places;
    const NeighbourOptions repeats{.periods = periods_in_space(options().periods),
                                   .threads = steps_->threads()};
    neighbours_within(state.places, places, apart, near_fluid, repeats);
    neighbours_within(places, apart, near_places, repeats);
    std::vector<bool> taken(places.size());
    const std::size_t before = state.size();
    for (std::size_t i = 0; i < places.size(); ++i) {
        taken[i] = near_fluid.offsets[i + 1] == near_fluid.offsets[i];
        for (std::size_t k = near_places.offsets[i]; k < near_places.offsets[i + 1]; ++k)
            if (near_places.ids[k] < i && taken[near_places.ids[k]]) taken[i] = false;
        if (taken[i]) state.places.push_back(places[i]);
    }
    state.resize(state.places.size());
    for (std::size_t i = before; i < state.size(); ++i) state.velocities[i] = velocity;
    steps_->fills.resize(state.size());
    return state.size() - before;
}

template <int D>
double FluidFlow<D>::longest_step() const {
    return steps_->longest_step();
}
template <int D>
const FluidState<D>& FluidFlow<D>::state() const {
    return steps_->state;
}
template <int D>
const FluidWalls<D>& FluidFlow<D>::walls() const {
    return steps_->walls;
}
template <int D>
const FluidOptions<D>& FluidFlow<D>::options() const {
    return steps_->options;
}
template <int D>
double FluidFlow<D>::pressure(std::size_t i) const {
    const FluidOptions<D>& o = options();
    return state().compressions[i] * o.rest_density * o.sound * o.sound;
}
template <int D>
double FluidFlow<D>::mass() const {
    return options().rest_density * std::pow(options().spacing, D);
}
template <int D>
const std::vector<float>& FluidFlow<D>::fills() const {
    return steps_->fills;
}

template class FluidFlow<2>;
template class FluidFlow<3>;
template FluidOptions<2> filled_in(FluidOptions<2>, const FluidState<2>&, const FluidWalls<2>&);
template FluidOptions<3> filled_in(FluidOptions<3>, const FluidState<3>&, const FluidWalls<3>&);

}  // namespace hedgerow
