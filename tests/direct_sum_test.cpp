/// Direct sums by every instruction set against sums in long double, within their stated bounds.
#include <gtest/gtest.h>

#include <hedgerow/base/error.h>
#include <hedgerow/nbody/direct_sum.h>
#include <hedgerow/scenes/random.h>
#include <hedgerow/scenes/sets.h>

#include "using.h"

using namespace hedgerow;

namespace {

template <class T>
class DirectSums : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(DirectSums, Scalars);

template <class T>
struct Scene {
    std::vector<Vec<T, 3>> places;
    std::vector<T> charges;

    explicit Scene(std::size_t count, bool neutral = false) : places(points<T>(count).points) {
        for (std::uint64_t i = 0; i < count; ++i)
            charges.push_back(
                static_cast<T>((neutral && i % 2 == 1 ? -1 : 1) * (0.1 + Random(8, i).uniform())));
    }
    Charges<T> view() const { return {places, charges}; }
};
template <class T>
std::vector<PotentialAt<T>> sums_of(const Scene<T>& scene, const std::vector<Vec<T, 3>>& targets,
                                    Threads threads = {}) {
    std::vector<PotentialAt<T>> found(targets.size());
    direct_sum<T>(scene.view(), targets, found, {.threads = threads});
    return found;
}

/// Compares with sums in long double. A term may err by a share of itself, and sums of them by roundings.
template <class T>
void expect_right(const Scene<T>& scene, const std::vector<Vec<T, 3>>& targets,
                  const std::vector<PotentialAt<T>>& found) {
    using Real = long double;
    const Real share = std::is_same_v<T, float> ? 0x1p-21L + 32 * 0x1p-24L : 0x1p-42L + 32 * 0x1p-53L;
    for (std::size_t i = 0; i < targets.size(); ++i) {
        Real potential = 0, size = 0, gradient[3] = {}, sizes = 0;
        for (std::size_t j = 0; j < scene.places.size(); ++j) {
            Real d[3], d2 = 0;
            for (int k = 0; k < 3; ++k) {
                d[k] = Real(scene.places[j][k]) - Real(targets[i][k]);
                d2 += d[k] * d[k];
            }
            if (d2 == 0) continue;
            const Real one = Real(scene.charges[j]) / std::sqrt(d2);
            potential += one, size += std::abs(one), sizes += std::abs(one) / std::sqrt(d2);
            for (int k = 0; k < 3; ++k) gradient[k] += one / d2 * d[k];
        }
        ASSERT_LE(std::abs(Real(found[i].potential) - potential), share * size) << i;
        for (int k = 0; k < 3; ++k)
            ASSERT_LE(std::abs(Real(found[i].gradient[k]) - gradient[k]), 3 * share * sizes) << i;
    }
}

TYPED_TEST(DirectSums, AreRightForEveryInstructionSet) {
    for (const auto set : instruction_sets()) {
        SCOPED_TRACE(set);
        const Using use(set);
        for (const bool neutral : {false, true}) {
            const Scene<TypeParam> scene(3000, neutral);
            const std::vector some(scene.places.begin(), scene.places.begin() + 101);
            expect_right(scene, some, sums_of(scene, some));
        }
    }
}
/// Any number of sources and targets, in whatever part of a vector they end.
TYPED_TEST(DirectSums, OfAnyNumber) {
    for (const auto set : instruction_sets()) {
        SCOPED_TRACE(set);
        const Using use(set);
        for (std::size_t n = 0; n < 40; ++n) {
            const Scene<TypeParam> scene(n);
            expect_right(scene, scene.places, sums_of(scene, scene.places));
            expect_right(scene, {{3, 4, 5}}, sums_of(scene, {{3, 4, 5}}));
        }
    }
}
TYPED_TEST(DirectSums, OfHugeAndTinyCoordinatesAndCharges) {
    using T = TypeParam;
    constexpr int most = std::is_same_v<T, float> ? 18 : 300;
    for (const auto set : instruction_sets()) {
        SCOPED_TRACE(set);
        const Using use(set);
        for (const int exponent : {most, -most}) {
            Scene<T> scene(200);
            for (auto& p : scene.places) p = p * std::ldexp(T(1), exponent);
            for (std::size_t i = 0; i < 200; i += 3) scene.charges[i] *= T(1e12);
            for (auto& q : scene.charges) q = std::ldexp(q, exponent);
            expect_right(scene, scene.places, sums_of(scene, scene.places));
        }
    }
}
TYPED_TEST(DirectSums, PointsInOnePlaceDoNothingToEachOther) {
    using T = TypeParam;
    for (const auto set : instruction_sets()) {
        SCOPED_TRACE(set);
        const Using use(set);
        Scene<T> scene(0);
        scene.places.assign(20, {T(0.1), T(0.2), T(0.3)});
        scene.charges.assign(20, T(1));
        for (const auto& found : sums_of(scene, scene.places)) {
            EXPECT_EQ(found.potential, 0);
            EXPECT_EQ(found.gradient, (Vec<T, 3>()));
        }
        scene.places.assign(20, {});
        EXPECT_EQ(sums_of(scene, scene.places)[0].potential, 0);
        scene.places[7] = {0, 0, 2};
        // Within the bound of a pair: processors' estimates of roots differ.
        EXPECT_NEAR(static_cast<double>(sums_of(scene, scene.places)[7].potential), 9.5, 9.5 * 0x1p-21);
        EXPECT_NEAR(static_cast<double>(sums_of(scene, scene.places)[7].gradient[2]), -4.75, 1e-5);
    }
}
TYPED_TEST(DirectSums, AreTheSameForAnyNumberOfThreads) {
    const Scene<TypeParam> scene(2000);
    const auto serial = sums_of(scene, scene.places, serial_executor()),
               parallel = sums_of(scene, scene.places, default_executor());
    for (std::size_t i = 0; i < serial.size(); ++i) {
        ASSERT_EQ(serial[i].potential, parallel[i].potential);
        ASSERT_EQ(serial[i].gradient, parallel[i].gradient);
    }
}
TYPED_TEST(DirectSums, RefuseBadInput) {
    using T = TypeParam;
    const auto said = [](const Scene<T>& scene, std::size_t room) -> std::string {
        std::vector<PotentialAt<T>> found(room);
        try {
            direct_sum<T>(scene.view(), scene.places, found);
        } catch (const InputError& e) {
            return e.what();
        }
        return "";
    };
    Scene<T> scene(20);
    EXPECT_EQ(said(scene, 20), "");
    EXPECT_NE(said(scene, 19).find("room for 19"), std::string::npos);
    scene.places[13][1] = std::numeric_limits<T>::quiet_NaN();
    EXPECT_NE(said(scene, 20).find("source 13 is nan"), std::string::npos) << said(scene, 20);
    scene = Scene<T>(20);
    scene.charges[7] = std::numeric_limits<T>::infinity();
    EXPECT_NE(said(scene, 20).find("charge of source 7 is inf"), std::string::npos) << said(scene, 20);
    scene = Scene<T>(20);
    scene.charges.pop_back();
    EXPECT_NE(said(scene, 20).find("19 charges for 20 places"), std::string::npos);
}

}  // namespace
