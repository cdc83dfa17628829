/// Hard spheres that bounce: what they keep, which pairs do, bad input.
#include <gtest/gtest.h>

#include <hedgerow/base/error.h>
#include <hedgerow/nbody/contacts.h>
#include <hedgerow/scenes/random.h>

using namespace hedgerow;

namespace {

Particles two(const Vec3d& apart, double mass, const Vec3d& velocity) {
    Particles all;
    all.resize(2);
    all.places[1] = apart, all.velocities[0] = velocity, all.masses = {1, mass};
    return all;
}
const std::vector<double> halves{0.5, 0.5};

TEST(Contacts, OfTwoSpheres) {
    // Equal ones exchange what is along their centers.
    Particles all = two({0.9, 0, 0}, 1, {2, 3, 0});
    EXPECT_EQ(bounce(all, halves), 1u);
    EXPECT_EQ(all.velocities[0], Vec3d(0, 3, 0));
    EXPECT_EQ(all.velocities[1], Vec3d(2, 0, 0));
    EXPECT_EQ(bounce(all, halves), 0u);  // they part
    // A light one bounces off a heavy one; without restitution both go on together.
    all = two({0, 0, 1}, 1e9, {0, 0, 1});
    EXPECT_EQ(bounce(all, halves), 1u);
    EXPECT_NEAR(all.velocities[0][2], -1, 1e-8);
    all = two({0, 1, 0}, 3, {0, 4, 0});
    EXPECT_EQ(bounce(all, halves, 0), 1u);
    EXPECT_EQ(all.velocities[0], Vec3d(0, 1, 0));
    EXPECT_EQ(all.velocities[1], Vec3d(0, 1, 0));
    // Not those that are too far apart, part, or lie in one place.
    for (Particles other :
         {two({1.01, 0, 0}, 1, {2, 0, 0}), two({0.9, 0, 0}, 1, {-2, 0, 0}), two({}, 1, {1, 0, 0})})
        EXPECT_EQ(bounce(other, halves), 0u);
    all = two({1.2, 0, 0}, 1, {1, 0, 0});
    EXPECT_EQ(bounce(all, std::vector{1.0, 0.1}), 0u);
    EXPECT_EQ(bounce(all, std::vector{1.0, 0.3}), 1u);
}
TEST(Contacts, KeepEnergyAndMomentumForAnyExecutor) {
    Particles all;
    all.resize(5000);
    std::vector<double> radii;
    for (std::uint64_t i = 0; i < all.size(); ++i) {
        Random random(3, i);
        all.places[i] = random.in_cube<3>(), all.velocities[i] = random.direction<3>();
        all.masses[i] = 0.5 + random.uniform(), radii.push_back(0.02 * random.uniform());
    }
    Particles serial = all, parallel = all;
    const std::size_t contacts = bounce(serial, radii, 1, serial_executor());
    EXPECT_GT(contacts, 100u);
    EXPECT_EQ(bounce(parallel, radii, 1, default_executor()), contacts);
    EXPECT_EQ(serial.velocities, parallel.velocities);
    double before = 0, after = 0;
    Vec3d momentum;
    for (std::size_t i = 0; i < all.size(); ++i) {
        before += all.masses[i] * length2(all.velocities[i]),
            after += all.masses[i] * length2(serial.velocities[i]);
        momentum += (serial.velocities[i] - all.velocities[i]) * all.masses[i];
    }
    EXPECT_NEAR(after / before, 1, 1e-12);
    EXPECT_LE(length(momentum), 1e-11);
}
TEST(Contacts, RefuseBadInput) {
    Particles none;
    EXPECT_EQ(bounce(none, {}), 0u);
    Particles all = two({1, 0, 0}, 1, {1, 0, 0});
    EXPECT_THROW(bounce(all, std::vector{0.5}), InputError);
    EXPECT_THROW(bounce(all, std::vector{0.5, -1.0}), InputError);
    EXPECT_THROW(bounce(all, std::vector{0.5, std::nan("")}), InputError);
    EXPECT_THROW(bounce(all, halves, 2), UsageError);
    all.masses[1] = 0;
    EXPECT_THROW(bounce(all, halves), InputError);
    all.masses[1] = 1, all.places[1][2] = std::nan("");
    EXPECT_THROW(bounce(all, halves), InputError);
}

}  // namespace
