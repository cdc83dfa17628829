/// Crossings, self-intersections and least distances by every structure, against all pairs in rational
/// arithmetic.
#include <gtest/gtest.h>

#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>
#include <hedgerow/scenes/sets.h>

#include "cubes.h"
#include "every_structure.h"
#include "exact.h"
#include "rational_triangles.h"

using namespace hedgerow;

namespace {

template <class T>
class Pairs : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Pairs, Scalars);

using PairList = std::vector<ElementPair>;

// ---- Oracles: all pairs, in rational numbers

template <class T>
PairList all_crossings(const TriangleMesh<T>& a, const TriangleMesh<T>& b) {
    PairList found;
    for (PrimitiveId i = 0; i < a.size(); ++i)
        for (PrimitiveId j = 0; j < b.size(); ++j) {
            const auto s = a.view().triangle(i), t = b.view().triangle(j);
            if (overlap(s.bounds(), t.bounds()) && rational::meet(s, t)) found.push_back({i, j});
        }
    return found;
}
template <class T>
PairList all_self_intersections(const TriangleMesh<T>& mesh) {
    PairList found;
    for (PrimitiveId i = 0; i < mesh.size(); ++i)
        for (PrimitiveId j = i + 1; j < mesh.size(); ++j) {
            const auto s = mesh.view().triangle(i), t = mesh.view().triangle(j);
            if (overlap(s.bounds(), t.bounds()) && rational::meet_beyond_shared(s, t))
                found.push_back({i, j});
        }
    return found;
}

/// Compares every structure over `mesh` and `other` with the oracles.
template <class T>
void expect_pairs(const char* scene, const TriangleMesh<T>& mesh, const TriangleMesh<T>& other) {
    SCOPED_TRACE(scene);
    const auto self = all_self_intersections(mesh), crossings = all_crossings(mesh, other);
    const auto bvh = build<Bvh>(other);
    const auto nearest = minimum_distance(build<BruteForce>(mesh), build<BruteForce>(other));
    EXPECT_EQ(nearest.distance2 == 0, !crossings.empty());
    if (!crossings.empty()) {
        EXPECT_EQ((ElementPair{nearest.element_a, nearest.element_b}), crossings[0]);
    }
    for_each_index(mesh, [&](const char* name, const auto& index) {
        PairList found;
        EXPECT_EQ(self_intersections(index, found), self.size()) << name;
        EXPECT_EQ(found, self) << name;
        EXPECT_EQ(any_self_intersection(index), !self.empty()) << name;
        EXPECT_EQ(crossing_pairs(index, bvh, found), crossings.size()) << name;
        EXPECT_EQ(found, crossings) << name;
        EXPECT_EQ(any_crossing(bvh, index), !crossings.empty()) << name;
        EXPECT_EQ(minimum_distance(index, bvh), nearest) << name;
    });
}

// ---- Scenes

/// Triangles with corners of small integers times 2^exponent: many share corners, touch or have no area.
template <class T>
TriangleMesh<T> lattice_soup(std::size_t count, int reach, std::uint64_t seed, int exponent = 0) {
    Random random(26, seed);
    TriangleMesh<T> mesh;
    for (std::uint32_t i = 0; i < count; ++i) {
        for (int k = 0; k < 3; ++k) mesh.vertices.push_back(exact::integers<T, 3>(random, reach, exponent));
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

TYPED_TEST(Pairs, OfSoupsOnSmallIntegers) {
    using T = TypeParam;
    constexpr int most = std::is_same_v<T, float> ? 56 : 476;
    expect_pairs("crowded", lattice_soup<T>(60, 2, 1), lattice_soup<T>(40, 2, 2));
    expect_pairs("sparse", lattice_soup<T>(150, 6, 3), lattice_soup<T>(100, 6, 4));
    expect_pairs("huge", lattice_soup<T>(30, 4, 5, most), lattice_soup<T>(20, 4, 6, most));
    expect_pairs("tiny", lattice_soup<T>(30, 4, 7, -most), lattice_soup<T>(20, 4, 8, -most));
}
TYPED_TEST(Pairs, OfTouchingAndOverlappingCubes) {
    using T = TypeParam;
    using V = Vec<T, 3>;
    const auto one = cube_at<T>(V(0, 0, 0), 2);
    PairList found;
    EXPECT_EQ(self_intersections(build(one), found), 0u);
    expect_pairs("at a face", one, cube_at<T>(V(2, 0, 0), 2));
    expect_pairs("at a part of a face", one, cube_at<T>(V(2, 1, 1), 2));
    expect_pairs("at an edge", one, cube_at<T>(V(2, 2, 0), 2));
    expect_pairs("at a corner", one, cube_at<T>(V(2, 2, 2), 2));
    expect_pairs("in each other", one, cube_at<T>(V(1, 1, 1), 2));
    expect_pairs("inside", one, cube_at<T>(V(T(0.5), T(0.5), T(0.5)), 1));
    expect_pairs("apart", one, cube_at<T>(V(5, 6, 7), 2));
    expect_pairs("joined", joined(one, cube_at<T>(V(2, 0, 0), 2)), joined(one, cube_at<T>(V(1, 0, 0), 2)));
}
TYPED_TEST(Pairs, OfFoldsAndPlanes) {
    using T = TypeParam;
    TriangleMesh<T> folded;  // a strip of paper, folded twice: its third part lies on its first
    folded.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, T(0.5), 0}, {0, T(1.5), 0}};
    folded.triangles = {{0, 1, 2}, {1, 3, 2}, {1, 3, 4}, {3, 5, 4}};
    PairList found;
    EXPECT_EQ(self_intersections(build(folded), found), 4u);
    expect_pairs("folded", folded, lattice_soup<T>(20, 1, 9));
    auto flat = lattice_soup<T>(50, 5, 10), other = lattice_soup<T>(30, 5, 11);
    for (auto* mesh : {&flat, &other})
        for (auto& v : mesh->vertices) v[2] = v[0] + v[1];
    expect_pairs("coplanar", flat, other);
    const auto teapot_mesh = teapot<T>(150);
    auto moved = teapot_mesh;
    for (auto& v : moved.vertices) v[0] += T(0.5);
    expect_pairs("teapot", teapot_mesh, moved);
}
TYPED_TEST(Pairs, OfNothingAndOfOneTriangle) {
    using T = TypeParam;
    const TriangleMesh<T> none;
    const auto one = lattice_soup<T>(1, 3, 12);
    expect_pairs("none", none, one);
    expect_pairs("one", one, one);
    expect_pairs("nothing to meet", one, none);
    EXPECT_FALSE(minimum_distance(build(none), build(one)));
}
TYPED_TEST(Pairs, AreTheSameForAnyNumberOfThreads) {
    using T = TypeParam;
    const auto mesh = soup<T>(20000);
    auto moved = mesh;
    for (auto& v : moved.vertices) v[0] += T(0.01);
    const auto a = build(mesh), b = build(moved);
    PairList serial, parallel;
    const ThreadLimit limit(2);
    self_intersections(a, serial, {.threads = serial_executor()});
    self_intersections(a, parallel, {.threads = default_executor()});
    EXPECT_EQ(serial, parallel);
    EXPECT_FALSE(serial.empty());
    crossing_pairs(a, b, serial, {.threads = serial_executor()});
    crossing_pairs(a, b, parallel);
    EXPECT_EQ(serial, parallel);
    EXPECT_FALSE(serial.empty());
}

// ---- Distances

TYPED_TEST(Pairs, AreAsFarApartAsInExactArithmetic) {
    using T = TypeParam;
    Random random(26, 13);
    for (int i = 0; i < 3000; ++i) {
        // Integers, corners anywhere, and slivers; near each other and far.
        const auto corner = [&](int offset) {
            if (i % 3 == 0) return exact::integers<T, 3>(random, 3) + Vec<T, 3>(T(offset), 0, 0);
            Vec<T, 3> v(random.direction<3>() * random.uniform());
            if (i % 3 == 2) v[1] = v[0] * T(0.3) + v[1] * T(1e-4);
            return v + Vec<T, 3>(T(offset), 0, 0);
        };
        const int offset = i % 7 == 0 ? 1000 : i % 4;
        const Triangle<T, 3> a{corner(0), corner(0), corner(0)};
        const Triangle<T, 3> b{corner(offset), corner(offset), corner(offset)};
        const double want = rational::distance2(a, b).get_d();
        const auto gap = closest_points(a, b);
        const double error = (std::is_same_v<T, float> ? 0x1p-22 : 0x1p-48) * std::sqrt(want);
        ASSERT_NEAR(std::sqrt(static_cast<double>(gap.distance2)), std::sqrt(want),
                    error + 0x1p-48 * (4 + offset))
            << i;
        ASSERT_EQ(gap.distance2 == 0,
                  triangles_meet({Vec3d(a.a), Vec3d(a.b), Vec3d(a.c)}, {Vec3d(b.a), Vec3d(b.b), Vec3d(b.c)}))
            << i;
        // The points are on the triangles and as far apart, but for their own rounding.
        const double rounding = (std::is_same_v<T, float> ? 0x1p-21 : 0x1p-48) * (4 + offset);
        ASSERT_LE(std::sqrt(static_cast<double>(closest_point(gap.a, a).distance2)), rounding) << i;
        ASSERT_LE(std::sqrt(static_cast<double>(closest_point(gap.b, b).distance2)), rounding) << i;
        ASSERT_NEAR(length(Vec3d(gap.a) - Vec3d(gap.b)), std::sqrt(want), rounding) << i;
    }
}
template <class A, class B>
void expect_distances(const char* name, const A& a, const B& b) {
    SCOPED_TRACE(name);
    using T = typename A::Scalar;
    const auto oracle = build<BruteForce>(b);
    const auto want = minimum_distance(build<BruteForce>(a), oracle);
    EXPECT_TRUE(want);
    for_each_index(a, [&](const char* of_a, const auto& index) {
        Visits visits;
        EXPECT_EQ(minimum_distance(index, oracle), want) << of_a;
        EXPECT_EQ(minimum_distance(index, build(b), {}, visits), want) << of_a;
        EXPECT_EQ(minimum_distance(index, oracle, {.radius2 = want.distance2}), want) << of_a;
        const T radius = std::sqrt(want.distance2);
        EXPECT_EQ(minimum_distance(index, oracle, {.radius = radius * T(1.0001)}), want) << of_a;
        EXPECT_FALSE(minimum_distance(index, oracle, {.radius = -1})) << of_a;
        EXPECT_FALSE(minimum_distance(index, oracle, {.radius = std::numeric_limits<T>::quiet_NaN()}))
            << of_a;
        const auto about = minimum_distance(index, oracle, {.factor = T(1.5)});
        EXPECT_GE(about.distance2, want.distance2) << of_a;
        EXPECT_LE(about.distance2, want.distance2 * T(2.2501)) << of_a;
        EXPECT_THROW(minimum_distance(index, oracle, {.factor = T(0.5)}), InputError);
        if (want.distance2 > 0) {
            EXPECT_FALSE(minimum_distance(index, oracle, {.radius = radius * T(0.9999)})) << of_a;
            EXPECT_FALSE(minimum_distance(index, oracle, {.radius2 = std::nextafter(want.distance2, T(0))}))
                << of_a;
        }
    });
}
TYPED_TEST(Pairs, DistancesOfSetsAreThoseOfAllPairs) {
    using T = TypeParam;
    auto mesh = soup<T>(300);
    auto cloud = points<T>(400);
    expect_distances("soups", mesh, soup<T>(200));
    expect_distances("points and a soup", cloud, mesh);
    for (auto& v : mesh.vertices) v = v * T(0.1) + Vec<T, 3>(T(0.3), T(2), T(0.4));
    expect_distances("a soup beside", mesh, soup<T>(200));
    expect_distances("a soup beside points", mesh, cloud);
    auto far = points<T>(300);
    for (auto& p : far.points) p[0] += T(100);
    expect_distances("points", cloud, far);
    expect_distances("equal cubes", cube_at<T>(Vec<T, 3>(0, 0, 0), 1), cube_at<T>(Vec<T, 3>(4, 0, 0), 1));
}

}  // namespace
