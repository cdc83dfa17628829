/// The shape of each generated scene: where it is closed or open, its size, and the way it faces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/generate.h>
#include <hedgerow/scenes/random.h>

namespace hedgerow {
namespace {

template <class T>
Triangle<T, 3> triangle(const TriangleMesh<T>& mesh, const TriangleIndices& t) {
    return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

template <class T>
Box<T, 3> bounds(const TriangleMesh<T>& mesh) {
    Box<T, 3> box;
    for (const auto& p : mesh.vertices) box.expand(p);
    return box;
}

double signed_volume(const TriangleMesh<double>& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles) {
        const auto [a, b, c] = triangle(mesh, t);
        sum += dot(a, cross(b, c)) / 6;
    }
    return sum;
}

/// Counts the edges of only one triangle. Fails if neighbours face opposite ways, or if more than two
/// triangles share an edge.
std::size_t open_edges(const TriangleMesh<double>& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const auto& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) ++uses[{t[i], t[(i + 1) % 3]}];
    std::size_t open = 0;
    for (const auto& [edge, count] : uses) {
        EXPECT_EQ(count, 1) << edge.first << " " << edge.second;
        open += !uses.contains({edge.second, edge.first});
    }
    return open;
}

TEST(Teapot, IsATeapot) {
    const auto mesh = teapot<double>(100'000);
    const Box3d box = bounds(mesh);
    EXPECT_NEAR(box.low[0], -3, 1e-12);
    EXPECT_NEAR(box.high[0], 3.4345, 1e-3);
    EXPECT_NEAR(box.low[1], -2, 1e-3);
    EXPECT_NEAR(box.high[1], 2, 1e-3);
    EXPECT_EQ(box.low[1], -box.high[1]);
    EXPECT_EQ(box.low[2], 0);
    EXPECT_EQ(box.high[2], 3.15);
    EXPECT_GT(signed_volume(mesh), 20);
    EXPECT_LT(signed_volume(mesh), 30);
}

TEST(Teapot, IsOpenOnlyAtItsSixRims) {
    // Each patch has 10 × 10 pieces. The rim and the lid's edge have four quarters each, both ends of handle
    // and spout two halves each.
    EXPECT_EQ(open_edges(teapot<double>(6320)), 10u * (2 * 4 + 4 * 2));
}

TEST(Teapot, FacesOutward) {
    const auto mesh = teapot<double>(6320);
    for (const auto& t : mesh.triangles) {
        const auto tri = triangle(mesh, t);
        const Vec3d center = (tri.a + tri.b + tri.c) / 3.0;
        // The belly of the body, where neither spout nor handle is.
        if (std::abs(center[0]) < 1.2 && center[2] > 0.5 && center[2] < 2.2) {
            EXPECT_GT(dot(tri.normal(), Vec3d(center[0], center[1], 0)), 0);
        }
        if (center[2] < 0.05) {
            EXPECT_LT(tri.normal()[2], 0);
        }
    }
}

TEST(Stadium, IsHugeAroundASmallTeapot) {
    const auto mesh = teapot_in_stadium<double>(54'056);
    EXPECT_EQ(mesh.size(), 47'736u + 6'320u);
    const Box3d box = bounds(mesh);
    EXPECT_GT(box.extent()[0], 300 * 6.4345);
    EXPECT_EQ(box.low[2], 0);
    EXPECT_EQ(box.low[0], -box.high[0]);
    EXPECT_EQ(box.low[1], -box.high[1]);
    // Open are the bowl's foot, with 216 segments, and the teapot's rims, with 160.
    EXPECT_EQ(open_edges(mesh), 216u + 160u);
}

TEST(Stadium, HasSeatsThatFaceTheFieldAndTheSky) {
    const auto mesh = teapot_in_stadium<double>(54'056);
    for (std::size_t i = 0; i < 47'736; ++i) {
        const auto tri = triangle(mesh, mesh.triangles[i]);
        const Vec3d n = tri.normal();
        const bool outer_wall = i >= 47'736 - 2 * 216;
        EXPECT_GE(n[2], 0);
        if (n[2] == 0) {
            EXPECT_EQ(dot(n, Vec3d(tri.a[0], tri.a[1], 0)) > 0, outer_wall);
        }
    }
}

TEST(TurnedStadium, IsTheStadiumWithNothingAlongAnAxis) {
    const auto straight = teapot_in_stadium<double>(5000), turned = turned_stadium<double>(5000);
    ASSERT_EQ(turned.triangles, straight.triangles);
    for (std::size_t i = 1; i < turned.vertices.size(); ++i)  // a rotation keeps lengths
        ASSERT_NEAR(length(turned.vertices[i] - turned.vertices[i - 1]),
                    length(straight.vertices[i] - straight.vertices[i - 1]), 1e-9);
    for (std::size_t i = 0; i < 4000; ++i) {
        const Vec3d n = abs(normalized(triangle(turned, turned.triangles[i]).normal()));
        ASSERT_LT(max_component(n), 0.99999) << i;
    }
    EXPECT_GT(bounds(turned).extent()[2], 2 * bounds(straight).extent()[2]);
}

TEST(Grass, IsThinBladesThatStandOnTheGround) {
    const auto mesh = grass<double>(100'000, 3);
    const auto ground = terrain<double>(100'000 / 8, 3);
    ASSERT_EQ((mesh.size() - ground.size()) % 3, 0u);
    EXPECT_TRUE(std::equal(ground.triangles.begin(), ground.triangles.end(), mesh.triangles.begin()));
    double thinnest = 1, lowest = 1, highest = 0;
    for (std::size_t i = ground.size(); i < mesh.size(); i += 3) {
        const Vec3d left = mesh.vertices[mesh.triangles[i][0]], right = mesh.vertices[mesh.triangles[i][1]],
                    tip = mesh.vertices[mesh.triangles[i + 2][2]];
        const double height = tip[2] - left[2];
        thinnest = std::min(thinnest, length(right - left) / height);
        lowest = std::min(lowest, height), highest = std::max(highest, height);
        ASSERT_TRUE(left[2] > 0 && left[2] < 0.25);
    }
    EXPECT_LT(thinnest, 0.1);
    EXPECT_NEAR(lowest, 0.02, 1e-4);
    EXPECT_NEAR(highest, 0.05, 1e-4);
}

TEST(Hairball, IsLongStrandsBetweenTwoRadii) {
    const auto mesh = hairball<double>(32'000);
    EXPECT_EQ(mesh.size(), 32'000u);
    EXPECT_EQ(open_edges(mesh), 1000u * (2 * 16 + 2));
    // Strands are between the radii 0.5 and 1, on all sides.
    Vec3d sum;
    for (const Vec3d& p : mesh.vertices) {
        ASSERT_TRUE(length(p) > 0.49 && length(p) < 1.01);
        sum = sum + p / static_cast<double>(mesh.vertices.size());
    }
    EXPECT_LT(length(sum), 0.05) << "all around";
    // Strands are much longer than wide. Each has 34 vertices in pairs.
    double longest = 0;
    for (std::size_t strand = 0; strand < 1000; ++strand) {
        double along = 0, across = 0;
        for (std::size_t i = strand * 34 + 2; i < strand * 34 + 34; i += 2) {
            along += length(mesh.vertices[i] - mesh.vertices[i - 2]);
            across = std::max(across, length(mesh.vertices[i] - mesh.vertices[i + 1]));
        }
        ASSERT_GT(along, 50 * across);
        longest = std::max(longest, along);
    }
    EXPECT_GT(longest, 1.8);
}

TEST(Cube, IsClosed) {
    for (const unsigned size : {12u, 100u, 1000u}) {
        const auto mesh = cube<double>(size);
        EXPECT_EQ(open_edges(mesh), 0u) << size;
        EXPECT_NEAR(signed_volume(mesh), 8, 1e-12);
        EXPECT_EQ(bounds(mesh), (Box3d{{-1, -1, -1}, {1, 1, 1}}));
        EXPECT_EQ(mesh.vertices.size(), mesh.size() / 2 + 2);  // Euler's formula: V = F / 2 + 2 if closed
    }
    EXPECT_EQ(cube<double>(12).size(), 12u);
}

TEST(Boulder, IsClosedAndItsTrianglesAreAlike) {
    for (const unsigned size : {100u, 1000u, 30'000u}) {
        const auto mesh = boulder<double>(size, 2);
        EXPECT_EQ(open_edges(mesh), 0u) << size;
        EXPECT_EQ(mesh.vertices.size(), mesh.size() / 2 + 2);  // Euler's formula: V = F / 2 + 2 if closed
        EXPECT_GT(signed_volume(mesh), 2) << "faces outward";
        // No edge is much longer than the others.
        double sum = 0, longest = 0;
        for (const auto& t : mesh.triangles) {
            const auto [a, b, c] = triangle(mesh, t);
            for (const double edge : {length(b - a), length(c - b), length(a - c)})
                sum += edge, longest = std::max(longest, edge);
        }
        EXPECT_LT(longest, 6 * sum / static_cast<double>(3 * mesh.size())) << size;
    }
    const Vec3d extent = bounds(boulder<double>(10'000)).extent();
    EXPECT_GT(extent[2], extent[0]) << "higher than wide";
}

TEST(CornellBox, IsOpenOnlyToTheFrontAndTheFloor) {
    const auto mesh = cornell_box<double>(32);
    EXPECT_EQ(mesh.size(), 32u);
    // Open are the room's front, the light's edge, and the feet of two blocks.
    EXPECT_EQ(open_edges(mesh), 4u * 4);
    EXPECT_EQ(bounds(mesh), (Box3d{{0, 0, 0}, {556, 548.8, 559.2}}));
    EXPECT_EQ(open_edges(cornell_box<double>(32 * 25)), 5u * 4 * 4);
}

TEST(CornellBox, FacesTheEye) {
    const auto mesh = cornell_box<double>(32);
    const Vec3d middle(278, 274, 280);
    for (std::size_t i = 0; i < 12; ++i) {
        const auto tri = triangle(mesh, mesh.triangles[i]);
        EXPECT_GT(dot(tri.normal(), middle - tri.a), 0) << i;
    }
    for (const std::size_t first : {std::size_t{12}, std::size_t{22}}) {
        Vec3d center;
        for (std::size_t i = first; i < first + 10; ++i)
            center = center + triangle(mesh, mesh.triangles[i]).a / 10.0;
        for (std::size_t i = first; i < first + 10; ++i) {
            const auto tri = triangle(mesh, mesh.triangles[i]);
            EXPECT_LT(dot(tri.normal(), center - tri.a), 0) << i;
        }
    }
}

TEST(Terrain, IsOneSheetThatLooksUp) {
    const auto mesh = terrain<double>(2000);
    EXPECT_EQ(open_edges(mesh), 4u * 32 - 2);  // 31 × 32 pieces
    for (const auto& t : mesh.triangles) EXPECT_GT(triangle(mesh, t).normal()[2], 0);
    EXPECT_GT(bounds(mesh).extent()[2], 0.05);
    EXPECT_LT(bounds(mesh).high[2], 0.25);
}

TEST(Interior, HoldsThingsFromTwelveMetresToAMillimetre) {
    const auto mesh = interior<double>(300'000);
    const Box3d box = bounds(mesh);
    EXPECT_LT(length(box.low - Vec3d(-0.36, -0.36, -0.312)), 1e-12);
    EXPECT_LT(length(box.high - Vec3d(12.76, 8.96, 3.1)), 1e-12);
    double longest = 0, shortest = 1;
    std::size_t slivers = 0, along_axes = 0;
    for (const TriangleIndices& t : mesh.triangles) {
        const auto tri = triangle(mesh, t);
        const double edges[] = {length(tri.b - tri.a), length(tri.c - tri.b), length(tri.a - tri.c)};
        const auto [least, most] = std::minmax_element(edges, edges + 3);
        longest = std::max(longest, *most), shortest = std::min(shortest, *least);
        slivers += length(tri.normal()) < 0.01 * *most * *most;  // a hundred times as long as high
        along_axes += max_component(abs(normalized(tri.normal()))) > 1 - 1e-9;
    }
    EXPECT_GT(longest, 12);
    EXPECT_LT(shortest, 0.0011);
    EXPECT_GT(slivers, mesh.size() / 50) << "mouldings, planks, bars";
    EXPECT_GT(along_axes, mesh.size() / 4);
    EXPECT_LT(along_axes, 3 * mesh.size() / 4);
}

TEST(Interior, IsClosedButForItsWindows) {
    for (const unsigned size : {2000u, 100'000u}) {
        const auto mesh = interior<float>(size);
        const auto index = build(mesh);
        const Vec3f eyes[] = {{2.5f, 2.3f, 1.7f}, {6.6f, 6.7f, 1.7f}, {10, 2, 1.7f}, {9.2f, 5.6f, 1.7f}};
        for (const Vec3f& eye : eyes) {
            int missed = 0;
            for (std::uint64_t i = 0; i < 1000; ++i)
                missed += !closest_hit(index, Ray3f{eye, Vec3f(Random(1, i).direction<3>())});
            EXPECT_LT(missed, 120) << size << " " << eye[0];
        }
        EXPECT_FALSE(any_hit(index, Ray3f{{3.4f, 1, 1.41f}, {0, -1, 0}}))
            << "out of a window, between its bars";
        EXPECT_TRUE(any_hit(index, Ray3f{{3.2f, 1, 0.5f}, {0, -1, 0}})) << "the wall below it";
    }
}

TEST(Interior, GainsThingsAndThenRoundness) {
    // The first things are the slabs and the walls, for every size.
    const auto few = interior<double>(500), more = interior<double>(5000);
    EXPECT_TRUE(std::equal(few.triangles.begin(), few.triangles.begin() + 300, more.triangles.begin()));
    EXPECT_TRUE(std::equal(few.vertices.begin(), few.vertices.begin() + 150, more.vertices.begin()));
    // A larger size divides round things more finely, so the area grows only a little.
    const auto area = [](const TriangleMesh<double>& mesh) {
        double sum = 0;
        for (const auto& t : mesh.triangles) sum += length(triangle(mesh, t).normal()) / 2;
        return sum;
    };
    const double coarse = area(interior<double>(252'740)), fine = area(interior<double>(967'616));
    EXPECT_GT(fine, coarse);
    EXPECT_LT(fine, 1.05 * coarse);
}

}  // namespace
}  // namespace hedgerow
