/// Walks serve more than rays: two queries of the user's own run over the same walkers, range counting that
/// accepts whole subtrees and a monopole Barnes-Hut. Also filters, counts of visits, and builds.
#include <gtest/gtest.h>

#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>
#include <hedgerow/scenes/sets.h>

#include "matrix.h"

using namespace hedgerow;

namespace {

/// The points below a node: their box, number and sum. The sum over the number is the center of unit masses.
struct Below {
    Box3d box;
    double count = 0;
    Vec3d sum;
};

template <class I>
std::vector<Below> gather(const I& index) {
    return fold(
        index.structure(),
        [&](const Leaf& leaf) {
            Below b;
            for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
                const Vec3d p = index.primitives().point(leaf.ids[i]);
                b.box.expand(p);
                b.count += 1;
                b.sum = b.sum + p;
            }
            return b;
        },
        [](const Below& a, const Below& b) {
            return Below{merged(a.box, b.box), a.count + b.count, a.sum + b.sum};
        });
}

/// Counts the points in a box, one by one.
struct PlainCount {
    using Probe = BoxProbe<double, 3>;
    static constexpr Order order = Order::none;
    Probe asked;
    double counted = 0;

    const Probe& probe() const { return asked; }
    double limit() const { return std::numeric_limits<double>::max(); }
    Flow offer(const OverlapCandidate&) { return ++counted, Flow::go_on; }
};
/// Counts the points in a box. Subtrees wholly inside are counted and not opened.
struct RangeCount : PlainCount {
    const std::vector<Below>& below;

    RangeCount(const Probe& box, const std::vector<Below>& all) : PlainCount{box}, below(all) {}
    Verdict accept(const auto& node) {
        const Below& b = below[node.id()];
        if (b.count == 0) return Verdict::prune;
        if (!asked.box().contains(b.box)) return Verdict::open;
        EXPECT_EQ(static_cast<double>(node.count()), b.count);
        counted += b.count;
        return Verdict::accept;
    }
};

/// The acceleration at a point, G = 1, unit masses (Barnes and Hut 1986): a node seen under less than the
/// opening angle (its width over the distance of its center of mass) acts as one mass.
struct BarnesHut {
    using Probe = PointProbe<double, 3>;
    static constexpr Order order = Order::none;
    Probe asked;
    const std::vector<Below>& below;
    double opening_angle;
    Vec3d acceleration{};

    const Probe& probe() const { return asked; }
    double limit() const { return std::numeric_limits<double>::max(); }
    void attract(const Vec3d& from, double mass) {
        const Vec3d r = from - asked.point();
        const double d2 = length2(r);
        if (d2 > 0) acceleration = acceleration + r * (mass / (d2 * std::sqrt(d2)));
    }
    Flow offer(const PointCandidate<double, 3>& c) { return attract(c.point, 1), Flow::go_on; }
    Verdict accept(const auto& node) {
        const Below& b = below[node.id()];
        if (b.count == 0) return Verdict::prune;
        const Vec3d center = b.sum / b.count;
        if (max_component(b.box.extent()) >= opening_angle * length(center - asked.point()))
            return Verdict::open;
        attract(center, b.count);
        return Verdict::accept;
    }
};

template <class I>
void expect_counts(const I& index, const PointCloud<double, 3>& cloud) {
    const auto below = gather(index);
    Visits with_subtrees, one_by_one;
    for (std::uint64_t i = 0; i < 100; ++i) {
        Random random(2, i);
        Box3d box;
        for (int k = 0; k < 2; ++k) box.expand(Vec3d(random.uniform(), random.uniform(), random.uniform()));
        double direct = 0;
        for (const auto& p : cloud.points) direct += box.contains(p);
        RangeCount query{BoxProbe<double, 3>(box), below};
        index.ask(query, with_subtrees);
        EXPECT_EQ(query.counted, direct);
        PlainCount plain{BoxProbe<double, 3>(box)};
        index.ask(plain, one_by_one);
        EXPECT_GE(plain.counted, direct);  // a point may be in several cells
        std::vector<PrimitiveId> found;
        EXPECT_EQ(static_cast<double>(overlapping(index, box, found)), direct);
    }
    EXPECT_LT(with_subtrees.primitives, one_by_one.primitives);
}

TEST(Walkers, RangeCountingAcceptsWholeSubtrees) {
    const auto cloud = points<double>(5000);
    expect_counts(build<Bvh>(cloud), cloud);
    expect_counts(build<KdTree>(cloud), cloud);
    expect_counts(build<Orthtree>(cloud), cloud);
    expect_counts(build<WideBvh>(cloud), cloud);
    expect_counts(build<PointOrthtree>(cloud), cloud);
}

template <class I>
double barnes_hut_error(const I& index, const std::vector<Below>& below, const PointCloud<double, 3>& cloud,
                        double angle) {
    double worst = 0;
    for (std::size_t i = 0; i < 50; ++i) {
        const Vec3d& p = cloud.points[i * 7];
        BarnesHut direct{PointProbe<double, 3>(p), below, 0}, query{PointProbe<double, 3>(p), below, angle};
        for (const auto& q : cloud.points) direct.attract(q, 1);
        index.ask(query);
        worst =
            std::max(worst, length(query.acceleration - direct.acceleration) / length(direct.acceleration));
    }
    return worst;
}

TEST(Walkers, BarnesHutNearsTheDirectSumAsTheAngleShrinks) {
    const auto cloud = points<double>(2000);
    const auto check = [&](const auto& index) {
        const auto below = gather(index);
        EXPECT_LT(barnes_hut_error(index, below, cloud, 0), 1e-12);
        EXPECT_LT(barnes_hut_error(index, below, cloud, 0.2), 0.01);
        EXPECT_LT(barnes_hut_error(index, below, cloud, 0.2), barnes_hut_error(index, below, cloud, 0.8));
    };
    check(build<Bvh>(cloud));
    check(build<KdTree>(cloud));
    check(build<Orthtree>(cloud));
    check(build<WideBvh>(cloud));
}

TEST(Walkers, FiltersRefuseWhatTheListOfAllHitsHolds) {
    const auto mesh = soup<float>(500);
    const auto index = build(mesh);
    std::vector<std::uint32_t> masks(mesh.size());
    for (std::size_t i = 0; i < masks.size(); ++i) masks[i] = 1u << (i % 3);
    std::vector<Hit<float>> all;
    for (std::uint64_t i = 0; i < 1000; ++i) {
        Random random(6, i);
        const Ray3f ray{Vec3f(0.5f, 0.5f, 0.5f) + Vec3f(random.direction<3>()) * 2.f,
                        Vec3f(random.direction<3>())};
        const Ray3f in{ray.origin, Vec3f(0.5f, 0.5f, 0.5f) - ray.origin};
        all_hits(index, in, all);
        // The answers with a filter follow from the list of all hits.
        const auto expect = [&](auto filter) {
            const auto first = std::find_if(all.begin(), all.end(), filter);
            const auto hit = closest_hit(index, in, filter);
            ASSERT_EQ(bool(hit), first != all.end());
            if (hit) {
                EXPECT_EQ(hit, *first);
            }
            EXPECT_EQ(any_hit(index, in, filter), bool(hit));
            EXPECT_EQ(hit_count(index, in, filter),
                      static_cast<std::size_t>(std::count_if(all.begin(), all.end(), filter)));
        };
        if (!all.empty()) expect(Except{all[0].element});
        expect(CullBackFaces<TriangleMeshView<float>>{mesh.view(), in.direction});
        expect([&](const Hit<float>& h) { return (masks[h.element] & 5) != 0; });
        expect([](const Hit<float>& h) { return h.u + h.v < 0.5f; });
    }
}

TEST(Walkers, VisitsAreCountedOnlyWhenAsked) {
    const auto mesh = teapot<float>(1000);
    const auto index = build(mesh);
    const auto oracle = build<BruteForce>(mesh);
    const Ray3f ray{{10, 9, 8}, {-10, -9, -7}};
    Visits visits, again, all;
    EXPECT_EQ(closest_hit(index, ray, KeepAll{}, visits), closest_hit(index, ray));
    closest_hit(index, ray, KeepAll{}, again);
    closest_hit(oracle, ray, KeepAll{}, all);
    EXPECT_EQ(visits, again);
    EXPECT_GT(visits.nodes, 0u);
    EXPECT_EQ(all.primitives, mesh.size());
    EXPECT_LT(visits.primitives, all.primitives);
}

/// A row of walls. Every structure skips the walls behind the one that is hit.
TEST(Walkers, PassOverWhatLiesBehindTheHit) {
    constexpr std::uint32_t walls = 512;
    TriangleMesh<float> row;
    for (std::uint32_t i = 0; i < walls; ++i) {
        const auto x = static_cast<float>(i);
        row.vertices.insert(row.vertices.end(), {{x, 0, 0}, {x, 1, 0}, {x, 0, 1}, {x, 1, 1}});
        row.triangles.push_back({4 * i, 4 * i + 1, 4 * i + 2});
        row.triangles.push_back({4 * i + 3, 4 * i + 2, 4 * i + 1});
    }
    // Compare the visits of the closest hit with those of all hits.
    const Ray3f ray{{-1, 0.3f, 0.4f}, {1, 0, 0}};
    for (const auto& name : structures_for<TriangleMesh<float>>()) {
        if (name == "brute-force") continue;
        SCOPED_TRACE(name);
        const auto index = build_any(name, row);
        Hit<float> hit;
        std::vector<Hit<float>> hits;
        Visits closest, all;
        closest_hits(*index, {&ray, 1}, {&hit, 1}, {}, KeepAll(), std::span(&closest, 1));
        all_hits(*index, ray, hits, KeepAll(), all);
        EXPECT_EQ(hit.t, 1);
        EXPECT_EQ(hits.size(), walls);
        EXPECT_LE(closest.primitives, 8u);
        EXPECT_LE(closest.leaves, 2u);
        EXPECT_LT(2 * closest.nodes, all.nodes);
    }
}

TEST(Builds, GiveTheSameTreeForAnyNumberOfThreads) {
    const auto mesh = soup<float>(50000);
    const auto serial = build(mesh);
    const ThreadLimit limit(2);
    for (int run = 0; run < 3; ++run) {
        const auto parallel = build(mesh, default_executor());
        ASSERT_TRUE(std::ranges::equal(serial.structure().items(), parallel.structure().items()));
        ASSERT_EQ(serial.structure().sah_cost(), parallel.structure().sah_cost());
    }
}

TEST(Builds, OwnWhatTheyAreGivenAndMove) {
    auto owned = build(teapot<float>(500));
    const auto mesh = teapot<float>(500);
    const auto borrowed = build(mesh);
    const auto moved = std::move(owned);
    const Ray3f ray{{10, 9, 8}, {-10, -9, -7}};
    EXPECT_EQ(closest_hit(moved, ray), closest_hit(borrowed, ray));
}

TEST(Builds, TroublesomeCasesEndInSensibleLeaves) {
    TriangleMesh<float> mesh;  // all boxes equal, hence all centers
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
    mesh.triangles.assign(1000, {0, 1, 2});
    for (const auto builder : bvh_builders) {
        Bvh<float, 3>::Options options;
        options.builder = builder;
        const auto index = build<Bvh>(mesh, options);
        EXPECT_EQ(index.validate(), "");
        EXPECT_GE(index.structure().leaf_count(), 125u);
        EXPECT_LE(index.structure().depth(), 12);
    }
}

TEST(Builds, DepthIsBoundedOnGeometricProgressions) {
    PointCloud<double, 3> cloud;
    for (int i = 0; i < 900; ++i)
        cloud.points.emplace_back(std::ldexp(1.0, i % 450 - 400), std::ldexp(1.0, i - 450), 0.0);
    for (const auto builder : bvh_builders) {
        Bvh<double, 3>::Options options;
        options.builder = builder;
        const auto index = build<Bvh>(cloud, options);
        EXPECT_EQ(index.validate(), "");
        EXPECT_LE(index.structure().depth(), bvh_max_depth);
    }
}

TEST(Builds, NameTheFirstBadPrimitive) {
    auto mesh = teapot<float>(100);
    mesh.vertices[mesh.triangles[7][1]][2] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(build(mesh), InputError);
    mesh = teapot<float>(100);
    mesh.triangles[3][1] = 1u << 30;
    try {
        build(mesh);
        FAIL();
    } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find("triangle 3"), std::string::npos) << e.what();
    }
}

}  // namespace
