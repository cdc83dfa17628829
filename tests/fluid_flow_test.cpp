/// Flows: each sum against all pairs in double; the same bits for any threads, instruction set and
/// interruption; momentum; walls and what is refused.
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <hedgerow/base/error.h>
#include <hedgerow/fluid/fluid_flow.h>
#include <hedgerow/fluid/fluid_measures.h>

#include "fluids.h"
#include "using.h"

namespace hedgerow {
namespace {

template <class Type>
class Fluids : public testing::Test {};
template <int dimension>
struct Space {
    static constexpr int D = dimension;
};
using Spaces = testing::Types<Space<2>, Space<3>>;
TYPED_TEST_SUITE(Fluids, Spaces);

/// A fluid of unlike velocities and compressions, in a jittered lattice of some particles a side.
template <int D>
FluidState<D> stirred(int side, double spacing, double sound, unsigned seed) {
    Box<double, D> box;
    for (int k = 0; k < D; ++k) box.low[k] = 0, box.high[k] = side * spacing;
    FluidState<D> state = filled(box, spacing);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (std::size_t i = 0; i < state.size(); ++i) {
        for (int k = 0; k < D; ++k) {
            state.places[i][k] += 0.2 * spacing * unit(random);
            state.velocities[i][k] = 0.1 * sound * unit(random);
        }
        state.compressions[i] = 0.01 * unit(random);
    }
    return state;
}

template <int D>
void expect_same(const FluidState<D>& a, const FluidState<D>& b) {
    EXPECT_EQ(a.time, b.time);
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(a.places, b.places);
    EXPECT_EQ(a.velocities, b.velocities);
    EXPECT_EQ(a.compressions, b.compressions);
    EXPECT_EQ(a.accelerations, b.accelerations);
    EXPECT_EQ(a.compression_rates, b.compression_rates);
}

/// The rates of a flow by all pairs in double, each term as the papers state it, in metres and seconds.
template <int D>
class Oracle {
    using V = Vec<double, D>;

public:
    Oracle(const FluidFlow<D>& flow, double half)
        : o_(flow.options()), h_(o_.smoothing * o_.spacing), volume_(std::pow(o_.spacing, D)) {
        const FluidState<D>& s = flow.state();
        for (std::size_t i = 0; i < s.size(); ++i) {
            x_.push_back(s.places[i] + s.velocities[i] * half);
            v_.push_back(s.velocities[i] + s.accelerations[i] * half);
            c_.push_back(s.compressions[i] + s.compression_rates[i] * half);
        }
        const FluidWalls<D>& walls = flow.walls();
        for (std::size_t w = 0; w < walls.places.size(); ++w) {
            const V own = walls.velocities.empty() ? V() : walls.velocities[w];
            double sum = 0, compression = 0;
            V velocity;
            for (std::size_t j = 0; j < x_.size(); ++j) {
                const V r = offset(walls.places[w], x_[j]);
                const double weight = kernel(length(r));
                sum += weight;
                compression += weight * (c_[j] + dot(o_.gravity, r) / (o_.sound * o_.sound));
                velocity += v_[j] * weight;
            }
            wall_x_.push_back(walls.places[w]), wall_v_.push_back(own);
            wall_c_.push_back(sum > 0 ? std::max(0.0, compression / sum) : 0);
            mirrored_.push_back(own + own - (sum > 0 ? velocity / sum : V()));
        }
    }
    /// Finds the acceleration and the rate of compression of a particle, and the sums of the sizes of terms.
    void rates(std::size_t i, V& acceleration, double& rate, double& size, double& rate_size) const {
        acceleration = o_.gravity, rate = 0, size = length(o_.gravity), rate_size = 0;
        const double nu = o_.viscosity, c = o_.sound, eta2 = 0.01 * h_ * h_,
                     alpha = std::max(0.0, 0.03 - 2 * (D + 2) * nu / (h_ * c));
        const auto add = [&](const V& push, double growth) {
            acceleration += push, rate += growth;
            size += length(push), rate_size += std::abs(growth);
        };
        for (std::size_t j = 0; j < x_.size(); ++j) {
            if (j == i) continue;
            const V r = offset(x_[i], x_[j]), v = v_[i] - v_[j], gradient = gradient_of(r);
            const double r2 = length2(r), at = dot(r, gradient) / (r2 + eta2);
            add(gradient * (-c * c * (c_[i] + c_[j]) * volume_), (1 + c_[i]) * dot(v, gradient) * volume_);
            add(gradient * (alpha * h_ * c * dot(v, r) / (r2 + eta2) * volume_), 0);
            add(v * (2 * nu * at * volume_), 0);
            // Diffusion of what is left of density without its hydrostatic part.
            if (r2 > 0)
                add(V(), 2 * o_.diffusion * h_ * c * (c_[i] - c_[j] - dot(o_.gravity, r) / (c * c)) *
                             dot(r, gradient) / r2 * volume_);
        }
        for (std::size_t w = 0; w < wall_x_.size(); ++w) {
            const V r = offset(x_[i], wall_x_[w]), gradient = gradient_of(r);
            const double r2 = length2(r), near = 1 - length(r) / (0.7 * o_.spacing);
            add(gradient * (-c * c * (c_[i] + wall_c_[w] + 2 * std::max(0.0, near)) * volume_),
                (1 + c_[i]) * dot(v_[i] - wall_v_[w], gradient) * volume_);
            add((v_[i] - mirrored_[w]) * (2 * nu * dot(r, gradient) / (r2 + eta2) * volume_), 0);
        }
    }
    double fill(std::size_t i) const {
        double sum = 0;
        for (const auto* const all : {&x_, &wall_x_})
            for (const V& x : *all) sum += kernel(length(offset(x_[i], x))) * volume_;
        return sum;
    }

private:
    V offset(const V& a, const V& b) const {
        V r = a - b;
        for (int k = 0; k < D; ++k) r[k] = nearest_image(r[k], o_.periods[k]);
        return r;
    }
    double kernel(double r) const {
        const double q = r / h_, norm = D == 2 ? 7 / (4 * std::numbers::pi * h_ * h_)
                                               : 21 / (16 * std::numbers::pi * h_ * h_ * h_);
        return q < 2 ? norm * std::pow(1 - q / 2, 4) * (2 * q + 1) : 0;
    }
    V gradient_of(const V& r) const {
        const double q = length(r) / h_, norm = D == 2 ? 7 / (4 * std::numbers::pi * h_ * h_)
                                                       : 21 / (16 * std::numbers::pi * h_ * h_ * h_);
        if (!(q < 2) || q == 0) return {};
        return r * (-5 * norm * q * std::pow(1 - q / 2, 3) / h_ / length(r));
    }

    FluidOptions<D> o_;
    double h_, volume_;
    std::vector<V> x_, v_, wall_x_, wall_v_, mirrored_;
    std::vector<double> c_, wall_c_;
};

/// Holds the rates of a step against all pairs.
template <int D>
void expect_rates(FluidFlow<D> flow) {
    for (int step = 0; step < 2; ++step) {
        const double dt = flow.longest_step();
        const Oracle<D> oracle(flow, dt / 2);
        flow.step();
        for (std::size_t i = 0; i < flow.state().size(); ++i) {
            Vec<double, D> acceleration;
            double rate, size, rate_size;
            oracle.rates(i, acceleration, rate, size, rate_size);
            ASSERT_LE(length(flow.state().accelerations[i] - acceleration), 2e-6 * size) << "particle " << i;
            ASSERT_NEAR(flow.fills()[i], oracle.fill(i), 3e-6);
            if (flow.fills()[i] >= 0.5f) {
                ASSERT_LE(std::abs(flow.state().compression_rates[i] - rate), 2e-6 * rate_size);
            }
        }
    }
}

TYPED_TEST(Fluids, RatesAreThoseOfAllPairs) {
    constexpr int D = TypeParam::D;
    for (const double viscosity : {0.0, 1e-4, 0.05})
        for (const double spacing : {0.05, 1e-6, 1e6}) {
            FluidOptions<D> options;
            options.spacing = spacing, options.sound = 10 * spacing * 20;
            options.viscosity = viscosity * options.sound * spacing;
            options.gravity = options.gravity * (options.sound * options.sound / (1000 * spacing));
            Box<double, D> box;
            for (int k = 0; k < D; ++k) box.low[k] = 0, box.high[k] = 8 * spacing;
            FluidWalls<D> walls = walls_of_box(box, spacing);
            for (std::size_t w = 0; w < walls.places.size(); ++w)
                walls.velocities.push_back(walls.places[w] * (0.01 * options.sound / (8 * spacing)));
            expect_rates(FluidFlow<D>(stirred<D>(8, spacing, options.sound, 1), walls, options));
        }
}
TYPED_TEST(Fluids, RatesOfPeriodicFluidsAreThoseOfAllPairsOfImages) {
    constexpr int D = TypeParam::D;
    FluidOptions<D> options;
    options.spacing = 0.1, options.sound = 10;
    for (const double moved : {0.0, 1e4}) {
        FluidState<D> state = stirred<D>(10, options.spacing, options.sound, 2);
        for (int k = 0; k < D; ++k) options.periods[k] = k == 1 ? 0 : 1;
        for (auto& p : state.places) p[0] += moved;
        expect_rates(FluidFlow<D>(state, {}, options));
    }
}
TYPED_TEST(Fluids, FarPlacesHaveTheRatesOfNearOnes) {
    constexpr int D = TypeParam::D;
    FluidOptions<D> options;
    options.spacing = 0x1p-4, options.sound = 10;
    FluidState<D> state = stirred<D>(8, options.spacing, options.sound, 3);
    for (auto& p : state.places)
        for (int k = 0; k < D; ++k) p[k] = std::ldexp(std::round(std::ldexp(p[k], 20)), -20);
    FluidState<D> far = state;
    for (auto& p : far.places) p += Vec<double, D>::all(0x1p20);
    far.places.push_back(Vec<double, D>::all(-0x1p21)), far.resize(far.places.size());
    FluidFlow<D> a(state, {}, options), b(far, {}, options);
    // Velocities move places by multiples of what places that are far off have room for.
    for (std::size_t i = 0; i < state.size(); ++i) state.velocities[i] = {}, far.velocities[i] = {};
    a = FluidFlow<D>(state, {}, options), b = FluidFlow<D>(far, {}, options);
    a.step(), b.step();
    for (std::size_t i = 0; i < state.size(); ++i)
        ASSERT_LE(length(a.state().accelerations[i] - b.state().accelerations[i]),
                  1e-5 * options.sound * options.sound / options.spacing);
}

TYPED_TEST(Fluids, ThreadsAndInstructionSetsGiveTheSameBits) {
    constexpr int D = TypeParam::D;
    for (const bool viscous : {false, true}) {
        const FluidFlow<D> start = dam<D>(D == 2 ? 0.02 : 0.05);
        FluidOptions<D> options = start.options();
        if (viscous) options.viscosity = 0.01;
        FluidState<D> first;
        for (const auto set : instruction_sets()) {
            SCOPED_TRACE(set);
            const Using use(set);
            for (const bool serial : {true, false}) {
                FluidFlow<D> flow(start.state(), start.walls(), options,
                                  serial ? Threads(serial_executor()) : Threads(default_executor()));
                flow.advance(D == 2 ? 0.05 : 0.02);
                if (first.size() == 0)
                    first = flow.state();
                else
                    expect_same(first, flow.state());
            }
        }
    }
}
TYPED_TEST(Fluids, ASavedStateGoesOnAsIfThereHadBeenNoInterruption) {
    constexpr int D = TypeParam::D;
    FluidFlow<D> flow = dam<D>(0.05);
    const FluidOptions<D> options = flow.options();
    flow.advance(0.03);
    for (int i = 0; i < 3; ++i) flow.step_towards(0.06);
    const FluidState<D> saved = flow.state();
    flow.advance(0.06);
    FluidFlow<D> resumed(saved, flow.walls(), options);
    resumed.advance(0.06);
    EXPECT_EQ(resumed.state().time, 0.06);
    expect_same(flow.state(), resumed.state());
}
TYPED_TEST(Fluids, MomentumIsKeptWithoutWallsAndGravity) {
    constexpr int D = TypeParam::D;
    for (const double viscosity : {0.0, 0.02}) {
        FluidOptions<D> options;
        options.spacing = 0.1, options.sound = 10, options.gravity = {}, options.viscosity = viscosity;
        for (int k = 0; k < D; ++k) options.periods[k] = k == 0 ? 1 : 0;
        FluidFlow<D> flow(stirred<D>(10, options.spacing, options.sound, 5), {}, options);
        const auto before = measures(flow);
        double moved = 0;
        for (int step = 0; step < 200; ++step) {
            const double dt = flow.longest_step();
            flow.step();
            for (const auto& a : flow.state().accelerations) moved += length(a) * dt * flow.mass();
        }
        EXPECT_LT(length(measures(flow).momentum - before.momentum), 1e-7 * moved);
        EXPECT_LT(measures(flow).kinetic, before.kinetic);
    }
}
TYPED_TEST(Fluids, ADropFallsFreely) {
    constexpr int D = TypeParam::D;
    FluidOptions<D> options;
    options.spacing = 0.01, options.sound = 20;
    FluidState<D> state;
    state.resize(1);
    FluidFlow<D> flow(state, {}, options);
    flow.advance(0.5);
    EXPECT_NEAR(flow.state().velocities[0][D - 1], -9.81 * 0.5, 1e-9);
    EXPECT_NEAR(flow.state().places[0][D - 1], -9.81 * 0.125, 1e-6);
    EXPECT_EQ(flow.state().compressions[0], 0);
    EXPECT_NEAR(flow.fills()[0],
                D == 2 ? 7 / (4 * std::numbers::pi * 2.25) : 21 / (16 * std::numbers::pi * 1.728), 1e-6);
    // No faster than half of sound, however deep.
    flow.advance(5);
    EXPECT_NEAR(flow.state().velocities[0][D - 1], -10, 1e-9);
}
TYPED_TEST(Fluids, ASourceKeepsFull) {
    constexpr int D = TypeParam::D;
    FluidOptions<D> options = water<D>(0.1, 1);
    options.gravity = {};
    Box<double, D> source;
    for (int k = 0; k < D; ++k) source.low[k] = 0, source.high[k] = 0.3;
    const auto places = fill_box(source, 0.1);
    Vec<double, D> velocity;
    velocity[0] = 1;
    FluidFlow<D> flow({}, {}, options);
    EXPECT_EQ(flow.pour(places, velocity), places.size());
    EXPECT_EQ(flow.pour(places, velocity), 0u);
    auto doubled = places;
    doubled.insert(doubled.end(), places.begin(), places.end());
    EXPECT_EQ(FluidFlow<D>({}, {}, options).pour(doubled, velocity), places.size());
    for (const auto& v : flow.state().velocities) EXPECT_EQ(v, velocity);
    // What has left makes room for about as much: a layer for each spacing.
    const std::size_t layer = places.size() / 3;
    std::size_t added = 0;
    while (flow.state().time < 1) added += flow.pour(places, velocity), flow.step();
    EXPECT_NEAR(static_cast<double>(added), 10.0 * static_cast<double>(layer),
                3.0 * static_cast<double>(layer));
    const auto state = flow.state();
    FluidFlow<D> resumed(state, {}, flow.options());
    EXPECT_EQ(resumed.pour(places, velocity), flow.pour(places, velocity));
    flow.step(), resumed.step();
    expect_same(flow.state(), resumed.state());
    EXPECT_THROW(flow.pour({Vec<double, D>::all(std::nan(""))}, velocity), InputError);
}
TYPED_TEST(Fluids, NoParticlesFlowAtNoCost) {
    constexpr int D = TypeParam::D;
    FluidFlow<D> flow({}, {}, water<D>(0.1, 1));
    EXPECT_GT(flow.advance(0.01), 0u);
    EXPECT_EQ(flow.state().time, 0.01);
    EXPECT_EQ(measures(flow).kinetic, 0);
}
TYPED_TEST(Fluids, ParticlesInOnePlaceStayTogether) {
    constexpr int D = TypeParam::D;
    FluidOptions<D> options = water<D>(0.1, 1);
    FluidState<D> state;
    state.resize(20);
    FluidFlow<D> flow(state, {}, options);
    flow.advance(0.1);
    for (const auto& p : flow.state().places) EXPECT_EQ(p, flow.state().places[0]);
    EXPECT_TRUE(std::isfinite(flow.state().places[0][1]));
}

TYPED_TEST(Fluids, WallsOfABoxAreLayersBehindItsFaces) {
    constexpr int D = TypeParam::D;
    Box<double, D> box;
    for (int k = 0; k < D; ++k) box.low[k] = -0.5, box.high[k] = 0.5 + k;
    const std::size_t inside = fill_box(box, 0.1).size();
    EXPECT_EQ(inside, D == 2 ? 200u : 6000u);
    const auto count = [&](const BoxFaces<D>& faces, int layers) {
        const auto walls = walls_of_box(box, 0.1, faces, layers);
        for (const auto& p : walls.places) {
            bool outside = false;
            for (int k = 0; k < D; ++k) outside |= p[k] < box.low[k] || p[k] > box.high[k];
            EXPECT_TRUE(outside);
        }
        return walls.places.size();
    };
    EXPECT_EQ(count({}, 3), D == 2 ? 16u * 26 - 200 : 16u * 26 * 36 - 6000);
    EXPECT_EQ(count(BoxFaces<D>::open_above(), 2), D == 2 ? 14u * 22 - 200 : 14u * 24 * 32 - 6000);
    EXPECT_THROW(fill_box(box, 0.3), UsageError);
    EXPECT_THROW(fill_box(box, 0.0), UsageError);
    EXPECT_THROW(fill_box(box, std::nan("")), UsageError);
    EXPECT_THROW(walls_of_box(box, 2.0), UsageError);
}

TYPED_TEST(Fluids, BadFlowsAreRefused) {
    constexpr int D = TypeParam::D;
    const FluidState<D> state = stirred<D>(6, 0.1, 10, 1);
    const auto refused = [&](auto change) {
        FluidOptions<D> options;
        options.spacing = 0.1, options.sound = 10;
        change(options);
        EXPECT_THROW(FluidFlow<D>(state, {}, options), UsageError);
    };
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    for (const double x : {0.0, -1.0, nan, infinity}) refused([&](auto& o) { o.spacing = x; });
    for (const double x : {-1.0, nan, infinity}) {
        refused([&](auto& o) { o.sound = x; });
        refused([&](auto& o) { o.viscosity = x; });
        refused([&](auto& o) { o.diffusion = x; });
        refused([&](auto& o) { o.smoothing = x; });
        refused([&](auto& o) { o.rest_density = x; });
        refused([&](auto& o) { o.periods[1] = x; });
    }
    refused([&](auto& o) { o.gravity[0] = nan; });
    refused([&](auto& o) { o.periods[0] = 0.2; });  // a particle would reach its own image
    refused([&](auto& o) { o.gravity = {}, o.sound = 0; });

    const FluidOptions<D> good = water<D>(0.1, 1);
    FluidState<D> bad = state;
    bad.velocities.pop_back();
    EXPECT_THROW(FluidFlow<D>(bad, {}, good), InputError);
    FluidWalls<D> walls;
    walls.places.resize(2), walls.velocities.resize(1);
    EXPECT_THROW(FluidFlow<D>(state, walls, good), InputError);
    bad = state;
    for (const double x : {nan, infinity}) {
        bad.places[3][1] = x;
        EXPECT_THROW(FluidFlow<D>(bad, {}, good), InputError);
        walls.velocities.clear(), walls.places[1][0] = x;
        EXPECT_THROW(FluidFlow<D>(state, walls, good), InputError);
    }
    bad.places[3][1] = 1e200;
    FluidFlow<D> flow(bad, {}, good);
    EXPECT_THROW(flow.step(), InputError);
}
TYPED_TEST(Fluids, AFluidFasterThanSoundIsRefusedAndLeftAsItWas) {
    constexpr int D = TypeParam::D;
    FluidOptions<D> options;
    options.spacing = 0.1, options.sound = 1;
    FluidState<D> state = stirred<D>(8, 0.1, 1, 9);
    for (auto& c : state.compressions) c = 3;  // it bursts
    FluidFlow<D> flow(state, {}, options);
    FluidState<D> before;
    const auto go_on = [&] {
        for (int i = 0; i < 1000; ++i) before = flow.state(), flow.step();
    };
    EXPECT_THROW(go_on(), InputError);
    expect_same(before, flow.state());
}

}  // namespace
}  // namespace hedgerow
