/// On primitives that cannot be separated, every structure and builder keeps to its limit of items and
/// answers like brute force.
#include "crowded.h"
#include "matrix.h"

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

using namespace hedgerow;
using namespace hedgerow::matrix;

namespace {

/// A structure or builder, and the most items that it may have per primitive.
struct Limited {
    const char* structure;
    double items_per_primitive;
};
constexpr Limited limited[] = {{"grid", 32},
                               {"grid:heuristic=roots", 32},
                               {"grid:insert=box", 32},
                               {"grid:items_per_primitive=3", 3},
                               {"two-level-grid", 64},
                               {"two-level-grid:items_per_primitive=5", 5},
                               {"kdtree", 16},
                               {"kdtree:builder=binned", 16},
                               {"kdtree:builder=median", 64},
                               {"kdtree:builder=midpoint", 64},
                               {"kdtree:items_per_primitive=2", 2},
                               {"octree", 32},
                               {"octree:items_per_primitive=6", 6},
                               {"bsp", 16},
                               {"bsp:items_per_primitive=1", 1},
                               {"bvh", 1},
                               {"bvh:builder=sweep", 1},
                               {"bvh:builder=equal-counts", 1},
                               {"bvh:builder=midpoint", 1},
                               {"bvh:builder=lbvh", 1},
                               {"bvh:builder=ploc", 1},
                               {"bvh:builder=agglomerative", 1},
                               {"bvh:reinsertion=3", 1},
                               {"bvh:builder=spatial-splits", 1.5},
                               {"bvh:volume=sphere", 1},
                               {"bvh:volume=obb", 1},
                               {"bvh:volume=kdop14", 1},
                               {"bvh:volume=cylinder", 1},
                               {"wide", 1},
                               {"wide:builder=fast", 1},
                               {"wide:builder=high", 1}};

template <class P>
void expect_limited(const char* name, const P& set) {
    SCOPED_TRACE(name);
    using T = typename P::Scalar;
    constexpr int D = P::dimension;
    Indexes<T, D> indexes;
    indexes.push_back(build_any("brute-force", set));
    for (const auto& [structure, items_per_primitive] : limited) {
        indexes.push_back(build_any(named_for<P>(structure), set));
        const auto& index = *indexes.back();
        EXPECT_LE(static_cast<double>(index.item_count()), items_per_primitive * double(set.size()))
            << structure;
        EXPECT_LE(index.bytes(), 100e3 + 64 * 64 * double(set.size())) << structure;
        if (set.size() < 10'000) {
            EXPECT_EQ(index.validate(), "") << structure;
        }
    }
    const Box<T, D> box = indexes[0]->bounds();
    const Points<T, D> targets = {box.low, box.center(), box.high};
    expect_equal_rays(indexes, targets, 0, 64);
    expect_equal_regions(indexes, 16);
}

std::uint32_t how_many() {
    return static_cast<std::uint32_t>(in_long_runs(100'000, 1000));
}

TEST(Crowded, FansKeepToTheLimit) {
    expect_limited("disc", crowded::fan<float>(how_many()));
    expect_limited("cone", crowded::fan<float>(how_many(), 0.7));
    expect_limited("disc in double", crowded::fan<double>(how_many() / 2));
    expect_limited("star", crowded::star<float>(how_many()));
}
TEST(Crowded, AlikeKeepToTheLimit) {
    expect_limited("triangles", crowded::alike<float>(how_many()));
    expect_limited("segments", crowded::alike_segments<float>(how_many()));
    expect_limited("points", crowded::alike_points<float, 3>(how_many()));
    expect_limited("points in the plane", crowded::alike_points<double, 2>(how_many()));
}
TEST(Crowded, CoincidentBoxesKeepToTheLimit) {
    expect_limited("boxes", crowded::boxes<float>(how_many()));
    expect_limited("triangles of equal boxes", crowded::around_origin<float>(how_many(), true));
    expect_limited("triangles of equal centers", crowded::around_origin<float>(how_many(), false));
    expect_limited("equal spheres", crowded::spheres_around_origin<float>(how_many(), true));
    expect_limited("spheres of equal centers", crowded::spheres_around_origin<float>(how_many(), false));
}

TEST(Crowded, StructuresAreTheSameForAnyNumberOfThreads) {
    const auto mesh = crowded::fan<float>(12'000, 0.01);
    const ThreadLimit limit(2);
    for (const char* structure : {"grid", "two-level-grid", "kdtree", "kdtree:builder=binned", "octree"}) {
        const auto serial = build_any(structure, mesh);
        for (int run = 0; run < 3; ++run) {
            const auto parallel = build_any(structure, mesh, default_executor());
            EXPECT_EQ(parallel->item_count(), serial->item_count()) << structure;
            EXPECT_EQ(parallel->node_count(), serial->node_count()) << structure;
            EXPECT_EQ(parallel->leaf_count(), serial->leaf_count()) << structure;
            EXPECT_EQ(parallel->bytes(), serial->bytes()) << structure;
        }
    }
}

TEST(Crowded, WithinTheLimitNothingChanges) {
    const auto mesh = teapot<float>(3000);
    for (const std::string structure : {"grid", "two-level-grid", "kdtree", "kdtree:builder=median", "bsp"}) {
        const auto usual = build_any(structure, mesh);
        const char separator = structure.find(':') == std::string::npos ? ':' : ',';
        const auto unlimited = build_any(structure + separator + "items_per_primitive=1e9", mesh);
        EXPECT_EQ(usual->item_count(), unlimited->item_count()) << structure;
        EXPECT_EQ(usual->node_count(), unlimited->node_count()) << structure;
    }
}

TEST(Crowded, AResolutionByHandIsKept) {
    const auto mesh = crowded::alike<float>(50);
    EXPECT_EQ(build_any("grid:resolution=20", mesh)->node_count(), 8000u);
    EXPECT_GT(build_any("grid:resolution=20", mesh)->item_count(), 50u * 100);
}

TEST(Crowded, LessThanAnItemAPrimitiveIsRefused) {
    const auto mesh = cube<float>(12);
    for (const double bad : {0.0, 0.5, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_THROW(build<Grid>(mesh, {.items_per_primitive = bad}), UsageError) << bad;
        EXPECT_THROW(build<TwoLevelGrid>(mesh, {.items_per_primitive = bad}), UsageError) << bad;
        EXPECT_THROW(build<Orthtree>(mesh, {.items_per_primitive = bad}), UsageError) << bad;
        EXPECT_THROW(build<BspTree>(mesh, {.items_per_primitive = bad}), UsageError) << bad;
        if (bad == 0) continue;  // 0: the limit of the builder
        EXPECT_THROW(build<KdTree>(mesh, {.items_per_primitive = bad}), UsageError) << bad;
    }
}

// ---- BSP trees compared with kd-trees, in cells of many primitives

/// Planks of 12 triangles each, turned in random directions.
TriangleMesh<float> planks(std::uint32_t n) {
    TriangleMesh<float> mesh;
    for (std::uint32_t i = 0; i < n; ++i) {
        Random random(5, i);
        const Vec3d along = random.direction<3>(), across = normalized(cross(along, random.direction<3>()));
        const Vec3d up = cross(along, across), at = random.in_cube<3>();
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (int corner = 0; corner < 8; ++corner) {
            const auto side = [&](int k) { return (corner >> k & 1) - 0.5; };
            mesh.vertices.emplace_back(at + along * (0.3 * side(0)) + across * (0.03 * side(1)) +
                                       up * (0.01 * side(2)));
        }
        constexpr std::uint32_t faces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                               {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
        for (const auto& f : faces) {
            mesh.triangles.push_back({first + f[0], first + f[1], first + f[2]});
            mesh.triangles.push_back({first + f[0], first + f[2], first + f[3]});
        }
    }
    return mesh;
}
double tests_a_ray(const AnyIndex<float, 3>& index) {
    std::vector<Ray<float, 3>> rays(1000);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        Random random(4, i);
        rays[i].origin = point_in(index.bounds(), 1, random);
        rays[i].direction = point_in(index.bounds(), 0, random) - rays[i].origin;
    }
    std::vector<Hit<float>> hits(rays.size());
    std::vector<Visits> visits(rays.size());
    closest_hits(index, rays, hits, {}, KeepAll(), visits);
    double tests = 0;
    for (const Visits& v : visits) tests += static_cast<double>(v.primitives);
    return tests / static_cast<double>(rays.size());
}

TEST(Bsp, InLargeCellsItsPlanesAreNoWorseThanAKdTrees) {
    for (const auto& mesh :
         {planks(100), planks(static_cast<std::uint32_t>(in_long_runs(600, 200))), soup<float>(3000)}) {
        const auto kd = build_any("kdtree", mesh), bsp = build_any("bsp", mesh);
        EXPECT_LT(tests_a_ray(*bsp), 1.1 * tests_a_ray(*kd)) << mesh.size();
    }
}
/// Large walls askew to the axes, and a small fine teapot. Cells between planes that coincide up to roundings
/// once became leaves of up to a hundred triangles.
TEST(Bsp, WallsAskewAreHardlyRepeatedAndLeavesStaySmall) {
    for (const std::uint64_t size : {1000u, 10'000u}) {
        const auto mesh = turned_stadium<float>(size);
        const auto kd = build_any("kdtree", mesh), bsp = build_any("bsp", mesh);
        EXPECT_LT(double(bsp->item_count()), 1.5 * double(mesh.size())) << size;
        EXPECT_LT(tests_a_ray(*bsp), tests_a_ray(*kd)) << size;
    }
}
/// Once, a plane just outside of all parts was chosen again and again, down to the last level.
TEST(Bsp, NoPlaneIsChosenTwice) {
    const auto mesh = planks(100);
    const auto usual = build_any("bsp", mesh), deep = build_any("bsp:max_depth=64", mesh);
    EXPECT_LT(deep->depth(), 50);
    EXPECT_LT(double(deep->node_count()), 1.1 * double(usual->node_count()));
}

}  // namespace
