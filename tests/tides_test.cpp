/// Tidal tensors: against differences of gradients, and those of fast multipoles against sums over pairs.
#include <gtest/gtest.h>

#include <hedgerow/base/error.h>
#include <hedgerow/nbody/forces.h>
#include <hedgerow/scenes/particles.h>
#include <hedgerow/scenes/random.h>

#include "using.h"

using namespace hedgerow;

namespace {

std::array<double, 6> numbers(const Tides& t) {
    return {t.xx, t.yy, t.zz, t.xy, t.xz, t.yz};
}
double size_of(const Tides& t) {
    double sum = 0;
    for (const double x : numbers(t)) sum += x * x;
    return std::sqrt(sum);
}

struct Case {
    const char* name;
    Particles particles;
    Softening softening = {};
    double period = 0;

    Charges<double> view() const { return {particles.places, particles.masses, softening, {}, period}; }
};
std::vector<Case> cases(std::size_t n) {
    return {{"points", plummer(n)},
            {"Wendland", plummer(n), {SofteningKernel::wendland, 0.1}},
            {"spline", plummer(n), {SofteningKernel::spline, 0.1}},
            {"periodic", cold_cube(n), {}, 1},
            {"periodic and softened", cold_cube(n), {SofteningKernel::wendland, 0.1}, 1}};
}

TEST(Tides, AreDifferencesOfGradients) {
    for (const Case& c : cases(60)) {
        SCOPED_TRACE(c.name);
        std::vector<Vec3d> places, moved;
        constexpr double step = 1e-5;
        for (std::uint64_t i = 0; i < 10; ++i) {
            places.push_back(Random(90, i).in_cube<3>());
            for (int k = 0; k < 6; ++k) {
                Vec3d p = places.back();
                p[k / 2] += k % 2 == 0 ? -step : step;
                moved.push_back(p);
            }
        }
        std::vector<Tides> found(places.size());
        std::vector<PotentialAt<double>> around(moved.size());
        direct_tides<double>(c.view(), places, found);
        direct_sum<double>(c.view(), moved, around);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const auto change = [&](std::size_t along, int of) {
                return (around[6 * i + 2 * along + 1].gradient[of] - around[6 * i + 2 * along].gradient[of]) /
                       (2 * step);
            };
            const Tides want{change(0, 0), change(1, 1), change(2, 2),
                             change(0, 1), change(2, 0), change(1, 2)};
            EXPECT_LE(size_of(found[i] + want * -1.0), 1e-4 * (1 + size_of(want)));
        }
    }
}
/// At charges and at other places, by every instruction set.
TEST(Tides, OfFastMultipolesAreThoseOfPairs) {
    for (const Case& c : cases(1200)) {
        SCOPED_TRACE(c.name);
        std::vector<Vec3d> some, others;
        std::vector<double> masses;
        for (std::size_t i = 0; i < 1200; i += 24) {
            some.push_back(c.particles.places[i]), masses.push_back(c.particles.masses[i]);
            others.push_back(Random(91, i).in_cube<3>());
        }
        std::vector<double> lengths(some.size(), c.softening.length);
        std::vector<Tides> want(some.size()), want_others(some.size()), found(1200);
        direct_tides<double>(c.view(), Targets<double>(some, lengths, masses), want);
        direct_tides<double>(c.view(), others, want_others);
        for (const auto set : instruction_sets()) {
            if (c.period > 0 && set != instruction_sets().front()) continue;  // pairs of all near images
            const Using use(set);
            for (const double accuracy : {1e-3, 1e-7}) {
                SCOPED_TRACE(std::string(set) + " " + std::to_string(accuracy));
                std::vector<PotentialAt<double>> at(1200), at_others(some.size());
                std::vector<Tides> found_others(some.size());
                forces<double>(c.view(), at, {.accuracy = accuracy, .tides = found});
                forces<double>(c.view(), Targets<double>(others), at_others,
                               {.accuracy = accuracy, .tides = found_others});
                double error2 = 0;
                for (std::size_t i = 0; i < want.size(); ++i) {
                    const auto square = [](double x) { return x * x; };
                    error2 += square(size_of(found[24 * i] + want[i] * -1.0) / (1 + size_of(want[i])));
                    error2 += square(size_of(found_others[i] + want_others[i] * -1.0) /
                                     (1 + size_of(want_others[i])));
                }
                EXPECT_LE(std::sqrt(error2 / static_cast<double>(2 * want.size())), 3 * accuracy);
            }
        }
    }
}
TEST(Tides, AcrossAFaceOfAPeriodicCubeAreThoseOfTheDistance) {
    const std::vector<Vec3d> places{{0x1p-60, 0.5, 0.5}, {1 - 0x1p-50, 0.5, 0.5}};
    const std::vector<double> charges{1, 1};
    std::vector<Tides> found(1);
    direct_tides<double>({places, charges, {}, {}, 1}, std::vector<Vec3d>{places[0]}, found);
    const double apart = 0x1p-50 + 0x1p-60, whole = 1 / (apart * apart * apart);
    EXPECT_NEAR(found[0].xx / whole, 2, 1e-14);
    EXPECT_NEAR(found[0].yy / whole, -1, 1e-14);
    EXPECT_NEAR(found[0].zz / whole, -1, 1e-14);
}

TEST(Tides, NeedRoomForEachTarget) {
    const Particles all = plummer(100);
    std::vector<PotentialAt<double>> found(100);
    std::vector<Tides> tides(99);
    EXPECT_THROW(forces<double>({all.places, all.masses}, found, {.accuracy = 1e-3, .tides = tides}),
                 InputError);
    EXPECT_THROW(direct_tides<double>({all.places, all.masses}, all.places, tides), InputError);
}

}  // namespace
