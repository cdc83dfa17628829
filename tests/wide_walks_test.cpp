/// The engine's kernels of points over triangles of double, and over primitives that only the walk is theirs
/// of: every instruction set and width gives the bits of brute force.
#include "engine.h"

#include <hedgerow/engine/wide_bvh.h>
#include <hedgerow/primitives/sphere_set.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/structures/brute_force.h>

using namespace hedgerow;
using namespace hedgerow::matrix;

namespace {

/// Points around, near, far and very far from a scene, some of them at given places, or next to one.
template <class T>
std::vector<Vec<T, 3>> points_around(const Box<T, 3>& box, std::span<const Vec<T, 3>> places,
                                     std::size_t count) {
    std::vector<Vec<T, 3>> points;
    for (std::uint64_t i = 0; i < count; ++i) {
        Random random(31, i);
        points.push_back(point_in(box, i % 8 == 0 ? 1000.0 : i % 4 == 0 ? 3.0 : 0.05, random));
        if (places.empty() || i % 2 == 0) continue;
        Vec<T, 3>& p = points.back();
        p = places[random.bits() % places.size()];
        const T size = max_component(box.extent());
        if (i % 8 == 3) p[1] = std::nextafter(p[1], std::numeric_limits<T>::max());
        if (i % 8 == 5) p[2] += size * T(1e-6);
        if (i % 8 == 7) p[0] -= size * T(1e-3);
    }
    return points;
}

/// Compares closest points, one by one and in a batch, and lists with brute force.
template <class Set, class T = typename Set::Scalar>
void expect_brute_force(const Set& set, std::span<const Vec<T, 3>> places, std::size_t count) {
    const auto brute = build<BruteForce>(set);
    const auto points = points_around(brute.bounds(), places, count);
    std::vector<Near<T, 3>> want, batch(count), list, lists;
    for (const auto& p : points) want.push_back(closest_point(brute, p));
    auto distances = std::vector<T>();
    for (const auto& near : want) distances.push_back(near.distance2);
    std::sort(distances.begin(), distances.end());
    const T middle = distances[count / 2];
    for_each_kernel(set, [&](const auto& index, std::string_view) {
        closest_points(index, points, batch, {.threads = serial_executor()});
        ASSERT_EQ(want, batch);
        for (std::size_t i = 0; i < count; ++i) {
            SCOPED_TRACE("point " + std::to_string(i));
            ASSERT_EQ(want[i], closest_point(index, points[i]));
            // A maximum is included.
            const bool within_middle = want[i].distance2 <= middle;
            ASSERT_EQ(within_middle ? want[i] : (Near<T, 3>()),
                      closest_point(index, points[i], {.radius2 = middle}));
            if (i % 7 != 0) continue;
            const std::size_t k = i % 3 == 0 ? 1 : 9;
            nearest(brute, points[i], k, list);
            EXPECT_EQ(nearest(index, points[i], k, lists), list.size());
            ASSERT_EQ(list, lists);
            const double reach = 1.5 * std::sqrt(double(want[i].distance2));
            within(brute, points[i], reach, list);
            EXPECT_EQ(within(index, points[i], reach, lists), list.size());
            ASSERT_EQ(list, lists);
        }
    });
}
template <class T>
void expect_brute_force(const TriangleMesh<T>& mesh, std::size_t count) {
    expect_brute_force(mesh, std::span<const Vec<T, 3>>(mesh.vertices), count);
}
template <class T>
TriangleMesh<T> moved(TriangleMesh<T> mesh, T scale, const Vec<T, 3>& shift) {
    for (auto& v : mesh.vertices) v = v * scale + shift;
    return mesh;
}

TEST(WideWalks, TrianglesOfDoubleAsBruteForce) {
    const std::size_t count = in_long_runs(20000, 500);
    expect_brute_force(soup<double>(500), count);
    expect_brute_force(teapot_in_stadium<double>(2000), count);
    expect_brute_force(hairball<double>(1500), count);
    expect_brute_force(terrain<double>(2000), count);
}

// Kernels answer from about 2^-40 to 2^60, and the walk beyond.
TEST(WideWalks, TrianglesOfDoubleOfEveryScaleAsBruteForce) {
    for (const double scale : {1e-300, 1e-140, 1e-30, 1e-13, 1e-11, 1e-6, 1e9, 1e14, 1e17, 1e19, 1e140}) {
        SCOPED_TRACE(scale);
        expect_brute_force(moved(soup<double>(200), scale, {0, 0, 0}), 300);
    }
    for (const double shift : {1e3, 1e6, 1e12}) {
        SCOPED_TRACE(shift);
        expect_brute_force(moved(teapot_in_stadium<double>(800), 1.0, {shift, -2 * shift, shift}), 300);
    }
}

// Where all vectors of an exact test are tiny, it scales them.
TEST(WideWalks, SliversPointsAndTinyTrianglesOfDoubleAsBruteForce) {
    TriangleMesh<double> mesh = soup<double>(300);
    auto& v = mesh.vertices;
    for (std::uint32_t i = 0; i < 300; ++i) {
        const auto [a, b, c] = mesh.triangles[i];
        if (i % 6 == 0) v[c] = v[a] + (v[b] - v[a]) * 0.3;
        if (i % 6 == 1) v[c] = v[a] + (v[b] - v[a]) * 1.7 + Vec3d(0, 1e-16, 0);
        if (i % 6 == 2) v[c] = v[b];
        if (i % 6 == 3) v[c] = v[b] = v[a];
        if (i % 6 == 4) mesh.triangles.push_back({c, a, b});  // twice, turned
    }
    for (const double size : {1e-70, 1e-120, 1e-200, 1e-310}) {
        const auto first = static_cast<std::uint32_t>(v.size());
        for (const Vec3d& corner : {Vec3d(0, 0, 0), Vec3d(size, 0, 0), Vec3d(0, size, size / 3)})
            v.push_back(corner);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    expect_brute_force(mesh, in_long_runs(20000, 2000));
    std::vector<Vec3d> near_the_tiny;
    for (const double x : {0.0, 1e-71, 1e-70, 3e-70, 1e-121, 1e-201, 5e-311, 1e-60, 1e-10})
        for (const double y : {0.0, 1e-70, -2e-120, 1e-201}) near_the_tiny.push_back({x, y, x / 5});
    expect_brute_force(mesh, std::span<const Vec3d>(near_the_tiny), 400);
}

TEST(WideWalks, NoPointsAndNoTrianglesOfDouble) {
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 infinity = std::numeric_limits<double>::infinity();
    const std::vector<Vec3d> points{{nan, 0, 0}, {0, infinity, 0}, {0, 0, -1e300}, {0, 1e19, 0}, {0, 0, 0}};
    const auto brute = build<BruteForce>(soup<double>(50));
    std::vector<Near<double, 3>> want, batch(points.size());
    for (const auto& p : points) want.push_back(closest_point(brute, p));
    for_each_kernel(soup<double>(50), [&](const auto& index, std::string_view) {
        for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(want[i], closest_point(index, points[i]));
        closest_points(index, points, batch);
        EXPECT_EQ(want, batch);
        EXPECT_FALSE(closest_point(index, points.back(), {.radius = -1}));
        EXPECT_EQ(want.back(),
                  closest_point(index, points.back(), {.radius = infinity, .radius2 = infinity}));
    });
    for_each_kernel(TriangleMesh<double>{}, [&](const auto& index, std::string_view) {
        EXPECT_FALSE(closest_point(index, points.back()));
    });
}

/// Poles of height 1, a set that the library does not know.
template <class T>
struct Poles {
    using Scalar = T;
    static constexpr int dimension = 3;
    std::span<const Vec<T, 3>> feet;

    std::size_t size() const { return feet.size(); }
    Box<T, 3> bounds(std::size_t i) const { return {feet[i], feet[i] + Vec<T, 3>(0, 0, 1)}; }
    Vec<T, 3> closest_point(std::size_t i, const Vec<T, 3>& p) const { return clamped(p, bounds(i)); }
};

template <class T>
void expect_brute_force_of_others() {
    const TriangleMesh<T> mesh = terrain<T>(600);
    const auto& v = mesh.vertices;
    const std::span<const Vec<T, 3>> places(v);
    SphereSet<T, 3> spheres;
    for (std::size_t i = 0; i + 1 < v.size(); ++i)
        spheres.spheres.push_back({v[i], length(v[i + 1] - v[i]) * T(i % 5) / 4});
    expect_brute_force(spheres, places, 600);
    expect_brute_force(Poles<T>{places}, places, 600);
    expect_brute_force(PointCloud<T, 3>{v}, places, 600);
}
TEST(WideWalks, OtherPrimitivesAsBruteForce) {
    expect_brute_force_of_others<float>();
    expect_brute_force_of_others<double>();
}

}  // namespace
