/// Overlaps with boxes against rational arithmetic, on coordinates where rounding decides.
#include <gtest/gtest.h>

#include <hedgerow/geometry/overlap.h>

#include "exact.h"
#include "nasty.h"
#include "rational.h"

namespace {

using namespace hedgerow;

template <class T>
class Overlap : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Overlap, Scalars);

/// Compares the overlaps of triangles, segments and spheres with boxes against rational arithmetic. Counts
/// the triangles whose bounds overlap the box: in `yes` those that overlap it themselves, in `no` the others.
/// `source(random)` gives a function that draws vectors.
template <class T, class Source>
void expect_exact(int count, Source source, int& yes, int& no) {
    for (int i = 0; i < count; ++i) {
        Random random(14, static_cast<std::uint64_t>(i));
        auto space = source(random);
        const auto plane = [&] {
            const Vec<T, 3> v = space();
            return Vec<T, 2>(v[0], v[1]);
        };
        Triangle<T, 3> tri{space(), space(), space()};
        if (i % 16 == 0) tri.c = tri.a;
        if (i % 32 == 0) tri.b = tri.a;
        Box<T, 3> box = exact::box_of(space(), space());
        if (i % 8 == 1) box.low = min(tri.a, tri.b), box.high = max(tri.a, tri.b);
        const bool expected = rational::overlap(tri, box);
        ASSERT_EQ(overlap(tri, box), expected) << "triangle " << i;
        if (overlap(tri.bounds(), box)) ++(expected ? yes : no);

        const Box<T, 2> square = exact::box_of(plane(), plane());
        const Segment<T, 2> segment{plane(), i % 16 == 0 ? square.low : plane()};
        ASSERT_EQ(overlap(segment, square), rational::overlap(segment, square)) << "segment " << i;

        const Sphere<T, 3> ball{space(), std::abs(space()[0])};
        ASSERT_EQ(overlap(ball, box), rational::overlap(ball, box)) << "sphere " << i;
    }
}

template <class T>
void expect_exact_on_integers(int reach, int exponent) {
    int yes = 0, no = 0;
    const auto integers = [=](Random& random) {
        return [&random, reach, exponent] { return exact::integers<T, 3>(random, reach, exponent); };
    };
    expect_exact<T>(10000, integers, yes, no);
    EXPECT_GT(yes, 200);
    EXPECT_GT(no, 200);
}
TYPED_TEST(Overlap, IsExactOnIntegersAndCountsTouching) {
    for (const int reach : {1, 2, 4, 4000}) expect_exact_on_integers<TypeParam>(reach, 0);
}
TYPED_TEST(Overlap, OfTheLargestAndLeastShapes) {
    constexpr int most = std::is_same_v<TypeParam, float> ? 57 : 477;
    for (const int exponent : {most, -most}) expect_exact_on_integers<TypeParam>(4, exponent);
}
TYPED_TEST(Overlap, IsExactOnNastyNumbers) {
    using Numbers = nasty::Numbers<TypeParam>;
    const auto numbers = [](Random& random) {  // one kind along the first axis, another along the others
        return [x = Numbers::any(random), y = Numbers::any(random)]() mutable {
            return Vec<TypeParam, 3>{x(), y(), y()};
        };
    };
    int yes = 0, no = 0;
    expect_exact<TypeParam>(30000, numbers, yes, no);
    EXPECT_GT(yes, 500);
    EXPECT_GT(no, 500);
}

/// Triangles in walls that are flat but for the last digits, and boxes around a point inside the triangle.
TYPED_TEST(Overlap, OfAlmostFlatWalls) {
    using T = TypeParam;
    Random random(16, 0);
    for (int i = 0; i < 20000; ++i) {
        const int axis = i % 3;
        const T wall = static_cast<T>(random.uniform());
        const auto corner = [&] {
            Vec<T, 3> v(static_cast<T>(random.uniform()), static_cast<T>(random.uniform()),
                        static_cast<T>(random.uniform()));
            v[axis] = nasty::nudged(wall, static_cast<int>(random.bits() % 4));
            return v;
        };
        const Triangle<T, 3> tri{corner(), corner(), corner()};
        const Vec<T, 3> middle = tri.a * T(0.25) + (tri.b * T(0.25) + tri.c * T(0.5));
        Box<T, 3> box{middle - Vec<T, 3>::all(T(0.01)), middle + Vec<T, 3>::all(T(0.01))};
        if (i % 2 == 0)
            box.low[axis] = box.high[axis] = nasty::nudged(wall, static_cast<int>(random.bits() % 4));
        ASSERT_EQ(overlap(tri, box), rational::overlap(tri, box)) << i;
    }
}

TYPED_TEST(Overlap, BoundsOfSpheresHoldThem) {
    using T = TypeParam;
    Random random(17, 0);
    for (int i = 0; i < 20000; ++i) {
        auto numbers = nasty::Numbers<T>::any(random);
        const Sphere<T, 2> ball{numbers.template vec<2>(), std::abs(numbers())};
        const Box<T, 2> box = ball.bounds();
        for (int k = 0; k < 2; ++k) {
            const rational::Number c = double(ball.center[k]), r = double(ball.radius);
            ASSERT_TRUE(double(box.low[k]) <= c - r && c + r <= double(box.high[k])) << i;
            ASSERT_TRUE(ball.radius > 0 || (box.low[k] == ball.center[k] && box.high[k] == ball.center[k]))
                << i;
        }
    }
}

}  // namespace
