/// Many points at one place: the engine's searches find those of the lowest ids without a look at the others.
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <hedgerow/engine/kernels.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/random.h>

#include "lists.h"

using namespace hedgerow;

namespace {

/// `count` points, of which one in `apart` is anywhere in the unit cube, and all others are at `places`.
PointCloud<float, 3> crowd(std::size_t count, std::size_t apart, const std::vector<Vec3f>& places) {
    PointCloud<float, 3> cloud;
    for (std::size_t i = 0; i < count; ++i) {
        Random random(11, i);
        const Vec3f anywhere(random.in_cube<3>());
        cloud.points.push_back(apart > 0 && i % apart == 0 ? anywhere
                                                           : places[random.bits() % places.size()]);
    }
    return cloud;
}
std::vector<Vec3f> queries(const std::vector<Vec3f>& places) {
    std::vector<Vec3f> all = places;
    for (std::size_t i = 0; i < 20; ++i) all.push_back(Vec3f(Random(12, i).in_cube<3>()));
    all.push_back(Vec3f(-5, 7, 1e6f));
    return all;
}

template <class I, class Oracle>
void expect_answers(const I& index, const Oracle& oracle, const std::vector<Vec3f>& points) {
    std::vector<Near<float, 3>> found, truth, batch(points.size());
    closest_points(index, Strided<Vec3f>(points), std::span(batch));
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto closest = closest_point(oracle, points[i]);
        EXPECT_EQ(closest_point(index, points[i]), closest) << i;
        EXPECT_EQ(batch[i], closest) << i;
    }
    for (const std::size_t k : {0u, 1u, 8u, 32u, 64u, 100u}) {
        const auto lists = nearest(index, points, k);
        for (std::size_t i = 0; i < points.size(); ++i)
            for (const float radius : {std::numeric_limits<float>::infinity(), 0.25f, 0.0f}) {
                nearest(oracle, points[i], k, truth, {.radius = radius});
                nearest(index, points[i], k, found, {.radius = radius});
                ASSERT_EQ(found, truth) << "query " << i << ", k = " << k << ", radius " << radius;
                if (radius < 1) continue;
                ASSERT_TRUE(same_list(lists[i], truth)) << "query " << i << ", k = " << k;
            }
    }
}

TEST(CrowdedPoints, AllStructuresGiveTheLowestIds) {
    const std::vector<Vec3f> one = {{0.5f, 0.25f, 0.75f}},
                             three = {{0, 0, 0}, {0.5f, 0.5f, 0.5f}, {-0.0f, 0, 0}};
    for (const auto& [count, apart, places] :
         {std::tuple(20000ul, 0ul, one), std::tuple(20000ul, 3ul, one), std::tuple(20000ul, 7ul, three),
          std::tuple(1500ul, 0ul, three), std::tuple(9ul, 0ul, one)}) {
        const auto cloud = crowd(count, apart, places);
        const auto points = queries(places);
        const auto oracle = build<BruteForce>(cloud);
        for (const auto set : instruction_sets()) {
            SCOPED_TRACE(set);
            use_instruction_set(set);
            for (const int width : wide_widths)
                for (const std::uint32_t leaf : {8u, 3u}) {
                    WideOptions options;
                    options.width = width, options.max_leaf_size = leaf;
                    const auto index = build<WideBvh>(cloud, options);
                    EXPECT_EQ(index.validate(), "");
                    EXPECT_EQ(index.structure().tree().crowded, count > 5000);
                    expect_answers(index, oracle, points);
                }
        }
    }
    use_instruction_set(instruction_sets().front());
}

TEST(CrowdedPoints, ARefitForgetsTheOrderOfIds) {
    auto cloud = crowd(20000, 0, {{0.5f, 0.25f, 0.75f}});
    // The ids of the first place become the last of another.
    std::vector<Vec3f> later(cloud.points.rbegin(), cloud.points.rend());
    for (std::size_t i = 0; i < cloud.size(); ++i) cloud.points[i] = Vec3f(float((i * 7919) % 20000), 0, 0);
    auto index = build<WideBvh>(cloud);
    EXPECT_FALSE(index.structure().tree().crowded);
    cloud.points = later;
    index.refit();
    const auto points = queries({{0.5f, 0.25f, 0.75f}});
    expect_answers(index, build<BruteForce>(cloud), points);
    auto crowded = build<WideBvh>(cloud);
    EXPECT_TRUE(crowded.structure().tree().crowded);
    crowded.refit();
    EXPECT_FALSE(crowded.structure().tree().crowded);
    expect_answers(crowded, build<BruteForce>(cloud), points);
}

/// Among a million points at one place a search opens a few nodes.
TEST(CrowdedPoints, AWalkAmongTiesLooksAtFewPoints) {
    PointCloud<float, 3> cloud;
    cloud.points.assign(1000000, {1, 2, 3});
    for (std::size_t i = 0; i < cloud.size(); i += 1000) cloud.points[i] = Vec3f(Random(13, i).in_cube<3>());
    const auto index = build<WideBvh>(cloud);
    const auto oracle = build<BruteForce>(cloud);
    std::vector<Near<float, 3>> found, truth;
    for (const std::size_t k : {1u, 8u, 32u}) {
        Visits visits;
        const Vec3f p(1.5f, 2, 3);
        index.answer<NearestAmongTies<PointCloudView<float, 3>>>(visits, p, k, NearLimits<float>(), found);
        nearest(oracle, p, k, truth);
        EXPECT_EQ(found, truth) << k;
        EXPECT_LT(visits.nodes + visits.leaves, 200u) << k;
        EXPECT_LT(visits.primitives, 500u) << k;
    }
}

}  // namespace
