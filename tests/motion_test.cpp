/// Particles that move: orders, what is conserved, block steps, and motions that go on from a state.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <random>

#include <hedgerow/base/error.h>
#include <hedgerow/nbody/motion.h>
#include <hedgerow/scenes/particles.h>

using namespace hedgerow;

namespace {

/// Two unlike masses on an ellipse about each other, from their greatest distance, 1 + e, on.
Particles pair(double e) {
    Particles two;
    two.resize(2);
    const double speed = std::sqrt((1 - e) / (1 + e));
    two.masses = {0.75, 0.25};
    two.places = {{-0.25 * (1 + e), 0, 0}, {0.75 * (1 + e), 0, 0}};
    two.velocities = {{0, -0.25 * speed, 0}, {0, 0.75 * speed, 0}};
    return two;
}
constexpr MotionOptions exact{.accuracy = 1e-9};

TEST(Motion, OfAPairIsAnEllipse) {
    // After a period of 2π they are back, but for an error that falls with the square of the step.
    double before = 0;
    for (const int steps : {200, 400, 800}) {
        Motion motion(pair(0.3), exact);
        for (int i = 0; i < steps; ++i) motion.step(2 * std::numbers::pi / steps);
        const double error = length(motion.state().particles.places[1] - pair(0.3).places[1]);
        EXPECT_LE(error, 400.0 / (steps * steps));
        if (before > 0) {
            EXPECT_NEAR(before / error, 4, 0.3);
        }
        before = error;
    }
}
TEST(Motion, GoesBackTheWayItCame) {
    Motion there(plummer(500), {.accuracy = 1e-9, .softening = {.length = 0.05}});
    const Particles start = there.state().particles;
    for (int i = 0; i < 50; ++i) there.step(0.01);
    Particles turned = there.state().particles;
    for (auto& v : turned.velocities) v = v * -1.0;
    Motion back(turned, {.accuracy = 1e-9, .softening = {.length = 0.05}});
    for (int i = 0; i < 50; ++i) back.step(0.01);
    for (std::size_t i = 0; i < start.size(); ++i)
        ASSERT_LE(length(back.state().particles.places[i] - start.places[i]), 1e-7);
}
TEST(Motion, ConservesEnergyAndMomenta) {
    Motion motion(plummer(3000), {.accuracy = 1e-3, .softening = {.length = 0.02}});
    const Conserved before = conserved(motion.state());
    for (int i = 0; i < 64; ++i) motion.step(1.0 / 64);
    const Conserved after = conserved(motion.state());
    EXPECT_NEAR(after.energy() / before.energy(), 1, 1e-4);
    EXPECT_LE(length(after.momentum - before.momentum), 1e-7);
    EXPECT_LE(length(after.angular_momentum - before.angular_momentum), 1e-4);
    EXPECT_NEAR(after.virial_ratio(), 1, 0.1);
}
TEST(Motion, ConservedSumsHaveTheSameBitsInAnyOrder) {
    const MotionState state = Motion(plummer(3000)).state();
    const Conserved want = conserved(state);
    // Against long double: the momentum of a Plummer sphere is a small sum of large terms.
    long double momentum = 0, kinetic = 0;
    for (std::size_t i = 0; i < state.particles.size(); ++i) {
        const auto& v = state.particles.velocities[i];
        momentum += v[0] * state.particles.masses[i];
        kinetic += dot(v * state.particles.masses[i], v) / 2;
    }
    EXPECT_EQ(want.momentum[0], static_cast<double>(momentum));
    EXPECT_EQ(want.kinetic, static_cast<double>(kinetic));
    std::mt19937 random(1);
    for (int times = 0; times < 10; ++times) {
        std::vector<std::size_t> order(state.particles.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::shuffle(order.begin(), order.end(), random);
        MotionState shuffled = state;
        for (std::size_t i = 0; i < order.size(); ++i) {
            shuffled.particles.places[i] = state.particles.places[order[i]];
            shuffled.particles.velocities[i] = state.particles.velocities[order[i]];
            shuffled.particles.masses[i] = state.particles.masses[order[i]];
            shuffled.potentials[i] = state.potentials[order[i]];
        }
        const Conserved found = conserved(shuffled);
        EXPECT_EQ(found.kinetic, want.kinetic);
        EXPECT_EQ(found.potential, want.potential);
        EXPECT_EQ(found.momentum, want.momentum);
        EXPECT_EQ(found.angular_momentum, want.angular_momentum);
    }
}
TEST(Motion, InBlockStepsConservesTheSame) {
    const MotionOptions options{.accuracy = 1e-4, .softening = {.length = 0.02}};
    Motion motion(hernquist(2000), options), fixed(hernquist(2000), options);
    const Conserved before = conserved(motion.state());
    std::uint64_t found = 0;
    for (int i = 0; i < 8; ++i) found += motion.block_step(1.0 / 8);
    // The shortest steps of all particles would need many more forces.
    EXPECT_DOUBLE_EQ(motion.state().time, 1);
    EXPECT_GT(found, 8u * 2000u);
    EXPECT_LT(found, 100u * 2000u);
    const Conserved after = conserved(motion.state());
    EXPECT_NEAR(after.energy() / before.energy(), 1, 2e-3);
    EXPECT_LE(length(after.momentum - before.momentum), 1e-3);
}
TEST(Motion, InBlockStepsOfOneLengthIsTheSameMotion) {
    const MotionOptions options{.accuracy = 1e-9, .softening = {.length = 0.1}};
    Motion blocks(plummer(300), options), fixed(plummer(300), options);
    for (int i = 0; i < 5; ++i) {
        EXPECT_EQ(blocks.block_step(0.001), 300u);
        fixed.step(0.001);
    }
    for (std::size_t i = 0; i < 300; ++i)
        EXPECT_EQ(blocks.state().particles.places[i], fixed.state().particles.places[i]);
}
/// Bare steps follow the potential energy: a pair on a long ellipse comes back to where it began.
TEST(Motion, InBareStepsAPairStaysOnItsEllipse) {
    const Particles start = pair(0.95);
    Motion motion(start, exact);
    const double dt = usual_step(motion.state(), 0);
    const BareSteps steps(motion.state(), exact, dt);
    const Conserved before = conserved(motion.state());
    int taken = 0;
    for (const double until : {std::numbers::pi, 2 * std::numbers::pi})
        for (; motion.state().time < until; ++taken) motion.bare_step(steps, until);
    EXPECT_EQ(motion.state().time, 2 * std::numbers::pi);
    EXPECT_LT(taken, 500);
    EXPECT_LE(length(motion.state().particles.places[1] - start.places[1]), 1e-3);
    EXPECT_NEAR(conserved(motion.state()).energy() / before.energy(), 1, 1e-5);
    EXPECT_NEAR(conserved(motion.state()).angular_momentum[2] / before.angular_momentum[2], 1, 1e-9);
    // Steps of one length that are as many are not enough.
    Motion even(start, exact);
    for (int i = 0; i < taken; ++i) even.step(2 * std::numbers::pi / taken);
    EXPECT_GT(length(even.state().particles.places[1] - start.places[1]), 0.1);
}
/// Two masses fall into each other from rest, and come back at the time of free fall.
TEST(Motion, InBareStepsAPairGoesThroughACollision) {
    Particles two;
    two.resize(2);
    two.places[1] = {0.5, 0, 0}, two.masses = {1, 1};
    Motion motion(two, exact);
    const BareSteps steps(motion.state(), exact, usual_step(motion.state(), 0));
    const double fall = std::numbers::pi / 2 * std::sqrt(0.125 / 4);  // π/2·√(r³/(2·G·M))
    while (motion.state().time < 2 * fall) motion.bare_step(steps, 2 * fall);
    const auto& after = motion.state().particles;
    EXPECT_NEAR(length(after.places[1] - after.places[0]), 0.5, 1e-3);
    EXPECT_NEAR(conserved(motion.state()).energy(), -2, 1e-4);
    EXPECT_EQ(motion.state().time, 2 * fall);
}
/// Burrau's problem of three bodies, through encounters, and with the same bits from a state on.
TEST(Motion, InBareStepsThreeBodiesKeepTheirEnergy) {
    Particles three;
    three.resize(3);
    three.places = {{1, 3, 0}, {-2, -1, 0}, {1, -1, 0}}, three.masses = {3, 4, 5};
    Motion motion(three, exact);
    const BareSteps steps(motion.state(), exact, usual_step(motion.state(), 0));
    const Conserved before = conserved(motion.state());
    while (motion.state().time < 5) motion.bare_step(steps, 5);
    Motion rest(motion.state(), exact);
    while (motion.state().time < 10) motion.bare_step(steps, 10), rest.bare_step(steps, 10);
    EXPECT_NEAR(conserved(motion.state()).energy() / before.energy(), 1, 1e-2);
    EXPECT_EQ(motion.state().particles.places, rest.state().particles.places);
    EXPECT_EQ(motion.state().time, 10);
}
TEST(Motion, UsualStepsOfBareParticlesFollowTheirPairs) {
    // On a circle with G = 4 and masses of 1 together the pair of distance 2 turns by √(4/8) a unit of time.
    Particles two = pair(0);
    for (auto& p : two.places) p = p * 2.0;
    for (auto& v : two.velocities) v = v * 1.4;
    const Motion motion(two, {.gravity = 4});
    const double step = usual_step(motion.state(), 0, 0.1, 4);
    EXPECT_LE(step, 0.1 * std::sqrt(8.0 / 4));
    EXPECT_GT(step, 0.05 * std::sqrt(8.0 / 4));
    // Nine in one place do not act on each other, and one far away acts on them.
    Particles crowd;
    crowd.resize(10);
    crowd.masses.assign(10, 1);
    crowd.places[9] = {1, 0, 0};
    EXPECT_EQ(usual_softening(crowd), 0);
    EXPECT_LE(usual_step(Motion(crowd).state(), 0), 0.025 * std::sqrt(0.5));
    EXPECT_EQ(usual_step(Motion(Particles{}).state(), 0), 1);
}
TEST(Motion, GoesOnFromAStateWithTheSameBits) {
    const MotionOptions options{.accuracy = 1e-3, .softening = {.length = 0.02}};
    Motion whole(plummer(2000), options);
    for (int i = 0; i < 5; ++i) whole.step(0.01);
    Motion rest(whole.state(), options);
    for (int i = 0; i < 5; ++i) whole.step(0.01), rest.step(0.01);
    EXPECT_EQ(whole.state().particles.places, rest.state().particles.places);
    EXPECT_EQ(whole.state().particles.velocities, rest.state().particles.velocities);
    EXPECT_EQ(whole.state().accelerations, rest.state().accelerations);
    EXPECT_EQ(whole.state().time, rest.state().time);
}
/// In a cube that repeats: particles leave by one face and come back by the other, energy and momentum are
/// kept, and even particles at rest clump.
TEST(Motion, InAPeriodicCube) {
    const MotionOptions options{.accuracy = 1e-4, .softening = {.length = 0.02}, .period = 1};
    Motion motion(cold_cube(1000), options);
    const Conserved before = conserved(motion.state());
    for (int i = 0; i < 60; ++i) motion.step(1.0 / 128);
    const Conserved after = conserved(motion.state());
    EXPECT_NEAR(after.energy(), before.energy(), 0.002 * after.kinetic);
    EXPECT_GT(after.kinetic, 0.01);
    EXPECT_LE(length(after.momentum), 1e-6);
    for (const Vec3d& p : motion.state().particles.places)
        for (int k = 0; k < 3; ++k) EXPECT_TRUE(p[k] >= 0 && p[k] < 1);
    // Through a face, alone.
    Particles one;
    one.resize(1);
    one.places[0] = {0.9, 0.1, 0.5}, one.velocities[0] = {0.4, -0.4, 0}, one.masses[0] = 1;
    Motion through(one, options);
    through.step(0.5);
    EXPECT_LE(length(through.state().particles.places[0] - Vec3d(0.1, 0.9, 0.5)), 1e-6);
}
TEST(Motion, OfNoneAndOfOne) {
    Motion none{Particles()};
    none.step(0.1);
    EXPECT_EQ(none.state().particles.size(), 0u);
    Particles one;
    one.resize(1);
    one.masses[0] = 1, one.velocities[0] = {1, 0, 0};
    Motion alone(one, {.softening = {.length = 0.1}});
    alone.step(0.5);
    EXPECT_EQ(alone.block_step(0.5), 1u);
    EXPECT_EQ(alone.state().particles.places[0], Vec3d(1, 0, 0));
}
TEST(Motion, RefusesBadInput) {
    Particles bad = plummer(10);
    bad.masses.pop_back();
    EXPECT_THROW(Motion{bad}, InputError);
    bad = plummer(10);
    bad.places[3][1] = std::nan("");
    EXPECT_THROW(Motion{bad}, InputError);
    EXPECT_THROW(Motion(plummer(10)).block_step(0.1), UsageError);
    const MotionState ten = Motion(plummer(10)).state();
    EXPECT_NO_THROW(BareSteps(ten, {}, 0.1));
    EXPECT_THROW(BareSteps(ten, {.softening = {.length = 0.1}}, 0.1), UsageError);
    EXPECT_THROW(BareSteps(ten, {.period = 100}, 0.1), UsageError);
    EXPECT_THROW(BareSteps(Motion(plummer(1)).state(), {}, 0.1), UsageError);
    EXPECT_THROW(Motion(plummer(10), {.softening = {.length = -1}}), InputError);
}

}  // namespace
