/// How far questions of a point look and how exactly, for every structure: radii, squared radii and factors.
#include <gtest/gtest.h>

#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>

#include "every_structure.h"
#include "lists.h"

using namespace hedgerow;

namespace {

template <std::floating_point T, int D>
PointCloud<T, D> some_points(std::size_t count) {
    PointCloud<T, D> cloud;
    for (std::uint64_t i = 0; i < count; ++i) {
        Random random(11, i);
        Vec<T, D> p;
        for (int k = 0; k < D; ++k)
            p[k] = static_cast<T>(i % 3 == 0 ? random.uniform() * 0.1 : random.uniform());
        cloud.points.push_back(p);
    }
    return cloud;
}
template <class I>
PointOf<I> question(const I& index, std::uint64_t i) {
    Random random(12, i);
    PointOf<I> p;
    for (int k = 0; k < I::dimension; ++k)
        p[k] = index.bounds().low[k] +
               index.bounds().extent()[k] * static_cast<typename I::Scalar>(random.uniform(-0.5, 1.5));
    return p;
}

/// Expects answers within the factor of the exact ones, by exact distances, for fewer visits in all.
template <class I>
void expect_within_factor(const I& index, typename I::Scalar factor) {
    using T = typename I::Scalar;
    std::vector<NearOf<I>> exact, found;
    const T bound = factor * factor * T(1 + 1e-6);
    Visits needed, spent;
    for (std::uint64_t i = 0; i < 200; ++i) {
        const auto p = question(index, i);
        const auto best = closest_point(index, p, {}, KeepAll(), needed),
                   near = closest_point(index, p, {.factor = factor}, KeepAll(), spent);
        ASSERT_TRUE(near);
        EXPECT_LE(near.distance2, best.distance2 * bound);
        const auto alone = closest_point(index, p, {.radius2 = near.distance2, .factor = factor});
        ASSERT_TRUE(alone);
        nearest(index, p, 7, exact);
        ASSERT_EQ(nearest(index, p, 7, found, {.factor = factor}), exact.size());
        for (std::size_t k = 0; k < found.size(); ++k) {
            EXPECT_LE(found[k].distance2, exact[k].distance2 * bound) << k;
            EXPECT_EQ(found[k].distance2,
                      foot_of(p, index.primitives().closest_point(found[k].element, p)).distance2);
        }
    }
    EXPECT_LE(spent.leaves, needed.leaves);
}

template <class I>
void expect_radii(const I& index) {
    using T = typename I::Scalar;
    const auto p = question(index, 3);
    std::vector<NearOf<I>> all, some;
    ASSERT_EQ(nearest(index, p, index.size(), all), index.size());
    // All but those of the greatest distance are within the distance of the middle.
    const T middle = all[index.size() / 2].distance2;
    std::size_t want = 0;
    while (want < all.size() && all[want].distance2 <= middle) ++want;
    EXPECT_EQ(within(index, p, PointOptions::anywhere, some, {.radius2 = middle}), want);
    EXPECT_EQ(nearest(index, p, index.size(), some, {.radius2 = middle}), want);
    const T radius = T(0.4);
    EXPECT_EQ(within(index, p, radius, some),
              within(index, p, PointOptions::anywhere, all, {.radius2 = largest_square_within(radius)}));
    EXPECT_EQ(some, all);
    // Both hold.
    EXPECT_EQ(within(index, p, radius, some, {.radius2 = 0}), 0u);
    EXPECT_EQ(within(index, p, radius, some, {.radius = 0}), within(index, p, 0, all, {.radius = radius}));
    EXPECT_EQ(some, all);
    EXPECT_FALSE(closest_point(index, p, {.radius = 0, .radius2 = 1}));
    constexpr T nan = std::numeric_limits<T>::quiet_NaN();
    for (const PointOptions& nothing : {PointOptions{.radius = -1}, PointOptions{.radius2 = -1},
                                        PointOptions{.radius = nan}, PointOptions{.radius2 = nan}}) {
        EXPECT_FALSE(closest_point(index, p, nothing));
        EXPECT_EQ(nearest(index, p, 3, some, nothing), 0u);
        EXPECT_EQ(within(index, p, PointOptions::anywhere, some, nothing), 0u);
    }
    EXPECT_EQ(within(index, p, -1, some), 0u);
    EXPECT_EQ(within(index, p, nan, some), 0u);
    constexpr T infinity = std::numeric_limits<T>::infinity();
    EXPECT_EQ(within(index, p, infinity, some), index.size());
    for (const T factor : {T(0.99), T(-1), nan}) {
        EXPECT_THROW(closest_point(index, p, {.factor = factor}), InputError);
        EXPECT_THROW(nearest(index, p, 3, some, {.factor = factor}), InputError);
    }
}

template <class Set>
void expect_options(const Set& set) {
    for_each_index(set, [](const char* name, const auto& index) {
        SCOPED_TRACE(name);
        expect_radii(index);
        for (const double factor : {1.0, 1.1, 2.0, 10.0})
            expect_within_factor(index, static_cast<typename std::decay_t<decltype(index)>::Scalar>(factor));
    });
}

TEST(PointOptions, CloudsInSpace) {
    expect_options(some_points<float, 3>(600));
    expect_options(some_points<double, 3>(600));
}
TEST(PointOptions, CloudsInThePlane) {
    expect_options(some_points<float, 2>(400));
}
TEST(PointOptions, Meshes) {
    expect_options(soup<float>(300));
    expect_options(soup<double>(300));
}

/// The rule of radii for numbers of every size, those at the ends of the range and next to squares among
/// them.
template <class T>
void expect_rule_of_radii() {
    using limits = std::numeric_limits<T>;
    const auto expect_limit = [](T radius) {
        const T square = largest_square_within(radius);
        ASSERT_TRUE(square >= 0 && within_radius(square, radius)) << radius;
        ASSERT_TRUE(square == limits::max() ||
                    !within_radius(std::nextafter(square, limits::infinity()), radius))
            << radius;
    };
    for (std::uint64_t i = 0; i < 20000; ++i) {
        Random random(51, i);
        const int exponent = limits::min_exponent - limits::digits +
                             static_cast<int>(random.bits() % (limits::max_exponent * 2 + limits::digits));
        expect_limit(static_cast<T>(std::ldexp(1 + random.uniform(), exponent)));
        // The root of a square, as it is printed, and the number below it.
        const T square = static_cast<T>(std::ldexp(1 + random.uniform(), exponent / 2)),
                root = std::sqrt(square);
        ASSERT_LE(square, largest_square_within(root));
        ASSERT_GT(square, largest_square_within(std::nextafter(root, T(0))));
    }
    for (const T radius : {T(0), limits::denorm_min(), limits::min(), std::sqrt(limits::min()),
                           std::sqrt(limits::denorm_min()), std::sqrt(limits::max()), limits::max()})
        expect_limit(radius);
    EXPECT_EQ(largest_square_within(limits::infinity()), limits::max());
    EXPECT_EQ(largest_square_within(limits::quiet_NaN()), -1);
    EXPECT_EQ(largest_square_within(-limits::denorm_min()), -1);
}
TEST(PointOptions, RadiiBoundRoundedDistances) {
    expect_rule_of_radii<float>();
    expect_rule_of_radii<double>();
}

/// Each distance that is answered finds its primitive as a radius, by every question and every structure; the
/// next smaller radius does not.
template <class Set>
void expect_distances_are_radii(const Set& set) {
    using T = typename Set::Scalar;
    constexpr int D = Set::dimension;
    const auto oracle = build<BruteForce>(set);
    std::size_t rounded_up = 0;
    for_each_index(set, [&](const char* name, const auto& index) {
        SCOPED_TRACE(name);
        using I = std::decay_t<decltype(index)>;
        std::vector<NearOf<I>> all, found;
        std::vector<PrimitiveId> ids, wanted;
        for (std::uint64_t i = 0; i < 60; ++i) {
            const auto p = question(oracle, i);
            nearest(oracle, p, set.size(), all);
            const T radius = std::sqrt(all[i % 20].distance2), less = std::nextafter(radius, T(0));
            rounded_up += all[i % 20].distance2 > static_cast<T>(double(radius) * double(radius));
            wanted.clear();
            for (const auto& near : all)
                if (std::sqrt(near.distance2) <= radius) wanted.push_back(near.element);
            ASSERT_GT(wanted.size(), i % 20);
            ASSERT_EQ(within(index, p, radius, found), wanted.size());
            EXPECT_EQ(nearest(index, p, set.size(), found, {.radius = radius}), wanted.size());
            std::sort(wanted.begin(), wanted.end());
            const Sphere<T, D> ball{p, radius};
            EXPECT_EQ(overlapping(index, ball, ids), wanted.size());
            EXPECT_EQ(ids, wanted);
            EXPECT_EQ(overlap_count(index, ball), wanted.size());
            const T first = std::sqrt(all[0].distance2);
            EXPECT_TRUE(closest_point(index, p, {.radius = first}));
            EXPECT_TRUE(any_overlap(index, Sphere<T, D>{p, first}));
            if (!(first > 0)) continue;
            EXPECT_FALSE(closest_point(index, p, {.radius = std::nextafter(first, T(0))}));
            EXPECT_FALSE(any_overlap(index, Sphere<T, D>{p, std::nextafter(first, T(0))}));
            EXPECT_LT(within(index, p, less, found), wanted.size());
        }
        if constexpr (PointSet<ViewOf<Set>>) {
            // Pairs: those that single points find.
            nearest(oracle, set.points[5], 8, all);
            const T radius = std::sqrt(all[7].distance2);
            std::vector<PairWithin<T>> pairs;
            pairs_within(index, radius, pairs);
            std::size_t want = 0;
            for (const auto& p : set.points) want += within(oracle, p, radius, found) - 1;
            EXPECT_EQ(2 * pairs.size(), want);
            EXPECT_GE(std::count_if(pairs.begin(), pairs.end(),
                                    [](const auto& pair) { return pair.a == 5 || pair.b == 5; }),
                      7);
        }
    });
    EXPECT_GT(rounded_up, 0u);
}
TEST(PointOptions, DistancesThatWereAnsweredAreRadii) {
    expect_distances_are_radii(some_points<float, 3>(300));
    expect_distances_are_radii(some_points<double, 3>(300));
    expect_distances_are_radii(some_points<float, 2>(200));
    expect_distances_are_radii(soup<float>(100));
    expect_distances_are_radii(soup<double>(100));
}

/// A primitive at exactly the radius is within it.
TEST(PointOptions, RadiusIsIncluded) {
    const PointCloud<float, 3> cloud{{{3, 4, 0}, {0.1f, 0, 0}, {0, 7, 0}}};
    for_each_index(cloud, [](const char* name, const auto& index) {
        SCOPED_TRACE(name);
        std::vector<Near<float, 3>> found;
        EXPECT_EQ(within(index, Vec3f(0, 0, 0), 5, found), 2u);
        EXPECT_EQ(within(index, Vec3f(0, 0, 0), std::nextafter(5.0f, 0.0f), found), 1u);
        EXPECT_EQ(within(index, Vec3f(0, 0, 0), 0.1f, found), 1u);
    });
}

/// Columns of k nearest are those of single queries, for every structure.
TEST(PointOptions, ColumnsOfNearest) {
    const auto cloud = some_points<double, 2>(50);
    for_each_index(cloud, [](const char* name, const auto& index) {
        SCOPED_TRACE(name);
        std::vector<Vec2d> points;
        for (std::uint64_t i = 0; i < 30; ++i) points.push_back(question(index, i));
        points[7][0] = std::numeric_limits<double>::quiet_NaN();
        const auto lists = nearest(index, points, 60, {.radius = 0.5});
        ASSERT_EQ(lists.size(), points.size());
        for (std::size_t i = 0; i < points.size(); ++i)
            ASSERT_TRUE(same_list(lists[i], nearest(index, points[i], 60, {.radius = 0.5}))) << i;
    });
}

/// Expects that lists in columns are those of single queries, over any cut of the batch.
template <class Set, class Points>
void expect_lists_in_columns(const Set& set, const Points& points, typename Set::Scalar radius) {
    for_each_index(set, [&](const char* name, const auto& index) {
        SCOPED_TRACE(name);
        using I = std::decay_t<decltype(index)>;
        NearListsOf<I> serial, parallel;
        serial.ids.resize(3);  // what the lists hold is replaced
        within(index, points, radius, serial, {.threads = serial_executor()});
        within(index, points, radius, parallel);
        EXPECT_EQ(serial, parallel);
        ASSERT_EQ(serial.size(), points.size());
        EXPECT_EQ(serial.ids.size(), serial.count());
        std::vector<NearOf<I>> found;
        for (std::size_t i = 0; i < points.size(); ++i) {
            within(index, points[i], radius, found);
            ASSERT_TRUE(same_list(serial[i], found)) << i;
            ASSERT_TRUE(std::is_sorted(found.begin(), found.end(), nearer<NearOf<I>, NearOf<I>>));
        }
    });
}
TEST(PointOptions, ListsInColumns) {
    const auto questions_of = [](const auto& set) {
        const auto index = build<BruteForce>(set);
        std::vector<PointOf<std::decay_t<decltype(index)>>> points;
        for (std::uint64_t i = 0; i < 300; ++i) points.push_back(question(index, i));
        points[7][0] = std::numeric_limits<typename std::decay_t<decltype(set)>::Scalar>::quiet_NaN();
        return points;
    };
    const auto cloud = some_points<float, 3>(600);
    expect_lists_in_columns(cloud, questions_of(cloud), 0.5f);
    // Without the question that is no number, cells answer: all questions, and those of the points
    // themselves.
    auto asked = questions_of(cloud);
    asked.erase(asked.begin() + 7);
    for (const float radius : {0.5f, 0.05f, 0.0f, -1.0f}) expect_lists_in_columns(cloud, asked, radius);
    expect_lists_in_columns(cloud, cloud.points, 0.2f);
    const auto plane = some_points<double, 2>(60);
    expect_lists_in_columns(plane, questions_of(plane), 0.5);
    const auto triangles = soup<float>(200);
    expect_lists_in_columns(triangles, questions_of(triangles), 0.3f);
}
/// Long lists of many equal distances: a lattice, each point of it three times.
TEST(PointOptions, LongListsOfTies) {
    PointCloud<float, 3> lattice;
    for (int copy = 0; copy < 3; ++copy)
        for (int x = 0; x < 9; ++x)
            for (int y = 0; y < 9; ++y)
                for (int z = 0; z < 9; ++z) lattice.points.emplace_back(float(8 - x), float(y), float(z));
    expect_lists_in_columns(lattice, std::vector<Vec3f>{{4, 4, 4}, {0.5f, 4, 8}, {-1, -1, -1}, {20, 0, 0}},
                            6.0f);
    expect_lists_in_columns(lattice, lattice.points, 2.0f);
}

}  // namespace
