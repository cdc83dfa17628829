/// Farthest points against all corners in long double, and last hits against the lists of all hits.
#include <gtest/gtest.h>

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>
#include <hedgerow/scenes/sets.h>

#include "every_structure.h"

using namespace hedgerow;

namespace {

template <int D, class T>
long double distance_to(const Vec<T, D>& p, const Vec<T, D>& q) {
    long double sum = 0;
    for (int k = 0; k < D; ++k) {
        const long double d = static_cast<long double>(p[k]) - static_cast<long double>(q[k]);
        sum += d * d;
    }
    return std::sqrt(sum);
}
template <class P, class V>
long double farthest_of(const P& set, std::size_t i, const V& p) {
    long double most = 0;
    if constexpr (requires { set.corners(i); }) {
        for (const auto& corner : set.corners(i)) most = std::max(most, distance_to(p, corner));
    } else if constexpr (requires { set.sphere(i); }) {
        most = distance_to(p, set.sphere(i).center) + static_cast<long double>(set.sphere(i).radius);
    } else {
        most = distance_to(p, set.point(i));
    }
    return most;
}

/// Points in, on, around and far from a set: at places of primitives, between them, and beyond.
template <class P>
auto places_around(const P& set, std::size_t count) {
    using T = typename P::Scalar;
    constexpr int D = P::dimension;
    Box<T, D> all;
    for (std::size_t i = 0; i < set.size(); ++i) all.expand(set.bounds(i));
    std::vector<Vec<T, D>> places;
    for (std::size_t i = 0; i < count; ++i) {
        Random random(7, i);
        Vec<T, D> p = all.center();
        const T reach = i % 4 == 3 ? T(100) : T(1);
        for (int k = 0; k < D; ++k) p[k] += reach * T(random.uniform() - 0.5) * all.extent()[k];
        if (i % 4 == 1) p = set.bounds(random.bits() % set.size()).low;
        if (i % 8 == 2) p = all.center();
        places.push_back(p);
    }
    return places;
}

template <class P>
void expect_farthest(const P& owned) {
    using T = typename P::Scalar;
    const auto set = view_of(owned);
    const auto places = places_around(set, 60);
    for_each_index(owned, [&](const char* name, const auto& index) {
        SCOPED_TRACE(name);
        std::vector<NearOf<std::decay_t<decltype(index)>>> batch(places.size());
        farthest_points(index, places, batch, {.threads = 2});
        for (std::size_t n = 0; n < places.size(); ++n) {
            const auto& p = places[n];
            const auto found = farthest_point(index, p);
            ASSERT_EQ(found, batch[n]);
            ASSERT_TRUE(found);
            long double most = 0;
            for (std::size_t i = 0; i < set.size(); ++i) most = std::max(most, farthest_of(set, i, p));
            // The place, the distance, and the element agree with the oracle to roundings of the scalar.
            const long double error =
                16 * static_cast<long double>(unit_roundoff<T>) *
                (most + static_cast<long double>(max_component(abs(index.bounds().high)) +
                                                 max_component(abs(index.bounds().low))));
            ASSERT_LE(std::abs(std::sqrt(static_cast<long double>(found.distance2)) - most), error);
            ASSERT_LE(std::abs(farthest_of(set, found.element, p) - most), error);
            ASSERT_LE(std::abs(distance_to(p, found.point) - most), error);
            // Without it, another; within half the distance, one that lies there; within a factor, far
            // enough.
            const auto other = farthest_point(index, p, {.leave_out = found.element});
            ASSERT_TRUE(!other || other.element != found.element);
            ASSERT_TRUE(!other || other.distance2 <= found.distance2);
            const auto half = farthest_point(index, p, {.radius2 = static_cast<double>(found.distance2) / 4});
            ASSERT_TRUE(!half || half.distance2 <= found.distance2 / 4);
            const auto about = farthest_point(index, p, {.factor = 2});
            ASSERT_GE(about.distance2 * T(4.001), found.distance2);
        }
        EXPECT_FALSE(farthest_point(index, places[0], {.radius = -1}));
    });
}

template <class T>
class Farthest : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Farthest, Scalars);

TYPED_TEST(Farthest, OfTriangles) {
    expect_farthest(teapot<TypeParam>(600));
    expect_farthest(soup<TypeParam>(300));
}
TYPED_TEST(Farthest, OfPointsSpheresAndSegments) {
    expect_farthest(points<TypeParam>(500));
    expect_farthest(spheres<TypeParam>(300));
    expect_farthest(segments2d<TypeParam>(300));
}
TYPED_TEST(Farthest, OfOneAndOfCoincidentOnes) {
    using T = TypeParam;
    PointCloud<T, 3> cloud{{{1, 2, 3}}};
    expect_farthest(cloud);
    cloud.points.assign(40, {1, 2, 3});
    expect_farthest(cloud);
    const auto index = build<Bvh>(cloud);
    EXPECT_EQ(farthest_point(index, {0, 0, 0}).element, 0u) << "ties go to the lowest";
    EXPECT_FALSE(farthest_point(build<Bvh>(PointCloud<T, 3>()), {0, 0, 0}));
}
/// The walk opens few nodes of a tree.
TEST(Farthest, IsFoundInFewSteps) {
    const auto mesh = teapot<float>(20000);
    for (const char* spec : {"bvh", "octree", "kdtree"}) {
        const auto index = build<AnyStructure>(mesh, {spec});
        Visits visits;
        for (const auto& p : places_around(view_of(mesh), 20))
            farthest_point(index, p, {}, KeepAll(), visits);
        EXPECT_LT(visits.primitives, 20 * mesh.size() / 20) << spec;
    }
}

/// The hit of greatest t of a list in the order of (t, element): of several the first.
template <class T>
Hit<T> last_of(const std::vector<Hit<T>>& all) {
    const auto last =
        std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
    return last == all.end() ? Hit<T>() : *last;
}
TYPED_TEST(Farthest, LastHitsAreTheEndsOfTheListsOfAll) {
    using T = TypeParam;
    const auto mesh = teapot<T>(400);
    std::vector<Ray<T, 3>> rays;
    for (const auto& p : places_around(view_of(mesh), 200)) {
        Ray<T, 3> ray{p, mesh.vertices[rays.size() % mesh.vertices.size()] - p};
        if (rays.size() % 5 == 0) ray.t_max = T(0.7);
        rays.push_back(ray);
    }
    rays.push_back({{0, 0, 0}, {0, 0, 0}});
    std::size_t several = 0;
    for_each_index(mesh, [&](const char* name, const auto& index) {
        std::vector<Hit<T>> last(rays.size());
        last_hits(index, rays, last, {.threads = 2});
        for (std::size_t i = 0; i < rays.size(); ++i) {
            auto all = all_hits(index, rays[i]);
            several += all.size() > 1;
            ASSERT_EQ(last[i], last_of(all)) << name;
            const PrimitiveId element = last[i].element;
            std::erase_if(all, [&](const auto& hit) { return hit.element == element; });
            ASSERT_EQ(last_hit(index, rays[i], {.leave_out = element}), last_of(all)) << name;
        }
    });
    EXPECT_GT(several, 100u);
}

}  // namespace
