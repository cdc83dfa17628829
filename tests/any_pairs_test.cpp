/// Pairs, distances and Hausdorff distances of an AnyIndex against those of an Index.
#include <gtest/gtest.h>

#include <hedgerow/any_pairs.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

using namespace hedgerow;

namespace {

template <class T>
class AnyPairs : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(AnyPairs, Scalars);

const char* const specs[] = {"wide", "bvh", "kdtree", "octree", "grid", "bsp"};

TYPED_TEST(AnyPairs, OfTriangles) {
    using T = TypeParam;
    const auto mesh = teapot<T>(500);
    auto turned = mesh;
    for (auto& v : turned.vertices) v = Vec<T, 3>(v[1], v[0], v[2]);
    const auto a = build(mesh), b = build(turned);
    const auto crossings = crossing_pairs(a, b), selves = self_intersections(a);
    ASSERT_FALSE(crossings.empty() || selves.empty());
    for (const char* spec : specs) {
        SCOPED_TRACE(spec);
        const auto any_a = build_any(spec, mesh), any_b = build_any("wide", turned);
        EXPECT_EQ(crossing_pairs(*any_a, *any_b, {.threads = 2}), crossings);
        EXPECT_EQ(self_intersections(*any_a), selves);
        EXPECT_TRUE(any_crossing(*any_a, *any_b));
        EXPECT_TRUE(any_self_intersection(*any_a));
        EXPECT_EQ(hausdorff_distance(*any_a, *any_b), hausdorff_distance(a, b));
        EXPECT_EQ(directed_hausdorff_distance(*any_b, *any_a), directed_hausdorff_distance(b, a));
    }
    auto away = mesh;
    for (auto& v : away.vertices) v[0] += T(20);
    const auto far = build_any("octree", away), near = build_any("grid", mesh);
    EXPECT_EQ(minimum_distance(*near, *far), minimum_distance(a, build(away)));
    EXPECT_FALSE(any_crossing(*near, *far));
    EXPECT_FALSE(minimum_distance(*near, *far, {.radius = 1}));
}

TYPED_TEST(AnyPairs, OfPointsAndOthers) {
    using T = TypeParam;
    const auto mesh = teapot<T>(300);
    const auto cloud = points<T>(400), others = points<T>(300, 7);
    const auto spheres = hedgerow::spheres<T>(200);
    for (const char* spec : {"wide", "kdtree", "hash-grid"}) {
        SCOPED_TRACE(spec);
        const auto any = build_any(spec, cloud), of_others = build_any("kdtree", others);
        const auto index = build<Bvh>(cloud), index_of_others = build<Bvh>(others);
        std::vector<PairWithin<T>> found;
        pairs_within(*any, 0.1, found);
        EXPECT_EQ(found, pairs_within(index, 0.1));
        pairs_within(*any, *of_others, 0.1, found);
        EXPECT_EQ(found, pairs_within(index, index_of_others, 0.1));
        EXPECT_EQ(hausdorff_distance(*any, *of_others), hausdorff_distance(index, index_of_others));
        EXPECT_EQ(minimum_distance(*any, *of_others), minimum_distance(index, index_of_others));
        const auto any_mesh = build_any("bvh", mesh), any_spheres = build_any("octree", spheres);
        EXPECT_EQ(minimum_distance(*any, *any_mesh), minimum_distance(index, build(mesh)));
        EXPECT_EQ(minimum_distance(*any_spheres, *any), minimum_distance(build<Bvh>(spheres), index));
        EXPECT_EQ(directed_hausdorff_distance(*any, *any_spheres),
                  directed_hausdorff_distance(index, build<Bvh>(spheres)));
    }
}

TYPED_TEST(AnyPairs, InThePlane) {
    using T = TypeParam;
    const auto walls = segments2d<T>(100);
    const auto cloud = points2d<T>(100);
    const auto any_walls = build_any("quadtree", walls), any = build_any("grid", cloud);
    EXPECT_EQ(minimum_distance(*any, *any_walls), minimum_distance(build<Bvh>(cloud), build<Bvh>(walls)));
    EXPECT_EQ(hausdorff_distance(*any, *any), hausdorff_distance(build<Bvh>(cloud), build<Bvh>(cloud)));
    EXPECT_THROW(minimum_distance(*any_walls, *any_walls), InputError);
}

TYPED_TEST(AnyPairs, OfWhatIsHeldAlone) {
    using T = TypeParam;
    const auto mesh = teapot<T>(300);
    auto index = build<Bvh>(mesh);
    const auto any = build_any("bvh", mesh), brute = build_any("brute-force", mesh);
    for (PrimitiveId i = 0; i < mesh.size(); i += 2) {
        ASSERT_TRUE(index.erase(mesh, i));
        ASSERT_TRUE(any->erase(i));
        EXPECT_FALSE(any->holds(i));
    }
    const auto whole = build<Bvh>(mesh);
    EXPECT_EQ(directed_hausdorff_distance(*brute, *any), directed_hausdorff_distance(whole, index));
    EXPECT_EQ(directed_hausdorff_distance(*any, *brute), directed_hausdorff_distance(index, whole));
    EXPECT_EQ(crossing_pairs(*any, *brute), crossing_pairs(index, whole));
}

TYPED_TEST(AnyPairs, AreRefusedWhereThereAreNone) {
    using T = TypeParam;
    const auto cloud = points<T>(20);
    const auto mesh = cube<T>(12);
    const auto spheres = hedgerow::spheres<T>(20);
    const auto any_cloud = build_any("kdtree", cloud), any_mesh = build_any("kdtree", mesh),
               any_spheres = build_any("kdtree", spheres);
    std::vector<PairWithin<T>> found;
    EXPECT_THROW(pairs_within(*any_mesh, 1, found), InputError);
    EXPECT_THROW(crossing_pairs(*any_cloud, *any_mesh), InputError);
    EXPECT_THROW(self_intersections(*any_spheres), InputError);
    EXPECT_THROW(minimum_distance(*any_mesh, *any_spheres), InputError);
    EXPECT_THROW(hausdorff_distance(*any_mesh, *any_spheres), InputError);
    EXPECT_THROW(directed_hausdorff_distance(*any_spheres, *any_mesh), InputError);
}

}  // namespace
