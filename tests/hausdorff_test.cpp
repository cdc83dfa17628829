/// Hausdorff distances against those that are known, against dense samples, and against all pairs of points.
#include <gtest/gtest.h>

#include <random>

#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>
#include <hedgerow/scenes/sets.h>

#include "engine.h"
#include "every_structure.h"
#include "generated.h"

using namespace hedgerow;

namespace {

template <class T>
class HausdorffOf : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(HausdorffOf, Scalars);

template <class T>
using Result = Hausdorff<T, 3>;

/// How far apart bounds may be, whatever tolerance is asked for.
template <class T>
double floor_of(double distance, double reach) {
    return std::is_same_v<T, float> ? 0x1p-19 * distance + 0x1p-20 * reach
                                    : 0x1p-45 * distance + 0x1p-42 * reach;
}

/// The greatest distance from points spread over A's triangles (corners included) to B: a lower bound of the
/// distance from A to B, whose points are in double.
template <class T>
double sampled(const TriangleMesh<T>& a, const TriangleMesh<T>& b, int samples) {
    TriangleMesh<double> wide;
    for (const auto& v : b.vertices) wide.vertices.emplace_back(v);
    wide.triangles = b.triangles;
    const auto index = build<Bvh>(wide);
    double farthest2 = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const auto t = a.view().triangle(i);
        const Vec3d p(t.a), q(t.b), r(t.c);
        for (int u = 0; u <= samples; ++u)
            for (int v = 0; u + v <= samples; ++v)
                farthest2 = std::max(farthest2, closest_point(index, p + (q - p) * (double(u) / samples) +
                                                                         (r - p) * (double(v) / samples))
                                                    .distance2);
    }
    return std::sqrt(farthest2);
}

/// The interval is sound: ordered, as narrow as was asked for, and its witnesses are as far apart as it says.
template <class T, class A, class B>
void expect_sound(const Result<T>& found, const A& a, const B& b, const HausdorffOptions& options,
                  double reach) {
    const double lower = static_cast<double>(found.lower), upper = static_cast<double>(found.upper);
    ASSERT_TRUE(found);
    ASSERT_LE(0, lower);
    ASSERT_LE(lower, upper);
    ASSERT_LE(upper - lower,
              std::max({options.absolute, options.relative * lower, floor_of<T>(lower, reach)}) * (1 + 1e-6));
    const double rounding = floor_of<T>(upper, reach);
    ASSERT_NEAR(length(Vec3d(found.point_a) - Vec3d(found.point_b)), lower, rounding);
    const auto on_a = foot_of(found.point_a, a.primitives().closest_point(found.element_a, found.point_a));
    const auto on_b = foot_of(found.point_b, b.primitives().closest_point(found.element_b, found.point_b));
    ASSERT_LE(std::sqrt(static_cast<double>(on_a.distance2)), rounding);
    ASSERT_LE(std::sqrt(static_cast<double>(on_b.distance2)), rounding);
    const double witnessed = found.from_b
                                 ? std::sqrt(static_cast<double>(closest_point(a, found.point_b).distance2))
                                 : std::sqrt(static_cast<double>(closest_point(b, found.point_a).distance2));
    ASSERT_GE(witnessed * (1 + 1e-6) + rounding, lower);
}

template <class T>
double reach_of(const TriangleMesh<T>& a, const TriangleMesh<T>& b) {
    double reach = 0;
    for (const auto* mesh : {&a, &b})
        for (const auto& v : mesh->vertices) reach = std::max(reach, max_component(abs(Vec3d(v))));
    return reach;
}

/// The directed distance, which must be `want`.
template <class T>
void expect_directed(const char* what, const TriangleMesh<T>& a, const TriangleMesh<T>& b, double want,
                     const HausdorffOptions& options = {}) {
    SCOPED_TRACE(what);
    const auto from = build(a), to = build(b);
    const auto found = directed_hausdorff_distance(from, to, options);
    const double reach = reach_of(a, b);
    expect_sound(found, from, to, options, reach);
    const double error = floor_of<T>(want, reach);
    EXPECT_LE(static_cast<double>(found.lower), want + error);
    EXPECT_GE(static_cast<double>(found.upper), want - error);
}

// ---- Distances that are known

TYPED_TEST(HausdorffOf, AVToItsHull) {
    using T = TypeParam;
    // The V is open at the top; the middle of the lid is farthest from it, at height 1 between arms of slope
    // 2: its distance to the line y = 2x is 1/sqrt(5).
    TriangleMesh<T> v, hull;
    v.vertices = {{0, 0, 0}, {0, 0, 4}, {1, 2, 0}, {1, 2, 4}, {-1, 2, 0}, {-1, 2, 4}};
    v.triangles = {{0, 1, 2}, {1, 3, 2}, {0, 4, 1}, {1, 4, 5}};
    hull = v;
    hull.triangles.push_back({2, 3, 4});
    hull.triangles.push_back({3, 5, 4});
    for (const double relative : {0.1, 1e-3, 1e-6}) {
        expect_directed("from the hull", hull, v, 2 / std::sqrt(5), {0, relative});
        expect_directed("from the V", v, hull, 0, {0, relative});
    }
    const auto found = hausdorff_distance(build(v), build(hull), {0, 1e-4});
    EXPECT_TRUE(found.from_b);
    EXPECT_NEAR(static_cast<double>(found.point_b[0]), 0, 1e-3);
    EXPECT_EQ(found.point_b[1], 2);
    EXPECT_GE(found.element_b, 4u);
    EXPECT_NEAR(static_cast<double>(found.lower), 2 / std::sqrt(5), 1e-3);
}

TYPED_TEST(HausdorffOf, TwoTriangulationsOfAQuad) {
    using T = TypeParam;
    TriangleMesh<T> one, other;
    one.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    one.triangles = {{0, 1, 2}, {0, 2, 3}};
    other.vertices = one.vertices;
    other.triangles = {{0, 1, 3}, {1, 2, 3}};
    expect_directed("flat", one, other, 0, {0, 1e-6});
    expect_directed("flat, back", other, one, 0, {0, 1e-6});
    // Bent: the diagonals cross at heights 1/2 and 0, and vertices are shared. The middle of the upper
    // diagonal is farthest from the other side's faces, x + y - 1 = z and its mirror image.
    for (auto* mesh : {&one, &other}) mesh->vertices[0][2] = mesh->vertices[2][2] = 1;
    const double want = 1 / std::sqrt(3);
    expect_directed("bent", one, other, want, {0, 1e-5});
    expect_directed("bent, back", other, one, want, {0, 1e-5});
    EXPECT_NEAR(sampled(one, other, 200), want, 1e-9);
}

TYPED_TEST(HausdorffOf, AMeshAndItself) {
    using T = TypeParam;
    const auto mesh = boulder<T>(600);
    expect_directed("itself", mesh, mesh, 0);
    const auto index = build(mesh);
    EXPECT_EQ(hausdorff_distance(index, index).upper, 0);
    // Each triangle in four, at midpoints: on a lattice these are exact, so the surface is the same.
    auto coarse = mesh;
    for (auto& v : coarse.vertices)
        for (int k = 0; k < 3; ++k) v[k] = std::round(v[k] * 1024) / 1024;
    TriangleMesh<T> fine;
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        const auto t = coarse.view().triangle(i);
        const auto first = static_cast<std::uint32_t>(fine.vertices.size());
        for (const auto& v :
             {t.a, t.b, t.c, (t.a + t.b) * T(0.5), (t.b + t.c) * T(0.5), (t.c + t.a) * T(0.5)})
            fine.vertices.push_back(v);
        for (const auto& [a, b, c] : {TriangleIndices{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}})
            fine.triangles.push_back({first + a, first + b, first + c});
    }
    expect_directed("from the finer", fine, coarse, 0);
    expect_directed("to the finer", coarse, fine, 0);
}
TYPED_TEST(HausdorffOf, SharedTriangles) {
    using T = TypeParam;
    // Every other triangle is B's too, with its corners in another order and other vertices.
    const auto mesh = boulder<T>(600);
    TriangleMesh<T> moved, some, only_moved;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const auto t = mesh.view().triangle(i);
        const Vec<T, 3> by(0, 0, i % 2 == 0 ? T(0) : T(0.0625 * static_cast<double>(i % 7)));
        for (auto* to : {&moved, &only_moved}) {
            if (to == &only_moved && i % 2 == 0) continue;
            const auto first = static_cast<std::uint32_t>(to->vertices.size());
            for (const auto& p : {t.b, t.c, t.a}) to->vertices.push_back(p + by);
            to->triangles.push_back(i % 3 == 0 ? TriangleIndices{first, first + 1, first + 2}
                                               : TriangleIndices{first + 1, first, first + 2});
        }
    }
    const auto from = build(moved), to = build(mesh);
    const HausdorffOptions options{0, 1e-4};
    const auto found = directed_hausdorff_distance(from, to, options);
    const auto want = directed_hausdorff_distance(build(only_moved), to, options);
    expect_sound(found, from, to, options, reach_of(moved, mesh));
    EXPECT_EQ(found.element_a % 2, 1u);
    EXPECT_LE(found.lower, want.upper);
    EXPECT_GE(found.upper, want.lower);
    EXPECT_GT(found.lower, T(0.1));
    // Without those that were moved, the distance is 0; zeros of either sign are equal.
    for (std::size_t i = 0; i < moved.size(); i += 2) some.triangles.push_back(moved.triangles[i]);
    some.vertices = moved.vertices;
    auto signless = mesh, signful = some;
    for (auto& v : signless.vertices) v[2] = T(0);
    for (auto& v : signful.vertices) v[2] = -T(0);
    EXPECT_EQ(directed_hausdorff_distance(build(some), to).upper, 0);
    EXPECT_EQ(directed_hausdorff_distance(build(signful), build(signless)).upper, 0);
    // What was erased from B is not shared.
    auto part = build<Bvh>(mesh);
    for (std::size_t i = 0; i < mesh.size(); i += 2) part.erase(mesh, static_cast<PrimitiveId>(i));
    EXPECT_GT(directed_hausdorff_distance(to, part).lower, T(0.01));
}
TYPED_TEST(HausdorffOf, LargeMeshesFarApart) {
    using T = TypeParam;
    // So far apart that whole blocks of triangles are dropped, in whatever order they come.
    const auto mesh = boulder<T>(6000);
    auto aside = mesh, mixed = mesh;
    for (auto& v : aside.vertices) v = v + Vec<T, 3>(T(0.5), T(0.25), T(1));
    std::shuffle(mixed.triangles.begin(), mixed.triangles.end(), std::mt19937(7));
    const auto from = build(mixed), to = build(aside);
    const double samples = sampled(mesh, aside, 2);
    for (const double relative : {0.1, 1e-3, 1e-5}) {
        const HausdorffOptions options{0, relative};
        const auto found = directed_hausdorff_distance(from, to, options);
        expect_sound(found, from, to, options, reach_of(mixed, aside));
        EXPECT_LE(samples, static_cast<double>(found.upper));
        EXPECT_LE(static_cast<double>(found.lower), samples * 1.01);
        const auto back = directed_hausdorff_distance(to, from, options);
        EXPECT_LE(sampled(aside, mesh, 1), static_cast<double>(back.upper));
    }
}
TYPED_TEST(HausdorffOf, AMovedCube) {
    using T = TypeParam;
    const auto one = cube<T>(300);
    auto moved = one;
    for (auto& v : moved.vertices) v = v + Vec<T, 3>(T(0.25), T(0.5), 0);
    // The corner that is moved farthest out of the cube's box; edges of both are in one plane.
    expect_directed("to", moved, one, std::sqrt(0.3125), {0, 1e-5});
    expect_directed("from", one, moved, std::sqrt(0.3125), {0, 1e-5});
    // Beside each other: from the far faces.
    for (auto& v : moved.vertices) v = v + Vec<T, 3>(0, 3, 0);
    expect_directed("beside", moved, one, std::sqrt(0.0625 + 3.5 * 3.5));
    // Within a larger one: from the larger one's corners, and from the smaller one's faces.
    auto large = one;
    for (auto& v : large.vertices) v = v * T(3);
    expect_directed("out", large, one, 2 * std::sqrt(3), {1e-3, 0});
    expect_directed("in", one, large, 2, {1e-3, 0});
}
TYPED_TEST(HausdorffOf, SamplesAreInTheInterval) {
    using T = TypeParam;
    const auto teapot_mesh = teapot<T>(400), coarse = teapot<T>(100), few = soup<T>(40),
               others = soup<T>(60, 1);
    const std::pair<const TriangleMesh<T>*, const TriangleMesh<T>*> pairs[] = {
        {&teapot_mesh, &coarse}, {&coarse, &teapot_mesh}, {&few, &others}, {&others, &few}, {&few, &coarse}};
    for (const auto& [a, b] : pairs) {
        const double samples = sampled(*a, *b, 20);
        for (const double relative : {0.3, 1e-2, 1e-4}) {
            const HausdorffOptions options{0, relative};
            const auto from = build(*a), to = build(*b);
            const auto found = directed_hausdorff_distance(from, to, options);
            expect_sound(found, from, to, options, reach_of(*a, *b));
            EXPECT_LE(samples, static_cast<double>(found.upper));
            // The samples are dense: the farthest point is near one of them.
            EXPECT_LE(static_cast<double>(found.lower), samples * 1.2);
        }
    }
}
TYPED_TEST(HausdorffOf, FarFromTheOrigin) {
    using T = TypeParam;
    auto one = cube<T>(12), other = cube<T>(300);
    for (auto* mesh : {&one, &other})
        for (auto& v : mesh->vertices) v = v + Vec<T, 3>(4096, -4096, 1024);
    for (auto& v : other.vertices) v[0] += T(0.5);
    expect_directed("moved by a half", one, other, 0.5, {0, 1e-2});
    expect_directed("moved by a half, back", other, one, 0.5, {0, 1e-2});
    // The distance is precise all the same: no triangle needs to be divided.
    const auto found = directed_hausdorff_distance(build(one), build(other), {0, 1e-6});
    EXPECT_GE(static_cast<double>(found.lower), 0.5 - 1e-6);
}
TYPED_TEST(HausdorffOf, HugeAndTinyMeshes) {
    using T = TypeParam;
    constexpr int most = std::is_same_v<T, float> ? 56 : 470;
    for (const int exponent : {most, -most}) {
        const T scale = std::ldexp(T(1), exponent);
        auto one = soup<T>(30), other = soup<T>(30, 2);
        const auto want = directed_hausdorff_distance(build(one), build(other), {0, 1e-2});
        for (auto* mesh : {&one, &other})
            for (auto& v : mesh->vertices) v = v * scale;
        const auto found = directed_hausdorff_distance(build(one), build(other), {0, 1e-2});
        ASSERT_TRUE(std::isfinite(found.upper));
        if (exponent > 0) {
            EXPECT_NEAR(static_cast<double>(found.lower / scale), static_cast<double>(want.lower), 1e-5);
            EXPECT_NEAR(static_cast<double>(found.upper / scale), static_cast<double>(want.upper), 1e-5);
        } else {
            // Squares of distances underflow: the bounds are wider, but they are bounds.
            EXPECT_LE(static_cast<double>(found.lower / scale), static_cast<double>(want.upper));
            EXPECT_GE(static_cast<double>(found.upper / scale), static_cast<double>(want.lower));
        }
    }
}
TYPED_TEST(HausdorffOf, TrianglesWithoutArea) {
    using T = TypeParam;
    TriangleMesh<T> point, needle, plate;
    point.vertices = {{1, 2, 3}};
    point.triangles = {{0, 0, 0}, {0, 0, 0}};
    needle.vertices = {{0, 0, 0}, {2, 0, 0}, {1, 0, 0}};
    needle.triangles = {{0, 1, 2}, {0, 0, 1}};
    plate.vertices = {{0, -1, 1}, {2, -1, 1}, {0, 1, 1}, {2, 1, 1}};
    plate.triangles = {{0, 1, 2}, {1, 3, 2}};
    expect_directed("needle to point", needle, point, std::sqrt(14));
    expect_directed("point to needle", point, needle, std::sqrt(13));
    expect_directed("needle to plate", needle, plate, 1);
    expect_directed("plate to needle", plate, needle, std::sqrt(2));
    expect_directed("point to itself", point, point, 0);
    expect_directed("needle to itself", needle, needle, 0);
}
TYPED_TEST(HausdorffOf, EmptySets) {
    using T = TypeParam;
    const auto none = build(TriangleMesh<T>());
    const auto some = build(cube<T>(12));
    const auto cloud = build(PointCloud<T, 3>());
    constexpr T infinity = std::numeric_limits<T>::infinity();
    for (const auto& found :
         {directed_hausdorff_distance(none, some), hausdorff_distance(none, none),
          directed_hausdorff_distance(cloud, some), directed_hausdorff_distance(none, none)}) {
        EXPECT_FALSE(found);
        EXPECT_EQ(found.lower, 0);
        EXPECT_EQ(found.upper, 0);
    }
    for (const auto& found : {directed_hausdorff_distance(some, none), hausdorff_distance(some, none),
                              hausdorff_distance(none, some), directed_hausdorff_distance(some, cloud)}) {
        EXPECT_FALSE(found);
        EXPECT_EQ(found.lower, infinity);
        EXPECT_EQ(found.upper, infinity);
    }
}
TYPED_TEST(HausdorffOf, BadTolerances) {
    using T = TypeParam;
    const auto index = build(cube<T>(12));
    EXPECT_THROW(hausdorff_distance(index, index, {-1, 0}), UsageError);
    EXPECT_THROW(hausdorff_distance(index, index, {0, std::nan("")}), UsageError);
    EXPECT_THROW(directed_hausdorff_distance(index, index, {0, -0.5}), UsageError);
}
TYPED_TEST(HausdorffOf, ALimitOfPartsGivesAWiderInterval) {
    using T = TypeParam;
    // The lid of a trough, whose two triangles are the farthest of all.
    TriangleMesh<T> trough, lid;
    trough.vertices = {{0, 0, 0}, {0, 0, 4}, {1, 2, 0}, {1, 2, 4}, {-1, 2, 0}, {-1, 2, 4}};
    trough.triangles = {{0, 1, 2}, {1, 3, 2}, {0, 4, 1}, {1, 4, 5}};
    lid = trough;
    lid.triangles = {{2, 3, 4}, {3, 5, 4}};
    const auto precise = directed_hausdorff_distance(build(lid), build(trough), {0, 1e-6});
    const auto limited = directed_hausdorff_distance(build(lid), build(trough), {0, 1e-6, 0});
    EXPECT_LE(limited.lower, precise.upper);
    EXPECT_GE(limited.upper, precise.lower);
    EXPECT_GT(limited.upper - limited.lower, T(0.01));
    EXPECT_LT(precise.upper - precise.lower, T(0.0001));
}

// ---- Clouds

template <class A, class B>
double of_all_pairs(const A& a, const B& b) {
    double farthest = 0;
    for (const auto& p : a.points) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const auto& q : b.points)
            nearest = std::min(nearest, length(Vec<double, A::dimension>(p) - Vec<double, A::dimension>(q)));
        farthest = std::max(farthest, nearest);
    }
    return farthest;
}
template <class Cloud>
void expect_clouds(const Cloud& a, const Cloud& b) {
    using T = typename Cloud::Scalar;
    const double to = of_all_pairs(a, b), from = of_all_pairs(b, a),
                 error = floor_of<T>(std::max(to, from), 1);
    const auto other = build(b);
    for_each_index(a, [&](const char* name, const auto& index) {
        const auto found = directed_hausdorff_distance(index, other, {0, 0});
        ASSERT_LE(static_cast<double>(found.upper - found.lower), error) << name;
        ASSERT_LE(static_cast<double>(found.lower), to) << name;
        ASSERT_GE(static_cast<double>(found.upper), to) << name;
        const auto both = hausdorff_distance(index, other);
        ASSERT_LE(static_cast<double>(both.lower), std::max(to, from)) << name;
        ASSERT_GE(static_cast<double>(both.upper), std::max(to, from)) << name;
        ASSERT_LE(static_cast<double>(both.upper - both.lower), error) << name;
        ASSERT_EQ(both.from_b, from > to) << name;
    });
}
TYPED_TEST(HausdorffOf, CloudsAsAllPairs) {
    using T = TypeParam;
    expect_clouds(points<T>(500), points<T>(300, 1));
    expect_clouds(points2d<T>(300), points2d<T>(500, 1));
    auto sparse = points<T>(500);
    for (auto& p : sparse.points) p = p * T(0.5);
    expect_clouds(points<T>(500), sparse);
}
TYPED_TEST(HausdorffOf, ACloudAndAMesh) {
    using T = TypeParam;
    const auto mesh = cube<T>(100);
    PointCloud<T, 3> cloud;
    cloud.points = mesh.vertices;
    const auto of_mesh = build(mesh);
    const auto of_cloud = build(cloud);
    EXPECT_LE(static_cast<double>(directed_hausdorff_distance(of_cloud, of_mesh).upper), floor_of<T>(0, 1));
    // The center of a square of the mesh's lattice is farthest from its corners.
    const auto found = directed_hausdorff_distance(of_mesh, of_cloud, {0, 1e-5});
    double edge = 2;
    for (const auto& v : mesh.vertices)
        if (v[0] > -1) edge = std::min(edge, static_cast<double>(v[0]) + 1);
    EXPECT_NEAR(static_cast<double>(found.lower), edge / std::sqrt(2), 1e-4);
    EXPECT_NEAR(static_cast<double>(found.upper), edge / std::sqrt(2), 1e-4);
    const auto both = hausdorff_distance(of_cloud, of_mesh, {0, 1e-5});
    EXPECT_TRUE(both.from_b);
    EXPECT_LE(both.lower, found.upper);
    EXPECT_GE(both.upper, found.lower);
}

// ---- Structures and threads

TYPED_TEST(HausdorffOf, StructuresAndThreadsAgree) {
    using T = TypeParam;
    const auto a = soup<T>(400), b = soup<T>(300, 1);
    const HausdorffOptions options{.absolute = 0, .relative = 1e-2, .threads = serial_executor()};
    const auto want = directed_hausdorff_distance(build(a), build(b), options);
    for_each_index(b, [&](const char* name, const auto& index) {
        // Only ties of distances may differ, between elements that share corners; the soup has none.
        EXPECT_EQ(directed_hausdorff_distance(build<BruteForce>(a), index, options), want) << name;
    });
    const ThreadLimit limit(2);
    const auto large = boulder<T>(20000), other = boulder<T>(10000);
    const auto from = build(large), to = build(other);
    EXPECT_EQ(hausdorff_distance(from, to, {.threads = serial_executor()}),
              hausdorff_distance(from, to, {.threads = default_executor()}));
    const auto on_all = hausdorff_distance(from, to, {0, 1e-4});
    for (const auto name : instruction_sets()) {
        const Using use(name);
        EXPECT_EQ(hausdorff_distance(from, to, {0, 1e-4}), on_all) << name;
    }
}
TYPED_TEST(HausdorffOf, WhatWasErasedDoesNotCount) {
    using T = TypeParam;
    auto mesh = cube<T>(12);
    const auto part = build(cube<T>(12));
    mesh.vertices.push_back({9, 9, 9});
    mesh.vertices.push_back({70, 70, 70});  // of no triangle
    mesh.triangles.push_back({0, 1, 8});
    auto index = build<Bvh>(mesh);
    EXPECT_GT(directed_hausdorff_distance(index, part).lower, 10);
    EXPECT_LT(directed_hausdorff_distance(index, part).upper, 20);
    index.erase(mesh, 12);
    EXPECT_LE(static_cast<double>(directed_hausdorff_distance(index, part).upper), floor_of<T>(0, 1));
}

// ---- Properties

template <class T>
void expect_properties() {
    generated::expect_always([] {
        const auto a = generated::any_set<TriangleMesh<T>>(false),
                   b = generated::any_set<TriangleMesh<T>>(false);
        RC_PRE(a.size() > 0 && b.size() > 0);
        const auto from = build(a), to = build(b);
        const HausdorffOptions options{0.05, 0};
        const auto there = directed_hausdorff_distance(from, to, options),
                   back = directed_hausdorff_distance(to, from, options),
                   both = hausdorff_distance(from, to, options);
        const auto width = [](const Hausdorff<T, 3>& h) { return static_cast<double>(h.upper - h.lower); };
        RC_ASSERT(width(there) <= 0.0501 && width(back) <= 0.0501 && width(both) <= 0.0501);
        // The interval has the samples below it, and the samples are dense.
        const double samples = sampled(a, b, 8);
        RC_ASSERT(samples <= static_cast<double>(there.upper));
        RC_ASSERT(static_cast<double>(there.lower) <= samples + 8 * std::sqrt(3) / 8);
        // The symmetric distance is the greater of both.
        RC_ASSERT(both.lower <= std::max(there.upper, back.upper));
        RC_ASSERT(both.upper >= std::max(there.lower, back.lower));
        const auto turned = hausdorff_distance(to, from, options);
        RC_ASSERT(turned.lower <= both.upper && both.lower <= turned.upper);
    });
}
TEST(HausdorffProperties, OfFloats) {
    expect_properties<float>();
}
TEST(HausdorffProperties, OfDoubles) {
    expect_properties<double>();
}

}  // namespace
