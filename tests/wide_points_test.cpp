/// The engine's kernels of points: every instruction set of this machine gives the bits of brute force, one
/// point at a time and in batches of any size, on trees of any width.
#include "engine.h"
#include "lists.h"
#include "long_runs.h"

#include <cmath>
#include <cstring>

#include <hedgerow/engine/wide_bvh.h>
#include <hedgerow/mesh_index.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/structures/brute_force.h>
#include <hedgerow/structures/bvh/bvh.h>
#include <hedgerow/structures/kdtree/point_kdtree.h>

using namespace hedgerow;
using namespace hedgerow::matrix;

namespace {

using Mesh = TriangleMesh<float>;
using Found = std::vector<Near<float, 3>>;

constexpr float anywhere = std::numeric_limits<float>::max();

/// A point on a primitive, at a corner of it, or on an edge.
Vec3f place_on(const Mesh& mesh, std::size_t element, Random& random, bool corner, bool edge) {
    const auto t = mesh.view().triangle(element);
    const float v = static_cast<float>(random.uniform()), w = edge ? 0 : (1 - v) * 0.5f;
    return corner ? t.a : t.a + (t.b - t.a) * v + (t.c - t.a) * w;
}
Vec3f place_on(const PointCloud<float, 3>& cloud, std::size_t element, Random&, bool, bool) {
    return cloud.points[element];
}

/// Points of every kind: around, far and very far from the scene, on primitives, and next to them.
template <class Set>
std::vector<Vec3f> points_of(const Set& set, const Box3f& box, std::size_t count) {
    std::vector<Vec3f> points;
    for (std::uint64_t i = 0; i < count; ++i) {
        Random random(21, i);
        points.push_back(point_in(box, i % 8 == 0 ? 1000.0 : i % 4 == 0 ? 3.0 : 0.05, random));
        if (set.size() == 0 || i % 2 == 0) continue;
        Vec3f& p = points.back();
        p = place_on(set, random.bits() % set.size(), random, i % 10 == 1, i % 6 == 1);
        const float size = max_component(box.extent());
        if (i % 10 == 3) p[1] = std::nextafter(p[1], anywhere);
        if (i % 10 == 5) p[2] += size * 1e-6f;
        if (i % 10 == 7) p[0] -= size * 1e-3f;
        if (i % 10 == 9) p = p + (p - box.center()) * 0.1f;
    }
    return points;
}

/// Expects the closest points `want`, in a batch and one by one.
template <class Index>
void expect_found(const Index& index, const std::vector<Vec3f>& points, const Found& want, float within) {
    Found batch(points.size());
    closest_points(index, points, batch, {.radius2 = within, .threads = serial_executor()});
    for (std::size_t i = 0; i < points.size(); ++i) {
        ASSERT_EQ(want[i], batch[i]) << "in a batch, point " << i << ": " << want[i].distance2 << " and "
                                     << batch[i].distance2;
        const auto one = closest_point(index, points[i], {.radius2 = within});
        ASSERT_EQ(want[i], one) << "alone, point " << i << ": " << want[i].distance2 << " and "
                                << one.distance2;
    }
}
/// Expects the nearest and those within a distance as brute force finds them.
template <class Index, class Brute>
void expect_lists(const Index& index, const Brute& brute, const Vec3f& p, std::size_t k, float within2) {
    Found want, found;
    nearest(brute, p, k, want, {.radius2 = within2});
    EXPECT_EQ(nearest(index, p, k, found, {.radius2 = within2}), want.size());
    ASSERT_EQ(want, found) << k << " nearest";
    within(brute, p, PointOptions::anywhere, want, {.radius2 = within2});
    EXPECT_EQ(within(index, p, PointOptions::anywhere, found, {.radius2 = within2}), want.size());
    ASSERT_EQ(want, found) << "within " << within2;
}

/// Expects balls to contain as many points as brute force finds: about none, some, and all. On lattices many
/// are at the radius itself.
template <class Index, class Brute>
void expect_counts(const Index& index, const Brute& brute, const Vec3f& p, float to_closest) {
    const float extent = max_component(brute.bounds().extent());
    for (const float radius :
         {0.0f, to_closest, 2 * to_closest, 0.25f * extent, 0.5f * extent, extent, 3 * extent}) {
        const Sphere<float, 3> ball{p, radius};
        ASSERT_EQ(overlap_count(brute, ball), overlap_count(index, ball))
            << "radius " << radius << " about " << p[0] << " " << p[1] << " " << p[2];
    }
}

/// Expects a batch of k nearest to write what `nearest` finds, point by point.
template <class Index>
void expect_columns(const Index& index, const std::vector<Vec3f>& points, std::size_t k, float within2) {
    const auto lists = nearest(index, points, k, {.radius2 = within2});
    ASSERT_EQ(lists.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        ASSERT_TRUE(same_list(lists[i], nearest(index, points[i], k, {.radius2 = within2}))) << "point " << i;
}

/// Compares all instruction sets and widths with brute force, at `count` points of every kind.
template <class Set>
void expect_brute_force(const char* name, const Set& set, std::size_t count) {
    SCOPED_TRACE(name);
    const auto brute = build<BruteForce>(set);
    const auto points = points_of(set, brute.bounds(), count);
    Found want(points.size());
    closest_points(brute, points, want, {.threads = default_executor()});
    std::vector<float> distances;
    for (const auto& near : want) distances.push_back(near.distance2);
    std::sort(distances.begin(), distances.end());
    const float middle = distances[distances.size() / 2];
    for_each_kernel(set, [&](const auto& index, std::string_view) {
        expect_found(index, points, want, anywhere);
        // A maximum is included; half of the points find nothing within it.
        Found within = want;
        for (auto& near : within)
            if (!(near.distance2 <= middle)) near = {};
        expect_found(index, points, within, middle);
        for (const std::size_t k : {1u, 5u, 20u})
            expect_columns(index, points, k, k == 5 ? middle : anywhere);
        // Lists: none, some, as many as there are and more, also where many are equally far away.
        constexpr std::size_t ks[] = {0, 1, 2, 8, 33, 300, 100000};
        for (std::size_t i = 0; i < points.size() && !testing::Test::HasFatalFailure(); i += 17) {
            const float enough = want[i].distance2 * (i % 2 == 0 ? 1.0f : 4.0f);
            expect_lists(index, brute, points[i], ks[i % 7], i % 3 == 0 ? enough : anywhere);
        }
        if constexpr (PointSet<ViewOf<Set>>) {
            for (std::size_t i = 0; i < points.size() && !testing::Test::HasFatalFailure(); i += 5)
                expect_counts(index, brute, points[i], std::sqrt(want[i].distance2));
        }
    });
}

void transform(Mesh& mesh, float scale, const Vec3f& shift) {
    for (auto& v : mesh.vertices) v = v * scale + shift;
}

TEST(WidePoints, GeneratedMeshesAsBruteForce) {
    expect_brute_force("soup", soup<float>(500), 1500);
    expect_brute_force("stadium", teapot_in_stadium<float>(2000), 1000);
    expect_brute_force("hairball", hairball<float>(1500), 1000);
    expect_brute_force("terrain", terrain<float>(2000), 1000);
}

TEST(WidePoints, TinyHugeAndFarMeshesAsBruteForce) {
    for (const float scale : {1e-38f, 1e-30f, 1e-18f, 1e-9f, 1e9f, 1e13f, 1e17f}) {
        SCOPED_TRACE(scale);
        Mesh mesh = soup<float>(200);
        transform(mesh, scale, {0, 0, 0});
        expect_brute_force("scaled", mesh, 400);
    }
    for (const float shift : {1e3f, 1e6f, 1e12f}) {
        SCOPED_TRACE(shift);
        Mesh mesh = teapot_in_stadium<float>(800);
        transform(mesh, 1, {shift, -2 * shift, shift});
        expect_brute_force("shifted", mesh, 400);
    }
}

TEST(WidePoints, SliversNeedlesPointsAndDuplicatesAsBruteForce) {
    Mesh mesh = soup<float>(300);
    for (std::uint32_t i = 0; i < 300; ++i) {
        const auto [a, b, c] = mesh.triangles[i];
        auto& v = mesh.vertices;
        if (i % 6 == 0) v[c] = v[a] + (v[b] - v[a]) * 0.3f;                       // a needle
        if (i % 6 == 1) v[c] = v[a] + (v[b] - v[a]) * 1.7f + Vec3f(0, 1e-7f, 0);  // a sliver
        if (i % 6 == 2) v[c] = v[b];
        if (i % 6 == 3) v[c] = v[b] = v[a];
        if (i % 6 == 4) mesh.triangles.push_back({c, a, b});  // twice, turned
    }
    expect_brute_force("degenerate", mesh, 2000);
    // All in one place: the lowest of very many.
    Mesh same;
    same.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    same.triangles.assign(1000, {0, 1, 2});
    expect_brute_force("coincident", same, 50);
}

TEST(WidePoints, BatchesOfEverySizeAndStride) {
    const Mesh mesh = terrain<float>(500);
    const auto index = build<WideBvh>(mesh);
    const auto points = points_of(mesh, index.bounds(), 70);
    Found want;
    for (const Vec3f& p : points) want.push_back(closest_point(index, p));
    struct Padded {
        float before;
        Vec3f p;
        double after;
    };
    std::vector<Padded> padded;
    padded.reserve(points.size());
    for (const Vec3f& p : points) padded.push_back({-1, p, -1});
    for (std::size_t count = 0; count <= points.size(); ++count) {
        Found found(count);
        closest_points(index, Strided<Vec3f>(&padded[0].p, count, sizeof(Padded)), std::span(found));
        for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(want[i], found[i]) << i << " of " << count;
    }
}

/// Points in a ball, in clusters, on a lattice (most of them at equal distances), on a line, and in one
/// place.
PointCloud<float, 3> cloud_of(int kind, std::size_t count, float scale) {
    PointCloud<float, 3> cloud;
    for (std::uint64_t i = 0; i < count; ++i) {
        Random random(5, i), cluster(6, i % 7);
        const auto in_cube = [](Random& from) {
            return Vec3f(float(from.uniform()), float(from.uniform()), float(from.uniform()));
        };
        Vec3f p = in_cube(random);
        if (kind == 1) p = in_cube(cluster) + p * 1e-3f;
        if (kind == 2)
            for (int k = 0; k < 3; ++k) p[k] = std::floor(p[k] * 6);
        if (kind == 3) p = {0.3f, p[1], 0.7f};
        if (kind == 4) p = {0.3f, -0.1f, 0.7f};
        cloud.points.push_back(p * scale);
    }
    return cloud;
}

/// A batch over a large index is asked along a curve.
TEST(WidePoints, LargeBatchesInAnyOrderAsOneByOne) {
    const std::size_t count = in_long_runs(1000000, 6000);
    const auto expect_alike = [&](const auto& set) {
        const auto brute = build<Bvh>(set);
        auto points = points_of(set, brute.bounds(), count);
        const float nan = std::numeric_limits<float>::quiet_NaN();
        points[count / 2] = {nan, 0, 0}, points[count / 3] = {0, -anywhere, 0};
        Found want, got(count);
        for (const Vec3f& p : points) want.push_back(closest_point(brute, p));
        for_each_kernel(set, [&](const auto& index, std::string_view) {
            ASSERT_GE(index.bytes(), std::size_t(1) << 18);
            closest_points(index, points, got);
            ASSERT_EQ(want, got);
            std::fill(got.begin(), got.end(), Near<float, 3>());
            closest_points(index, points, got, {.threads = serial_executor()});
            ASSERT_EQ(want, got);
            expect_columns(index, points, 3, anywhere);
        });
    };
    expect_alike(cloud_of(1, 30000, 1));
    expect_alike(terrain<float>(12000));
}

TEST(WidePoints, NearestOfManyNeedsRoomForItsRows) {
    const auto index = build<WideBvh>(cloud_of(0, 100, 1));
    const std::vector<Vec3f> points(10);
    std::vector<std::size_t> offsets(11);
    std::vector<PrimitiveId> ids(29);
    std::vector<float> distances2(30);
    auto lists = lists_in(std::span(offsets), std::span(ids), std::span(distances2));
    EXPECT_THROW(nearest(index, points, 3, lists), InputError);
    EXPECT_EQ(offsets.back(), 30u);  // the room that is wanted
    EXPECT_NO_THROW(nearest(index, points, 2, lists));
    EXPECT_EQ(lists, nearest(index, points, 2));
    EXPECT_NO_THROW(nearest(index, points, 0, lists));
    EXPECT_EQ(lists.count(), 0u);
    EXPECT_NO_THROW(nearest(index, std::vector<Vec3f>(), 3, lists));
    EXPECT_EQ(lists.size(), 0u);
}

TEST(WidePoints, FindsNothingForWhatIsNoPoint) {
    const Mesh mesh = terrain<float>(500);
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                infinity = std::numeric_limits<float>::infinity();
    for_each_kernel(mesh, [&](const auto& index, std::string_view) {
        const Vec3f inside = index.bounds().center();
        std::vector<Vec3f> points;
        for (int k = 0; k < 3; ++k)
            for (const float x : {nan, infinity, -infinity, anywhere, 1e19f, -0x1p61f, 0.0f}) {
                points.push_back(inside);
                points.back()[k] = x;
            }
        Found want;
        for (const Vec3f& p : points) {
            Visits visits;  // the plain walk
            want.push_back(closest_point(index, p, {}, KeepAll(), visits));
            EXPECT_EQ(bool(want.back()), length2(p - inside) < anywhere);
        }
        expect_found(index, points, want, anywhere);
        for (const float none : {-1.0f, nan}) expect_found(index, {inside}, {Near<float, 3>()}, none);
        // A maximum of infinity is none.
        expect_found(index, {points.back()}, {want.back()}, infinity);
    });
}

TEST(WidePoints, ReportsTheFacesOfTheFile) {
    Mesh mesh = terrain<float>(500);
    for (std::uint32_t i = 0; i < mesh.size(); ++i) mesh.faces.push_back(i / 2 + 7);
    expect_brute_force("faces", mesh, 300);
}

TEST(WidePoints, CloudsAsBruteForce) {
    for (const std::size_t count : {1u, 2u, 7u, 8u, 9u, 63u, 64u, 65u, 500u, 1100u, 5000u})
        for (int kind = 0; kind < 5; ++kind) {
            SCOPED_TRACE(std::to_string(count) + " of kind " + std::to_string(kind));
            if (count > unless_sanitized(5000, 500)) continue;
            expect_brute_force("cloud", cloud_of(kind, count, 1),
                               count < 100 ? 40 : unless_sanitized(150, 30));
        }
    for (const float scale : {1e-38f, 1e-20f, 1e-9f, 1e9f, 1e17f}) {
        SCOPED_TRACE(scale);
        for (int kind = 0; kind < 3; ++kind)
            expect_brute_force("scaled", cloud_of(kind, 300, scale), unless_sanitized(200, 30));
    }
}

using PairList = std::vector<PairWithin<float>>;

PairList all_pairs(const PointCloud<float, 3>& a, const PointCloud<float, 3>& b, float radius, bool one) {
    PairList pairs;
    for (PrimitiveId i = 0; i < a.size(); ++i)
        for (PrimitiveId j = one ? i + 1 : 0; j < b.size(); ++j) {
            const float distance2 = closest_point(a.points[i], b.points[j]).distance2;
            if (within_radius(distance2, radius)) pairs.push_back({i, j, distance2});
        }
    return pairs;
}

/// Lists of some, of many and of all points: the longest are not put in order by counting.
TEST(WidePoints, PairsWithinARadiusAsAllPairs) {
    for (const std::size_t count :
         {std::size_t(1), std::size_t(7), std::size_t(9), std::size_t(65), unless_sanitized(700, 150)})
        for (const float scale : {1e-20f, 1.0f, 1e17f})
            for (int kind = 0; kind < 5; ++kind) {
                SCOPED_TRACE(std::to_string(count) + " of kind " + std::to_string(kind) + ", scale " +
                             std::to_string(scale));
                const auto cloud = cloud_of(kind, count, scale), other = cloud_of(kind ^ 2, 60, scale);
                const auto of_other = build<PointKdTree>(other);
                for (const float radius : {0.0f, 2e-4f * scale, 0.2f * scale, 1.0f * scale, anywhere}) {
                    const PairList alone = all_pairs(cloud, cloud, radius, true),
                                   with = all_pairs(other, cloud, radius, false);
                    for_each_kernel(cloud, [&](const auto& index, std::string_view) {
                        PairList found{{7, 7, 7}};
                        EXPECT_EQ(pairs_within(index, radius, found), alone.size());
                        ASSERT_EQ(found, alone);
                        EXPECT_EQ(pairs_within(of_other, index, radius, found), with.size());
                        ASSERT_EQ(found, with);
                    });
                }
            }
}

TEST(WidePoints, PairsOfManyPointsAsWithin) {
    const std::size_t count = in_long_runs(1000000, 20000);
    const auto cloud = cloud_of(0, count, 1);
    const float radius = 1.5f / std::cbrt(static_cast<float>(count));
    PairList want, found;
    for_each_kernel(cloud, [&](const auto& index, std::string_view) {
        if (want.empty()) {
            Found near;
            for (PrimitiveId i = 0; i < count; ++i) {
                within(index, cloud.points[i], radius, near);
                for (const auto& n : near)
                    if (n.element > i) want.push_back({i, n.element, n.distance2});
            }
            std::sort(want.begin(), want.end());
            ASSERT_GT(want.size(), 5 * count);
        }
        for (Executor* const executor : {static_cast<Executor*>(&serial_executor()), &default_executor()}) {
            pairs_within(index, radius, found, {.threads = *executor});
            ASSERT_EQ(found, want);
            pairs_within(index, index, radius, found, {.threads = *executor});
            ASSERT_EQ(found.size(), 2 * want.size() + count);  // each also with itself
            std::erase_if(found, [](const auto& pair) { return pair.a >= pair.b; });
            ASSERT_EQ(found, want);
        }
    });
}

TEST(WidePoints, TreesOfCloudsAreFull) {
    for (const std::size_t count : {1u, 8u, 9u, 64u, 65u, 512u, 513u, 4096u, 4097u, 30000u})
        for (const int width : wide_widths)
            for (const std::uint32_t most : {1u, 3u, 8u}) {
                WideOptions options;
                options.width = width, options.max_leaf_size = most;
                const auto cloud = cloud_of(0, count, 1);
                const auto index = build<WideBvh>(cloud, options);
                EXPECT_EQ(index.validate(), "");
                EXPECT_EQ(index.structure().leaf_count(), (count + most - 1) / most);
                // Any number of threads builds the same tree.
                const auto alone = build<WideBvh>(cloud, options, serial_executor());
                const auto bytes = index.structure().tree().nodes.bytes();
                ASSERT_EQ(bytes, alone.structure().tree().nodes.bytes());
                EXPECT_EQ(std::memcmp(index.structure().tree().nodes.data(),
                                      alone.structure().tree().nodes.data(), bytes),
                          0);
            }
}

TEST(WidePoints, EmptySetsHaveNoClosestPoint) {
    const auto index = build<WideBvh>(Mesh{});
    expect_found(index, {{0, 0, 0}, {1, 2, 3}}, Found(2), anywhere);
    expect_found(build<WideBvh>(PointCloud<float, 3>{}), {{0, 0, 0}}, Found(1), anywhere);
}

}  // namespace
