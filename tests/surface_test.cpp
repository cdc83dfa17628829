/// Positions of hits and normals of surfaces there, on every kind of primitive and in instances; features
/// that closest points are on.
#include <map>

#include <hedgerow/any_index.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

#include "matrix.h"
#include "placements.h"

using namespace hedgerow;
using namespace hedgerow::matrix;

namespace {

template <class T>
class Surface : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Surface, Scalars);

/// Shoots 500 rays from all around and calls f(ray, hit) for each that hits. Returns the number of hits.
template <class I, class F>
std::size_t for_each_hit(const I& index, F f) {
    using T = typename I::Scalar;
    constexpr int D = I::dimension;
    std::size_t hits = 0;
    for (std::uint64_t i = 0; i < 500; ++i) {
        Random random(41, i);
        const Vec<T, D> from = point_in(index.bounds(), 1.0, random),
                        to = point_in(index.bounds(), 0.0, random);
        const Ray<T, D> ray{from, to - from};
        const auto hit = closest_hit(index, ray);
        if (!hit) continue;
        f(ray, hit);
        ++hits;
    }
    return hits;
}

template <class T, int D>
double error_of(const Vec<T, D>& a, const Vec<double, D>& b) {
    return length(Vec<double, D>(a) - b);
}

/// ray.at(t), computed in double.
template <class T, int D>
Vec<double, D> exactly_at(const Ray<T, D>& ray, T t) {
    return Vec<double, D>(ray.origin) + Vec<double, D>(ray.direction) * double(t);
}

TYPED_TEST(Surface, OfTriangles) {
    using T = TypeParam;
    const auto mesh = teapot<T>(500);
    const auto index = build(mesh);
    const double u = static_cast<double>(unit_roundoff<T>);
    EXPECT_GT(for_each_hit(index,
                           [&](const auto& ray, const auto& hit) {
                               const auto t = mesh.view().triangle(hit.element);
                               const Vec3d a(t.a), b(t.b), c(t.c);
                               const auto p = position(index, hit), n = normal(mesh, hit);
                               EXPECT_LT(error_of(p, exactly_at(ray, hit.t)), 512 * u);
                               EXPECT_EQ(p, position(mesh, ray, hit));
                               EXPECT_EQ(n, normal(index, ray, hit));
                               EXPECT_NEAR(length(Vec3d(n)), 1, 4 * u);
                               EXPECT_NEAR(dot(Vec3d(n), Vec3d(p) - a), 0, 64 * u);
                               EXPECT_NEAR(dot(Vec3d(n), normalized(b - a)), 0, 8 * u);
                               EXPECT_NEAR(dot(Vec3d(n), normalized(c - a)), 0, 8 * u);
                               EXPECT_GT(dot(Vec3d(n), cross(b - a, c - a)), 0);
                           }),
              100u);
}

/// ray.at(t) errs by roundings of the distance travelled. The position from u and v errs only by roundings of
/// the triangle's coordinates.
TEST(Surface, IsMetAsExactlyFromAfar) {
    const TriangleMesh<float> mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}};
    const auto index = build(mesh);
    int hits = 0, off_the_plane = 0;
    for (std::uint64_t i = 0; i < 200; ++i) {
        Random random(42, i);
        const Vec3f from = Vec3f(random.direction<3>()) * 1e6f, at(0.25f, 0.25f, 0);
        const Ray3f ray{from, (at - from) * 0.3f};
        const auto hit = closest_hit(index, ray);
        if (!hit) continue;
        ++hits, off_the_plane += ray.at(hit.t)[2] != 0;
        EXPECT_EQ(position(index, hit)[2], 0);
        EXPECT_EQ(normal(index, hit), Vec3f(0, 0, 1));
    }
    EXPECT_GT(hits, 100);
    EXPECT_GT(off_the_plane, 20);
}

/// Positions on spheres do not err with the distance travelled either, although t does: the ray goes 10^4,
/// and the radius is 0.01.
TEST(Surface, OfSpheresIsMetAsExactlyFromAfar) {
    const SphereSet<float, 3> set{{{{0, 0, 0}, 0.01f}}};
    const auto index = build<Bvh>(set);
    int hits = 0;
    for (std::uint64_t i = 0; i < 200; ++i) {
        Random random(43, i);
        const Vec3f from = Vec3f(random.direction<3>()) * 1e4f;
        const Ray3f ray{from, -from * 0.3f};
        const auto hit = closest_hit(index, ray);
        if (!hit) continue;
        ++hits;
        const Vec3d along = normalized(Vec3d(ray.direction)), p(position(index, ray, hit));
        EXPECT_LT(length(cross(along, p - Vec3d(from))), 1e-8) << "from the ray's line";
    }
    EXPECT_GT(hits, 100);
}

/// The rounded cross product of this triangle's edges is 0, yet rays hit it.
TEST(Surface, OfASliverHasADirection) {
    const double u = 0x1p-53;
    const TriangleMesh<double> mesh{{{0, 0, 0}, {1, 1 - u, 0}, {1 - u, 1 - 2 * u, 0}}, {{0, 1, 2}}, {}};
    const Ray<double, 3> ray{{0, 0, 5}, {0, 0, -1}};
    const auto hit = closest_hit(build<BruteForce>(mesh), ray);
    ASSERT_TRUE(hit);
    EXPECT_EQ(std::abs(normal(mesh, ray, hit)[2]), 1);
}

/// Triangles of the largest and the smallest size have normals, though their squared areas are out of range.
TYPED_TEST(Surface, OfTinyAndHugeTriangles) {
    using T = TypeParam;
    for (const T size : {largest_coordinate<T>, T(1) / largest_coordinate<T>}) {
        const TriangleMesh<T> mesh{{{0, 0, 0}, {0, size, 0}, {0, 0, size}}, {{0, 1, 2}}, {}};
        const auto index = build(mesh);
        const auto hit = closest_hit(index, Ray<T, 3>{{size, size / 4, size / 4}, {-size, 0, 0}});
        ASSERT_TRUE(hit);
        EXPECT_EQ(normal(index, hit), (Vec<T, 3>(1, 0, 0)));
        EXPECT_EQ(position(index, hit), (Vec<T, 3>(0, size / 4, size / 4)));
    }
}

TYPED_TEST(Surface, OfSpheres) {
    using T = TypeParam;
    const auto set = spheres<T>(50);
    const auto index = build<KdTree>(set);
    const double u = static_cast<double>(unit_roundoff<T>);
    EXPECT_GT(for_each_hit(index,
                           [&](const auto& ray, const auto& hit) {
                               const auto ball = set.view().sphere(hit.element);
                               const Vec3d center(ball.center);
                               const auto p = position(index, ray, hit), n = normal(index, ray, hit);
                               const double radius = static_cast<double>(ball.radius);
                               EXPECT_NEAR(length(Vec3d(p) - center), radius, 4 * u);
                               EXPECT_LT(error_of(p, exactly_at(ray, hit.t)), 512 * u);
                               EXPECT_LT(error_of(n, (Vec3d(p) - center) / radius), 512 * u);
                           }),
              100u);
    const SphereSet<T, 3> one_point{{{{1, 2, 3}, 0}}};
    EXPECT_EQ(normal(one_point, Ray<T, 3>{{1, 2, 5}, {0, 0, -2}}, Hit<T>{1, 0, 0, 0, 0, 0, 0}),
              (Vec<T, 3>(0, 0, 1)));
}

TYPED_TEST(Surface, OfSegments) {
    using T = TypeParam;
    const auto set = segments2d<T>(200);
    const auto index = build<Orthtree>(set);
    const double u = static_cast<double>(unit_roundoff<T>);
    EXPECT_GT(for_each_hit(index,
                           [&](const auto& ray, const auto& hit) {
                               const auto s = set.view().segment(hit.element);
                               const Vec2d along = normalized(Vec2d(s.b) - Vec2d(s.a));
                               const auto p = position(index, hit), n = normal(index, hit);
                               EXPECT_LT(error_of(p, exactly_at(ray, hit.t)), 512 * u);
                               EXPECT_LT(error_of(n, Vec2d(-along[1], along[0])), 4 * u);
                           }),
              100u);
}

/// Hits on instances lie on the transformed triangles and face as these do. Mirrored instances keep their
/// outside.
TYPED_TEST(Surface, OfInstances) {
    using T = TypeParam;
    const auto mesh = teapot<T>(200);
    const auto pot = build<Grid>(mesh);
    const auto places = transforms<3>(20, Scales::any, 20);
    std::vector<Instance<decltype(pot)>> instances;
    instances.reserve(places.size());
    for (const auto& place : places) instances.emplace_back(pot, place);
    const InstanceSet set(instances);
    const auto index = build<Bvh>(set);
    const double u = static_cast<double>(unit_roundoff<T>);
    int mirrored = 0;
    EXPECT_GT(for_each_hit(index,
                           [&](const auto& ray, const auto& hit) {
                               const auto& there = places[hit.instance].there();
                               const auto own = mesh.view().triangle(hit.element);
                               const Vec3d ab = there.vector(Vec3d(own.b) - Vec3d(own.a)),
                                           ac = there.vector(Vec3d(own.c) - Vec3d(own.a));
                               const auto p = position(index, hit), n = normal(set, hit);
                               EXPECT_EQ(p, position(index, ray, hit));
                               EXPECT_LT(error_of(p, exactly_at(ray, hit.t)), 4096 * u);
                               EXPECT_NEAR(dot(Vec3d(n), normalized(ab)), 0, 64 * u);
                               EXPECT_NEAR(dot(Vec3d(n), normalized(ac)), 0, 64 * u);
                               EXPECT_NEAR(length(Vec3d(n)), 1, 4 * u);
                               const auto& m = there.linear;
                               const double volume = dot(m[0], cross(m[1], m[2]));
                               mirrored += volume < 0;
                               EXPECT_GT(volume * dot(Vec3d(n), cross(ab, ac)), 0);
                           }),
              100u);
    EXPECT_GT(mirrored, 5);
}

TEST(Surface, OfInstancesOfSpheres) {
    const auto balls = spheres<double>(50);
    const auto index = build<Bvh>(balls);
    const auto placed = Transform<3>::translation({1, 2, 3}) * Transform<3>::scaling(4);
    const InstanceSet set{Instance(index, placed)};
    EXPECT_GT(for_each_hit(build<Bvh>(set),
                           [&](const auto& ray, const auto& hit) {
                               const auto ball = balls.view().sphere(hit.element);
                               const Vec3d center = placed.there().point(ball.center);
                               const Vec3d p = position(set, ray, hit), n = normal(set, ray, hit);
                               EXPECT_LT(length(p - ray.at(hit.t)), 1e-12);
                               EXPECT_LT(length(center + n * (4 * ball.radius) - p), 1e-12);
                           }),
              50u);
}

/// Expects the features of the closest points of many questions to give these points. Returns how often each
/// kind of feature was found.
template <class I>
std::map<Feature, int> expect_features(const I& index, double tolerance) {
    using T = typename I::Scalar;
    constexpr int D = I::dimension;
    std::map<Feature, int> kinds;
    for (std::uint64_t i = 0; i < 2000; ++i) {
        Random random(43, i);
        const Vec<T, D> p = point_in(index.bounds(), i % 2 == 0 ? 1.0 : 0.0, random);
        const auto near = closest_point(index, p);
        const auto on = feature(index, p, near);
        ++kinds[on.feature];
        const auto corners = detail::corners_of(index.primitives(), near);
        Vec<double, D> there;
        double sum = 0;
        int without = 0;
        for (std::size_t k = 0; k < corners.size(); ++k) {
            EXPECT_GE(on.weights[k], 0);
            there += corners[k] * static_cast<double>(on.weights[k]);
            sum += static_cast<double>(on.weights[k]);
            without += on.weights[k] == 0;
        }
        EXPECT_NEAR(sum, 1, 4 * static_cast<double>(unit_roundoff<T>));
        EXPECT_LT(error_of(near.point, there), tolerance) << i;
        EXPECT_NEAR(length(Vec<double, D>(on.normal)), 1, 1e-6);
        if (on.feature == Feature::vertex) {
            EXPECT_EQ(without, D - 1);
            EXPECT_EQ(on.weights[static_cast<std::size_t>(on.number)], 1);
        } else if (on.feature == Feature::edge) {
            EXPECT_EQ(without, 1);
            EXPECT_EQ(on.weights[static_cast<std::size_t>((on.number + 2) % 3)], 0);
        } else {
            EXPECT_EQ(without, 0);
            // The way to a face is along its normal.
            const Vec<double, D> way = Vec<double, D>(p) - there;
            const double away = std::abs(dot(way, Vec<double, D>(on.normal)));
            EXPECT_NEAR(away, std::sqrt(static_cast<double>(near.distance2)), tolerance);
        }
    }
    return kinds;
}

TYPED_TEST(Surface, FeaturesOfClosestPoints) {
    using T = TypeParam;
    const double tolerance = 256 * static_cast<double>(unit_roundoff<T>);
    const auto mesh = soup<T>(60);
    auto kinds = expect_features(build(mesh), tolerance);
    for (const Feature kind : {Feature::face, Feature::edge, Feature::vertex}) EXPECT_GT(kinds[kind], 100);
    kinds = expect_features(build<KdTree>(segments2d<T>(40)), tolerance);
    EXPECT_GT(kinds[Feature::face], 100);
    EXPECT_GT(kinds[Feature::vertex], 100);
    EXPECT_EQ(kinds[Feature::edge], 0);
}

/// An AnyIndex, and instances of such, have the surface of an Index.
TYPED_TEST(Surface, OfAnyIndex) {
    using T = TypeParam;
    using Any = AnyIndex<T, 3>;
    const auto transform = Transform<3>::translation({1, 2, 3}) * Transform<3>::rotation({1, 1, 0}, 0.7);
    const auto expect_same = [](const auto& index, const auto& any) {
        EXPECT_GT(for_each_hit(index,
                               [&](const auto& ray, const auto& hit) {
                                   ASSERT_EQ(position(any, ray, hit), position(index, ray, hit));
                                   ASSERT_EQ(normal(any, ray, hit), normal(index, ray, hit));
                               }),
                  50u);
    };
    const auto expect_of = [&](const auto& set) {
        const auto index = build(set);
        const auto any = build_any("grid", set);
        expect_same(index, *any);
        expect_same(build(InstanceSet{Instance(index, transform)}),
                    build(InstanceSet<Any>{{*any, transform}}));
    };
    const auto mesh = teapot<T>(500);
    expect_of(mesh);
    expect_of(spheres<T>(100));
    const auto index = build(mesh);
    const auto any = build_any("kdtree", mesh);
    const auto world = build(InstanceSet{Instance(index, transform)});
    const auto world_of_any = build(InstanceSet<Any>{{*any, transform}});
    const auto same = [](const auto& a, const auto& b) {
        return a.feature == b.feature && a.number == b.number && a.weights == b.weights &&
               a.normal == b.normal;
    };
    for (std::uint64_t i = 0; i < 100; ++i) {
        Random random(3, i);
        const auto p = point_in(index.bounds(), 0.5, random);
        ASSERT_TRUE(
            same(feature(*any, p, closest_point(*any, p)), feature(index, p, closest_point(index, p))));
        const auto near = closest_point(world, p);
        ASSERT_EQ(closest_point(world_of_any, p), near);
        ASSERT_TRUE(same(feature(world_of_any, p, near), feature(world, p, near)));
    }
    const auto cloud = points<T>(10);
    const auto of_points = build_any("wide", cloud);
    const Vec<T, 3> p;
    EXPECT_THROW(feature(*of_points, p, closest_point(*of_points, p)), InputError);
}

TEST(Surface, FeaturesOfInstances) {
    const auto index = build(soup<float>(40));
    const InstanceSet set{Instance(index, Transform<3>::translation({1, 2, 3}) * Transform<3>::scaling(0.5))};
    EXPECT_GT(expect_features(build<Bvh>(set), 1e-4)[Feature::face], 100);
}

/// Triangles that are a segment or a point: the feature is an edge or a vertex, and the normal is 0.
TYPED_TEST(Surface, FeaturesOfTrianglesWithoutArea) {
    using T = TypeParam;
    TriangleMesh<T> mesh;
    mesh.vertices = {{0, 0, 0}, {1, 2, 3}, {2, 4, 6}};
    for (const TriangleIndices& t : {TriangleIndices{0, 1, 2}, {0, 2, 2}, {1, 1, 1}}) {
        mesh.triangles = {t};
        const auto index = build(mesh);
        for (const Vec<T, 3>& p : {Vec<T, 3>(1, 2, 4), {-1, 0, 0}, {1, 2, 3}, {5, 5, 5}}) {
            const auto on = feature(index, p, closest_point(index, p));
            EXPECT_NE(on.feature, Feature::face);
            EXPECT_EQ(on.normal, (Vec<T, 3>()));
            T sum = 0;
            for (const T weight : on.weights) sum += weight;
            EXPECT_NEAR(sum, 1, 1e-6);
        }
    }
    SegmentSet<T> point;
    point.segments = {{{1, 1}, {1, 1}}};
    const auto index = build(point);
    EXPECT_EQ(feature(index, {2, 3}, closest_point(index, {2, 3})).normal, (Vec<T, 2>()));
}

/// A square of two triangles: above its corners, its sides, its diagonal and the rest.
TEST(Surface, FeaturesOfASquare) {
    TriangleMesh<double> mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    const auto index = build(mesh);
    const auto on = [&](const Vec3d& p) { return feature(index, p, closest_point(index, p)); };
    EXPECT_EQ(on({-1, -1, 2}).feature, Feature::vertex);
    EXPECT_EQ(on({-1, -1, 2}).number, 0);
    EXPECT_EQ(on({0.25, -1, 1}).feature, Feature::edge);
    EXPECT_EQ(on({0.25, -1, 1}).weights, (std::array<double, 3>{0.75, 0.25, 0}));
    EXPECT_EQ(on({0.5, 0.5, 1}).feature, Feature::edge);
    EXPECT_EQ(on({0.75, 0.25, 1}).feature, Feature::face);
    EXPECT_EQ(on({0.75, 0.25, 1}).weights, (std::array<double, 3>{0.25, 0.5, 0.25}));
    EXPECT_EQ(on({0.75, 0.25, -1}).normal, (Vec3d{0, 0, 1}));
}

}  // namespace
