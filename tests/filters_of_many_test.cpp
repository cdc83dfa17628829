/// Filters that are called once for many answers: the answers are those of the same filter, called for each.
#include <hedgerow/any_index.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

#include "contract.h"

using namespace hedgerow;

namespace {

/// Compares batches with `keeps`, called for each answer, with those of the same called for many.
template <class I, class Keeps>
void expect_the_same(const I& index, const Keeps& keeps) {
    using T = typename I::Scalar;
    using Id = IdOf<typename I::Primitives>;
    const contract::Questions questions(index, 400);
    const auto& rays = questions.rays;
    std::size_t calls = 0;
    const auto many = [&](std::span<const std::size_t> of, std::span<const Hit<T>> hits,
                          std::span<bool> keep) {
        ++calls;
        EXPECT_TRUE(std::is_sorted(of.begin(), of.end()));
        for (std::size_t j = 0; j < hits.size(); ++j) keep[j] = keep[j] && keeps(of[j], hits[j].element);
    };
    const auto each = [&](std::size_t i, const Hit<T>& hit) { return keeps(i, hit.element); };
    std::vector<PrimitiveId> own(rays.size());
    for (std::size_t i = 0; i < own.size(); ++i)
        own[i] = i % 2 == 0 ? closest_hit(index, rays[i]).element : no_primitive;
    for (const RayOptions& options : {RayOptions(), RayOptions{.leave_out = own, .threads = 2}}) {
        std::vector<Hit<T>> hits(rays.size()), want(rays.size());
        closest_hits(index, rays, hits, options, many);
        closest_hits(index, rays, want, options, each);
        for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(hits[i], want[i]) << "ray " << i;
        std::vector<std::uint8_t> any(rays.size()), want_any(rays.size());
        any_hits(index, rays, any, options, many);
        any_hits(index, rays, want_any, options, each);
        EXPECT_EQ(any, want_any);
        EXPECT_EQ(all_hits(index, rays, options, many), all_hits(index, rays, options, each));
        std::vector<std::size_t> counts(rays.size()), want_counts(rays.size());
        hit_counts(index, rays, counts, options, many);
        hit_counts(index, rays, want_counts, options, each);
        EXPECT_EQ(counts, want_counts);
        std::vector<Visits> visits(rays.size()), of_one(rays.size());
        closest_hits(index, rays, hits, options, many, visits);
        EXPECT_EQ(hits, want);
        closest_hits(index, rays, hits, options, KeepAll(), of_one);
        for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_GE(visits[i].nodes, of_one[i].nodes) << i;
    }
    EXPECT_LT(calls, 200u);

    const auto& points = questions.points;
    own.resize(points.size());
    const auto many_near = [&](std::span<const std::size_t> of, std::span<const Id> ids,
                               std::span<const T> distances2, std::span<bool> keep) {
        EXPECT_EQ(ids.size(), distances2.size());
        for (std::size_t j = 0; j < ids.size(); ++j) keep[j] = keeps(of[j], detail::element_of_id(ids[j]));
    };
    const auto each_near = [&](std::size_t i, const NearOf<I>& near) { return keeps(i, near.element); };
    const double radius = 0.3 * static_cast<double>(max_component(index.bounds().extent()));
    for (const PointOptions& options :
         {PointOptions(), PointOptions{.radius = radius, .leave_out = own, .threads = 2}}) {
        for (const std::size_t k : {0u, 1u, 7u, 100000u})
            ASSERT_EQ(nearest(index, points, k, options, many_near),
                      nearest(index, points, k, options, each_near))
                << k;
        std::vector<NearOf<I>> closest(points.size()), want(points.size());
        closest_points(index, points, closest, options, many_near);
        closest_points(index, points, want, options, each_near);
        ASSERT_EQ(closest, want);
        const auto rough = nearest(index, points, 3, {.factor = 1.5}, many_near);
        const auto exact = nearest(index, points, 3, {}, each_near);
        for (std::size_t i = 0; i < points.size(); ++i) {
            ASSERT_EQ(rough[i].size(), exact[i].size()) << i;
            for (std::size_t j = 0; j < rough[i].size(); ++j) {
                ASSERT_LE(rough[i].distances2[j], T(2.2501) * exact[i].distances2[j]) << i;
                ASSERT_GE(rough[i].distances2[j], exact[i].distances2[j]) << i;
            }
        }
        ASSERT_EQ(within(index, points, radius, options, many_near),
                  within(index, points, radius, options, each_near));
        std::vector<std::size_t> offsets(points.size() + 1);
        std::vector<Id> ids(3 * points.size());
        std::vector<T> distances2(ids.size());
        auto mine = lists_in(std::span(offsets), std::span(ids), std::span(distances2));
        nearest(index, points, 3, mine, options, many_near);
        ASSERT_EQ(mine, nearest(index, points, 3, options, each_near));
    }
}

template <class I>
void expect_all_filters(const I& index) {
    expect_the_same(index, [](std::size_t, PrimitiveId) { return true; });
    expect_the_same(index, [](std::size_t, PrimitiveId) { return false; });
    expect_the_same(index, [](std::size_t i, PrimitiveId element) { return (element + i) % 3 == 0; });
    expect_the_same(index,
                    [](std::size_t i, PrimitiveId element) { return i % 2 == 0 && element % 50 == 7; });
}

TEST(FiltersOfMany, AreThoseOfEach) {
    const auto mesh = teapot<float>(500);
    const auto wide = build(mesh);
    expect_all_filters(wide);
    expect_all_filters(*build_any("octree", mesh));
    expect_all_filters(*build_any("wide", spheres<double>(200).view()));
    expect_all_filters(build<Bvh>(segments2d<float>(200)));
    const InstanceSet world{Instance(wide), Instance(wide, Transform<3>::translation({0.1, 0, 0})),
                            Instance(wide, Transform<3>::rotation({1, 0, 0}, 1))};
    expect_all_filters(build(world));
}

/// Coincident triangles: every next hit is at the same t.
TEST(FiltersOfMany, OfCoincidentTriangles) {
    TriangleMesh<float> mesh = cube<float>(12);
    const auto once = mesh.triangles;
    for (int copy = 0; copy < 200; ++copy)
        mesh.triangles.insert(mesh.triangles.end(), once.begin(), once.end());
    const auto index = build(mesh);
    expect_the_same(index,
                    [&](std::size_t i, PrimitiveId element) { return element >= (i % 200) * once.size(); });
}

/// A filter that refuses nearly all that is near a point.
TEST(FiltersOfMany, ThatRefuseNearlyAll) {
    const auto cloud = points<float>(30000);
    const auto index = build(cloud);
    const std::vector<Vec3f> asked(cloud.points.begin(), cloud.points.begin() + 20);
    const auto few = [](auto, std::span<const PrimitiveId> ids, auto, std::span<bool> keep) {
        for (std::size_t j = 0; j < ids.size(); ++j) keep[j] = ids[j] % 10000 == 7;
    };
    const auto each = [](const Near<float, 3>& near) { return near.element % 10000 == 7; };
    EXPECT_EQ(nearest(index, asked, 5, {}, few), nearest(index, asked, 5, {}, each));
    EXPECT_EQ(nearest(index, asked, 2, few), nearest(index, asked, 2, each));
    const auto most = [](auto, std::span<const PrimitiveId> ids, auto, std::span<bool> keep) {
        for (std::size_t j = 0; j < ids.size(); ++j) keep[j] = ids[j] % 50 != 7;
    };
    const auto but_some = [](const Near<float, 3>& near) { return near.element % 50 != 7; };
    std::vector<std::uint32_t> bits(cloud.size());
    for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = 1u << i % 3;
    for (const std::size_t k : {129u, 200u, 5000u})
        EXPECT_EQ(nearest(index, asked, k, {.mask = {bits, 3}, .threads = 2}, most),
                  nearest(index, asked, k, {.mask = {bits, 3}}, but_some));
}

/// The filter may ask questions of its own.
TEST(FiltersOfMany, MayAskAgain) {
    const auto mesh = teapot<float>(300);
    const auto index = build(mesh);
    const contract::Questions questions(index, 100);
    const auto& rays = questions.rays;
    const auto twice = [&](std::size_t i, const Hit<float>& hit) {
        return hit_count(index, rays[i]) > 1 && closest_point(index, rays[i].at(hit.t)).distance2 < 1;
    };
    const auto many = [&](std::span<const std::size_t> of, std::span<const Hit<float>> hits,
                          std::span<bool> keep) {
        const auto inner = all_hits(index, rays, [](auto, auto, auto) {});
        for (std::size_t j = 0; j < hits.size(); ++j)
            keep[j] = twice(of[j], hits[j]) && !inner[of[j]].empty();
    };
    std::vector<Hit<float>> hits(rays.size()), want(rays.size());
    closest_hits(index, rays, hits, many);
    closest_hits(index, rays, want, twice);
    EXPECT_EQ(hits, want);
    EXPECT_EQ(all_hits(index, rays, many), all_hits(index, rays, twice));
}

TEST(FiltersOfMany, LeaveNothingRefusedWhenTheyThrow) {
    struct Refusal {};
    const auto mesh = teapot<float>(300);
    const auto index = build(mesh);
    const contract::Questions questions(index, 100);
    std::vector<Hit<float>> hits(questions.rays.size());
    HitLists<float> lists;
    const auto throws = [](auto, auto, auto) { throw Refusal(); };
    EXPECT_THROW(closest_hits(index, questions.rays, hits, throws), Refusal);
    for (const auto& hit : hits) EXPECT_FALSE(hit);
    EXPECT_THROW(all_hits(index, questions.rays, lists, throws), Refusal);
    EXPECT_EQ(lists.count(), 0u);
}

TEST(FiltersOfMany, NeedRoomAsOthersDo) {
    const auto mesh = teapot<float>(300);
    const auto index = build(mesh);
    const std::vector<Vec3f> points(10);
    const std::vector<PrimitiveId> few(5, 1);
    std::vector<Visits> visits(5);
    NearLists<float> lists;
    const auto all = [](auto, auto, auto, auto) {};
    EXPECT_THROW(nearest(index, points, 2, {.leave_out = few}, all), InputError);
    EXPECT_THROW(nearest(index, points, 2, lists, {}, all, visits), InputError);
    EXPECT_THROW(nearest(index, points, 2, {.factor = 0.5}, all), InputError);
}

TEST(FiltersOfMany, OfNothing) {
    const TriangleMesh<float> none;
    const auto index = build(none);
    const auto many = [](auto, auto, auto) { FAIL() << "asked of nothing"; };
    std::vector<Ray3f> rays(3);
    std::vector<Hit<float>> hits(3);
    closest_hits(index, rays, hits, many);
    EXPECT_FALSE(hits[0]);
    EXPECT_EQ(all_hits(index, rays, many).size(), 3u);
    closest_hits(index, std::vector<Ray3f>(), std::span<Hit<float>>(), many);
    const auto near = [](auto, auto, auto, auto) { FAIL() << "asked of nothing"; };
    EXPECT_EQ(nearest(index, std::vector<Vec3f>(2), 4, {}, near).size(), 2u);
    EXPECT_EQ(within(index, std::vector<Vec3f>(2), 4, {}, near).count(), 0u);
}

}  // namespace
