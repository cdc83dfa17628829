/// Every function that asks reads question(index, asked, out, options, filter, visits): with or without each,
/// of an Index and of an AnyIndex, for one and for many.
#include <hedgerow/any_index.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

#include "contract.h"
#include "lists.h"

using namespace hedgerow;

namespace {

const auto is_even = [](const auto& found) { return found.element % 2 == 0; };

/// All that does not come after in one list, by brute force: those of `all` that a filter keeps.
template <class Found, class Keeps>
std::vector<Found> kept(std::vector<Found> all, Keeps keeps, std::size_t most = std::size_t(-1)) {
    std::erase_if(all, [&](const Found& found) { return !keeps(found); });
    if (all.size() > most) all.resize(most);
    return all;
}

TEST(Grammar, EightCalls) {
    const auto mesh = teapot<float>(300);
    auto other = mesh;
    for (auto& v : other.vertices) v += Vec3f(1, 0, 0);
    const auto i = build(mesh);
    const auto b = build(other);
    const contract::Questions questions(i, 100);
    const auto& rays = questions.rays;
    const auto& points = questions.points;
    const auto ray = rays[0];
    const auto p = points[0];
    const auto f = is_even;
    std::vector<Hit<float>> hits(rays.size());
    std::vector<std::uint8_t> bytes(rays.size());
    NearLists<float> lists;
    EXPECT_EQ(closest_hit(i, ray), contract::answers(i, questions).closest[0]);
    EXPECT_TRUE(!closest_hit(i, ray, f) || f(closest_hit(i, ray, f)));
    closest_hits(i, rays, hits, {.threads = 4}, f);
    for (std::size_t k = 0; k < rays.size(); ++k) EXPECT_EQ(hits[k], closest_hit(i, rays[k], f));
    any_hits(i, rays, bytes);
    for (std::size_t k = 0; k < rays.size(); ++k) EXPECT_EQ(bool(bytes[k]), any_hit(i, rays[k]));
    EXPECT_EQ(bool(closest_point(i, p, {.radius = 1})), !within(i, p, 1).empty());
    nearest(i, points, 8, lists);
    EXPECT_EQ(lists.count(), 8 * points.size());
    EXPECT_TRUE(within(i, p, 0.5f).size() <= i.size());
    EXPECT_GT(hausdorff_distance(i, b, {.relative = 1e-3}).lower, 0);
}

/// Compares all that a point is asked with lists by brute force.
template <class I, class Oracle, class Points>
void expect_points(const I& index, const Oracle& oracle, const Points& points) {
    using Found = NearOf<I>;
    const double radius = 0.3;
    std::vector<Found> all, found;
    std::vector<PrimitiveId> own(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        own[i] = i % 3 == 0 ? no_primitive : closest_point(oracle, points[i]).element;
    const auto of_number = [](std::size_t i, const Found& near) { return (near.element + i) % 3 != 0; };

    // One by one.
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto& p = points[i];
        nearest(oracle, p, oracle.size(), all);
        const auto near_enough = [&](const Found& near) {
            return within_radius(near.distance2, static_cast<typename I::Scalar>(radius));
        };
        ASSERT_EQ(nearest(index, p, 5), kept(
                                            all, [](const Found&) { return true; }, 5));
        ASSERT_EQ(nearest(index, p, 5, {}, is_even), kept(all, is_even, 5));
        ASSERT_TRUE(nearest(index, p, 0, {}, is_even).empty());
        ASSERT_EQ(nearest(index, p, 5, is_even), kept(all, is_even, 5));
        ASSERT_EQ(within(index, p, radius, is_even), kept(kept(all, near_enough), is_even));
        ASSERT_EQ(within(index, p, radius, {.factor = 3}), kept(all, near_enough));
        ASSERT_EQ(nearest(index, p, 5, found, is_even), std::min<std::size_t>(5, kept(all, is_even).size()));
        const auto is_other = [&](const Found& near) { return near.element != own[i]; };
        ASSERT_EQ(nearest(index, p, 5, {.leave_out = own[i]}), kept(all, is_other, 5));
        ASSERT_EQ(within(index, p, radius), kept(all, near_enough));
        ASSERT_EQ(within(index, p, radius, {.leave_out = own[i]}, is_even),
                  kept(kept(kept(all, near_enough), is_even), is_other));
        const auto closest = kept(all, is_other, 1);
        ASSERT_EQ(closest_point(index, p, {.leave_out = own[i]}), closest.empty() ? Found() : closest[0]);
        const auto even = kept(all, is_even, 1);
        ASSERT_EQ(closest_point(index, p, is_even), even.empty() ? Found() : even[0]);
        Visits visits;
        ASSERT_EQ(closest_point(index, p, {}, KeepAll(), visits), all.empty() ? Found() : all[0]);
        ASSERT_EQ(all.empty(), visits.primitives == 0);
    }

    // In batches, by any number of threads.
    std::vector<Found> one(points.size());
    std::vector<Visits> visits(points.size());
    NearListsOf<I> lists;
    for (const Threads threads : {Threads(), Threads(1), Threads(3), Threads(serial_executor())}) {
        const PointOptions leaving{.leave_out = own, .threads = threads};
        closest_points(index, points, one, leaving);
        for (std::size_t i = 0; i < points.size(); ++i)
            ASSERT_EQ(one[i], closest_point(index, points[i], {.leave_out = own[i]})) << i;
        closest_points(index, points, one, {.threads = threads}, of_number);
        for (std::size_t i = 0; i < points.size(); ++i)
            ASSERT_EQ(one[i], closest_point(index, points[i], filter_of_ray(of_number, i))) << i;
        for (const std::size_t k : {0u, 1u, 4u, 5000u}) {
            nearest(index, points, k, lists, leaving);
            for (std::size_t i = 0; i < points.size(); ++i)
                ASSERT_TRUE(same_list(lists[i], nearest(index, points[i], k, {.leave_out = own[i]})))
                    << i << ", k = " << k;
        }
        nearest(index, points, 4, lists, {.factor = 1.5, .leave_out = own, .threads = threads}, of_number,
                visits);
        for (std::size_t i = 0; i < points.size(); ++i) {
            ASSERT_TRUE(same_list(lists[i], nearest(index, points[i], 4, {.factor = 1.5, .leave_out = own[i]},
                                                    filter_of_ray(of_number, i))));
            ASSERT_GT(visits[i].primitives, 0u);
        }
        within(index, points, radius, lists, leaving);
        for (std::size_t i = 0; i < points.size(); ++i)
            ASSERT_TRUE(same_list(lists[i], within(index, points[i], radius, {.leave_out = own[i]}))) << i;
        within(index, points, radius, lists, {.threads = threads}, of_number);
        for (std::size_t i = 0; i < points.size(); ++i)
            ASSERT_TRUE(
                same_list(lists[i], within(index, points[i], radius, {}, filter_of_ray(of_number, i))));
    }
    EXPECT_EQ(nearest(index, points, 4, is_even), nearest(index, points, 4, {}, is_even));
    EXPECT_EQ(within(index, points, radius, is_even), within(index, points, radius, {}, is_even));
    own.pop_back();
    EXPECT_THROW(nearest(index, points, 4, lists, {.leave_out = own}), InputError);
    own.clear();
    EXPECT_THROW(closest_point(index, points[0], {.leave_out = own}), InputError);
    EXPECT_THROW(within(index, points[0], radius, {.leave_out = own}), InputError);
    EXPECT_THROW(closest_points(index, points, one, {.leave_out = own}), InputError);
    visits.pop_back();
    EXPECT_THROW(nearest(index, points, 4, lists, {}, KeepAll(), visits), InputError);
}

/// Points of a set and around it, more than a thousand: batches are put in order where an index is large.
template <class Set>
auto points_around(const Set& set) {
    const auto oracle = build<BruteForce>(set);
    std::vector<PointOf<std::decay_t<decltype(oracle)>>> points;
    const contract::Questions questions(oracle, 40);
    for (const auto& p : questions.points) points.push_back(p);
    return points;
}
template <class Set>
void expect_points_of(const Set& set) {
    const auto points = points_around(set);
    const auto oracle = build<BruteForce>(set);
    expect_points(build(set), oracle, points);
    expect_points(build<KdTree>(set), oracle, points);
    for (const char* const spec : {"wide", "kdtree", "grid"})
        expect_points(*build_any(spec, set), oracle, points);
}
TEST(Grammar, OfAPoint) {
    expect_points_of(points<float>(300));
    expect_points_of(points<double>(200));
    expect_points_of(teapot<float>(100));
    expect_points_of(segments2d<double>(100));
    expect_points_of(spheres<float>(100));
    expect_points_of(PointCloud<float, 3>{{{1, 2, 3}}});
}

/// Without the point itself: by its number, so that others in its place stay.
TEST(Grammar, NeighboursWithoutThePointItself) {
    auto cloud = points<float>(500);
    for (std::size_t i = 0; i < 100; ++i) cloud.points[i] = cloud.points[i % 10];
    std::vector<PrimitiveId> own(cloud.size());
    for (std::size_t i = 0; i < own.size(); ++i) own[i] = static_cast<PrimitiveId>(i);
    const auto index = build(cloud);
    const auto lists = nearest(index, cloud.points, 8, {.leave_out = own});
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        ASSERT_EQ(lists[i].size(), 8u);
        EXPECT_EQ(std::count(lists[i].ids.begin(), lists[i].ids.end(), own[i]), 0);
        EXPECT_EQ(lists[i].distances2[0] == 0, i < 100) << i;
    }
    const auto balls = within(index, cloud.points, 0.2, {.leave_out = own});
    const auto neighbours = neighbours_within(cloud.points, 0.2);
    EXPECT_EQ(balls.offsets, neighbours.offsets);
}

/// Compares all that a ray is asked with the lists of brute force.
template <class I, class Oracle, class Rays>
void expect_rays(const I& index, const Oracle& oracle, const Rays& rays) {
    using Found = HitOf<I>;
    std::vector<Found> all, found;
    std::vector<PrimitiveId> own(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
        own[i] = i % 3 == 0 ? no_primitive : closest_hit(oracle, rays[i]).element;
    const auto of_number = [](std::size_t i, const Found& hit) { return (hit.element + i) % 3 != 0; };
    const auto first_of = [](const std::vector<Found>& hits) { return hits.empty() ? Found() : hits[0]; };

    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto& ray = rays[i];
        all_hits(oracle, ray, all);
        const auto is_other = [&](const Found& hit) { return hit.element != own[i]; };
        const RayOptions leaving{.leave_out = own[i]};
        ASSERT_EQ(all_hits(index, ray), all);
        all_hits(index, ray, found, leaving, is_even);
        ASSERT_EQ(found, kept(kept(all, is_other), is_even));
        ASSERT_EQ(closest_hit(index, ray, leaving), first_of(kept(all, is_other)));
        ASSERT_EQ(closest_hit(index, ray, is_even), first_of(kept(all, is_even)));
        ASSERT_EQ(closest_hit(index, ray, leaving, is_even), first_of(found));
        ASSERT_EQ(any_hit(index, ray, leaving, is_even), !found.empty());
        ASSERT_EQ(hit_count(index, ray), all.size());
        ASSERT_EQ(hit_count(index, ray, leaving, is_even), found.size());
        std::array<Found, 2> two;
        const std::size_t some =
            first_hits(index, ray, two, {.after = first_of(all), .leave_out = own[i]}, is_even);
        const auto rest = kept(
            found, [&](const Found& hit) { return hit_before(first_of(all), hit); }, 2);
        ASSERT_EQ(std::vector<Found>(two.begin(), two.begin() + static_cast<std::ptrdiff_t>(some)), rest);
    }

    std::vector<Found> hits(rays.size());
    std::vector<std::uint8_t> bytes(rays.size(), 7);
    std::vector<bool> bits(rays.size());
    const auto flags = std::make_unique<bool[]>(rays.size());
    std::vector<std::size_t> counts(rays.size());
    std::vector<Visits> visits(rays.size());
    HitListsOf<I> lists;
    for (const Threads threads : {Threads(), Threads(2), Threads(serial_executor())}) {
        const RayOptions leaving{.leave_out = own, .threads = threads};
        closest_hits(index, rays, hits, leaving, of_number);
        any_hits(index, rays, bytes, leaving, of_number);
        any_hits(index, rays, bits, leaving, of_number);
        any_hits(index, rays, {flags.get(), rays.size()}, leaving, of_number);
        all_hits(index, rays, lists, leaving, of_number);
        hit_counts(index, rays, counts, leaving, of_number);
        const auto first = first_hits(index, rays, 3, {.leave_out = own, .threads = threads}, of_number);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const auto of_ray = filter_of_ray(of_number, i);
            all_hits(index, rays[i], found, {.leave_out = own[i]}, of_ray);
            ASSERT_TRUE(same_list(lists[i], found)) << i;
            ASSERT_EQ(hits[i], first_of(found)) << i;
            ASSERT_EQ(bytes[i], found.empty() ? 0 : 1);
            ASSERT_EQ(bits[i], !found.empty());
            ASSERT_EQ(flags[i], !found.empty());
            ASSERT_EQ(counts[i], found.size());
            if (found.size() > 3) found.resize(3);
            ASSERT_TRUE(same_list(first[i], found)) << i;
        }
        closest_hits(index, rays, hits, {.threads = threads}, KeepAll(), visits);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(hits[i], closest_hit(index, rays[i]));
            Visits alone;
            closest_hit(index, rays[i], KeepAll(), alone);
            ASSERT_EQ(visits[i], alone);
        }
        visits.assign(rays.size(), {});
    }
    own.pop_back(), bits.pop_back();
    EXPECT_THROW(closest_hits(index, rays, hits, {.leave_out = own}), InputError);
    EXPECT_THROW(any_hits(index, rays, bits), InputError);
}
template <class Set>
void expect_rays_of(const Set& set) {
    const auto oracle = build<BruteForce>(set);
    const contract::Questions questions(oracle, 60);
    expect_rays(build(set), oracle, questions.rays);
    expect_rays(build<KdTree>(set), oracle, questions.rays);
    for (const char* const spec : {"wide", "octree", "grid"})
        if constexpr (Set::dimension == 3) expect_rays(*build_any(spec, set), oracle, questions.rays);
}
TEST(Grammar, OfARay) {
    expect_rays_of(teapot<float>(200));
    expect_rays_of(teapot<double>(100));
    expect_rays_of(spheres<float>(100));
    expect_rays_of(segments2d<float>(100));
}

template <class I, class Oracle, class Regions>
void expect_regions(const I& index, const Oracle& oracle, const Regions& regions) {
    IdListsOf<I> lists;
    std::vector<std::size_t> counts(regions.size());
    std::vector<bool> any(regions.size());
    std::vector<Visits> visits(regions.size());
    for (const Threads threads : {Threads(), Threads(2)}) {
        overlapping(index, regions, lists, {.threads = threads}, visits);
        overlap_counts(index, regions, counts, {.threads = threads});
        any_overlaps(index, regions, any, {.threads = threads});
        const auto inside = contained(index, regions, {.threads = threads});
        for (std::size_t i = 0; i < regions.size(); ++i) {
            const auto want = overlapping(oracle, regions[i]);
            ASSERT_TRUE(same_list(lists[i], want)) << i;
            ASSERT_TRUE(same_list(inside[i], contained(oracle, regions[i]))) << i;
            ASSERT_EQ(overlapping(index, regions[i]), want);
            ASSERT_EQ(overlap_count(index, regions[i]), want.size());
            ASSERT_EQ(any_overlap(index, regions[i]), !want.empty());
            ASSERT_EQ(counts[i], want.size());
            ASSERT_EQ(any[i], !want.empty());
        }
    }
}
TEST(Grammar, OfARegion) {
    const auto mesh = teapot<float>(200);
    const auto oracle = build<BruteForce>(mesh);
    const contract::Questions questions(oracle, 40);
    std::vector<Sphere<float, 3>> balls;
    for (const auto& p : questions.points) balls.push_back({p, 0.4f});
    const auto expect = [&](const auto& index) {
        expect_regions(index, oracle, questions.boxes);
        expect_regions(index, oracle, balls);
        expect_regions(index, oracle, std::vector<HalfSpace<float>>{{{0, 0, 1}, 0.5f}, {{1, 0, 0}, -9}});
    };
    expect(build(mesh));
    expect(build<Grid>(mesh));
    for (const char* const spec : {"wide", "octree"}) expect(*build_any(spec, mesh));
}

/// A number of threads is the most that work at once.
TEST(Grammar, ThreadsByNumber) {
    for (const std::size_t most : {1u, 2u, 3u}) {
        std::atomic<std::size_t> now = 0, highest = 0;
        Executor& executor = Threads(most).over(1 << 20);
        executor.for_each_piece(200, 1, [&](std::size_t, std::size_t) {
            const std::size_t here = ++now;
            for (std::size_t seen = highest; seen < here && !highest.compare_exchange_weak(seen, here);) {
            }
            for (int i = 0; i < 20000; ++i) static_cast<void>(highest.load());
            --now;
        });
        EXPECT_LE(highest, most);
        EXPECT_EQ(&executor, &Threads(most).over(1 << 20));
        EXPECT_EQ(&Threads(most).over(10), &serial_executor());
        std::atomic<int> both = 0;
        executor.both([&] { ++both; }, [&] { both += 2; });
        EXPECT_EQ(both, 3);
        EXPECT_THROW(
            executor.for_each_piece(100, 1, [](std::size_t, std::size_t) { throw InputError("no"); }),
            InputError);
    }
    EXPECT_EQ(&Threads(0).over(1 << 20), &default_executor());
    EXPECT_EQ(&Threads(-1).over(1 << 20), &default_executor());
}

// An array is not made of a pointer to something else in silence.
template <class T, class... Arguments>
concept Makes = std::is_constructible_v<T, Arguments...>;
static_assert(Makes<Strided<Vec3f>, const Vec3f*, std::size_t, std::size_t>);
static_assert(Makes<Strided<Vec3f>, float (*)[3], std::size_t, std::size_t>);
static_assert(!Makes<Strided<Vec3f>, float (*)[2], std::size_t, std::size_t>);
static_assert(!Makes<Strided<Vec3f>, double (*)[3], std::size_t, std::size_t>);
static_assert(!Makes<Strided<Vec3f>, float*, std::size_t, std::size_t>);
static_assert(!Makes<Strided<Vec3f>, Vec3d*, std::size_t, std::size_t>);
static_assert(!Makes<Strided<Vec3f>, void*, std::size_t, std::size_t>);

TEST(Grammar, ArraysOfMembers) {
    struct Vertex {
        float position[3], normal[3];
        std::array<float, 2> texture;
    };
    std::vector<Vertex> vertices(4);
    for (std::size_t i = 0; i < 4; ++i) vertices[i].position[1] = float(i);
    const Strided<Vec3f> places(&vertices[0].position, vertices.size(), sizeof(Vertex));
    const auto same = Strided<Vec3f>::in_bytes(vertices.data(), vertices.size(), sizeof(Vertex));
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(places[i], Vec3f(0, float(i), 0));
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(same[i], places[i]);
}

/// Distances of float are compared with a radius of double exactly.
TEST(Grammar, RadiiAreDoubles) {
    const auto index = build(PointCloud<float, 3>{{{0.1f, 0, 0}}});
    EXPECT_EQ(within(index, {0, 0, 0}, 0.1f).size(), 1u);
    EXPECT_EQ(within(index, {0, 0, 0}, double(0.1f)).size(), 1u);
    EXPECT_EQ(within(index, {0, 0, 0}, std::nextafter(double(0.1f), 0.0)).size(), 0u);
    EXPECT_EQ(within(index, {0, 0, 0}, 1e300).size(), 1u);
    EXPECT_EQ(within(index, {0, 0, 0}, 1e-300).size(), 0u);
    EXPECT_EQ(greatest_at_most<float>(0.1), 0.099999994f);
    EXPECT_EQ(greatest_at_most<float>(-1e300), -std::numeric_limits<float>::infinity());
    EXPECT_EQ(greatest_at_most<float>(1e-46), 0.0f);
    EXPECT_EQ(greatest_at_most<float>(1e300), std::numeric_limits<float>::max());
    EXPECT_EQ(greatest_at_most<double>(0.1), 0.1);
}

}  // namespace
