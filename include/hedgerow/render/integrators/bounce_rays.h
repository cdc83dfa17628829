/// The rays of a picture's paths by bounce, to measure how structures answer the rays of a render.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <hedgerow/base/error.h>
#include <hedgerow/parallel/progress.h>
#include <hedgerow/render/integrators/path_camera.h>
#include <hedgerow/render/integrators/path_picture.h>
#include <hedgerow/render/integrators/path_reference.h>
#include <hedgerow/render/recording_tracer.h>

namespace hedgerow {

/// The rays of paths that have been scattered equally often.
template <std::floating_point T>
struct BounceRays {
    std::vector<Ray<T, 3>> rays;         ///< along which paths go: closest hits
    std::vector<Ray<T, 3>> shadow_rays;  ///< to lights, from where those hit: any hits
};

namespace detail {

/// Adds the rays of one path, as they were recorded.
template <std::floating_point T>
void add_path(const RecordingTracer<T>& path, std::vector<BounceRays<T>>& bounces) {
    std::size_t hits = 0;  // closest hits so far
    for (const auto& call : path.calls()) {
        if (!call.any && ++hits > bounces.size()) bounces.emplace_back();
        BounceRays<T>& at = bounces[hits - 1];
        if (call.any)
            at.shadow_rays.push_back(path.any().rays[call.first]);
        else
            at.rays.push_back(path.closest().rays[call.first]);
    }
}

}  // namespace detail

/// The rays of a picture's paths, which are those of `add_samples`: element 0 has the camera's rays, element
/// k those after k bounces. Paths follow each other by rows of pixels, and in a pixel by samples. If they are
/// more than `most_paths`, so many are followed, spread evenly over that order. Throws InputError for options
/// without a meaning and a camera that sees nothing, and Cancelled. O(paths), in the calling thread.
template <std::floating_point T>
std::vector<BounceRays<T>> rays_by_bounce(const PathScene<T>& scene, const PathPictureOptions& o,
                                          std::uint64_t most_paths, const Progress& progress = {}) {
    check_camera(o.camera);
    check_paths(o.paths);
    if (o.width < 1 || o.height < 1) throw InputError("a picture needs at least one pixel");
    std::optional<Compensation> compensation;
    if (o.paths.compensation) compensation.emplace();
    const PathSurfaces<T> surfaces(scene.model);
    const PathWorld<T> world{surfaces, scene.lights, o.paths, compensation ? &*compensation : nullptr};
    const PathCamera camera(o.camera, o.width, o.height, o.filter, o.paths.sampler, o.paths.seed);
    RecordingTracer<T> recorded(scene.tracer);
    const PathReference<T> reference(world, recorded);
    const auto width = static_cast<std::uint64_t>(o.width);
    const std::uint64_t all = width * static_cast<std::uint64_t>(o.height) * o.samples;
    const std::uint64_t count = std::min(all, most_paths);
    std::vector<BounceRays<T>> bounces;
    for (std::uint64_t i = 0; i < count; ++i) {
        if (i % 1024 == 0) progress.look(), progress(i, count);
        // The greatest whole number that is at most i · all / count, in parts that fit 64 bits.
        const std::uint64_t path = all / count * i + all % count * i / count, pixel = path / o.samples;
        const auto [half, sample] = half_sample(o.division, static_cast<std::uint32_t>(path % o.samples));
        const PathStart<T> start =
            camera.start<T>({static_cast<int>(pixel % width), static_cast<int>(pixel / width), half, sample});
        recorded.clear();
        reference.light(start.ray, start.samples);
        detail::add_path(recorded, bounces);
    }
    return bounces;
}

}  // namespace hedgerow
