/// What surfaces do to light: values, densities and samples against each other, and reciprocity.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <iomanip>
#include <limits>

#include <rapidcheck.h>

#include "scattering_support.h"

namespace hedgerow {
namespace {

using namespace scatterings;

constexpr double cosines[] = {1.0, 0.7, 0.15};

bool finite_and_positive(const Vec3f& v) {
    return finite(v) && v[0] >= 0 && v[1] >= 0 && v[2] >= 0;
}

class Surfaces : public testing::TestWithParam<Surface> {};

/// Counts of samples in the cells of two charts, and how many are single directions or none.
struct Histogram {
    static constexpr int rows = 16, columns = 16, cells = 2 * rows * columns;
    std::vector<double> counts = std::vector<double>(cells + 1), expected = std::vector<double>(cells + 1);

    static std::size_t cell(const std::array<Chart, 2>& charts, const Vec3f& i) {
        const std::size_t side = i[2] > 0 ? 0 : 1;
        const auto [t, turn] = charts[side].of(i);
        const auto of = [](double x, int n) {
            return static_cast<std::size_t>(std::clamp(static_cast<int>(x * n), 0, n - 1));
        };
        return (side * rows + of(t, rows)) * columns + of(turn, columns);
    }
    /// Integrates the density over each cell, by midpoints.
    void integrate(const Scattering& s, const std::array<Chart, 2>& charts) {
        constexpr int fine = 16;
        double all = 0;
        for (std::size_t c = 0; c < cells; ++c) {
            const std::size_t side = c / (rows * columns);
            const auto row = static_cast<double>(c / columns % rows),
                       column = static_cast<double>(c % columns);
            for (int k = 0; k < fine * fine; ++k) {
                const int down = k / fine, across = k % fine;
                const double t = (row + (down + 0.5) / fine) / rows,
                             turn = (column + (across + 0.5) / fine) / columns;
                const Vec3f i = charts[side].at(t, turn);
                if ((i[2] > 0) != (side == 0)) continue;
                expected[c] +=
                    static_cast<double>(s.density(i)) * charts[side].area(t) / (fine * fine * rows * columns);
            }
            all += expected[c];
        }
        EXPECT_LT(all, 1.003);
        expected[cells] = std::max(1 - all, 0.0);
    }
    /// The probability of counts as unlikely as these. Cells that expect less than 5 samples are put
    /// together.
    double probability(double samples) const {
        double sum = 0, few_counts = 0, few_expected = 0;
        int degrees = -1;
        const auto add = [&](double count, double mean) {
            sum += (count - mean) * (count - mean) / mean;
            ++degrees;
        };
        for (std::size_t c = 0; c <= cells; ++c) {
            const double mean = expected[c] * samples;
            if (mean >= 5) {
                add(counts[c], mean);
            } else {
                few_counts += counts[c], few_expected += mean;
            }
        }
        if (few_expected >= 5) add(few_counts, few_expected);
        if (few_expected < 5 && few_counts > 25) return 0;
        return degrees > 0 ? chi2_exceeds(sum, degrees) : 1;
    }
};

TEST_P(Surfaces, SamplesFollowTheDensity) {
    const Surface& s = GetParam();
    constexpr int samples = 20000;
    // The significance of 1% over all tests (Šidák 1967).
    const double tests = static_cast<double>(surfaces().size() * std::size(cosines));
    const double significance = 1 - std::pow(1 - 0.01, 1 / tests);
    for (const double cosine : cosines) {
        const Vec3f o = direction(cosine);
        const Scattering scattering = s.at(o);
        const auto around = charts(s, o);
        Histogram histogram;
        histogram.integrate(scattering, around);
        std::mt19937 generator(17);
        const auto number = [&] { return static_cast<float>(generator() >> 8) * 0x1p-24f; };
        for (int k = 0; k < samples; ++k) {
            const float choice = number(), u = number(), v = number();
            const auto to = scattering.sample(choice, u, v);
            const bool broad = to && !to.specular;
            histogram.counts[broad ? Histogram::cell(around, to.direction) : Histogram::cells] += 1;
        }
        EXPECT_GT(histogram.probability(samples), significance) << "cosine " << cosine;
    }
}

TEST_P(Surfaces, WeightsAreValueOverDensity) {
    const Surface& s = GetParam();
    for (const double cosine : {1.0, 0.7, 0.15, 0.001}) {
        const Scattering scattering = s.at(direction(cosine));
        int found = 0;
        for (int k = 0; k < 500; ++k) {
            const auto [choice, u, v] = even_point(k);
            const auto to = scattering.sample(choice, u, v);
            if (!to) continue;
            ++found;
            const Vec3f& i = to.direction;
            EXPECT_NEAR(length(i), 1, 1e-5);
            EXPECT_EQ(to.transmitted, i[2] < 0);
            EXPECT_TRUE(finite_and_positive(to.weight));
            if (to.specular) {
                EXPECT_EQ(to.density, 0);
                continue;
            }
            EXPECT_FALSE(scattering.only_specular());
            EXPECT_EQ(to.density, scattering.density(i));
            const Vec3f value = scattering.value(i), of_weight = to.weight * to.density;
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], of_weight[c], 1e-5f * value[c]);
        }
        EXPECT_GT(found, 250);
    }
}

/// The integral of the values is the mean of the weights, by a quadrature that knows no samples.
TEST_P(Surfaces, ValuesIntegrateToTheAlbedo) {
    const Surface& s = GetParam();
    const Vec3f o = direction(0.6);
    const Scattering scattering = s.at(o);
    double sum = 0, weights = 0;
    const auto both = charts(s, o);
    constexpr int n = 200;
    for (std::size_t side = 0; side < 2; ++side)
        for (int k = 0; k < n * n; ++k) {
            const int down = k / n, across = k % n;
            const double t = (down + 0.5) / n;
            const Vec3f i = both[side].at(t, (across + 0.5) / n);
            if ((i[2] > 0) == (side == 0))
                sum += static_cast<double>(scattering.value(i)[1]) * both[side].area(t) / (n * n);
        }
    constexpr int samples = 8000;
    for (int k = 0; k < samples; ++k) {
        const auto [choice, u, v] = even_point(k);
        const auto to = scattering.sample(choice, u, v);
        if (to && !to.specular) weights += static_cast<double>(to.weight[1]) / samples;
    }
    EXPECT_NEAR(sum, weights, 0.01 * sum + 0.002);
}

/// f(o → i)/η_o² = f(i → o)/η_i² (Veach 1997), which is the plain reciprocity of reflections.
TEST_P(Surfaces, AreReciprocal) {
    const Surface& s = GetParam();
    std::mt19937 generator(3);
    const auto number = [&] { return static_cast<double>(generator() >> 8) * 0x1p-24; };
    int compared = 0;
    for (int k = 0; k < 2000; ++k) {
        const Vec3f o = direction(0.02 + 0.98 * number(), number());
        // Half of the directions are sampled, so that those of sharp lobes are met.
        Vec3f i = direction(2 * number() - 1, number());
        const Scattering there = s.at(o);
        const auto [choice, u, v] = even_point(k);
        if (const auto to = there.sample(choice, u, v); to && k % 2 == 0) i = to.direction;
        if (std::abs(i[2]) < 0.02f) continue;
        const bool through = i[2] < 0;
        const Scattering back = s.at({i[0], i[1], std::abs(i[2])}, s.inside != through);
        const Vec3f from = through ? Vec3f(o[0], o[1], -o[2]) : o;
        const Vec3f forth = there.value(i) / std::abs(i[2]) * (through ? s.eta() * s.eta() : 1.0f),
                    again = back.value(from) / o[2];
        // Half vectors of sharp lobes are differences of directions, which err by 6·10⁻⁸.
        // The reflectance of glass bends without limit at the critical angle.
        const float alpha = std::max(s.material.roughness * s.material.roughness, 1e-3f),
                    slack = (through && s.eta() != 1 ? 3e-3f : 1e-4f) + 3e-6f / alpha;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(forth[c], again[c], slack * forth[c] + 1e-5f) << o[2] << ' ' << i[2];
        compared += forth[1] > 0;
    }
    EXPECT_TRUE(compared > 100 || s.at(direction(0.5)).only_specular());
}

TEST_P(Surfaces, ExtremeDirectionsGiveFiniteNumbers) {
    const Surface& s = GetParam();
    for (const float height : {1.0f, 1e-3f, 1e-6f, 1e-12f, 1e-18f, 1e-25f, 1e-44f, 0.0f, -1e-9f, -0.5f}) {
        const Vec3f o(std::sqrt(1 - height * height), 0, height);
        const Scattering scattering = s.at(o);
        for (const float turn : {0.0f, 0.3f, 0.5f})
            for (const float z :
                 {1.0f, 0.3f, 1e-6f, 1e-20f, 1e-44f, 0.0f, -1e-44f, -1e-20f, -1e-6f, -0.3f, -1.0f}) {
                Vec3f i = direction(static_cast<double>(z), static_cast<double>(turn));
                i[2] = z;
                EXPECT_TRUE(finite_and_positive(scattering.value(i))) << height << ' ' << z;
                EXPECT_TRUE(scattering.density(i) >= 0 && std::isfinite(scattering.density(i)));
                EXPECT_TRUE(height > 0 || scattering.value(i) == Vec3f());
            }
        for (const float x : {0.0f, 0.5f, 0x1.fffffep-1f})
            for (const float y : {0.0f, 0.5f, 0x1.fffffep-1f})
                for (const float choice : {0.0f, 0.5f, 0x1.fffffep-1f}) {
                    const auto to = scattering.sample(choice, x, y);
                    EXPECT_FALSE(to && height <= 0);
                    EXPECT_TRUE(!to || (finite_and_positive(to.weight) && finite(to.direction)));
                }
    }
}

INSTANTIATE_TEST_SUITE_P(All, Surfaces, testing::ValuesIn(surfaces()), [](const auto& at) {
    std::string name;
    for (const char c : at.param.name) {
        if (std::isalnum(static_cast<unsigned char>(c))) name += c;
    }
    return name;
});

TEST(Scattering, IsFiniteForAnyMaterial) {
    const auto wild = [] {
        return rc::gen::map(
            rc::gen::pair(rc::gen::inRange(0, 12), rc::gen::inRange(0, 1 << 24)), [](const auto& p) {
                constexpr float special[] = {0,
                                             1,
                                             -1,
                                             1e-30f,
                                             1e30f,
                                             std::numeric_limits<float>::quiet_NaN(),
                                             std::numeric_limits<float>::infinity()};
                return p.first < 7 ? special[p.first]
                                   : static_cast<float>(p.second) * 0x1p-24f * (p.first == 11 ? 3 : 1);
            });
    };
    EXPECT_TRUE(rc::check([&] {
        SurfaceMaterial m;
        const auto colour = [&] { return Vec3f(*wild(), *wild(), *wild()); };
        m.base_colour = colour(), m.specular_colour = colour();
        m.metallic = *wild(), m.roughness = *wild(), m.ior = *wild(), m.specular = *wild();
        m.transmission = *wild(), m.thin = *rc::gen::arbitrary<bool>();
        const auto share = [] { return static_cast<float>(*rc::gen::inRange(0, 1 << 24)) * 0x1p-24f; };
        const Vec3f o = sphere_direction(share(), share());
        const Scattering s(m, o, *rc::gen::arbitrary<bool>(),
                           *rc::gen::arbitrary<bool>() ? &tables() : nullptr);
        for (int k = 0; k < 8; ++k) {
            const Vec3f i = sphere_direction(share(), share());
            RC_ASSERT(finite_and_positive(s.value(i)));
            RC_ASSERT(s.density(i) >= 0 && std::isfinite(s.density(i)));
            const auto to = s.sample(share(), share(), share());
            RC_ASSERT(!to || (finite_and_positive(to.weight) && std::abs(length(to.direction) - 1) < 1e-4f));
            RC_ASSERT(o[2] > 0 || !to);
        }
    }));
}

/// The bits of values, densities, samples and tables, as a number. A processor, compiler or option that
/// changes one bit of a picture changes it. Directions come from functions that use no C library.
TEST(Scattering, HasTheSameBitsEverywhere) {
    std::uint64_t bits = 14695981039346656037u;  // FNV-1a
    const auto add = [&](float x) { bits = (bits ^ std::bit_cast<std::uint32_t>(x)) * 1099511628211u; };
    const auto add_all = [&](const Vec3f& v) { add(v[0]), add(v[1]), add(v[2]); };
    for (const Surface& s : surfaces())
        for (int k = 0; k < 50; ++k) {
            const auto [choice, u, v] = even_point(k);
            const Scattering scattering = s.at(cosine_direction(v, choice));
            const Vec3f i = sphere_direction(u, choice);
            add_all(scattering.value(i));
            add(scattering.density(i));
            if (const auto to = scattering.sample(choice, u, v)) add_all(to.direction), add_all(to.weight);
        }
    for (int k = 0; k < 200; ++k) {
        const auto [r, c, e] = even_point(k);
        add(tables().ggx(r, c).white), add(tables().ggx(r, c).grazing),
            add(tables().glass(r, c, 0.4f + 2 * e));
    }
    EXPECT_EQ(bits, 5018749561162518842u);
}

}  // namespace
}  // namespace hedgerow
