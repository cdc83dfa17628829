/// Every structure on large scenes, one thread: build times beside Embree's, closest-hit rates beside those
/// of the binned BVH in the same run, and the repeated tests that a mailbox avoids.
///
///   structures_benchmark [SCENE ...]     default: gen:terrain:2000000 gen:soup:200000; a mesh file is a
///   scene
#include <unordered_set>

#include <hedgerow/any_index.h>
#include <hedgerow/measure/contest.h>
#include <hedgerow/measure/machine.h>
#include <hedgerow/measure/ray_sets.h>
#include <hedgerow/structures/grid/grid.h>
#include <hedgerow/structures/kdtree/kdtree.h>

#include "peers/peers.h"
#include "scene.h"

using namespace hedgerow;
using namespace hedgerow::measure;

namespace {

constexpr int repeats = 5;
constexpr std::size_t most_for_slow_builds = 200000;

/// The specs to measure. The first one is the baseline of the others.
std::vector<std::string> structures_for(std::size_t triangles) {
    std::vector<std::string> specs = {"bvh",
                                      "bvh:builder=sweep",
                                      "bvh:builder=lbvh",
                                      "bvh:builder=ploc",
                                      "bvh:builder=agglomerative",
                                      "bvh:builder=spatial-splits",
                                      "bvh:reinsertion=3",
                                      "kdtree",
                                      "kdtree:builder=binned",
                                      "grid:density=1",
                                      "grid",
                                      "two-level-grid",
                                      "octree"};
    if (triangles <= most_for_slow_builds) specs.push_back("bsp");
    return specs;
}

using Built = std::unique_ptr<AnyIndex<float, 3>>;

std::vector<Built> builds(const TriangleMesh<float>& mesh) {
    double embree = 0;
    for (const auto& peer : peers()) {
        embree = build_seconds(*peer, mesh, repeats);
        std::printf("\n%s medium: %.1f ms on one thread\n", peer->name().c_str(), embree * 1e3);
    }
    std::printf(
        "\n| structure                   | build ms | of Embree | two threads | B a prim | items a prim |\n"
        "|-----------------------------|----------|-----------|-------------|----------|--------------|\n");
    std::vector<Built> all;
    for (const auto& spec : structures_for(mesh.size())) {
        Built index;
        // Build slow structures only once.
        const int times = spec == "bsp" || spec == "kdtree" ? 1 : repeats;
        const double one = median_seconds(times, [&] { index = build_any(spec, mesh, serial_executor()); });
        double two;
        {
            const ThreadLimit limit(2);
            two = median_seconds(times, [&] { build_any(spec, mesh, default_executor()); });
        }
        const double n = static_cast<double>(mesh.size());
        std::printf("| %-27s | %8.1f | %9.3f | %8.2f x  | %8.1f | %12.2f |\n", spec.c_str(), one * 1e3,
                    embree > 0 ? one / embree : 0.0, one / two, static_cast<double>(index->bytes()) / n,
                    static_cast<double>(index->item_count()) / n);
        all.push_back(std::move(index));
    }
    return all;
}

void traces(const TriangleMesh<float>& mesh, const std::vector<Built>& all) {
    const auto sets = ray_sets(mesh, all[0]->bounds(), 512, 1 << 17);
    std::printf(
        "\n| structure                   | rays     | Mrays/s | of the first | nodes    | leaves   | prims   "
        " "
        "| ns a node |\n"
        "|-----------------------------|----------|---------|--------------|----------|----------|----------"
        "|-----------|\n");
    for (const auto& set : sets) {
        const std::size_t n = set.rays.size();
        std::vector<Hit<float>> hits(n);
        std::vector<std::function<std::size_t()>> contenders;
        for (const auto& index : all)
            contenders.emplace_back([&] {
                closest_hits(*index, set.rays, hits, {.threads = serial_executor()});
                return static_cast<std::size_t>(
                    std::ranges::count_if(hits, [](const auto& h) { return bool(h); }));
            });
        // Time all structures in turn.
        const auto rate = rates(repeats, n, contenders);
        for (std::size_t c = 0; c < all.size(); ++c) {
            // Count what the rays visit.
            std::vector<Visits> visits(n);
            closest_hits(*all[c], set.rays, hits, {.threads = serial_executor()}, KeepAll(), visits);
            Visits sum;
            for (const auto& v : visits) sum += v;
            const double rays = static_cast<double>(n), nodes = static_cast<double>(sum.nodes) / rays;
            std::printf("| %-27s | %-8s | %7.3f | %12.2f | %8.2f | %8.2f | %8.2f | %9.1f |\n",
                        std::string(all[c]->structure()).c_str(), set.name.c_str(), rate[c],
                        rate[c] / rate[0], nodes, static_cast<double>(sum.leaves) / rays,
                        static_cast<double>(sum.primitives) / rays, 1e3 / rate[c] / nodes);
        }
    }
}

/// Counts tests, and collects the different primitives among them. `tests` leaves out what a mailbox skips.
template <class Index>
struct DifferentTests {
    const Index& index;
    std::unordered_set<PrimitiveId> seen = {};
    std::uint64_t tests = 0;

    template <class... State>
    void node(const Place&, const State&...) {}
    template <class... State>
    void leaf(std::uint64_t count, const Place& place, const State&...) {
        tests += count;
        const auto& structure = index.structure();
        Leaf leaf;
        if constexpr (requires { structure.lattice(); })
            leaf = structure.leaf(structure.lattice().cell(place.first));
        else
            leaf = structure.leaf(place.first);
        seen.insert(leaf.ids + leaf.first, leaf.ids + leaf.first + leaf.count);
    }
    void own(PrimitiveId) {}
    void skip(PrimitiveId) { --tests; }
};

/// Prints the part of the repeated tests that a mailbox avoids: tests of primitives that the same ray has
/// tested before.
template <template <class, int> class S>
void mailbox(const char* name, const TriangleMesh<float>& mesh, const std::vector<RaySet>& sets) {
    typename S<float, 3>::Options options;
    if constexpr (requires { options.builder; }) options.builder = KdBuilder::binned;
    const auto with = build<S>(mesh, options);
    for (const auto& set : sets) {
        std::uint64_t tests = 0, different = 0, spared = 0;
        for (const auto& ray : set.rays) {
            // Count the tests and the different primitives, then what the mailbox skips.
            DifferentTests<std::remove_cvref_t<decltype(with)>> count{with};
            closest_hit(with, ray, KeepAll{}, count);
            Visits visits;
            closest_hit(with, ray, KeepAll{}, visits);
            tests += count.tests + visits.skipped, spared += visits.skipped, different += count.seen.size();
        }
        const double n = static_cast<double>(set.rays.size()),
                     repeated = static_cast<double>(tests - different);
        std::printf("| %-9s | %-8s | %8.2f | %8.2f | %8.2f | %7.1f%% |\n", name, set.name.c_str(),
                    static_cast<double>(tests) / n, repeated / n, static_cast<double>(spared) / n,
                    repeated > 0 ? static_cast<double>(spared) / repeated * 100 : 100.0);
    }
}

void mailboxes(const TriangleMesh<float>& mesh, const Box3f& box) {
    const auto sets = ray_sets(mesh, box, 128, 1 << 14);
    std::printf(
        "\nTests a ray without a mailbox, those of them that are repeated, and what the mailbox spares:\n"
        "\n| structure | rays     | tests    | repeated | spared   | of these |\n"
        "|-----------|----------|----------|----------|----------|----------|\n");
    mailbox<KdTree>("kdtree", mesh, sets);
    mailbox<Grid>("grid", mesh, sets);
}

}  // namespace

int main(int count, char** arguments) try {
    std::printf("%s, %s, medians of %d\n", processor().c_str(), compiler().c_str(), repeats);
    std::vector<std::string> names(arguments + 1, arguments + count);
    if (names.empty()) names = {"gen:terrain:2000000", "gen:soup:200000"};
    for (const auto& name : names) {
        const auto mesh = scene(name);
        std::printf("\n%s, %zu triangles\n", name.substr(name.rfind('/') + 1).c_str(), mesh.size());
        const auto all = builds(mesh);
        traces(mesh, all);
        mailboxes(mesh, all[0]->bounds());
    }
} catch (const InputError& error) {
    std::fprintf(stderr, "structures_benchmark: %s\n", error.what());
    return 3;
}
