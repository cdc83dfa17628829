/// Pictures by path tracing. The component `render` has it compiled.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include <hedgerow/base/error.h>
#include <hedgerow/parallel/by.h>
#include <hedgerow/parallel/progress.h>
#include <hedgerow/render/camera/camera.h>
#include <hedgerow/render/film/light_halves.h>
#include <hedgerow/render/integrators/path.h>
#include <hedgerow/render/integrators/path_reference.h>
#include <hedgerow/render/sampling/pixel_filter.h>

namespace hedgerow {

/// How the samples of a picture are divided. `even`: all pixels have as many, in one sequence each, which
/// converges fastest. `halves`: in two independent halves, for denoising and to know the noise. `adaptive`:
/// in halves, and pixels whose samples differ much have more. What the first samples of one half show decides
/// how many the other gets, so no pixel is biased.
enum class Division : std::uint8_t { even, halves, adaptive };
inline constexpr std::array<std::string_view, 3> division_names = {"even", "halves", "adaptive"};

/// The half that has sample k of a pixel, and the sample's number there.
struct HalfSample {
    std::uint32_t half, number;
};
inline HalfSample half_sample(Division division, std::uint32_t k) {
    return division == Division::even ? HalfSample{0, k} : HalfSample{k % 2, k / 2};
}

struct PathPictureOptions {
    Camera camera;
    int width = 1024, height = 768;
    std::uint32_t samples = 64;  ///< of each pixel, or on the mean
    Division division = Division::even;
    PathOptions paths;
    PixelFilter filter = PixelFilter::box;
    /// Paths that each thread follows at once (integrators/path.h); 0: one by one, as PathReference does. The
    /// picture is the same.
    std::size_t in_flight = PathWavefront<float>::default_in_flight;
    /// Whether the picture has sums of its direct light, too, as PathPicture::direct.
    bool keeps_direct = false;
    /// By which threads. What is answered does not depend on them.
    Threads threads = {};
};

/// What paths of a picture go through. All of it is borrowed.
template <std::floating_point T>
struct PathScene {
    const ModelScene<T>& model;
    const SceneLights<T>& lights;
    /// Answers the rays, with the hits of `model`: its own tracer, or another over the same instances.
    const Tracer<T>& tracer;
};

/// A picture as sums of light, by rows from the top left.
struct PathPicture {
    int width = 0, height = 0;
    LightHalves light{0};
    /// The part of the light that is direct: scattered at most once between its source and the eye. Its
    /// samples are those of the light, and dropped as those are. No pixels if it is not kept.
    LightHalves direct{0};
    /// The samples that every pixel has, or has at least its share of: on the mean so many a pixel. Pixels
    /// may have more if work was interrupted.
    std::uint32_t samples = 0;
    /// What an adaptive picture divides its samples by: spreads of the first samples of each half
    /// (sampling/allocation.h). Empty before there are that many.
    std::array<std::vector<float>, 2> spreads;

    /// Throws InputError for a picture without pixels.
    PathPicture(int w, int h, bool keeps_direct = false)
        : width(w), height(h), light(pixels(w, h)), direct(keeps_direct ? light.size() : 0) {}
    bool keeps_direct() const { return direct.size() > 0; }
    /// Adds a sample to half a pixel. One that is not finite counts as black.
    void add(std::size_t pixel, int half, const PathLight& sample) {
        light.half(half).add(pixel, sample.all);
        if (keeps_direct()) direct.half(half).add(pixel, finite(sample.all) ? sample.direct : sample.all);
    }
    /// Linear light by pixel.
    std::vector<Vec3f> means() const {
        std::vector<Vec3f> all;
        for (std::size_t i = 0; i < light.size(); ++i) all.push_back(light.mean(i));
        return all;
    }
    /// The mean of a pixel's light that is scattered more than once, if direct light is kept: what is left of
    /// the light without it. Not negative.
    Vec3f indirect(std::size_t pixel) const { return light.mean(pixel) - direct.mean(pixel); }
    /// The samples that pixels have on the mean, also those of work that was interrupted.
    double mean_samples() const {
        double sum = 0;
        for (std::size_t i = 0; i < light.size(); ++i) sum += light.samples(i);
        return sum / static_cast<double>(light.size());
    }
    /// The samples of all pixels that were not finite.
    std::uint64_t dropped() const {
        std::uint64_t sum = 0;
        for (std::size_t i = 0; i < light.size(); ++i) sum += light.dropped(i);
        return sum;
    }

private:
    static std::size_t pixels(int w, int h) {
        if (w < 1 || h < 1) throw InputError("a picture needs at least one pixel");
        return static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
    }
};

/// The samples that each half of a pixel has before those of an adaptive picture are divided.
inline constexpr std::uint32_t pilot_samples = 16;

/// Follows paths until each pixel of a picture has `samples` samples, or all have so many on the mean; its
/// options name them only for those who start anew. A picture that has some goes on with the next, at places
/// that are spread evenly over the pixel together with those before. What a sample is depends on the scene,
/// the camera, the size, its number and the options alone, to the last bit: never on the executor, the
/// structure behind the tracer, the processor, or how often the work was interrupted. If it is cancelled,
/// pixels have the samples that were finished. Throws InputError for options without a meaning, a camera that
/// sees nothing, pictures without pixels or samples, a picture of another size, and one that does not keep
/// direct light if the options ask for it. A picture that keeps it goes on to do so.
template <std::floating_point T>
void add_samples(PathPicture& picture, std::uint32_t samples, const PathScene<T>& scene,
                 const PathPictureOptions& options, const Progress& progress = {});
extern template void add_samples(PathPicture&, std::uint32_t, const PathScene<float>&,
                                 const PathPictureOptions&, const Progress&);
extern template void add_samples(PathPicture&, std::uint32_t, const PathScene<double>&,
                                 const PathPictureOptions&, const Progress&);

/// A whole picture, as add_samples makes it.
template <std::floating_point T>
PathPicture trace_paths(const PathScene<T>& scene, const PathPictureOptions& options,
                        const Progress& progress = {}) {
    PathPicture picture(options.width, options.height, options.keeps_direct);
    add_samples(picture, options.samples, scene, options, progress);
    return picture;
}

/// What a pixel shows first, for denoisers: colour and normal of the first surface that scatters, which
/// mirrors and smooth glass may show. Both are 0 where there is none.
struct FirstSurface {
    Vec3f albedo;  ///< its base colour, from 0 to 1, tinted by what shows it
    Vec3f normal;  ///< by which it scatters, towards the eye
    /// The hit of the camera's ray: its texture coordinates (0 of surfaces without), its distance, and what
    /// it hits.
    Vec2f uv;
    float depth = std::numeric_limits<float>::infinity();
    std::uint32_t primitive = Hit<float>::none, instance = Hit<float>::none;
};

/// The first surfaces of each pixel, by rows from the top left: the mean colours and normals of its first
/// samples, whose paths are those of `add_samples`, and the hit of its first. Throws as `add_samples` does.
template <std::floating_point T>
std::vector<FirstSurface> first_surfaces(const PathScene<T>& scene, std::uint32_t samples,
                                         const PathPictureOptions& options);
extern template std::vector<FirstSurface> first_surfaces(const PathScene<float>&, std::uint32_t,
                                                         const PathPictureOptions&);
extern template std::vector<FirstSurface> first_surfaces(const PathScene<double>&, std::uint32_t,
                                                         const PathPictureOptions&);

}  // namespace hedgerow
