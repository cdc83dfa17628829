/// What pictures by path tracing cost on one thread, and how much of it rays do: ours in batches, ours one by
/// one, and Embree's, if it was found, by single calls and by streams. The integrator is the same. Rays alone
/// are those of the picture, traced again in the calls in which it asked them. Then two threads beside one,
/// and the memory of a thread beside scene and picture.
///
///   path_benchmark [SIZE] [SCENE ...]     default: 200, and the dragon if it is there,
///   gen:teapot-in-stadium:50000 gen:hairball:200000 gen:terrain:200000 gen:cornell-box
///   gen:terrain:200000+textures
#include <cmath>
#include <cstdio>
#include <thread>

#include <hedgerow/caster.h>
#include <hedgerow/measure/contest.h>
#include <hedgerow/measure/machine.h>
#include <hedgerow/render/recording_tracer.h>

#include "../tests/counted_memory.h"
#include "path_scene.h"
#include "peers/tracers.h"
#include "picture_scene.h"

using namespace hedgerow;
using namespace hedgerow::measure;

namespace {

constexpr int rounds = 5, rounds_of_threads = 3;
/// Samples of a pixel: of one thread, and where two are compared with one, so that both have work to the end.
constexpr std::uint32_t samples_a_pixel = 8, samples_of_threads = 64;

/// Answers batches ray by ray, by the fastest calls for single rays.
class OneByOne final : public Tracer<float> {
public:
    explicit OneByOne(const MeshIndex<float>& index) : index_(index) {}
    Box3f bounds() const override { return index_.bounds(); }
    KernelUse closest_hits(const RayArray<float, 3>& rays, std::span<Hit<float>> hits, std::span<Visits>,
                           const Filter&) const override {
        const Caster cast(index_);
        for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = cast.closest_hit(rays[i]);
        return {rays.size(), 0, 0};
    }
    KernelUse any_hits(const RayArray<float, 3>& rays, std::span<bool> hits, std::span<Visits>,
                       const Filter&) const override {
        const Caster cast(index_);
        for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = cast.any_hit(rays[i]);
        return {rays.size(), 0, 0};
    }
    void first_hits(const RayArray<float, 3>&, std::size_t, HitLists<float>&, const AfterHits&,
                    const Filter&) const override {
        throw std::logic_error("paths have no first hits");
    }

private:
    const MeshIndex<float>& index_;
};

/// Traces the rays of a picture again, call by call. Returns how many hit.
class Replay {
public:
    Replay(const RecordingTracer<float>& recorded, const Tracer<float>& tracer)
        : recorded_(recorded),
          tracer_(tracer),
          hits_(recorded.closest().rays.size()),
          blocked_(std::make_unique<bool[]>(recorded.any().rays.size())) {}

    std::size_t operator()() {
        for (const auto& call : recorded_.calls()) {
            const auto& rays = call.any ? recorded_.any().rays : recorded_.closest().rays;
            const RayArray<float, 3> asked(&rays[call.first], call.size);
            if (call.any)
                tracer_.any_hits(asked, std::span(&blocked_[call.first], call.size));
            else
                tracer_.closest_hits(asked, std::span(hits_).subspan(call.first, call.size));
        }
        return hits_.size();
    }

private:
    const RecordingTracer<float>& recorded_;
    const Tracer<float>& tracer_;
    std::vector<Hit<float>> hits_;
    std::unique_ptr<bool[]> blocked_;
};

/// Times by those of our picture in batches; 0 where there is none.
struct Ratios {
    double one_by_one = 1, embree = 1, threads = 1;
    void multiply(const Ratios& r) { one_by_one *= r.one_by_one, embree *= r.embree, threads *= r.threads; }
};

/// How many times as fast two threads are as one, on the clock on the wall. Embree limits the threads of the
/// process while it has a scene, so this is measured without one.
double two_threads(const PathBenchmarkScene& scene, int size) {
    const PathPictureOptions options = scene.options(size, samples_of_threads);
    const ThreadLimit limit(2);
    Contest contest;
    for (Executor* const executor : {static_cast<Executor*>(&serial_executor()), &default_executor()})
        contest.add("threads", [&, executor] {
            return trace_paths(scene.with(scene.tracer()), by(*executor, options)).light.size();
        });
    const auto times =
        measured_in_turn(rounds_of_threads, contest, Clock::wall, [](const std::string&) { return true; });
    return times[0].median / times[1].median;
}

Ratios measure_scene(const std::string& name, int size) {
    const PathBenchmarkScene scene(name);
    const PathPictureOptions options = scene.options(size, samples_a_pixel);
    const auto picture = [&](const Tracer<float>& tracer) {
        return trace_paths(scene.with(tracer), by(serial_executor(), options)).light.size();
    };
    const RecordingTracer<float> recorded(scene.tracer());
    picture(recorded);
    Ratios ratios{0, 0, two_threads(scene, size)};
    const double samples = double(size) * double(size) * samples_a_pixel;
    std::size_t vertices = 0;
    for (const Hit<float>& hit : recorded.closest().answers) vertices += bool(hit);

    Contest contest;
    contest.add("in batches", [&] { return picture(scene.tracer()); });
    Replay replay(recorded, scene.tracer());
    contest.add("its rays alone", [&] { return replay(); });
    const OneByOne one_by_one(scene.index());
    contest.add("rays one by one", [&] { return picture(one_by_one); });
    std::vector<std::unique_ptr<Tracer<float>>> peers;
    for (const auto& [calls, how] : {std::pair(EmbreeCalls::single, "Embree, single calls"),
                                     {EmbreeCalls::stream, "Embree, streams"},
                                     {EmbreeCalls::coherent_stream, "Embree, coherent streams"}})
        if (auto peer = embree_tracer(scene.mesh(), calls)) {
            contest.add(how, [&picture, tracer = peer.get()] { return picture(*tracer); });
            peers.push_back(std::move(peer));
        }
    const auto times =
        measured_in_turn(rounds, contest, Clock::thread, [](const std::string&) { return true; });
    PathPicture film(size, size);
    const std::size_t bytes = most_bytes_of([&] {
        add_samples(film, samples_a_pixel, scene.with(scene.tracer()), by(serial_executor(), options));
    });

    std::printf("%s: %zu triangles; %.0f samples, %.2f vertices and %.2f + %.2f rays a sample, %.0f a call\n",
                name.c_str(), scene.mesh().size(), samples, double(vertices) / samples,
                double(recorded.closest().rays.size()) / samples,
                double(recorded.any().rays.size()) / samples,
                double(recorded.closest().rays.size() + recorded.any().rays.size()) /
                    double(recorded.calls().size()));
    const double ours = times[0].median;
    for (std::size_t i = 0; i < times.size(); ++i)
        std::printf("    %-25s %8.0f ns a sample, %5.2f; spread %.0f%%\n", contest.names[i].c_str(),
                    1e9 * times[i].median / samples, times[i].median / ours, 100 * times[i].spread);
    ratios.one_by_one = times[2].median / ours;
    for (std::size_t i = 3; i < times.size(); ++i)
        ratios.embree = i == 3 ? times[i].median / ours : std::min(ratios.embree, times[i].median / ours);
    std::printf(
        "    two threads are %.2f times as fast as one (%u samples a pixel); %.2f MiB a thread beside scene "
        "and "
        "picture\n",
        ratios.threads, samples_of_threads, double(bytes) / (1 << 20));
    return ratios;
}

}  // namespace

int main(int count, char** arguments) try {
    const auto [size, names] =
        PictureArguments(count, arguments,
                         {"gen:teapot-in-stadium:50000", "gen:hairball:200000", "gen:terrain:200000",
                          "gen:cornell-box", "gen:terrain:200000+textures"},
                         200);
    std::printf("%s, %u cores, %s, one thread, %d x %d, %u samples a pixel, medians of %d in turns\n",
                processor().c_str(), std::thread::hardware_concurrency(), compiler().c_str(), size, size,
                samples_a_pixel, rounds);
    Ratios product;
    for (const auto& name : names) product.multiply(measure_scene(name, size));
    const auto mean = [scenes = double(names.size())](double of_all) { return std::pow(of_all, 1 / scenes); };
    std::printf("geometric means: one by one takes %.2f times as long, ", mean(product.one_by_one));
    if (product.embree > 0) std::printf("by the best of Embree's calls %.2f times, ", mean(product.embree));
    std::printf("two threads are %.2f times as fast\n", mean(product.threads));
} catch (const InputError& error) {
    std::fprintf(stderr, "path_benchmark: %s\n", error.what());
    return 3;
}
