/// Masks: questions see what has a wanted bit, with the answers of a filter that keeps the same.
#include <hedgerow/any_index.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

#include "contract.h"
#include "lists.h"
#include "placements.h"

using namespace hedgerow;

namespace {

/// Compares every question with a mask and without a filter to the same by brute force with a filter, where
/// seen(answer) says what the mask sees.
template <class I, class Oracle, class Seen>
void expect_masked(const I& index, const Oracle& oracle, const Mask& mask, const Seen& seen) {
    using T = typename I::Scalar;
    const contract::Questions questions(oracle, 200);
    const auto& rays = questions.rays;
    std::vector<Hit<T>> hits(rays.size()), last(rays.size());
    std::vector<std::uint8_t> any(rays.size());
    std::vector<std::size_t> counts(rays.size());
    closest_hits(index, rays, hits, {.mask = mask, .threads = 2});
    last_hits(index, rays, last, {.mask = mask});
    any_hits(index, rays, any, {.mask = mask});
    hit_counts(index, rays, counts, {.mask = mask});
    const auto all = all_hits(index, rays, {.mask = mask, .threads = 2});
    const auto some = first_hits(index, rays, 3, {.mask = mask});
    for (std::size_t i = 0; i < rays.size(); ++i) {
        std::vector<Hit<T>> want;
        all_hits(oracle, rays[i], want, seen);
        ASSERT_TRUE(std::ranges::equal(all[i], want)) << i;
        ASSERT_EQ(all_hits(index, rays[i], {.mask = mask}), want) << i;
        ASSERT_EQ(counts[i], want.size()) << i;
        ASSERT_EQ(bool(any[i]), !want.empty()) << i;
        ASSERT_EQ(any_hit(index, rays[i], {.mask = mask}), !want.empty()) << i;
        ASSERT_EQ(last[i], last_hit(oracle, rays[i], seen)) << i;
        const Hit<T> first = want.empty() ? Hit<T>() : want[0];
        ASSERT_EQ(hits[i], first) << i;
        ASSERT_EQ(closest_hit(index, rays[i], {.mask = mask}), first) << i;
        want.resize(std::min<std::size_t>(want.size(), 3));
        ASSERT_TRUE(std::ranges::equal(some[i], want)) << i;
    }

    const auto& points = questions.points;
    const double radius = 0.2 * static_cast<double>(max_component(oracle.bounds().extent()));
    std::vector<NearOf<I>> closest(points.size()), farthest(points.size());
    std::vector<PrimitiveId> own(points.size());
    for (std::size_t i = 0; i < own.size(); ++i) {
        const auto near = closest_point(oracle, points[i], seen);
        own[i] = i % 2 == 0 ? near.element : no_primitive;
    }
    const PointOptions options{.leave_out = own, .mask = mask, .threads = 2};
    closest_points(index, points, closest, options);
    if constexpr (!Instanced<typename I::Primitives>) {
        farthest_points(index, points, farthest, options);
        for (std::size_t i = 0; i < points.size(); ++i)
            ASSERT_EQ(farthest[i], farthest_point(oracle, points[i], {.leave_out = own[i]}, seen)) << i;
    }
    const auto five = nearest(index, points, 5, options), balls = within(index, points, radius, options);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const PointOptions alone{.leave_out = own[i], .mask = mask}, leaving{.leave_out = own[i]};
        const auto want = closest_point(oracle, points[i], leaving, seen);
        ASSERT_EQ(closest[i], want) << i;
        ASSERT_EQ(closest_point(index, points[i], alone), want) << i;
        const auto want_five = nearest(oracle, points[i], 5, leaving, seen);
        ASSERT_EQ(nearest(index, points[i], 5, alone), want_five) << i;
        ASSERT_TRUE(same_list(five[i], want_five)) << i;
        const auto want_within = within(oracle, points[i], radius, leaving, seen);
        ASSERT_EQ(within(index, points[i], radius, alone), want_within) << i;
        ASSERT_TRUE(same_list(balls[i], want_within)) << i;
    }
}

struct Enters {
    std::uint32_t wanted;
    bool enters(std::uint32_t bits) const { return (bits & wanted) != 0; }
    bool operator()(const Near<float, 3>&) const { return true; }
};

template <class Set>
void expect_masks_of(const Set& set) {
    std::vector<std::uint32_t> masks(set.size());
    for (std::size_t i = 0; i < masks.size(); ++i) masks[i] = i % 7 == 0 ? 0 : 1u << i % 3;
    const auto oracle = build<BruteForce>(set);
    for (const std::uint32_t wanted : {5u, 2u, 8u, ~0u}) {
        const auto seen = [&](const auto& found) { return (masks[found.element] & wanted) != 0; };
        const Mask mask(masks, wanted);
        expect_masked(build<WideBvh>(set), oracle, mask, seen);
        for (const char* spec : {"wide", "grid", "kdtree"}) {
            SCOPED_TRACE(spec);
            expect_masked(*build_any(spec, set), oracle, mask, seen);
        }
    }
    expect_masked(build<WideBvh>(set), oracle, {}, [](const auto&) { return true; });
}

TEST(Masks, OfElements) {
    expect_masks_of(teapot<float>(300));
    expect_masks_of(soup<double>(200));
    expect_masks_of(spheres<float>(100));
    expect_masks_of(segments2d<double>(100));
    expect_masks_of(points<float>(300));
}

/// Many that ask among points are answered by cells, as those without a mask are.
TEST(Masks, OfNeighboursInCells) {
    const auto cloud = points<float>(6000);
    std::vector<std::uint32_t> masks(cloud.size());
    for (std::size_t i = 0; i < masks.size(); ++i) masks[i] = 1u << i % 3;
    const auto lists = within(build(cloud), cloud.points, 0.05, {.mask = {masks, 6}});
    const auto of_all = within(build(cloud), cloud.points, 0.05);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        std::vector<PrimitiveId> seen;
        for (const PrimitiveId id : of_all[i].ids)
            if (id % 3 != 0) seen.push_back(id);
        ASSERT_TRUE(std::ranges::equal(lists[i].ids, seen)) << i;
    }
}

TEST(Masks, OfInstances) {
    const auto mesh = teapot<float>(100);
    const auto brute = build<BruteForce>(mesh);
    const auto wide = build(mesh);
    const auto any = build_any("octree", mesh);
    const auto mask_of = [](std::size_t i) { return i % 4 == 3 ? 0 : 1u << i % 3; };
    const auto over = [&]<class I>(const I& index) {
        std::vector<Instance<I>> placed;
        for (const auto& transform : transforms<3>(24, Scales::even, 20))
            placed.emplace_back(index, transform, mask_of(placed.size()));
        return InstanceSet<I>(placed);
    };
    const auto oracle = build<BruteForce>(over(brute));
    for (const std::uint32_t wanted : {3u, 4u, 8u, ~0u}) {
        SCOPED_TRACE(wanted);
        const auto seen = [&](const auto& found) { return (mask_of(found.instance) & wanted) != 0; };
        expect_masked(build<WideBvh>(over(wide)), oracle, wanted, seen);
        expect_masked(build<Grid>(over(wide)), oracle, wanted, seen);
        expect_masked(build<AnyStructure>(over(wide), {"kdtree"}), oracle, wanted, seen);
        expect_masked(build<Bvh>(over(*any)), oracle, wanted, seen);
        // A filter that enters instances does the same, of points too.
        const contract::Questions questions(oracle, 40);
        const auto index = build<WideBvh>(over(wide));
        for (const auto& p : questions.points)
            ASSERT_EQ(closest_point(index, p, Enters{wanted}), closest_point(oracle, p, seen));
    }
    // Whatever bits an instance has, it is seen where no mask is given.
    expect_masked(build<WideBvh>(over(wide)), oracle, {}, [](const auto&) { return true; });
}

TEST(Masks, RefuseThoseOfOtherSets) {
    const auto mesh = teapot<float>(100);
    const auto index = build(mesh);
    const std::vector<std::uint32_t> few(mesh.size() - 1, 1);
    const Mask mask(few, 1);
    const Ray3f ray{{}, {1, 0, 0}};
    std::vector<Ray3f> rays(3, ray);
    std::vector<Hit<float>> hits(3);
    EXPECT_THROW(closest_hit(index, ray, {.mask = mask}), InputError);
    EXPECT_THROW(closest_hits(index, rays, hits, {.mask = mask}), InputError);
    EXPECT_THROW(closest_point(index, Vec3f(), {.mask = mask}), InputError);
    EXPECT_THROW(within(index, Vec3f(), 1, {.mask = mask}), InputError);
    EXPECT_THROW(nearest(index, std::vector<Vec3f>(3), 2, {.mask = mask}), InputError);
    EXPECT_THROW(closest_hit(index, ray, {.mask = 2}), InputError);
    EXPECT_THROW(closest_point(*build_any("grid", mesh), Vec3f(), {.mask = 2}), InputError);
    const auto world = build(InstanceSet{Instance(index)});
    const std::vector<std::uint32_t> each(mesh.size(), 1);
    EXPECT_THROW(closest_hit(world, ray, {.mask = {each, 1}}), InputError);
    EXPECT_THROW(nearest(world, Vec3f(), 2, {.mask = {each, 1}}), InputError);
}

}  // namespace
