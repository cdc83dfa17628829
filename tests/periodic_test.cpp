/// Charges in a cube that repeats: against sums after Ewald, and lattices whose constants are known.
#include <gtest/gtest.h>

#include <numbers>

#include <hedgerow/base/error.h>
#include <hedgerow/nbody/acting_cells.h>
#include <hedgerow/nbody/barnes_hut.h>
#include <hedgerow/nbody/force_check.h>
#include <hedgerow/nbody/forces.h>
#include <hedgerow/nbody/kernels.h>
#include <hedgerow/scenes/random.h>

#include "long_runs.h"
#include "using.h"

using namespace hedgerow;

namespace {

struct Cube {
    std::vector<Vec3d> places;
    std::vector<double> charges;
    double side = 1;

    std::size_t size() const { return places.size(); }
    Charges<double> view() const { return {places, charges, {}, {}, side}; }
};
/// Charges that are even, or gather near a corner; all above 0, or of both signs.
Cube cube(std::size_t n, bool even, bool neutral, double side = 1) {
    Cube scene{{}, {}, side};
    for (std::uint64_t i = 0; i < n; ++i) {
        Random random(80, i);
        Vec3d p = random.in_cube<3>();
        if (!even)
            for (int k = 0; k < 3; ++k) p[k] = p[k] * p[k] * p[k];
        scene.places.push_back(p * side);
        scene.charges.push_back((neutral && i % 2 == 1 ? -1 : 1) * (0.5 + random.uniform()));
    }
    return scene;
}

/// What a charge of 1 and all its images do at an offset from it, after Ewald (1921): one sum over images,
/// and one over waves, in a cube of side 1. Of the charge itself nothing at its own place.
PotentialAt<double> after_ewald(Vec3d offset) {
    constexpr double pi = std::numbers::pi, width = 2.2;
    for (int k = 0; k < 3; ++k) offset[k] -= std::round(offset[k]);
    PotentialAt<double> sum{-pi / (width * width), {}};
    constexpr int images = 3, waves = 6;
    for (int x = -images; x <= images; ++x)
        for (int y = -images; y <= images; ++y)
            for (int z = -images; z <= images; ++z) {
                const Vec3d v = offset + Vec3d(x, y, z);
                const double r = length(v);
                if (r == 0) {
                    sum.potential -= 2 * width / std::sqrt(pi);
                    continue;
                }
                const double screened = std::erfc(width * r) / r;
                sum.potential += screened;
                sum.gradient +=
                    v *
                    (-(screened + 2 * width / std::sqrt(pi) * std::exp(-width * width * r * r)) / (r * r));
            }
    for (int x = -waves; x <= waves; ++x)
        for (int y = -waves; y <= waves; ++y)
            for (int z = -waves; z <= waves; ++z) {
                if (x == 0 && y == 0 && z == 0) continue;
                const Vec3d k = Vec3d(x, y, z) * (2 * pi);
                const double size = 4 * pi / length2(k) * std::exp(-length2(k) / (4 * width * width)),
                             phase = dot(k, offset);
                sum.potential += size * std::cos(phase);
                sum.gradient += k * (-size * std::sin(phase));
            }
    return sum;
}
std::vector<PotentialAt<double>> after_ewald(const Cube& cube) {
    std::vector<PotentialAt<double>> all(cube.size());
    for (std::size_t i = 0; i < cube.size(); ++i)
        for (std::size_t j = 0; j < cube.size(); ++j) {
            const auto one = after_ewald((cube.places[i] - cube.places[j]) / cube.side);
            all[i].potential += cube.charges[j] * one.potential / cube.side;
            all[i].gradient += one.gradient * (cube.charges[j] / (cube.side * cube.side));
        }
    return all;
}

std::vector<PotentialAt<double>> forces_of(const Cube& cube, double accuracy, Threads threads = {}) {
    std::vector<PotentialAt<double>> found(cube.size());
    forces<double>(cube.view(), found, {.accuracy = accuracy, .threads = threads});
    return found;
}
TEST(Periodic, DirectSumsAreThoseAfterEwald) {
    for (const double side : {1.0, 0.3, 7e5})
        for (const bool neutral : {false, true}) {
            const Cube scene = cube(40, true, neutral, side);
            const auto want = after_ewald(scene);
            for (const auto set : instruction_sets()) {
                SCOPED_TRACE(set);
                const Using use(set);
                std::vector<PotentialAt<double>> found(scene.size());
                direct_sum<double>(scene.view(), scene.places, found);
                for (std::size_t i = 0; i < scene.size(); ++i) {
                    EXPECT_NEAR(found[i].potential * side, want[i].potential * side, 1e-9);
                    EXPECT_LE(length(found[i].gradient - want[i].gradient) * side * side, 1e-8);
                }
            }
        }
}
/// One pair anywhere, in the corners too, where expansions about the cube's middle converge least.
TEST(Periodic, PairsAnywhereAreThoseAfterEwald) {
    for (std::uint64_t i = 0; i < 200; ++i) {
        Random random(81, i);
        Cube scene{{random.in_cube<3>(), random.in_cube<3>()}, {1, 0}};
        if (i % 2 == 0)
            for (Vec3d& p : scene.places)
                for (int k = 0; k < 3; ++k) p[k] = std::round(p[k]) * 0.999999;
        std::vector<PotentialAt<double>> found(2);
        direct_sum<double>(scene.view(), scene.places, found);
        const auto want = after_ewald(scene.places[1] - scene.places[0]);
        const double error = i % 2 == 0 ? 1e-7 : 1e-9;
        EXPECT_NEAR(found[1].potential, want.potential, error * (1 + std::abs(want.potential)));
        EXPECT_LE(length(found[1].gradient - want.gradient), 10 * error * (1 + length(want.gradient)));
    }
}
/// Madelung's constant of rock salt.
TEST(Periodic, RockSalt) {
    for (const int side : {2, 8}) {
        Cube salt;
        salt.side = side;
        for (int x = 0; x < side; ++x)
            for (int y = 0; y < side; ++y)
                for (int z = 0; z < side; ++z) {
                    salt.places.emplace_back(x, y, z);
                    salt.charges.push_back((x + y + z) % 2 == 0 ? 1 : -1);
                }
        for (const auto set : instruction_sets()) {
            SCOPED_TRACE(set);
            const Using use(set);
            const auto found = forces_of(salt, 1e-9);
            for (std::size_t i = 0; i < salt.size(); ++i) {
                EXPECT_NEAR(found[i].potential * salt.charges[i], -1.747564594633182, 1e-9);
                EXPECT_LE(length(found[i].gradient), 1e-8);
            }
        }
    }
}
TEST(Periodic, ForcesKeepTheirAccuracy) {
    for (const bool even : {true, false})
        for (const bool neutral : {true, false}) {
            const Cube scene = cube(unless_sanitized(8000, 1500), even, neutral, 3);
            const ForceCheck check(scene.view(), 200);
            for (const double accuracy : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-7, 1e-9}) {
                const ForceErrors errors = check.errors_of<double>(forces_of(scene, accuracy));
                EXPECT_LE(errors.rms, accuracy) << even << neutral;
                EXPECT_LE(errors.imbalance, accuracy > 6e-7 ? 2e-6 : 1e-13) << accuracy;
            }
        }
}
TEST(Periodic, OfEveryInstructionSet) {
    const Cube scene = cube(1000, false, false);
    const ForceCheck check(scene.view());
    for (const auto set : instruction_sets())
        for (const double accuracy : {1e-3, 1e-6}) {
            const Using use(set);
            EXPECT_LE(check.errors_of<double>(forces_of(scene, accuracy)).rms, accuracy) << set;
        }
}
/// Places may lie in any image of the cube, targets too, and all may be moved.
TEST(Periodic, PlacesOfAnyImages) {
    const Cube scene = cube(5000, true, false, 2);
    Cube moved = scene;
    std::vector<Vec3d> targets, targets_in_cube;
    for (std::size_t i = 0; i < scene.size(); ++i) {
        const auto n = [&](std::size_t k) { return static_cast<double>(i / k % 7) - 3; };
        moved.places[i] += Vec3d(n(1), n(7), n(49)) * 2.0 + Vec3d(0.7, 0.1, 1.9);
        if (i % 10 != 0) continue;
        targets_in_cube.push_back(Random(82, i).in_cube<3>() * 2.0);
        targets.push_back(targets_in_cube.back() - Vec3d(n(3), n(5), n(2)) * 2.0);
    }
    EXPECT_LE(ForceCheck(scene.view(), 200).errors_of<double>(forces_of(moved, 1e-6)).rms, 1e-6);
    std::vector<PotentialAt<double>> found(targets.size()), want(targets.size());
    forces<double>(scene.view(), Targets<double>(targets), found, {.accuracy = 1e-6});
    direct_sum<double>(scene.view(), targets_in_cube, want);
    double error2 = 0;
    for (std::size_t k = 0; k < found.size(); ++k)
        error2 += length2(found[k].gradient - want[k].gradient) / length2(want[k].gradient);
    EXPECT_LE(std::sqrt(error2 / static_cast<double>(found.size())), 3e-6);
}
TEST(Periodic, OfSoftenedCharges) {
    const Cube scene = cube(3000, true, false);
    Charges<double> charges = scene.view();
    charges.softening.length = 0.1;
    const ForceCheck check(charges);
    std::vector<PotentialAt<double>> found(scene.size());
    for (const double accuracy : {1e-3, 1e-7}) {
        forces<double>(charges, found, {.accuracy = accuracy});
        EXPECT_LE(check.errors_of<double>(found).rms, accuracy);
    }
    charges.softening.length = 0.5;  // which reaches beyond the cube's side
    EXPECT_THROW(forces<double>(charges, found), InputError);
}
TEST(Periodic, AreTheSameForAnyNumberOfThreads) {
    const Cube scene = cube(20000, false, false);
    const auto serial = forces_of(scene, 1e-3, serial_executor()),
               parallel = forces_of(scene, 1e-3, default_executor());
    for (std::size_t i = 0; i < serial.size(); ++i) {
        ASSERT_EQ(serial[i].potential, parallel[i].potential);
        ASSERT_EQ(serial[i].gradient, parallel[i].gradient);
    }
}
TEST(Periodic, OfFewOrCoincidentCharges) {
    // One charge stays where it is, in the potential of its own images.
    const Cube one{{{0.1, 0.2, 0.3}}, {3}};
    const auto alone = forces_of(one, 1e-9);
    EXPECT_NEAR(alone[0].potential, -2.837297479480 * 3, 1e-8);
    EXPECT_LE(length(alone[0].gradient), 1e-8);
    Cube many;
    many.places.assign(10000, {0.1, 0.2, 0.3}), many.charges.assign(10000, 1);
    EXPECT_NEAR(forces_of(many, 1e-6)[7].potential, -28372.97479480, 1e-2);
    EXPECT_TRUE(forces_of(Cube(), 1e-3).empty());
}
TEST(Periodic, OfFloats) {
    const Cube scene = cube(3000, true, false);
    std::vector<Vec3f> places;
    std::vector<float> charges;
    Cube same;
    for (std::size_t i = 0; i < scene.size(); ++i) {
        places.emplace_back(scene.places[i]), charges.push_back(static_cast<float>(scene.charges[i]));
        same.places.emplace_back(places[i]), same.charges.push_back(static_cast<double>(charges[i]));
    }
    std::vector<PotentialAt<float>> found(scene.size());
    forces<float>({places, charges, {}, {}, 1}, found, {.accuracy = 1e-4});
    EXPECT_LE(ForceCheck(same.view()).errors_of<float>(found).rms, 1e-4);
}
/// Of a charge, the cells that act on it hold each near image of each charge once.
TEST(Periodic, CellsThatActHoldEachNearImageOnce) {
    if (in_use<NbodyKernels>() == nullptr) GTEST_SKIP() << "no kernels";
    const Cube scene = cube(20000, false, false);
    std::size_t held = 0;
    for (const auto& cell : acting_cells<double>(scene.view(), 77, {.accuracy = 1e-3})) held += cell.count;
    EXPECT_EQ(held, 125u * 20000);
}
TEST(Periodic, RefuseBadInput) {
    Cube scene = cube(100, true, false);
    for (const double side : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        scene.side = side;
        EXPECT_THROW(forces_of(scene, 1e-3), InputError);
    }
    scene.side = 1;
    std::vector<PotentialAt<double>> found(100);
    EXPECT_THROW(barnes_hut<double>(scene.view(), found), UsageError);
}

}  // namespace
