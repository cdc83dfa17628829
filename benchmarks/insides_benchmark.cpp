/// Sides and signed distances of points, one thread, in turns: near the surface (1% of the diagonal off it)
/// and far (in the doubled box). Beside CGAL's Side_of_triangle_mesh in the same run, if CGAL was found and
/// the mesh is closed; and after some triangles were taken away, which leaves edges open.
///
/// Of soups, whose edges are nearly all open: winding numbers by expansions beside the sum of all solid
/// angles, and how far they are off.
///
///   insides_benchmark [SCENE ...]    a mesh file or gen:NAME[:SIZE]; default: gen:boulder:70000
///                                    gen:boulder:800000 gen:soup:100000
#include <cstdio>
#include <numbers>

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
    contest.add("side", each([&](const Vec3f& p) { return side(solid, p) == Side::inside; }));
    contest.add("sides", [&] {
        return sides(solid, all, std::span(ours), {.threads = serial_executor()}), points.size();
    });
    contest.add("side, holes", each([&](const Vec3f& p) { return side(open, p) == Side::inside; }));
    contest.add("closest_point",
                each([&](const Vec3f& p) { return closest_point(solid.index(), p).distance2 > 1; }));
    contest.add("signed_distance", each([&](const Vec3f& p) { return signed_distance(solid, p) < 0; }));
    contest.add("by pseudonormals", each([&](const Vec3f& p) { return signed_distance(by_normals, p) < 0; }));
    contest.add("closest_points", [&] {
        return closest_points(solid.index(), all, std::span(near), {.threads = serial_executor()}),
               points.size();
    });
    contest.add("signed_distances", [&] {
        return signed_distances(solid, all, std::span(distances), {.threads = serial_executor()}),
               points.size();
    });
    contest.add("by pseudonormals", [&] {
        return signed_distances(by_normals, all, std::span(distances), {.threads = serial_executor()}),
               points.size();
    });
    const auto times =
        measured_in_turn(rounds, contest, Clock::thread, [](const std::string&) { return true; });
    Visits visits;
    for (const Vec3f& p : points) side(solid, p, {}, visits);
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

/// The sum of the solid angles of all triangles, over 4π (Van Oosterom and Strackee 1983).
double sum_of_angles(const TriangleMesh<float>& mesh, const Vec3f& point) {
    const TriangleMeshView<float> view = mesh.view();
    const Vec3d q(point);
    double sum = 0;
    for (std::size_t i = 0; i < view.size(); ++i) {
        const auto t = view.triangle(i);
        const Vec3d a = Vec3d(t.a) - q, b = Vec3d(t.b) - q, c = Vec3d(t.c) - q;
        const double la = length(a), lb = length(b), lc = length(c);
        sum +=
            std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    }
    return sum / (2 * std::numbers::pi);
}
void measure_expansions(const char* kind, const TriangleMesh<float>& mesh, const MeshIndex<float>& index,
                        const std::vector<Vec3f>& points) {
    constexpr std::size_t few = 200;
    std::vector<double> sums(few), found(points.size());
    const double sum_time = median_seconds(
        rounds,
        [&] {
            for (std::size_t i = 0; i < few; ++i) sums[i] = sum_of_angles(mesh, points[i]);
        },
        Clock::thread);
    const double sum_rate = few / sum_time;
    std::printf("%s: %.0f sums of all solid angles a second\n", kind, sum_rate);
    for (const double error : {1e-2, 1e-3, 1e-4}) {
        const Solid solid(index, {.by = SideBy::expansion, .error = error}, serial_executor());
        const double time = median_seconds(
            rounds,
            [&] {
                for (std::size_t i = 0; i < points.size(); ++i) found[i] = winding_number(solid, points[i]);
            },
            Clock::thread);
        double worst = 0;
        for (std::size_t i = 0; i < few; ++i) worst = std::max(worst, std::abs(found[i] - sums[i]));
        const double rate = static_cast<double>(points.size()) / time;
        std::printf(
            "    within %.0e %8.0f a second, %6.1f times the sum's rate; the worst of %zu is off by %.1e\n",
            error, rate, rate / sum_rate, few, worst);
    }
}
void measure_soup(const std::string& name) {
    const TriangleMesh<float> mesh = scene(name);
    const MeshIndex<float> index = build(mesh, serial_executor());
    const double solid_time = median_seconds(
        3, [&] { static_cast<void>(Solid(index, {.by = SideBy::expansion}, serial_executor())); },
        Clock::thread);
    std::printf("\n%s: %zu triangles; the solid takes %.1f ms\n", name.c_str(), mesh.size(),
                solid_time * 1e3);
    measure_expansions("near", mesh, index, near_points(mesh, index.bounds(), 2000));
    measure_expansions("far", mesh, index, far_points(index.bounds(), 2000));
}

}  // namespace

int main(int count, char** arguments) try {
    std::printf("%s, %s, one thread, medians of %d\n", processor().c_str(), compiler().c_str(), rounds);
    std::vector<std::string> names(arguments + 1, arguments + count);
    if (names.empty()) names = {"gen:boulder:70000", "gen:boulder:800000", "gen:soup:100000"};
    for (const auto& name : names) name.starts_with("gen:soup") ? measure_soup(name) : measure_scene(name);
} catch (const InputError& error) {
    std::fprintf(stderr, "insides_benchmark: %s\n", error.what());
    return 3;
}
