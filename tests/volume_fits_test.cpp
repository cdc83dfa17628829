/// Compares the size of fitted volumes with the least of their kind: a known volume, or the best of a search
/// over many frames that is independent of the fit.
#include <hedgerow/any_index.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/io/mesh_file.h>
#include <hedgerow/scenes/random.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>

using namespace hedgerow;

namespace {

using Points = std::vector<Vec3d>;

/// Orthonormal axes in any direction. The first eight are the coordinate axes turned about z by eighths of a
/// turn.
Rows<3> frame(std::uint64_t i) {
    if (i < 8) {
        const double c = std::cos(static_cast<double>(i) * std::numbers::pi / 4);
        const double s = std::sin(static_cast<double>(i) * std::numbers::pi / 4);
        return {Vec3d(c, s, 0), Vec3d(-s, c, 0), Vec3d(0, 0, 1)};
    }
    Random random(1, i);
    const Vec3d x = random.direction<3>(), y = normalized(cross(x, random.direction<3>()));
    return {x, y, cross(x, y)};
}
/// The point with coordinates p in a frame, rounded to float.
Vec3d placed(const Rows<3>& f, const Vec3d& p) {
    return Vec3d(Vec3f(f[0] * p[0] + f[1] * p[1] + f[2] * p[2]));
}
Points placed(const Rows<3>& f, const Points& points) {
    Points turned;
    for (const auto& p : points) turned.push_back(placed(f, p));
    return turned;
}
Points corners(const Vec3d& extent) {
    Points all;
    for (int i = 0; i < 8; ++i)
        all.push_back({(i & 1) * extent[0], (i >> 1 & 1) * extent[1], (i >> 2) * extent[2]});
    return all;
}

struct Size {
    double volume, half_area;
};
Size size_of(const Vec3d& extent) {
    return {extent[0] * extent[1] * extent[2], Box3d{Vec3d(), extent}.half_area()};
}
template <class T>
Size fitted(const Points& points) {
    const auto b = VolumeFit<Obb<T, 3>>::around(points, 0);
    return size_of(Vec3d(b.high) - Vec3d(b.low));
}

/// The least volume and the least surface of boxes around points, each searched on its own: 1,500 frames,
/// then random steps from the best six, shorter and shorter.
class LeastBox {
public:
    explicit LeastBox(const Points& points) : points_(points) {}
    Size size() const {
        return {least([](const Size& s) { return s.volume; }),
                least([](const Size& s) { return s.half_area; })};
    }

private:
    template <class Measure>
    double least(Measure measure) const {
        // Find the best six of many frames.
        std::vector<std::pair<double, std::uint64_t>> found;
        for (std::uint64_t i = 0; i < 1500; ++i) found.push_back({measure(in(frame(i))), i});
        std::partial_sort(found.begin(), found.begin() + 6, found.end());
        double best = found[0].first;
        for (std::size_t k = 0; k < 6; ++k) {
            // Improve a frame by random steps: longer after a gain, else shorter.
            auto [here, number] = found[k];
            Rows<3> at = frame(number);
            Random random(2, k);
            for (double step = 0.2; step > 1e-4;) {
                Rows<3> next;
                next[0] = normalized(at[0] + random.direction<3>() * step);
                next[1] = normalized(cross(at[2] + random.direction<3>() * step, next[0]));
                next[2] = cross(next[0], next[1]);
                const double there = measure(in(next));
                if (there < here)
                    here = there, at = next, step *= 1.5;
                else
                    step *= 0.94;
            }
            best = std::min(best, here);
        }
        return best;
    }
    Size in(const Rows<3>& axes) const {
        Box3d box;
        for (const auto& p : points_) box.expand({dot(axes[0], p), dot(axes[1], p), dot(axes[2], p)});
        return size_of(box.extent());
    }

    const Points& points_;
};

template <class T>
class OrientedBoxes : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(OrientedBoxes, Scalars);

/// Boxes, rods and plates are themselves the least boxes around their corners.
TYPED_TEST(OrientedBoxes, AreTheBoxesThatWereTurned) {
    for (const Vec3d& extent : {Vec3d(1, 1, 1), Vec3d(4, 1, 1), Vec3d(20, 1, 1), Vec3d(4, 4, 1),
                                Vec3d(20, 20, 1), Vec3d(1, 2, 3), Vec3d(0.5, 1, 8)})
        for (std::uint64_t i = 0; i < 200; ++i) {
            Points points = placed(frame(i), corners(extent));
            EXPECT_LT(fitted<TypeParam>(points).volume, 1.01 * size_of(extent).volume) << "turn " << i;
            Random random(3, i);
            for (int k = 0; k < 100; ++k) {  // points inside the box
                const Vec3d u = random.in_cube<3>();
                points.push_back(placed(frame(i), {u[0] * extent[0], u[1] * extent[1], u[2] * extent[2]}));
            }
            EXPECT_LT(fitted<TypeParam>(points).volume, 1.1 * size_of(extent).volume) << "turn " << i;
        }
}

/// The fit minimises surface, by which rays hit boxes. Around other tetrahedra than the first two the box of
/// least surface may have more than the least volume.
TYPED_TEST(OrientedBoxes, AreTightAroundTetrahedra) {
    const Points regular = {{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}},
                 corner = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double least_around_corner = LeastBox(corner).size().volume;
    for (std::uint64_t i = 0; i < 200; ++i) {
        EXPECT_LT(fitted<TypeParam>(placed(frame(i), regular)).volume, 1.1) << "turn " << i;
        EXPECT_LT(fitted<TypeParam>(placed(frame(i), corner)).volume, 1.1 * least_around_corner)
            << "turn " << i;
    }
    for (std::uint64_t i = 0; i < 100; ++i) {
        Random random(4, i);
        Points any;
        for (int k = 0; k < 4; ++k) any.push_back(Vec3d(Vec3f(random.in_cube<3>())));
        const Size least = LeastBox(any).size(), fit = fitted<TypeParam>(any);
        EXPECT_LT(fit.half_area, 1.15 * least.half_area) << "tetrahedron " << i;
        EXPECT_LT(fit.volume, 1.3 * least.volume) << "tetrahedron " << i;
    }
}

/// The corners of the `size` triangles of a mesh that are nearest to triangle `at`.
Points patch(const TriangleMesh<double>& mesh, std::size_t at, std::size_t size) {
    const auto middle = [&](std::uint32_t i) {
        const auto& t = mesh.triangles[i];
        return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
    };
    std::vector<std::pair<double, std::uint32_t>> order;
    for (std::uint32_t i = 0; i < mesh.size(); ++i)
        order.push_back({length2(middle(i) - middle(static_cast<std::uint32_t>(at))), i});
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(size), order.end());
    Points points;
    for (std::size_t i = 0; i < size; ++i)
        for (const auto v : mesh.triangles[order[i].second]) points.push_back(mesh.vertices[v]);
    return points;
}
TYPED_TEST(OrientedBoxes, AreTightAroundPatchesOfScans) {
    const std::string path = HEDGEROW_DATA "/bunny.ply";
    if (!std::filesystem::exists(path))
        GTEST_SKIP() << "skipped: there is no data/bunny.ply; scripts/fetch-scenes brings it";
    const auto mesh = load_mesh<double>(path);
    for (const std::size_t size : {2u, 4u, 12u, 40u})
        for (std::uint64_t i = 0; i < 25; ++i) {
            const Points points = placed(frame(i), patch(mesh, Random(5, i).bits() % mesh.size(), size));
            const Size least = LeastBox(points).size(), fit = fitted<TypeParam>(points);
            EXPECT_LT(fit.volume, 1.3 * least.volume) << "patch " << i << " of " << size;
            EXPECT_LT(fit.half_area, 1.1 * least.half_area) << "patch " << i << " of " << size;
        }
}

TYPED_TEST(OrientedBoxes, InThePlaneHaveAboutTheLeastPerimeter) {
    for (std::uint64_t i = 0; i < 200; ++i) {
        Random random(6, i);
        const Vec2d x = random.direction<2>(), y(-x[1], x[0]),
                    extent(random.uniform(0.1, 1), random.uniform(0.1, 1));
        // Choose points in a turned rectangle.
        std::vector<Vec2d> points;
        for (std::uint64_t k = 0; k < 3 + i; ++k) {
            const Vec2d u = random.in_cube<2>();
            points.push_back(Vec2d(Vec2f(x * (u[0] * extent[0]) + y * (u[1] * extent[1]))));
        }
        const auto perimeter = [&](const Vec2d& side) {
            Box2d box;
            for (const auto& p : points) box.expand({dot(side, p), dot(Vec2d(-side[1], side[0]), p)});
            return box.half_area();
        };
        // Find the least perimeter over 2,000 directions in a quarter turn.
        double least = perimeter({1, 0});
        for (int k = 1; k < 2000; ++k) {
            const double angle = k * std::numbers::pi / 4000;
            least = std::min(least, perimeter({std::cos(angle), std::sin(angle)}));
        }
        const auto b = VolumeFit<Obb<TypeParam, 2>>::around(points, 0);
        EXPECT_LT((Box2d{Vec2d(b.low), Vec2d(b.high)}.half_area()), 1.05 * least) << i;
    }
}

/// Six hundred cubes, each turned its own way.
TEST(OrientedBoxTrees, TestFewerTrianglesOfTurnedCubesThanBoxesDo) {
    constexpr std::uint32_t faces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                            {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    // Place the cubes, and rays from around them to points among them.
    TriangleMesh<float> mesh;
    for (std::uint64_t i = 0; i < 600; ++i) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        const Vec3d at = Random(7, i).in_cube<3>() * 15.0;
        for (const auto& p : placed(frame(8 + i), corners({1, 1, 1}))) mesh.vertices.push_back(Vec3f(at + p));
        for (const auto& f : faces) mesh.triangles.push_back({first + f[0], first + f[1], first + f[2]});
    }
    std::vector<Ray3f> rays;
    for (std::uint64_t i = 0; i < 2000; ++i) {
        Random random(8, i);
        const Vec3d from = Vec3d::all(7.5) + random.direction<3>() * 40.0;
        rays.push_back({Vec3f(from), Vec3f(random.in_cube<3>() * 15.0 - from)});
    }
    // Count the triangles tested a ray.
    const auto tests = [&](const char* structure) {
        std::vector<Hit<float>> hits(rays.size());
        std::vector<Visits> visits(rays.size());
        closest_hits(*build_any(structure, mesh), std::span<const Ray3f>(rays), hits, {}, KeepAll(), visits);
        double all = 0;
        for (const auto& v : visits) all += static_cast<double>(v.primitives);
        return all / static_cast<double>(rays.size());
    };
    const double boxes = tests("bvh"), oriented = tests("bvh:volume=obb"), hulls = tests("bvh:volume=hull");
    RecordProperty("primitives_a_ray",
                   std::to_string(boxes) + " " + std::to_string(oriented) + " " + std::to_string(hulls));
    EXPECT_LT(oriented, 0.65 * boxes);
    EXPECT_LT(hulls, oriented);
}

}  // namespace
