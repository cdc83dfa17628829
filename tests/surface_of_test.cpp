/// Surfaces around points: closed manifolds for all arrangements, where the field has the level, with the
/// volume and the shape of what the points fill, and the same for any threads.
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include <hedgerow/base/error.h>
#include <hedgerow/fluid/surface_of.h>
#include <hedgerow/parallel/watched_executor.h>
#include <hedgerow/scenes/random.h>

#include "arrangements.h"

namespace hedgerow {
namespace {

using Points = std::vector<Vec3d>;

/// What keeps a mesh from being a closed and oriented manifold, or an empty text.
std::string fault_of(std::size_t vertices, const std::vector<TriangleIndices>& triangles) {
    // Each corner with the next and the last one of its triangle, by vertices.
    std::vector<std::array<std::uint32_t, 3>> corners;
    for (const auto& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            if (t[k] >= vertices || t[k] == t[(k + 1) % 3]) return "a triangle has a bad corner";
            corners.push_back({t[k], t[(k + 1) % 3], t[(k + 2) % 3]});
        }
    std::sort(corners.begin(), corners.end());
    auto begin = corners.begin();
    for (std::uint32_t v = 0; v < vertices; ++v) {
        const auto end = std::find_if(begin, corners.end(), [&](const auto& c) { return c[0] != v; });
        if (begin == end) return "a vertex has no triangle";
        for (auto c = begin; c + 1 != end; ++c)
            if (c[0][1] == c[1][1]) return "two triangles run along an edge one way";
        // Go around the vertex.
        std::ptrdiff_t steps = 0;
        auto at = begin;
        do {
            const std::uint32_t last = (*at)[2];
            at = std::find_if(begin, end, [&](const auto& c) { return c[1] == last; });
            if (at == end) return "an edge is open";
            ++steps;
        } while (at != begin && steps <= end - begin);
        if (steps != end - begin) return "the triangles around a vertex are not one ring";
        begin = end;
    }
    return "";
}
template <class T>
std::string fault_of(const PointSurface<T>& surface) {
    if (surface.normals.size() != surface.mesh.vertices.size()) return "a vertex has no normal";
    for (const Vec3f& n : surface.normals)
        if (!(std::abs(length(Vec3d(n)) - 1) < 1e-6)) return "a normal is not of length 1";
    for (const auto& v : surface.mesh.vertices)
        if (!finite(v)) return "a vertex is not finite";
    return fault_of(surface.mesh.vertices.size(), surface.mesh.triangles);
}

template <class T>
double volume_of(const TriangleMesh<T>& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        sum += dot(Vec3d(mesh.vertices[a]), cross(Vec3d(mesh.vertices[b]), Vec3d(mesh.vertices[c]))) / 6;
    return sum;
}
/// Vertices − edges + triangles of a closed mesh.
template <class T>
std::int64_t euler_characteristic(const TriangleMesh<T>& mesh) {
    return static_cast<std::int64_t>(mesh.vertices.size()) - static_cast<std::int64_t>(mesh.size() / 2);
}
/// The connected part that each vertex belongs to, by the number of one of its vertices.
std::vector<std::uint32_t> parts_of(const TriangleMesh<double>& mesh) {
    std::vector<std::uint32_t> part(mesh.vertices.size());
    for (std::uint32_t v = 0; v < part.size(); ++v) part[v] = v;
    for (bool changed = true; changed;) {
        changed = false;
        for (const auto& [a, b, c] : mesh.triangles) {
            const std::uint32_t least = std::min({part[a], part[b], part[c]});
            for (const std::uint32_t v : {a, b, c}) changed |= part[v] != least, part[v] = least;
        }
    }
    return part;
}

/// The points of a lattice for which `inside` holds, within a cube of half the side `extent`.
template <class F>
Points lattice_points(int extent, double spacing, const Vec3d& offset, F inside) {
    Points points;
    for (int z = -extent; z <= extent; ++z)
        for (int y = -extent; y <= extent; ++y)
            for (int x = -extent; x <= extent; ++x) {
                const Vec3d p = Vec3d(x + offset[0], y + offset[1], z + offset[2]) * spacing;
                if (inside(p)) points.push_back(p);
            }
    return points;
}
Points ball_points(int count, double spacing, const Vec3d& offset = {0.3, 0.2, 0.4}) {
    const double radius = std::cbrt(count * 3 / (4 * std::numbers::pi)) * spacing;
    return lattice_points(static_cast<int>(radius / spacing) + 2, spacing, offset,
                          [&](const Vec3d& p) { return length(p) <= radius; });
}
Points random_points(std::size_t count, double side, std::uint64_t seed) {
    Points points;
    for (std::uint64_t i = 0; i < count; ++i) points.push_back(Random(seed, i).in_cube<3>() * side);
    return points;
}

/// Expects a closed manifold for several options, as it is found and smoothed, of double and float.
void expect_manifold(const std::string& what, const Points& points, double spacing) {
    SCOPED_TRACE(what);
    std::vector<Vec3f> floats;
    for (const Vec3d& p : points) floats.push_back(Vec3f(p));
    for (const double cell : {0.5, 0.6, 1.0})
        for (const int smoothing : {0, 6})
            for (const bool drops : {false, true}) {
                const PointSurfaceOptions options{
                    .spacing = spacing, .cell = cell * spacing, .drops = drops, .smoothing = smoothing};
                const auto surface = surface_of(points, options);
                EXPECT_EQ(fault_of(surface), "") << cell << ' ' << smoothing << ' ' << drops;
                EXPECT_EQ(fault_of(surface_of(floats, options)), "") << "of floats";
                if (drops && cell < 1) {
                    EXPECT_GT(surface.mesh.size(), 0u);
                }
            }
}

/// The rule by which all other tests call a mesh a manifold finds each fault.
TEST(SurfaceOf, FaultsOfMeshesAreFound) {
    const std::vector<TriangleIndices> tetrahedron = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
    EXPECT_EQ(fault_of(4, tetrahedron), "");
    auto bad = tetrahedron;
    bad.pop_back();
    EXPECT_EQ(fault_of(4, bad), "an edge is open");
    bad = tetrahedron, std::swap(bad[0][1], bad[0][2]);
    EXPECT_EQ(fault_of(4, bad), "two triangles run along an edge one way");
    bad = tetrahedron;
    for (const auto& t : tetrahedron)
        bad.push_back({t[0] == 0 ? 0 : t[0] + 3, t[1] == 0 ? 0 : t[1] + 3, t[2] == 0 ? 0 : t[2] + 3});
    EXPECT_EQ(fault_of(7, bad), "the triangles around a vertex are not one ring");
    EXPECT_EQ(fault_of(5, tetrahedron), "a vertex has no triangle");
}

TEST(SurfaceOf, FewPointsAreClosedManifolds) {
    for (std::uint64_t i = 0; i < 12; ++i) {
        Random random(1, i);
        const Vec3d p = random.in_cube<3>() * 20.0, direction = random.direction<3>();
        expect_manifold("one", {p}, 1);
        // From coincident to apart; where the distance is near 2 the two drops part.
        for (const double distance : {0.0, 1e-9, 0.7, 1.3, 1.6, 1.8, 1.9, 2.0, 2.1, 2.5, 3.0, 4.0, 4.1})
            expect_manifold("two", {p, p + direction * distance}, 1);
    }
    // On vertices, edges and faces of the lattice, on both sides of its origin.
    for (const double x : {0.0, 0.25, 0.5, -3.5, -0.25, 3.5})
        for (const double y : {0.0, 0.25, -3.5})
            expect_manifold("on the lattice", {{x, y, 3.5}, {x, y, 4}}, 1);
}

TEST(SurfaceOf, ManyPointsAreClosedManifolds) {
    for (const std::uint64_t seed : {1u, 2u})
        for (const double side : {3.0, 8.0, 14.0, 40.0})
            expect_manifold("cloud", random_points(400, side, seed), 1);
    Points line, plane, thick;
    for (int i = 0; i < 60; ++i) line.push_back(Vec3d(i, 0.5 * i, 0.3 * i) * 0.8);
    for (int x = 0; x < 20; ++x)
        for (int y = 0; y < 20; ++y) {
            plane.push_back(Vec3d(x, y, 0));
            for (int z = 0; z < 3; ++z) thick.push_back(Vec3d(x, y, 0.5 * z));
        }
    expect_manifold("line", line, 1);
    expect_manifold("plane", plane, 1);
    expect_manifold("layers", thick, 1);
    expect_manifold("coincident", Points(500, Vec3d(0.1, 7, -3)), 1);
    expect_manifold("ball on the lattice", ball_points(2000, 1, {0, 0, 0}), 1);
    expect_manifold("ball between the lattice", ball_points(2000, 1, {0.25, 0.25, 0.25}), 1);
    for (const double scale : {1e-6, 1e6}) expect_manifold("scaled", ball_points(1000, scale), scale);
}

TEST(SurfaceOf, HuntersArrangementsAreClosedManifolds) {
    for (const auto& one : open_arrangements()) {
        const Points points = one.make(300, 5).places;
        Vec3d low = points[0], high = low;
        for (const Vec3d& p : points) low = min(low, p), high = max(high, p);
        SCOPED_TRACE(one.name);
        for (const double share : {8.0, 40.0, 1000.0}) {
            const double spacing = std::max(max_component(high - low) / share, 1e-3);
            EXPECT_EQ(fault_of(surface_of(points, {.spacing = spacing})), "") << share;
        }
    }
}

/// With a low level the surface goes as far as points reach, to the border of what is sampled.
TEST(SurfaceOf, LowLevelsReachTheBorder) {
    for (std::uint64_t i = 0; i < 300; ++i) {
        const Points one = {Random(11, i).in_cube<3>() * 20.0 - Vec3d(10, 10, 10)};
        const auto surface =
            surface_of(one, {.spacing = 1, .radius = 2, .level = 1e-9, .drops = false, .smoothing = 0});
        EXPECT_EQ(fault_of(surface), "") << i;
        double farthest = 0;
        for (const Vec3d& v : surface.mesh.vertices) farthest = std::max(farthest, length(v - one[0]));
        EXPECT_GT(farthest, 1.8) << i;
        EXPECT_LT(farthest, 2 + 0.5 * std::numbers::sqrt3) << i;
    }
}

/// Values that are equal to the level, or next to it, at thousands of lattice vertices.
TEST(SurfaceOf, ValuesNextToTheLevelMakeManifolds) {
    // In the middle of a cube of points the field has this value, but for roundings.
    const double norm = 315 / (64 * std::numbers::pi * 8),
                 middle = norm * (8 * std::pow(13.0 / 16, 3) + 24 * std::pow(5.0 / 16, 3));
    for (const double jitter : {0.0, 1e-7}) {
        Points points = ball_points(3000, 1, {0, 0, 0});
        for (std::size_t i = 0; i < points.size(); ++i) points[i] += Random(10, i).in_cube<3>() * jitter;
        std::set<std::size_t> sizes;
        for (int ulps = -12; ulps <= 12; ++ulps) {
            const PointSurfaceOptions options{.spacing = 1,
                                              .radius = 2,
                                              .level = middle * (1 + ulps * 0x1p-24),
                                              .drops = false,
                                              .smoothing = ulps % 2 == 0 ? 6 : 0};
            const auto surface = surface_of(points, options);
            EXPECT_EQ(fault_of(surface), "") << ulps;
            sizes.insert(surface.mesh.size());
        }
        EXPECT_GE(sizes.size(), jitter > 0 ? 4u : 2u) << "no value was next to the level";
    }
    // A drop whose peak is as high as the level.
    for (const double level : {0.5, 0.67, 0.3})
        EXPECT_EQ(fault_of(surface_of(Points{{1, 2, 3}, {9, 9.1, 9}},
                                      {.spacing = 1, .level = level, .drops = true})),
                  "");
}

/// The field by its definition.
double field_at(const Points& points, double radius, const Vec3d& place) {
    double sum = 0;
    for (const Vec3d& p : points) {
        const double rest = 1 - length2(p - place) / (radius * radius);
        if (rest > 0) sum += rest * rest * rest;
    }
    return sum * 315 / (64 * std::numbers::pi * std::pow(radius, 3));
}
/// How often the mesh winds around a place: the sum of solid angles (Van Oosterom and Strackee 1983).
double winding_around(const TriangleMesh<double>& mesh, const Vec3d& place) {
    double sum = 0;
    for (const auto& t : mesh.triangles) {
        const Vec3d a = mesh.vertices[t[0]] - place, b = mesh.vertices[t[1]] - place,
                    c = mesh.vertices[t[2]] - place;
        const double la = length(a), lb = length(b), lc = length(c);
        sum += 2 * std::atan2(dot(a, cross(b, c)),
                              la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    }
    return sum / (4 * std::numbers::pi);
}

TEST(SurfaceOf, LiesWhereTheFieldHasTheLevel) {
    for (const double radius : {1.5, 2.0, 5.0}) {
        const Points points = random_points(150, 5.5, 4);
        const double level = 0.5, cell = radius / 12;
        const auto surface = surface_of(
            points,
            {.spacing = 1, .radius = radius, .cell = cell, .level = level, .drops = false, .smoothing = 0});
        ASSERT_EQ(fault_of(surface), "");
        ASSERT_GT(surface.mesh.size(), 1000u);
        std::size_t uphill = 0;
        for (std::size_t v = 0; v < surface.mesh.vertices.size(); ++v) {
            const Vec3d p = surface.mesh.vertices[v], n = Vec3d(surface.normals[v]);
            EXPECT_NEAR(field_at(points, radius, p), level, 0.05);
            uphill += field_at(points, radius, p + n * cell) >= field_at(points, radius, p - n * cell);
        }
        // Normals lead to where the field is less, but for some at saddles.
        EXPECT_LE(1000 * uphill, surface.mesh.vertices.size());
        int inside = 0, outside = 0;
        for (std::uint64_t i = 0; i < 400; ++i) {
            const Vec3d p = Random(5, i).in_cube<3>() * 6.5 - Vec3d(0.5, 0.5, 0.5);
            const double value = field_at(points, radius, p);
            if (std::abs(value - level) < 0.05) continue;
            EXPECT_NEAR(winding_around(surface.mesh, p), value > level ? 1 : 0, 1e-6);
            ++(value > level ? inside : outside);
        }
        EXPECT_GT(inside, 30);
        EXPECT_GT(outside, 30);
    }
}

/// Means over the triangles of a ball: the angle of a triangle to the ball, and the ratio of its shortest
/// side to its longest.
std::array<double, 2> shape_of(const TriangleMesh<double>& mesh) {
    double angles = 0, ratios = 0;
    for (const auto& t : mesh.triangles) {
        const Vec3d a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
        angles += std::acos(std::min(1.0, dot(normalized(cross(b - a, c - a)), normalized(a + b + c))));
        const double ab = length(a - b), bc = length(b - c), ca = length(c - a);
        ratios += std::min({ab, bc, ca}) / std::max({ab, bc, ca});
    }
    const auto n = static_cast<double>(mesh.size());
    return {angles / n, ratios / n};
}

TEST(SurfaceOf, ABallHasItsVolumeAndShape) {
    for (const double spacing : {1.0, 0.01}) {
        const Points points = ball_points(20000, spacing);
        const double radius = std::cbrt(20000 * 3 / (4 * std::numbers::pi)) * spacing,
                     volume = 20000 * spacing * spacing * spacing;
        std::vector<std::array<double, 2>> shapes;
        for (const int smoothing : {0, 6, 40}) {
            const auto surface = surface_of(points, {.spacing = spacing, .smoothing = smoothing});
            ASSERT_EQ(fault_of(surface), "");
            EXPECT_NEAR(volume_of(surface.mesh) / volume, 1, 0.02) << smoothing;
            EXPECT_EQ(euler_characteristic(surface.mesh), 2) << smoothing;
            for (std::size_t v = 0; v < surface.normals.size(); ++v) {
                const Vec3d p = surface.mesh.vertices[v];
                EXPECT_NEAR(length(p), radius, 0.5 * spacing);
                EXPECT_GT(dot(Vec3d(surface.normals[v]), p) / length(p), smoothing == 0 ? 0.5 : 0.85);
            }
            shapes.push_back(shape_of(surface.mesh));
        }
        EXPECT_LT(shapes[1][0], 0.75 * shapes[0][0]);
        EXPECT_GT(shapes[1][1], 1.25 * shapes[0][1]);
        // Shapes that are longer than the noise stay.
        EXPECT_NEAR(shapes[2][0], shapes[1][0], 0.05 * shapes[1][0]);
    }
}

TEST(SurfaceOf, ATorusHasAHole) {
    const Points points = lattice_points(14, 1, {0.1, 0.2, 0.3}, [](const Vec3d& p) {
        return std::hypot(std::hypot(p[0], p[1]) - 9, p[2]) <= 3.5;
    });
    for (const int smoothing : {0, 6}) {
        const auto surface = surface_of(points, {.spacing = 1, .smoothing = smoothing});
        EXPECT_EQ(fault_of(surface), "");
        EXPECT_EQ(euler_characteristic(surface.mesh), 0);
        EXPECT_NEAR(volume_of(surface.mesh) / static_cast<double>(points.size()), 1, 0.05);
    }
}

/// Smoothing keeps the volume of each part: a ball, hollows in it, and drops of one and of few points.
TEST(SurfaceOf, SmoothingKeepsTheVolumeOfEachPart) {
    Points points = lattice_points(9, 1, {0.1, 0.2, 0.3}, [](const Vec3d& p) {
        return length(p) <= 8 && length(p - Vec3d(2, 2, 2)) > 2.2;
    });
    for (int i = 0; i < 20; ++i) points.push_back(Vec3d(20 + 4 * i, 0.21 * i, 0.13 * i));
    for (int i = 0; i < 4; ++i) points.push_back(Vec3d(0.9 * i, 20, 0));
    const auto volumes = [](const TriangleMesh<double>& mesh) {
        const auto part = parts_of(mesh);
        std::map<std::uint32_t, double> all;
        for (const auto& [a, b, c] : mesh.triangles) {
            const Vec3d from = mesh.vertices[part[a]];
            all[part[a]] +=
                dot(mesh.vertices[a] - from, cross(mesh.vertices[b] - from, mesh.vertices[c] - from)) / 6;
        }
        return all;
    };
    const auto found = surface_of(points, {.spacing = 1, .smoothing = 0});
    const auto wanted = volumes(found.mesh);
    ASSERT_EQ(wanted.size(), 23u);
    int hollows = 0;
    for (const auto& [part, volume] : wanted) hollows += volume < 0;
    EXPECT_EQ(hollows, 1);
    for (const int smoothing : {1, 6, 100}) {
        const auto surface = surface_of(points, {.spacing = 1, .smoothing = smoothing});
        EXPECT_NE(surface.mesh.vertices, found.mesh.vertices);
        EXPECT_EQ(surface.mesh.triangles, found.mesh.triangles);
        for (const auto& [part, volume] : volumes(surface.mesh))
            EXPECT_NEAR(volume / wanted.at(part), 1, 0.01) << smoothing << ", part " << part;
    }
}

/// Single points, jets and sheets are seen, about as large as they should be; without `drops` they are not.
TEST(SurfaceOf, DropsAreSeen) {
    for (std::uint64_t i = 0; i < 40; ++i) {
        const Points one = {Random(2, i).in_cube<3>() * 5.0};
        EXPECT_NEAR(volume_of(surface_of(one, {.spacing = 1}).mesh), 1, 0.35);
        EXPECT_TRUE(surface_of(one, {.spacing = 1, .drops = false}).mesh.triangles.empty());
    }
    Points jet;
    for (int i = 0; i < 100; ++i) jet.push_back(Vec3d(i * 0.6, i * 0.64, i * 0.48));
    const auto surface = surface_of(jet, {.spacing = 1});
    EXPECT_EQ(euler_characteristic(surface.mesh), 2) << "the jet is in pieces";
    EXPECT_NEAR(volume_of(surface.mesh) / 100, 1, 0.35);
}

/// Far-off points cost no memory for the space between, and leave the rest of the surface as it is.
TEST(SurfaceOf, FarPointsChangeNothing) {
    Points points = random_points(2000, 14, 6);
    const auto near = surface_of(points, {.spacing = 1});
    for (const double far : {1e3, 1e6, 1e11}) {
        points.push_back(Vec3d::all(far));
        const auto all = surface_of(points, {.spacing = 1});
        points.pop_back();
        EXPECT_EQ(fault_of(all), "") << far;
        ASSERT_GT(all.mesh.vertices.size(), near.mesh.vertices.size()) << far;
        ASSERT_GT(all.mesh.size(), near.mesh.size()) << far;
        EXPECT_TRUE(
            std::equal(near.mesh.vertices.begin(), near.mesh.vertices.end(), all.mesh.vertices.begin()));
        EXPECT_TRUE(
            std::equal(near.mesh.triangles.begin(), near.mesh.triangles.end(), all.mesh.triangles.begin()));
        EXPECT_LT(length(all.mesh.vertices.back() - Vec3d::all(far)), 2) << far;
    }
    std::vector<Vec3f> floats = {{0, 0, 0}, {1e6f, 1e6f, -1e6f}};
    EXPECT_EQ(fault_of(surface_of(floats, {.spacing = 1})), "");
}

TEST(SurfaceOf, TheSameForAnyThreadsAndMode) {
    Points points = ball_points(9000, 1);
    for (const Vec3d& p : random_points(1000, 40, 7)) points.push_back(p);
    const auto want = surface_of(points, {.spacing = 1}, serial_executor());
    EXPECT_GT(want.mesh.size(), 50000u);
    for (const unsigned threads : {1u, 2u, 0u}) {
        const ThreadLimit limit(threads);
        const auto surface = surface_of(points, {.spacing = 1}, default_executor());
        EXPECT_EQ(surface.mesh.vertices, want.mesh.vertices) << threads;
        EXPECT_EQ(surface.mesh.triangles, want.mesh.triangles) << threads;
        EXPECT_EQ(surface.normals, want.normals) << threads;
    }
    // Points with a stride.
    struct Particle {
        Vec3d place;
        float other;
    };
    std::vector<Particle> particles;
    for (const Vec3d& p : points) particles.push_back({p, 7});
    const Strided<Vec3d> places(&particles[0].place, particles.size(), sizeof(Particle));
    EXPECT_EQ(surface_of(places, {.spacing = 1}).mesh.vertices, want.mesh.vertices);
}

TEST(SurfaceOf, ReportsProgressAndStops) {
    const Points points = ball_points(6000, 1);
    std::atomic<bool> stop = false;
    std::atomic<std::uint64_t> last = 0, of = 0;
    const auto show = [&](std::uint64_t done, std::uint64_t total) { last = done, of = total; };
    WatchedExecutor watched(serial_executor(), {show, &stop});
    const auto surface = surface_of(points, {.spacing = 1}, watched);
    EXPECT_GT(surface.mesh.size(), 0u);
    EXPECT_EQ(of, 2 * points.size());
    EXPECT_EQ(last, 2 * points.size());
    stop = true;
    EXPECT_THROW(surface_of(points, {.spacing = 1}, watched), Cancelled);
}

template <class Error, class T>
void expect_refusal(const std::vector<Vec<T, 3>>& points, const PointSurfaceOptions& options,
                    const std::string& part) {
    try {
        surface_of(points, options);
        ADD_FAILURE() << part;
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

TEST(SurfaceOf, RefusesWhatHasNoSurface) {
    const auto nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {nan, infinity, -infinity, 0x1.1p480}) {
        Points points = random_points(9000, 20, 8);
        points[8123][1] = bad, points[8999][0] = nan;
        expect_refusal<InputError>(points, {.spacing = 1}, "point 8123 has a coordinate that is NaN");
        std::vector<Vec3f> floats(10);
        floats[3][2] = static_cast<float>(bad);
        expect_refusal<InputError>(floats, {.spacing = 1}, "point 3 has a coordinate that is NaN");
    }
    expect_refusal<InputError>(Points{{}, {0, 0, 1e13}}, {.spacing = 1}, "point 1 lies more than 2^40 cells");

    const Points one(1);
    for (const double bad : {0.0, -1.0, nan, infinity, 1e-300})
        expect_refusal<UsageError>(one, {.spacing = bad}, "the spacing");
    for (const double bad : {-1.0, 0.9, 17.0, nan})
        expect_refusal<UsageError>(one, {.spacing = 1, .radius = bad}, "the radius");
    for (const double bad : {-1.0, 1e-9, 1.6, nan})
        expect_refusal<UsageError>(one, {.spacing = 1, .cell = bad}, "the cell");
    for (const double bad : {-1.0, 0.0, 1.0, nan})
        expect_refusal<UsageError>(one, {.spacing = 1, .level = bad}, "the level");
    expect_refusal<UsageError>(one, {.spacing = 1, .smoothing = -1}, "the smoothing");
    expect_refusal<UsageError>(Points(), {}, "the spacing");

    const auto none = surface_of(Points(), {.spacing = 1});
    EXPECT_TRUE(none.mesh.vertices.empty() && none.mesh.triangles.empty() && none.normals.empty());
}

}  // namespace
}  // namespace hedgerow
