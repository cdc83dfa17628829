/// Every structure × query × primitive × scalar gives the bits of brute force, on generated and degenerate
/// scenes.
#include "matrix.h"

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

using namespace hedgerow;
using namespace hedgerow::matrix;

namespace {

template <class T>
TriangleMesh<T> moved(TriangleMesh<T> mesh, double scale, double shift) {
    for (auto& v : mesh.vertices) v = Vec<T, 3>(Vec3d(v) * scale + Vec3d::all(shift));
    return mesh;
}

template <class T>
class Matrix : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Matrix, Scalars);

TYPED_TEST(Matrix, GeneratedMeshes) {
    using T = TypeParam;
    expect_equal("teapot", teapot<T>(1000));
    expect_equal("teapot in a stadium", teapot_in_stadium<T>(3000));
    expect_equal("terrain", terrain<T>(2000));
    expect_equal("soup", soup<T>(2000));
    expect_equal("cube", cube<T>(300));
    expect_equal("Cornell box", cornell_box<T>(32));
    expect_equal("grass", grass<T>(1000));
    expect_equal("hairball", hairball<T>(1000));
    expect_equal("turned stadium", turned_stadium<T>(1000));
}

TYPED_TEST(Matrix, TinyHugeAndFarMeshes) {
    using T = TypeParam;
    expect_equal("tiny", moved(teapot<T>(500), 1e-30, 0));
    expect_equal("subnormal", moved(teapot<T>(500), 1e-40, 0));
    expect_equal("huge", moved(teapot<T>(500), 1e16, 1e15));
    expect_equal("far from the origin", moved(teapot<T>(500), 1, 1e5));
}

TYPED_TEST(Matrix, DegenerateMeshes) {
    using T = TypeParam;
    TriangleMesh<T> mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    expect_equal("empty", mesh);
    mesh.triangles = {{0, 1, 2}};
    expect_equal("one", mesh);
    for (int i = 0; i < 50; ++i) mesh.triangles.push_back({0, 1, 2});
    expect_equal("coincident", mesh);
    for (int i = 0; i < 50; ++i) mesh.triangles.push_back({0, 1, 1});
    expect_equal("without area", mesh);
    expect_equal("coplanar", [] {
        TriangleMesh<T> flat = terrain<T>(500);
        for (auto& v : flat.vertices) v[2] = T(0.25);
        return flat;
    }());
}

TYPED_TEST(Matrix, OtherPrimitives) {
    using T = TypeParam;
    const auto balls = spheres<T>(500);
    Points<T, 3> centers;
    for (const auto& s : balls.spheres) centers.push_back(s.center + Vec<T, 3>(s.radius, T(0), T(0)));
    expect_equal("spheres", balls, centers);
    const auto cloud = points<T>(500);
    expect_equal("points", cloud, cloud.points);
    const auto plane = points2d<T>(500);
    expect_equal("points in the plane", plane, plane.points);
    const auto lines = segments2d<T>(500);
    Points<T, 2> ends;
    for (const auto& s : lines.segments) ends.push_back(s.a);
    expect_equal("segments", lines, ends);
}

TYPED_TEST(Matrix, UnusableRaysHitNothing) {
    using T = TypeParam;
    const auto mesh = cube<T>(12);
    constexpr T nan = std::numeric_limits<T>::quiet_NaN(), infinity = std::numeric_limits<T>::infinity();
    const Ray<T, 3> rays[] = {{{0, 0, 5}, {0, 0, 0}},
                              {{0, 0, 5}, {0, nan, -1}},
                              {{nan, 0, 5}, {0, 0, -1}},
                              {{0, 0, 5}, {0, 0, -infinity}},
                              {{infinity, 0, 0}, {-1, 0, 0}},
                              {{0, 0, 5}, {0, 0, -1}, T(7), T(3)},
                              {{0, 0, 5}, {0, 0, -std::numeric_limits<T>::denorm_min()}}};
    for (const char* spec : structures) {
        const auto index = build_any(spec, mesh);
        for (const auto& ray : rays) {
            Hit<T> hit;
            closest_hits(*index, {&ray, 1}, {&hit, 1});
            EXPECT_FALSE(hit) << spec;
        }
    }
}

}  // namespace
