/// Polygons in files: triangles cover the inside of a polygon once, and keep the face's id.
#include <atomic>
#include <chrono>
#include <cmath>
#include <numbers>
#include <thread>

#include "io_support.h"

namespace hedgerow {
namespace {

using namespace testing_io;
using Polygon = std::vector<Vec3d>;

std::string corner_list(std::size_t count, std::size_t first) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i) text += " " + std::to_string(first + i);
    return text + "\n";
}

std::string vertex_list(const Polygon& polygon, const std::string& word) {
    std::string text;
    char line[128];
    for (const Vec3d& p : polygon) {
        std::snprintf(line, sizeof line, "%s%.17g %.17g %.17g\n", word.c_str(), p[0], p[1], p[2]);
        text += line;
    }
    return text;
}

/// The corners of a separate triangle, then those of the polygon, which is face 1.
Polygon behind_a_triangle(const Polygon& polygon) {
    Polygon all{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    all.insert(all.end(), polygon.begin(), polygon.end());
    return all;
}
std::string face_list(const Polygon& polygon) {
    return "3 0 1 2\n" + std::to_string(polygon.size()) + corner_list(polygon.size(), 3);
}

std::filesystem::path off_of(const TempFolder& folder, const Polygon& polygon) {
    const Polygon all = behind_a_triangle(polygon);
    return folder.file(
        "a.off", "OFF\n" + std::to_string(all.size()) + " 2 0\n" + vertex_list(all, "") + face_list(polygon));
}

/// Writes the polygon to a file of every format that has polygons.
std::vector<std::filesystem::path> files_of(const TempFolder& folder, const Polygon& polygon) {
    const Polygon all = behind_a_triangle(polygon);
    return {off_of(folder, polygon),
            folder.file("a.obj", vertex_list(all, "v ") + "f 1 2 3\nf" + corner_list(polygon.size(), 4)),
            folder.file("a.ply",
                        "ply\nformat ascii 1.0\nelement face 2\nproperty list uint uint vertex_index\n"
                        "element vertex " +
                            std::to_string(all.size()) +
                            "\nproperty double x\nproperty double y\n"
                            "property double z\nend_header\n" +
                            face_list(polygon) + vertex_list(all, ""))};
}

/// Twice the area of the polygon, as a vector along its normal.
Vec3d area_of(const Polygon& polygon) {
    Vec3d sum;
    for (std::size_t i = 2; i < polygon.size(); ++i)
        sum = sum + cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
    return sum;
}

struct Filled {
    double signed_area = 0, area = 0;  // doubled: along the polygon's normal, and absolute
    std::size_t flat = 0;
};

/// Sums up the triangles of face 1. There must be two fewer than the polygon has corners.
Filled filled(const std::filesystem::path& path, const Polygon& polygon) {
    const auto mesh = load_mesh<double>(path);
    EXPECT_EQ(mesh.size(), polygon.size() - 1) << path;
    EXPECT_EQ(mesh.faces.size(), mesh.size());
    const Vec3d normal = normalized(area_of(polygon));
    Filled sum;
    for (std::size_t i = 1; i < mesh.size(); ++i) {
        EXPECT_EQ(mesh.faces[i], 1u);
        const Vec3d n = mesh.view().normal(i);
        sum.signed_area += dot(n, normal);
        sum.area += std::sqrt(length2(n));
        sum.flat += length2(n) == 0;
    }
    return sum;
}

/// Expects that triangles cover the polygon once, and that `flat` of them have no area. Together the
/// triangles wind around each point as often as the polygon does. So their areas sum up to the polygon's only
/// if no triangle is outside of it or on another.
void expect_filled(const Polygon& polygon, std::size_t flat = 0) {
    TempFolder folder;
    const double area = std::sqrt(length2(area_of(polygon)));
    for (const auto& path : files_of(folder, polygon)) {
        const Filled f = filled(path, polygon);
        EXPECT_NEAR(f.signed_area, area, 1e-9 * area) << path;
        EXPECT_NEAR(f.area, area, 1e-9 * area) << path;
        EXPECT_EQ(f.flat, flat) << path;
    }
}

Polygon turned(const Polygon& polygon) {
    Polygon other;
    for (const Vec3d& p : polygon)
        other.push_back({0.6 * p[0] - 0.8 * p[1] + 7, 0.48 * p[0] + 0.36 * p[1] + 0.8 * p[2],
                         -0.64 * p[0] - 0.48 * p[1] + 0.6 * p[2]});
    return other;
}
Polygon reversed(Polygon polygon) {
    std::reverse(polygon.begin(), polygon.end());
    return polygon;
}

TEST(Polygons, AnLHasTheAreaOfAnL) {
    const Polygon l{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
    for (std::size_t first = 0; first < l.size(); ++first) {
        Polygon from = l;
        std::rotate(from.begin(), from.begin() + static_cast<std::ptrdiff_t>(first), from.end());
        expect_filled(from);
        expect_filled(reversed(from));
        expect_filled(turned(from));
    }
}

TEST(Polygons, WhereABoundaryTouchesItself) {
    // A hole joined to the outside by a bridge: two edges in one place.
    expect_filled({{0, 0, 0},
                   {4, 0, 0},
                   {4, 4, 0},
                   {0, 4, 0},
                   {0, 0, 0},
                   {1, 1, 0},
                   {1, 3, 0},
                   {3, 3, 0},
                   {3, 1, 0},
                   {1, 1, 0}});
    // Corners on one line make no flat triangles where others can be made.
    expect_filled({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {0, 2, 0}, {0, 1, 0}});
    // A corner twice, and a spike: triangles without area.
    expect_filled({{0, 0, 0}, {0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}, 1);
    expect_filled({{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, 2);
}

TEST(Polygons, RandomOnesAroundACentre) {
    std::mt19937_64 random(11);
    for (int round = 0; round < 60; ++round) {
        Polygon star;
        const std::size_t n = 4 + random() % 40;
        for (std::size_t i = 0; i < n; ++i) {
            const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
            const double reach = 1 + static_cast<double>(random() % 1000);
            star.push_back({reach * std::cos(angle), reach * std::sin(angle), 0});
        }
        expect_filled(round % 2 == 0 ? star : turned(star));
    }
}

/// Outlines of 100,000 corners that make ear clipping slow: spikes to a centre, a leaning comb, a spiral, and
/// facing arcs.
TEST(Polygons, OfAHundredThousandCorners) {
    constexpr int n = 100000;
    std::mt19937_64 random(12);
    Polygon star, comb, spiral, arcs;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * i / n, reach = 1 + static_cast<double>(random() % 1000);
        star.push_back({reach * std::cos(angle), reach * std::sin(angle), 0});
    }
    for (int i = 0; i < n / 2; ++i)
        comb.insert(comb.end(), {{double(i), double(i), 0}, {i + 0.5, i - 1000.0, 0}});
    comb.insert(comb.end(), {{n / 2.0, n / 2.0 + 10, 0}, {0, 10, 0}});
    // The spiral and the arcs have two sides: one there, the other back.
    for (int i = 0; i < n; ++i) {
        const double angle = 1e-3 * (i < n / 2 ? i : n - 1 - i), reach = (i < n / 2 ? 2 : 1) + angle;
        spiral.push_back({reach * std::cos(angle), reach * std::sin(angle), 0});
        const double x = (i < n / 2 ? i : n - 1 - i) * 4.0 / n - 1;
        arcs.push_back({x, i < n / 2 ? -x * x - 1e-3 : x * x + 1e-3, 0});
    }
    TempFolder folder;
    for (const Polygon& polygon : {star, comb, spiral, arcs}) {
        const double area = std::sqrt(length2(area_of(polygon)));
        const Filled f = filled(off_of(folder, polygon), polygon);
        EXPECT_NEAR(f.area, area, 1e-6 * area);
    }
}

/// A polygon that crosses and touches itself everywhere.
Polygon lattice(int corners) {
    std::mt19937_64 random(13);
    Polygon polygon;
    for (int i = 0; i < corners; ++i) polygon.push_back({double(random() % 50), double(random() % 50), 0});
    return polygon;
}

TEST(Polygons, ThatCrossThemselvesOrHaveNoInsideStillEnd) {
    TempFolder folder;
    const auto count = [&](const Polygon& polygon) {
        for (const auto& path : files_of(folder, polygon))
            EXPECT_EQ(load_mesh(path).size(), polygon.size() - 1);
    };
    count({{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}});  // a figure of eight, with no normal
    count({{0, 0, 0}, {2, 3, 0}, {2, 0, 0}, {0, 2, 0}});
    count(Polygon(100, {1, 2, 3}));
    Polygon line;
    for (int i = 0; i < 2000; ++i) line.push_back({double(i), 2.0 * i, 0});
    count(line);
    count(lattice(20000));
}

TEST(Polygons, AreNotFilledOnceReadingIsCancelled) {
    TempFolder folder;
    const auto path = off_of(folder, lattice(200000));  // takes many seconds to fill
    std::atomic<bool> read = false, cancel = false;
    std::thread user([&] {
        while (!read) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        cancel = true;
    });
    const Progress progress{[&](std::uint64_t done, std::uint64_t total) { read = done == total; }, &cancel};
    EXPECT_THROW(load_mesh(path, {}, progress), Cancelled);
    read = true;
    user.join();
}

/// The last places decide. A corner is moved by one unit in the last place across the diagonals of a square,
/// or by 2^-60 across the line between its neighbours.
TEST(Polygons, SignsAreExact) {
    const double unit = 0x1p-53;
    for (const double shift : {-unit, unit}) {
        const double x = 0.5 + shift * (shift < 0 ? 0.5 : 1);
        expect_filled({{0, 0, 0}, {1, 0, 0}, {x, 0.5, 0}, {1, 1, 0}, {0, 1, 0}});
        const double low = shift < 0 ? -0x1p-60 : 0x1p-60;  // beside the edge from (0, 0) to (1, 0)
        expect_filled({{0, 0, 0}, {0.5, low, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    }
}

}  // namespace
}  // namespace hedgerow
