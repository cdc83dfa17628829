/// Flows against hydrostatics, experiments, theory of waves and closed forms. Short runs are coarse or end
/// early; long ones are those of docs/fluids.md.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <hedgerow/fluid/fluid_flow.h>
#include <hedgerow/fluid/fluid_measures.h>

#include "fluids.h"
#include "long_runs.h"

namespace hedgerow {
namespace {

constexpr double g = 9.81, pi = std::numbers::pi;

/// Prints a figure, which docs/fluids.md has.
void tell(const std::string& what, double found) {
    std::printf("  %s: %.4f\n", what.c_str(), found);
}

/// The line of pressures over depths by least squares, and what they differ by from those of water at rest.
struct Hydrostatics {
    double slope, rms, floor;  // over ρg and over ρgH; the mean of p/(ρgd) in the lowest layer
};
template <int D>
Hydrostatics hydrostatics(const FluidFlow<D>& flow, double height) {
    double n = 0, d1 = 0, p1 = 0, d2 = 0, dp = 0, errors = 0, floor = 0, lowest = 0;
    for (std::size_t i = 0; i < flow.state().size(); ++i) {
        const double d = height - flow.state().places[i][D - 1], p = flow.pressure(i) / 1000 / g;
        n += 1, d1 += d, p1 += p, d2 += d * d, dp += d * p, errors += (p - d) * (p - d);
        if (d > height - flow.options().spacing) floor += p / d, lowest += 1;
    }
    return {(n * dp - d1 * p1) / (n * d2 - d1 * d1), std::sqrt(errors / n) / height, floor / lowest};
}
/// A column of water that stands in a tank, from the start compressed by its weight.
template <int D>
FluidFlow<D> column(double spacing, int width, int height) {
    Box<double, D> tank, box;
    for (int k = 0; k < D; ++k) tank.low[k] = box.low[k] = 0, tank.high[k] = box.high[k] = width * spacing;
    box.high[D - 1] = height * spacing, tank.high[D - 1] = (height + 10) * spacing;
    const FluidOptions<D> options = water<D>(spacing, height * spacing);
    FluidState<D> state = filled(box, spacing);
    compress(state, box.high[D - 1], options);
    return {state, walls_of_box(tank, spacing, BoxFaces<D>::open_above()), options};
}
template <int D>
void expect_rest(double spacing, int width, int height, double rms) {
    FluidFlow<D> flow = column<D>(spacing, width, height);
    const double h = height * spacing;
    std::vector<Hydrostatics> found;
    for (const double until : {1.0, 5.0, 20.0}) {
        if (until > static_cast<double>(in_long_runs(20, 1))) break;
        flow.advance(until);
        found.push_back(hydrostatics(flow, h));
        const std::string at = std::to_string(D) + "D at " + std::to_string(int(until)) + " s, ";
        SCOPED_TRACE(at);
        tell(at + "rms over the deepest pressure", found.back().rms);
        tell(at + "pressure at the floor", found.back().floor);
        tell(at + "slope", found.back().slope);
        EXPECT_LT(found.back().rms, rms);
        EXPECT_NEAR(found.back().floor, 1, 0.02);
        EXPECT_NEAR(found.back().slope, 1, 0.02);
        if (until > 1) {
            const auto m = measures(flow);
            const double speed = std::sqrt(2 * m.kinetic / (flow.mass() * double(flow.state().size())));
            tell(at + "rms speed in thousandths of √(gH)", 1000 * speed / std::sqrt(g * h));
            EXPECT_LT(speed, (D == 2 ? 2e-3 : 5e-3) * std::sqrt(g * h));
        }
    }
    if (found.size() == 3) {
        EXPECT_NEAR(found[2].slope, found[1].slope, 0.005);
        EXPECT_NEAR(found[2].floor, found[1].floor, 0.005);
    }
}
TEST(FluidPhysics, AColumnAtRestHasThePressureOfItsWeight) {
    expect_rest<2>(0.02, 25, 25, 0.01);
    if (in_long_runs(1, 0) == 1)
        expect_rest<3>(1 / 64.0, 12, 18, 0.015);
    else
        expect_rest<3>(1 / 64.0, 6, 10, 0.015);
}

/// The front of a column twice as high as wide, Z = x/a at times t·√(2g/a): Martin and Moyce, An experimental
/// study of the collapse of liquid columns on a rigid horizontal plane (1952), table 2.
constexpr std::array<std::array<double, 2>, 11> experiment = {{{0.84, 1.22},
                                                               {1.19, 1.44},
                                                               {1.43, 1.67},
                                                               {1.63, 1.89},
                                                               {1.83, 2.11},
                                                               {1.98, 2.33},
                                                               {2.20, 2.56},
                                                               {2.32, 2.78},
                                                               {2.51, 3.00},
                                                               {2.65, 3.22},
                                                               {2.83, 3.44}}};
struct Track {
    std::vector<double> times, values;
    void add(double time, double value) { times.push_back(time), values.push_back(value); }
    /// The value at a time between those of the track.
    double at(double time) const {
        const auto after = std::upper_bound(times.begin(), times.end(), time);
        const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
            after - times.begin(), 1, static_cast<std::ptrdiff_t>(times.size()) - 1));
        const double share = (time - times[i - 1]) / (times[i] - times[i - 1]);
        return values[i - 1] + share * (values[i] - values[i - 1]);
    }
};
TEST(FluidPhysics, TheFrontOfADamBreakIsThatOfTheExperiment) {
    constexpr double a = 0.5;
    const double spacing = in_long_runs(1, 0) == 1 ? a / 50 : a / 25;
    const Box<double, 2> tank{{0, 0}, {4 * a, 3}}, box{{0, 0}, {a, 2 * a}};
    FluidFlow<2> flow(filled(box, spacing), walls_of_box(tank, spacing), water<2>(spacing, 2 * a));
    Track front;
    for (double z = 1; z < 3.7;) {
        flow.step();
        double most = 0;
        for (const auto& p : flow.state().places) most = std::max(most, p[0]);
        z = (most + spacing / 2) / a;
        front.add(flow.state().time * std::sqrt(2 * g / a), z);
        ASSERT_LT(front.times.back(), 4);
    }
    // The gate of the experiment takes its time: the shift in time is fitted.
    double shift = 0, rms = 10;
    for (double s = -0.3; s < 0.6; s += 0.01) {
        double sum = 0;
        for (const auto& [time, z] : experiment) sum += std::pow(front.at(time - s) - z, 2);
        if (const double e = std::sqrt(sum / experiment.size()); e < rms) rms = e, shift = s;
    }
    EXPECT_LE(std::abs(shift), 0.3);
    EXPECT_LE(rms, 0.05);
    const auto speed = [](auto z, const auto& from, const auto& to) {
        return (z(to[0]) - z(from[0])) / (to[0] - from[0]);
    };
    const double found = speed([&](double t) { return front.at(t - shift); }, experiment[1], experiment[10]),
                 wanted = (experiment[10][1] - experiment[1][1]) / (experiment[10][0] - experiment[1][0]);
    EXPECT_NEAR(found / wanted, 1, 0.08);
    tell("shift in time", shift), tell("rms over a", rms),
        tell("speed over that of the experiment", found / wanted);
}
TEST(FluidPhysics, ABrokenDamComesToRestWithoutLeaksAndKeepsItsDensity) {
    constexpr double a = 0.5, height = 3;
    const double spacing = a / 20, until = static_cast<double>(in_long_runs(12, 2));
    const Box<double, 2> tank{{0, 0}, {4 * a, height}}, box{{0, 0}, {a, 2 * a}};
    FluidFlow<2> flow(filled(box, spacing), walls_of_box(tank, spacing), water<2>(spacing, 2 * a));
    const double start = measures(flow).potential;
    std::size_t dense = 0, far_from_rest = 0;  // particles, summed over steps
    double kinetic = 0, mean = 0;
    while (flow.state().time < until) {
        flow.step();
        for (const auto& p : flow.state().places)
            for (int k = 0; k < 2; ++k)
                ASSERT_TRUE(p[k] > -0.3 * spacing && p[k] < tank.high[k] + 0.3 * spacing)
                    << p[0] << " " << p[1] << " at " << flow.state().time;
        const auto m = measures(flow);
        ASSERT_LT(m.mean_compression, 0.01);
        mean = std::max(mean, m.mean_compression);
        dense += m.dense, far_from_rest += m.far_from_rest;
        ASSERT_LT(m.kinetic + m.potential, 1.001 * start);
        if (flow.state().time > 10) {
            ASSERT_LT(m.kinetic, 0.02 * start) << flow.state().time;
            kinetic = std::max(kinetic, m.kinetic / start);
            double highest = 0;
            for (const auto& p : flow.state().places) highest = std::max(highest, p[1]);
            ASSERT_LT(highest, 2 * a * 2 * a / (4 * a) * 2);  // two depths
        }
    }
    tell("greatest mean compression", mean);
    tell("share of particles beyond 5%, in thousandths", 1000 * double(far_from_rest) / double(dense));
    tell("greatest kinetic energy from 10 s on, over the energy at the start", kinetic);
    EXPECT_GT(dense, 0u);
    EXPECT_LT(far_from_rest, dense / 1000);
}
TEST(FluidPhysics, ALongDamHasTheDepthsOfRitter) {
    // Depths (2c - x/t)²/(9g) behind a dam that vanishes (Ritter 1892), c² = gH.
    constexpr double H = 0.25, L = 1.5, spacing = H / 20;
    const double c = std::sqrt(g * H);
    const Box<double, 2> tank{{0, 0}, {4.5, 0.4}}, box{{0, 0}, {L, H}};
    FluidOptions<2> options = water<2>(spacing, H);
    FluidState<2> state = filled(box, spacing);
    compress(state, H, options);
    FluidFlow<2> flow(state, walls_of_box(tank, spacing, BoxFaces<2>::open_above()), options);
    const auto front = [&] {
        double most = 0;
        for (const auto& p : flow.state().places) most = std::max(most, p[0]);
        return most;
    };
    flow.advance(4 * std::sqrt(H / g));
    const double before = front(), then = flow.state().time;
    flow.advance(5 * std::sqrt(H / g));
    const double time = flow.state().time, wide = 0.1;
    const auto depth = [&](double x) {
        double sum = 0;
        for (const auto& p : flow.state().places)
            if (std::abs(p[0] - x) < wide / 2) sum += spacing * spacing / wide;
        return sum;
    };
    double squares = 0, columns = 0;
    for (double x = L - 0.9 * c * time; x < L + c * time; x += wide) {
        squares += std::pow(depth(x) - std::pow(2 * c - (x - L) / time, 2) / (9 * g), 2), columns += 1;
    }
    EXPECT_LT(std::sqrt(squares / columns), 0.04 * H);
    tell("rms of depths over H", std::sqrt(squares / columns) / H);
    tell("depth at the gate over 4H/9", (depth(L - wide / 2) + depth(L + wide / 2)) / 2 / (4 * H / 9));
    tell("speed of the tip over √(gH)", (front() - before) / (time - then) / c);
    EXPECT_NEAR((depth(L - wide / 2) + depth(L + wide / 2)) / 2, 4 * H / 9, 0.05 * 4 * H / 9);
    const double tip = (front() - before) / (time - then) / c;
    EXPECT_GT(tip, 1.5);
    EXPECT_LT(tip, 2);
}
TEST(FluidPhysics, AStandingWaveHasThePeriodOfItsLength) {
    // ω² = g·k·tanh(kH) for a wave of small height.
    constexpr double W = 1, H = 0.5, k = pi / W, spacing = H / 25;
    const double height = 0.05 / std::cosh(k * H), omega = std::sqrt(g * k * std::tanh(k * H)),
                 period = 2 * pi / omega;
    const Box<double, 2> tank{{0, 0}, {W, 0.8}}, box{{0, 0}, {W, H}};
    FluidOptions<2> options = water<2>(spacing, H / 2);
    FluidState<2> state = filled(box, spacing);
    compress(state, H, options);
    for (std::size_t i = 0; i < state.size(); ++i) {
        const double x = k * state.places[i][0], y = k * state.places[i][1];
        state.velocities[i] = {height * std::sin(x) * std::cosh(y), -height * std::cos(x) * std::sinh(y)};
    }
    FluidFlow<2> flow(state, walls_of_box(tank, spacing, BoxFaces<2>::open_above()), options);
    std::vector<double> crossings;
    double last = 0, then = 0;
    while (crossings.size() < in_long_runs(9, 3)) {
        flow.step();
        double sum = 0;
        for (std::size_t i = 0; i < state.size(); ++i)
            sum += flow.state().velocities[i][0] * std::sin(k * flow.state().places[i][0]);
        const double time = flow.state().time;
        if (last * sum < 0) crossings.push_back(then + (time - then) * last / (last - sum));
        last = sum, then = time;
        ASSERT_LT(time, 6 * period);
    }
    const double found =
        2 * (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
    EXPECT_NEAR(found / period, 1, 0.02);
    tell("period over that of the theory", found / period);
}

/// The rms of what velocities along a channel of height 1 differ by from exact ones.
template <class F>
double error_in_channel(const FluidFlow<2>& flow, F exact) {
    double sum = 0;
    for (std::size_t i = 0; i < flow.state().size(); ++i)
        sum += std::pow(flow.state().velocities[i][0] - exact(flow.state().places[i][1]), 2);
    const double rms = std::sqrt(sum / static_cast<double>(flow.state().size()));
    tell("rms of velocities over the greatest", rms);
    return rms;
}
FluidFlow<2> channel(double spacing, double viscosity, double push, double belt) {
    FluidOptions<2> options;
    options.spacing = spacing, options.viscosity = viscosity, options.sound = 10;
    options.periods = {0.5, 0}, options.gravity = {push, 0};
    const Box<double, 2> box{{0, 0}, {0.5, 1}};
    BoxFaces<2> faces;
    faces.low[0] = faces.high[0] = false;
    FluidWalls<2> walls = walls_of_box(box, spacing, faces);
    for (const auto& p : walls.places) walls.velocities.push_back({p[1] > 0.5 ? belt : 0, 0});
    return {filled(box, spacing), walls, options};
}
TEST(FluidPhysics, CouetteFlow) {
    // Morris, Fox and Zhu, Modeling low Reynolds number incompressible flows using SPH (1997), section 4.1.
    for (const double viscosity : {1.0, 0.1}) {
        FluidFlow<2> flow = channel(0.05, viscosity, 0, 1);
        for (const double s : {0.05, 0.2, 1.0}) {  // in units of height²/viscosity
            flow.advance(s / viscosity);
            EXPECT_LT(error_in_channel(flow,
                                       [&](double y) {
                                           double v = y;
                                           for (int n = 1; n < 100; ++n)
                                               v += 2 / (n * pi) * (n % 2 == 1 ? -1 : 1) *
                                                    std::sin(n * pi * y) * std::exp(-n * n * pi * pi * s);
                                           return v;
                                       }),
                      0.02);
        }
    }
}
TEST(FluidPhysics, PoiseuilleFlow) {
    for (const double viscosity : {1.0, 0.1}) {
        FluidFlow<2> flow = channel(0.05, viscosity, 8 * viscosity, 0);  // 1 in the middle
        for (const double s : {0.05, 0.2, 1.0}) {
            flow.advance(s / viscosity);
            EXPECT_LT(error_in_channel(flow,
                                       [&](double y) {
                                           double v = 4 * y * (1 - y);
                                           for (int n = 1; n < 100; n += 2)
                                               v -= 32 / std::pow(n * pi, 3) * std::sin(n * pi * y) *
                                                    std::exp(-n * n * pi * pi * s);
                                           return v;
                                       }),
                      0.02);
        }
    }
}
TEST(FluidPhysics, VorticesOfTaylorAndGreenDecay) {
    // Velocities decay as exp(-8π²νt). Particles begin off their lattice by a fifth of a spacing: one that is
    // stretched until it breaks costs energy, and no flow begins with one.
    constexpr double viscosity = 0.01;
    const double spacing = in_long_runs(1, 0) == 1 ? 0.01 : 0.02;
    FluidOptions<2> options;
    options.spacing = spacing, options.viscosity = viscosity, options.sound = 10;
    options.periods = {1, 1}, options.gravity = {};
    FluidState<2> state = filled(Box<double, 2>{{0, 0}, {1, 1}}, spacing);
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(-0.2, 0.2);
    for (std::size_t i = 0; i < state.size(); ++i) {
        for (int k = 0; k < 2; ++k) state.places[i][k] += spacing * unit(random);
        const double x = 2 * pi * state.places[i][0], y = 2 * pi * state.places[i][1];
        state.velocities[i] = {-std::cos(x) * std::sin(y), std::sin(x) * std::cos(y)};
        state.compressions[i] = -0.25 * (std::cos(2 * x) + std::cos(2 * y)) / 100;
    }
    FluidFlow<2> flow(state, {}, options);
    flow.advance(0.5);
    const double before = measures(flow).kinetic;
    flow.advance(2);
    const double rate = std::log(before / measures(flow).kinetic) / 2 / 1.5;
    EXPECT_NEAR(rate / (8 * pi * pi * viscosity), 1, 0.05);
    tell("rate of decay over 8π²ν", rate / (8 * pi * pi * viscosity));
}

}  // namespace
}  // namespace hedgerow
