/// Intersections of rays and shapes against exact or wider arithmetic, and the premise of every structure:
/// that the probe enters each box around a hit.
#include "exact.h"

#include <hedgerow/probes/ray.h>

using namespace hedgerow;
using namespace hedgerow::exact;

namespace {

template <class T>
class Rays : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Rays, Scalars);

// ---- Ray meets triangle

/// The intersection of a ray's line and a triangle's plane, in long double. The three tests may differ from
/// it and from one another by some roundings. Let L be the longest edge, A twice the area, R the distance of
/// the farthest corner from the origin o, D the direction's length, N = |normal · direction| and ε the unit
/// roundoff. In the test by plane the normal errs by ε·L², hence t by ε·L²·R / N, the point by ε·(|o| +
/// L²·R·D / N), and the coordinates u and v by the point's error times L / A. The other tests err less.
template <class T>
struct Crossing {
    Real t, u, v, slack_t, slack_uv;

    Crossing(const Ray<T, 3>& ray, const Triangle<T, 3>& tri) {
        const Real3 o = real(ray.origin), d = real(ray.direction), a = real(tri.a), b = real(tri.b),
                    c = real(tri.c), n = cross(b - a, c - a);
        const Real across = dot(n, d);
        t = dot(n, a - o) / across;
        u = dot(cross(d, o - a), c - a) / across;
        v = dot(cross(o - a, d), b - a) / across;
        const Real longest = std::max({size(b - a), size(c - a), size(c - b)});
        const Real reach = std::max({size(a - o), size(b - o), size(c - o)});
        const Real condition = longest * longest / std::fabs(across);
        slack_t = 32 * unit_roundoff<T> * condition * reach;
        slack_uv = 32 * unit_roundoff<T> * condition * longest / size(n) * (reach + size(o)) * size(d);
    }
    bool hit() const { return std::min({u, v, 1 - u - v}) >= 0 && t >= 0; }
    bool clear() const {
        return std::fabs(std::min({u, v, 1 - u - v})) > slack_uv && std::fabs(t) > slack_t && slack_uv < 1;
    }
    bool near(const std::optional<Meeting<T>>& m) const {
        return m && std::fabs(m->t - t) <= slack_t && std::fabs(m->u - u) <= slack_uv &&
               std::fabs(m->v - v) <= slack_uv;
    }
};

TYPED_TEST(Rays, TheThreeWaysToMeetATriangleAgree) {
    using T = TypeParam;
    int clear = 0, hits = 0;
    for (std::uint64_t i = 0; i < 100000; ++i) {
        Random random(3, i);
        // Choose a triangle and a ray to a point in or near it.
        const Vec<T, 3> at = in_ball<T, 3>(random, 10);
        const double s = std::exp2(integer(random, 4));
        Triangle<T, 3> tri{at + in_ball<T, 3>(random, s), at + in_ball<T, 3>(random, s),
                           at + in_ball<T, 3>(random, s)};
        const T u = T(random.uniform(-0.5, 1.5)), v = T(random.uniform(-0.5, 1.5));
        const auto target = tri.a + (tri.b - tri.a) * u + (tri.c - tri.a) * v;
        const Vec<T, 3> origin = target + in_ball<T, 3>(random, 20);
        const T longer = T(std::exp2(integer(random, 8)));
        Ray<T, 3> ray{origin, (target - origin) * (i % 4 == 0 ? -longer : longer)};
        if (i % 16 == 1) ray.direction[integer(random, 1) + 1] = T(-0.0);
        // Compare the tests, with both windings, where roundings cannot decide.
        for (int winding = 0; winding < 2; ++winding, std::swap(tri.b, tri.c)) {
            const Crossing<T> exact(ray, tri);
            if (!exact.clear()) continue;
            for (const auto& m :
                 {meet_by_plane(ray, tri), meet_by_barycentrics(ray, tri), meet_watertight(ray, tri)}) {
                ASSERT_EQ(m.has_value(), exact.hit()) << i;
                if (m) {
                    ASSERT_TRUE(exact.near(m)) << i;
                }
            }
            ++clear, hits += exact.hit();
        }
    }
    EXPECT_GT(clear, 150000);
    EXPECT_GT(hits, 12000);
}

/// Where the shear is exact, so is the answer: edges and corners belong to the triangle, on both sides.
TYPED_TEST(Rays, TheWatertightWayIsExactOnIntegers) {
    using T = TypeParam;
    int at_edges = 0;
    for (std::uint64_t i = 0; i < 300000; ++i) {
        Random random(4, i);
        // Choose a ray and a triangle with integer coordinates.
        using V = Vec<T, 3>;
        const V o = integers<T, 3>(random, 3);
        const Triangle<T, 3> tri{integers<T, 3>(random, 3), integers<T, 3>(random, 3),
                                 integers<T, 3>(random, 3)};
        V d = integers<T, 3>(random, 2);
        d[integer(random, 1) + 1] = i % 2 == 0 ? T(2) : T(-2);
        // Compute the exact result from the volumes of ray and edges.
        const Real3 a = real(tri.a - o), b = real(tri.b - o), c = real(tri.c - o), along = real(d);
        const Real u = dot(along, cross(b, c)), v = dot(along, cross(c, a)), w = dot(along, cross(a, b));
        const bool hit = ((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) && u + v + w != 0;
        const auto m = meet(WatertightRay<T>(o, d * T(0.25)), tri);
        ASSERT_EQ(m.has_value(), hit) << i;
        if (!hit) continue;
        const Real t = 4 * dot(cross(b - a, c - a), a) / (u + v + w), rounding = 32 * unit_roundoff<T>;
        ASSERT_LE(std::fabs(m->t - t), rounding) << i;
        ASSERT_LE(std::fabs(m->u - v / (u + v + w)), rounding) << i;
        ASSERT_LE(std::fabs(m->v - w / (u + v + w)), rounding) << i;
        at_edges += u == 0 || v == 0 || w == 0;
    }
    EXPECT_GT(at_edges, 5000);
}

TYPED_TEST(Rays, NoRayLeaksThroughAFan) {
    using T = TypeParam;
    for (std::uint64_t i = 0; i < 100000; ++i) {
        Random random(5, i);
        // Make a fan of triangles around a center.
        const int n = 5 + static_cast<int>(random.bits() % 6);
        const Vec<T, 3> center = in_ball<T, 3>(random, 0.3);
        std::vector<Vec<T, 3>> rim;
        for (int k = 0; k < n; ++k) {
            const double angle = (k + random.uniform(-0.2, 0.2)) * 2 * 3.14159265 / n;
            rim.emplace_back(T(2 * std::cos(angle)), T(2 * std::sin(angle)), T(random.uniform(-0.5, 0.5)));
        }
        // Aim at the center or at an inner edge.
        const T s = i % 3 == 0 ? T(0) : T(random.uniform(0, 0.9));
        const Vec<T, 3> target = center + (rim[random.bits() % rim.size()] - center) * s;
        const Vec<T, 3> origin(T(random.uniform(-9, 9)), T(random.uniform(-9, 9)), T(i % 2 == 0 ? 40 : -40));
        const Ray<T, 3> ray{origin, target - origin};
        int hits = 0;
        for (std::size_t k = 0; k < rim.size(); ++k) {
            Triangle<T, 3> tri{center, rim[k], rim[(k + 1) % rim.size()]};
            if (random.bits() % 2 == 0) std::swap(tri.a, tri.b);
            hits += meet_watertight(ray, tri).has_value();
        }
        ASSERT_GE(hits, 1) << i;
    }
}

TYPED_TEST(Rays, TrianglesWithoutAreaAreNeverHit) {
    using T = TypeParam;
    for (std::uint64_t i = 0; i < 200000; ++i) {
        Random random(6, i);
        const Vec<T, 3> a = integers<T, 3>(random, 8), step = integers<T, 3>(random, 3);
        Triangle<T, 3> tri{a, a + step * T(integer(random, 3)), a + step * T(integer(random, 3))};
        Vec<T, 3> d = integers<T, 3>(random, 2);
        d[integer(random, 1) + 1] = T(2);
        const Ray<T, 3> ray{a + step * T(integer(random, 2)) - d * T(integer(random, 2) + 2), d};
        for (int turn = 0; turn < 3; ++turn) {
            ASSERT_FALSE(meet_by_plane(ray, tri)) << i;
            ASSERT_FALSE(meet_by_barycentrics(ray, tri)) << i;
            ASSERT_FALSE(meet_watertight(ray, tri)) << i;
            tri = {tri.b, tri.c, tri.a};
        }
    }
}
TYPED_TEST(Rays, TrianglesOfTwoCornersAreNeverHit) {
    using T = TypeParam;
    for (std::uint64_t i = 0; i < 100000; ++i) {
        Random random(7, i);
        const Vec<T, 3> a = in_ball<T, 3>(random, 3), b = in_ball<T, 3>(random, 3);
        const Vec<T, 3> origin = in_ball<T, 3>(random, 9);
        const Ray<T, 3> ray{origin, a + (b - a) * T(random.uniform()) - origin};
        for (const Triangle<T, 3>& tri : {Triangle<T, 3>{a, b, b}, {b, a, b}, {b, b, a}, {a, a, a}})
            ASSERT_FALSE(meet_watertight(ray, tri)) << i;
    }
}

TYPED_TEST(Rays, BothEndsOfTheIntervalBelongToIt) {
    using T = TypeParam;
    constexpr T infinity = std::numeric_limits<T>::infinity();
    const auto expect = [&](auto meets, const Ray<T, 3>& ray, const Triangle<T, 3>& tri) {
        const auto m = meets(ray, tri);
        ASSERT_TRUE(m);
        const T t = m->t, less = std::nextafter(t, T(0)), more = std::nextafter(t, infinity);
        const auto within = [&](T t_min, T t_max) {
            return meets(Ray<T, 3>{ray.origin, ray.direction, t_min, t_max}, tri) == m;
        };
        EXPECT_TRUE(within(t, t) && within(t, infinity) && within(0, t));
        EXPECT_FALSE(within(0, less) || within(more, infinity));
    };
    for (std::uint64_t i = 0; i < 100; ++i) {
        Random random(8, i);
        const Triangle<T, 3> tri{{0, 0, in_ball<T, 3>(random, 1)[0]}, {1, 0, 0}, {0, 1, 0}};
        const Ray<T, 3> ray{{T(0.1), T(0.2), 3}, {T(0.05), T(0.1), T(random.uniform(-2, -1))}};
        expect(meet_by_plane<T>, ray, tri);
        expect(meet_by_barycentrics<T>, ray, tri);
        expect(meet_watertight<T>, ray, tri);
    }
}

// ---- Ray meets box

/// A parameter of a ray. Infinity is 1 / 0.
struct Fraction {
    std::int64_t top, bottom;  // bottom >= 0
    friend bool operator<(Fraction a, Fraction b) { return a.top * b.bottom < b.top * a.bottom; }
};
/// The interval of a ray in a box, exact for integers. The candidates are the parameters at which the ray
/// begins, ends or crosses a plane of the box. The interval is from the least to the greatest whose point is
/// in the box.
template <int D>
std::optional<std::pair<Fraction, Fraction>> exact_interval(const Ray<double, D>& ray,
                                                            const Box<double, D>& box) {
    const auto i64 = [](double x) { return static_cast<std::int64_t>(x); };
    // List the candidates. 2^20 is beyond all crossings and stands for infinity.
    const bool endless = !(ray.t_max < 1e9);
    const Fraction begin{i64(ray.t_min), 1},
        end = endless ? Fraction{1 << 20, 1} : Fraction{i64(ray.t_max), 1};
    std::vector<Fraction> ts = {begin, end};
    for (int k = 0; k < D; ++k)
        for (const double plane : {box.low[k], box.high[k]}) {
            const std::int64_t d = i64(ray.direction[k]), to = i64(plane - ray.origin[k]);
            if (d != 0) ts.push_back(d > 0 ? Fraction{to, d} : Fraction{-to, -d});
        }
    // Remove those beyond the ray or outside of the box.
    std::erase_if(ts, [&](Fraction t) {
        bool outside = t < begin || end < t;
        for (int k = 0; k < D; ++k) {
            const std::int64_t x = i64(ray.origin[k]) * t.bottom + i64(ray.direction[k]) * t.top;
            outside = outside || x < i64(box.low[k]) * t.bottom || x > i64(box.high[k]) * t.bottom;
        }
        return outside;
    });
    if (ts.empty()) return std::nullopt;
    const auto [least, greatest] = std::minmax_element(ts.begin(), ts.end());
    if (endless && greatest->top == end.top) return std::pair{*least, Fraction{1, 0}};
    return std::pair{*least, *greatest};
}

template <class T, int D>
void expect_exact_boxes() {
    int hits = 0, misses = 0, flat = 0;
    for (std::uint64_t i = 0; i < 200000; ++i) {
        Random random(9, i);
        const auto box = box_of(integers<T, D>(random, 3), integers<T, D>(random, 3));
        Ray<T, D> ray{integers<T, D>(random, 4), integers<T, D>(random, 2), T(integer(random, 1) + 1)};
        if (i % 3 == 0) ray.t_max = ray.t_min + T(integer(random, 1) + 1);
        for (T& x : ray.direction.data)
            if (x == 0 && random.bits() % 2 == 0) x = T(-0.0);
        const Ray<double, D> wide{Vec<double, D>(ray.origin), Vec<double, D>(ray.direction), ray.t_min,
                                  ray.t_max};
        const auto exact = exact_interval<D>(wide, {Vec<double, D>(box.low), Vec<double, D>(box.high)});
        const auto got = meet(ray, box);
        ASSERT_EQ(got.has_value(), exact.has_value()) << i;
        ++(got ? hits : misses);
        if (!got) continue;
        flat += box.low[0] == box.high[0];
        ASSERT_EQ(got->entry, T(exact->first.top) / T(exact->first.bottom)) << i;
        ASSERT_EQ(got->exit, T(exact->second.top) / T(exact->second.bottom)) << i;
    }
    EXPECT_GT(hits, 10000);
    EXPECT_GT(misses, 10000);
    EXPECT_GT(flat, 100);
}
TYPED_TEST(Rays, RaysMeetBoxesExactlyOnIntegers) {
    expect_exact_boxes<TypeParam, 2>();
    expect_exact_boxes<TypeParam, 3>();
}

TYPED_TEST(Rays, RaysEnterAndLeaveBoxesOnTheirSurface) {
    using T = TypeParam;
    constexpr T u = unit_roundoff<T>;
    for (std::uint64_t i = 0; i < 100000; ++i) {
        Random random(10, i);
        // Aim at a point of a box, in some cases of a flat one.
        auto box = box_of(in_ball<T, 3>(random, 5), in_ball<T, 3>(random, 5));
        if (i % 5 == 0) box.high[integer(random, 1) + 1] = box.low[integer(random, 1) + 1];
        if (box.empty()) continue;
        Vec<T, 3> target = in_ball<T, 3>(random, 5);
        target = min(max(target, box.low), box.high);
        const Vec<T, 3> origin = in_ball<T, 3>(random, 20);
        const Ray<T, 3> ray{origin, (target - origin) * T(std::exp2(integer(random, 9)))};
        const auto in = meet(ray, box);
        if (!in) continue;  // missed only by rounding, at a face
        // Both ends of the interval are at a face, or the origin is in the box.
        for (const T t : {in->entry, in->exit}) {
            if (t == 0) {
                ASSERT_TRUE(box.contains(origin));
                continue;
            }
            bool at_a_face = false;
            for (int k = 0; k < 3; ++k) {
                const T x = ray.at(t)[k],
                        slack = 8 * u * (std::abs(origin[k]) + std::abs(ray.direction[k] * t));
                ASSERT_GE(x, box.low[k] - slack) << i;
                ASSERT_LE(x, box.high[k] + slack) << i;
                at_a_face =
                    at_a_face || std::abs(x - box.low[k]) <= slack || std::abs(x - box.high[k]) <= slack;
            }
            ASSERT_TRUE(at_a_face) << i;
        }
    }
    EXPECT_FALSE(meet(Ray<T, 3>{{0, 0, 0}, {1, 2, 3}}, Box<T, 3>()));
    EXPECT_FALSE(meet(Ray<T, 3>{{0, 0, 0}, {0, T(-0.0), -1}}, Box<T, 3>()));
}

/// The premise of every structure. Where the watertight test hits, the probe enters every box around the
/// triangle, and at or before the hit. On the side of a plane that contains the triangle, the interval
/// contains the hit.
TYPED_TEST(Rays, TheProbeEntersEveryBoxAroundAHit) {
    using T = TypeParam;
    int hits = 0;
    for (std::uint64_t i = 0; i < 300000; ++i) {
        Random random(11, i);
        // Choose a triangle of any size, some thin, in a larger scene.
        const int scale = integer(random, std::is_same_v<T, float> ? 40 : 300);
        const auto within = [&](double radius) { return in_ball<T, 3>(random, std::ldexp(radius, scale)); };
        const Vec<T, 3> at = within(i % 4 == 0 ? 1000 : 1);
        const double thin = i % 3 == 0 ? 1e-6 : 1;
        Triangle<T, 3> tri{at + within(1), at + within(1), at};
        tri.c = i % 5 == 0 ? at + within(1) : tri.a + (tri.b - tri.a) * T(random.uniform()) + within(thin);
        if (i % 7 == 0) tri.b[integer(random, 1) + 1] = tri.a[0];
        Box<T, 3> scene = tri.bounds();
        scene.expand(at + within(i % 8 == 0 ? 1e4 : 2));
        // Aim at a point of the triangle, some rays in its plane or across an axis.
        const T u = i % 2 == 0 ? T(0) : T(random.uniform()),
                v = i % 9 == 0 ? T(0) : T(random.uniform()) * (1 - u);
        const Vec<T, 3> target = tri.a * (1 - u - v) + tri.b * u + tri.c * v;
        const Vec<T, 3> origin = i % 6 == 0 ? within(3e4) : target + within(2);
        Ray<T, 3> ray{origin, (target - origin) * T(std::exp2(integer(random, 20)))};
        if (i % 4 == 1)
            ray.direction = target - (ray.origin = tri.a + (tri.b - tri.a) * T(random.uniform(-1, 0)));
        if (i % 10 == 3) ray.direction[integer(random, 1) + 1] = T(-0.0);
        const RayProbe<T, 3> probe(ray, scene);
        if (!probe.usable()) continue;
        const auto m = meet(probe.watertight(), tri);
        if (!m || !(m->t >= 0 && m->t <= std::numeric_limits<T>::max())) continue;
        ++hits;
        // Enter the triangle's own box and a larger one, alone and as a pair.
        const Box<T, 3> own = tri.bounds(), larger = merged(own, Box<T, 3>().expand(at + within(1)));
        BoxPair<T, 3> pair;
        pair.set(0, own), pair.set(1, larger);
        T entry[2], entries[4];
        ASSERT_TRUE(probe.enter(own, m->t, entry[0])) << i;
        ASSERT_TRUE(probe.enter(larger, m->t, entry[1])) << i;
        ASSERT_EQ(probe.enter(pair, m->t, entries), 3u) << i;
        for (int k = 0; k < 2; ++k) {
            ASSERT_LE(entry[k], m->t) << i;
            ASSERT_EQ(entry[k], entries[k]) << i;
        }
        // Cut at the planes of the own box. The triangle's side contains the hit.
        for (int axis = 0; axis < 3; ++axis)
            for (const bool above : {false, true}) {
                const auto cut = probe.cut(probe.root(scene),
                                           AxisPlane<T>{axis, above ? own.low[axis] : own.high[axis]}, m->t);
                const auto& side = cut.near_is_high == above ? cut.near : cut.far;
                ASSERT_TRUE(side.entry <= m->t && m->t <= side.exit) << i;
            }
    }
    EXPECT_GT(hits, 100000);
}

}  // namespace
