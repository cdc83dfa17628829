/// What paths save that end early, and how they err: by Russian roulette from the first, from the fourth
/// vertex or never, and by a cut where little light gets through. All have as many samples; the picture that
/// they are held against has 32 times as many, without either. Times of one thread, medians of 3 in turns.
///
///   roulette_benchmark [SIZE] [SCENE ...]     default: 64, and
///   gen:cornell-box gen:teapot-in-stadium:50000 gen:hairball:200000 gen:terrain:200000
#include <cstdio>
#include <iterator>
#include <thread>

#include <hedgerow/measure/contest.h>
#include <hedgerow/measure/machine.h>
#include <hedgerow/render/recording_tracer.h>

#include "path_scene.h"
#include "picture_error.h"
#include "picture_scene.h"

using namespace hedgerow;
using namespace hedgerow::measure;

namespace {

constexpr std::uint32_t samples = 64, times_the_samples = 32;

struct Ending {
    const char* name;
    std::uint32_t roulette_from;
    float least_throughput;
};
constexpr Ending endings[] = {{"to the end", PathOptions::never, 0},
                              {"roulette from the fourth vertex", 3, 0},
                              {"roulette from the second vertex", 1, 0},
                              {"cut below 0.01", PathOptions::never, 0.01f},
                              {"cut below 0.1", PathOptions::never, 0.1f}};

double rays_a_sample(const PathBenchmarkScene& scene, PathPictureOptions options) {
    options.samples = 1;
    const RecordingTracer<float> recorded(scene.tracer());
    const PathPicture picture = trace_paths(scene.with(recorded), by(serial_executor(), options));
    return double(recorded.closest().rays.size() + recorded.any().rays.size()) / double(picture.light.size());
}

void measure_scene(const std::string& name, int size) {
    const PathBenchmarkScene scene(name);
    const auto picture = [&](const PathPictureOptions& options, Executor& executor) {
        return trace_paths(scene.with(scene.tracer()), by(executor, options));
    };
    PathPictureOptions options = scene.options(size, samples * times_the_samples);
    options.paths.seed = 1, options.paths.roulette_from = PathOptions::never;
    const PathPicture right = picture(options, default_executor());
    Contest contest;
    std::vector<PathPicture> pictures(std::size(endings), PathPicture(size, size));
    std::vector<double> rays;
    for (std::size_t i = 0; i < std::size(endings); ++i) {
        PathPictureOptions ending = scene.options(size, samples);
        ending.paths.roulette_from = endings[i].roulette_from;
        ending.paths.least_throughput = endings[i].least_throughput;
        rays.push_back(rays_a_sample(scene, ending));
        contest.add(endings[i].name, [&, i, ending] {
            pictures[i] = picture(ending, serial_executor());
            return pictures[i].light.size();
        });
    }
    const auto times = measured_in_turn(3, contest, Clock::thread, [](const std::string&) { return true; });
    std::printf(
        "%s\n| paths end | rays a sample | time | bias of the mean | bias beside paths to the end | error "
        "|\n|---|---|---|---|---|---|\n",
        name.c_str());
    for (std::size_t i = 0; i < std::size(endings); ++i) {
        const PictureError error = error_of(pictures[i], right);
        std::printf("| %s | %.2f | %.2f | %+.2f%% | %+.2f%% | %.1f%% |\n", endings[i].name, rays[i],
                    times[i].median / times[0].median, 100 * error.bias,
                    100 * error_of(pictures[i], pictures[0]).bias, 100 * error.root);
    }
}

}  // namespace

int main(int count, char** arguments) try {
    const auto [size, names] = PictureArguments(
        count, arguments,
        {"gen:cornell-box", "gen:teapot-in-stadium:50000", "gen:hairball:200000", "gen:terrain:200000"}, 64,
        false);
    std::printf("%s, %u cores, %s, one thread, %d x %d, %u samples a pixel\n", processor().c_str(),
                std::thread::hardware_concurrency(), compiler().c_str(), size, size, samples);
    for (const auto& name : names) measure_scene(name, size);
} catch (const InputError& error) {
    std::fprintf(stderr, "roulette_benchmark: %s\n", error.what());
    return 3;
}
