/// Sums in fixed point: the same bits in every order and however the terms are divided, and as near as can
/// be.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include <hedgerow/geometry/fixed_point.h>

using namespace hedgerow;

namespace {

FixedPoint point_of(const std::vector<double>& terms) {
    double largest = 0;
    for (const double x : terms) largest = FixedPoint::larger(largest, x);
    return FixedPoint(largest);
}
double sum_of(const std::vector<double>& terms) {
    const FixedPoint point = point_of(terms);
    FixedPoint::Sum sum;
    for (const double x : terms) sum += point.integer(x);
    return point.value(sum);
}
/// Sums whose long double hardly errs, of sizes over twelve decades, of one sign or of both.
std::vector<double> uneven(std::size_t count, bool cancel, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<double> terms(count);
    for (double& x : terms) {
        x = std::pow(10, -12 * unit(random));
        if (cancel && unit(random) < 0.5) x = -x;
    }
    return terms;
}

TEST(FixedPoint, SumsHaveTheSameBitsHoweverTheyAreDivided) {
    std::mt19937_64 random(1);
    for (const bool cancel : {false, true}) {
        std::vector<double> terms = uneven(10000, cancel, 2);
        const double want = sum_of(terms);
        const FixedPoint point = point_of(terms);
        for (int times = 0; times < 20; ++times) {
            std::shuffle(terms.begin(), terms.end(), random);
            // Up to seven shares, each summed alone and joined from the last to the first.
            std::vector<FixedPoint::Sum> shares(1 + random() % 7);
            for (const double x : terms) shares[random() % shares.size()] += point.integer(x);
            FixedPoint::Sum sum;
            for (auto share = shares.rbegin(); share != shares.rend(); ++share) sum += *share;
            EXPECT_EQ(point.value(sum), want);
        }
    }
}
TEST(FixedPoint, SumsErrLessThanThoseOfALoop) {
    for (const bool cancel : {false, true}) {
        long double of_fixed = 0, of_loop = 0;
        for (std::uint64_t seed = 0; seed < 50; ++seed) {
            const auto terms = uneven(10000, cancel, seed);
            const long double want = std::accumulate(terms.begin(), terms.end(), 0.0L);
            const double loop = std::accumulate(terms.begin(), terms.end(), 0.0), fixed = sum_of(terms);
            // Rounded once: within half a unit in the last place.
            EXPECT_LE(std::abs(fixed - want), 0x1p-53L * (1 + 0x1p-9L) * std::abs(want));
            of_fixed += std::abs(fixed - want), of_loop += std::abs(loop - want);
        }
        EXPECT_LT(4 * of_fixed, of_loop);
    }
}
TEST(FixedPoint, OfAnySize) {
    const double tiny = std::numeric_limits<double>::denorm_min(), huge = std::numeric_limits<double>::max();
    EXPECT_EQ(sum_of({}), 0);
    EXPECT_EQ(sum_of({0, -0.0}), 0);
    EXPECT_EQ(sum_of({huge, -huge, 0x1p970}), 0x1p970);
    EXPECT_EQ(sum_of({huge, huge}), std::numeric_limits<double>::infinity());
    EXPECT_EQ(sum_of({0x1p-1000, 0x1p-1020, -0x1p-1000}), 0x1p-1020);
    EXPECT_EQ(sum_of({tiny, tiny}), 0);  // below the least unit
    EXPECT_EQ(sum_of({1, -0x1p-68}), 1);
    EXPECT_EQ(sum_of({1, -0x1p-68, -1}), -0x1p-68);
    EXPECT_EQ(sum_of({-1, -1, -0.5}), -2.5);
    // As many terms as there is room for, by doubling.
    const FixedPoint point(1);
    FixedPoint::Sum sum = point.integer(1);
    for (int k = 0; k < 39; ++k) sum += sum;
    EXPECT_EQ(point.value(sum), 0x1p39);
}
TEST(FixedPoint, OfWhatIsNotFiniteIsNoNumber) {
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(std::isnan(sum_of({1, std::nan(""), 2})));
    EXPECT_TRUE(std::isnan(sum_of({1, infinity, 2})));
    EXPECT_TRUE(std::isnan(sum_of({-infinity})));
}

}  // namespace
