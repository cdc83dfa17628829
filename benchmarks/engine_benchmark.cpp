/// The engine: a wide BVH's rays a second, one at a time and in batches, beside Embree in the same run when
/// it is there.
///
///   engine_benchmark [--width N] [--set INSTRUCTIONS] [SCENE ...]
///
/// The scenes are mesh files or gen:NAME[:SIZE]. One thread; medians; every ratio is to the better of
/// Embree's medium and high builds on that scene and ray set. Embree answers single rays by its single calls;
/// primary rays also by its calls of 16, which are handed the rays in its own layout.
#include <cmath>
#include <map>
#include <memory>

#include <hedgerow/structures/bvh/wide/wide_bvh.h>

#include "contest.h"
#include "embree.h"
#include "ray_sets.h"

using namespace hedgerow;
using namespace hedgerow::benchmark;

namespace {

constexpr int repeats = 5;

using Engine = decltype(build<WideBvh>(std::declval<const TriangleMesh<float>&>()));

/// Geometric means by what was compared.
class Means {
public:
    void add(const std::string& what, double ratio) {
        auto& [logs, count] = of_[what];
        logs += std::log(ratio), ++count;
    }
    void print() const {
        for (const auto& [what, sum] : of_)
            std::printf("%-40s %.2f\n", what.c_str(), std::exp(sum.first / sum.second));
    }

private:
    std::map<std::string, std::pair<double, int>> of_;
};

/// What Embree may use besides: the same instruction set.
[[maybe_unused]] std::string embree_isa() {
    const std::string_view ours = wide_kernels() != nullptr ? wide_kernels()->instruction_set : "plain";
    return ours == "avx2" ? "avx2" : ours == "sse4" ? "sse4.2" : "";
}

using Contender = std::function<std::size_t()>;

void builds(const TriangleMesh<float>& mesh, [[maybe_unused]] Means& means) {
    for (const auto& [name, builder] : {std::pair<std::string, WideBuilder>{"fast", WideBuilder::fast},
                                        {"medium", WideBuilder::medium},
                                        {"high", WideBuilder::high}}) {
        WideOptions options;
        options.builder = builder;
        const double ours = median_seconds(3, [&] { build<WideBvh>(mesh, options); });
        std::printf("  %-6s build %8.1f ms", name.c_str(), ours * 1e3);
#ifdef HEDGEROW_HAS_EMBREE
        const auto quality = builder == WideBuilder::high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
        const double theirs = embree_build_seconds(3, mesh, quality);
        std::printf(", Embree %s %8.1f ms: ours takes %.2f of it",
                    quality == RTC_BUILD_QUALITY_HIGH ? "high" : "medium", theirs * 1e3, ours / theirs);
        means.add("build " + name, ours / theirs);
#endif
        std::printf("\n");
    }
}

void traces(const TriangleMesh<float>& mesh, int width, [[maybe_unused]] Means& means) {
    std::vector<Engine> engines;
    for (const auto builder : {WideBuilder::medium, WideBuilder::high}) {
        WideOptions options;
        options.builder = builder;
        options.width = width;
        engines.push_back(build<WideBvh>(mesh, options));
    }
    std::printf("  width %d, %.1f bytes a triangle\n", engines[0].structure().options().width,
                double(engines[0].bytes()) / double(mesh.size()));
#ifdef HEDGEROW_HAS_EMBREE
    std::vector<std::unique_ptr<Embree>> embrees;
    for (const auto quality : {RTC_BUILD_QUALITY_MEDIUM, RTC_BUILD_QUALITY_HIGH})
        embrees.push_back(std::make_unique<Embree>(mesh, false, 1, quality, embree_isa()));
#endif
    for (const auto& set : ray_sets(mesh, engines[0].bounds(), 1024, 1 << 19)) {
        const std::string& name = set.name;
        const std::vector<Ray3f>& rays = set.rays;
        const std::span<const Ray3f> asked(rays);
        std::vector<Hit<float>> hits(rays.size());
        const std::unique_ptr<bool[]> any(new bool[rays.size()]);
        for (const bool closest : {true, false}) {
            std::vector<Contender> contenders;
            for (const auto& engine : engines) {
                contenders.emplace_back([&] {
                    std::size_t found = 0;
                    if (closest)
                        for (const auto& r : asked) found += closest_hit(engine, r).has_value();
                    else
                        for (const auto& r : asked) found += any_hit(engine, r);
                    return found;
                });
                contenders.emplace_back([&]() -> std::size_t {
                    if (closest)
                        closest_hits(engine, asked, std::span(hits));
                    else
                        any_hits(engine, asked, {any.get(), rays.size()});
                    return 0;
                });
            }
#ifdef HEDGEROW_HAS_EMBREE
            const Embree::Packets packets(name == "primary" ? asked : asked.first(0));
            for (const auto& e : embrees) {
                contenders.emplace_back([&] { return closest ? e->trace(rays) : e->occluded(rays); });
                if (name == "primary") contenders.emplace_back([&] { return e->trace(packets, closest); });
            }
#endif
            const auto rate = rates(repeats, rays.size(), contenders);
            const double single = std::max(rate[0], rate[2]), batch = std::max(rate[1], rate[3]);
            const std::string kind = closest ? "closest" : "any";
            std::printf("  %-8s %-7s one %6.2f (medium %.2f, high %.2f) batch %6.2f (%.2f, %.2f)",
                        name.c_str(), kind.c_str(), single, rate[0], rate[2], batch, rate[1], rate[3]);
#ifdef HEDGEROW_HAS_EMBREE
            const bool primary = name == "primary";
            const double theirs = std::max(rate[4], rate[primary ? 6 : 5]);
            std::printf(" | Embree %6.2f: one %.2f, batch %.2f", theirs, single / theirs, batch / theirs);
            means.add(kind + ", one", single / theirs);
            if (primary) {
                const double by_16 = std::max(rate[5], rate[7]);
                std::printf(" | by 16 %6.2f: %.2f", by_16, batch / by_16);
                means.add(kind + ", batch, coherent, by 16", batch / by_16);
            } else {
                means.add(kind + ", batch, incoherent", batch / theirs);
            }
#endif
            std::printf("\n");
            std::fflush(stdout);
        }
    }
}

}  // namespace

int main(int count, char** arguments) {
    int width = 0;
    std::vector<std::string> names;
    for (int i = 1; i < count; ++i) {
        const std::string a = arguments[i];
        if (a == "--width" && i + 1 < count)
            width = std::atoi(arguments[++i]);
        else if (a == "--set" && i + 1 < count)
            use_instruction_set(arguments[++i]);
        else
            names.push_back(a);
    }
    const std::string set(wide_kernels() != nullptr ? wide_kernels()->instruction_set : "plain");
    std::printf("%s, %s, g++ %d.%d, one thread, medians of %d, Mrays/s\n", processor().c_str(), set.c_str(),
                __GNUC__, __GNUC_MINOR__, repeats);
    if (names.empty())
        names = {"gen:teapot-in-stadium:50000", "gen:soup:200000", "gen:hairball:200000", "gen:terrain:20000",
                 "gen:terrain:2000000"};
    Means means;
    for (const auto& name : names) {
        const auto mesh = scene(name);
        std::printf("%s: %zu triangles\n", name.substr(name.rfind('/') + 1).c_str(), mesh.size());
        builds(mesh, means);
        traces(mesh, width, means);
    }
    std::printf("Geometric means (rates: ours to theirs; builds: our time to theirs)\n");
    means.print();
}
