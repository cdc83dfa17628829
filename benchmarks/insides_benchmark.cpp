/// Sides and signed distances of points, one thread, in turns: near the surface (1% of the diagonal off it)
/// and far (in the doubled box). Beside CGAL's Side_of_triangle_mesh in the same run, if CGAL was found and
/// the mesh is closed; and after some triangles were taken away, which leaves edges open.
///
///   insides_benchmark [SCENE ...]    a mesh file or gen:NAME[:SIZE]; default: gen:boulder:70000
///                                    gen:boulder:800000
#include <cstdio>

#include <hedgerow/hedgerow.h>
#include <hedgerow/measure/contest.h>
#include <hedgerow/measure/machine.h>

#include "peers/insides.h"
#include "query_points.h"
#include "scene.h"

using namespace hedgerow;
using namespace hedgerow::measure;

namespace {

constexpr int rounds = 5;
constexpr std::size_t query_count = 50000;

/// The mesh without triangles that are spread over it, until so many edges are open.
TriangleMesh<float> with_holes(TriangleMesh<float> mesh, std::size_t open_edges) {
    const std::size_t holes = open_edges / 3, step = mesh.size() / holes;
    for (std::size_t i = holes; i-- > 0;)
        mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(i * step));
    mesh.faces.clear();
    return mesh;
}

void measure_queries(const char* kind, const Solid<MeshIndex<float>>& solid,
                     const Solid<MeshIndex<float>>& by_normals, const Solid<MeshIndex<float>>& open,
                     const InsidePeer* peer, const std::vector<Vec3f>& points) {
    std::vector<int> theirs(points.size());
    std::vector<Side> ours(points.size());
    std::vector<float> distances(points.size());
    std::vector<Near<float, 3>> near(points.size());
    const Strided<Vec3f> all(points);
    const auto each = [&](auto ask) {
        return [&points, ask] {
            std::size_t count = 0;
            for (std::size_t i = 0; i < points.size(); ++i) count += ask(points[i]);
            return count;
        };
    };
    Contest contest;
    if (peer != nullptr) contest.add(peer->name(), [&] { return peer->sides(points, theirs); });
    contest.add("side", each([&](const Vec3f& p) { return solid.side(p) == Side::inside; }));
    contest.add("sides",
                [&] { return sides(solid, all, std::span(ours), serial_executor()), points.size(); });
    contest.add("side, holes", each([&](const Vec3f& p) { return open.side(p) == Side::inside; }));
    contest.add("closest_point",
                each([&](const Vec3f& p) { return closest_point(solid.index(), p).distance2 > 1; }));
    contest.add("signed_distance",
                each([&](const Vec3f& p) { return solid.signed_distance(p).distance < 0; }));
    contest.add("by pseudonormals",
                each([&](const Vec3f& p) { return by_normals.signed_distance(p).distance < 0; }));
    contest.add("closest_points", [&] {
        return closest_points(solid.index(), all, std::span(near), serial_executor()), points.size();
    });
    contest.add("signed_distances", [&] {
        return signed_distances(solid, all, std::span(distances), serial_executor()), points.size();
    });
    contest.add("by pseudonormals", [&] {
        return signed_distances(by_normals, all, std::span(distances), serial_executor()), points.size();
    });
    const auto times =
        measured_in_turn(rounds, contest, Clock::thread, [](const std::string&) { return true; });
    Visits visits;
    for (const Vec3f& p : points) solid.side(p, visits);
    const double n = static_cast<double>(points.size());
    std::printf("%s: %.1f nodes, %.1f leaves a side\n", kind, double(visits.nodes) / n,
                double(visits.leaves) / n);
    for (std::size_t c = 0; c < times.size(); ++c)
        std::printf("    %-18s %8.3f M/s, %6.2f times the first\n", contest.names[c].c_str(),
                    n / times[c].median * 1e-6, times[0].median / times[c].median);
    if (peer == nullptr) return;
    std::size_t unlike = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        unlike += theirs[i] != (ours[i] == Side::inside ? 1 : (ours[i] == Side::on ? 0 : -1));
    std::printf("    %zu of %zu sides differ from the peer's\n", unlike, points.size());
}

void measure_scene(const std::string& name) {
    const TriangleMesh<float> mesh = scene(name), holed = with_holes(mesh, 200);
    const MeshIndex<float> index = build(mesh, serial_executor()), of_holed = build(holed, serial_executor());
    const double build_time = median_seconds(
        3, [&] { static_cast<void>(build(mesh, serial_executor())); }, Clock::thread);
    const double solid_time = median_seconds(
        3, [&] { static_cast<void>(Solid(index, {}, serial_executor())); }, Clock::thread);
    const Solid solid(index), by_normals(index, {.by = SideBy::pseudonormal}), open(of_holed);
    std::printf("\n%s: %zu triangles, %zu edges open; the index takes %.1f ms, the solid %.1f ms\n",
                name.c_str(), mesh.size(), solid.boundary().open.size(), build_time * 1e3, solid_time * 1e3);
    const auto peer = cgal_insides(mesh);
    measure_queries("near", solid, by_normals, open, peer.get(),
                    near_points(mesh, index.bounds(), query_count));
    measure_queries("far", solid, by_normals, open, peer.get(), far_points(index.bounds(), query_count));
}

}  // namespace

int main(int count, char** arguments) try {
    std::printf("%s, %s, one thread, medians of %d\n", processor().c_str(), compiler().c_str(), rounds);
    std::vector<std::string> names(arguments + 1, arguments + count);
    if (names.empty()) names = {"gen:boulder:70000", "gen:boulder:800000"};
    for (const auto& name : names) measure_scene(name);
} catch (const InputError& error) {
    std::fprintf(stderr, "insides_benchmark: %s\n", error.what());
    return 3;
}
