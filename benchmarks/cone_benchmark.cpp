/// What a cone costs beside 256 rays, on one thread: on pixels that an edge crosses, and for the shadows of a
/// disc of 5 degrees; and how far the shares that cones and rays find are apart. Times in microseconds.
///
///   cone_benchmark [SIZE] [SCENE ...]     default: 1024, and the dragon if it is there,
///   gen:cornell-box gen:teapot-in-stadium:50000 gen:terrain:200000 gen:hairball:200000 gen:soup:50000
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>

#include <hedgerow/ask/rays.h>
#include <hedgerow/engine/wide_bvh.h>
#include <hedgerow/index.h>
#include <hedgerow/measure/contest.h>
#include <hedgerow/measure/machine.h>
#include <hedgerow/render/shading/shading.h>
#include <hedgerow/render/shading/surfaces.h>
#include <hedgerow/render/visibility/cones.h>

#include "picture_scene.h"

using namespace hedgerow;
using namespace hedgerow::measure;

namespace {

constexpr int rounds = 5;
constexpr std::size_t across = 16, most_cones = 2000;

/// Cones, and for each the 256 rays that it stands for.
struct Trial {
    std::vector<ConeRays<float, 3>> cones;
    std::vector<Ray<float, 3>> rays;
};

/// Some of the pixels whose neighbours see other triangles, spread over the picture.
std::vector<std::size_t> on_edges(const PictureSamples<float>& samples, const std::vector<Hit<float>>& hits) {
    std::vector<std::size_t> all;
    for (int y = 1; y + 1 < samples.height(); ++y)
        for (int x = 1; x + 1 < samples.width(); ++x) {
            const auto element = [&](int dx, int dy) { return hits[samples.number(x + dx, y + dy)].element; };
            if (element(0, 0) != element(1, 0) || element(0, 0) != element(0, 1))
                all.push_back(samples.number(x, y));
        }
    std::vector<std::size_t> some;
    for (std::size_t i = 0; i < most_cones && !all.empty(); ++i)
        some.push_back(all[i * all.size() / most_cones]);
    return some;
}
Trial pixels(const Camera& camera, const PictureSamples<float>& samples,
             const std::vector<std::size_t>& some) {
    Trial trial;
    const RayMaker make(camera, samples.width(), samples.height());
    for (const std::size_t i : some) {
        const auto width = static_cast<std::size_t>(samples.width());
        trial.cones.push_back(
            cone_of_pixel(samples, static_cast<int>(i % width), static_cast<int>(i / width)));
        for (std::size_t s = 0; s < across * across; ++s) {
            const auto at = [&](std::size_t pixel, std::size_t cell) {
                return static_cast<float>(pixel) + (static_cast<float>(cell) + 0.5f) / across;
            };
            trial.rays.push_back(make.ray<float>(at(i % width, s % across), at(i / width, s / across)));
        }
    }
    return trial;
}
/// From what pixels see to a distant light.
Trial shadows(const TriangleMesh<float>& mesh, const PictureSamples<float>& samples,
              const std::vector<Hit<float>>& hits, const Vec3f& light) {
    Trial trial;
    const SurfacesOf surfaces(mesh);
    const auto slope = static_cast<float>(std::tan(2.5 * std::numbers::pi / 180));
    const std::size_t step = 1 + hits.size() / (4 * most_cones);
    for (std::size_t i = 0; i < hits.size() && trial.cones.size() < most_cones; i += step) {
        if (!hits[i]) continue;
        const auto width = static_cast<std::size_t>(samples.width());
        const auto ray = samples.ray(static_cast<int>(i % width), static_cast<int>(i / width));
        const Vec3f normal = surfaces.normal(ray, hits[i]);
        if (dot(normal, light) < 0.1f) continue;  // so that all of the disc is above the surface
        const Vec3f from = surfaces.origin(ray, hits[i], normal);
        const ConeRays<float, 3>& cone = trial.cones.emplace_back(Ray3f{from, light}, 0.0f, slope);
        const ConeFrame frame(cone);
        for (std::size_t s = 0; s < across * across; ++s) {
            const auto at = [](std::size_t cell) { return (static_cast<float>(cell) + 0.5f) / across; };
            const LensPoint p = lens_point(at(s % across), at(s / across));
            const Ray3d ray_of_place = frame.ray(cone.origin(), double(p.right), double(p.up));
            trial.rays.push_back({from, Vec3f(ray_of_place.direction)});
        }
    }
    return trial;
}
/// Measures a trial, and prints a line.
template <class I>
void compare(const I& index, const char* what, const Trial& trial) {
    const IndexCones cones(index);
    const std::size_t n = trial.cones.size();
    if (n == 0) return;
    const auto blocked = std::make_unique<bool[]>(trial.rays.size());
    std::vector<ConeFragment<float>> found;
    std::size_t fragments = 0;
    Contest contest;
    contest.add("cones", [&] {
        fragments = 0;
        for (std::size_t i = 0; i < n; ++i) fragments += cone_fragments(index, trial.cones[i], found);
        return fragments;
    });
    contest.add("rays", [&] {
        any_hits(index, trial.rays, std::span<bool>(blocked.get(), trial.rays.size()),
                 {.threads = serial_executor()});
        return n;
    });
    std::vector<Hit<float>> hits(trial.rays.size());
    contest.add("closest", [&] {
        closest_hits(index, trial.rays, std::span(hits), {.threads = serial_executor()});
        return n;
    });
    const auto times =
        measured_in_turn(rounds, contest, Clock::thread, [](const std::string&) { return true; });
    double error = 0;
    std::size_t partly = 0;
    for (std::size_t i = 0; i < n; ++i) {
        std::size_t clear = 0;
        for (std::size_t s = 0; s < across * across; ++s) clear += !blocked[across * across * i + s];
        const double share = double(clear) / (across * across), seen = double(cones.open(trial.cones[i]));
        if (clear == 0 || clear == across * across) continue;
        error += std::abs(share - seen), ++partly;
    }
    const double each = 1e6 / double(n);
    std::printf(
        "  %-8s a cone %5.2f us, %4.1f fragments; 256 closest hits %6.2f, any %6.2f: %.2f and %.2f of them;",
        what, times[0].median * each, double(fragments) / double(n), times[2].median * each,
        times[1].median * each, times[0].median / times[2].median, times[0].median / times[1].median);
    std::printf(" %zu partly covered, error %.2f%%\n", partly,
                100 * error / double(std::max<std::size_t>(partly, 1)));
}

}  // namespace

int main(int count, char** arguments) try {
    const auto [size, names] =
        PictureArguments(count, arguments,
                         {"gen:cornell-box", "gen:teapot-in-stadium:50000", "gen:terrain:200000",
                          "gen:hairball:200000", "gen:soup:50000"});
    std::printf("%s, %s, one thread, %d x %d, medians of %d\n", processor().c_str(), compiler().c_str(), size,
                size, rounds);
    for (const auto& name : names) {
        const auto [mesh, kind, camera] = PictureScene(name);
        const PictureSamples<float> samples(camera, size, size);
        const auto index = build<WideBvh>(mesh, {}, serial_executor());
        std::vector<Hit<float>> hits(samples.size());
        closest_hits(index, samples.rays(), std::span(hits), {.threads = serial_executor()});
        std::printf("%s, %zu triangles\n", kind.c_str(), mesh.size());
        compare(index, "pixels", pixels(camera, samples, on_edges(samples, hits)));
        compare(index, "shadows", shadows(mesh, samples, hits, PlainShading(camera, 0).to_light()));
    }
} catch (const InputError& error) {
    std::fprintf(stderr, "cone_benchmark: %s\n", error.what());
    return 3;
}
