/// Structures that cut space: clipped bounds, mailboxes, memory and visits. The matrix and property tests
/// check that their answers are right.
#include <set>

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>
#include <hedgerow/trace.h>

#include "contract.h"
#include "exact.h"

using namespace hedgerow;

namespace {

template <class T>
class Cells : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Cells, Scalars);

/// The bounds of the points of a fine net on a triangle that are in a box. They are never outside the bounds
/// of the clipped triangle.
template <class T>
Box<T, 3> bounds_by_net(const Triangle<T, 3>& t, const Box<T, 3>& box, int n) {
    Box<T, 3> bounds;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j) {
            const Vec3d a(t.a), ab = Vec3d(t.b) - a, ac = Vec3d(t.c) - a;
            const Vec<T, 3> p(a + ab * (double(i) / n) + ac * (double(j) / n));
            if (box.contains(p)) bounds.expand(p);
        }
    return bounds;
}

TYPED_TEST(Cells, ClippedBoundsHoldThePartAndNoMore) {
    using T = TypeParam;
    constexpr int net = 64;
    int parts = 0;
    for (std::uint64_t i = 0; i < 300; ++i) {
        Random random(1, i);
        const auto corner = [&] { return exact::in_ball<T, 3>(random, 1); };
        const Triangle<T, 3> t{corner(), corner(), corner()};
        const auto box = exact::box_of(corner(), corner());
        const auto clipped = clipped_bounds(t, box), seen = bounds_by_net(t, box, net);
        if (seen.empty()) continue;
        ++parts;
        const auto around = enlarged(clipped, T(4) * unit_roundoff<T>);
        ASSERT_TRUE(around.contains(seen)) << i;
        // Every place on the border of the clipped part has a net point within two steps of the net.
        const T step = T(4) * max_component(t.bounds().extent()) / net;
        if (length(cross(t.b - t.a, t.c - t.a)) > T(0.2) && max_component(clipped.extent()) > 4 * step) {
            ASSERT_TRUE(enlarged(seen, 3 * step).contains(clipped)) << i;
        }
    }
    EXPECT_GT(parts, 100);
}

TYPED_TEST(Cells, ClippedBoundsOfWhatIsInsideAreItsOwn) {
    using T = TypeParam;
    const Triangle<T, 3> t{{0, 0, 0}, {1, 0, 2}, {0, 3, 1}};
    const Box<T, 3> around{{-1, -1, -1}, {4, 4, 4}}, beside{{5, 5, 5}, {6, 6, 6}};
    // A corner of the triangle's bounds that the triangle itself does not touch.
    const Box<T, 3> corner{{T(0.9), T(2.5), 0}, {1, 3, 2}};
    EXPECT_EQ(clipped_bounds(t, around), t.bounds());
    EXPECT_TRUE(clipped_bounds(t, beside).empty());
    EXPECT_TRUE(overlap(t.bounds(), corner));
    EXPECT_TRUE(clipped_bounds(t, corner).empty());
    const Segment<T, 2> s{{0, 0}, {4, 2}};
    EXPECT_EQ(clipped_bounds(s, Box<T, 2>{{1, 0}, {2, 9}}), (Box<T, 2>{{1, T(0.5)}, {2, 1}}));
    EXPECT_TRUE(clipped_bounds(s, Box<T, 2>{{3, 0}, {4, 1}}).empty());
}

/// The visits of 400 rays between points of the scene, in a structure with these options.
template <template <class, int> class S, class T>
Visits visits_of(const TriangleMesh<T>& mesh, const typename S<T, 3>::Options& options) {
    const auto index = build<S>(mesh, options);
    Visits all;
    for (std::uint64_t i = 0; i < 400; ++i) {
        Random random(4, i);
        const auto from = matrix::point_in(index.bounds(), 0.0, random);
        const auto to = matrix::point_in(index.bounds(), 0.0, random);
        closest_hit(index, Ray<T, 3>{from, to - from}, KeepAll{}, all);
    }
    return all;
}

TYPED_TEST(Cells, AMailboxSparesTestsAndNothingElse) {
    const auto mesh = teapot_in_stadium<TypeParam>(3000);
    const auto compare = [&](Visits with, Visits without) {
        EXPECT_EQ(with.nodes, without.nodes);
        EXPECT_EQ(with.leaves, without.leaves);
        EXPECT_GT(with.skipped, 0u);
        EXPECT_EQ(without.skipped, 0u);
        EXPECT_EQ(with.primitives + with.skipped, without.primitives);
    };
    compare(visits_of<KdTree>(mesh, {.mailbox = true}), visits_of<KdTree>(mesh, {.mailbox = false}));
    compare(visits_of<Grid>(mesh, {.mailbox = true}), visits_of<Grid>(mesh, {.mailbox = false}));
    compare(visits_of<TwoLevelGrid>(mesh, {.mailbox = true}),
            visits_of<TwoLevelGrid>(mesh, {.mailbox = false}));
}

/// Ids run in the rows of a terrain, and in the rings and patches of a stadium with a teapot, upright and
/// turned.
TYPED_TEST(Cells, AMailboxSparesNineInTenRepeatedTests) {
    using T = TypeParam;
    const auto spares = [](const auto& index) {
        std::uint64_t needed = 0, made = 0, without = 0;
        for (std::uint64_t i = 0; i < 500; ++i) {
            Random random(7, i);
            const auto from = matrix::point_in(index.bounds(), 0.0, random);
            const auto way =
                trace(index, Ray<T, 3>{from, matrix::point_in(index.bounds(), 0.0, random) - from});
            std::set<PrimitiveId> different;
            for (const auto& step : way.steps)
                for (const auto& test : step.tests) different.insert(test.id);
            needed += different.size(), made += way.visits.primitives;
            without += way.visits.primitives + way.visits.skipped;
        }
        EXPECT_LT(needed, without);
        EXPECT_LT(10 * (made - needed), without - needed) << needed << " " << made << " " << without;
    };
    for (const auto& mesh : {terrain<T>(20000), teapot_in_stadium<T>(20000), turned_stadium<T>(20000)})
        spares(build<KdTree>(mesh, {.builder = KdBuilder::binned}));
    // The turned stadium is left out, because some cells of its grid have more primitives than a mailbox
    // remembers.
    for (const auto& mesh : {terrain<T>(20000), teapot_in_stadium<T>(20000)}) spares(build<Grid>(mesh));
}

TYPED_TEST(Cells, ExactEnteringLeavesOutOnlyWhatIsNotThere) {
    const auto mesh = soup<TypeParam>(2000);
    const GridResolution fine{.resolution = 40};
    const auto exact = build<Grid>(mesh, {.cells = fine, .insert = GridInsert::exact});
    const auto box = build<Grid>(mesh, {.cells = fine, .insert = GridInsert::box});
    EXPECT_LT(exact.structure().items().size(), box.structure().items().size() * 8 / 10);
    EXPECT_EQ(exact.validate(), "");
    EXPECT_EQ(box.validate(), "");
}

TYPED_TEST(Cells, AGridsMemoryGrowsWithTheOccupiedCells) {
    const auto mesh = teapot<TypeParam>(2000);
    const auto at = [&](int resolution) {
        return build<Grid>(mesh, {.cells = {.resolution = resolution}}).structure();
    };
    const auto coarse = at(64), fine = at(512);
    // There are 512 times as many cells, but a surface occupies only about 64 times as many.
    EXPECT_LT(fine.leaf_count(), 100 * coarse.leaf_count());
    for (const auto& grid : {coarse, fine})
        EXPECT_LT(grid.bytes(), 4 * grid.items().size() + 56 * grid.leaf_count() + 256);
    EXPECT_LT(fine.bytes(), fine.node_count() / 2);
}

/// Counts all hits of rays, some of them along an axis or from cell corner to cell corner.
TYPED_TEST(Cells, AGridStepsOverEmptyBlocksAndMissesNothing) {
    using T = TypeParam;
    // Compare a grid that steps over empty blocks with one that does not.
    const auto compare = [](const auto& set, auto ray_of) {
        using Set = std::remove_cvref_t<decltype(set)>;
        constexpr int D = Set::dimension;
        typename Grid<T, D>::Options options{.cells = {.resolution = D == 3 ? 100 : 1000}};
        const auto with = build<Grid>(set, options);
        options.skip_empty = false;
        const auto without = build<Grid>(set, options);
        Visits fast, slow;
        for (std::uint64_t i = 0; i < 1000; ++i) {
            Random random(9, i);
            const Ray<T, D> ray = ray_of(with.bounds(), random);
            Visits a, b;
            EXPECT_EQ(hit_count(with, ray, KeepAll{}, a), hit_count(without, ray, KeepAll{}, b));
            EXPECT_EQ(a.leaves, b.leaves) << i;
            EXPECT_EQ(a.primitives, b.primitives) << i;
            EXPECT_LE(a.nodes, b.nodes) << i;
            fast += a, slow += b;
        }
        EXPECT_LT(2 * fast.nodes, slow.nodes);
    };
    // Rays anywhere, half of them along an axis.
    const auto anywhere = [](const auto& bounds, Random& random) {
        constexpr int D = std::remove_cvref_t<decltype(bounds)>::dimension;
        const auto from = matrix::point_in(bounds, 0.5, random);
        Vec<T, D> to = matrix::point_in(bounds, 0.0, random);
        const int along = static_cast<int>(random.uniform(0, 2 * D));
        for (int a = 0; a < D && along < D; ++a)
            if (a != along) to[a] = from[a];
        return Ray<T, D>{from, to - from};
    };
    // Rays between corners of the lattice.
    const auto on_the_lattice = [](const auto& bounds, Random& random) {
        constexpr int D = std::remove_cvref_t<decltype(bounds)>::dimension;
        Ray<T, D> ray{bounds.low, bounds.extent()};
        for (int a = 0; a < D; ++a) {
            ray.origin[a] += bounds.extent()[a] * T(std::floor(random.uniform(0, 25)) / 25);
            ray.direction[a] *= T(std::floor(random.uniform(-2, 3)));
        }
        return ray;
    };
    compare(teapot<T>(2000), anywhere);
    compare(teapot<T>(2000), on_the_lattice);
    compare(segments2d<T>(200), anywhere);
}

TYPED_TEST(Cells, AGridBeyondItsBudgetIsRefused) {
    const auto mesh = soup<TypeParam>(1000);
    for (const double budget : {1e4, 1e6}) {
        EXPECT_THROW(build<Grid>(mesh, {.cells = {.resolution = 500}, .budget = budget}), InputError);
        EXPECT_THROW(build<TwoLevelGrid>(mesh, {.cells = {.resolution = 500}, .budget = budget}), InputError);
    }
    EXPECT_NO_THROW(build<Grid>(mesh, {.cells = {.density = 1}, .budget = 1e6}));
}

TYPED_TEST(Cells, ManyEqualPrimitivesMakeNoDeepTree) {
    TriangleMesh<TypeParam> mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
    mesh.triangles.assign(1000, {0, 1, 2});
    for (const auto builder : {KdBuilder::sah, KdBuilder::binned, KdBuilder::median, KdBuilder::midpoint}) {
        const auto index = build<KdTree>(mesh, {.builder = builder});
        EXPECT_LT(index.structure().items().size(), 200 * mesh.size());
        EXPECT_EQ(index.validate(), "");
    }
    EXPECT_EQ(build<TwoLevelGrid>(mesh).validate(), "");
}

/// The more planes a builder compares by the SAH, the less the work of queries, weighed as the SAH weighs it.
TYPED_TEST(Cells, PlanesByCostVisitFewerThanPlainOnes) {
    const auto mesh = teapot_in_stadium<TypeParam>(3000);
    const auto work = [&](KdBuilder builder) {
        const Visits v = visits_of<KdTree>(mesh, {.builder = builder});
        const KdCosts costs;
        return costs.traversal_cost * double(v.nodes) + costs.intersection_cost * double(v.primitives);
    };
    const double sah = work(KdBuilder::sah);
    EXPECT_LT(sah, 1.1 * work(KdBuilder::binned));
    EXPECT_LT(sah, 0.8 * work(KdBuilder::median));
    EXPECT_LT(sah, 0.8 * work(KdBuilder::midpoint));
}

/// The teapot, and the field below it, are in a few cells of the first level. The second level divides these.
TYPED_TEST(Cells, TwoLevelsRecoverFromATeapotInAStadium) {
    using T = TypeParam;
    const auto mesh = teapot_in_stadium<T>(20000);
    const auto visits = [&](const auto& index) {
        Visits all;
        for (std::uint64_t i = 0; i < 400; ++i) {
            Random random(4, i);
            const auto place = [&](double reach) { return Vec<T, 3>(random.direction<3>() * reach); };
            const Vec<T, 3> from = place(30), to = place(2);
            closest_hit(index, Ray<T, 3>{from, to - from}, KeepAll{}, all);
        }
        return all;
    };
    const Visits one = visits(build<Grid>(mesh)), two = visits(build<TwoLevelGrid>(mesh));
    EXPECT_LT(5 * two.primitives, one.primitives);
    EXPECT_LT(two.nodes, 5 * one.nodes);
}

}  // namespace
