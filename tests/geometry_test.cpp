/// The basics of geometry against exact or wider arithmetic: rounding, vectors and boxes, closest points.
#include "exact.h"

#include <hedgerow/geometry/overlap.h>
#include <hedgerow/geometry/transform.h>

using namespace hedgerow;
using namespace hedgerow::exact;

namespace {

template <class T>
class Geometry : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Geometry, Scalars);

// ---- Rounding

TYPED_TEST(Geometry, TwoProductsAreExact) {
    using T = TypeParam;
    static_assert(two_product(T(3), T(5)).high == 15 && two_product(T(3), T(5)).low == 0);
    for (std::uint64_t i = 0; i < 100000; ++i) {
        Random random(1, i);
        constexpr int reach = std::is_same_v<T, float> ? 30 : 400;
        const T a = std::ldexp(T(random.uniform(-1, 1)), integer(random, reach));
        const T b = std::ldexp(T(random.uniform(-1, 1)), integer(random, reach));
        const auto p = two_product(a, b);
        ASSERT_EQ(p.high, product(a, b));
        ASSERT_EQ(p.high, a * b);
        ASSERT_EQ(p.low, std::fma(a, b, -p.high)) << a << " * " << b;
    }
}

TYPED_TEST(Geometry, DifferencesOfProductsHaveTheExactSign) {
    using T = TypeParam;
    constexpr int digits = std::numeric_limits<T>::digits;
    int zeros = 0;
    for (std::uint64_t i = 0; i < 100000; ++i) {
        Random random(2, i);
        const auto any = [&] { return static_cast<std::int64_t>(random.bits() >> (64 - digits)); };
        std::int64_t a = any(), b = any(), c = a + integer(random, 2), d = b + integer(random, 2);
        if (i % 2 == 0) c = any(), d = any();
        const Int top = Int(1) << digits;
        if (c < 0 || d < 0 || c > top || d > top) continue;
        const Int exact = Int(a) * b - Int(c) * d;
        const T got = difference_of_products(T(a), T(b), T(c), T(d));
        ASSERT_EQ(got > 0, exact > 0) << a << ' ' << b << ' ' << c << ' ' << d;
        ASSERT_EQ(got < 0, exact < 0) << a << ' ' << b << ' ' << c << ' ' << d;
        const Real error = static_cast<Real>(got) - static_cast<Real>(exact);
        ASSERT_LE(std::fabs(error), 8 * unit_roundoff<T> * std::fabs(static_cast<Real>(exact)));
        zeros += exact == 0;
    }
    EXPECT_GT(zeros, 100);
}

/// Not inlined, so that the compiler keeps the numbers they return side by side in registers. At -O1 it drops
/// no conversion, so this program has to be compiled as the library is.
template <int D>
[[gnu::noinline]] Vec<double, D> to_float_and_back(const Vec<double, D>& p) {
    return Vec<double, D>(Vec<float, D>(p));
}
template <int D>
[[gnu::noinline]] Vec<double, D> offset_of_transformed(const Affine<D>& f, const Vec<float, D>& p) {
    return Vec<double, D>(transformed(f, p)) - Vec<double, D>(p);
}
template <int D>
void expect_conversions_to_round() {
    const auto through_memory = [](const Vec<double, D>& v) {
        return map(v, [](double x) {
            const volatile float near = static_cast<float>(x);
            return static_cast<double>(near);
        });
    };
    for (std::uint64_t i = 0; i < 1000; ++i) {
        Random random(3, i);
        const Vec<double, D> p = random.in_cube<D>();
        ASSERT_EQ(to_float_and_back(p), through_memory(p));
        Affine<D> turn{{}, random.direction<D>()};
        for (auto& row : turn.linear) row = random.direction<D>();
        const Vec<float, D> narrow(p);
        const Vec<double, D> wide(narrow);
        ASSERT_EQ(offset_of_transformed(turn, narrow), through_memory(turn.point(wide)) - wide);
    }
}
TEST(Rounding, ConversionsToFloatAreNotDropped) {
    expect_conversions_to_round<2>();
    expect_conversions_to_round<3>();
}

#if defined(__SSE2__)
TYPED_TEST(Geometry, InIeeeModeSubnormalsLiveAndTheModeIsRestored) {
    using T = TypeParam;
    const volatile T least = std::numeric_limits<T>::min();
    const unsigned before = _mm_getcsr();
    const unsigned flushing = before | 0xC040;  // flush to zero, denormals are zero, rounding up
    const auto half = [&] { return least * T(0.5); };
    struct Thrown {};
    // Halve the least normal number in a mode that flushes, with and without in_ieee_mode.
    _mm_setcsr(flushing);
    const T outside = half();
    const T inside = in_ieee_mode(half);
    const unsigned after = _mm_getcsr();
    unsigned after_throw = 0;
    try {
        in_ieee_mode([] { throw Thrown(); });
    } catch (const Thrown&) {
        after_throw = _mm_getcsr();
    }
    _mm_setcsr(before);
    // Compare in the mode of before.
    EXPECT_EQ(outside, 0);
    EXPECT_EQ(inside, std::numeric_limits<T>::min() / 2);
    EXPECT_EQ(after & 0xFFC0, flushing & 0xFFC0);
    EXPECT_EQ(after_throw & 0xFFC0, flushing & 0xFFC0);
    EXPECT_EQ(in_ieee_mode([&]() -> const volatile T& { return least; }), least);
}
#endif

// ---- Vectors and boxes

TYPED_TEST(Geometry, VectorsAndBoxesDoAsTheySay) {
    using T = TypeParam;
    using V = Vec<T, 3>;
    using B = Box<T, 3>;
    EXPECT_EQ(cross(V(1, 2, 3), V(4, 5, 6)), V(-3, 6, -3));
    EXPECT_EQ(dot(V(1, 2, 3), V(4, 5, 6)), 32);
    EXPECT_EQ(normalized(V(0, 3, 4)), V(0, T(3) / 5, T(4) / 5));
    EXPECT_EQ(normalized(V()), V());
    EXPECT_EQ(max_axis(V(1, -2, 2)), 1);  // the first of equals
    EXPECT_EQ(max_axis(V(1, -2, 3)), 2);
    EXPECT_EQ(max_axis(V(-2, 2, 2)), 0);
    EXPECT_FALSE(std::signbit(abs(V(T(-0.0), 1, 1))[0]));
    EXPECT_FALSE(finite(V(0, std::numeric_limits<T>::infinity(), 0)));
    EXPECT_EQ((Triangle<T, 3>{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}).normal(), V(0, 0, 6));

    const B none, box{{0, 0, 0}, {2, 3, 4}}, flat{{1, 1, 4}, {2, 2, 4}};
    EXPECT_TRUE(none.empty());
    EXPECT_EQ(none.half_area(), 0);
    EXPECT_FALSE(none.contains(V()));
    EXPECT_FALSE(overlap(none, box));
    EXPECT_EQ(merged(none, box), box);
    EXPECT_FALSE(flat.empty());
    EXPECT_EQ(flat.half_area(), 1);
    EXPECT_EQ(box.half_area(), 2 * 3 + 3 * 4 + 4 * 2);
    EXPECT_EQ((Box<T, 2>{{0, 0}, {2, 3}}).half_area(), 5);
    EXPECT_EQ(box.center(), V(1, T(1.5), 2));
    EXPECT_TRUE(box.contains(flat) && box.contains(V(2, 3, 4)) && overlap(flat, box));
    EXPECT_FALSE(flat.contains(box) || box.contains(V(2, 3, T(4.5))));
    EXPECT_EQ(intersection(box, B{{1, 1, 1}, {9, 9, 9}}), (B{{1, 1, 1}, {2, 3, 4}}));
    EXPECT_TRUE(intersection(box, B{{3, 0, 0}, {4, 1, 1}}).empty());
    EXPECT_TRUE(overlap(box, B{{2, 3, 4}, {9, 9, 9}}));  // at a corner
    EXPECT_EQ((Sphere<T, 3>{{1, 2, 3}, 2}).bounds(), (B{{-1, 0, 1}, {3, 4, 5}}));
}

// ---- Distances

Real distance_to(Real3 p, Real3 a, Real3 b) {
    const Real3 ab = b - a;
    const Real l = dot(ab, ab);
    return size(p - a - ab * (l > 0 ? std::clamp(dot(p - a, ab) / l, Real(0), Real(1)) : Real(0)));
}
/// The distance to the nearest edge, or to the foot on the plane if it is inside and nearer. The side ac is
/// split into a part along ab and a height, so that in slivers all errors are those of a long double, too.
Real distance_to(Real3 p, Real3 a, Real3 b, Real3 c) {
    const Real3 ab = b - a, ac = c - a, ap = p - a;
    const Real l = dot(ab, ab), along_c = dot(ac, ab) / l, along_p = dot(ap, ab) / l;
    const Real3 height = ac - ab * along_c;
    const Real w = dot(ap - ab * along_p, height) / dot(height, height), v = along_p - w * along_c;
    const Real edges = std::min({distance_to(p, a, b), distance_to(p, a, c), distance_to(p, b, c)});
    return v >= 0 && w >= 0 && v + w <= 1 ? std::min(edges, size(ap - ab * v - ac * w)) : edges;
}

/// Expects that the closest point of a shape is right, within `slack`, and its distance within 2^-22 of
/// itself, or in double within 2^-48 of itself and of `longest`, the shape's longest edge. `distance`
/// measures to the shape in long double.
template <class T, int D, class Shape, class Distance>
void expect_closest(const Vec<T, D>& p, const Shape& shape, Real longest, Real slack, Distance distance) {
    const auto [d2, q] = closest_point(p, shape);
    const Box<T, D> box = shape.bounds();
    EXPECT_TRUE(box.contains(q));
    EXPECT_LE(distance(real(q)), slack);
    const Real true_distance = distance(real(p)), found = std::sqrt(Real(d2));
    EXPECT_LE(std::fabs(size(real(p) - real(q)) - true_distance), slack);
    const Real share = std::is_same_v<T, float> ? 0x1p-22 : 0x1p-48;
    const Real least = std::is_same_v<T, float> ? Real(0x1p-48) : share;  // of the longest edge
    const Real underflow = 2 * std::sqrt(Real(std::numeric_limits<T>::denorm_min()));
    EXPECT_LE(std::fabs(found - true_distance), share * true_distance + least * longest + underflow);
    // The distance to the box may be more by roundings in T.
    const Real boxes = std::is_same_v<T, float> ? 0x1p-20 : 0x1p-48;
    EXPECT_LE(Real(distance2(p, box)),
              Real(d2) * (1 + boxes) + 4 * Real(std::numeric_limits<T>::denorm_min()));
    EXPECT_LE(distance2(p, box), distance2(p, q));
    EXPECT_LE(distance2(p, merged(box, Box<T, D>().expand(p * T(0.5)))), distance2(p, box));
}

/// Triangles and segments of all shapes, down to needles and points, times 2^scale. An answer may err by 16
/// roundings of the largest number in the query and the shape. In a sliver the foot may slip along it, but no
/// farther off than the sliver is thick.
template <class T, int D>
void expect_closest_points(int scale, bool slivers) {
    for (std::uint64_t i = 0; i < 50000 && !testing::Test::HasFailure(); ++i) {
        SCOPED_TRACE(i);
        Random random(12, i);
        const auto within = [&](double radius) { return in_ball<T, D>(random, std::ldexp(radius, scale)); };
        const Vec<T, D> at = within(i % 4 == 0 ? 30 : 1);
        // Draw a triangle. In a sliver the third corner is near the line of the first two, or on it.
        Triangle<T, D> tri{at + within(1), at + within(1), at + within(1)};
        const T u = T(random.uniform(-0.2, 1.2)), v = T(random.uniform(-0.2, 1.2));
        if (slivers) {
            tri.c = tri.a + (tri.b - tri.a) * v;
            if (i % 3 == 0) tri.c = tri.c + within(std::exp2(random.uniform(-50, 0)));
            if (i % 10 == 1) tri.c = tri.b;
            if (i % 30 == 1) tri.a = tri.b;
        }
        // Draw a query in or near the triangle's plane.
        Vec<T, D> p = tri.a + (tri.b - tri.a) * u + (tri.c - tri.a) * v;
        if (i % 2 == 0) p = p + within(i % 16 == 0 ? 100 : 1);
        const Real3 a = real(tri.a), b = real(tri.b), c = real(tri.c);
        const Real largest = max_component(max(max(abs(p), abs(tri.a)), max(abs(tri.b), abs(tri.c))));
        const Real slack = 16 * unit_roundoff<T> * largest;
        expect_closest(p, Segment<T, D>{tri.a, tri.b}, size(b - a), slack,
                       [&](Real3 x) { return distance_to(x, a, b); });
        // Allow a sliver to err by its thickness, and other triangles by 2^16 roundings in double of the
        // query's distance.
        const Real longest = std::max({size(b - a), size(c - a), size(c - b)});
        const Real thickness = longest > 0 ? size(cross(b - a, c - a)) / longest : 0;
        const Real slip =
            thickness < longest / 16 ? thickness : 0x1p16 * unit_roundoff<double> * size(real(p) - a);
        expect_closest(p, tri, longest, slack + slip, [&](Real3 x) { return distance_to(x, a, b, c); });
    }
}
TYPED_TEST(Geometry, ClosestPointsOfTrianglesAndSegments) {
    for (const int scale : {-20, 0, 20}) {
        expect_closest_points<TypeParam, 2>(scale, false);
        expect_closest_points<TypeParam, 3>(scale, false);
    }
}
TYPED_TEST(Geometry, ClosestPointsOfSliversNeedlesAndPoints) {
    expect_closest_points<TypeParam, 2>(0, true);
    expect_closest_points<TypeParam, 3>(0, true);
}
TYPED_TEST(Geometry, ClosestPointsOfTheLargestAndLeastTriangles) {
    constexpr int most = std::is_same_v<TypeParam, float> ? 52 : 472;
    expect_closest_points<TypeParam, 3>(most, false);
    expect_closest_points<TypeParam, 3>(-most, false);
}

TYPED_TEST(Geometry, ClosestPointsLieInTheBoxOfTheirTriangle) {
    using T = TypeParam;
    for (std::uint64_t i = 0; i < 100000; ++i) {
        Random random(15, i);
        const auto any = [&] { return T(random.uniform()); };
        const Triangle<T, 3> tri{{any(), any(), 0}, {1, -1, 0}, {1, 2, 0}};
        const Vec<T, 3> p(1 - static_cast<T>(random.bits() % 8) * unit_roundoff<T>, any(), any());
        ASSERT_TRUE(tri.bounds().contains(closest_point(p, tri).point)) << i;
    }
}

/// The triangles on both sides of a fold, in every order of corners: off the fold both are equally far away.
TYPED_TEST(Geometry, TrianglesAreEquallyFarWhereTheirCommonEdgeIsClosest) {
    using T = TypeParam;
    for (std::uint64_t i = 0; i < 50000; ++i) {
        Random random(16, i);
        const auto any = [&] { return T(random.uniform(-1, 1)); };
        const Vec<T, 3> a(any(), T(-1), T(0)), b(any(), T(1), T(0));
        const Vec<T, 3> left(T(-5), any(), T(-6)), right(T(5), any(), T(-7)), p(any(), 2 * any(), T(9));
        const T one = closest_point(p, Triangle<T, 3>{a, b, left}).distance2;
        for (const auto& other : {Triangle<T, 3>{b, a, right}, {right, b, a}, {a, right, b}})
            ASSERT_EQ(closest_point(p, other).distance2, one) << i;
    }
}

template <class T, int D>
void expect_closest_on_spheres_and_boxes() {
    for (std::uint64_t i = 0; i < 50000 && !testing::Test::HasFailure(); ++i) {
        SCOPED_TRACE(i);
        Random random(13, i);
        const Sphere<T, D> ball{in_ball<T, D>(random, 9),
                                i % 9 == 0 ? T(0) : T(std::exp2(random.uniform(-9, 3)))};
        const Vec<T, D> p = i % 7 == 0 ? ball.center : in_ball<T, D>(random, 20);
        expect_closest(p, ball, 30, 200 * unit_roundoff<T>,
                       [&](Real3 x) { return std::fabs(size(x - real(ball.center)) - ball.radius); });
        // Compare the box with a distance in long double.
        const auto box = box_of(in_ball<T, D>(random, 9), in_ball<T, D>(random, 9));
        const Real3 q = real(clamped(p, box));
        Real d2 = 0;
        for (int k = 0; k < D; ++k) {
            const Real x = p[k], d = std::max({box.low[k] - x, x - box.high[k], Real(0)});
            d2 += d * d;
        }
        EXPECT_LE(std::fabs(distance2(p, box) - d2), 8 * unit_roundoff<T> * d2);
        EXPECT_LE(std::fabs(dot(real(p) - q, real(p) - q) - d2), 4 * unit_roundoff<T> * d2);
        EXPECT_EQ(distance2(p, box) == 0, box.contains(p));
        EXPECT_EQ(distance2(p, clamped(p, box)), distance2(p, box));
    }
}
TYPED_TEST(Geometry, ClosestPointsOfSpheresAndBoxes) {
    expect_closest_on_spheres_and_boxes<TypeParam, 2>();
    expect_closest_on_spheres_and_boxes<TypeParam, 3>();
}

}  // namespace
