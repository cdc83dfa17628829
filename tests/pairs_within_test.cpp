/// All pairs of points within a radius, by every structure, against all pairs.
#include <gtest/gtest.h>

#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/random.h>
#include <hedgerow/scenes/sets.h>

#include "every_structure.h"

using namespace hedgerow;

namespace {

template <class T>
class PairsWithinRadius : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(PairsWithinRadius, Scalars);

template <class Cloud>
auto all_pairs(const Cloud& a, const Cloud& b, typename Cloud::Scalar radius, bool one) {
    std::vector<PairWithin<typename Cloud::Scalar>> found;
    for (PrimitiveId i = 0; i < a.size(); ++i)
        for (PrimitiveId j = one ? i + 1 : 0; j < b.size(); ++j) {
            const auto d2 = closest_point(a.points[i], b.points[j]).distance2;
            if (within_radius(d2, radius)) found.push_back({i, j, d2});
        }
    return found;
}

/// Compares the lists of every structure over `a` with all pairs, of `a` alone and with `b`.
template <class Cloud>
void expect_pairs(const char* scene, const Cloud& a, const Cloud& b, typename Cloud::Scalar radius) {
    SCOPED_TRACE(scene);
    const auto alone = all_pairs(a, a, radius, true), with = all_pairs(a, b, radius, false);
    const auto other = build(b);
    for_each_index(a, [&](const char* name, const auto& index) {
        std::vector<PairWithin<typename Cloud::Scalar>> found;
        EXPECT_EQ(pairs_within(index, radius, found), alone.size()) << name;
        EXPECT_EQ(found, alone) << name;
        EXPECT_EQ(pairs_within(index, other, radius, found), with.size()) << name;
        EXPECT_EQ(found, with) << name;
        // What `within` finds for each point: the same primitives and distances.
        std::vector<Near<typename Cloud::Scalar, Cloud::dimension>> near;
        std::size_t pairs = 0;
        for (PrimitiveId i = 0; i < a.size(); ++i)
            for (const auto& n : (within(other, a.points[i], radius, near), near)) {
                ++pairs;
                EXPECT_TRUE(std::binary_search(found.begin(), found.end(),
                                               PairWithin<typename Cloud::Scalar>{i, n.element, n.distance2}))
                    << name;
            }
        EXPECT_EQ(pairs, found.size()) << name;
    });
}

TYPED_TEST(PairsWithinRadius, OfUniformPoints) {
    using T = TypeParam;
    for (const T radius : {T(0), T(0.02), T(0.1), T(0.4)})
        expect_pairs("space", points<T>(300), points<T>(200, 1), radius);
    expect_pairs("plane", points2d<T>(300), points2d<T>(200, 1), T(0.1));
}
TYPED_TEST(PairsWithinRadius, OfClustersAndCoincidentPoints) {
    using T = TypeParam;
    PointCloud<T, 3> clusters, lattice, one, none;
    Random random(30);
    for (int i = 0; i < 240; ++i) {
        const auto center = static_cast<double>(i % 4);
        clusters.points.emplace_back(Vec3d(center, center, 0) + random.in_cube<3>() * 1e-3);
        lattice.points.emplace_back(T(random.bits() % 4), T(random.bits() % 4), T(random.bits() % 4));
        one.points.emplace_back(T(1), T(2), T(3));
    }
    expect_pairs("clusters", clusters, lattice, T(0.0005));
    expect_pairs("clusters, all", clusters, lattice, T(9));
    // Distances are exactly 0, 1, 2: the radius is included.
    for (const T radius : {T(0), T(1), T(2)}) expect_pairs("lattice", lattice, clusters, radius);
    expect_pairs("one place", one, lattice, 0);
    expect_pairs("no points", one, none, 1);
    expect_pairs("far away", lattice, one, T(0.5));
}
TYPED_TEST(PairsWithinRadius, OfHugeAndTinyCoordinates) {
    using T = TypeParam;
    constexpr int most = std::is_same_v<T, float> ? 56 : 470;
    for (const int exponent : {most, -most}) {
        auto a = points<T>(100), b = points<T>(80, 1);
        const T scale = std::ldexp(T(1), exponent);
        for (auto* cloud : {&a, &b})
            for (auto& p : cloud->points) p = p * scale;
        expect_pairs("scaled", a, b, scale * T(0.2));
    }
}
TYPED_TEST(PairsWithinRadius, RadiusAndRadius2) {
    using T = TypeParam;
    PointCloud<T, 3> cloud;
    for (int i = 0; i < 8; ++i) cloud.points.emplace_back(T(i) * T(0.1), T(0), T(0));
    const auto index = build(cloud);
    std::vector<PairWithin<T>> found;
    EXPECT_EQ(pairs_within(index, T(0.25), found), 7u + 6u);
    EXPECT_EQ(pairs_within(index, T(0.25)), found);
    EXPECT_EQ(pairs_within(index, 0.25, {.threads = 1}), found);
    EXPECT_EQ(pairs_within(index, index, T(0.05), found), 8u);  // each with itself
    // A radius that is the distance of two points has that pair.
    Random random(31);
    for (int i = 0; i < 1000; ++i) {
        PointCloud<T, 3> two;
        two.points = {Vec<T, 3>(), Vec<T, 3>(T(random.uniform()), T(0), T(0))};
        ASSERT_EQ(pairs_within(build(two), two.points[1][0], found), 1u);
    }
    for (const T bad : {T(-1), std::numeric_limits<T>::quiet_NaN(), -std::numeric_limits<T>::infinity()}) {
        EXPECT_EQ(pairs_within(index, bad, found), 0u);
        EXPECT_EQ(pairs_within(index, index, bad, found), 0u);
        EXPECT_TRUE(found.empty());
    }
    EXPECT_EQ(pairs_within(index, std::numeric_limits<T>::infinity(), found), 28u);
}
TYPED_TEST(PairsWithinRadius, TheSameForAnyNumberOfThreads) {
    using T = TypeParam;
    const auto a = build(points<T>(20000)), b = build(points<T>(10000, 1));
    std::vector<PairWithin<T>> serial, parallel;
    const ThreadLimit limit(2);
    pairs_within(a, T(0.03), serial, {.threads = serial_executor()});
    pairs_within(a, T(0.03), parallel, {.threads = default_executor()});
    EXPECT_EQ(serial, parallel);
    EXPECT_GT(serial.size(), 10000u);
    pairs_within(a, b, T(0.03), serial, {.threads = serial_executor()});
    pairs_within(a, b, T(0.03), parallel);
    EXPECT_EQ(serial, parallel);
    EXPECT_GT(serial.size(), 10000u);
}

}  // namespace
