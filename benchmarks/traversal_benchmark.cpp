/// What child order, culling and the SAH bring: visits and time a ray of each variant, and the SAH's
/// predicted cost beside the counted cost.
///
///   traversal_benchmark [SCENE ...]     default: gen:teapot-in-stadium gen:soup:200000
#include <hedgerow/any_index.h>
#include <hedgerow/measure/contest.h>
#include <hedgerow/measure/machine.h>
#include <hedgerow/measure/ray_sets.h>
#include <hedgerow/scenes/random.h>
#include <hedgerow/structures/bvh/bvh.h>

#include "scene.h"

using namespace hedgerow;
using namespace hedgerow::measure;

namespace {

constexpr int repeats = 3;

void variant(const char* spec, const TriangleMesh<float>& mesh, const RaySet& set) {
    const auto index = build_any(spec, mesh);
    std::vector<Hit<float>> hits(set.rays.size());
    std::vector<Visits> visits(set.rays.size());
    // Count what the rays visit.
    closest_hits(*index, set.rays, hits, {.threads = serial_executor()}, KeepAll(), visits);
    Visits all;
    for (const auto& v : visits) all += v;
    // Time the queries without counts.
    const double time = median_seconds(
        repeats, [&] { closest_hits(*index, set.rays, hits, {.threads = serial_executor()}); });
    const double n = double(set.rays.size());
    std::printf("| %-28s | %-8s | %8.2f | %8.2f | %8.2f | %9.0f |\n", spec, set.name.c_str(),
                double(all.nodes) / n, double(all.leaves) / n, double(all.primitives) / n, time / n * 1e9);
}

/// Uniformly random lines through the ball around the scene's box: chords between independent uniform points
/// of its sphere.
std::vector<Ray3f> random_lines(const Box3f& box, std::size_t n) {
    const Vec3f center = box.center();
    const float radius = 0.5f * length(box.extent());
    std::vector<Ray3f> lines;
    for (std::size_t i = 0; i < n; ++i) {
        Random random(23, i);
        const Vec3f a = center + Vec3f(random.direction<3>()) * radius,
                    b = center + Vec3f(random.direction<3>()) * radius;
        lines.push_back({a, b - a});
    }
    return lines;
}

/// The mean cost of the rays that hit the scene's box, from counted visits in the SAH's units. `all` asks for
/// all hits instead of the closest.
double counted_cost(const SahOptions& unit, const AnyIndex<float, 3>& index, const std::vector<Ray3f>& rays,
                    bool all) {
    std::vector<Hit<float>> hits;
    Visits visits;
    double met = 0;
    for (const auto& ray : rays) {
        if (!meet(ray, index.bounds())) continue;
        ++met;
        Hit<float> hit;
        if (all)
            all_hits(index, ray, hits, KeepAll(), visits);
        else
            closest_hits(index, {&ray, 1}, {&hit, 1}, {.threads = serial_executor()}, KeepAll(),
                         std::span(&visits, 1));
    }
    return (unit.traversal_cost * double(visits.nodes) + unit.intersection_cost * double(visits.primitives)) /
           met;
}

void prediction(const TriangleMesh<float>& mesh, const RaySet& primary) {
    const auto index = build<Bvh>(mesh);
    const auto any = build_any("bvh", mesh);
    const auto lines = random_lines(index.bounds(), 100000);
    const SahOptions& unit = index.structure().options();
    std::printf(
        "\nSAH cost predicted %.1f; counted: random lines, all hits %.1f; random lines, closest hit %.1f; "
        "primary rays %.1f\n\n",
        index.structure().sah_cost(), counted_cost(unit, *any, lines, true),
        counted_cost(unit, *any, lines, false), counted_cost(unit, *any, primary.rays, false));
}

}  // namespace

int main(int count, char** arguments) {
    std::printf("%s, %s, one thread, medians of %d\n", processor().c_str(), compiler().c_str(), repeats);
    std::vector<std::string> names(arguments + 1, arguments + count);
    if (names.empty()) names = {"gen:teapot-in-stadium", "gen:soup:200000"};
    for (const auto& name : names) {
        const auto mesh = scene(name);
        // Make the rays from the bounds of the mesh.
        Box3f box;
        for (const auto& v : mesh.vertices) box.expand(v);
        const auto sets = ray_sets(mesh, box, 256, 1 << 16);
        std::printf("\n%s, %zu triangles\n\n", name.substr(name.rfind('/') + 1).c_str(), mesh.size());
        std::printf(
            "| structure                    | rays     | nodes    | leaves   | prims    | ns a ray  |\n");
        std::printf(
            "|------------------------------|----------|----------|----------|----------|-----------|\n");
        // Measure each variant with each ray set.
        for (const char* spec : {"bvh", "bvh:builder=sweep", "bvh:builder=midpoint",
                                 "bvh:builder=equal-counts", "bvh:ordered=off", "bvh:culling=off",
                                 "bvh:ordered=off,culling=off", "kdtree", "grid", "octree"})
            for (const auto& set : sets) variant(spec, mesh, set);
        prediction(mesh, sets[0]);
    }
}
