/// Properties of hash grids alone: cells of a given size, searches that end however far points spread, and no
/// answers to rays.
#include <gtest/gtest.h>

#include <hedgerow/all.h>
#include <hedgerow/any_index.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>
#include <hedgerow/scenes/sets.h>

using namespace hedgerow;

namespace {

using Found = std::vector<Near<float, 3>>;

/// Points on both sides of the origin along each axis, and one point very far away.
PointCloud<float, 3> with_an_outlier(std::size_t count) {
    PointCloud<float, 3> cloud;
    Random random(5, 0);
    for (std::size_t i = 0; i < count; ++i)
        cloud.points.push_back(
            Vec3f(Vec3d(random.uniform(), random.uniform(), random.uniform()) * 2.0 - Vec3d::all(1)));
    cloud.points.push_back({1e12f, -1e12f, 3});
    return cloud;
}

TEST(HashGrid, CellsHaveTheSizeThatIsAskedFor) {
    const auto cloud = points<float>(1000);
    const auto index = build<HashGrid>(cloud, {.cell = 0.25});
    EXPECT_EQ(index.structure().cell_size(), 0.25);
    EXPECT_LE(index.structure().leaf_count(), 125u);
    EXPECT_EQ(index.validate(), "");
    std::size_t listed = 0;
    for (const auto& cell : outline(index.structure())) {
        listed += cell.items.size();
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(cell.box.extent()[k], 0.25, 1e-12);
        for (const PrimitiveId id : cell.items)
            EXPECT_TRUE(cell.box.contains(Box3d{Vec3d(cloud.points[id]), Vec3d(cloud.points[id])}));
    }
    EXPECT_EQ(listed, cloud.size());
    const double chosen = build<HashGrid>(cloud).structure().cell_size();
    EXPECT_GT(chosen, 0.1);
    EXPECT_LT(chosen, 0.15);  // 500 cells in about the unit cube
}

TEST(HashGrid, SearchesEndHoweverFarPointsSpread) {
    const auto cloud = with_an_outlier(3000);
    const auto index = build<HashGrid>(cloud, {.cell = 0.1});
    const auto oracle = build<BruteForce>(cloud);
    EXPECT_GE(index.structure().cell_size(), 0.1);
    EXPECT_EQ(index.validate(), "");
    // Search from inside, from beside and from far beyond the points.
    Found found, expected;
    for (const Vec3f& p : {Vec3f(0, 0, 0), Vec3f(-1, 1, 0.5f), Vec3f(1e11f, 0, 0),
                           Vec3f(-1e13f, 1e13f, 1e13f), Vec3f(1e12f, -1e12f, 3)})
        for (const float radius : {0.0f, 0.05f, 0.3f, 5.0f, 1e11f, 1e14f}) {
            Visits count;
            within(index, p, radius, found, {}, KeepAll(), count);
            within(oracle, p, PointOptions::anywhere, expected, {.radius2 = radius * radius});
            EXPECT_EQ(found, expected) << p[0] << " within " << radius;
            EXPECT_LE(count.nodes, 2 * index.structure().leaf_count() + 1);
            nearest(index, p, 5, found, {}, KeepAll(), count);
            nearest(oracle, p, 5, expected);
            EXPECT_EQ(found, expected);
        }
    // Balls and cones are near far more cells than are occupied, most of which they miss.
    std::vector<PrimitiveId> in_region, of_oracle;
    const auto expect_same = [&](const auto& region) {
        Visits count;
        overlapping(index, region, in_region, {}, count);
        overlapping(oracle, region, of_oracle);
        EXPECT_EQ(in_region, of_oracle);
        EXPECT_LE(count.nodes, 2 * index.structure().leaf_count() + 1);
    };
    for (const float radius : {0.0f, 0.3f, 5.0f, 1e9f, 1e14f})
        for (const Vec3f& p : {Vec3f(0, 0, 0), Vec3f(1e12f, -1e12f, 3)})
            expect_same(Sphere<float, 3>{p, radius});
    expect_same(Cone<float, 3>({0, 0, 0}, {1, 1, 1}, 0.01f));
    expect_same(Cone<float, 3>({0.5f, 0.5f, 0.5f}, {1e3f, 1, 0}, 0.5f, 1e10f));
    // Query an infinite box and a thick slice.
    std::vector<PrimitiveId> inside, all;
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(overlapping(index, Box3f{Vec3f::all(-infinity), Vec3f::all(infinity)}, inside), cloud.size());
    overlapping(index, Box3f{{-0.3f, -2, -2}, {0.2f, 2, 2}}, inside);
    overlapping(oracle, Box3f{{-0.3f, -2, -2}, {0.2f, 2, 2}}, all);
    EXPECT_EQ(inside, all);
}

TEST(HashGrid, ALargerCellTakesThePlaceOfOneThatIsTooSmallForTheExtent) {
    PointCloud<double, 2> cloud{{{0, 0}, {1e9, 0}, {1e9, 1e9}}};
    const auto index = build<HashGrid>(cloud, {.cell = 1e-9});
    EXPECT_EQ(index.structure().cell_size(), 1e9 / 0x1p29);
    EXPECT_EQ(index.structure().leaf_count(), 3u);
    EXPECT_EQ(index.validate(), "");
    EXPECT_EQ(closest_point(index, Vec2d(6e8, 1)).element, 1u);
}

TEST(HashGrid, PointsInOnePlaceShareACell) {
    PointCloud<float, 2> cloud;
    cloud.points.assign(1000, {3, 4});
    const auto index = build<HashGrid>(cloud);
    EXPECT_EQ(index.structure().leaf_count(), 1u);
    std::vector<Near<float, 2>> found;
    EXPECT_EQ(within(index, Vec2f(0, 0), 5, found), 1000u);
    EXPECT_EQ(within(index, Vec2f(0, 0), PointOptions::anywhere, found, {.radius2 = 24.99f}), 0u);
}

TEST(HashGrid, RefusesCellsThatAreNoLength) {
    const auto cloud = points<float>(10);
    for (const double cell :
         {-1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(build<HashGrid>(cloud, {.cell = cell}), UsageError);
    EXPECT_THROW(build_any("hash-grid:cell=-1", cloud), UsageError);
    EXPECT_THROW(build_any("hash-grid", cube<float>(12).view()), UsageError);
}

TEST(HashGrid, DeclinesRaysByAConceptAndWithASentence) {
    // Concepts decline rays at compile time.
    static_assert(AnswersProbe<HashGrid<float, 3>, PointProbe<float, 3>>);
    static_assert(AnswersProbe<HashGrid<float, 3>, BoxProbe<float, 3>>);
    static_assert(!AnswersProbe<HashGrid<float, 3>, RayProbe<float, 3>>);
    static_assert(AnswersProbe<Bvh<float, 3>, RayProbe<float, 3>>);
    // An index chosen by its name throws a sentence.
    const auto cloud = points<float>(10);
    const auto index = build_any("hash-grid", cloud);
    EXPECT_FALSE(index->answers_rays());
    const Ray3f ray{{0, 0, 0}, {1, 0, 0}};
    Hit<float> hit;
    Visits visits;
    std::vector<Hit<float>> hits;
    const auto message = [](auto ask) -> std::string {
        try {
            ask();
            return "";
        } catch (const InputError& e) {
            return e.what();
        }
    };
    const std::string sentence =
        "structure 'hash-grid' cannot answer rays: ask it for neighbours, or take another structure";
    EXPECT_EQ(message([&] { closest_hits(*index, {&ray, 1}, {&hit, 1}); }), sentence);
    EXPECT_EQ(message([&] {
                  closest_hits(*index, {&ray, 1}, {&hit, 1}, {}, KeepAll(), std::span(&visits, 1));
              }),
              sentence);
    EXPECT_EQ(message([&] { all_hits(*index, ray, hits); }), sentence);
    EXPECT_EQ(message([&] { trace(*index, ray); }), sentence);
}

}  // namespace
