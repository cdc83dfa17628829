/// Forces within the error that is asked for, against direct sums: scenes of every kind, by every instruction
/// set.
#include <gtest/gtest.h>

#include <hedgerow/base/error.h>
#include <hedgerow/nbody/acting_cells.h>
#include <hedgerow/nbody/force_check.h>
#include <hedgerow/nbody/forces.h>
#include <hedgerow/scenes/particles.h>
#include <hedgerow/scenes/random.h>

#include "long_runs.h"
#include "using.h"

using namespace hedgerow;

namespace {

struct Scene {
    std::vector<Vec3d> places;
    std::vector<double> charges;

    void add(const Vec3d& p, double charge) { places.push_back(p), charges.push_back(charge); }
    Charges<double> view() const { return {places, charges}; }
};
Scene cube(std::size_t n, bool neutral = false) {
    Scene scene;
    for (std::uint64_t i = 0; i < n; ++i) {
        Random random(70, i);
        scene.add(random.in_cube<3>(), (neutral && i % 2 == 1 ? -1 : 1) * (0.5 + random.uniform()));
    }
    return scene;
}
Scene stars(const Particles& all) {
    return {all.places, all.masses};
}
Scene lattice(int side) {
    Scene scene;
    for (int i = 0; i < side * side * side; ++i) {
        const int row = i / side, layer = row / side;
        scene.add(Vec3d(i % side, row % side, layer), 1);
    }
    return scene;
}
/// Two clusters, one 10^6 times as heavy and some times as small.
Scene unlike_clusters(std::size_t n, double size) {
    Scene scene;
    for (std::uint64_t i = 0; i < n; ++i) {
        Random random(72, i);
        const Vec3d p(random.direction<3>() * random.uniform());
        if (i % 2 == 0)
            scene.add(p * size, 1e6);
        else
            scene.add(p + Vec3d(5, 1, 2), 1);
    }
    return scene;
}

std::vector<PotentialAt<double>> forces_of(const Scene& scene, double accuracy, Threads threads = {}) {
    std::vector<PotentialAt<double>> found(scene.places.size());
    forces<double>(scene.view(), found, {.accuracy = accuracy, .threads = threads});
    return found;
}
double error_of(const Scene& scene, const std::vector<PotentialAt<double>>& found) {
    return ForceCheck(scene.view()).errors_of<double>(found).rms;
}

TEST(Forces, KeepTheirAccuracy) {
    const std::size_t n = in_long_runs(100000, unless_sanitized(20000, 4000));
    const std::pair<const char*, Scene> scenes[] = {{"cube", cube(n)},
                                                    {"neutral", cube(n, true)},
                                                    {"plummer", stars(plummer(n))},
                                                    {"hernquist", stars(hernquist(n))},
                                                    {"disc", stars(disc(n))},
                                                    {"lattice", lattice(n > 50000 ? 46 : 25)},
                                                    {"two clusters", unlike_clusters(n, 1e-6)},
                                                    {"unlike clusters", unlike_clusters(n, 1e-9)}};
    for (const auto& [name, scene] : scenes) {
        const ForceCheck check(scene.view(), in_long_runs(n, 1000));
        for (const double accuracy : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
            SCOPED_TRACE(std::string(name) + " " + std::to_string(accuracy * 1e9) + "e-9");
            const auto found = forces_of(scene, accuracy);
            const ForceErrors errors = check.errors_of<double>(found);
            EXPECT_LE(errors.rms, accuracy);
            EXPECT_LE(errors.most, 10 * accuracy);
            if (in_long_runs(1, 0) == 1)
                std::printf("%-14s %.0e: rms %.1e, all but a thousandth %.1e, most %.1e\n", name, accuracy,
                            errors.rms, errors.most, errors.largest);
            EXPECT_LE(errors.imbalance, accuracy >= 3e-7 ? 1e-6 : 1e-13);
        }
    }
}
TEST(Forces, WhoseSizesAreKnownKeepTheirAccuracy) {
    const Scene scene = stars(plummer(20000));
    const ForceCheck check(scene.view());
    auto found = forces_of(scene, 1e-2);
    for (const double accuracy : {1e-3, 1e-5, 1e-7}) {
        std::vector<double> sizes;
        sizes.reserve(found.size());
        for (const auto& at : found) sizes.push_back(length(at.gradient));
        forces<double>(scene.view(), found, {accuracy, sizes});
        const ForceErrors errors = check.errors_of<double>(found);
        EXPECT_LE(errors.rms, accuracy);
        EXPECT_LE(errors.most, 10 * accuracy);
    }
}
/// At other places than those of the charges: few and many, inside and far away, and at charges.
TEST(Forces, AtOtherPlaces) {
    const Scene scene = stars(plummer(20000));
    for (const std::size_t count : {1u, 30u, 3000u}) {
        std::vector<Vec3d> targets;
        for (std::uint64_t i = 0; i < count; ++i) {
            Random random(75, i);
            targets.push_back(i % 3 == 0 ? scene.places[i] : random.direction<3>() * (random.uniform() * 20));
        }
        std::vector<PotentialAt<double>> want(count), found(count);
        direct_sum<double>(scene.view(), targets, want);
        for (const auto set : instruction_sets())
            for (const double accuracy : {1e-3, 1e-6}) {
                const Using use(set);
                forces<double>(scene.view(), Targets<double>(targets), found, {.accuracy = accuracy});
                double error2 = 0;
                for (std::size_t i = 0; i < count; ++i)
                    error2 += length2(found[i].gradient - want[i].gradient) / length2(want[i].gradient) /
                              static_cast<double>(count);
                // One target alone may err as a few of many may.
                EXPECT_LE(std::sqrt(error2), count < 100 ? 10 * accuracy : accuracy) << set << " " << count;
            }
    }
    std::vector<PotentialAt<double>> none;
    forces<double>(scene.view(), Targets<double>(std::vector<Vec3d>()), none);
    // Nothing acts where there is no charge.
    std::vector<PotentialAt<double>> one(1, {1, {1, 1, 1}});
    forces<double>(Scene().view(), Targets<double>(std::vector<Vec3d>{{1, 2, 3}}), one);
    EXPECT_EQ(one[0].potential, 0);
}
/// Softened charges, of one length or each its own, against direct sums.
TEST(Forces, OfSoftenedCharges) {
    const Scene scene = stars(plummer(10000));
    std::vector<double> lengths;
    for (std::uint64_t i = 0; i < scene.places.size(); ++i) lengths.push_back(0.1 * Random(76, i).uniform());
    for (const auto kernel : {SofteningKernel::wendland, SofteningKernel::spline})
        for (const bool own : {false, true}) {
            Charges<double> charges = scene.view();
            charges.softening = {kernel, 0.05};
            if (own) charges.lengths = lengths;
            const ForceCheck check(charges, 10000);
            std::vector<PotentialAt<double>> found(scene.places.size());
            for (const double accuracy : {1e-3, 1e-7}) {
                forces<double>(charges, found, {.accuracy = accuracy});
                const ForceErrors errors = check.errors_of<double>(found);
                EXPECT_LE(errors.rms, accuracy);
                EXPECT_LE(errors.imbalance, accuracy >= 3e-7 ? 1e-6 : 1e-13);
            }
        }
}
TEST(Forces, OfEveryInstructionSet) {
    const Scene scene = stars(plummer(13000));  // more than are summed directly
    const ForceCheck check(scene.view());
    for (const auto set : instruction_sets()) {
        SCOPED_TRACE(set);
        const Using use(set);
        for (const double accuracy : {1e-2, 1e-3, 1e-5, 1e-6, 1e-7, 1e-9})
            EXPECT_LE(check.errors_of<double>(forces_of(scene, accuracy)).rms, accuracy) << accuracy;
    }
}
TEST(Forces, AreTheSameForAnyNumberOfThreads) {
    const Scene scene = stars(plummer(30000));
    for (const double accuracy : {1e-3, 1e-6}) {
        const auto serial = forces_of(scene, accuracy, serial_executor()),
                   parallel = forces_of(scene, accuracy, default_executor());
        for (std::size_t i = 0; i < serial.size(); ++i) {
            ASSERT_EQ(serial[i].potential, parallel[i].potential);
            ASSERT_EQ(serial[i].gradient, parallel[i].gradient);
        }
    }
}
TEST(Forces, OfFewOrCoincidentCharges) {
    EXPECT_TRUE(forces_of(Scene(), 1e-3).empty());
    Scene scene;
    scene.add({1, 2, 3}, 5);
    EXPECT_EQ(forces_of(scene, 1e-3)[0].potential, 0);
    scene.add({1, 2, 5}, 3);
    EXPECT_NEAR(forces_of(scene, 1e-3)[0].potential, 1.5, 1e-6);
    EXPECT_NEAR(forces_of(scene, 1e-3)[1].gradient[2], -1.25, 1e-6);
    scene = Scene();
    for (int i = 0; i < 1000000; ++i) scene.add({0.1, 0.2, 0.3}, 1);
    EXPECT_EQ(forces_of(scene, 1e-3)[7].potential, 0);
    // On a line, and charges of nothing.
    scene = Scene();
    for (int i = 0; i < 5000; ++i) scene.add(Vec3d(1, 2, 3) * std::sqrt(i), i % 3 == 0 ? 0 : 1);
    EXPECT_LE(error_of(scene, forces_of(scene, 1e-4)), 1e-4);
    for (auto& charge : scene.charges) charge = 0;
    for (const auto& at : forces_of(scene, 1e-4)) EXPECT_EQ(at.gradient, Vec3d());
    // So many that pairs alone would take a minute.
    scene = cube(500000);
    for (auto& charge : scene.charges) charge = 0;
    EXPECT_EQ(forces_of(scene, 1e-4)[77].gradient, Vec3d());
}
TEST(Forces, OfFloatsOfAnyScale) {
    const Scene scene = cube(3000);
    for (const int exponent : {-20, 0, 20}) {
        Scene scaled = scene;
        std::vector<Vec3f> places;
        std::vector<float> charges;
        places.reserve(scene.places.size()), charges.reserve(scene.places.size());
        for (std::size_t i = 0; i < scene.places.size(); ++i) {
            places.emplace_back(scene.places[i] * std::ldexp(1.0, exponent));
            charges.push_back(static_cast<float>(std::ldexp(scene.charges[i], exponent)));
            scaled.places[i] = Vec3d(places[i]), scaled.charges[i] = static_cast<double>(charges[i]);
        }
        std::vector<PotentialAt<float>> found(places.size());
        forces<float>({places, charges}, found, {.accuracy = 1e-4});
        std::vector<PotentialAt<double>> in_double;
        in_double.reserve(found.size());
        for (const auto& at : found)
            in_double.push_back({static_cast<double>(at.potential), Vec3d(at.gradient)});
        EXPECT_LE(error_of(scaled, in_double), 1e-4) << exponent;
    }
}
/// Of each charge, the cells that act on it hold every other one, once.
TEST(Forces, CellsThatActHoldEachChargeOnce) {
    const Scene scene = stars(plummer(20000));
    for (const auto set : instruction_sets()) {
        const Using use(set);
        for (const double accuracy : {1e-3, 1e-6})
            for (const std::size_t i : {0u, 77u, 19999u}) {
                const auto cells = acting_cells<double>(scene.view(), i, {.accuracy = accuracy});
                std::size_t held = 0, pairs = 0;
                for (const auto& cell : cells) {
                    held += cell.count;
                    if (cell.by == ActsBy::pairs) pairs += cell.count;
                }
                EXPECT_EQ(held, set == "plain" ? 0 : 20000) << set;  // its own leaf with it
                if (set == "plain") continue;
                EXPECT_GT(pairs, 0u);
                EXPECT_LT(pairs, 15000u);
                EXPECT_LT(cells.size(), 3000u);
            }
    }
    EXPECT_TRUE(acting_cells<double>(scene.view(), 20000).empty());
}
/// What is added to forces is what the check finds.
TEST(Forces, ChecksTellTheErrors) {
    const Scene scene = stars(plummer(2000));
    std::vector<PotentialAt<double>> found(2000);
    direct_sum<double>(scene.view(), scene.places, found);
    const ForceCheck check(scene.view(), 2000);
    ForceErrors errors = check.errors_of<double>(found);
    EXPECT_EQ(errors.targets, 2000u);
    EXPECT_EQ(errors.largest, 0);
    EXPECT_LE(errors.imbalance, 1e-11);
    for (std::size_t i = 0; i < 2000; i += 500) found[i].gradient = found[i].gradient * (i == 0 ? 1.1 : 1.01);
    errors = check.errors_of<double>(found);
    EXPECT_NEAR(errors.rms, std::sqrt((0.01 + 3e-4) / 2000), 1e-9);
    EXPECT_NEAR(errors.largest, 0.1, 1e-9);
    EXPECT_NEAR(errors.most, 0.01, 1e-9);
    EXPECT_EQ(ForceCheck(Scene().view()).errors_of<double>({}).targets, 0u);
    found.pop_back();
    EXPECT_THROW(check.errors_of<double>(found), InputError);
}
TEST(Forces, RefuseBadInput) {
    Scene scene = cube(100);
    EXPECT_THROW(forces_of(scene, 0), InputError);
    EXPECT_THROW(forces_of(scene, 1), InputError);
    EXPECT_THROW(forces_of(scene, std::nan("")), InputError);
    scene.places[31][2] = std::nan("");
    try {
        forces_of(scene, 1e-3);
        ADD_FAILURE();
    } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find("source 31 is nan"), std::string::npos) << e.what();
    }
    std::vector<PotentialAt<double>> found(99);
    EXPECT_THROW(forces<double>(cube(100).view(), found), InputError);
}

}  // namespace
