/// Sides, winding numbers and signed distances by every structure, against sums of solid angles in long
/// double.
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include <hedgerow/any_structure.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/generate.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>
#include <hedgerow/scenes/sets.h>

#include "cubes.h"
#include "engine.h"
#include "exact.h"
#include "generated.h"
#include "rational_triangles.h"

using namespace hedgerow;

namespace {

template <class T>
class Insides : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Insides, Scalars);

// ---- Oracles

using Long = long double;

/// The solid angle of a triangle over 4π (Van Oosterom and Strackee 1983), or the angle of a segment over 2π.
template <class T>
Long turns_of(const std::array<Vec<T, 3>, 3>& t, const Vec<T, 3>& q) {
    Long p[3][3], l[3];
    for (std::size_t i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) p[i][k] = Long(t[i][k]) - Long(q[k]);
        l[i] = std::sqrt(p[i][0] * p[i][0] + p[i][1] * p[i][1] + p[i][2] * p[i][2]);
    }
    const auto dots = [&](int i, int j) { return p[i][0] * p[j][0] + p[i][1] * p[j][1] + p[i][2] * p[j][2]; };
    const Long volume = p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) +
                        p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
                        p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
    const Long rest = l[0] * l[1] * l[2] + dots(0, 1) * l[2] + dots(1, 2) * l[0] + dots(2, 0) * l[1];
    return std::atan2(volume, rest) / (2 * std::numbers::pi_v<Long>);
}
template <class T>
Long turns_of(const std::array<Vec<T, 2>, 2>& s, const Vec<T, 2>& q) {
    const Long ax = Long(s[0][0]) - Long(q[0]), ay = Long(s[0][1]) - Long(q[1]);
    const Long bx = Long(s[1][0]) - Long(q[0]), by = Long(s[1][1]) - Long(q[1]);
    return std::atan2(ax * by - ay * bx, ax * bx + ay * by) / (2 * std::numbers::pi_v<Long>);
}
template <class P, class V>
Long sum_of_turns(const P& set, const V& q) {
    Long sum = 0;
    for (std::size_t i = 0; i < set.size(); ++i) sum += turns_of(set.view().corners(i), q);
    return sum;
}

// ---- Scenes

/// A ball of `rings` rings of twice as many vertices.
template <class T>
TriangleMesh<T> ball(std::uint32_t rings) {
    const std::uint32_t around = 2 * rings, top = rings * around, bottom = top + 1;
    TriangleMesh<T> mesh;
    for (std::uint32_t i = 0; i < rings; ++i)
        for (std::uint32_t k = 0; k < around; ++k) {
            const double down = std::numbers::pi * (i + 1) / (rings + 1), turn = std::numbers::pi * k / rings;
            const Vec3d p(std::sin(down) * std::cos(turn), std::sin(down) * std::sin(turn), std::cos(down));
            mesh.vertices.emplace_back(p);
        }
    mesh.vertices.push_back({0, 0, 1});
    mesh.vertices.push_back({0, 0, -1});
    for (std::uint32_t k = 0; k < around; ++k) {
        const std::uint32_t next = (k + 1) % around;
        mesh.triangles.push_back({top, k, next});
        for (std::uint32_t i = 0; i + 1 < rings; ++i) {
            const std::uint32_t above = i * around, below = above + around;
            mesh.triangles.push_back({above + k, below + k, below + next});
            mesh.triangles.push_back({above + k, below + next, above + next});
        }
        mesh.triangles.push_back({bottom, top - around + next, top - around + k});
    }
    return mesh;
}
template <class T>
TriangleMesh<T> turned(TriangleMesh<T> mesh) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}
template <class T>
TriangleMesh<T> scene(const char* spec) {
    return std::get<TriangleMesh<T>>(generate<T>(parse_scene_spec(spec)));
}
/// A closed surface on a lattice of integers times 2^exponent, which crosses itself: the boundaries of
/// tetrahedra, whose common faces cancel or are doubled.
template <class T>
TriangleMesh<T> tetrahedra(std::size_t count, int reach, std::uint64_t seed, int exponent = 0) {
    Random random(28, seed);
    TriangleMesh<T> mesh;
    for (std::uint32_t i = 0; i < 4 * count; i += 4) {
        for (int k = 0; k < 4; ++k) mesh.vertices.push_back(exact::integers<T, 3>(random, reach, exponent));
        for (const TriangleIndices t : {TriangleIndices{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}})
            mesh.triangles.push_back({i + t[0], i + t[1], i + t[2]});
    }
    return mesh;
}
/// Closed polygons on a lattice.
template <class T>
SegmentSet<T> polygons(std::size_t count, int reach, std::uint64_t seed, int exponent = 0) {
    Random random(28, seed);
    SegmentSet<T> set;
    for (std::size_t i = 0; i < count; ++i) {
        std::vector<Vec<T, 2>> corners;
        for (std::size_t k = 0; k < 3 + i % 4; ++k)
            corners.push_back(exact::integers<T, 2>(random, reach, exponent));
        for (std::size_t k = 0; k < corners.size(); ++k)
            set.segments.push_back({corners[k], corners[(k + 1) % corners.size()]});
    }
    return set;
}

/// Points around a set: anywhere, level with corners along some axes, corners, middles of sides.
template <class P>
auto queries_around(const P& set, std::size_t count, std::uint64_t seed) {
    using T = typename P::Scalar;
    constexpr int D = P::dimension;
    Random random(29, seed);
    const auto corner = [&] {
        const auto c = set.view().corners(random.bits() % set.size());
        return c[random.bits() % c.size()];
    };
    Box<T, D> box;
    for (std::size_t i = 0; i < set.size(); ++i) box.expand(set.view().bounds(i));
    std::vector<Vec<T, D>> points;
    while (points.size() < count) {
        Vec<T, D> p;
        for (int k = 0; k < D; ++k)
            p[k] = box.low[k] + (box.high[k] - box.low[k]) * T(random.uniform() * 1.2 - 0.1);
        const auto kind = random.bits() % 8;
        for (int k = 0; k < D; ++k)
            if (kind >> k & 1u) p[k] = corner()[k];
        if (kind == 7) p = corner() * T(0.5) + corner() * T(0.5);
        points.push_back(p);
    }
    return points;
}

/// Compares every structure over a set with sums of angles. Where the sum is in doubt, as next to the
/// surface, only equality among structures is asked.
template <class P>
void expect_insides(const char* scene, const P& set, std::size_t count = 300) {
    SCOPED_TRACE(scene);
    using T = typename P::Scalar;
    constexpr int D = P::dimension;
    const auto points = queries_around(set, count, 1);
    const auto oracle = build<AnyStructure>(set, {"brute-force"});
    const Solid of_oracle(oracle);
    std::vector<Side> want_sides(points.size());
    std::vector<double> want_numbers(points.size());
    std::vector<T> want_distances(points.size());
    sides(of_oracle, points, std::span(want_sides));
    winding_numbers(of_oracle, points, std::span(want_numbers));
    signed_distances(of_oracle, points, std::span(want_distances));
    for (std::size_t i = 0; i < points.size(); ++i) {
        const T near = std::sqrt(closest_point(oracle, points[i]).distance2);
        const bool on = want_sides[i] == Side::on;
        ASSERT_EQ(std::abs(want_distances[i]), on ? T(0) : near) << i;
        ASSERT_FALSE(std::signbit(want_distances[i]) && want_sides[i] != Side::inside) << i;
        ASSERT_EQ(want_distances[i] < 0, want_sides[i] == Side::inside && near > 0) << i;
        if (on) continue;
        const double sum = static_cast<double>(sum_of_turns(set, points[i]));
        ASSERT_NEAR(want_numbers[i], sum, 1e-9) << i;
        if (of_oracle.boundary().open.empty()) {
            ASSERT_EQ(want_numbers[i], std::round(sum)) << i;
            ASSERT_EQ(want_sides[i] == Side::inside, want_numbers[i] != 0) << i;
        } else {
            ASSERT_EQ(want_sides[i] == Side::inside, want_numbers[i] >= 0.5) << i;
        }
    }
    // Any solid, in a batch and, where visits are counted, one point at a time.
    std::vector<Visits> counted(points.size());
    for (const char* spec : matrix::structures) {
        const std::string name = matrix::named_for<P>(spec);
        const auto index = build_any(name, set);
        const auto& solid = index->solid();
        EXPECT_EQ(solid.closed(), of_oracle.closed());
        EXPECT_EQ(solid.oriented(), of_oracle.oriented());
        for (const std::span<Visits> visits : {std::span<Visits>(), std::span(counted)}) {
            std::vector<Side> found(points.size());
            std::vector<double> numbers(points.size());
            std::vector<T> distances(points.size());
            sides(solid, points, found, {}, visits);
            winding_numbers(solid, points, numbers, {}, visits);
            signed_distances(solid, points, distances, {}, visits);
            ASSERT_EQ(found, want_sides) << name;
            ASSERT_EQ(numbers, want_numbers) << name;
            ASSERT_EQ(distances, want_distances) << name;
        }
    }
    // Every kernel.
    if constexpr (D == 3)
        for_each_kernel(set, [&](const auto& index, std::string_view) {
            const Solid solid(index);
            for (std::size_t i = 0; i < points.size(); ++i) {
                ASSERT_EQ(side(solid, points[i]), want_sides[i]) << "point " << i;
                ASSERT_EQ(winding_number(solid, points[i]), want_numbers[i]) << "point " << i;
                const SignedDistance<T, D> d = closest_side(solid, points[i]);
                ASSERT_EQ(d.distance, want_distances[i]) << "point " << i;
                ASSERT_EQ(d.near, closest_point(oracle, points[i])) << "point " << i;
            }
            std::vector<Side> found(points.size());
            sides(solid, points, std::span(found));
            EXPECT_EQ(found, want_sides);
            std::vector<double> numbers(points.size());
            winding_numbers(solid, points, std::span(numbers));
            EXPECT_EQ(numbers, want_numbers);
        });
}

TYPED_TEST(Insides, OfClosedMeshes) {
    using T = TypeParam;
    using V = Vec<T, 3>;
    const auto cube = cube_at<T>(V(0, 0, 0), 4);
    expect_insides("cube", cube);
    expect_insides("inside out", turned(cube));
    expect_insides("overlapping", joined(cube, cube_at<T>(V(1, 2, 3), 4)));
    expect_insides("hollow", joined(cube, turned(cube_at<T>(V(1, 1, 1), 2))));
    expect_insides("touching", joined(cube, cube_at<T>(V(4, 0, 0), 4)));
    expect_insides("coincident", joined(cube, cube));
    expect_insides("cancelling", joined(cube, turned(cube)));
    expect_insides("boulder", scene<T>("gen:boulder:1000"));
}
TYPED_TEST(Insides, OfTetrahedraOnALattice) {
    using T = TypeParam;
    constexpr int most = std::is_same_v<T, float> ? 56 : 476;
    expect_insides("sparse", tetrahedra<T>(20, 8, 1));
    expect_insides("crowded", tetrahedra<T>(40, 2, 2));
    expect_insides("huge", tetrahedra<T>(10, 3, 3, most));
    expect_insides("tiny", tetrahedra<T>(10, 3, 4, -most));
}
/// A ball whose vertices lie on a lattice, so that queries are level with many of them, or on the surface.
TYPED_TEST(Insides, OfManyPointsLevelWithVertices) {
    using T = TypeParam;
    auto mesh = ball<T>(8);
    for (auto& v : mesh.vertices)
        for (int k = 0; k < 3; ++k) v[k] = std::round(v[k] * 8);
    const auto index = build(mesh);
    const Solid solid(index);
    ASSERT_TRUE(solid.closed() && solid.oriented());
    Random random(30, 1);
    const std::size_t count = in_long_runs(10'000'000, 20'000);
    std::size_t on = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const auto p = exact::integers<T, 3>(random, 20) * T(0.5);
        const Side where = side(solid, p);
        if (where == Side::on) {
            ASSERT_LT(closest_point(index, p).distance2, T(1e-12));
            ++on;
            continue;
        }
        ASSERT_GT(closest_point(index, p).distance2, T(1e-12));
        const double sum = static_cast<double>(sum_of_turns(mesh, p));
        ASSERT_EQ(winding_number(solid, p), std::round(sum)) << i;
        ASSERT_NEAR(sum, std::round(sum), 1e-9) << i;
        ASSERT_EQ(where == Side::inside, std::round(sum) != 0) << i;
    }
    EXPECT_GT(on, count / 200);
}
TYPED_TEST(Insides, OfOpenMeshes) {
    using T = TypeParam;
    using V = Vec<T, 3>;
    auto cube = cube_at<T>(V(0, 0, 0), 4);
    cube.triangles.pop_back();
    expect_insides("a triangle less", cube);
    cube.triangles.pop_back();
    expect_insides("without a lid", cube);
    cube.triangles.resize(5);
    expect_insides("five triangles", cube);
    cube.triangles.resize(1);
    expect_insides("one triangle", cube);
    auto some = tetrahedra<T>(20, 5, 5);
    std::vector<TriangleIndices> kept;
    for (std::size_t i = 0; i < some.size(); ++i)
        if (i % 7 != 0) kept.push_back(some.triangles[i]);
    some.triangles = kept;
    expect_insides("some of tetrahedra", some);
    for (std::size_t i = 0; i < some.size(); i += 3) std::swap(some.triangles[i][0], some.triangles[i][1]);
    expect_insides("some turned", some);
    // A ball with holes far from each other, at the ends of the range.
    constexpr int most = std::is_same_v<T, float> ? 58 : 478;
    for (const int exponent : {0, most, -most}) {
        auto holes = ball<T>(20);
        for (auto& v : holes.vertices) v = v * std::ldexp(T(1), exponent);
        holes.triangles.erase(holes.triangles.begin() + 300);
        holes.triangles.erase(holes.triangles.begin() + 500, holes.triangles.begin() + 502);
        expect_insides("ball with holes", holes, 100);
    }
    expect_insides("terrain", scene<T>("gen:terrain:500"));
    expect_insides("soup", soup<T>(100));
}
TYPED_TEST(Insides, OfPolygons) {
    using T = TypeParam;
    constexpr int most = std::is_same_v<T, float> ? 56 : 476;
    expect_insides("sparse", polygons<T>(10, 20, 1));
    expect_insides("crowded", polygons<T>(30, 2, 2));
    expect_insides("huge", polygons<T>(10, 5, 3, most));
    expect_insides("tiny", polygons<T>(10, 5, 4, -most));
    auto open = polygons<T>(10, 5, 5);
    std::vector<Segment<T, 2>> kept;
    for (std::size_t i = 0; i < open.size(); ++i)
        if (i % 5 != 0) kept.push_back(open.segments[i]);
    open.segments = kept;
    expect_insides("open", open);
}

/// Closed, oriented and without self-intersections, pseudonormals give the sides of crossings; so does
/// parity, which asks for no orientation.
template <class P>
void expect_equal_methods(const P& set, const P& turned_some) {
    const auto index = build(set), other = build(turned_some);
    const Solid by_crossings(index);
    const Solid by_normals(index, {.by = SideBy::pseudonormal});
    const Solid by_parity(other, {.by = SideBy::parity});
    EXPECT_EQ(by_crossings.by(), SideBy::crossings);
    for (const auto& p : queries_around(set, 2000, 2)) {
        const auto want = closest_side(by_crossings, p);
        const auto by_normal = closest_side(by_normals, p);
        EXPECT_EQ(by_normal.by, SideBy::pseudonormal);
        // Where the distance is but roundings, only crossings are exact.
        if (want.near.distance2 < typename P::Scalar(1e-12)) continue;
        ASSERT_EQ(by_normal.distance, want.distance);
        ASSERT_EQ(by_normal.side, want.side);
        ASSERT_EQ(side(by_parity, p), want.side);
    }
}
TYPED_TEST(Insides, AreTheSameByParityAndPseudonormals) {
    using T = TypeParam;
    const auto sphere = ball<T>(20), cube = cube_at<T>(Vec<T, 3>(1, 2, 3), 2);
    for (const auto& mesh : {sphere, cube}) {
        auto some = mesh;
        for (std::size_t i = 0; i < some.size(); i += 3)
            std::swap(some.triangles[i][0], some.triangles[i][1]);
        expect_equal_methods(mesh, some);
    }
    SegmentSet<T> star;  // sharp, hollow corners
    for (int i = 0; i < 10; ++i) {
        const auto at = [](int k) {
            const double angle = k * std::numbers::pi / 5, radius = k % 2 == 0 ? 5 : 1;
            return Vec<T, 2>(Vec2d(radius * std::cos(angle), radius * std::sin(angle)));
        };
        star.segments.push_back({at(i), at((i + 1) % 10)});
    }
    auto some = star;
    for (std::size_t i = 0; i < some.size(); i += 3) std::swap(some.segments[i].a, some.segments[i].b);
    expect_equal_methods(star, some);
}

/// The exact side of a point of tetrahedra that do not meet each other, turned outward or all inward.
template <class T>
Side exact_side(const TriangleMesh<T>& tetrahedra, const Vec<T, 3>& p) {
    using namespace rational;
    const Point x = point(p);
    for (std::size_t first = 0; first < tetrahedra.size(); first += 4) {
        int least = 1, most = -1;
        for (std::size_t i = first; i < first + 4; ++i) {
            const auto t = corners(tetrahedra.view().triangle(i));
            const int behind = -sgn(dot(cross(t[1] - t[0], t[2] - t[0]), x - t[0]));
            least = std::min(least, behind), most = std::max(most, behind);
        }
        if (least > 0 || most < 0) return Side::inside;
        if (least == 0 || most == 0) return Side::on;
    }
    return Side::outside;
}
/// Expects the exact side from every way of points on faces, edges and corners, next to them, and far off.
template <class T>
void expect_exact_sides(const char* scene, const TriangleMesh<T>& mesh) {
    SCOPED_TRACE(scene);
    const auto index = build(mesh);
    const auto other = build<AnyStructure>(mesh, {"kdtree"});
    const Solid by_crossings(index), by_normals(index, {.by = SideBy::pseudonormal}),
        by_parity(index, {.by = SideBy::parity});
    const Solid of_other(other, {.by = SideBy::pseudonormal});
    std::map<Side, int> sides_found;
    for (std::uint64_t i = 0; i < 3000; ++i) {
        Random random(52, i);
        const auto c = mesh.view().corners(random.bits() % mesh.size());
        const auto share = [&] { return T(random.bits() % 9) / 8; };
        // A point of a face, exact where the corners are integers.
        const T u = share(), v = (1 - u) * share();
        Vec<T, 3> p = c[0] + (c[1] - c[0]) * u + (c[2] - c[0]) * v;
        if (i % 4 == 1)  // next to the face
            for (int k = 0; k < 3; ++k)
                p[k] = std::nextafter(p[k], random.bits() % 2 == 0 ? T(1e9) : T(-1e9));
        if (i % 4 == 2)  // far away, up to 2^59 times
            p = (p - index.bounds().low) * std::ldexp(T(1 + random.uniform()), static_cast<int>(i % 50));
        if (i % 4 == 3) p = matrix::point_in(index.bounds(), 0.2, random);
        const Side want = exact_side(mesh, p);
        ++sides_found[want];
        const auto found = closest_side(by_normals, p);
        ASSERT_EQ(found.side, want) << i;
        ASSERT_EQ(closest_side(of_other, p), found) << i;
        for (const auto* solid : {&by_crossings, &by_normals, &by_parity})
            ASSERT_EQ(side(*solid, p), want) << i;
        ASSERT_TRUE(want == Side::on ? found.distance == 0
                                     : (found.distance < 0) == (want == Side::inside) || found.distance == 0)
            << i;
        T distance;
        signed_distances(by_normals, std::vector{p}, std::span(&distance, 1));
        ASSERT_EQ(distance, found.distance) << i;
    }
    for (const Side side : {Side::outside, Side::on, Side::inside}) EXPECT_GT(sides_found[side], 20);
}
/// Tetrahedra, flat ones and ones far apart among them, whose distances tie once they are rounded.
template <class T>
TriangleMesh<T> apart(std::initializer_list<std::array<Vec<T, 3>, 4>> all) {
    TriangleMesh<T> mesh;
    for (const auto& corners : all) {
        const auto i = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
        for (const TriangleIndices t : {TriangleIndices{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}})
            mesh.triangles.push_back({i + t[0], i + t[1], i + t[2]});
    }
    return mesh;
}
TYPED_TEST(Insides, AreExactByEveryWay) {
    using T = TypeParam;
    using V = Vec<T, 3>;
    const std::array<V, 4> one = {V(0, 0, 0), V(8, 0, 0), V(0, 8, 0), V(0, 0, 8)};
    expect_exact_sides("one", apart<T>({one}));
    expect_exact_sides("inside out", turned(apart<T>({one})));
    expect_exact_sides("flat", apart<T>({{V(0, 0, 0), V(64, 0, 1), V(0, 64, 1), V(24, 24, 1)}}));
    expect_exact_sides("skew", apart<T>({{V(0, 0, 0), V(40, 1, 3), V(5, 37, 2), V(7, 9, 4)}}));
    // Far parts of one scene, the near one last.
    expect_exact_sides(
        "far apart",
        apart<T>({{V(1 << 20, 0, 0), V((1 << 20) + 8, 0, 0), V(1 << 20, 8, 0), V(1 << 20, 0, 8)}, one}));
    expect_exact_sides(
        "thin wall",
        apart<T>({{V(0, 0, 4096), V(4096, 0, 4096), V(0, 4096, 4096), V(1024, 1024, T(4096.25))}, one}));
    // The case by which far points were inside: a cube, and a place far off one of its edges.
    const auto cube = cube_at<T>(V(-1, -1, -1), 2);
    const auto index = build(cube);
    const Solid solid(index, {.by = SideBy::pseudonormal});
    EXPECT_GT(signed_distance(solid, V(0, T(63103085), T(77575773))), 0);
    EXPECT_EQ(side(solid, V(T(0.25), T(0.125), -1)), Side::on);
}

/// Open surfaces: by pseudonormals the sides of what is closest, as far as rounded distances tell that.
TYPED_TEST(Insides, OfOpenSurfacesByPseudonormals) {
    using T = TypeParam;
    using V = Vec<T, 3>;
    auto bowl = ball<T>(12);
    bowl.triangles.resize(bowl.size() / 2);
    const auto index = build(bowl);
    const Solid solid(index, {.by = SideBy::pseudonormal});
    std::vector<V> points;
    std::vector<T> distances(2000);
    for (std::uint64_t i = 0; i < distances.size(); ++i) {
        Random random(53, i);
        points.push_back(matrix::point_in(index.bounds(), 0.2, random));
    }
    signed_distances(solid, points, std::span(distances));
    int behind = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto found = closest_side(solid, points[i]);
        ASSERT_EQ(found.distance, distances[i]);
        // Where the closest point is on a face, the face tells.
        if (feature(index, points[i], found.near).feature != Feature::face) continue;
        const auto c = bowl.view().corners(found.near.element);
        const int in_front = side(Vec3d(c[0]), Vec3d(c[1]), Vec3d(c[2]), Vec3d(points[i]));
        ASSERT_EQ(found.side, in_front > 0 ? Side::outside : (in_front < 0 ? Side::inside : Side::on)) << i;
        behind += in_front < 0;
    }
    EXPECT_GT(behind, 200);
    // Points of faces, edges and corners are on the surface.
    TriangleMesh<T> square;
    square.vertices = {{0, 0, 0}, {3, 0, 1}, {3, 3, 1}, {0, 3, 0}};
    square.triangles = {{0, 1, 2}, {0, 2, 3}};
    const auto of_square = build(square);
    const Solid flat(of_square, {.by = SideBy::pseudonormal});
    for (const V& p : {V(0, 0, 0), V(3, T(1.5), 1), V(T(1.5), T(1.5), T(0.5)), V(T(1.5), T(0.75), T(0.5))})
        EXPECT_EQ(side(flat, p), Side::on);
    EXPECT_EQ(side(flat, V(1, 1, 2)), Side::outside);
    EXPECT_EQ(side(flat, V(1, 1, -2)), Side::inside);
}

/// Compares expansions with the sums, by every structure.
template <class T>
void expect_promises(const char* scene, const TriangleMesh<T>& mesh, std::size_t count = 200) {
    SCOPED_TRACE(scene);
    const auto index = build(mesh);
    const Solid by_crossings(index);
    for (const double error : {1e-1, 1e-2, 1e-3, 1e-4, 1e-7}) {
        const Solid solid(index, {.by = SideBy::expansion, .error = error});
        for (const auto& p : queries_around(mesh, count, 3)) {
            if (side(by_crossings, p) == Side::on) continue;
            const double sum = static_cast<double>(sum_of_turns(mesh, p)), found = winding_number(solid, p);
            ASSERT_NEAR(found, sum, error);
            ASSERT_EQ(side(solid, p), found >= 0.5 ? Side::inside : Side::outside);
        }
    }
    const auto grid = build<AnyStructure>(mesh, {"grid"});
    const Solid of_wide(index, {.by = SideBy::expansion});
    const Solid of_grid(grid, {.by = SideBy::expansion});
    for (const auto& p : queries_around(mesh, count, 4))
        ASSERT_EQ(winding_number(of_wide, p), winding_number(of_grid, p));
}
TYPED_TEST(Insides, ExpansionsKeepTheirPromises) {
    using T = TypeParam;
    constexpr int most = std::is_same_v<T, float> ? 56 : 476;
    expect_promises("soup", soup<T>(2000));
    expect_promises("boulder", scene<T>("gen:boulder:2000"));
    expect_promises("terrain", scene<T>("gen:terrain:2000"));
    expect_promises("cube", cube_at<T>(Vec<T, 3>(0, 0, 0), 1));
    expect_promises("coincident",
                    joined(cube_at<T>(Vec<T, 3>(0, 0, 0), 1), cube_at<T>(Vec<T, 3>(0, 0, 0), 1)));
    expect_promises("huge", tetrahedra<T>(40, 4, 6, most));
    expect_promises("tiny", tetrahedra<T>(40, 4, 7, -most));
}

/// Sets of any kind, many of whose primitives coincide, touch or have no area.
template <class P>
void expect_right_of_any() {
    generated::expect_always([] {
        const generated::AnyCase<P> any;
        const auto p = any.point();
        const auto brute = build<AnyStructure>(any.set, {"brute-force"});
        const auto wide = build(any.set);
        const auto cut = build<AnyStructure>(any.set, {"kdtree"});
        const Solid solid(brute);
        const Solid of_wide(wide);
        const Solid of_cut(cut);
        RC_ASSERT(side(of_wide, p) == side(solid, p));
        RC_ASSERT(side(of_cut, p) == side(solid, p));
        RC_ASSERT(winding_number(of_wide, p) == winding_number(solid, p));
        RC_ASSERT(winding_number(of_cut, p) == winding_number(solid, p));
        RC_ASSERT(closest_side(of_cut, p) == closest_side(solid, p));
        RC_ASSERT(!std::isnan(signed_distance(solid, p)));
        if (side(solid, p) != Side::on && !any.wild)
            RC_ASSERT(std::abs(winding_number(solid, p) - static_cast<double>(sum_of_turns(any.set, p))) <
                      1e-9);
    });
}
TYPED_TEST(Insides, OfGeneratedSets) {
    expect_right_of_any<TriangleMesh<TypeParam>>();
    expect_right_of_any<SegmentSet<TypeParam>>();
}

TYPED_TEST(Insides, OfNothing) {
    using T = TypeParam;
    const auto expect_nothing = [](const auto& index, const auto& options) {
        const Solid solid(index, options);
        using Point = typename std::remove_cvref_t<decltype(solid)>::Point;
        EXPECT_TRUE(solid.closed());
        EXPECT_EQ(side(solid, Point()), Side::outside);
        EXPECT_EQ(winding_number(solid, Point()), 0);
        EXPECT_FALSE(closest_side(solid, Point()));
        EXPECT_EQ(signed_distance(solid, Point()), std::numeric_limits<T>::infinity());
    };
    const TriangleMesh<T> none;
    const SegmentSet<T> no_segments;
    for (const auto by : {SideBy::crossings, SideBy::parity, SideBy::pseudonormal, SideBy::expansion})
        expect_nothing(build(none), SolidOptions{.by = by});
    expect_nothing(build(no_segments), SolidOptions{});
    expect_nothing(build<AnyStructure>(no_segments, {"bvh"}), SolidOptions{.by = SideBy::pseudonormal});
}
TYPED_TEST(Insides, OfPointsThatAreNotFinite) {
    using T = TypeParam;
    const T infinity = std::numeric_limits<T>::infinity();
    const auto cube = cube_at<T>(Vec<T, 3>(0, 0, 0), 4);
    auto open = cube;
    open.triangles.pop_back();
    for (const auto& mesh : {cube, open})
        for (const auto by : {SideBy::crossings, SideBy::parity, SideBy::pseudonormal, SideBy::expansion}) {
            const auto index = build(mesh);
            const Solid solid(index, {.by = by});
            for (const T bad : {std::numeric_limits<T>::quiet_NaN(), infinity, -infinity})
                for (int k = 0; k < 3; ++k) {
                    Vec<T, 3> p(1, 1, 1);
                    p[k] = bad;
                    EXPECT_EQ(side(solid, p), Side::outside);
                    EXPECT_TRUE(std::isnan(winding_number(solid, p)));
                    EXPECT_FALSE(closest_side(solid, p));
                    EXPECT_EQ(signed_distance(solid, p), infinity);
                    T distance = 0;
                    signed_distances(solid, std::span<const Vec<T, 3>>(&p, 1), std::span(&distance, 1));
                    EXPECT_EQ(distance, infinity);
                }
            // The largest numbers are points like others.
            const T most = std::numeric_limits<T>::max();
            for (const auto& p :
                 {Vec<T, 3>(most, most, most), Vec<T, 3>(-most, 0, most), Vec<T, 3>(1, 1, -most)}) {
                EXPECT_EQ(side(solid, p), Side::outside);
                EXPECT_NEAR(winding_number(solid, p), 0, 1e-3);
                EXPECT_FALSE(std::isnan(signed_distance(solid, p)));
            }
        }
}
TYPED_TEST(Insides, BadRequestsAreRefused) {
    using T = TypeParam;
    const auto cube = cube_at<T>(Vec<T, 3>(0, 0, 0), 4);
    auto index = build<AnyStructure>(cube, {"bvh"});
    for (const double error : {0.0, -1.0, 1e-12, 2.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(Solid(index, {.by = SideBy::expansion, .error = error}), UsageError);
    const auto square = polygons<T>(1, 5, 1);
    const auto plane = build(square);
    EXPECT_THROW(Solid(plane, {.by = SideBy::expansion}), UsageError);
    const Solid solid(index);
    const std::vector<Vec<T, 3>> points(3);
    std::vector<Side> some(2);
    std::vector<double> numbers(2);
    std::vector<T> distances(2);
    EXPECT_THROW(sides(solid, points, std::span(some)), InputError);
    EXPECT_THROW(winding_numbers(solid, points, std::span(numbers)), InputError);
    EXPECT_THROW(signed_distances(solid, points, std::span(distances)), InputError);
    ASSERT_TRUE(index.erase(cube, 3));
    EXPECT_THROW(Solid{index}, InputError);
}
TYPED_TEST(Insides, AreTheSameForAnyNumberOfThreads) {
    using T = TypeParam;
    auto mesh = scene<T>("gen:boulder:20000");
    mesh.triangles.resize(19000);
    const auto index = build(mesh);
    const ThreadLimit limit(2);
    for (const auto by : {SideBy::crossings, SideBy::pseudonormal, SideBy::expansion}) {
        const SolidOptions options{.by = by, .error = 1e-2};
        const Solid one(index, options, serial_executor()), many(index, options, default_executor());
        const auto points = queries_around(mesh, 3000, 6);
        std::vector<double> numbers(points.size()), more_numbers(points.size());
        std::vector<T> distances(points.size()), more_distances(points.size());
        winding_numbers(one, points, std::span(numbers), {.threads = serial_executor()});
        winding_numbers(many, points, std::span(more_numbers), {.threads = default_executor()});
        EXPECT_EQ(numbers, more_numbers);
        signed_distances(one, points, std::span(distances), {.threads = serial_executor()});
        signed_distances(many, points, std::span(more_distances), {.threads = default_executor()});
        EXPECT_EQ(distances, more_distances);
    }
}

}  // namespace
