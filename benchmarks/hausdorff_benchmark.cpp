/// Directed Hausdorff distances of meshes, builds included, on one thread: to a copy that is moved, to one
/// whose vertices are scattered, and to another mesh. Beside CGAL in the same run, if CGAL was found.
///
///   hausdorff_benchmark [SCENE | SCENE,SCENE ...]     a mesh file or gen:NAME[:SIZE], or two;
///   default: gen:teapot:70000 gen:boulder:70000,gen:boulder:20000
#include <cstdio>

#include <hedgerow/ask/hausdorff.h>
#include <hedgerow/measure/contest.h>
#include <hedgerow/measure/machine.h>
#include <hedgerow/scenes/random.h>
#include <hedgerow/structures/brute_force.h>

#include "peers/hausdorff.h"
#include "scene.h"

using namespace hedgerow;
using namespace hedgerow::measure;

namespace {

constexpr int repeats = 5;

/// Times the contenders in turn, within `error`. Each returns the distance in millionths of `error`.
void measure_pair(const char* what, const TriangleMesh<float>& a, const TriangleMesh<float>& b,
                  double error) {
    const auto contender = [&](WideBuilder builder) -> Contender {
        return [&a, &b, error, builder] {
            WideOptions options;
            options.builder = builder;
            const auto to = build<WideBvh>(b, options, serial_executor());
            const auto found =
                directed_hausdorff_distance(build<BruteForce>(a, {}, serial_executor()), to,
                                            {.absolute = error, .relative = 0, .threads = serial_executor()});
            return static_cast<std::size_t>(static_cast<double>(found.upper) / error * 1e6);
        };
    };
    Contest contest;
    contest.add("wide, fast", contender(WideBuilder::fast));
    contest.add("wide, medium", contender(WideBuilder::medium));
    add_cgal_hausdorff(contest, a, b, error);
    std::vector<double> found;
    for (const auto& run : contest.contenders) found.push_back(static_cast<double>(run()) * 1e-6 * error);
    const auto times =
        measured_in_turn(repeats, contest, Clock::thread, [](const std::string&) { return true; });
    for (std::size_t i = 0; i < times.size(); ++i)
        std::printf("  %-28s %-20s %12.7f %9.2f ms %6.2f x\n", what, contest.names[i].c_str(), found[i],
                    times[i].median * 1e3, times[i].median / times[0].median);
}

void measure_scenes(const std::string& name) {
    const auto comma = name.find(',');
    const auto mesh = scene(name.substr(0, comma));
    Box3f box;
    for (const auto& v : mesh.vertices) box.expand(v);
    const float diagonal = length(box.extent());
    std::printf("%s: %zu triangles, diagonal %g; within 1e-4 of it\n", name.c_str(), mesh.size(),
                static_cast<double>(diagonal));
    const double error = 1e-4 * static_cast<double>(diagonal);
    if (comma != std::string::npos) {
        const auto other = scene(name.substr(comma + 1));
        measure_pair("to the second", mesh, other, error);
        measure_pair("from the second", other, mesh, error);
        return;
    }
    // Move the copy askew to all axes.
    auto copy = mesh;
    const Vec3f by = Vec3f(0.7f, 1.1f, -0.4f) * (0.001f * diagonal);
    for (auto& v : copy.vertices) v = v + by;
    measure_pair("to a moved copy", mesh, copy, error);
    copy = mesh;
    Random random(30);
    for (auto& v : copy.vertices)
        v = v + Vec3f(random.direction<3>() * (0.001 * static_cast<double>(diagonal)));
    measure_pair("to a scattered copy", mesh, copy, error);
    for (auto& v : copy.vertices) v = v + box.extent() * 0.3f;
    measure_pair("to a copy aside", mesh, copy, error);
    measure_pair("to itself", mesh, mesh, error);
}

}  // namespace

int main(int count, char** arguments) try {
    std::printf("%s, %s, one thread, medians of %d\n", processor().c_str(), compiler().c_str(), repeats);
    std::vector<std::string> names(arguments + 1, arguments + count);
    if (names.empty()) names = {"gen:teapot:70000", "gen:boulder:70000,gen:boulder:20000"};
    for (const auto& name : names) measure_scenes(name);
} catch (const InputError& error) {
    std::fprintf(stderr, "hausdorff_benchmark: %s\n", error.what());
    return 3;
}
