/// The first hits of a ray: their pieces, joined, are all hits, whatever the size of a piece and however many
/// hits have the same t; by every structure, kernel and set, among instances, alone and in batches.
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

#include "backwards.h"
#include "crowded.h"
#include "engine.h"
#include "layers.h"
#include "lists.h"
#include "placements.h"

using namespace hedgerow;

namespace {

/// All hits of a ray, in pieces of k.
template <class I, class Filter = KeepAll, class T = typename I::Scalar>
std::vector<Hit<T>> joined(const I& index, const RayOf<I>& ray, std::size_t k, const Filter& filter = {}) {
    std::vector<Hit<T>> all, piece(k);
    AfterHit after;
    while (true) {
        const std::size_t n = first_hits(index, ray, piece, {.after = after}, filter);
        all.insert(all.end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(n));
        if (n < k) return all;
        after = piece.back();
    }
}
/// Expects that pieces of every size, joined, are all hits that the filter keeps.
template <class I, class Filter = KeepAll, class T = typename I::Scalar>
void expect_joined(const I& index, const RayOf<I>& ray, const std::vector<Hit<T>>& all,
                   const Filter& filter = {}) {
    std::vector<Hit<T>> kept;
    for (const auto& hit : all)
        if (keeps(filter, 0, hit)) kept.push_back(hit);
    for (std::size_t k = 1; k <= kept.size() + 1; k += 1 + k / 8)
        ASSERT_EQ(joined(index, ray, k, filter), kept) << "in pieces of " << k;
}

template <class P>
using RaysOf = std::vector<Ray<typename P::Scalar, P::dimension>>;
template <class P>
RaysOf<P> rays_at(const P& set, const matrix::Points<typename P::Scalar, P::dimension>& targets,
                  std::size_t count) {
    const auto bounds = build_any("brute-force", set)->bounds();
    RaysOf<P> rays;
    for (std::size_t i = 0; i < count; ++i) rays.push_back(matrix::ray_of(bounds, targets, i));
    return rays;
}
/// Compares every structure with the lists of brute force, of which some have at least `most` hits.
template <class P>
void expect_every_structure(const P& set, const RaysOf<P>& rays, std::size_t most = 3) {
    using T = typename P::Scalar;
    const auto oracle = build_any("brute-force", set);
    std::vector<Hit<T>> all;
    std::size_t longest = 0;
    for (const std::string& spec :
         structures_for<P>({"wide:width=4", "bvh:volume=obb", "bvh:builder=spatial-splits"})) {
        SCOPED_TRACE(spec);
        const auto index = build_any(spec, set);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            SCOPED_TRACE("ray " + std::to_string(i));
            longest = std::max(longest, all_hits(*oracle, rays[i], all));
            expect_joined(*index, rays[i], all);
            if (testing::Test::HasFatalFailure()) return;
        }
    }
    EXPECT_GE(longest, most);
}

template <class T>
class FirstHitsOf : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(FirstHitsOf, Scalars);

TYPED_TEST(FirstHitsOf, EveryStructureJoinToAllHits) {
    using T = TypeParam;
    const auto pot = teapot<T>(400);
    expect_every_structure(pot, rays_at(pot, matrix::targets_of(pot), 400));
    const auto balls = spheres<T>(200);
    matrix::Points<T, 3> centers;
    for (const auto& ball : balls.spheres) centers.push_back(ball.center);
    expect_every_structure(balls, rays_at(balls, centers, 400));
    const auto lines = segments2d<T>(200);
    matrix::Points<T, 2> ends;
    for (const auto& line : lines.segments) ends.push_back(line.a);
    expect_every_structure(lines, rays_at(lines, ends, 400));
}

TYPED_TEST(FirstHitsOf, HitsWithOneT) {
    using T = TypeParam;
    // The diagonal of the squares is an edge of both of their triangles, and each square is there four times.
    const auto layers = stack<T>(12, 4);
    auto rays = rays_at(layers, matrix::targets_of(layers), 200);
    for (int i = 1; i < 8; ++i) rays.push_back({{T(i) / 8, 1 - T(i) / 8, T(-1)}, {T(0), T(0), T(1)}});
    expect_every_structure(layers, rays, 12 * 4 * 2);
    // Fifty slivers share a vertex, in one plane. The rays meet it exactly.
    const auto fan = crowded::fan<T>(50);
    rays.clear();
    for (int i = 0; i < 20; ++i)
        rays.push_back({{T(i) / 8, T(3 - i) / 4, T(1)}, {-T(i) / 8, T(i - 3) / 4, T(-1)}});
    expect_every_structure(fan, rays, 50);
    // The same triangle.
    const auto alike = crowded::alike<T>(70);
    expect_every_structure(alike, rays_at(alike, {(alike.vertices[0] + alike.vertices[1]) * T(0.5)}, 100),
                           70);
}

TYPED_TEST(FirstHitsOf, AThousandLayers) {
    using T = TypeParam;
    const auto mesh = stack<T>(1000);
    const auto index = build(mesh);
    const Ray<T, 3> ray{{T(0.25), T(0.5), T(-1)}, {T(0), T(0), T(1)}};
    std::vector<Hit<T>> all;
    ASSERT_EQ(all_hits(index, ray, all), 1000u);
    for (const std::size_t k : {1u, 7u, 8u, 999u, 1000u, 1001u}) ASSERT_EQ(joined(index, ray, k), all) << k;
}

/// Cells before the place are pruned where a primitive has one t. A sphere has two, and is no new hit where
/// the ray leaves it.
TEST(FirstHits, BeginWhereTheyGoOn) {
    const auto mesh = stack<double>(1000);
    const auto index = build<Bvh>(mesh);
    const Ray3d ray{{0.25, 0.5, -1}, {0, 0, 1}};
    Visits begin, middle;
    std::array<Hit<double>, 4> some;
    ASSERT_EQ(first_hits(index, ray, some, {}, KeepAll{}, begin), 4u);
    ASSERT_EQ(first_hits(index, ray, some, {.after = AfterHit(500.5, 0, 0)}, KeepAll{}, middle), 4u);
    EXPECT_EQ(some[0].t, 501);
    EXPECT_LT(middle.leaves, 2 * begin.leaves + 8);
    const SphereSet<double, 3> ball{{{{0, 0, 0}, 1}, {{4, 0, 0}, 1}}};
    const auto balls = build<Bvh>(ball);
    const Ray3d through{{-3, 0, 0}, {1, 0, 0}};
    ASSERT_EQ(first_hits(balls, through, some, {.after = AfterHit(2, 0, 0)}), 1u);
    EXPECT_EQ(some[0].element, 1u);
    EXPECT_EQ(some[0].t, 6);
}

TEST(FirstHits, PlacesToGoOnFrom) {
    const auto mesh = stack<float>(4);
    const auto index = build_any("wide", mesh);
    const Ray3f ray{{0.25f, 0.5f, -1}, {0, 0, 1}};
    std::array<Hit<float>, 8> hits;
    const auto count = [&](const AfterHit& after) {
        return first_hits(*index, ray, std::span(hits), {.after = after});
    };
    ASSERT_EQ(count({}), 4u);
    const Hit<float> second = hits[1], last = hits[3];
    EXPECT_EQ(count(second), 2u);
    EXPECT_EQ(count(last), 0u);
    // Of two places at one t the element decides, and it need not be that of a hit.
    EXPECT_EQ(count({second.t, 0, second.element - 1}), 3u);
    EXPECT_EQ(count({second.t, 0, second.element + 1}), 2u);
    EXPECT_EQ(count({second.t, 1, 0}), 2u);
    EXPECT_EQ(count({-5, 0, 0}), 4u);
    EXPECT_EQ(count({100, 0, 0}), 0u);
    // Nothing comes after no hit, and after no number.
    EXPECT_EQ(count(Hit<float>()), 0u);
    EXPECT_EQ(count({std::numeric_limits<float>::quiet_NaN(), 0, 0}), 0u);
    // No room.
    EXPECT_EQ(first_hits(*index, ray, {}), 0u);
}

/// Kernels of every instruction set and width, with filters, which they call with hits alone.
TEST(FirstHits, OfEveryKernel) {
    for (const auto& mesh : {teapot<float>(300), stack<float>(10, 3), crowded::fan<float>(40)}) {
        const auto oracle = build<BruteForce>(mesh);
        std::vector<Ray3f> rays = apart(oracle.bounds(), matrix::targets_of(mesh), 300);
        std::vector<std::vector<Hit<float>>> all(rays.size());
        for (std::size_t i = 0; i < rays.size(); ++i) all_hits(oracle, rays[i], all[i]);
        for_each_kernel(mesh, [&](const auto& index, std::string_view) {
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const auto odd = [&](const Hit<float>& hit) {
                    EXPECT_NE(std::find(all[i].begin(), all[i].end(), hit), all[i].end());
                    return hit.element % 2 != 0;
                };
                expect_joined(index, rays[i], all[i]);
                expect_joined(index, rays[i], all[i], odd);
                if (testing::Test::HasFatalFailure()) return;
            }
        });
    }
}

template <template <class, int> class Outer, template <class, int> class Inner, class T>
void expect_instances(const std::vector<TriangleMesh<T>>& sets, const std::vector<Transform<3>>& transforms) {
    using I = IndexOf<Inner, TriangleMesh<T>>;
    using Plain = IndexOf<BruteForce, TriangleMesh<T>>;
    std::vector<I> indexes;
    std::vector<Plain> plain;
    for (const auto& set : sets)
        indexes.push_back(build<Inner>(set)), plain.push_back(build<BruteForce>(set));
    std::vector<Instance<I>> instances;
    std::vector<Instance<Plain>> oracles;
    for (std::size_t i = 0; i < transforms.size(); ++i) {
        instances.emplace_back(indexes[i % sets.size()], transforms[i]);
        oracles.emplace_back(plain[i % sets.size()], transforms[i]);
    }
    const InstanceSet set(instances);
    const InstanceSet oracle_set(oracles);
    const auto index = build<Outer>(set);
    const auto oracle = build<BruteForce>(oracle_set);
    std::vector<Vec<T, 3>> targets;
    for (std::size_t i = 0; i < transforms.size(); ++i)
        targets.push_back(transformed(transforms[i].there(), sets[i % sets.size()].vertices[0]));
    std::vector<Hit<T>> all;
    std::size_t most = 0;
    for (std::size_t i = 0; i < 200; ++i) {
        const auto ray = matrix::ray_of(oracle.bounds(), targets, i);
        most = std::max(most, all_hits(oracle, ray, all));
        expect_joined(index, ray, all);
        if (testing::Test::HasFatalFailure()) return;
    }
    EXPECT_GT(most, 2u);
}
TYPED_TEST(FirstHitsOf, Instances) {
    using T = TypeParam;
    const std::vector<TriangleMesh<T>> sets = {teapot<T>(100), stack<T>(3, 2)};
    auto places = transforms<3>(16, Scales::any, 8);
    // Several instances in one place, so that hits of one t differ by the instance alone.
    places.insert(places.end(), 6, Transform<3>());
    expect_instances<WideBvh, WideBvh>(sets, places);
    expect_instances<Bvh, Grid>(sets, places);
    expect_instances<KdTree, WideBvh>(sets, places);
}

// ---- Batches ----

TEST(FirstHits, InBatchesOfAnyThreads) {
    const auto mesh = teapot<float>(300);
    const auto index = build(mesh);
    const auto any = build_any("kdtree", mesh);
    const auto rays = rays_at(mesh, matrix::targets_of(mesh), 700);
    constexpr std::size_t k = 3;
    const auto own = [](std::size_t ray, const Hit<float>& hit) { return (hit.element + ray) % 3 != 0; };
    Backwards backwards;
    for (Executor* const threads :
         std::initializer_list<Executor*>{&serial_executor(), &default_executor(), &backwards}) {
        HitLists<float> hits, others, kept;
        std::vector<AfterHit> after(rays.size());
        // Take batches until no ray has more hits, and compare each with single calls.
        std::size_t found = 1, batches = 0;
        for (; found > 0; ++batches) {
            found = 0;
            const HitsOptions options{.after = after, .threads = *threads};
            first_hits(index, rays, k, hits, options);
            first_hits(*any, rays, k, others, options);
            first_hits(index, rays, k, kept, options, own);
            EXPECT_EQ(hits, others);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                std::vector<Hit<float>> one(k), filtered(k);
                one.resize(first_hits(index, rays[i], one, {.after = after[i]}));
                ASSERT_TRUE(same_list(hits[i], one));
                filtered.resize(
                    first_hits(index, rays[i], filtered, {.after = after[i]}, filter_of_ray(own, i)));
                ASSERT_TRUE(same_list(kept[i], filtered));
                found += one.size();
                after[i] = one.size() == k ? one.back() : Hit<float>();  // after no hit there are none
            }
        }
        EXPECT_GT(batches, 2u);
    }
}

TEST(FirstHits, NeedNoExecutorForAFilter) {
    const auto mesh = stack<float>(6);
    const auto index = build(mesh);
    const std::vector<Ray3f> rays(3, Ray3f{{0.25f, 0.5f, -1}, {0, 0, 1}});
    HitLists<float> hits;
    // Ray i sees what lies beyond t = 2 i + 1.5.
    first_hits(index, rays, 2, hits,
               [](std::size_t i, const Hit<float>& hit) { return hit.t > 1.5f + 2 * float(i); });
    EXPECT_EQ(hits.count(), 5u);
    EXPECT_EQ(hits[2].size(), 1u);
    for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(hits[i][0].t, 2 + 2 * float(i));
}

TEST(FirstHits, RefuseArraysThatAreTooShort) {
    const auto mesh = teapot<float>(50);
    const auto index = build(mesh);
    const auto rays = rays_at(mesh, matrix::targets_of(mesh), 10);
    const std::vector<AfterHit> after(9);
    HitLists<float> lists;
    EXPECT_THROW(first_hits(index, rays, 2, lists, {.after = after}), InputError);
    first_hits(index, rays, std::size_t(1) << 62, lists);
    EXPECT_EQ(lists, all_hits(index, rays));
    // In arrays of the caller's.
    first_hits(index, rays, 2, lists);
    std::vector<Hit<float>> hits(lists.count() - 1);
    std::vector<std::size_t> offsets(11);
    auto in_mine = lists_in(std::span(offsets), std::span(hits));
    EXPECT_THROW(first_hits(index, rays, 2, in_mine), InputError);
    EXPECT_EQ(offsets.back(), lists.count());
    hits.resize(lists.count());
    in_mine = lists_in(std::span(offsets), std::span(hits));
    first_hits(index, rays, 2, in_mine);
    EXPECT_EQ(in_mine, lists);
    EXPECT_EQ(hits.back(), lists.hits.back());
    offsets.pop_back();
    in_mine = lists_in(std::span(offsets), std::span(hits));
    EXPECT_THROW(first_hits(index, rays, 2, in_mine), InputError);
    // No room is wanted for no hits.
    first_hits(index, rays, 0, lists);
    EXPECT_EQ(lists.size(), 10u);
    EXPECT_EQ(lists.count(), 0u);
}

}  // namespace
