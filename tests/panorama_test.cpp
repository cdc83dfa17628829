/// The places of directions in panoramas: against long double, and to the last bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <hedgerow/render/lighting/panorama.h>
#include <hedgerow/scenes/random.h>

using namespace hedgerow;

namespace {

constexpr double error_across = 1.21e-8, error_down = 2.42e-8;

struct Place {
    long double across, down;
};
/// The place by the C library in long double.
Place exact_place(const Vec3d& direction) {
    constexpr long double half_turn = std::numbers::pi_v<long double>;
    const long double x = direction[0], y = direction[1], z = direction[2];
    return {0.5L + std::atan2(x, -z) / (2 * half_turn), std::atan2(std::hypot(x, z), y) / half_turn};
}
/// How far two shares of the width are apart; the right edge is the left one.
long double apart(long double a, long double b) {
    const long double d = std::abs(a - b);
    return std::min(d, 1 - d);
}

/// Directions of all sizes, many of them near the axes, the planes between them and the diagonals.
std::vector<Vec3d> directions() {
    std::vector<Vec3d> all(20000);
    Random random(1);
    for (Vec3d& d : all) d = random.direction<3>();
    const float denormal = std::numeric_limits<float>::denorm_min(), inf = INFINITY;
    const float values[] = {0,
                            denormal,
                            -denormal,
                            1e-30f,
                            -1e-30f,
                            1e-7f,
                            -1e-7f,
                            1e-3f,
                            0.5f,
                            -0.5f,
                            1,
                            -1,
                            0x1.fffffep-1f,
                            -0x1.fffffep-1f,
                            std::nextafter(1.0f, inf)};
    for (const float x : values)
        for (const float y : values)
            for (const float z : values) all.push_back(Vec3d(Vec3f(x, y, z)));
    for (std::size_t i = 0, n = all.size(); i < n; i += 5) all.push_back(all[i] * 1e30);
    return all;
}

TEST(Panorama, PlacesAreThoseOfAngles) {
    for (const Vec3d& d : directions()) {
        const PanoramaPlace place = panorama_place(d);
        ASSERT_TRUE(place.across >= 0 && place.across < 1 && place.down >= 0 && place.down < 1);
        if (d == Vec3d()) continue;
        const Place exact = exact_place(d);
        ASSERT_NEAR(double(exact.down), place.down, error_down) << d[0] << " " << d[1] << " " << d[2];
        if (d[0] == 0 && d[2] == 0) continue;
        ASSERT_LT(apart(exact.across, place.across), error_across) << d[0] << " " << d[1] << " " << d[2];
    }
}

TEST(Panorama, TexelsAreThoseOfAngles) {
    for (const auto& [columns, rows] :
         {std::pair(1, 1), {2, 1}, {3, 2}, {7, 64}, {4096, 2048}, {100000, 3}}) {
        int sure = 0;
        for (const Vec3d& d : directions()) {
            const PanoramaPlace place = panorama_place(d);
            const int column = place.column(columns), row = place.row(rows);
            ASSERT_TRUE(column >= 0 && column < columns && row >= 0 && row < rows);
            // Away from edges the texel is sure.
            const Place exact = exact_place(d);
            const long double x = exact.across * columns, y = exact.down * rows;
            if (std::abs(x - std::round(x)) > error_across * columns) {
                ASSERT_EQ(column, int(x)) << columns << ": " << d[0] << " " << d[1] << " " << d[2];
                ++sure;
            }
            if (std::abs(y - std::round(y)) > error_down * rows) {
                ASSERT_EQ(row, int(y)) << rows << ": " << d[0] << " " << d[1] << " " << d[2];
                ++sure;
            }
        }
        EXPECT_GT(sure, 40000);
    }
}

TEST(Panorama, AxesLieWhereTheConventionSays) {
    const auto expect = [](const Vec3d& d, double across, double down) {
        const PanoramaPlace place = panorama_place(d);
        EXPECT_LT(apart(across, place.across), error_across) << d[0] << " " << d[1] << " " << d[2];
        EXPECT_NEAR(place.down, down, error_down) << d[0] << " " << d[1] << " " << d[2];
    };
    expect({0, 0, -1}, 0.5, 0.5), expect({-0.0, 0, -1}, 0.5, 0.5);
    expect({1, 0, 0}, 0.75, 0.5), expect({1, 0, -0.0}, 0.75, 0.5);
    expect({-1, 0, 0}, 0.25, 0.5), expect({0, 0, 1}, 0, 0.5), expect({-0.0, 0, 1}, 0, 0.5);
    EXPECT_LT(panorama_place({0, 1, 0}).down, error_down);
    EXPECT_GT(panorama_place({0, -1, 0}).down, 1 - error_down);
    // The equator and the middle are exact, and so is the seam.
    EXPECT_EQ(panorama_place({0.3, 0, 0.4}).down, 0.5);
    EXPECT_EQ(panorama_place({0, 0.1, -1}).across, 0.5);
    EXPECT_EQ(panorama_place({-0.0, 0.1, 1}).across, 0);
    EXPECT_EQ(panorama_place({0, 0.1, 1}).across, below_one);
}

TEST(Panorama, WhatIsNoDirectionHasAPlace) {
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 infinity = std::numeric_limits<double>::infinity();
    const double values[] = {0, 1, -1, nan, infinity, -infinity, 1e300, 1e-300, 5e-324};
    for (const double x : values)
        for (const double y : values)
            for (const double z : values) {
                const PanoramaPlace place = panorama_place({x, y, z});
                ASSERT_TRUE(place.across >= 0 && place.across < 1) << x << " " << y << " " << z;
                ASSERT_TRUE(place.down >= 0 && place.down < 1) << x << " " << y << " " << z;
            }
}

TEST(Panorama, PlacesHaveTheseBits) {
    const PanoramaPlace a = panorama_place({0.6, 0.48, -0.64}), b = panorama_place({-1, -20, 0.3});
    EXPECT_EQ(a.across, 0x1.3d5f4def0fb8dp-1);
    EXPECT_EQ(a.down, 0x1.5ccfd96695c1ap-2);
    EXPECT_EQ(b.across, 0x1.a0fff50a53bbcp-3);
    EXPECT_EQ(b.down, 0x1.f7800be2e5058p-1);
}

}  // namespace
