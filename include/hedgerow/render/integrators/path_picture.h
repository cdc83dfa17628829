/// Pictures by path tracing. The component `render` has it compiled.
#pragma once

#include <cstdint>
#include <vector>

#include <hedgerow/parallel/progress.h>
#include <hedgerow/render/camera/camera.h>
#include <hedgerow/render/film/light_sums.h>
#include <hedgerow/render/integrators/path.h>
#include <hedgerow/render/integrators/path_reference.h>

namespace hedgerow {

struct PathPictureOptions {
    Camera camera;
    int width = 1024, height = 768;
    std::uint32_t samples = 64;  ///< of each pixel
    PathOptions paths;
    /// Paths that each thread follows at once (integrators/path.h); 0: one by one, as PathReference does. The
    /// picture is the same.
    std::size_t in_flight = PathWavefront<float>::default_in_flight;
};

/// What paths of a picture go through. All of it is borrowed.
template <std::floating_point T>
struct PathScene {
    const ModelScene<T>& model;
    const SceneLights<T>& lights;
    /// Answers the rays, with the hits of `model`: its own tracer, or another over the same instances.
    const Tracer<T>& tracer;
};

/// A picture as sums of light, and how much of it is finished.
struct PathPicture {
    int width = 0, height = 0;
    LightSums light{0};         ///< by rows from the top left
    bool whole = true;          ///< whether each pixel has all its samples
    std::uint64_t dropped = 0;  ///< samples that were not finite

    /// Linear light by pixel.
    std::vector<Vec3f> means() const {
        std::vector<Vec3f> all;
        for (std::size_t i = 0; i < light.size(); ++i) all.push_back(light.mean(i));
        return all;
    }
};

/// Follows paths through the pixels of a picture: `samples` for each, at places that are spread evenly over
/// the pixel. The picture depends on the scene, the camera, the size, the samples and the options alone, to
/// the last bit: never on the executor, the structure behind the tracer, or the processor. If it is
/// cancelled, pixels have the samples that were finished. Throws InputError for options without a meaning, a
/// camera that sees nothing, and pictures without pixels or samples.
template <std::floating_point T>
PathPicture trace_paths(const PathScene<T>& scene, const PathPictureOptions& options, Executor& executor,
                        const Progress& progress = {});
extern template PathPicture trace_paths(const PathScene<float>&, const PathPictureOptions&, Executor&,
                                        const Progress&);
extern template PathPicture trace_paths(const PathScene<double>&, const PathPictureOptions&, Executor&,
                                        const Progress&);

}  // namespace hedgerow
