/// Forces between particles on one thread: pairs by direct sums, forces of a stated accuracy with their
/// errors, Barnes and Hut, each by every instruction set, and octrees of points.
///
///   nbody_benchmark [COUNT]      particles; default 1,000,000
#include <cstdio>
#include <cstdlib>
#include <functional>

#include <hedgerow/base/instruction_set.h>
#include <hedgerow/index.h>
#include <hedgerow/measure/contest.h>
#include <hedgerow/measure/machine.h>
#include <hedgerow/nbody/barnes_hut.h>
#include <hedgerow/nbody/force_check.h>
#include <hedgerow/nbody/forces.h>
#include <hedgerow/scenes/particles.h>
#include <hedgerow/scenes/sets.h>
#include <hedgerow/structures/orthtree/orthtree.h>
#include <hedgerow/structures/orthtree/point_orthtree.h>

using namespace hedgerow;
using namespace hedgerow::measure;

namespace {

constexpr int repeats = 5;

std::string format(const char* pattern, double number) {
    char text[64];
    std::snprintf(text, sizeof text, pattern, number);
    return text;
}
/// Prints the cycles that a contender takes a unit of work, and its error, if that is asked.
void print(const Contest& contest, std::size_t units, const char* unit,
           const std::function<double()>& error = {}) {
    const auto times =
        measured_in_turn(repeats, contest, Clock::thread, [](const std::string&) { return true; });
    const double rate = clock_rate();
    for (std::size_t i = 0; i < times.size(); ++i) {
        const double seconds = times[i].median / static_cast<double>(units);
        std::printf("  %-34s %9.3f ns %9.2f cycles a %s", contest.names[i].c_str(), seconds * 1e9,
                    seconds * rate * 1e9, unit);
        if (error) contest.contenders[i](), std::printf(", rms error %.1e", error());
        std::printf("\n");
    }
}

template <class T>
void add_direct_sums(Contest& contest, const char* scalar, const PointCloud<T, 3>& cloud,
                     std::size_t targets) {
    for (const auto set : instruction_sets()) {
        if (set == "plain") continue;
        contest.add(std::string(scalar) + ", " + std::string(set), [&cloud, set, targets] {
            use_instruction_set(set);
            const std::vector<T> charges(cloud.size(), T(1));
            std::vector<PotentialAt<T>> found(targets);
            direct_sum<T>({cloud.points, charges}, std::span(cloud.points).first(targets), found,
                          {.threads = serial_executor()});
            return static_cast<std::size_t>(found[0].potential);
        });
    }
}
template <class T>
void add_trees(Contest& contest, const char* scalar, const PointCloud<T, 3>& cloud) {
    const std::string of = scalar;
    for (const std::uint32_t leaf_size : {8u, 32u})
        contest.add(of + ", point-octree of leaves of " + std::to_string(leaf_size), [&cloud, leaf_size] {
            return build<PointOrthtree>(cloud, {.leaf_size = leaf_size}, serial_executor())
                .structure()
                .leaf_count();
        });
    contest.add(of + ", octree",
                [&cloud] { return build<Orthtree>(cloud, {}, serial_executor()).structure().node_count(); });
}

}  // namespace

int main(int argc, char** argv) {
    const std::size_t count = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1000000;
    std::printf("%s at %.2f GHz, %s, %s, one thread, medians of %d\n", processor().c_str(), clock_rate(),
                avx512_rate().c_str(), compiler().c_str(), repeats);
    const auto floats = points<float>(count);
    const auto doubles = points<double>(count);
    const Particles stars = plummer(count), clusters = two_clusters(count);

    const std::size_t sources = std::min<std::size_t>(count, 20000),
                      targets = std::min<std::size_t>(sources, 4096);
    const auto few = points<float>(sources);
    const auto few_doubles = points<double>(sources);
    std::printf("direct sums: %zu sources, %zu targets\n", sources, targets);
    Contest sums;
    add_direct_sums(sums, "float", few, targets);
    add_direct_sums(sums, "double", few_doubles, targets);
    print(sums, sources * targets, "pair");

    const std::vector<double> charges(count, 1.0 / static_cast<double>(count));
    for (const auto& [scene, all_places] :
         {std::pair<const char*, std::span<const Vec3d>>("unit cube", doubles.points),
          {"Plummer sphere", stars.places},
          {"pair of unlike clusters", clusters.places}}) {
        const std::span<const Vec3d> places = all_places;
        std::printf("forces: %zu charges of a %s\n", count, scene);
        Contest methods;
        std::vector<PotentialAt<double>> found(count);
        for (const std::string_view set : instruction_sets()) {
            if (set == "plain" || set == "sse4") continue;
            for (const double accuracy : {1e-2, 1e-3, 1e-4, 3e-5, 1e-6, 1e-7})
                methods.add(std::string(set) + format(", within %.0e", accuracy), [&, set, accuracy] {
                    use_instruction_set(set);
                    forces<double>({places, charges}, found,
                                   {.accuracy = accuracy, .threads = serial_executor()});
                    return static_cast<std::size_t>(found[0].potential);
                });
            methods.add(std::string(set) + ", barnes_hut, angle 0.55", [&, set] {
                use_instruction_set(set);
                barnes_hut<double>({places, charges}, found,
                                   {.opening_angle = 0.55, .threads = serial_executor()});
                return static_cast<std::size_t>(found[0].potential);
            });
        }
        const ForceCheck check(Charges<double>{places, charges}, 1000, serial_executor());
        print(methods, count, "charge", [&] { return check.errors_of<double>(found).rms; });
    }

    std::printf("builds: %zu points of the unit cube\n", count);
    Contest trees;
    add_trees(trees, "float", floats);
    add_trees(trees, "double", doubles);
    print(trees, count, "point");
}
