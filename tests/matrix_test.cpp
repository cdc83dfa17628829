/// Every structure × query × primitive × scalar gives the bits of brute force, on generated and degenerate
/// scenes.
#include <cstdlib>

#include <gtest/gtest.h>

#include <hedgerow/any_index.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>
#include <hedgerow/scenes/sets.h>

using namespace hedgerow;

namespace {

constexpr const char* structures[] = {"bvh",
                                      "bvh:builder=sweep",
                                      "bvh:builder=midpoint",
                                      "bvh:builder=equal-counts",
                                      "bvh:ordered=off,culling=off",
                                      "bvh:max_leaf_size=1",
                                      "kdtree",
                                      "kdtree:leaf_size=1",
                                      "grid",
                                      "grid:resolution=3",
                                      "grid:resolution=100",
                                      "brute-force:box=on"};

int rays_per_scene() {
    return std::getenv("HEDGEROW_LONG") != nullptr ? 100000 : 1500;
}

template <class T, int D>
using Points = std::vector<Vec<T, D>>;

template <class T, int D>
Vec<T, D> point_in(const Box<T, D>& box, double beyond, Random& random) {
    Vec<T, D> p;
    for (int k = 0; k < D; ++k) {
        const double low = static_cast<double>(box.low[k]), extent = static_cast<double>(box.high[k]) - low;
        p[k] = static_cast<T>(low - beyond * extent + random.uniform() * extent * (1 + 2 * beyond));
    }
    return p;
}

/// Rays of all kinds: from near and far, at exact targets (vertices, middles of edges) and from them,
/// parallel to axes with 0, −0 and subnormal components, with very short and very long directions.
template <class T, int D>
Ray<T, D> ray_of(const Box<T, D>& box, const Points<T, D>& targets, std::uint64_t i) {
    Random random(3, i);
    const auto any_target = [&] { return targets[random.bits() % targets.size()]; };
    Ray<T, D> ray;
    ray.origin = point_in(box, i % 3 == 0 ? 2.0 : 0.1, random);
    const Vec<T, D> target = i % 4 == 1 ? any_target() : point_in(box, 0.0, random);
    if (i % 16 == 5) ray.origin = any_target();
    if (i % 64 == 7) ray.origin = ray.origin + Vec<T, D>::all(T(1000) * length(box.extent()));
    ray.direction = target - ray.origin;
    if (i % 8 == 2) {
        constexpr T small[] = {T(0), T(-0.0), std::numeric_limits<T>::denorm_min()};
        const int axis = static_cast<int>(random.bits() % D);
        for (int k = 0; k < D; ++k)
            if (k != axis) ray.direction[k] = small[i / 8 % 3];
        if (i % 16 == 2) {
            ray.origin = any_target();
            ray.origin[axis] -= ray.direction[axis];
        }
    }
    if (i % 32 == 9) ray.direction = ray.direction * T(1e-20);
    if (i % 32 == 11) ray.direction = ray.direction * T(1e15);
    if (i % 32 == 13) ray.t_min = T(0.5);
    if (i % 32 == 15) ray.t_max = T(1);
    return ray;
}

template <class T, int D>
void expect_equal_rays(const AnyIndex<T, D>& oracle, const AnyIndex<T, D>& index,
                       const Points<T, D>& targets) {
    for (int i = 0; i < rays_per_scene(); ++i) {
        const auto ray = ray_of(oracle.bounds(), targets, static_cast<std::uint64_t>(i));
        Hit<T> want, got;
        oracle.closest_hits({&ray, 1}, {&want, 1});
        index.closest_hits({&ray, 1}, {&got, 1});
        ASSERT_EQ(want, got) << "closest hit of ray " << i << ": t " << want.t << " and " << got.t;
        bool any = false;
        index.any_hits({&ray, 1}, {&any, 1});
        ASSERT_EQ(bool(want), any) << "any hit of ray " << i;
        if (i % 8 != 0) continue;
        std::vector<Hit<T>> all_wanted, all_got;
        oracle.all_hits(ray, all_wanted);
        index.all_hits(ray, all_got);
        ASSERT_EQ(all_wanted, all_got) << "all hits of ray " << i;
    }
}

template <class T, int D>
void expect_equal_regions(const AnyIndex<T, D>& oracle, const AnyIndex<T, D>& index) {
    for (std::uint64_t i = 0; i < 200; ++i) {
        Random random(9, i);
        const auto p = point_in(oracle.bounds(), i % 2 == 0 ? 0.0 : 3.0, random);
        Near<T, D> want, got;
        oracle.closest_points({&p, 1}, {&want, 1});
        index.closest_points({&p, 1}, {&got, 1});
        ASSERT_EQ(want, got) << "closest point of " << i;
        std::vector<Near<T, D>> near_wanted, near_got;
        oracle.nearest(p, i % 20, near_wanted);
        index.nearest(p, i % 20, near_got);
        ASSERT_EQ(near_wanted, near_got) << "nearest of " << i;
        Box<T, D> box;
        box.expand(point_in(oracle.bounds(), 0.2, random)).expand(point_in(oracle.bounds(), 0.2, random));
        std::vector<PrimitiveId> in_wanted, in_got;
        oracle.overlapping(box, in_wanted);
        index.overlapping(box, in_got);
        ASSERT_EQ(in_wanted, in_got) << "overlap of " << i;
    }
}

template <class P>
void expect_equal(const char* name, const P& set, const Points<typename P::Scalar, P::dimension>& targets) {
    const auto oracle = build_any("brute-force", set);
    for (const char* spec : structures) {
        SCOPED_TRACE(std::string(name) + ", " + spec);
        const auto index = build_any(spec, set);
        EXPECT_EQ(index->validate(), "");
        if (!targets.empty()) expect_equal_rays(*oracle, *index, targets);
        if (testing::Test::HasFatalFailure()) return;
        if (set.size() > 0) expect_equal_regions(*oracle, *index);
        if (testing::Test::HasFatalFailure()) return;
    }
}

template <class T>
void expect_equal(const char* name, const TriangleMesh<T>& mesh) {
    auto targets = mesh.vertices;
    for (const auto& t : mesh.triangles)
        targets.push_back(mesh.vertices[t[0]] * T(0.5) + mesh.vertices[t[1]] * T(0.5));
    expect_equal(name, mesh, targets);
}

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
            index->closest_hits({&ray, 1}, {&hit, 1});
            EXPECT_FALSE(hit) << spec;
        }
    }
}

TYPED_TEST(Matrix, NoRayLeaksOutOfAClosedMesh) {
    using T = TypeParam;
    const auto mesh = moved(cube<T>(1200), 1, 0.1);
    const int count = std::getenv("HEDGEROW_LONG") != nullptr ? 5000000 : 20000;
    for (const char* spec : {"bvh", "kdtree", "grid"}) {
        const auto index = build_any(spec, mesh);
        for (int i = 0; i < count; ++i) {
            Random random(17, static_cast<std::uint64_t>(i));
            const auto& t = mesh.triangles[random.bits() % mesh.size()];
            const double u = i % 3 == 0 ? 0 : random.uniform();
            const Vec3d on_edge = Vec3d(mesh.vertices[t[0]]) * (1 - u) + Vec3d(mesh.vertices[t[1]]) * u;
            const Vec<T, 3> origin(Vec3d::all(0.1) + random.direction<3>() * 0.5);
            const Ray<T, 3> ray{origin, Vec<T, 3>(on_edge) - origin};
            bool hit = false;
            index->any_hits({&ray, 1}, {&hit, 1});
            ASSERT_TRUE(hit) << spec << ", ray " << i;
        }
    }
}

}  // namespace
