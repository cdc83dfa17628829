/// Pairs of triangles against rational arithmetic: whether they meet, and whether neighbours meet beyond what
/// they share.
#include <gtest/gtest.h>

#include <hedgerow/geometry/meet_beyond_shared.h>

#include "exact.h"
#include "nasty.h"
#include "rational_triangles.h"

namespace {

using namespace hedgerow;

template <class T>
class TrianglesMeet : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(TrianglesMeet, Scalars);

template <class T>
Triangle<double, 3> in_double(const Triangle<T, 3>& t) {
    return {Vec3d(t.a), Vec3d(t.b), Vec3d(t.c)};
}
/// What pairs turned out to be, so that a test sees that it tests something.
struct Tally {
    int meet = 0, apart = 0, beyond = 0, shared_only = 0;
};

template <class T>
void expect_exact(const Triangle<T, 3>& s, const Triangle<T, 3>& t, Tally& tally) {
    const bool meet = rational::meet(s, t), beyond = rational::meet_beyond_shared(s, t);
    const auto p = in_double(s), q = in_double(t);
    const auto print = [&] {
        std::string text;
        for (const auto& v : {p.a, p.b, p.c, q.a, q.b, q.c})
            for (int k = 0; k < 3; ++k) text += testing::PrintToString(v[k]) + (k < 2 ? "," : "  ");
        return text;
    };
    ASSERT_EQ(triangles_meet(p, q), meet) << print();
    ASSERT_EQ(triangles_meet(q, p), meet) << print();
    ASSERT_EQ(meet_beyond_shared(p, q), beyond) << print();
    ASSERT_EQ(meet_beyond_shared({q.b, q.a, q.c}, {p.c, p.a, p.b}), beyond) << print();
    ++(meet ? tally.meet : tally.apart);
    if (meet) ++(beyond ? tally.beyond : tally.shared_only);
}

/// Compares `count` pairs whose corners are drawn by `next`. Pairs share no corner on purpose, one, two or
/// three, and some triangles have corners twice.
template <class T, class Next>
Tally expect_exact_pairs(int count, Next next) {
    Tally tally;
    for (int i = 0; i < count && !testing::Test::HasFatalFailure(); ++i) {
        Triangle<T, 3> s{next(), next(), next()}, t{next(), next(), next()};
        if (i % 4 >= 1) t.a = s.b;
        if (i % 4 >= 2) t.b = s.a;
        if (i % 32 == 3) t.c = s.c;
        if (i % 16 == 5) s.c = s.a;
        if (i % 64 == 6) t.c = t.b;
        if (i % 64 == 7) t.c = (t.a + t.b) * T(0.5);
        expect_exact(s, t, tally);
    }
    return tally;
}

TYPED_TEST(TrianglesMeet, AsInExactArithmeticOnSmallIntegers) {
    for (const int reach : {1, 2, 4, 1000}) {
        Random random(26, static_cast<std::uint64_t>(reach));
        const auto tally =
            expect_exact_pairs<TypeParam>(5000, [&] { return exact::integers<TypeParam, 3>(random, reach); });
        EXPECT_GT(tally.meet, 500) << reach;
        EXPECT_GT(tally.apart, 100) << reach;
        EXPECT_GT(tally.beyond, 50) << reach;
        EXPECT_GT(tally.shared_only, 500) << reach;
    }
}

/// All corners in one plane that is askew to the axes, or on one line.
TYPED_TEST(TrianglesMeet, AsInExactArithmeticInPlanesAndOnLines) {
    using V = Vec<TypeParam, 3>;
    Random random(26, 1);
    for (const int reach : {1, 2, 5}) {
        const auto steps = [&] { return TypeParam(exact::integer(random, reach)); };
        const V along(1, 2, -1), across(3, 0, 2);
        const auto plane =
            expect_exact_pairs<TypeParam>(2500, [&] { return along * steps() + across * steps(); });
        EXPECT_GT(plane.beyond, 200);
        EXPECT_GT(plane.shared_only, 200);
        const auto line = expect_exact_pairs<TypeParam>(1000, [&] { return along * steps(); });
        EXPECT_GT(line.beyond, 50);
        EXPECT_GT(line.shared_only, 30);
        const auto wall = expect_exact_pairs<TypeParam>(1000, [&] { return V(steps(), 7, steps()); });
        EXPECT_GT(wall.beyond, 50);
    }
}

TYPED_TEST(TrianglesMeet, AsInExactArithmeticAtEveryScale) {
    constexpr int most = std::is_same_v<TypeParam, float> ? 57 : 477;
    for (const int exponent : {most, -most}) {
        Random random(26, 2);
        const auto tally = expect_exact_pairs<TypeParam>(
            4000, [&] { return exact::integers<TypeParam, 3>(random, 3, exponent); });
        EXPECT_GT(tally.beyond, 100);
    }
}

TYPED_TEST(TrianglesMeet, AsInExactArithmeticOnNastyNumbers) {
    for (std::uint64_t i = 0; i < 150; ++i) {
        Random random(26, i);
        auto x = nasty::Numbers<TypeParam>::any(random), y = nasty::Numbers<TypeParam>::any(random);
        expect_exact_pairs<TypeParam>(40, [&] {
            const TypeParam first = x(), second = y(), third = y();
            return Vec<TypeParam, 3>(first, second, third);
        });
    }
}

/// Corners that were in one plane before they were rounded: the sign of each is in doubt.
TYPED_TEST(TrianglesMeet, AsInExactArithmeticInAlmostFlatWalls) {
    Random random(26, 3);
    const Vec3d along(0.3, 0.7, -0.2), across(0.1, -0.4, 0.9);
    const auto tally = expect_exact_pairs<TypeParam>(5000, [&] {
        const int u = exact::integer(random, 3), v = exact::integer(random, 3);
        return Vec<TypeParam, 3>(Vec3d(5, 5, 5) + along * double(u) + across * double(v));
    });
    EXPECT_GT(tally.beyond, 250);
    EXPECT_GT(tally.shared_only, 250);
}

TEST(MeetBeyondShared, IsWhatItSays) {
    const Triangle<double, 3> t{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    // An edge: unfolded, folded onto itself, at an angle.
    EXPECT_FALSE(meet_beyond_shared(t, {{4, 0, 0}, {0, 0, 0}, {1, -3, 0}}));
    EXPECT_TRUE(meet_beyond_shared(t, {{4, 0, 0}, {0, 0, 0}, {9, 1, 0}}));
    EXPECT_FALSE(meet_beyond_shared(t, {{4, 0, 0}, {0, 0, 0}, {1, 3, 0x1p-300}}));
    // A corner: beside, piercing, and lying on the face.
    EXPECT_FALSE(meet_beyond_shared(t, {{0, 0, 0}, {-1, 0, 1}, {0, -1, 1}}));
    EXPECT_TRUE(meet_beyond_shared(t, {{0, 0, 0}, {1, 1, 1}, {1, 1, -1}}));
    EXPECT_TRUE(meet_beyond_shared(t, {{0, 0, 0}, {1, 1, 0}, {-1, 0, 1}}));
    // A corner on the other's edge is no shared corner.
    EXPECT_TRUE(meet_beyond_shared(t, {{2, 0, 0}, {1, -1, 0}, {3, -1, 0}}));
    // Twice the same triangle, whichever way round; a segment twice.
    EXPECT_TRUE(meet_beyond_shared(t, {{0, 4, 0}, {4, 0, 0}, {0, 0, 0}}));
    EXPECT_FALSE(meet_beyond_shared({t.a, t.b, t.b}, {t.a, t.a, t.b}));
}

}  // namespace
