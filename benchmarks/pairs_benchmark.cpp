/// Pairs of triangles, builds included, on one thread: the self-intersections of a mesh, and the crossings of
/// a mesh and its moved copy. Beside CGAL in the same run, if CGAL was found. Pairs of vertices within a
/// radius, beside a query of `within` for each and beside nanoflann, and so the pairs of points of a cube
/// that have fifty neighbours each.
///
///   pairs_benchmark [SCENE ...]     a mesh file or gen:NAME[:SIZE]; default: gen:teapot:70000
///   gen:terrain:70000
#include <cmath>
#include <cstdio>
#include <numbers>

#include <hedgerow/ask/pairs.h>
#include <hedgerow/ask/points.h>
#include <hedgerow/measure/contest.h>
#include <hedgerow/measure/machine.h>
#include <hedgerow/scenes/sets.h>
#include <hedgerow/structures/bvh/bvh.h>
#include <hedgerow/structures/kdtree/point_kdtree.h>
#include <hedgerow/structures/orthtree/point_orthtree.h>

#include "peers/pairs.h"
#include "peers/points.h"
#include "scene.h"

using namespace hedgerow;
using namespace hedgerow::measure;

namespace {

constexpr int repeats = 7;

/// Builds an index as a contender does: for one walk a fast build is best.
template <template <class, int> class S>
auto built(const TriangleMesh<float>& mesh) {
    typename S<float, 3>::Options options;
    if constexpr (requires { options.budget; })
        options.builder = WideBuilder::fast;
    else
        options.builder = BvhBuilder::lbvh;
    return build<S>(mesh, options, serial_executor());
}
template <template <class, int> class S>
Contender self_intersections_of(const TriangleMesh<float>& mesh) {
    return [&mesh, found = std::vector<ElementPair>()]() mutable {
        return self_intersections(built<S>(mesh), found, {.threads = serial_executor()});
    };
}
template <template <class, int> class S>
Contender crossings_of(const TriangleMesh<float>& a, const TriangleMesh<float>& b) {
    return [&a, &b, found = std::vector<ElementPair>()]() mutable {
        return crossing_pairs(built<S>(a), built<S>(b), found, {.threads = serial_executor()});
    };
}

/// Times the contenders in turn. Prints the counts beside the medians, and the ratio to the first.
void print(const char* question, const Contest& contest) {
    std::vector<std::size_t> found;
    for (const auto& run : contest.contenders) found.push_back(run());
    const auto times =
        measured_in_turn(repeats, contest, Clock::thread, [](const std::string&) { return true; });
    for (std::size_t i = 0; i < times.size(); ++i)
        std::printf("  %-20s %-24s %9zu pairs %9.2f ms %6.2f x\n", question, contest.names[i].c_str(),
                    found[i], times[i].median * 1e3, times[i].median / times[0].median);
}

/// Pairs of points within a radius, builds included; beside nanoflann, if it was found.
void measure_radius(const PointCloud<float, 3>& cloud, float radius) {
    const auto by_pairs = [&cloud, radius]<template <class, int> class S>() -> Contender {
        return [&cloud, radius, found = std::vector<PairWithin<float>>()]() mutable {
            return pairs_within(build<S>(cloud, {}, serial_executor()), radius, found,
                                {.threads = serial_executor()});
        };
    };
    Contest contest;
    contest.add("pairs, wide", by_pairs.operator()<WideBvh>());
    contest.add("pairs, bvh", by_pairs.operator()<Bvh>());
    contest.add("pairs, point-octree", by_pairs.operator()<PointOrthtree>());
    contest.add("pairs, point-kdtree", by_pairs.operator()<PointKdTree>());
    contest.add("within, wide", [&cloud, radius] {
        const auto index = build<WideBvh>(cloud, {}, serial_executor());
        std::vector<Near<float, 3>> found;
        std::size_t pairs = 0;
        for (PrimitiveId i = 0; i < cloud.size(); ++i) {
            within(index, cloud.points[i], radius, found);
            for (const auto& near : found) pairs += near.element > i;
        }
        return pairs;
    });
    if (const auto peer = nanoflann_points(cloud)) {
        // Lists hold each pair from both sides, and each point itself.
        if (peer->within(std::span(cloud.points).first(1), radius))
            contest.add(peer->name() + ", within", [&cloud, radius] {
                const auto built = nanoflann_points(cloud);
                return (*built->within(cloud.points, radius, false) - cloud.size()) / 2;
            });
    }
    print("within a radius", contest);
}

void measure_scene(const TriangleMesh<float>& mesh) {
    Contest self;
    self.add("wide, fast", self_intersections_of<WideBvh>(mesh));
    self.add("bvh, lbvh", self_intersections_of<Bvh>(mesh));
    add_cgal_self_intersections(self, mesh);
    print("self-intersections", self);

    // Move the copy askew to all axes, by a thousandth of the extent.
    auto moved = mesh;
    Box3f box;
    for (const auto& v : mesh.vertices) box.expand(v);
    const Vec3f by = Vec3f(0.7f, 1.1f, -0.4f) * (0.001f * length(box.extent()));
    for (auto& v : moved.vertices) v = v + by;
    Contest crossings;
    crossings.add("wide, fast", crossings_of<WideBvh>(mesh, moved));
    crossings.add("bvh, lbvh", crossings_of<Bvh>(mesh, moved));
    add_cgal_crossings(crossings, mesh, moved);
    print("crossings", crossings);
    // Vertices within about three lengths of an edge.
    measure_radius({mesh.vertices}, 3 * length(box.extent()) / std::sqrt(static_cast<float>(mesh.size())));

    // The distance to a copy that is moved by three times the extent.
    auto far = mesh;
    for (auto& v : far.vertices) v = v + box.extent() * 3.f;
    const auto a = built<WideBvh>(mesh), b = built<WideBvh>(far), c = built<WideBvh>(moved);
    const auto time = [&](const auto& other) {
        return median_seconds(
                   repeats, [&] { minimum_distance(a, other); }, Clock::thread) *
               1e3;
    };
    std::printf("  minimum distance, without builds: %.3f ms to a far copy, %.3f ms to the crossing one\n",
                time(b), time(c));
}

}  // namespace

int main(int count, char** arguments) try {
    std::printf("%s, %s, one thread, medians of %d\n", processor().c_str(), compiler().c_str(), repeats);
    std::vector<std::string> names(arguments + 1, arguments + count);
    // Points that have fifty neighbours each.
    constexpr std::size_t count_of_points = 200'000;
    std::printf("unit cube: %zu points\n", count_of_points);
    const auto cloud = points<float>(count_of_points);
    measure_radius(
        cloud, static_cast<float>(std::cbrt(50 / (4.0 / 3 * std::numbers::pi * double(count_of_points)))));
    if (names.empty()) names = {"gen:teapot:70000", "gen:terrain:70000"};
    for (const auto& name : names) {
        const auto mesh = scene(name);
        std::printf("%s: %zu triangles\n", name.substr(name.rfind('/') + 1).c_str(), mesh.size());
        measure_scene(mesh);
    }
} catch (const InputError& error) {
    std::fprintf(stderr, "pairs_benchmark: %s\n", error.what());
    return 3;
}
