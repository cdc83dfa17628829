/// The choice of one of many lights: probabilities, frequencies, bounds, and what the tree gains.
#include <gtest/gtest.h>

#include <memory>

#include <hedgerow/base/instruction_set.h>
#include <hedgerow/render/lighting/default_sky.h>
#include <hedgerow/render/lighting/light_tree.h>

#include "lights_of_tests.h"

using namespace hedgerow;
using namespace hedgerow::test;

namespace {

/// Triangles, points and spots in a cube from −1 to 1.
Emitters mixed_lights(int count, std::uint64_t seed) {
    Random random(seed);
    Emitters emitters;
    for (int i = 0; i < count; ++i) {
        const Vec3d at = random.in_cube<3>() * 2.0 - Vec3d::all(1);
        const Vec3f intensity = random_point(random, 0.01, 1);
        if (i % 5 < 3)
            emitters.add(random_triangle(random, 0.3));
        else if (i % 5 == 3)
            emitters.add(PointLight{"", at, intensity});
        else
            emitters.add(SpotLight{"", at, random.direction<3>(), intensity, 0.1, random.uniform(0.2, 1.57)});
    }
    return emitters;
}
/// Mixed lights, a sun and a sky.
Emitters lights_and_sky(int count, std::uint64_t seed) {
    Emitters emitters = mixed_lights(count, seed);
    emitters.add(DirectionalLight{"", {0, -1, 0.5}, {3, 3, 2}});
    emitters.add(EnvironmentMap(default_sky()));
    return emitters;
}
struct Receiver {
    Vec3f point, normal;
};
/// Receivers in and around the lights; every fourth without a normal.
std::vector<Receiver> receivers(int count, std::uint64_t seed) {
    Random random(seed);
    std::vector<Receiver> all;
    for (int i = 0; i < count; ++i) {
        const Vec3f normal(random.direction<3>());
        all.push_back({random_point(random, -2, 2), i % 4 == 3 ? Vec3f() : normal});
    }
    return all;
}
const Box3f scene{Vec3f::all(-2), Vec3f::all(2)};

/// Expects that `choose` chooses as `probability` says, by numbers that are evenly spaced: those that choose
/// an emitter are an interval.
template <class Lights>
void expect_frequencies(const Lights& lights, std::size_t emitters, const Receiver& r) {
    constexpr int numbers = 1 << 14;
    std::vector<int> counts(emitters);
    for (int i = 0; i < numbers; ++i) {
        const LightChoice c = lights.choose(r.point, r.normal, (i + 0.5) / numbers);
        if (!c) continue;
        ++counts[c.emitter];
        ASSERT_EQ(c.probability, lights.probability(r.point, r.normal, c.emitter));
    }
    for (std::uint32_t i = 0; i < emitters; ++i)
        ASSERT_NEAR(counts[i], numbers * double(lights.probability(r.point, r.normal, i)), 1.01) << i;
}

TEST(LightTree, ChoosesAsItsProbabilitiesSay) {
    for (const int count : {1, 2, 3, 17, 200}) {
        const Emitters near = mixed_lights(count, 1), all = lights_and_sky(count, 2);
        const LightTree near_tree(near, scene), tree(all, scene);
        const PowerLights power(all, scene);
        for (const Receiver& r : receivers(20, 3)) {
            expect_frequencies(near_tree, near.size(), r);
            expect_frequencies(tree, all.size(), r);
            expect_frequencies(power, all.size(), r);
        }
    }
}

TEST(LightTree, ProbabilitiesSumUpToOneWhereAllLightsReach) {
    // Points shine everywhere, and both sides of triangles do.
    Random random(4);
    Emitters emitters;
    for (int i = 0; i < 300; ++i) {
        EmissiveTriangle t = random_triangle(random, 0.2);
        t.both_sides = true;
        emitters.add(t);
        emitters.add(PointLight{"", random.in_cube<3>(), Vec3f::all(0.1f)});
    }
    emitters.add(EnvironmentMap(default_sky()));
    const LightTree tree(emitters, scene);
    const PowerLights power(emitters, scene);
    for (const Receiver& r : receivers(100, 5)) {
        double sum = 0, by_power = 0;
        for (std::uint32_t i = 0; i < emitters.size(); ++i) {
            sum += double(tree.probability(r.point, {}, i));
            by_power += double(power.probability(r.point, {}, i));
        }
        EXPECT_NEAR(sum, 1, 1e-5);
        EXPECT_NEAR(by_power, 1, 1e-5);
    }
}

TEST(LightTree, ProbabilitiesAndNothingSumUpToOne) {
    const Emitters emitters = lights_and_sky(200, 6);
    const LightTree tree(emitters, scene);
    constexpr int numbers = 4096;
    for (const Receiver& r : receivers(50, 7)) {
        double sum = 0;
        for (std::uint32_t i = 0; i < emitters.size(); ++i)
            sum += double(tree.probability(r.point, r.normal, i));
        int nothing = 0;
        for (int i = 0; i < numbers; ++i) nothing += !tree.choose(r.point, r.normal, (i + 0.5) / numbers);
        // Nothing is chosen by a few intervals of numbers.
        EXPECT_NEAR(sum + double(nothing) / numbers, 1, 0.01);
        EXPECT_LE(sum, 1 + 1e-5);
    }
}

TEST(LightTree, WhateverLightsAPointIsProbable) {
    const Emitters emitters = lights_and_sky(400, 8);
    const LightTree tree(emitters, scene);
    Random random(9);
    int lit = 0, impossible = 0;
    for (const Receiver& r : receivers(200, 10))
        for (std::uint32_t i = 0; i < emitters.size(); ++i) {
            const float p = tree.probability(r.point, r.normal, i);
            impossible += p == 0;
            const Vec2f uv = in_square(random);
            const LightSample s = emitters.sample(i, r.point, uv[0], uv[1]);
            if (!s || (r.normal != Vec3f() && !(dot(r.normal, s.direction) > 0))) continue;
            ++lit;
            ASSERT_GT(p, 0) << i;
        }
    EXPECT_GT(lit, 10000);
    EXPECT_GT(impossible, 10000);
}

TEST(LightTree, GrazingLightIsProbable) {
    // A lamp in the ceiling, a wall under its edge, and points close to both planes.
    Emitters emitters;
    emitters.add(EmissiveTriangle{{0, 1, 0}, {1, 1, 0}, {0, 1, 1}, Vec3f::all(1), false});
    emitters.add(EmissiveTriangle{{0, 1, 1}, {1, 1, 0}, {1, 1, 1}, Vec3f::all(1), false});
    emitters.add(EmissiveTriangle{{5, 1, 1}, {6, 1, 0}, {6, 1, 1}, Vec3f::all(1), false});
    const LightTree tree(emitters);
    Random random(11);
    int lit = 0;
    for (int i = 0; i < 3000; ++i) {
        const auto tiny = float(random.uniform() < 0.5 ? random.uniform() * 1e-6 : random.uniform() * 1e-3);
        const Vec3f ceiling{float(random.uniform(-20, 20)), 1 - tiny, float(random.uniform(-20, 20))};
        const Vec3f wall{-tiny, float(random.uniform(-20, 1)), float(random.uniform(-1, 2))};
        for (const Receiver& r :
             {Receiver{ceiling, {0, -1, 0}}, Receiver{ceiling, {0, 1, 0}}, Receiver{ceiling, {1, 0, 0}},
              Receiver{wall, {1, 0, 0}}, Receiver{wall, {-1, 0, 0}}})
            for (std::uint32_t e = 0; e < emitters.size(); ++e) {
                const Vec2f uv = in_square(random);
                const LightSample s = emitters.sample(e, r.point, uv[0], uv[1]);
                if (!s || !(dot(r.normal, s.direction) > 0)) continue;
                ++lit;
                ASSERT_GT(tree.probability(r.point, r.normal, e), 0);
            }
    }
    EXPECT_GT(lit, 1000);
}

TEST(LightTree, LightsBelowTheHorizonOrBehindAreNotChosen) {
    Emitters emitters;
    emitters.add(EmissiveTriangle{{0, 1, 0}, {1, 1, 0}, {0, 1, 1}, Vec3f::all(1), false});  // faces down
    const LightTree tree(emitters);
    EXPECT_TRUE(tree.choose({0, -3, 0}, {0, 1, 0}, 0.5));
    EXPECT_FALSE(tree.choose({0, -3, 0}, {0, -1, 0}, 0.5));
    EXPECT_TRUE(tree.choose({0, -3, 0}, {}, 0.5));
    EXPECT_FALSE(tree.choose({0, 5, 0}, {0, -1, 0}, 0.5));
    EXPECT_FALSE(tree.choose({0, 5, 0}, {}, 0.5));
    EXPECT_EQ(tree.probability({0, 5, 0}, {}, 0), 0);
}

TEST(LightTree, LightsAtOnePlaceAndNoLights) {
    Emitters emitters;
    for (int i = 0; i < 50; ++i) emitters.add(PointLight{"", {1, 1, 1}, Vec3f::all(float(1 + i % 2))});
    const LightTree tree(emitters), none{Emitters()};
    expect_frequencies(tree, emitters.size(), {{0, 0, 0}, {0, 1, 0}});
    expect_frequencies(tree, emitters.size(), {{1, 1, 1}, {0, 1, 0}});
    EXPECT_FALSE(none.choose({}, {}, 0.5));
    EXPECT_FALSE(PowerLights(Emitters()).choose({}, {}, 0.5));
}

TEST(LightTree, ThreadsChangeNoBit) {
    const Emitters emitters = lights_and_sky(5000, 12);
    const LightTree one(emitters, scene), many(emitters, scene, default_executor());
    Random random(13);
    for (const Receiver& r : receivers(500, 14)) {
        const double u = random.uniform();
        const LightChoice a = one.choose(r.point, r.normal, u), b = many.choose(r.point, r.normal, u);
        ASSERT_EQ(a.emitter, b.emitter);
        ASSERT_EQ(a.probability, b.probability);
    }
}

TEST(LightTree, SkiesHaveAFixedShareByPower) {
    const Emitters emitters = lights_and_sky(100, 15);
    const auto sun = static_cast<std::uint32_t>(emitters.size() - 2), sky = sun + 1;
    const LightTree tree(emitters, scene);
    const auto share = [&](const Vec3f& point, std::uint32_t i) {
        return double(tree.probability(point, {0, 1, 0}, i));
    };
    for (const Vec3f& point : {Vec3f(), Vec3f(9, 9, 9)}) {
        const double both = share(point, sun) + share(point, sky);
        EXPECT_GE(both, 0.25 - 1e-6);
        EXPECT_LE(both, 0.75 + 1e-6);
        EXPECT_EQ(share(point, sun), share({}, sun));
        EXPECT_NEAR(share(point, sun) / share(point, sky), emitters.power(sun, 3) / emitters.power(sky, 3),
                    1e-4);
    }
}

TEST(PowerLights, ChooseByPower) {
    const Emitters emitters = mixed_lights(100, 16);
    const PowerLights lights(emitters);
    double total = 0;
    for (std::size_t i = 0; i < emitters.size(); ++i) total += emitters.power(i, 1);
    for (std::uint32_t i = 0; i < emitters.size(); ++i)
        EXPECT_NEAR(double(lights.probability({}, {}, i)), emitters.power(i, 1) / total, 1e-6);
}

TEST(LightGroups, HaveTheSameImportancesByEveryInstructionSet) {
    const Emitters emitters = mixed_lights(40, 20);
    const std::vector<Receiver> all = receivers(500, 21);
    std::vector<LightGroups> groups(10);
    for (std::size_t i = 0; i < 40; ++i) groups[i / 4].set(i % 4, emitters.bounds(i));
    for (const std::size_t lights : {3u, 2u, 1u, 0u}) {
        groups.emplace_back();
        for (std::size_t i = 0; i < lights; ++i) groups.back().set(i, emitters.bounds(i));
    }
    const auto importances = [&](std::string_view set) {
        use_instruction_set(set);
        std::vector<LightGroups::Lanes> found;
        for (const Receiver& r : all)
            for (const LightGroups& g : groups) found.push_back(g.importances(r.point, r.normal));
        return found;
    };
    const auto sets = instruction_sets();
    const auto plain = importances("plain");
    for (const std::string_view set : sets) EXPECT_EQ(importances(set), plain) << set;
    use_instruction_set(sets.front());
    EXPECT_EQ(groups.back().importances({1, 2, 3}, {0, 1, 0}), LightGroups::Lanes());
}

/// Whichever others are set.
TEST(LightGroups, HaveTheSameImportanceAmongAnyOthers) {
    const Emitters emitters = mixed_lights(4, 23);
    std::vector<LightGroups> first(5);  // the first 0 to 4 lights
    for (std::size_t count = 1; count <= 4; ++count)
        for (std::size_t i = 0; i < count; ++i) first[count].set(i, emitters.bounds(i));
    double sum = 0;
    for (const Receiver& r : receivers(500, 24)) {
        LightGroups::Lanes expected = first[4].importances(r.point, r.normal);
        for (const double importance : expected) sum += importance;
        for (std::size_t count = 4; count-- > 0;) {
            expected[count] = 0;
            EXPECT_EQ(first[count].importances(r.point, r.normal), expected) << count;
        }
    }
    EXPECT_GT(sum, 0);
}

/// From afar, where the distance to the middle is nearly that to all places.
TEST(LightGroups, ImportancesBoundTheLightOfTriangles) {
    Random random(22);
    int lit = 0;
    for (int k = 0; k < 3000; ++k) {
        const EmissiveTriangle triangle = random_triangle(random, 0.3);
        const Receiver r{random_point(random, -4, 4), Vec3f(random.direction<3>())};
        Emitters emitters;
        emitters.add(triangle);
        LightGroups groups;
        groups.set(2, emitters.bounds(0));
        const double irradiance = irradiance_by(triangle, r.point, r.normal, 3);
        if (length(Vec3d(r.point) - Vec3d(triangle.a)) < 3 || !(irradiance > 0)) continue;
        ++lit;
        const double in_mean =
            irradiance * detail::brightness(triangle.radiance) / double(triangle.radiance[0]);
        EXPECT_LE(in_mean, 1.3 * groups.importances(r.point, r.normal)[2]) << k;
    }
    EXPECT_GT(lit, 300);
}

TEST(LightBounds, MergedConesContainBoth) {
    Random random(17);
    for (int k = 0; k < 3000; ++k) {
        // Cones that are mostly slim, as those of triangles.
        const auto cone = [&] {
            const double angle = k % 3 == 0 ? 0 : random.uniform(0, k % 3 == 1 ? 0.1 : pi);
            return NormalCone{Vec3f(random.direction<3>()), float(std::cos(angle)), float(std::sin(angle))};
        };
        NormalCone a = cone(), b = cone();
        if (k % 5 == 0) b.axis = k % 2 == 0 ? a.axis : -a.axis;
        const NormalCone both = detail::merged(a, b);
        ASSERT_NEAR(length(both.axis), 1, 1e-6);
        const double angle = both.is_all() ? pi : std::atan2(double(both.sine), double(both.cosine));
        for (const NormalCone& part : {a, b}) {
            const Vec3d axis(part.axis), whole(both.axis);
            const double between = std::atan2(length(cross(axis, whole)), dot(axis, whole));
            const double needed = between + std::atan2(double(part.sine), double(part.cosine));
            ASSERT_LE(std::min(needed, pi), angle + 2e-7) << k;
        }
        // No more than needed: half of what both and the angle between take.
        const Vec3d of_a(a.axis), of_b(b.axis);
        const double between = std::atan2(length(cross(of_a, of_b)), dot(of_a, of_b));
        const double wide = std::max({(between + std::atan2(double(a.sine), double(a.cosine)) +
                                       std::atan2(double(b.sine), double(b.cosine))) /
                                          2,
                                      std::atan2(double(a.sine), double(a.cosine)),
                                      std::atan2(double(b.sine), double(b.cosine))});
        if (between < 3.1) {
            ASSERT_LE(angle, wide + 2e-6) << k;
        }
    }
}

/// The sum of the squared relative errors of estimates with one sample, beside the irradiance.
template <class Lights>
double squared_error(const Lights& lights, const Emitters& emitters, const Receiver& r, double exact,
                     Random random, double& mean) {
    constexpr int samples = 2000;
    double sum = 0, squares = 0;
    for (int i = 0; i < samples; ++i) {
        double value = 0;
        const double u = random.uniform();
        const float v = float(random.uniform()), w = float(random.uniform());
        if (const LightChoice c = lights.choose(r.point, r.normal, u))
            if (const LightSample s = emitters.sample(c.emitter, r.point, v, w); s)
                value = double(s.radiance[0]) * std::max(0.0, double(dot(r.normal, s.direction))) /
                        (double(s.density) * double(c.probability));
        sum += value;
        squares += (value / exact - 1) * (value / exact - 1);
    }
    mean = sum / samples;
    return squares / samples;
}

/// The error of choices by the tree over that of choices by power, at points of a floor from −reach to reach.
double error_beside_power(const Emitters& emitters, double reach) {
    const LightTree tree(emitters);
    const PowerLights power(emitters);
    Random random(18);
    double of_tree = 0, of_power = 0, bias = 0;
    constexpr int points = 20;
    for (int k = 0; k < points; ++k) {
        const Receiver r{{float(random.uniform(-reach, reach)), 0, float(random.uniform(-reach, reach))},
                         {0, 1, 0}};
        double exact = 0;
        for (std::size_t i = 0; i < emitters.size(); ++i)
            exact += irradiance_by(std::get<EmissiveTriangle>(emitters[i]), r.point, r.normal, 3);
        double mean = 0, ignored = 0;
        const auto stream = static_cast<std::uint64_t>(k);
        const double error = squared_error(tree, emitters, r, exact, Random(19, stream), mean);
        // Unbiased within 4 standard errors of 2000 samples.
        EXPECT_LT(std::abs(mean / exact - 1), 4 * std::sqrt(error / 2000) + 2e-3);
        bias += mean / exact - 1;
        of_tree += error;
        of_power += squared_error(power, emitters, r, exact, Random(20, stream), ignored);
    }
    EXPECT_LT(std::abs(bias / points), 4 * std::sqrt(of_tree / points / 2000 / points) + 2e-3);
    return std::sqrt(of_tree / of_power);
}
/// Groups of triangles of one radiance, over a floor.
Emitters lamps(int count, int triangles, double size, double reach) {
    Random random(18);
    Emitters emitters;
    for (int lamp = 0; lamp < count; ++lamp) {
        const Vec3f at{float(random.uniform(-reach, reach)), float(random.uniform(1, 3)),
                       float(random.uniform(-reach, reach))};
        const Vec3f radiance = Vec3f::all(float(random.uniform(0.2, 5)));
        for (int i = 0; i < triangles; ++i) {
            EmissiveTriangle t = random_triangle(random, 0.1);
            const Vec3f shift = at + t.a * float(size) - t.a;
            t.a += shift, t.b += shift, t.c += shift;
            t.radiance = radiance;
            emitters.add(t);
        }
    }
    return emitters;
}

TEST(LightTree, HasAtMostHalfTheErrorOfAChoiceByPower) {
    const auto expect = [](const char* name, const Emitters& emitters, double reach) {
        ASSERT_EQ(emitters.size(), 10000u) << name;
        EXPECT_LE(error_beside_power(emitters, reach), 0.5) << name;
    };
    expect("lamps of 25 triangles", lamps(400, 25, 0.2, 20), 20);
    expect("single triangles", lamps(10000, 1, 0, 20), 20);
    expect("large lamps", lamps(20, 500, 2, 20), 20);
    // Windows in walls around, which shine inward: each triangle has one side.
    Random random(21);
    Emitters windows;
    while (windows.size() < 10000) {
        const double along = random.uniform(-20, 20), up = random.uniform(0.5, 6);
        const Vec3f radiance = Vec3f::all(float(random.uniform(0.2, 5)));
        for (int wall = 0; wall < 4; ++wall) {
            const float s = wall % 2 == 0 ? 20.0f : -20.0f;
            const auto place = [&](double x, double y) {
                return wall < 2 ? Vec3f(s, float(y), float(x)) : Vec3f(float(x), float(y), s);
            };
            EmissiveTriangle t{place(along, up), place(along + 0.1, up), place(along, up + 0.1), radiance,
                               false};
            if (dot(t.normal(), Vec3d(t.a)) > 0) std::swap(t.b, t.c);
            windows.add(t);
        }
    }
    expect("windows", windows, 18);
    // Few lamps that are a hundred times as bright, beyond the others.
    Emitters uneven = lamps(300, 30, 0.3, 10);
    for (int i = 0; i < 1000; ++i) {
        EmissiveTriangle t = random_triangle(random, 0.1);
        for (Vec3f* corner : {&t.a, &t.b, &t.c}) *corner += Vec3f(60, 8, 0);
        t.radiance = Vec3f::all(300);
        uneven.add(t);
    }
    expect("uneven lamps", uneven, 10);
}

}  // namespace
