/// Measuring what structures cost, judged by counts: no time is. And the changes that any index offers.
#include <atomic>

#include <gtest/gtest.h>

#include <hedgerow/any_index.h>
#include <hedgerow/base/error.h>
#include <hedgerow/measure/advice.h>
#include <hedgerow/measure/compare.h>
#include <hedgerow/measure/query_set.h>
#include <hedgerow/scenes/generate.h>

namespace hedgerow::measure {
namespace {

using Strings = std::vector<std::string>;

MeasureOptions quick_options() {
    MeasureOptions o;
    o.queries = 64, o.rounds = 3, o.build_seconds = 0;
    o.seconds = 100;  // enough for every structure to answer every query
    return o;
}
const StructureCost& named(const Comparison& c, std::string_view name) {
    return *std::find_if(c.structures.begin(), c.structures.end(),
                         [&](const auto& s) { return s.structure == name; });
}

TEST(Measure, CountsWhatIsVisited) {
    const auto mesh = teapot<float>(600);
    const Strings structures = {"brute-force", "bvh", "octree", "grid"};
    const Comparison c = compare(mesh, structures, quick_options());
    EXPECT_TRUE(c.finished);
    EXPECT_EQ(c.primitive, "triangles");
    EXPECT_EQ(c.size, mesh.size());
    ASSERT_EQ(c.structures.size(), 4u);
    // Sizes are those of the index, and brute force tests all primitives.
    for (const auto& s : c.structures) {
        const auto index = build_any(s.structure, mesh);
        EXPECT_EQ(s.bytes, index->bytes());
        EXPECT_EQ(s.items, index->item_count());
        EXPECT_EQ(s.depth, index->depth());
        EXPECT_EQ(s.builds, 1);
        ASSERT_EQ(s.queries.size(), 31u) << "15 of rays, 5 of points, 8 of regions, 3 of insides";
        for (const auto& q : s.queries) {
            EXPECT_EQ(q.asked, 64u) << q.kind;
            EXPECT_GT(q.seconds, 0) << q.kind;
            EXPECT_GE(q.spread, 0);
            if (s.structure == "brute-force") {
                EXPECT_EQ(q.nodes, 0);
                // A signed distance takes a search for the closest point, and one for the side.
                const double searches = q.ask == "signed-distance" ? 2 : 1;
                EXPECT_EQ(q.leaves, searches) << q.kind;
                EXPECT_EQ(q.primitives, searches * static_cast<double>(mesh.size())) << q.kind;
            } else {
                EXPECT_GT(q.nodes, 0) << q.kind;
                EXPECT_LT(q.primitives, static_cast<double>(mesh.size()) / 2) << q.kind;
            }
        }
    }
    // Updates have costs: a refit of a BVH, and single changes where the structure has them.
    EXPECT_EQ(named(c, "bvh").update.how, "refit");
    EXPECT_GT(named(c, "bvh").update.drift, 0.5);
    EXPECT_GT(named(c, "bvh").update.slowdown, 0);
    for (const char* name : {"brute-force", "bvh", "octree"}) {
        const UpdateCost& u = named(c, name).update;
        EXPECT_GT(u.insert, 0);
        EXPECT_EQ(u.one, u.erase + u.insert);
    }

    // A second measurement has the same counts.
    const Comparison again = compare(mesh, structures, quick_options());
    for (std::size_t i = 0; i < c.structures.size(); ++i)
        for (std::size_t k = 0; k < c.structures[i].queries.size(); ++k) {
            EXPECT_EQ(c.structures[i].queries[k].nodes, again.structures[i].queries[k].nodes);
            EXPECT_EQ(c.structures[i].queries[k].primitives, again.structures[i].queries[k].primitives);
        }
}
TEST(Measure, CountsWithoutTimesWhenThereAreNoRounds) {
    const auto mesh = teapot<float>(600);
    const Strings structures = {"brute-force", "bvh", "octree"};
    MeasureOptions counts = quick_options();
    counts.rounds = 0, counts.seconds = 1e-9;
    const Comparison timed = compare(mesh, structures, quick_options()),
                     c = compare(mesh, structures, counts);
    EXPECT_TRUE(c.finished);
    ASSERT_EQ(c.structures.size(), 3u);
    for (const StructureCost& s : c.structures) EXPECT_EQ(s.build_seconds, 0);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < c.structures[i].queries.size(); ++k) {
            const QueryCost &one = c.structures[i].queries.at(k), &other = timed.structures[i].queries.at(k);
            EXPECT_EQ(one.asked, 64u);
            EXPECT_EQ(one.seconds, 0);
            EXPECT_EQ(one.nodes, other.nodes);
            EXPECT_EQ(one.primitives, other.primitives);
        }
}
/// A closed room around a finely divided teapot. From outside, rays hit only the walls.
TriangleMesh<float> teapot_in_a_room() {
    TriangleMesh<float> mesh = teapot<float>(2000);
    const auto walls = cube<float>(12);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3f& p : walls.vertices) mesh.vertices.push_back(p * 8.f);
    for (const auto& [a, b, c] : walls.triangles)  // as seen from inside
        mesh.triangles.push_back({first + a, first + c, first + b});
    return mesh;
}
TEST(Measure, LeavesAllSurfacesWithIncoherentRays) {
    const Strings structures = {"bvh"};
    MeasureOptions o = quick_options();
    o.queries = 400, o.asks = {"closest-hit"};
    const auto mesh = teapot_in_a_room();
    // A camera outside of the room sees the walls.
    const Comparison outside = compare(mesh, structures, o);
    const auto& queries = outside.structures[0].queries;
    ASSERT_EQ(queries.size(), 3u);
    ASSERT_EQ(outside.rays.size(), 3u);
    EXPECT_EQ(outside.rays[1].kind, "incoherent");
    EXPECT_EQ(outside.rays[1].rays, 400u);
    EXPECT_EQ(outside.rays[1].missed, 0u) << "the room is closed";
    EXPECT_GT(queries[1].nodes, queries[0].nodes + 1) << "from inside, though the camera is outside";
    EXPECT_LT(outside.seen_from_outside, 0.03) << "twelve walls of 2000 triangles";

    // A camera inside changes the coherent rays and not the incoherent ones.
    o.camera = Camera{{-7, -7, 2}, {0, 0, 1.5f}, {0, 0, 1}, 40};
    const Comparison inside = compare(mesh, structures, o);
    EXPECT_EQ(inside.seen_from_outside, 1);
    EXPECT_EQ(inside.rays[0].missed, 0u);
    EXPECT_GT(inside.structures[0].queries[0].nodes, queries[0].nodes);
    EXPECT_EQ(inside.structures[0].queries[1].nodes, queries[1].nodes)
        << "places do not depend on the camera";

    EXPECT_GT(compare(teapot<float>(2000), structures, o).seen_from_outside, 0.2)
        << "a thing that is all outside";
    EXPECT_GT(compare(soup<float>(2000), structures, o).rays[1].missed, 20u);
}
TEST(Measure, SpreadsIncoherentRaysByArea) {
    // One large triangle faces away from a thousand small ones. Nearly all incoherent rays leave it and hit
    // nothing.
    TriangleMesh<float> mesh{{{0, 0, -9}, {0, 100, -9}, {100, 0, -9}}, {{0, 1, 2}}, {}};
    const auto ball = teapot<float>(1000);
    for (const Vec3f& p : ball.vertices) mesh.vertices.push_back(p);
    for (const auto& [a, b, c] : ball.triangles) mesh.triangles.push_back({3 + a, 3 + b, 3 + c});
    MeasureOptions o = quick_options();
    o.queries = 400, o.asks = {"closest-hit"};
    const Strings structures = {"bvh"};
    EXPECT_GT(compare(mesh, structures, o).rays[1].missed, 390u);
}
TEST(Measure, TakesEveryKindOfPrimitives) {
    const auto kinds = [](const auto& set, const char* tree) {
        const Strings structures = {"kdtree", tree};
        const Comparison c = compare(set, structures, quick_options());
        EXPECT_EQ(c.structures.size(), 2u);
        return c.structures.at(0).queries.size();
    };
    EXPECT_EQ(kinds(spheres<double>(200), "octree"), 27u) << "no features, no insides";
    EXPECT_EQ(kinds(segments2d<float>(200), "quadtree"), 31u);
    EXPECT_EQ(kinds(points<float>(200), "octree"), 12u) << "rays pass between points";
    EXPECT_EQ(kinds(points2d<double>(200), "quadtree"), 12u);
}
TEST(Measure, AsksWhatIsSlowLess) {
    MeasureOptions o = quick_options();
    o.queries = 10'000, o.seconds = 0.003, o.asks = {"nearest"}, o.updates = false;
    const Strings structures = {"brute-force", "kdtree"};
    const auto cloud = points<float>(50'000);
    const Comparison c = compare(cloud, structures, o);
    const QueryCost& q = c.structures[0].queries.at(0);
    EXPECT_GE(q.asked, 1u);
    EXPECT_LT(q.asked, 10'000u);
    EXPECT_EQ(q.primitives, 50'000);
}
TEST(Measure, BuildsWhereNoQuerySuitsThePrimitives) {
    MeasureOptions o = quick_options();
    o.asks = {"closest-hit"};
    const auto of_points = question_names<PointCloud<float, 3>>();
    EXPECT_EQ(std::count(of_points.begin(), of_points.end(), "closest-hit"), 0);
    EXPECT_EQ(std::count(of_points.begin(), of_points.end(), "nearest"), 1);
    const auto of_segments = question_names<SegmentSet<float>>();
    EXPECT_EQ(std::count(of_segments.begin(), of_segments.end(), "closest-hit"), 1);
    const Strings structures = {"kdtree", "bvh"};
    const Comparison c = compare(points<float>(200), structures, o);
    EXPECT_TRUE(c.finished);
    ASSERT_EQ(c.structures.size(), 2u);
    EXPECT_TRUE(c.structures[1].queries.empty());
    EXPECT_EQ(c.structures[1].update.slowdown, 1);
    EXPECT_EQ(advise(c, "closest-hit").size(), 4u);
}
TEST(Measure, RefusesWhatIsNotThere) {
    const Strings structures = {"bvh"};
    EXPECT_THROW(compare(TriangleMesh<float>{}, structures), InputError);
    const Strings unknown = {"bvhh"};
    EXPECT_THROW(compare(points<float>(10), unknown), InputError);
}
TEST(Measure, StopsWhenItIsTold) {
    std::atomic<bool> cancel{false};
    Progress progress;
    progress.cancel = &cancel;
    progress.report = [&](std::uint64_t done, std::uint64_t) { cancel = done >= 1; };
    const Strings structures = {"bvh", "kdtree", "grid"};
    const Comparison c =
        compare(points<float>(1000), structures, by(serial_executor(), quick_options()), progress);
    EXPECT_FALSE(c.finished);
    EXPECT_LT(c.structures.size(), 3u);

    cancel = false;
    MeasureOptions counts = quick_options();
    counts.rounds = 0;
    EXPECT_EQ(
        compare(points<float>(1000), structures, by(serial_executor(), counts), progress).structures.size(),
        1u)
        << "its counts are whole";
}
TEST(Measure, StopsBetweenTheQueriesOfOneKind) {
    const auto cloud = points<float>(100);
    const auto index = build_any("brute-force", cloud);
    std::vector<Neighbours<float, 3>> given;
    for (const Vec3f& p : cloud.points) given.push_back({p, 8});
    QuerySetOf<AskNearest<float, 3>, float, 3> questions("8 nearest", given);
    const std::atomic<bool> cancel{true};
    Visits visits;
    EXPECT_THROW(questions.answers(*index, visits, {{}, &cancel}), Cancelled);
    EXPECT_EQ(questions.answers(*index, visits).size(), 100u);
    EXPECT_EQ(visits.primitives, 100u * 100u);
}

TEST(AnyIndexChanges, AreOfferedWhereTheStructureHasThem) {
    // An octree inserts and erases single primitives but does not refit.
    auto cloud = points<float>(500);
    const auto tree = build_any("octree", cloud);
    ASSERT_TRUE(tree->changes_one_by_one());
    EXPECT_FALSE(tree->refittable());
    EXPECT_TRUE(tree->erase(7));
    EXPECT_FALSE(tree->erase(7));
    cloud.points[7] = {0.5f, 0.5f, 0.5f};
    EXPECT_TRUE(tree->insert(7));
    const Vec3f p(0.5f, 0.5f, 0.5f);
    Near<float, 3> near;
    closest_points(*tree, {&p, 1}, {&near, 1});
    EXPECT_EQ(near.element, 7u);
    EXPECT_THROW(tree->refit(), InputError);

    // A BVH refits.
    const auto bvh = build_any("bvh", cloud);
    ASSERT_TRUE(bvh->refittable());
    cloud.points[9] = {2, 2, 2};
    EXPECT_GT(bvh->refit(), 0);
    EXPECT_EQ(bvh->validate(), "");
    const Vec3f q(2, 2, 2);
    closest_points(*bvh, {&q, 1}, {&near, 1});
    EXPECT_EQ(near.element, 9u);

    // A solid is made again of what has changed.
    const auto mesh = teapot<float>(600);
    const auto solid = build_any("octree", mesh), oracle = build_any("brute-force", mesh);
    const std::vector<Vec3f> places(64, oracle->bounds().center());
    std::vector<double> want(places.size()), got(places.size());
    winding_numbers(oracle->solid(), places, want);
    for (int round = 0; round < 3; ++round) {
        winding_numbers(solid->solid(), places, got);
        EXPECT_EQ(got, want);
        for (PrimitiveId id = 0; id < mesh.size(); id += 2) EXPECT_TRUE(solid->erase(id));
        EXPECT_THROW(solid->solid(), InputError) << "half of the surface is missing";
        for (PrimitiveId id = 0; id < mesh.size(); id += 2) EXPECT_TRUE(solid->insert(id));
    }

    // A grid does neither.
    const auto grid = build_any("grid", cloud);
    EXPECT_FALSE(grid->changes_one_by_one());
    EXPECT_FALSE(grid->refittable());
    EXPECT_THROW(grid->insert(0), InputError);
    EXPECT_THROW(grid->erase(0), InputError);
    EXPECT_THROW(grid->refit(), InputError);
}

}  // namespace
}  // namespace hedgerow::measure
