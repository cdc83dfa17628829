/// What a BVH's bounding volume costs and brings: bytes, cycles a test, tests and time a ray. The first row
/// is the default BVH. The other rows are the study structure (structures/bvh/volume_bvh.h) over the same
/// tree; its kdop6 is the default's box, tested by the code of the study.
///
///   volumes_benchmark [SCENE ...]     default: gen:teapot-in-stadium gen:soup:100000
///   gen:hairball:20000; a mesh file is a scene
#include <hedgerow/ask.h>
#include <hedgerow/measure/contest.h>
#include <hedgerow/measure/machine.h>
#include <hedgerow/measure/ray_sets.h>
#include <hedgerow/structures/bvh/volume_bvh.h>

#include "scene.h"

using namespace hedgerow;
using namespace hedgerow::measure;

namespace {

constexpr int repeats = 3;

/// Seconds of one test of a ray against a volume, for rays and nodes in arbitrary order.
template <class Index>
double test_seconds(const Index& index, const std::vector<Ray3f>& rays) {
    const auto& tree = index.structure();
    const std::size_t nodes = tree.leaf_count() - 1;
    if (nodes == 0) return 0;
    std::vector<RayProbe<float, 3>> probes;
    // Take up to 1000 rays, scattered over the set.
    for (std::size_t i = 0; i < std::min<std::size_t>(rays.size(), 1000); ++i)
        probes.emplace_back(rays[i * 7919 % rays.size()], index.bounds());
    std::size_t entered = 0, tests = 0;
    const double time = median_seconds(repeats, [&] {
        tests = 0;
        // Test only 64 nodes, so that they stay in the cache and memory is not measured.
        for (std::size_t k = 0; k < 64; ++k) {
            const auto volumes = tree.volumes({static_cast<std::uint32_t>(k * nodes / 64), 0});
            for (const auto& probe : probes) {
                float at[4];
                entered += probe.enter(volumes, probe.ray().t_max, at);
                tests += 2;
            }
        }
    });
    // Use the count, so that the compiler keeps all tests.
    asm volatile("" : : "r"(entered));
    return time / static_cast<double>(tests);
}

template <class Index>
void row(const char* name, const Index& index, const RaySet& set, double built, double clock) {
    // Count what the rays visit.
    Visits visits;
    for (const auto& ray : set.rays) closest_hit(index, ray, KeepAll{}, visits);
    // Time the queries without counts.
    std::size_t hits = 0;
    const double time = median_seconds(repeats, [&] {
        hits = 0;
        for (const auto& ray : set.rays) hits += bool(closest_hit(index, ray));
    });
    const double n = static_cast<double>(set.rays.size());
    // Print the node bytes without the items of the leaves.
    const double items = static_cast<double>(index.size()) * sizeof(PrimitiveId);
    const double inner = static_cast<double>(index.structure().leaf_count() - 1);
    const double bytes = static_cast<double>(index.structure().bytes());
    std::printf("| %-9s | %-8s | %8.0f | %8.1f | %8.1f | %7.1f | %8.2f | %8.2f | %9.0f | %5.1f |\n", name,
                set.name.c_str(), built * 1e3, (bytes - items) / inner,
                bytes / static_cast<double>(index.size()), test_seconds(index, set.rays) * clock * 1e9,
                2 * static_cast<double>(visits.nodes) / n, static_cast<double>(visits.primitives) / n,
                time / n * 1e9, static_cast<double>(hits) / n * 100);
}

void table(const TriangleMesh<float>& mesh, double clock) {
    Box3f box;
    for (const auto& v : mesh.vertices) box.expand(v);
    const auto sets = ray_sets(mesh, box, 128, 1 << 14);
    std::printf(
        "| volume    | rays     | build ms | B a node | B a prim | cycles  | volumes  | prims    | ns a ray  "
        "| %% hit "
        "|\n|-----------|----------|----------|----------|----------|---------|----------|----------|--------"
        "---|-------"
        "|\n");
    const auto measure = [&](const char* name, auto build_index) {
        const double start = now(Clock::wall);
        const auto index = build_index();
        const double built = now(Clock::wall) - start;
        for (const auto& set : sets) row(name, index, set, built, clock);
    };
    measure("(default)", [&] { return build<Bvh>(mesh, serial_executor()); });
    for (std::size_t kind = 0; kind < std::size(volume_names); ++kind) {
        const auto volume = static_cast<Volume>(kind);
        // The box is the default BVH, above; kdop4 and kdop8 are for the plane.
        if (volume == Volume::box || volume == Volume::kdop4 || volume == Volume::kdop8) continue;
        VolumeBvhOptions options;
        options.volume = volume;
        measure(std::string(name_of(volume)).c_str(),
                [&] { return build<VolumeBvh>(mesh, options, serial_executor()); });
    }
}

}  // namespace

int main(int count, char** arguments) try {
    const double clock = clock_rate();
    std::printf("%s at %.2f GHz, %s, one thread, medians of %d; cycles: a test of one volume\n",
                processor().c_str(), clock, compiler().c_str(), repeats);
    std::vector<std::string> names(arguments + 1, arguments + count);
    if (names.empty()) names = {"gen:teapot-in-stadium", "gen:soup:100000", "gen:hairball:20000"};
    for (const auto& name : names) {
        const auto mesh = scene(name);
        std::printf("\n%s, %zu triangles\n\n", name.substr(name.rfind('/') + 1).c_str(), mesh.size());
        table(mesh, clock);
    }
} catch (const InputError& error) {
    std::fprintf(stderr, "volumes_benchmark: %s\n", error.what());
    return 3;
}
