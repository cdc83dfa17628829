/// Environments: lookups, densities, samples, and what is no environment.
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <utility>

#include <hedgerow/render/lighting/default_sky.h>
#include <hedgerow/render/lighting/environment_map.h>

#include "lights_of_tests.h"

using namespace hedgerow;
using namespace hedgerow::test;

namespace {

/// An environment whose grey texels are f(column, row).
template <class F>
Environment panorama(int width, int height, const F& f) {
    std::vector<float> samples;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) samples.push_back(f(x, y));
    Environment e;
    e.panorama.name = "a panorama";
    e.panorama.pixels = std::make_shared<const Pixels>(Pixels{width, height, 1, samples});
    return e;
}
/// Random texels, a few of them bright.
Environment random_panorama(int width, int height, std::uint64_t seed) {
    Random random(seed);
    return panorama(width, height, [&](int, int) {
        const double factor = random.uniform() < 0.05 ? 50 : 1;
        return float(factor * random.uniform());
    });
}
/// The direction in the environment's own space of a place of the panorama, from 0 to 1 across and down.
Vec3f direction_of(double across, double down) {
    const double theta = pi * down, phi = 2 * pi * (across - 0.5);
    return Vec3f(Vec3d(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)));
}
double radiance_of(const EnvironmentMap& map, const Vec3f& direction) {
    return double(map.radiance(direction)[0]);
}
double sum_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double v : values) sum += v;
    return sum;
}
/// A rotation by an angle about an axis.
Rows<3> rotation(const Vec3d& axis, double angle) {
    return Transform<3>::rotation(axis, angle).there().linear;
}

struct Case {
    Environment environment;
    EnvironmentMapOptions options;
};
std::vector<Case> cases() {
    std::vector<Case> all;
    for (const bool compensates : {false, true}) {
        all.push_back({random_panorama(16, 8, 1), {.compensates = compensates}});
        all.push_back({random_panorama(7, 5, 2), {.compensates = compensates}});
        all.push_back(
            {random_panorama(64, 32, 3), {.compensates = compensates, .most_columns = 10, .most_rows = 7}});
        all.push_back({random_panorama(1, 9, 4), {.compensates = compensates}});
        all.push_back({random_panorama(20, 10, 5), {.compensates = compensates}});
        all.back().environment.panorama.filter = TextureFilter::nearest;
        all.back().environment.to_world = rotation({1, 2, 3}, 1);
        all.push_back({default_sky(), {.compensates = compensates}});
    }
    return all;
}

TEST(EnvironmentMap, WithoutPixelsIsAllOneRadiance) {
    Environment e;
    e.radiance = {1, 2, 3};
    const EnvironmentMap map(e);
    EXPECT_EQ(map.columns() * map.rows(), 1u);
    Random random(1);
    for (int i = 0; i < 100; ++i) {
        const Vec2f uv = in_square(random);
        const EnvironmentSample s = map.sample(uv[0], uv[1]);
        EXPECT_EQ(s.radiance, Vec3f(1, 2, 3));
        EXPECT_NEAR(s.density, 1 / (4 * pi), 1e-8);
        EXPECT_NEAR(length(s.direction), 1, 1e-6);
        EXPECT_EQ(map.density(s.direction), s.density);
    }
    EXPECT_LT(length(map.mean() - Vec3f(1, 2, 3)), 1e-6f);
}

TEST(EnvironmentMap, DensitiesIntegrateToOne) {
    for (const Case& c : cases()) {
        const EnvironmentMap map(c.environment, c.options);
        const SphereGrid grid{64, 64};
        EXPECT_NEAR(sum_of(grid.integrals(12, [&](const Vec3f& d) { return double(map.density(d)); })), 1,
                    4e-3);
    }
}

TEST(EnvironmentMap, SamplesHaveTheirDensity) {
    constexpr int samples = 50000;
    const SphereGrid grid{13, 11};
    for (const Case& c : cases()) {
        const EnvironmentMap map(c.environment, c.options);
        const auto probabilities = grid.integrals(60, [&](const Vec3f& d) { return double(map.density(d)); });
        std::vector<double> counts(grid.size());
        Random random(7);
        for (int i = 0; i < samples; ++i) {
            const Vec2f uv = in_square(random);
            counts[grid.cell(map.sample(uv[0], uv[1]).direction)] += 1;
        }
        EXPECT_LT(chi_square_score(counts, probabilities, samples), 4);
    }
}

TEST(EnvironmentMap, SamplesHaveTheRadianceAndTheDensityOfTheirDirection) {
    auto all = cases();
    for (const auto& [columns, rows] : {std::pair(2, 1), {3, 2}, {1024, 512}, {4096, 3}}) {
        all.push_back({random_panorama(columns, rows, 6), {}});
        all.back().environment.to_world = rotation({1, -2, 3}, 2);
        all.push_back(all.back());
        all.back().environment.panorama.filter = TextureFilter::nearest;
    }
    for (const Case& c : all) {
        const EnvironmentMap map(c.environment, c.options);
        Random random(8);
        int unlikely = 0;
        for (int i = 0; i < 20000; ++i) {
            const Vec2f uv = in_square(random);
            const EnvironmentSample s = map.sample(uv[0], uv[1]), there = map.at(s.direction);
            ASSERT_NEAR(length(s.direction), 1, 1e-6);
            ASSERT_EQ(there.density, s.density);
            ASSERT_EQ(map.density(s.direction), s.density);
            ASSERT_EQ(there.radiance, s.radiance);
            ASSERT_EQ(map.radiance(s.direction), s.radiance);
            unlikely += s.density == 0;
        }
        EXPECT_LE(unlikely, 4);  // the directions that are rounded into a cell of density 0
    }
}

TEST(EnvironmentMap, WhereThereIsLightThereIsDensity) {
    for (const TextureFilter filter : {TextureFilter::nearest, TextureFilter::bilinear})
        for (const int row : {0, 3, 7})
            for (const int column : {0, 5, 15}) {
                Environment e =
                    panorama(16, 8, [&](int x, int y) { return x == column && y == row ? 1.0f : 0.0f; });
                e.panorama.filter = filter;
                const EnvironmentMap map(e, {.compensates = false});
                Random random(9);
                int lit = 0;
                for (int i = 0; i < 20000; ++i) {
                    const Vec3f d(random.direction<3>());
                    if (!(radiance_of(map, d) > 1e-5)) continue;
                    ++lit;
                    ASSERT_GT(map.density(d), 0);
                }
                EXPECT_GT(lit, 10);
            }
}

TEST(EnvironmentMap, CompensationLeavesOutWhatIsDarkerThanTheMean) {
    const auto e = panorama(16, 8, [](int x, int y) { return x == 4 && y == 3 ? 100.0f : 1.0f; });
    const EnvironmentMap map(e), whole(e, {.compensates = false});
    const Vec3f bright = direction_of(4.5 / 16, 3.5 / 8), dark = direction_of(0.8, 0.5);
    EXPECT_EQ(map.density(dark), 0);
    EXPECT_GT(whole.density(dark), 0);
    EXPECT_GT(map.density(bright), whole.density(bright));
    // Nothing is left out of a map that is flat, or almost so.
    Random random(3);
    const EnvironmentMap flat(panorama(16, 8, [&](int, int) { return 1 + 1e-4f * float(random.uniform()); }));
    for (int i = 0; i < 1000; ++i)
        EXPECT_NEAR(flat.density(Vec3f(random.direction<3>())), 1 / (4 * pi), 1e-4);
}

/// A mean with its standard error.
struct Estimate {
    double sum = 0, squares = 0;
    int count = 0;

    void add(double x) { sum += x, squares += x * x, ++count; }
    double mean() const { return sum / count; }
    double error() const { return std::sqrt((squares / count - mean() * mean()) / count); }
};

TEST(EnvironmentMap, IrradianceOfSamplesIsUnbiased) {
    for (const Case& c : cases()) {
        const EnvironmentMap map(c.environment, c.options);
        const Vec3f n(normalized(Vec3d(1, 2, -0.5)));
        const auto cosine_to = [&](const Vec3f& d) { return std::max(0.0, double(dot(n, d))); };
        const double exact = sum_of(SphereGrid{64, 64}.integrals(
            8, [&](const Vec3f& d) { return radiance_of(map, d) * cosine_to(d); }));
        // Uniform directions stand for the samples of a material.
        constexpr double uniform = 1 / (4 * pi);
        Random random(10);
        Estimate estimate;
        for (int i = 0; i < 20000; ++i) {
            const Vec2f uv = in_square(random);
            const EnvironmentSample s = map.sample(uv[0], uv[1]);
            double value = double(s.radiance[0]) * cosine_to(s.direction);
            if (c.options.compensates) {
                value /= double(s.density) + uniform;
                const Vec3f d(random.direction<3>());
                value += radiance_of(map, d) * cosine_to(d) / (double(map.density(d)) + uniform);
            } else {
                value /= double(s.density);
            }
            estimate.add(value);
        }
        EXPECT_LT(std::abs(estimate.mean() - exact), 4 * estimate.error() + 1e-3 * exact);
        EXPECT_LT(estimate.error(), 0.05 * exact);
    }
}

TEST(EnvironmentMap, TexelsLieWhereTheConventionSays) {
    const auto value = [](int x, int y) { return float(1 + x + 16 * y); };
    const EnvironmentMap map(panorama(16, 8, value));
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x)
            EXPECT_NEAR(radiance_of(map, direction_of((x + 0.5) / 16, (y + 0.5) / 8)), double(value(x, y)),
                        1e-3);
    // Middle column at −z, +x right of it, top row at +y.
    const EnvironmentMap four(panorama(4, 2, [](int x, int y) { return float(x + 4 * y); }));
    const float h = std::sqrt(0.5f), s = 0.5f;
    EXPECT_NEAR(radiance_of(four, {s, h, -s}), 2, 1e-5);
    EXPECT_NEAR(radiance_of(four, {s, h, s}), 3, 1e-5);
    EXPECT_NEAR(radiance_of(four, {-s, h, -s}), 1, 1e-5);
    EXPECT_NEAR(radiance_of(four, {-s, -h, s}), 4, 1e-5);
}

TEST(EnvironmentMap, LookupsAreContinuousAtTheSeamAndBeyondThePoles) {
    const EnvironmentMap map(random_panorama(16, 8, 11));
    const auto texel = [&](int x, int y) {
        return radiance_of(map, direction_of((x + 0.5) / 16, (y + 0.5) / 8));
    };
    for (int y = 0; y < 8; ++y) {
        const double left = radiance_of(map, direction_of(1e-6, (y + 0.5) / 8)),
                     right = radiance_of(map, direction_of(1 - 1e-6, (y + 0.5) / 8));
        EXPECT_NEAR(left, right, 1e-3);
        EXPECT_NEAR(left, (texel(0, y) + texel(15, y)) / 2, 1e-3);
    }
    for (int x = 0; x < 16; ++x) {
        const double top = radiance_of(map, direction_of((x + 0.5) / 16, 1e-5)),
                     bottom = radiance_of(map, direction_of((x + 0.5) / 16, 1 - 1e-5));
        EXPECT_NEAR(top, (texel(x, 0) + texel((x + 8) % 16, 0)) / 2, 0.02);
        EXPECT_NEAR(bottom, (texel(x, 7) + texel((x + 8) % 16, 7)) / 2, 0.02);
    }
    for (const Vec3f& pole : {Vec3f(0, 1, 0), Vec3f(0, -1, 0), Vec3f(-0.0f, 1, -0.0f), Vec3f(0, 0, 1)}) {
        EXPECT_TRUE(finite(map.radiance(pole)));
        EXPECT_TRUE(std::isfinite(map.density(pole)));
    }
}

TEST(EnvironmentMap, RotationTurnsEverything) {
    Environment e = random_panorama(16, 8, 12);
    const EnvironmentMap plain(e, {.compensates = false});
    const auto turn = Transform<3>::rotation({1, -2, 0.5}, 2).there();
    e.to_world = turn.linear;
    const EnvironmentMap turned(e, {.compensates = false});
    Random random(13);
    int differ = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3d d = random.direction<3>();
        const Vec3f there(turn.vector(d));
        EXPECT_NEAR(radiance_of(turned, there), radiance_of(plain, Vec3f(d)), 2e-3);
        differ += std::abs(turned.density(there) - plain.density(Vec3f(d))) > 1e-5f;
        const float u = float(random.uniform()), v = float(random.uniform());
        EXPECT_LT(
            length(turned.sample(u, v).direction - Vec3f(turn.vector(Vec3d(plain.sample(u, v).direction)))),
            1e-6f);
    }
    EXPECT_LE(differ, 2);  // at the edges of cells
}

TEST(EnvironmentMap, TheMeanIsThatOverDirections) {
    const Environment e = random_panorama(32, 16, 14);
    const EnvironmentMap map(e);
    const double mean =
        sum_of(SphereGrid{64, 64}.integrals(4, [&](const Vec3f& d) { return radiance_of(map, d); })) /
        (4 * pi);
    EXPECT_NEAR(double(map.mean()[0]) / mean, 1, 0.01);
}

TEST(EnvironmentMap, BadTexelsAreNamed) {
    for (const float bad :
         {-1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        const auto e = panorama(
            9, 5, [&](int x, int y) { return (x == 7 && y == 2) || (x == 3 && y == 3) ? bad : 1.0f; });
        try {
            const EnvironmentMap map(e);
            FAIL() << "a texel of " << bad << " was taken";
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find("(column 7, row 2)"), std::string::npos) << error.what();
        }
    }
    // A texel that is finite, but not after the multiplication.
    auto bright = panorama(2, 2, [](int, int) { return 1e30f; });
    bright.radiance = Vec3f::all(1e30f);
    EXPECT_THROW(EnvironmentMap{bright}, InputError);
    Environment e;
    e.radiance = {1, -1, 1};
    EXPECT_THROW(EnvironmentMap{e}, InputError);
    e = {};
    e.to_world[0] = Vec3d(2, 0, 0);
    EXPECT_THROW(EnvironmentMap{e}, InputError);
}

TEST(EnvironmentMap, ABlackOneGivesNoLight) {
    const EnvironmentMap map(panorama(4, 2, [](int, int) { return 0.0f; }));
    EXPECT_FALSE(map.lit());
    EXPECT_EQ(map.sample(0.5f, 0.5f).density, 0);
    EXPECT_EQ(map.density({0, 1, 0}), 0);
    EXPECT_EQ(map.radiance({0, 1, 0}), Vec3f());
    Emitters emitters;
    EXPECT_EQ(emitters.add(map), no_emitter);
    EXPECT_EQ(emitters.dark(), 1u);
}

TEST(EnvironmentMap, TheDefaultSkyLightsWhatLiesFlatAboutAsWhite) {
    for (const Vec3f& up :
         {Vec3f(0, 1, 0), Vec3f(0, 0, 1), Vec3f(0, 0, -3), Vec3f(0.3f, -2, 0.5f), Vec3f()}) {
        const Environment sky = default_sky(up);
        const EnvironmentMap map(sky);
        const Vec3f zenith(normalized(up == Vec3f() ? Vec3d(0, 1, 0) : Vec3d(up)));
        Vec3d irradiance;
        for (int k = 0; k < 3; ++k)
            irradiance[k] = sum_of(SphereGrid{32, 32}.integrals(
                                4,
                                [&](const Vec3f& d) {
                                    return double(map.radiance(d)[k]) * std::max(0.0, double(dot(d, zenith)));
                                })) /
                            pi;
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(irradiance[k], 1, 0.15) << k;
        EXPECT_LT(length(map.radiance(zenith) - EnvironmentMap(default_sky()).radiance({0, 1, 0})), 0.05f);
        // The horizon is brighter than the ground.
        const Vec3f beside(normalized(cross(Vec3d(zenith), Vec3d(1, 0, 0))));
        EXPECT_GT(map.radiance(normalized(beside + zenith * 0.1f))[2], map.radiance(-zenith)[2]);
    }
}

}  // namespace
