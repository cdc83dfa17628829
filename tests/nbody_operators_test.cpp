/// The operators of the fast multipole method, each alone: shifts are exact, conversions converge at their
/// order, gradients are those of differences, and two cells push each other alike.
#include <gtest/gtest.h>

#include <hedgerow/nbody/operators.h>
#include <hedgerow/nbody/swap_matrices.h>
#include <hedgerow/scenes/random.h>

using namespace hedgerow;

namespace {

struct Charges {
    std::vector<Vec3d> places;
    std::vector<double> charges;

    /// In a ball around `center`, of both signs if they are `neutral`.
    Charges(const Vec3d& center, double radius, std::size_t count, std::uint64_t seed, bool neutral = false) {
        Random random(60, seed);
        for (std::size_t i = 0; i < count; ++i) {
            places.push_back(center + Vec3d(random.direction<3>()) * (radius * random.uniform()));
            charges.push_back(neutral && i % 2 == 1 ? -random.uniform() : random.uniform());
        }
    }
    PotentialAt<double> at(const Vec3d& p) const {
        PotentialAt<double> sum;
        for (std::size_t i = 0; i < places.size(); ++i) {
            const auto one = p2p(charges[i], p - places[i]);
            sum.potential += one.potential, sum.gradient = sum.gradient + one.gradient;
        }
        return sum;
    }
    template <int p>
    Harmonics<double, p> multipole(const Vec3d& center) const {
        Harmonics<double, p> m;
        for (std::size_t i = 0; i < places.size(); ++i) p2m(charges[i], places[i] - center, m);
        return m;
    }
};

template <int order>
void expect_near(const Harmonics<double, order>& a, const Harmonics<double, order>& b, double error) {
    for (int n = 0; n <= order; ++n)
        for (int m = 0; m <= n; ++m) {
            EXPECT_NEAR(a.re[a.at(n, m)], b.re[a.at(n, m)], error) << n << ' ' << m;
            EXPECT_NEAR(a.im[a.at(n, m)], b.im[a.at(n, m)], error) << n << ' ' << m;
        }
}

TEST(Harmonics, ExpandTheInverseDistance) {
    const Vec3d x(0.9, -1.1, 0.7), y(0.2, 0.1, -0.25);
    const auto r = regular_harmonics<30>(y);
    const auto s = singular_harmonics<30>(x);
    double sum = 0;
    for (int n = 0; n <= 30; ++n)
        for (int m = -n; m <= n; ++m) sum += (conj(harmonic(r, n, m)) * harmonic(s, n, m)).re;
    EXPECT_NEAR(sum, 1 / length(x - y), 1e-14);
    // Of order 1 they are known: r e^(iφ) sin θ / 2, and e^(iφ) sin θ / r².
    EXPECT_EQ(r.re[r.at(1, 1)], 0.1);
    EXPECT_EQ(r.im[r.at(1, 1)], 0.05);
    EXPECT_NEAR(s.re[s.at(1, 1)], 0.9 / std::pow(length(x), 3), 1e-15);
    EXPECT_NEAR(s.re[s.at(1, 0)], 0.7 / std::pow(length(x), 3), 1e-15);
}
/// On the z axis only m = 0 is left; at the center only degree 0.
TEST(Harmonics, OnTheAxisAndAtTheCenter) {
    const auto r = regular_harmonics<4>(Vec3d(0, 0, 2));
    double factorial = 1;
    for (int n = 0; n <= 4; factorial *= ++n)
        for (int m = 0; m <= n; ++m)
            EXPECT_NEAR(r.re[r.at(n, m)], m == 0 ? std::pow(2, n) / factorial : 0, 1e-15);
    const auto none = regular_harmonics<4>(Vec3d());
    EXPECT_EQ(none.re[0], 1);
    for (std::size_t i = 1; i < none.count; ++i) EXPECT_EQ(none.re[i], 0);
}

/// Swapping the axes x and z multiplies the harmonics of each degree by a matrix.
TEST(Harmonics, AreSwappedByMatrices) {
    static constexpr SwapMatrices<9> swaps;
    const auto r = regular_harmonics<9>(Vec3d(0.3, -0.7, 0.4)),
               want = regular_harmonics<9>(Vec3d(0.4, -0.7, 0.3));
    for (int n = 0; n <= 9; ++n)
        for (int m = 0; m <= n; ++m) {
            Complex<double> sum{0, 0}, folded{0, 0};
            for (int l = -n; l <= n; ++l) sum = sum + swaps(n, m, l) * harmonic(r, n, l);
            for (int l = 0; l <= n; ++l)
                folded = folded + Complex<double>{swaps.multipole(n, m, l, true) * harmonic(r, n, l).re,
                                                  swaps.multipole(n, m, l, false) * harmonic(r, n, l).im};
            for (const auto& found : {sum, folded}) {
                EXPECT_NEAR(found.re, want.re[want.at(n, m)], 1e-15);
                EXPECT_NEAR(found.im, want.im[want.at(n, m)], 1e-15);
            }
            // Twice is not at all, for local expansions as well.
            for (int l = 0; l <= n; ++l)
                for (const bool real : {false, true}) {
                    double twice[2] = {};
                    for (int k = 0; k <= n; ++k) {
                        twice[0] += swaps.multipole(n, m, k, real) * swaps.multipole(n, k, l, real);
                        twice[1] += swaps.local(n, m, k, real) * swaps.local(n, k, l, real);
                    }
                    const bool same = m == l && (real || m > 0);
                    EXPECT_NEAR(twice[0], same ? 1 : 0, 1e-12);
                    EXPECT_NEAR(twice[1], same ? 1 : 0, 1e-12);
                }
        }
}

TEST(Operators, ShiftsOfMultipolesAreExact) {
    const Charges all({0.3, -0.2, 0.1}, 0.5, 20, 1, true);
    const Vec3d part(0.35, -0.1, 0.2), whole(-0.4, 0.1, 0.6);
    Harmonics<double, 9> shifted;
    m2m(all.multipole<9>(part), part - whole, shifted);
    expect_near(shifted, all.multipole<9>(whole), 1e-14);
}
TEST(Operators, ShiftsOfLocalExpansionsAreExact) {
    const Charges far({5, 4, -3}, 1, 20, 2);
    const Vec3d whole(0.1, 0.2, 0.3), part(0.3, 0.1, 0.2), at(0.35, 0.15, 0.1);
    Harmonics<double, 8> local, shifted;
    m2l(far.multipole<12>({5, 4, -3}), whole - Vec3d(5, 4, -3), local);
    l2l(local, part - whole, shifted);
    const auto a = l2p(local, at - whole), b = l2p(shifted, at - part);
    EXPECT_NEAR(a.potential, b.potential, 1e-14);
    EXPECT_NEAR(length(a.gradient - b.gradient), 0, 1e-13);
}
TEST(Operators, GradientsAreThoseOfDifferences) {
    const Charges far({3, -2, 2}, 0.7, 20, 3, true);
    Harmonics<double, 7> local;
    m2l(far.multipole<7>({3, -2, 2}), Vec3d(-3, 2, -2), local);
    const Vec3d at(0.2, -0.3, 0.4);
    const double h = 1e-5;
    for (int k = 0; k < 3; ++k) {
        Vec3d step;
        step[k] = h;
        const double difference =
            (l2p(local, at + step).potential - l2p(local, at - step).potential) / (2 * h);
        EXPECT_NEAR(l2p(local, at).gradient[k], difference, 1e-9);
    }
}
TEST(Operators, MultipolesGiveFarPotentials) {
    const Charges all({0, 0, 0}, 1, 30, 4, true);
    const Vec3d at(40, -30, 20);
    const auto want = all.at(at), got = m2p(all.multipole<6>({}), at);
    EXPECT_NEAR(got.potential, want.potential, 1e-10 * std::abs(want.potential) + 1e-12);
    EXPECT_NEAR(length(got.gradient - want.gradient), 0, 1e-12);
}

/// The error of the acceleration that one conversion makes, relative to the acceleration.
template <int p>
double error_of_conversion(double opening) {
    double error2 = 0, size2 = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        Random random(61, seed);
        const Vec3d away = Vec3d(random.direction<3>()) * (2 / opening);
        const Charges sources({}, 1, 30, 100 + seed), targets(away, 1, 30, 200 + seed);
        Harmonics<double, p + 1> local;
        m2l(sources.multipole<p>({}), away, local);
        for (const auto& x : targets.places) {
            const auto want = sources.at(x).gradient;
            error2 += length2(l2p(local, x - away).gradient - want), size2 += length2(want);
        }
    }
    return std::sqrt(error2 / size2);
}
TEST(Operators, ConversionsConvergeAtTheirOrder) {
    const double errors[] = {error_of_conversion<2>(0.6), error_of_conversion<4>(0.6),
                             error_of_conversion<6>(0.6), error_of_conversion<8>(0.6),
                             error_of_conversion<10>(0.6)};
    for (std::size_t i = 0; i + 1 < std::size(errors); ++i) EXPECT_LT(errors[i + 1], 0.25 * errors[i]) << i;
    EXPECT_LT(errors[1], 5e-3);
    EXPECT_LT(errors[4], 2e-5);
    // Half as far apart for their size: an order more for each degree.
    EXPECT_LT(error_of_conversion<6>(0.3), 0x1p-6 * error_of_conversion<6>(0.6));
}
/// What two cells do to each other adds up to nothing, though both expansions are cut off.
TEST(Operators, CellsPushEachOtherAlike) {
    const Vec3d center(2.5, 1, -1.5);
    const Charges a({}, 1, 20, 5), b(center, 1, 20, 6);
    const auto of_a = a.multipole<3>({}), of_b = b.multipole<3>(center);
    Harmonics<double, 4> at_a, at_b;
    m2l(of_b, Vec3d() - center, at_a);
    m2l(of_a, center, at_b);
    Vec3d sum, all;
    for (std::size_t i = 0; i < 20; ++i) {
        sum = sum + l2p(at_a, a.places[i]).gradient * a.charges[i];
        all = all + l2p(at_a, a.places[i]).gradient * a.charges[i];
        sum = sum + l2p(at_b, b.places[i] - center).gradient * b.charges[i];
    }
    EXPECT_GT(length(all), 1);
    EXPECT_LT(length(sum), 1e-14 * length(all));
}

}  // namespace
