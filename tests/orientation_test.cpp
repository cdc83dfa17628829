// The signs of orientations against exact sums, where rounding leaves them in doubt and where it does not.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <hedgerow/geometry/orientation.h>

namespace hedgerow {
namespace {

// Points of a small lattice, of which many are collinear and coplanar, some of them moved by one unit in the
// last place, at a scale and an offset.
class NearlyDegenerate {
public:
    NearlyDegenerate(double scale, double offset) : scale_(scale), offset_(offset) {}

    Vec3d operator()() {
        Vec3d p;
        for (int k = 0; k < 3; ++k) {
            p[k] = scale_ * (offset_ + static_cast<double>(at_(random_)));
            if (moved_(random_) == 0) p[k] = std::nextafter(p[k], p[k] > 0 ? 0.0 : 1.0);
        }
        return p;
    }

private:
    double scale_, offset_;
    std::mt19937 random_{7};
    std::uniform_int_distribution<int> at_{-2, 2}, moved_{0, 5};
};

void expect_exact(NearlyDegenerate next) {
    int zeros = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3d a = next(), b = next(), c = next(), x = next();
        const int s = side(a, b, c, x);
        ASSERT_EQ(s, exact_side(a, b, c, x));
        ASSERT_EQ(s, -side(b, a, c, x));
        ASSERT_EQ(s, side(b, c, a, x));
        zeros += s == 0;
        for (int u = 0; u < 3; ++u) {
            const int v = (u + 1) % 3;
            const int t = turn(a, b, c, u, v);
            ASSERT_EQ(t, exact_turn(a, b, c, u, v));
            ASSERT_EQ(t, -turn(b, a, c, u, v));
            ASSERT_EQ(t, turn(b, c, a, u, v));
        }
    }
    EXPECT_GT(zeros, 100);  // the points are as degenerate as they are meant to be
}

TEST(Orientation, IsExactWhereRoundingIsNot) {
    expect_exact({1, 0});
    expect_exact({0.1, 1000003});
}
TEST(Orientation, IsExactAtEveryScale) {
    expect_exact({0x1p478, 0});  // products overflow
    expect_exact({0x1p-480, 0});
    expect_exact({0x1p-1060, 0});  // products and differences underflow
}

}  // namespace
}  // namespace hedgerow
