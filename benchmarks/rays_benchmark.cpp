/// Closest-hit rates and build times of the BVH, beside Embree's in the same run if Embree was found.
///
///   rays_benchmark [SCENE ...]     a mesh file or gen:NAME[:SIZE]; default: gen:teapot-in-stadium
#include <hedgerow/ask.h>
#include <hedgerow/measure/contest.h>
#include <hedgerow/measure/machine.h>
#include <hedgerow/measure/ray_sets.h>
#include <hedgerow/structures/bvh/bvh.h>

#include "peers/peers.h"
#include "scene.h"

using namespace hedgerow;
using namespace hedgerow::measure;

namespace {

constexpr int repeats = 7;

void builds(const TriangleMesh<float>& mesh) {
    const double one = median_seconds(repeats, [&] { build<Bvh>(mesh, serial_executor()); });
    double two;
    {
        const ThreadLimit limit(2);
        two = median_seconds(repeats, [&] { build<Bvh>(mesh, {}, default_executor()); });
    }
    std::printf("  binned build  %7.1f ms on one thread, %7.1f ms on two: %.2f x as fast\n", one * 1e3,
                two * 1e3, one / two);
    for (const auto& peer : peers()) {
        const double medium = build_seconds(*peer, mesh, repeats);
        std::printf("  %s medium %7.1f ms on one thread: ours takes %.2f of it\n", peer->name().c_str(),
                    medium * 1e3, one / medium);
    }
}

void traces(const TriangleMesh<float>& mesh) {
    const auto index = build<Bvh>(mesh);
    std::printf("  %.1f bytes a triangle, depth %d, SAH cost %.1f\n",
                double(index.bytes()) / double(mesh.size()), index.structure().depth(),
                index.structure().sah_cost());
    // Make the rays and the indices of the peers.
    const auto sets = ray_sets(mesh, index.bounds(), 1024, 1 << 19);
    std::vector<std::unique_ptr<PeerIndex>> theirs;
    for (const auto& peer : peers())
        for (const char* how : {"medium", "robust"})
            theirs.push_back(peer->build(mesh, build_named(*peer, how), {}));
    std::printf("  %-8s %9s %8s %8s %8s", "rays", "Mrays/s", "nodes", "leaves", "prims");
    std::printf("   Embree Mrays/s (ratio)   robust (ratio)\n");
    for (const RaySet& set : sets) {
        const std::vector<Ray3f>& rays = set.rays;
        // Count what the rays visit.
        Visits v;
        for (const auto& r : rays) closest_hit(index, r, KeepAll{}, v);
        // Time our BVH and the peers in turn.
        std::vector<std::function<std::size_t()>> contenders = {[&] {
            std::size_t found = 0;
            for (const auto& r : rays) found += bool(closest_hit(index, r));
            return found;
        }};
        for (const auto& peer : theirs)
            contenders.emplace_back([&peer = *peer, &rays] { return peer.closest(rays); });
        const auto rate = rates(repeats, rays.size(), contenders);
        const double n = double(rays.size());
        std::printf("  %-8s %9.2f %8.2f %8.2f %8.2f", set.name.c_str(), rate[0], double(v.nodes) / n,
                    double(v.leaves) / n, double(v.primitives) / n);
        for (std::size_t c = 1; c < rate.size(); ++c)
            std::printf("   %9.2f (%.2f)", rate[c], rate[0] / rate[c]);
        std::printf("\n");
    }
}

}  // namespace

int main(int count, char** arguments) {
    std::printf("%s, %s, one thread, medians of %d\n", processor().c_str(), compiler().c_str(), repeats);
    std::vector<std::string> names(arguments + 1, arguments + count);
    if (names.empty()) names = {"gen:teapot-in-stadium"};
    for (const auto& name : names) {
        const auto mesh = scene(name);
        std::printf("%s: %zu triangles\n", name.substr(name.rfind('/') + 1).c_str(), mesh.size());
        builds(mesh);
        traces(mesh);
    }
}
