/// Questions of points, one thread, beside peers in turns.
///
/// Closest points of triangles, beside CGAL's tree of boxes with its hint: near the surface (1% of the
/// diagonal off it) and far (in the doubled box). k nearest of a million points, beside nanoflann: uniform in
/// a cube, in a hundred clusters of many sizes, and on a sphere; queries are drawn like the points. k nearest
/// among a million points at one place, beside uniform ones.
///
///   points_benchmark [SCENE ...]     default: gen:terrain:200000 gen:soup:60000 gen:teapot-in-stadium:50000;
///                                    a mesh file is a scene
#include <cmath>
#include <cstdio>
#include <random>

#include <hedgerow/hedgerow.h>
#include <hedgerow/measure/contest.h>
#include <hedgerow/measure/machine.h>
#include <hedgerow/queries/nearest.h>

#include "peers/points.h"
#include "query_points.h"
#include "scene.h"

using namespace hedgerow;
using namespace hedgerow::measure;

namespace {

constexpr int rounds = 5;
constexpr std::size_t query_count = 100000;

/// The greatest share by which squared distances differ.
double disagreement(const std::vector<float>& ours, const std::vector<float>& theirs) {
    double most = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) {
        const double a = double(ours[i]), b = double(theirs[i]);
        most = std::max(most, std::abs(a - b) / std::max({a, b, 1e-30}));
    }
    return most;
}

/// Measures finding the k nearest to each point: the peer, the plain walk, one by one, and (for k = 1) in a
/// batch, also of an index of doubles if there is one.
template <class I>
void measure_queries(const I& index, const PointPeer* peer, const std::string& kind, std::size_t k,
                     const std::vector<Vec3f>& points, const MeshIndex<double>* doubles = nullptr) {
    std::vector<float> ours(points.size()), theirs(points.size());
    std::vector<Near<float, 3>> found, all(points.size());
    Visits visits;
    const auto each = [&](auto find) {
        for (std::size_t i = 0; i < points.size(); ++i) ours[i] = find(points[i]);
        return points.size();
    };
    Contest contest;
    if (peer != nullptr) contest.add(peer->name(), [&] { return peer->nearest(points, k, theirs); });
    contest.add("walk", [&] {
        visits = {};
        return each([&](const Vec3f& p) {
            if (k == 1) return closest_point(index, p, {}, KeepAll(), visits).distance2;
            nearest(index, p, k, found, {}, KeepAll(), visits);
            return found.back().distance2;
        });
    });
    contest.add("one by one", [&] {
        return each([&](const Vec3f& p) {
            if (k == 1) return closest_point(index, p).distance2;
            nearest(index, p, k, found);
            return found.back().distance2;
        });
    });
    if (k == 1)
        contest.add("batch", [&] {
            closest_points(index, Strided<Vec3f>(points), std::span(all), {.threads = serial_executor()});
            return points.size();
        });
    std::vector<Vec3d> points_in_double;
    for (const Vec3f& p : points) points_in_double.emplace_back(p);
    std::vector<Near<double, 3>> found_in_double(points.size());
    if (doubles != nullptr) {
        contest.add("in double", [&] {
            for (std::size_t i = 0; i < points.size(); ++i)
                found_in_double[i] = closest_point(*doubles, points_in_double[i]);
            return points.size();
        });
        contest.add("same, batch", [&] {
            closest_points(*doubles, points_in_double, found_in_double, {.threads = serial_executor()});
            return points.size();
        });
    }
    NearListsOf<I> lists;
    contest.add("columns", [&] {
        nearest(index, points, k, lists, {.threads = serial_executor()});
        return points.size();
    });
    const auto times =
        measured_in_turn(rounds, contest, Clock::wall, [](const std::string&) { return true; });
    const double n = static_cast<double>(points.size());
    std::printf("%s: the walk sees %.1f nodes, %.1f leaves, %.1f primitives a query\n", kind.c_str(),
                double(visits.nodes) / n, double(visits.leaves) / n, double(visits.primitives) / n);
    for (std::size_t c = 0; c < times.size(); ++c)
        std::printf("    %-12s %8.3f M/s, %6.2f times the first\n", contest.names[c].c_str(),
                    n / times[c].median * 1e-6, times[0].median / times[c].median);
    if (peer != nullptr)
        std::printf("    squared distances differ by %.0e at most\n", disagreement(ours, theirs));
}

void measure_mesh(const std::string& name) {
    const TriangleMesh<float> mesh = scene(name);
    const MeshIndex<float> index = build(mesh, serial_executor());
    TriangleMesh<double> in_double;
    for (const Vec3f& v : mesh.vertices) in_double.vertices.emplace_back(v);
    in_double.triangles = mesh.triangles;
    const MeshIndex<double> doubles = build(in_double, serial_executor());
    const auto peer = cgal_points(mesh);
    std::printf("\nclosest points, %s: %zu triangles\n", name.c_str(), mesh.size());
    measure_queries(index, peer.get(), "near", 1, near_points(mesh, index.bounds(), query_count), &doubles);
    measure_queries(index, peer.get(), "far", 1, far_points(index.bounds(), query_count / 4), &doubles);
}

/// Draws points of a kind: "uniform", "clustered" or "on a sphere".
std::vector<Vec3f> drawn(const std::string& kind, std::size_t count, unsigned seed) {
    std::mt19937 random(seed), of_clusters(3);
    std::uniform_real_distribution<float> share(0, 1);
    std::normal_distribution<float> normal(0, 1);
    std::vector<std::pair<Vec3f, float>> clusters;  // where, and how wide
    for (int i = 0; i < 100; ++i) {
        const Vec3f at(share(of_clusters), share(of_clusters), share(of_clusters));
        clusters.emplace_back(at, 0.001f * std::pow(100.0f, share(of_clusters)));
    }
    std::vector<Vec3f> points;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3f away(normal(random), normal(random), normal(random));
        if (kind == "uniform") {
            points.emplace_back(share(random), share(random), share(random));
        } else if (kind == "clustered") {
            const auto& [at, width] = clusters[random() % clusters.size()];
            points.push_back(at + away * width);
        } else {
            points.push_back(normalized(away));
        }
    }
    return points;
}

/// The queries along a curve.
std::vector<Vec3f> in_order(std::vector<Vec3f> points, const Box3f& box) {
    const CurveOfPoints<float, 3> curve(box);
    std::sort(points.begin(), points.end(),
              [&](const Vec3f& a, const Vec3f& b) { return curve.code(a) < curve.code(b); });
    return points;
}

/// Measures listing and counting all within a radius, which is that of the greatest of the `many` nearest of
/// the first query.
template <class I>
void measure_lists(const I& index, const PointPeer* peer, std::size_t many,
                   const std::vector<Vec3f>& points) {
    std::vector<Near<float, 3>> found;
    nearest(index, points[0], many, found);
    const float radius = std::sqrt(found.back().distance2);
    std::size_t ours = 0, theirs = 0;
    Contest contest;
    if (peer != nullptr)
        contest.add(peer->name(), [&] { return theirs = *peer->within(points, radius), points.size(); });
    contest.add("one by one", [&] {
        ours = 0;
        for (const Vec3f& p : points) ours += within(index, p, radius, found);
        return points.size();
    });
    contest.add("batch", [&] {
        ours = within(index, points, radius, {.threads = serial_executor()}).count();
        return points.size();
    });
    NearListsOf<I> columns;
    contest.add("columns", [&] {
        within(index, points, radius, columns, {.threads = serial_executor()});
        ours = columns.count();
        return points.size();
    });
    contest.add("counts", [&] {
        std::size_t all = 0;
        for (const Vec3f& p : points) all += overlap_count(index, Sphere<float, 3>{p, radius});
        return all > 0 ? points.size() : 0;
    });
    const auto times =
        measured_in_turn(rounds, contest, Clock::wall, [](const std::string&) { return true; });
    const double n = static_cast<double>(points.size());
    std::printf("within a radius: %.1f a query%s\n", double(ours) / n,
                peer != nullptr && ours != theirs ? ", the peer's roundings find others" : "");
    for (std::size_t c = 0; c < times.size(); ++c)
        std::printf("    %-12s %8.3f M/s, %6.2f times the first\n", contest.names[c].c_str(),
                    n / times[c].median * 1e-6, times[0].median / times[c].median);
}

void measure_cloud(const std::string& kind) {
    const PointCloud<float, 3> cloud{drawn(kind, 1000000, 4)};
    const auto queries = drawn(kind, query_count / 2, 5);
    auto index = build(cloud, serial_executor());
    std::unique_ptr<PointPeer> peer;
    Contest builds;
    builds.add("ours", [&] { return index = build(cloud, serial_executor()), std::size_t(0); });
    builds.add("peer", [&] { return peer = nanoflann_points(cloud), std::size_t(0); });
    const auto times = measured_in_turn(rounds, builds, Clock::wall, [](const std::string&) { return true; });
    std::printf("\nk nearest, a million points %s: built in %.0f ms, %.1f bytes a point\n", kind.c_str(),
                times[0].median * 1e3,
                static_cast<double>(index.bytes()) / static_cast<double>(cloud.size()));
    if (peer != nullptr)
        std::printf("    %.2f of the time of %s\n", times[0].median / times[1].median, peer->name().c_str());
    for (const std::size_t k : {1u, 8u, 32u})
        measure_queries(index, peer.get(), "k = " + std::to_string(k), k, queries);
    measure_queries(index, peer.get(), "k = 8, queries along a curve", 8, in_order(queries, index.bounds()));
    const std::vector<Vec3f> some(queries.begin(), queries.begin() + query_count / 10);
    for (const std::size_t many : {30u, 1000u}) measure_lists(index, peer.get(), many, some);
}

/// Measures k nearest among a million points at one place, beside those of a million uniform ones.
void measure_crowd() {
    const PointCloud<float, 3> uniform{drawn("uniform", 1000000, 4)};
    PointCloud<float, 3> crowd;
    crowd.points.assign(uniform.size(), Vec3f::all(0.5f));
    const auto among_uniform = build(uniform, serial_executor()), in_crowd = build(crowd, serial_executor());
    const auto queries = drawn("uniform", query_count / 10, 5);
    std::printf("\nk nearest, a million points at one place\n");
    for (const std::size_t k : {1u, 8u, 32u}) {
        std::vector<Near<float, 3>> found;
        NearLists<float> lists;
        Contest contest;
        for (const auto& [name, index] :
             {std::pair("uniform", &among_uniform), std::pair("crowd", &in_crowd)}) {
            contest.add(std::string(name) + ", one by one", [&, index = index] {
                for (const Vec3f& p : queries) nearest(*index, p, k, found);
                return queries.size();
            });
            contest.add(std::string(name) + ", columns", [&, index = index] {
                nearest(*index, queries, k, lists, {.threads = serial_executor()});
                return queries.size();
            });
        }
        const auto times =
            measured_in_turn(rounds, contest, Clock::wall, [](const std::string&) { return true; });
        std::printf("k = %zu: one by one %.1f times the time of uniform points, columns %.1f times\n", k,
                    times[2].median / times[0].median, times[3].median / times[1].median);
    }
}

}  // namespace

int main(int argc, char** argv) {
    std::printf("%s, %s, %s\n", processor().c_str(), avx512_rate().c_str(), compiler().c_str());
    std::vector<std::string> names(argv + 1, argv + argc);
    if (names.empty()) names = {"gen:terrain:200000", "gen:soup:60000", "gen:teapot-in-stadium:50000"};
    for (const std::string& name : names) measure_mesh(name);
    for (const char* kind : {"uniform", "clustered", "on a sphere"}) measure_cloud(kind);
    measure_crowd();
}
