/// Hausdorff distances against those that are known, against dense samples, and against all pairs of points.
#include <gtest/gtest.h>

#include <hedgerow/ask/hausdorff.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>
#include <hedgerow/scenes/sets.h>

#include "every_structure.h"
// #include "generated.h"

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
void expect_sound(const Result<T>& found, const A& a, const B& b, const HausdorffOptions& options, double reach) {
    const double lower = static_cast<double>(found.lower), upper = static_cast<double>(found.upper);
    ASSERT_TRUE(found);
    ASSERT_LE(0, lower);
    ASSERT_LE(lower, upper);
    ASSERT_LE(upper - lower, std::max({options.absolute, options.relative * lower, floor_of<T>(lower, reach)}) * (1 + 1e-6));
    const double rounding = floor_of<T>(upper, reach);
    ASSERT_NEAR(length(Vec3d(found.point_a) - Vec3d(found.point_b)), lower, rounding);
    const auto on_a = foot_of(found.point_a, a.primitives().closest_point(found.element_a, found.point_a));
    const auto on_b = foot_of(found.point_b, b.primitives().closest_point(found.element_b, found.point_b));
    ASSERT_LE(std::sqrt(static_cast<double>(on_a.distance2)), rounding);
    ASSERT_LE(std::sqrt(static_cast<double>(on_b.distance2)), rounding);
    const double witnessed = found.from_b ? std::sqrt(static_cast<double>(closest_point(a, found.point_b).distance2))
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

}  // namespace
