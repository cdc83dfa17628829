/// Particle systems: flight against closed forms, contacts with meshes and each other, walls that nothing
/// passes, births and deaths, the same bits for any threads and after a break.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <hedgerow/ask/insides.h>
#include <hedgerow/base/error.h>
#include <hedgerow/fluid/particle_system.h>
#include <hedgerow/index.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>

#include "long_runs.h"

using namespace hedgerow;

namespace {

using Options = ParticleSystemOptions;
constexpr double forever = 1e9;

void add(ParticleState& state, const Vec3d& place, const Vec3d& velocity, double radius = 0) {
    state.particles.places.push_back(place), state.particles.velocities.push_back(velocity);
    state.particles.masses.push_back(radius > 0 ? radius * radius * radius : 1);
    state.ages.push_back(0), state.lives.push_back(forever), state.radii.push_back(radius);
    state.numbers.push_back(state.numbers.size());
}
ParticleState one(const Vec3d& place, const Vec3d& velocity, double radius = 0) {
    ParticleState state;
    add(state, place, velocity, radius);
    return state;
}
/// A square in the plane z = 0, of two triangles.
TriangleMesh<double> floor_of(double half) {
    return {
        {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}};
}
bool operator==(const ParticleState& a, const ParticleState& b) {
    return a.time == b.time && a.particles.places == b.particles.places &&
           a.particles.velocities == b.particles.velocities && a.particles.masses == b.particles.masses &&
           a.ages == b.ages && a.lives == b.lives && a.radii == b.radii && a.numbers == b.numbers;
}

TEST(ParticleSystem, FallsInParabolas) {
    Options options;
    options.forces.gravity = {0, 1, -10};
    ParticleSystem system(options, nullptr, one({1, 2, 3}, {4, 5, 6}));
    for (const double dt : {0.125, 0.5, 0.25, 0.125, 1.0}) system.step(dt);
    EXPECT_EQ(system.state().time, 2);
    EXPECT_LT(length(system.state().particles.places[0] - Vec3d(1 + 8, 2 + 10 + 2, 3 + 12 - 20)), 1e-13);
    EXPECT_LT(length(system.state().particles.velocities[0] - Vec3d(4, 7, -14)), 1e-13);
    EXPECT_EQ(system.state().ages[0], 2);
}

/// Velocities without gravity are those of the closed forms, in steps of any length; places are of second
/// order.
TEST(ParticleSystem, DragHasItsClosedForm) {
    const Vec3d wind{1, -2, 0.5}, start{4, 3, 2};
    const auto fly = [&](double linear, double quadratic, int steps) {
        Options options;
        options.forces = {{}, wind, linear, quadratic};
        ParticleSystem system(options, nullptr, one({}, start));
        for (int i = 0; i < steps; ++i) system.step(2.0 / steps);
        return system.state().particles;
    };
    const Vec3d u = start - wind;
    for (const int steps : {1, 3, 64}) {
        EXPECT_LT(length(fly(0.7, 0, steps).velocities[0] - (wind + u * std::exp(-1.4))), 1e-13);
        EXPECT_LT(length(fly(0, 0.3, steps).velocities[0] - (wind + u / (1 + 0.6 * length(u)))), 1e-13);
        // The limits of small coefficients.
        EXPECT_LT(length(fly(1e-12, 0.3, steps).velocities[0] - fly(0, 0.3, steps).velocities[0]), 1e-10);
        // Both: from du/dt = −(a + b·u)·u by partial fractions.
        const double a = 0.7, b = 0.3, grown = std::exp(2 * a), speed = length(u);
        EXPECT_LT(
            length(fly(a, b, steps).velocities[0] - (wind + u * (a / ((a + b * speed) * grown - b * speed)))),
            1e-13);
    }
    // As dust in honey: eᵃᵗ is beyond double.
    for (const double strong : {1e3, 1e100}) EXPECT_EQ(fly(strong, 0.3, 2).velocities[0], wind);
    const Vec3d place = wind * 2.0 + u * ((1 - std::exp(-1.4)) / 0.7);
    const double coarse = length(fly(0.7, 0, 16).places[0] - place),
                 fine = length(fly(0.7, 0, 32).places[0] - place);
    EXPECT_LT(coarse, 0.01);
    EXPECT_NEAR(coarse / fine, 4, 0.1);
}
TEST(ParticleSystem, DragAndGravityEndInTheTerminalSpeed) {
    Options options;
    options.forces = {{0, 0, -9}, {2, 0, 0}, 0, 0.25};
    ParticleSystem system(options, nullptr, one({}, {}));
    for (int i = 0; i < 2000; ++i) system.step(0.005);
    EXPECT_LT(length(system.state().particles.velocities[0] - Vec3d(2, 0, -6)), 1e-4);
}

TEST(ParticleSystem, BouncesAndComesToRest) {
    const auto mesh = floor_of(1);
    const auto index = build(mesh);
    Options options;
    options.contacts.restitution = 0.7;
    for (const double radius : {0.05, 0.0}) {
        ParticleSystem system(options, &index, one({0.2, 0.1, 1 + radius}, {}, radius));
        // The highest place between the first and the second contact.
        double top = 0, before = 0;
        int contacts = 0;
        for (int i = 0; i < 8000; ++i) {
            system.step(0.001);
            const double v = system.state().particles.velocities[0][2];
            contacts += before < 0 && v > 0;
            before = v;
            ASSERT_GE(system.state().particles.places[0][2], radius * (1 - 1e-9)) << "step " << i;
            if (contacts == 1) top = std::max(top, system.state().particles.places[0][2] - radius);
        }
        EXPECT_NEAR(top, 0.49, 0.002);
        EXPECT_GT(contacts, 5);
        EXPECT_NEAR(system.state().particles.places[0][2], radius, 1e-9);
        EXPECT_LT(length(system.state().particles.velocities[0]), 1e-12);
    }
}
/// Bounces without loss neither gain energy, nor lose more than g²dt²/8 each.
TEST(ParticleSystem, KeepsItsEnergyWithoutLoss) {
    const auto mesh = cube<double>(12);
    const auto index = build(mesh);
    Options options;
    options.contacts = {.restitution = 1, .friction = 0};
    for (const double radius : {0.0, 0.1}) {
        ParticleSystem system(options, &index, one({0.2, 0.1, 0.3}, {3, 2, 1}, radius));
        const auto energy = [&] {
            const auto& all = system.state().particles;
            return length2(all.velocities[0]) / 2 + 9.81 * all.places[0][2];
        };
        const double first = energy();
        for (int i = 0; i < 5000; ++i) {
            system.step(0.001);
            ASSERT_LE(energy(), first + 1e-4) << "radius " << radius << ", step " << i;
        }
        EXPECT_NEAR(energy(), first, 0.02);
    }
}
/// Coulomb's friction: a ball that slides stops after v²/2μg; on a slope it stays below tan = μ.
TEST(ParticleSystem, FrictionStopsWhatSlides) {
    const auto mesh = floor_of(10);
    const auto index = build(mesh);
    for (const double radius : {0.1, 0.0}) {
        Options options;
        options.contacts = {.restitution = 0.5, .friction = 0.25};
        ParticleSystem system(options, &index, one({0, 0, radius}, {3, 0, 0}, radius));
        for (int i = 0; i < 3000; ++i) system.step(0.001);
        EXPECT_NEAR(system.state().particles.places[0][0], 9 / (2 * 0.25 * 9.81), 0.01);
        EXPECT_EQ(length(system.state().particles.velocities[0]), 0);
        // Gravity that is not along the normal: a slope.
        for (const double slope : {0.2, 0.3}) {
            options.forces.gravity = {slope, 0, -1};
            ParticleSystem other(options, &index, one({0, 0, radius}, {}, radius));
            for (int i = 0; i < 1000; ++i) other.step(0.001);
            const double x = other.state().particles.places[0][0];
            EXPECT_NEAR(x, slope < 0.25 ? 0 : (slope - 0.25) / 2, 1e-3) << radius << " " << slope;
        }
    }
}
/// A contact takes (1 + restitution)·μ of the approach from the speed along the surface.
TEST(ParticleSystem, FrictionSlowsWhatBounces) {
    const auto mesh = floor_of(10);
    const auto index = build(mesh);
    for (const double radius : {0.1, 0.0}) {
        Options options;
        options.forces.gravity = {};
        options.contacts = {.restitution = 0.5, .friction = 0.25};
        ParticleSystem system(options, &index, one({0, 0, 0.5}, {3, 0, -2}, radius));
        for (int i = 0; i < 10; ++i) system.step(0.1);
        EXPECT_LT(length(system.state().particles.velocities[0] - Vec3d(3 - 0.25 * 3, 0, 1)), 1e-12);
    }
}
/// A ball that falls into a valley of two walls touches both.
TEST(ParticleSystem, RestsInAValley) {
    const TriangleMesh<double> mesh{{{0, -5, 0}, {0, 5, 0}, {5, 5, 5}, {5, -5, 5}, {-5, 5, 5}, {-5, -5, 5}},
                                    {{0, 1, 2}, {0, 2, 3}, {0, 4, 1}, {0, 5, 4}},
                                    {}};
    const auto index = build(mesh);
    ParticleSystem system({}, &index, one({0.3, 0, 2}, {}, 0.25));
    for (int i = 0; i < 6000; ++i) system.step(0.002);
    EXPECT_LT(length(system.state().particles.places[0] - Vec3d(0, 0, 0.25 * std::sqrt(2.0))), 2e-3);
}
/// The rim of a wall that the center misses, at four radii a step.
TEST(ParticleSystem, BallsMeetRims) {
    const TriangleMesh<double> mesh{
        {{0, -5, -5}, {0, 5, -5}, {0, 5, 0}, {0, -5, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}};
    const auto index = build(mesh);
    Options options;
    options.forces.gravity = {};
    ParticleSystem system(options, &index, one({-1.1, 0, 0.05}, {4, 0, 0}, 0.1));
    for (int i = 0; i < 10; ++i) system.step(0.1);
    EXPECT_GT(system.state().particles.velocities[0][2], 0.5);
}

/// How many of many fast particles leave a closed mesh, from within. Each moves about a thousand times the
/// mesh's size a step; they aim at anywhere, or exactly at vertices and along edges.
std::size_t leaks(const TriangleMesh<double>& mesh, double radius, double restitution, std::uint64_t seed,
                  std::size_t count, int steps) {
    const auto index = build(mesh);
    const Solid solid(index);
    Options options;
    options.contacts = {.restitution = restitution, .friction = seed % 2 == 0 ? 0.0 : 0.2};
    ParticleState start;
    for (std::uint64_t i = 0; start.size() < count; ++i) {
        Random random(seed, i);
        const Vec3d low = index.bounds().low, high = index.bounds().high;
        Vec3d place;
        for (int k = 0; k < 3; ++k) place[k] = random.uniform(low[k], high[k]);
        if (side(solid, place) != Side::inside) continue;
        Vec3d target = place + random.direction<3>();
        const auto triangle = mesh.view().triangle(random.bits() % mesh.size());
        if (i % 3 == 1) target = triangle.a;
        if (i % 3 == 2) target = triangle.a + (triangle.b - triangle.a) * random.uniform();
        add(start, place, (target - place) * 1000.0, radius);
    }
    ParticleSystem system(options, &index, std::move(start));
    std::size_t leaked = 0;
    for (int i = 0; i < steps; ++i) {
        system.step(1);
        leaked = 0;
        for (const Vec3d& place : system.state().particles.places)
            leaked += side(solid, place) != Side::inside;
        if (leaked > 0) return leaked;
    }
    return leaked;
}
TEST(ParticleSystem, NothingPassesAClosedMesh) {
    // A sliver of a tetrahedron has sharp corners, in which a ball of a radius has no room.
    const TriangleMesh<double> sliver{{{0, 0, 0}, {1, 0, 0}, {0.3, 1, 0}, {0.4, 0.3, 0.02}},
                                      {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}},
                                      {}};
    const std::vector<TriangleMesh<double>> meshes{cube<double>(12), cube<double>(300), boulder<double>(2000),
                                                   sliver};
    for (std::size_t m = 0; m < meshes.size(); ++m)
        for (std::uint64_t seed = 0; seed < in_long_runs(40, 4); ++seed)
            for (const double radius : {0.0, 0.02})
                EXPECT_EQ(leaks(meshes[m], radius, seed % 3 == 0 ? 1 : 0.5, seed, 200, 8), 0u)
                    << "mesh " << m << ", seed " << seed << ", radius " << radius;
}
/// One layer of triangles is a wall from both sides, for particles that cross it a thousand times its size
/// from where they are, hit its inner edges and vertices, lie on it and slide along it.
TEST(ParticleSystem, NothingPassesAThinWall) {
    TriangleMesh<double> mesh;
    constexpr std::uint32_t n = 8;
    for (std::uint32_t y = 0; y <= n; ++y)
        for (std::uint32_t x = 0; x <= n; ++x) mesh.vertices.push_back({x - 4.0, y - 4.0, 0.1 * (x % 3)});
    for (std::uint32_t y = 0; y < n; ++y)
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
            mesh.triangles.push_back({a, b, d}), mesh.triangles.push_back({a, d, c});
        }
    const auto index = build(mesh);
    Options options;
    options.contacts.restitution = 0;
    for (const double radius : {0.0, 0.05}) {
        ParticleState start;
        std::vector<double> sides;
        for (std::uint64_t i = 0; i < in_long_runs(20000, 2000); ++i) {
            Random random(7, i);
            const double side = i % 2 == 0 ? 1 : -1, far = i % 5 == 0 ? 5000 : 2;
            Vec3d target{random.uniform(-2, 2), random.uniform(-2, 2), 0};
            if (i % 3 == 0) target = mesh.vertices[3 * (n + 1) + 3 + random.bits() % 3];
            const Vec3d away = normalized(random.direction<3>() + Vec3d(0, 0, 1.5)) * far;
            add(start, target + Vec3d(away[0], away[1], away[2] * 1) * side, away * (side * -1000), radius);
            sides.push_back(side);
        }
        ParticleSystem system(options, &index, start);
        for (int i = 0; i < 4; ++i) {
            system.step(1);
            for (std::size_t k = 0; k < sides.size(); ++k) {
                const Vec3d& p = system.state().particles.places[k];
                // A way from the start that passes nothing, or off the wall.
                const Vec3d top{p[0], p[1], 3 * sides[k]};
                const bool over = std::abs(p[0]) < 4 && std::abs(p[1]) < 4;
                ASSERT_TRUE(!over || !any_hit(index, Ray<double, 3>{top, p - top, 0, 1}))
                    << "particle " << k << ", step " << i << ", radius " << radius;
            }
        }
    }
}

/// Ways that end on a slanted wall but for roundings, before it or behind it, and go on in the next step.
TEST(ParticleSystem, NothingPassesAWallAtTheEndOfAStep) {
    const TriangleMesh<double> mesh{{{9, -8, 1.3}, {-7, -9, 4.1}, {0.2, 17, -3.7}}, {{0, 1, 2}}, {}};
    const auto index = build(mesh);
    const Vec3d normal = normalized(mesh.view().normal(0)), on = mesh.vertices[0];
    Options options;
    options.forces.gravity = {};
    ParticleState start;
    for (std::uint64_t i = 0; i < in_long_runs(100000, 5000); ++i) {
        Random random(11, i);
        const Vec3d target = mesh.vertices[0] * random.uniform(0.25, 0.35) +
                             mesh.vertices[1] * random.uniform(0.25, 0.35) + mesh.vertices[2] * 0.3,
                    end = target - normal * dot(target - on, normal), place = end + random.direction<3>();
        add(start, place, end - place);
    }
    ParticleSystem system(options, &index, start);
    for (int i = 0; i < 3; ++i) system.step(1);
    for (std::size_t k = 0; k < start.size(); ++k)
        ASSERT_GT(dot(system.state().particles.places[k] - on, normal) *
                      dot(start.particles.places[k] - on, normal),
                  0)
            << "particle " << k;
}

TEST(ParticleSystem, EmitsInTime) {
    Options options;
    options.forces.gravity = {};
    ParticleEmitter emitter;
    emitter.rate = 40, emitter.begin = 0.5, emitter.end = 2.5;
    emitter.speed = 2, emitter.speed_spread = 0.5, emitter.spread = 0.3;
    emitter.life = 1, emitter.life_spread = 0.25;
    options.emitters = {emitter, emitter};
    options.emitters[1].rate = 10;
    const auto count_at = [&](double time, int steps) {
        ParticleSystem system(options);
        for (int i = 0; i < steps; ++i) system.step(time / steps);
        return system.emitted();
    };
    // Births are at 0.5 + k/40 and 0.5 + k/10; those at the end of a step belong to the next.
    EXPECT_EQ(count_at(0.5, 4), 0u);
    EXPECT_EQ(count_at(1, 8), 20u + 5u);
    EXPECT_EQ(count_at(1, 1), 25u);
    EXPECT_EQ(count_at(2.75, 64), 80u + 20u);
    // A particle's age is the time since its birth, which is within a step.
    Options single = options;
    single.emitters.resize(1);
    ParticleSystem young(single);
    for (int i = 0; i < 9; ++i) young.step(0.1);
    EXPECT_EQ(young.state().size(), 16u);
    for (std::size_t k = 0; k < young.state().size(); ++k)
        EXPECT_NEAR(young.state().ages[k], 0.9 - 0.5 - static_cast<double>(k) / 40, 1e-12);
    // Each lives as long as it drew, from 0.75 to 1.25, and flies straight from its birth on.
    ParticleSystem system(options);
    std::vector<double> seen(100), life(100);
    for (int i = 0; i < 400; ++i) {
        system.step(0.01);
        const ParticleState& state = system.state();
        for (std::size_t k = 0; k < state.size(); ++k) {
            const Vec3d v = state.particles.velocities[k];
            ASSERT_LT(length(state.particles.places[k] - v * state.ages[k]), 1e-12);
            ASSERT_GE(length(v), 1.5 - 1e-12);
            ASSERT_LE(length(v), 2.5 + 1e-12);
            ASSERT_GE(v[2] / length(v), std::cos(0.3) - 1e-12);
            ASSERT_LT(state.ages[k], state.lives[k]);
            seen[state.numbers[k]] = state.ages[k], life[state.numbers[k]] = state.lives[k];
        }
        ASSERT_TRUE(std::is_sorted(state.numbers.begin(), state.numbers.end()));
    }
    EXPECT_EQ(system.state().size(), 0u);
    double sum = 0, sum2 = 0;
    for (std::size_t k = 0; k < 100; ++k) {
        EXPECT_GE(life[k], 0.75);
        EXPECT_LE(life[k], 1.25);
        EXPECT_LE(life[k] - seen[k], 0.01 + 1e-9);
        sum += life[k], sum2 += life[k] * life[k];
    }
    EXPECT_NEAR(sum / 100, 1, 0.06);
    EXPECT_NEAR(std::sqrt(sum2 / 100 - sum * sum / 1e4), 0.25 / std::sqrt(3.0), 0.02);
}
/// Places of birth are even over discs, boxes and surfaces, and directions over a cone.
TEST(ParticleSystem, RefusesMoreBirthsThanNumbers) {
    Options options;
    ParticleEmitter emitter;
    emitter.rate = 100;
    options.emitters = {emitter};
    ParticleState late;
    late.time = 1e18;
    ParticleSystem system(options, nullptr, late);
    EXPECT_THROW(system.step(1), InputError);
}
TEST(ParticleSystem, EmitsFromShapes) {
    const auto mean_of = [](const Options& options, auto measure, const MeshIndex<double>* mesh = nullptr) {
        ParticleSystem system(options, mesh);
        system.step(1e-6);
        EXPECT_EQ(system.state().size(), 20000u);
        double sum = 0;
        for (std::size_t i = 0; i < system.state().size(); ++i)
            sum += measure(system.state().particles.places[i], system.state().particles.velocities[i],
                           system.state().radii[i]);
        return sum / static_cast<double>(system.state().size());
    };
    Options options;
    options.forces.gravity = {};
    options.emitters.resize(1);
    ParticleEmitter& e = options.emitters[0];
    e.rate = 2e10 * (1 - 1e-7), e.direction = {1, 1, 1}, e.spread = 0.8, e.speed = 1e-3;
    // The mean cosine in a cone is that of its middle height.
    const Vec3d axis = normalized(Vec3d(1, 1, 1));
    const auto height = [&](const Vec3d&, const Vec3d& v, double) { return dot(v, axis) / 1e-3; };
    EXPECT_NEAR(mean_of(options, height), (1 + std::cos(0.8)) / 2, 2e-3);
    e.source = FromDisc{{1, 2, 3}, 2};
    const auto out2 = [](const Vec3d& p, const Vec3d&, double) { return length2(p - Vec3d(1, 2, 3)); };
    EXPECT_NEAR(mean_of(options, out2), 2, 0.03);
    const auto off = [&](const Vec3d& p, const Vec3d&, double) {
        return std::abs(dot(p - Vec3d(1, 2, 3), axis));
    };
    EXPECT_LT(mean_of(options, off), 1e-9);
    e.source = FromBox{{{-1, -2, -3}, {1, 2, 3}}};
    const auto z2 = [](const Vec3d& p, const Vec3d&, double) {
        EXPECT_LE(max_component(abs(p)), 3);
        return p[2] * p[2];
    };
    EXPECT_NEAR(mean_of(options, z2), 3, 0.05);
    // From a cube's surface, outward, a radius above it, also where the mesh is an obstacle.
    const auto mesh = cube<double>(12);
    const auto index = build(mesh);
    e.source = FromSurface{mesh.view()};
    e.radius = 0.1, e.spread = 0;
    const auto on_top = [](const Vec3d& p, const Vec3d& v, double r) {
        EXPECT_NEAR(max_component(abs(p)), 1 + r, 2e-9);
        EXPECT_GT(dot(p, v), 0);
        return p[2] > 1.05 ? 1.0 : 0.0;
    };
    EXPECT_NEAR(mean_of(options, on_top, &index), 1.0 / 6, 0.01);
}

TEST(ParticleSystem, ContactsWithEachOtherKeepMomentumAndEnergy) {
    Options options;
    options.forces.gravity = {};
    options.contacts = {.restitution = 1, .friction = 0, .each_other = true};
    ParticleState start;
    for (std::uint64_t i = 0; i < 300; ++i) {
        Random random(3, i);
        add(start, random.in_cube<3>(), random.direction<3>(), random.uniform(0.02, 0.05));
    }
    const auto sums = [](const ParticleState& s) {
        std::pair<Vec3d, double> both;
        for (std::size_t i = 0; i < s.size(); ++i) {
            both.first += s.particles.velocities[i] * s.particles.masses[i];
            both.second += length2(s.particles.velocities[i]) * s.particles.masses[i] / 2;
        }
        return both;
    };
    ParticleSystem system(options, nullptr, start);
    for (int i = 0; i < 200; ++i) system.step(0.002);
    const auto before = sums(start), after = sums(system.state());
    EXPECT_LT(length(after.first - before.first), 1e-14);
    EXPECT_NEAR(after.second / before.second, 1, 1e-12);
    std::size_t turned = 0;
    for (std::size_t i = 0; i < start.size(); ++i)
        turned += length(system.state().particles.velocities[i] - start.particles.velocities[i]) > 0.1;
    EXPECT_GT(turned, 100u);
    // With a loss momentum alone is kept.
    options.contacts.restitution = 0.5;
    ParticleSystem lossy(options, nullptr, start);
    for (int i = 0; i < 200; ++i) lossy.step(0.002);
    EXPECT_LT(length(sums(lossy.state()).first - before.first), 1e-14);
    EXPECT_LT(sums(lossy.state()).second, 0.95 * before.second);
}
/// Balls on each other in a box come to rest, hardly overlap, and none leaves it.
TEST(ParticleSystem, BallsLieOnEachOther) {
    const auto mesh = cube<double>(12);
    const auto index = build(mesh);
    Options options;
    options.contacts = {.restitution = 0.2, .friction = 0.3, .each_other = true};
    ParticleState start;
    constexpr double r = 0.15;
    for (int i = 0; i < 150; ++i) {
        const int row = i / 5 % 5, layer = i / 25;
        add(start, Vec3d(i % 5, row, layer) * 0.32 + Vec3d(-0.65 + 0.001 * i, -0.65, -0.8), {}, r);
    }
    ParticleSystem system(options, &index, start);
    for (int i = 0; i < 1500; ++i) system.step(0.002);
    double deepest = 0, energy = 0;
    const auto& all = system.state().particles;
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_LE(max_component(abs(all.places[i])), 1 - r + 1e-3);
        energy += length2(all.velocities[i]) / 2 / static_cast<double>(all.size());
        for (std::size_t k = 0; k < i; ++k)
            deepest = std::max(deepest, 2 * r - length(all.places[i] - all.places[k]));
    }
    EXPECT_LT(deepest, 0.15 * r);
    EXPECT_LT(energy, 0.02);
}

Options fountain() {
    Options options;
    ParticleEmitter emitter;
    emitter.source = FromDisc{{0, 0, 1.3}, 0.2};
    emitter.rate = 1000, emitter.spread = 0.5, emitter.speed = 3, emitter.speed_spread = 1;
    emitter.life = 0.7, emitter.life_spread = 0.3, emitter.radius = 0.03;
    options.emitters = {emitter, emitter};
    options.emitters[1].source = FromBox{{{-1, -1, 2}, {1, 1, 3}}};
    options.forces.wind = {1, 0, 0}, options.forces.quadratic_drag = 0.1;
    options.contacts.each_other = true;
    options.seed = 5;
    return options;
}
TEST(ParticleSystem, HasTheSameBitsForAnyThreads) {
    const auto mesh = boulder<double>(2000);
    const auto index = build(mesh);
    const auto run = [&](Threads threads) {
        ParticleSystem system(fountain(), &index);
        for (int i = 0; i < 100; ++i) system.step(0.01, threads);
        return system.state();
    };
    const ParticleState serial = run(serial_executor());
    EXPECT_GT(serial.size(), 1000u);
    EXPECT_TRUE(run(default_executor()) == serial);
    const ThreadLimit limit(2);
    EXPECT_TRUE(run(default_executor()) == serial);
    // The seed matters.
    Options other = fountain();
    other.seed = 6;
    ParticleSystem system(other, &index);
    for (int i = 0; i < 100; ++i) system.step(0.01);
    EXPECT_FALSE(system.state() == serial);
}
TEST(ParticleSystem, GoesOnWithTheSameBits) {
    const auto mesh = boulder<double>(2000);
    const auto index = build(mesh);
    ParticleSystem whole(fountain(), &index), first(fountain(), &index);
    for (int i = 0; i < 80; ++i) whole.step(0.01);
    for (int i = 0; i < 37; ++i) first.step(0.01);
    ParticleSystem second(fountain(), &index, first.state());
    for (int i = 37; i < 80; ++i) second.step(0.01);
    EXPECT_GT(second.state().size(), 900u);
    EXPECT_TRUE(second.state() == whole.state());
    EXPECT_EQ(second.emitted(), whole.emitted());
}

TEST(ParticleSystem, RefusesBadOptions) {
    const auto refused = [](auto change) {
        Options options = fountain();
        change(options);
        try {
            ParticleSystem system(options);
            ADD_FAILURE() << "accepted";
        } catch (const UsageError& e) {
            EXPECT_NE(std::string(e.what()).find(": give "), std::string::npos) << e.what();
        }
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {-1.0, nan, std::numeric_limits<double>::infinity()}) {
        refused([&](Options& o) { o.emitters[1].rate = bad; });
        refused([&](Options& o) { o.emitters[1].speed = bad; });
        refused([&](Options& o) { o.emitters[1].life = bad; });
        refused([&](Options& o) { o.emitters[1].radius = bad; });
        refused([&](Options& o) { o.emitters[1].spread = bad; });
        refused([&](Options& o) { o.contacts.restitution = bad; });
        refused([&](Options& o) { o.contacts.friction = bad; });
        refused([&](Options& o) { o.forces.linear_drag = bad; });
        refused([&](Options& o) { o.forces.quadratic_drag = bad; });
    }
    refused([&](Options& o) { o.forces.gravity[1] = nan; });
    refused([&](Options& o) { o.forces.wind[2] = nan; });
    refused([&](Options& o) { o.emitters[0].begin = nan; });
    refused([&](Options& o) { o.emitters[0].direction = {}; });
    refused([&](Options& o) { o.emitters[0].speed_spread = 4; });
    refused([&](Options& o) { o.emitters[0].life_spread = 0.7; });
    refused([&](Options& o) { o.emitters[0].radius = 0; });  // with contacts of each other
    refused([&](Options& o) { o.emitters[0].source = FromPoint{{0, nan, 0}}; });
    refused([&](Options& o) { o.emitters[0].source = FromDisc{{}, -1}; });
    refused([&](Options& o) { o.emitters[0].source = FromBox{{{0, 0, 0}, {1, -1, 1}}}; });
    Options options = fountain();
    const TriangleMesh<double> flat{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}, {}};
    options.emitters[0].source = FromSurface{flat.view()};
    EXPECT_THROW(ParticleSystem system(options), InputError);
    // States.
    const auto bad_state = [](auto change) {
        ParticleState state = one({}, {}, 1);
        change(state);
        EXPECT_THROW(ParticleSystem system({}, nullptr, state), InputError);
    };
    bad_state([&](ParticleState& s) { s.ages.clear(); });
    bad_state([&](ParticleState& s) { s.numbers.push_back(1); });
    bad_state([&](ParticleState& s) { s.particles.places[0][1] = nan; });
    bad_state([&](ParticleState& s) { s.particles.velocities[0][1] = nan; });
    bad_state([&](ParticleState& s) { s.particles.masses[0] = 0; });
    bad_state([&](ParticleState& s) { s.radii[0] = -1; });
    bad_state([&](ParticleState& s) { s.time = nan; });
    ParticleSystem system(fountain());
    for (const double bad : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()})
        EXPECT_THROW(system.step(bad), UsageError);
    EXPECT_THROW(system.step_until(-1), UsageError);
}
/// Nothing at all, and meshes of nothing.
TEST(ParticleSystem, MayBeEmpty) {
    const TriangleMesh<double> nothing;
    const auto index = build(nothing);
    ParticleSystem system({}, &index);
    system.step(1);
    EXPECT_EQ(system.state().size(), 0u);
    ParticleSystem still(fountain(), &index);
    still.step(0.1);
    EXPECT_EQ(still.state().size(), 200u);
    EXPECT_EQ(still.emitted(), 200u);
}

}  // namespace
