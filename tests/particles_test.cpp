/// Generated particles: what each model is, by sums over all pairs.
#include <gtest/gtest.h>

#include <numbers>

#include <hedgerow/base/error.h>
#include <hedgerow/nbody/direct_sum.h>
#include <hedgerow/nbody/motion.h>
#include <hedgerow/scenes/generate.h>

using namespace hedgerow;

namespace {

Conserved sums_of(const Particles& all) {
    MotionState state{0, all, {}, {}};
    std::vector<PotentialAt<double>> found(all.size());
    direct_sum<double>({all.places, all.masses}, all.places, found);
    for (const auto& at : found) state.potentials.push_back(-at.potential);
    return conserved(state);
}
/// The share of particles within a distance of the origin.
double share_within(const Particles& all, double radius) {
    std::size_t inside = 0;
    for (const Vec3d& p : all.places) inside += length(p) <= radius;
    return static_cast<double>(inside) / static_cast<double>(all.size());
}

TEST(Particles, OfModelsInEquilibriumAreInIt) {
    constexpr std::size_t n = 20000;
    for (const Particles& all : {plummer(n), hernquist(n), uniform_sphere(n)}) {
        const Conserved sums = sums_of(all);
        EXPECT_NEAR(sums.virial_ratio(), 1, 0.03);
        EXPECT_NEAR(sums.energy(), -0.25, 0.01);
        EXPECT_LE(length(sums.momentum), 0.02);
    }
}
TEST(Particles, LieAsTheirModelsSay) {
    constexpr std::size_t n = 50000;
    // Plummer's: a share (1 + r⁻²)^(−3/2) of a thousandth less than all within r radii.
    const Particles sphere = plummer(n);
    constexpr double radius = 3 * std::numbers::pi / 16;
    for (const double r : {0.5, 1.0, 3.0})
        EXPECT_NEAR(share_within(sphere, r * radius), std::pow(1 + 1 / (r * r), -1.5) / 0.999, 0.01) << r;
    const Particles galaxy = hernquist(n);
    for (const double r : {0.1, 1.0, 10.0})
        EXPECT_NEAR(share_within(galaxy, r / 3), std::pow(r / (1 + r) * 301 / 300, 2), 0.01) << r;
    for (const double r : {0.3, 0.6, 1.0}) {
        EXPECT_NEAR(share_within(uniform_sphere(n), r * 1.2), r * r * r, 0.01);
        EXPECT_NEAR(share_within(cold_collapse(n), r), r * r * r, 0.01);
    }
    for (const Vec3d& v : cold_collapse(100).velocities) EXPECT_EQ(v, Vec3d());
    // Kuzmin's disc is thin, and its velocities are across the radius.
    const Particles flat = disc(n);
    for (std::size_t i = 0; i < n; ++i) {
        EXPECT_LE(std::abs(flat.places[i][2]), 0.041);
        EXPECT_NEAR(flat.places[i][0] * flat.velocities[i][0] + flat.places[i][1] * flat.velocities[i][1], 0,
                    1e-12);
    }
    EXPECT_NEAR(share_within(flat, 1), (1 - 1 / std::sqrt(2.0)) / (1 - 1 / std::sqrt(101.0)), 0.01);
}
TEST(Particles, AreThePointsOfTheirScene) {
    for (const SceneInfo& info : scene_list()) {
        const SceneSpec spec{std::string(info.name), 100, 3};
        if (info.particles == nullptr) {
            EXPECT_THROW(generate_particles(spec), UsageError) << info.name;
            continue;
        }
        const Particles all = generate_particles(spec);
        const Scene<double> scene = generate<double>(spec);
        EXPECT_EQ(all.places, (std::get<PointCloud<double, 3>>(scene).points)) << info.name;
        EXPECT_EQ(all.size(), 100u);
        double mass = 0;
        for (const double m : all.masses) mass += m;
        EXPECT_NEAR(mass, 1, 1e-12);
    }
}

}  // namespace
