/// Light sources: densities, closed forms of the irradiance, sides, and what is no light.
#include <gtest/gtest.h>

#include <limits>

#include <hedgerow/render/lighting/default_sky.h>
#include <hedgerow/render/lighting/emitters.h>

#include "lights_of_tests.h"

using namespace hedgerow;
using namespace hedgerow::test;

namespace {

/// The solid angle of a triangle (Van Oosterom & Strackee 1983).
double solid_angle(const EmissiveTriangle& t, const Vec3f& point) {
    const Vec3d a = normalized(Vec3d(t.a) - Vec3d(point)), b = normalized(Vec3d(t.b) - Vec3d(point)),
                c = normalized(Vec3d(t.c) - Vec3d(point));
    return std::abs(2 * std::atan2(dot(a, cross(b, c)), 1 + dot(a, b) + dot(b, c) + dot(c, a)));
}
/// The distance at which a ray from a point hits a triangle; 0 if it does not (Möller & Trumbore 1997).
double hit_distance(const EmissiveTriangle& t, const Vec3f& point, const Vec3f& direction) {
    const Vec3d d(direction), ab = Vec3d(t.b) - Vec3d(t.a), ac = Vec3d(t.c) - Vec3d(t.a),
                              from = Vec3d(point) - Vec3d(t.a);
    const Vec3d p = cross(d, ac), q = cross(from, ab);
    const double det = dot(ab, p), u = dot(from, p) / det, v = dot(d, q) / det, far = dot(ac, q) / det;
    return u >= 0 && v >= 0 && u + v <= 1 && far > 0 ? far : 0;
}
bool sound(const LightSample& s) {
    return finite(s.direction) && finite(s.radiance) && std::isfinite(s.density) && s.density >= 0 &&
           !std::isnan(s.distance);
}

TEST(Lighting, ADiscOfTrianglesHasTheIrradianceOfADisc) {
    constexpr int parts = 256;
    const float radius = 1, height = 0.75f;
    double sum = 0;
    std::vector<Vec3d> corners;
    const auto corner = [&](int i) {
        const double angle = 2 * pi * i / parts;
        return Vec3f(
            Vec3d(double(radius) * std::cos(angle), double(height), double(radius) * std::sin(angle)));
    };
    for (int i = 0; i < parts; ++i) {
        corners.push_back(Vec3d(corner(i)));
        const EmissiveTriangle t{{0, height, 0}, corner(i), corner(i + 1), Vec3f::all(2), false};
        ASSERT_LT(t.normal()[1], 0);  // it faces down
        sum += irradiance_by(t, {}, {0, 1, 0}, 24);
    }
    EXPECT_NEAR(sum / (2 * lambert(corners, {}, {0, 1, 0})), 1, 5e-4);
    const double disc = 2 * pi / (1 + double(height) * double(height));
    EXPECT_NEAR(sum / disc, 1, 1e-3);
}

TEST(Lighting, TrianglesHaveTheIrradianceOfPolygons) {
    Random random(1);
    for (int k = 0; k < 50; ++k) {
        EmissiveTriangle t = random_triangle(random, 1);
        t.both_sides = true;
        t.radiance = Vec3f::all(3);
        // Below all corners, so that none is below the horizon.
        const Vec3f point(0.2f, -3, 0.1f), normal(0, 1, 0);
        const double exact = 3 * lambert({Vec3d(t.a), Vec3d(t.b), Vec3d(t.c)}, Vec3d(point), Vec3d(normal));
        EXPECT_NEAR(irradiance_by(t, point, normal, 48), exact, 2e-3 * exact + 1e-7) << k;
    }
}

TEST(Lighting, DensitiesOfTrianglesIntegrateToOne) {
    Random random(2);
    for (int k = 0; k < 50; ++k) {
        EmissiveTriangle t = random_triangle(random, 1);
        t.both_sides = true;
        const Vec3f point = random_point(random, 2, 3);
        // The mean of 1 / density is the solid angle, if samples have that density.
        constexpr int side = 64;
        double sum = 0;
        for (int i = 0; i < side * side; ++i) {
            const int column = i % side, row = i / side;
            const LightSample s = t.sample(point, (float(column) + 0.5f) / side, (float(row) + 0.5f) / side);
            sum += 1 / double(s.density);
        }
        const double exact = solid_angle(t, point);
        EXPECT_NEAR(sum / side / side, exact, 2e-3 * exact + 1e-9) << k;
    }
}

TEST(Lighting, SamplesOfATriangleHaveTheirDensity) {
    const EmissiveTriangle t{{-1, 0.6f, -0.5f}, {0.4f, 0.5f, 1}, {1.5f, 1.5f, -0.7f}, Vec3f::all(1), true};
    const SphereGrid grid{24, 24};
    const auto probabilities = grid.integrals(
        48, [&](const Vec3f& d) { return double(t.density_toward(d, float(hit_distance(t, {}, d)))); });
    double whole = 0;
    for (const double p : probabilities) whole += p;
    EXPECT_NEAR(whole, 1, 2e-3);
    constexpr int samples = 100000;
    std::vector<double> counts(grid.size());
    Random random(3);
    for (int i = 0; i < samples; ++i) {
        const Vec2f uv = in_square(random);
        const LightSample s = t.sample({}, uv[0], uv[1]);
        ASSERT_NEAR(length(s.direction), 1, 1e-6);
        counts[grid.cell(s.direction)] += 1;
    }
    EXPECT_LT(chi_square_score(counts, probabilities, samples), 4);
}

TEST(Lighting, AHitHasTheDensityOfTheSampleInTheSameBits) {
    Random random(4);
    Emitters emitters;
    for (int i = 0; i < 100; ++i) emitters.add(random_triangle(random, 1));
    for (std::size_t i = 0; i < emitters.size(); ++i) {
        const Vec3f point = random_point(random, -2, 2);
        const Vec2f uv = in_square(random);
        const LightSample s = emitters.sample(i, point, uv[0], uv[1]);
        EXPECT_EQ(s.density, emitters.density_toward(i, s.direction, s.distance));
        EXPECT_EQ(s.radiance, emitters.radiance_toward(i, s.direction));
        // The weights are those of the place.
        const auto& t = std::get<EmissiveTriangle>(emitters[i]);
        const Vec3f at = t.a + (t.b - t.a) * s.weights[0] + (t.c - t.a) * s.weights[1];
        EXPECT_LT(length(point + s.direction * s.distance - at), 1e-5f);
    }
}

TEST(Lighting, OnlyTheFrontsOfTrianglesEmitUnlessBothSidesDo) {
    // Counterclockwise seen from +z.
    const EmissiveTriangle one{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Vec3f::all(1), false};
    EmissiveTriangle two = one;
    two.both_sides = true;
    const Vec3f before(0.2f, 0.2f, 1), behind(0.2f, 0.2f, -1);
    EXPECT_TRUE(one.sample(before, 0.3f, 0.4f));
    EXPECT_FALSE(one.sample(behind, 0.3f, 0.4f));
    EXPECT_EQ(one.sample(behind, 0.3f, 0.4f).radiance, Vec3f());
    EXPECT_EQ(one.density_toward({0, 0, 1}, 1), 0);
    EXPECT_GT(one.density_toward({0, 0, -1}, 1), 0);
    EXPECT_EQ(one.radiance_toward({0, 0, 1}), Vec3f());
    EXPECT_EQ(one.radiance_toward({0, 0, -1}), Vec3f::all(1));
    for (const Vec3f& point : {before, behind}) EXPECT_TRUE(two.sample(point, 0.3f, 0.4f));
    EXPECT_EQ(two.sample(before, 0.3f, 0.4f).density, two.sample(behind, 0.3f, 0.4f).density);
    EXPECT_EQ(two.radiance_toward({0, 0, 1}), Vec3f::all(1));
    // No light in the plane.
    EXPECT_FALSE(two.sample({3, 0, 0}, 0.3f, 0.4f));
}

TEST(Lighting, APointFallsWithTheSquareOfTheDistance) {
    Emitters emitters;
    emitters.add(PointLight{"", {1, 2, 3}, {6, 12, 18}});
    const LightSample s = emitters.sample(0, {1, 2, 1}, 0.5f, 0.5f);
    EXPECT_TRUE(s.single);
    EXPECT_EQ(s.density, 0);
    EXPECT_EQ(s.direction, Vec3f(0, 0, 1));
    EXPECT_EQ(s.distance, 2);
    EXPECT_EQ(s.radiance, Vec3f(1.5f, 3, 4.5f));
    EXPECT_EQ(emitters.density_toward(0, {0, 0, 1}, 2), 0);
    EXPECT_FALSE(emitters.sample(0, {1, 2, 3}, 0.5f, 0.5f));
    EXPECT_NEAR(emitters.power(0, 1), 4 * pi * 12, 1e-6);
}

TEST(Lighting, ASpotFallsBetweenItsAngles) {
    Emitters emitters;
    emitters.add(SpotLight{"", {0, 3, 0}, {0, -2, 0}, Vec3f::all(9), 0.3, 0.7});
    const auto at = [&](double angle) {
        return emitters.sample(0, Vec3f(Vec3d(3 * std::tan(angle), 0, 0)), 0, 0);
    };
    for (const double angle : {0.0, 0.15, 0.29, 0.4, 0.5, 0.69}) {
        const double d = 3 / std::cos(angle);
        const double rise =
            std::min(1.0, (std::cos(angle) - std::cos(0.7)) / (std::cos(0.3) - std::cos(0.7)));
        EXPECT_NEAR(at(angle).radiance[1], 9 * rise * rise / (d * d), 1e-5) << angle;
        EXPECT_TRUE(at(angle).single);
    }
    EXPECT_FALSE(at(0.71));
    EXPECT_FALSE(emitters.sample(0, {0, 4, 0}, 0, 0));
    // The power is the integral over directions.
    const auto& spot = std::get<SpotEmitter>(emitters[0]);
    double flux = 0;
    constexpr int steps = 20000;
    for (int i = 0; i < steps; ++i) flux += 9 * spot.share((i + 0.5) / steps) * 2 * pi / steps;
    EXPECT_NEAR(emitters.power(0, 1) / flux, 1, 1e-4);
}

TEST(Lighting, TheSunShinesAlikeEverywhere) {
    Emitters emitters;
    emitters.add(DirectionalLight{"", {0, -3, 0}, {5, 6, 7}});
    const LightSample s = emitters.sample(0, {100, -20, 3}, 0, 0);
    EXPECT_TRUE(s.single);
    EXPECT_EQ(s.direction, Vec3f(0, 1, 0));
    EXPECT_EQ(s.distance, std::numeric_limits<float>::infinity());
    EXPECT_EQ(s.radiance, Vec3f(5, 6, 7));
    EXPECT_FALSE(emitters.has_position(0));
    EXPECT_NEAR(emitters.power(0, 2), 6 * 4 * pi, 1e-6);
}

TEST(Lighting, SourcesWithoutLightAreDroppedAndCounted) {
    Emitters emitters;
    EXPECT_EQ(emitters.add(EmissiveTriangle{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, Vec3f::all(1), true}),
              no_emitter);
    EXPECT_EQ(emitters.add(EmissiveTriangle{{0, 0, 0}, {1, 1, 1}, {0, 0, 0}, Vec3f::all(1), true}),
              no_emitter);
    EXPECT_EQ(emitters.add(EmissiveTriangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Vec3f(), true}), no_emitter);
    EXPECT_EQ(emitters.add(Light(PointLight{})), no_emitter);
    EXPECT_EQ(emitters.without_area(), 2u);
    EXPECT_EQ(emitters.dark(), 2u);
    EXPECT_TRUE(emitters.empty());
    EXPECT_EQ(emitters.add(EmissiveTriangle{{0, 0, 0}, {1e-18f, 0, 0}, {0, 1e-18f, 0}, Vec3f::all(1), true}),
              0u);
}

TEST(Lighting, WhatIsNoLightIsRefused) {
    Emitters emitters;
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    EXPECT_THROW(emitters.add(PointLight{"", {0, 0, 0}, {1, -1, 1}}), InputError);
    EXPECT_THROW(emitters.add(PointLight{"", {0, 0, 0}, {1, nan, 1}}), InputError);
    EXPECT_THROW(emitters.add(PointLight{"", {0, 0, 1e300}, {1, 1, 1}}), InputError);
    EXPECT_THROW(emitters.add(EmissiveTriangle{{0, 0, nan}, {1, 0, 0}, {0, 1, 0}, Vec3f::all(1), true}),
                 InputError);
    EXPECT_THROW(emitters.add(EmissiveTriangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Vec3f::all(inf), true}),
                 InputError);
    EXPECT_THROW(emitters.add(DirectionalLight{"", {0, 0, 0}, {1, 1, 1}}), InputError);
    EXPECT_THROW(emitters.add(SpotLight{"", {}, {0, 0, 1}, Vec3f::all(1), 0.5, 0.5}), InputError);
    EXPECT_THROW(emitters.add(SpotLight{"", {}, {0, 0, 1}, Vec3f::all(1), 0.5, 2}), InputError);
    EXPECT_EQ(emitters.add(EnvironmentMap(default_sky())), 0u);
    EXPECT_THROW(emitters.add(EnvironmentMap(default_sky())), InputError);
}

TEST(Lighting, NoFinitePlaceGivesNaN) {
    Emitters emitters;
    for (const float size : {1e-20f, 1e-6f, 1.0f, 1e6f, 1e17f}) {
        emitters.add(EmissiveTriangle{{0, 0, 0}, {size, 0, 0}, {0, size, 0}, Vec3f::all(1e30f), true});
        emitters.add(
            EmissiveTriangle{{0, 0, size}, {size, 0, size}, {0, size * 1e-6f, size}, Vec3f::all(1), false});
    }
    emitters.add(PointLight{"", {0, 0, 0}, Vec3f::all(1e30f)});
    emitters.add(SpotLight{"", {0, 0, 0}, {0, 0, 1}, Vec3f::all(1e30f), 0, 1e-9});
    std::vector<Vec3f> points{{}};
    for (const float far : {1e-45f, 1e-38f, 1e-20f, 1e-6f, 1.0f, 1e10f, 1e18f, 3e38f})
        for (const Vec3f& d : {Vec3f(0, 0, 1), Vec3f(1, 0, 0), Vec3f(1, 1, 1), Vec3f(-1, 0.5f, -0.25f)})
            points.push_back(d * far);
    for (std::size_t i = 0; i < emitters.size(); ++i)
        for (const Vec3f& point : points)
            for (const float u : {0.0f, 0.5f, 0.99999994f})
                EXPECT_TRUE(sound(emitters.sample(i, point, u, u / 2))) << i << " " << point[0];
}

}  // namespace
