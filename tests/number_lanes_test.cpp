/// Lanes: whatever is written for them gives each lane the bits that a single number gets, from arithmetic up
/// to surfaces, lights and skies.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

#include <hedgerow/geometry/elementary.h>
#include <hedgerow/geometry/offset.h>
#include <hedgerow/render/lighting/default_sky.h>
#include <hedgerow/render/lighting/emitters.h>
#include <hedgerow/render/scattering/point_scattering.h>

#include "lights_of_tests.h"
#include "scattering_support.h"

namespace hedgerow {
namespace {

using test::random_point;
using test::random_triangle;

/// Whether two results have the same bits. All NaN are one.
template <std::floating_point T>
bool same(T a, T b) {
    return (a != a && b != b) || (a == b && std::signbit(a) == std::signbit(b));
}
bool same(bool a, bool b) {
    return a == b;
}
template <class T, int D>
bool same(const Vec<T, D>& a, const Vec<T, D>& b) {
    for (int i = 0; i < D; ++i)
        if (!same(a[i], b[i])) return false;
    return true;
}
/// The part of a result in a lane.
bool in_lane(LaneMask m, int k) {
    return m[k];
}
bool in_lane(LaneMaskOf<double> m, int k) {
    return m[k];
}
template <std::floating_point T>
T in_lane(NumberLanes<T> x, int k) {
    return x[k];
}
template <std::floating_point T, int D>
Vec<T, D> in_lane(const Vec<NumberLanes<T>, D>& a, int k) {
    Vec<T, D> v;
    for (int i = 0; i < D; ++i) v[i] = a[i][k];
    return v;
}

/// Numbers where roundings, signs and comparisons are special, and some that are not.
template <std::floating_point T>
std::vector<T> numbers() {
    using limits = std::numeric_limits<T>;
    std::vector<T> all{0,
                       1,
                       -1,
                       T(0.5),
                       T(-2.5),
                       limits::min(),
                       limits::denorm_min(),
                       3,
                       T(-0.0),
                       T(1e30),
                       limits::max(),
                       -limits::max(),
                       limits::infinity(),
                       -limits::infinity(),
                       T(7.999),
                       limits::quiet_NaN()};
    Random random(3);
    for (int i = 0; i < 16; ++i) all.push_back(static_cast<T>(random.uniform(-4, 4)));
    return all;
}
/// Holds what f returns for lanes against what it returns for each of them.
template <class T, class F>
void expect_same(const char* what, const F& f) {
    const std::vector<T> all = numbers<T>();
    const auto number = [&](std::size_t i) { return all[i % all.size()]; };
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t j = 0; j < all.size(); ++j) {
            const auto a = NumberLanes<T>::each([&](int k) { return number(i + std::size_t(k)); });
            const auto b = NumberLanes<T>::each([&](int k) { return number(j + 3 * std::size_t(k)); });
            const auto lanes = f(a, b);
            for (int k = 0; k < 4; ++k)
                ASSERT_TRUE(same(in_lane(lanes, k), f(a[k], b[k])))
                    << what << " of " << a[k] << " and " << b[k];
        }
}
template <class T>
void expect_same_arithmetic() {
    expect_same<T>("sum", [](auto a, auto b) { return a + b; });
    expect_same<T>("difference", [](auto a, auto b) { return a - b; });
    expect_same<T>("plain product", [](auto a, auto b) { return a * b; });
    expect_same<T>("product", [](auto a, auto b) { return product(a, b); });
    expect_same<T>("quotient", [](auto a, auto b) { return a / b; });
    expect_same<T>("negative", [](auto a, auto) { return -a; });
    expect_same<T>("lesser", [](auto a, auto b) { return lesser(a, b); });
    expect_same<T>("greater", [](auto a, auto b) { return greater(a, b); });
    expect_same<T>("root", [](auto a, auto) { return root(a); });
    expect_same<T>("magnitude", [](auto a, auto) { return magnitude(a); });
    expect_same<T>("sign", [](auto a, auto b) { return with_sign_of(a, b); });
    expect_same<T>("clamped", [](auto a, auto b) { return clamped(a, b, 1); });
    expect_same<T>("<", [](auto a, auto b) { return a < b; });
    expect_same<T>(">", [](auto a, auto b) { return a > b; });
    expect_same<T>("<=", [](auto a, auto b) { return a <= b; });
    expect_same<T>(">=", [](auto a, auto b) { return a >= b; });
    expect_same<T>("equal", [](auto a, auto b) { return equal(a, b); });
    expect_same<T>("minus", [](auto a, auto) { return has_minus(a); });
    expect_same<T>("and, or, not", [](auto a, auto b) { return (a < b || a > 1) && !(b > 0); });
    expect_same<T>("select", [](auto a, auto b) { return select(a < b, a, b); });
    expect_same<T>("only", [](auto a, auto b) { return only(a < b, b); });
    expect_same<T>("select of conditions", [](auto a, auto b) { return select(a<b, a> 0, b > 0); });
    expect_same<T>("floor", [](auto a, auto) { return floored(only(magnitude(a) < T(1e9), a)) + T(0); });
    expect_same<T>("in float", [](auto a, auto) { return in_float(a); });
}

TEST(Lanes, HaveTheArithmeticOfSingleFloats) {
    expect_same_arithmetic<float>();
    expect_same<float>("widened", [](auto a, auto b) { return widened(Vec<decltype(a), 3>(a, b, a)); });
}
TEST(Lanes, HaveTheArithmeticOfSingleDoubles) {
    expect_same_arithmetic<double>();
}
TEST(Lanes, AnyAsksAllOfThem) {
    for (int which = 0; which < 16; ++which) {
        const auto floats = LaneMask::each([&](int k) { return (which >> k & 1) != 0; });
        const auto doubles = LaneMaskOf<double>::each([&](int k) { return (which >> k & 1) != 0; });
        EXPECT_EQ(any(floats), which != 0);
        EXPECT_EQ(any(doubles), which != 0);
        EXPECT_EQ(any(!floats), which != 15);
        EXPECT_EQ(any(!doubles), which != 15);
    }
}
TEST(Lanes, HaveTheVectorsOfSingleNumbers) {
    const auto vectors = [](auto a, auto b) {
        using V = Vec<decltype(a), 3>;
        return std::pair(V(a, b, a + b), V(b, 1, a));
    };
    const auto expect = [&](const char* what, const auto& f) {
        expect_same<float>(what, [&](auto a, auto b) {
            const auto [u, v] = vectors(a, b);
            return f(u, v);
        });
    };
    expect("dot", [](const auto& u, const auto& v) { return dot(u, v); });
    expect("cross", [](const auto& u, const auto& v) { return cross(u, v); });
    expect("normalized", [](const auto& u, const auto&) { return normalized(u); });
    expect("min", [](const auto& u, const auto& v) { return min(u, v); });
    expect("max", [](const auto& u, const auto& v) { return max(u, v); });
    expect("abs", [](const auto& u, const auto&) { return abs(u); });
    expect("max_component", [](const auto& u, const auto&) { return max_component(u); });
    expect("select", [](const auto& u, const auto& v) { return select(u[0] < v[0], u, v); });
    expect("equal", [](const auto& u, const auto& v) { return equal(u, v); });
}
TEST(Lanes, HaveTheTurnsAndWarpsOfSingleNumbers) {
    const auto turns = [](auto a) { return only(magnitude(a) < 1e6f, a); };
    expect_same<float>("sine", [&](auto a, auto) { return sine_cosine_of_turns(turns(a)).sine; });
    expect_same<float>("cosine", [&](auto a, auto) { return sine_cosine_of_turns(turns(a)).cosine; });
    const auto unit = [&](auto a) { return magnitude(turns(a)) - floored(magnitude(turns(a))); };
    expect_same<float>("disc", [&](auto a, auto b) { return disc_point(unit(a), unit(b)); });
    expect_same<float>("cosine", [&](auto a, auto b) { return cosine_direction(unit(a), unit(b)); });
    expect_same<float>("hemisphere", [&](auto a, auto b) { return hemisphere_direction(unit(a), unit(b)); });
    expect_same<float>("triangle", [&](auto a, auto b) { return triangle_point(unit(a), unit(b)); });
}

/// Calls f(k) for random cases of four.
template <class F>
void for_groups(int count, const F& f) {
    for (int i = 0; i < count; ++i) f(Random(17, static_cast<std::uint64_t>(i)));
}
template <class S, class F>
std::array<S, 4> four(const F& f) {
    return {f(), f(), f(), f()};
}

template <class T>
void expect_same_origins() {
    for_groups(2000, [](Random random) {
        struct Case {
            Vec<T, 3> origin, direction, low, high, normal, toward;
            T begin, t;
        };
        const auto cases = four<Case>([&] {
            const auto vector = [&] { return Vec<T, 3>(random.in_cube<3>() * 2.0 - Vec3d::all(1)); };
            const Vec<T, 3> a = vector(), b = vector(), n = vector();
            return Case{vector(),
                        normalized(vector()),
                        min(a, b),
                        max(a, b),
                        n,
                        random.uniform() < 0.5 ? n : vector(),
                        T(random.uniform() < 0.5 ? 0 : 0.3),
                        T(random.uniform(0, 2))};
        });
        const auto of = [&](int k) -> const Case& { return cases[std::size_t(k)]; };
        const auto low = in_lanes(of, &Case::low), high = in_lanes(of, &Case::high),
                   origin = in_lanes(of, &Case::origin);
        const auto lanes = offset_origin(origin, in_lanes(of, &Case::direction), in_lanes(of, &Case::begin),
                                         in_lanes(of, &Case::t), hit_error(origin, low, high),
                                         in_lanes(of, &Case::normal), in_lanes(of, &Case::toward));
        for (int k = 0; k < 4; ++k) {
            const Case& c = of(k);
            const Ray<T, 3> ray{c.origin, c.direction, c.begin};
            ASSERT_TRUE(
                same(lane(lanes, k), offset_origin(ray, c.t, Box<T, 3>{c.low, c.high}, c.normal, c.toward)));
        }
    });
}
TEST(Lanes, HaveTheOriginsOfSingleRays) {
    expect_same_origins<float>();
    expect_same_origins<double>();
}

void expect_same_light(const LightSampleOf<FloatLanes>& lanes, int k, const LightSample& one) {
    EXPECT_TRUE(same(lane(lanes.direction, k), one.direction));
    EXPECT_TRUE(same(lanes.distance[k], one.distance));
    EXPECT_TRUE(same(lanes.free[k], one.free));
    EXPECT_TRUE(same(lane(lanes.radiance, k), one.radiance));
    EXPECT_TRUE(same(lanes.density[k], one.density));
    EXPECT_TRUE(same(in_lane(lanes.weights, k), one.weights));
    EXPECT_EQ(lanes.single[k], one.single);
    EXPECT_EQ(lanes.arrives()[k], bool(one));
}
/// Lights of each kind, alone and mixed; points on them, behind them and far away.
TEST(Lanes, HaveTheLightOfSingleEmitters) {
    Emitters emitters;
    Random shapes(5);
    for (int i = 0; i < 12; ++i)
        emitters.add(random_triangle(shapes, i == 0 ? 1e-20 : i == 1 ? 1e6 : i == 2 ? 1e-6 : 1));
    emitters.add(PointLight{"point", {0, 0.5, 0}, {1, 2, 3}});
    emitters.add(SpotLight{"spot", {0, 1, 0}, {0, -1, 0.1}, {4, 4, 4}, 0.1, 0.7});
    emitters.add(DirectionalLight{"sun", {1, -2, 1}, {3, 3, 2}});
    emitters.add(EnvironmentMap(default_sky()));
    for_groups(3000, [&](Random random) {
        const bool alone = random.uniform() < 0.3;
        std::array<std::uint32_t, 4> which;
        for (std::uint32_t& w : which) {
            w = random.uniform() < 0.1 ? no_emitter
                                       : std::uint32_t(random.uniform() * double(emitters.size()));
            if (alone) w = which[0];
        }
        const auto points = four<Vec3f>([&] {
            return random.uniform() < 0.1
                       ? Vec3f(0, 0.5f, 0)
                       : random_point(random, -1, 1) * (random.uniform() < 0.1 ? 1e15f : 2.0f);
        });
        const auto us = four<float>([&] { return float(random.bits() >> 40) * 0x1p-24f; }),
                   vs = four<float>([&] { return float(random.bits() >> 40) * 0x1p-24f; });
        const auto lanes =
            emitters.sample_four([&](int k) { return which[std::size_t(k)]; },
                                 each_vector<FloatLanes>([&](int k) { return points[std::size_t(k)]; }),
                                 FloatLanes::each([&](int k) { return us[std::size_t(k)]; }),
                                 FloatLanes::each([&](int k) { return vs[std::size_t(k)]; }));
        for (std::size_t k = 0; k < 4; ++k)
            expect_same_light(
                lanes, int(k),
                which[k] == no_emitter ? LightSample() : emitters.sample(which[k], points[k], us[k], vs[k]));
    });
}
TEST(Lanes, HaveThePlacesOfSingleDirections) {
    const EnvironmentMap sky(default_sky());
    expect_same<float>("across",
                       [&](auto a, auto b) { return sky.place_of(Vec<decltype(a), 3>(a, b, 1)).across; });
    expect_same<float>("down",
                       [&](auto a, auto b) { return sky.place_of(Vec<decltype(a), 3>(b, a, b)).down; });
}

/// A material of any numbers, some of which mean nothing.
SurfaceMaterial wild_material(Random& random) {
    const std::vector<float> special = numbers<float>();
    const auto number = [&] {
        return random.uniform() < 0.3 ? special[std::size_t(random.uniform() * double(special.size()))]
                                      : float(random.uniform(0, 1.2));
    };
    const auto colour = [&] { return Vec3f(number(), number(), number()); };
    SurfaceMaterial m;
    m.base_colour = colour(), m.specular_colour = colour();
    m.metallic = random.uniform() < 0.5 ? 0 : number(), m.roughness = number();
    m.ior = number() * 2, m.specular = random.uniform() < 0.5 ? 0 : number();
    m.transmission = random.uniform() < 0.5 ? 0 : number(), m.thin = random.uniform() < 0.5;
    return m;
}
/// Surfaces of all kinds, alone and mixed, whose three normals are one, differ, or lie on other sides.
TEST(Lanes, HaveTheScatteringOfSingleSurfaces) {
    const std::vector<scatterings::Surface> known = scatterings::surfaces();
    for_groups(6000, [&](Random random) {
        const bool alone = random.uniform() < 0.3, is_wild = random.uniform() < 0.3;
        const Compensation* tables = random.uniform() < 0.2 ? nullptr : &scatterings::tables();
        const auto direction = [&] { return Vec3f(random.direction<3>()); };
        std::array<SurfacePoint<float>, 4> points;
        for (SurfacePoint<float>& p : points) {
            p.geometric = direction(), p.toward_origin = direction();
            if (dot(p.geometric, p.toward_origin) < 0 && random.uniform() < 0.9) p.geometric = -p.geometric;
            const auto near = [&](double share) {
                return Vec3f(normalized(Vec3d(p.geometric) + Vec3d(direction()) * share));
            };
            p.horizon = random.uniform() < 0.5 ? p.geometric : near(0.3);
            p.shading = random.uniform() < 0.5 ? p.geometric : near(0.5);
            p.front = random.uniform() < 0.5;
            p.material = is_wild ? wild_material(random)
                                 : known[std::size_t(random.uniform() * double(known.size()))].material;
            if (alone) p.material = points[0].material;
        }
        const SurfacePoint<FloatLanes> at =
            points_in_lanes([&](int k) -> const SurfacePoint<float>& { return points[std::size_t(k)]; });
        const PointScattering<FloatLanes> scattering(at, tables);
        const auto directions = four<Vec3f>(direction);
        const auto u = four<Vec3f>([&] { return Vec3f(random.in_cube<3>()); });
        const auto lit =
            scattering.at(each_vector<FloatLanes>([&](int k) { return directions[std::size_t(k)]; }));
        const auto number = [&](int i) {
            return FloatLanes::each([&](int k) { return u[std::size_t(k)][i]; });
        };
        const Departure<FloatLanes> next = scattering.sample(number(0), number(1), number(2));
        for (int k = 0; k < 4; ++k) {
            const auto j = static_cast<std::size_t>(k);
            const PointScattering<float> one(points[j], tables);
            EXPECT_EQ(scattering.only_specular()[k], one.only_specular());
            const ScatteredLight there = one.at(directions[j]);
            EXPECT_TRUE(same(lane(lit.value, k), there.value));
            EXPECT_TRUE(same(lit.density[k], there.density));
            const Departure<float> way = one.sample(u[j][0], u[j][1], u[j][2]);
            ASSERT_EQ(next.exists[k], way.exists);
            if (!way.exists) continue;
            EXPECT_TRUE(same(lane(next.direction, k), way.direction));
            EXPECT_TRUE(same(lane(next.weight, k), way.weight));
            EXPECT_TRUE(same(next.shown[k], way.shown));
            EXPECT_TRUE(same(next.density[k], way.density));
            EXPECT_EQ(next.transmitted[k], way.transmitted);
        }
    });
}

}  // namespace
}  // namespace hedgerow
