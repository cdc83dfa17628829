/// The rays with which the paths of a picture begin.
#pragma once

#include <cstddef>
#include <cstdint>

#include <hedgerow/render/camera/ray_maker.h>
#include <hedgerow/render/sampling/path_samples.h>
#include <hedgerow/render/sampling/pixel_filter.h>

namespace hedgerow {

/// A path from the camera: its ray, whose direction has length 1, and its numbers.
template <std::floating_point T>
struct PathStart {
    Ray<T, 3> ray;
    PathSamples samples;
};

/// Makes the starts of paths, each a function of the camera, the size, the seed, the pixel, the half and the
/// sample.
class PathCamera {
public:
    PathCamera(const Camera& camera, int width, int height, PixelFilter filter, Sampler sampler,
               std::uint64_t seed)
        : make_(camera, width, height), width_(width), filter_(filter), sampler_(sampler), seed_(seed) {}

    /// The number of a pixel, by rows from the top left.
    std::size_t number(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }
    /// The samples of a picture's second half have a sequence of their own, independent of the first's.
    template <std::floating_point T>
    PathStart<T> start(int x, int y, std::uint32_t half, std::uint32_t sample) const {
        const PathSamples samples(PixelSequence(sampler_, seed_, number(x, y), half), sample);
        const UnitPair numbers = samples.in_pixel();
        const Vec2f at = place_in_pixel(filter_, numbers.x, numbers.y);
        const float across = static_cast<float>(x) + at[0], down = static_cast<float>(y) + at[1];
        if (!make_.has_lens()) return {make_.template ray<T>(across, down), samples};
        const UnitPair lens = samples.on_lens();
        return {make_.template ray<T>(across, down, lens_point(lens.x, lens.y)), samples};
    }

private:
    RayMaker make_;
    int width_;
    PixelFilter filter_;
    Sampler sampler_;
    std::uint64_t seed_;
};

}  // namespace hedgerow
