/// The rays with which the paths of a picture begin.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <hedgerow/render/camera/ray_maker.h>
#include <hedgerow/render/sampling/path_samples.h>
#include <hedgerow/render/sampling/pixel_filter.h>
#include <hedgerow/render/sampling/sample_batch.h>

namespace hedgerow {

/// A path from the camera: its ray, whose direction has length 1, and its numbers.
template <std::floating_point T>
struct PathStart {
    Ray<T, 3> ray;
    PathSamples samples;
};

/// A sample of a pixel, in one of the halves of a picture's samples. The samples of the second half have a
/// sequence of their own, independent of the first's.
struct PixelSample {
    int x, y;
    std::uint32_t half, number;
};

/// Makes the starts of paths, each a function of the camera, the size, the seed and the sample.
class PathCamera {
public:
    PathCamera(const Camera& camera, int width, int height, PixelFilter filter, Sampler sampler,
               std::uint64_t seed)
        : make_(camera, width, height), width_(width), filter_(filter), sampler_(sampler), seed_(seed) {}

    /// The number of a pixel, by rows from the top left.
    std::size_t number(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }
    template <std::floating_point T>
    PathStart<T> start(const PixelSample& of) const {
        const PathSamples samples = samples_of(of);
        return {ray<T>(of, samples.at_camera()), samples};
    }
    /// The numbers of a path, and its ray by those of the camera.
    PathSamples samples_of(const PixelSample& of) const {
        return {PixelSequence(sampler_, seed_, number(of.x, of.y), of.half), of.number};
    }
    template <std::floating_point T>
    Ray<T, 3> ray(const PixelSample& of, const CameraSamples& numbers) const {
        const UnitPair in_pixel = numbers.in_pixel();
        const Vec2f at = place_in_pixel(filter_, in_pixel.x, in_pixel.y);
        const float across = static_cast<float>(of.x) + at[0], down = static_cast<float>(of.y) + at[1];
        if (!make_.has_lens()) return make_.template ray<T>(across, down);
        const UnitPair on_lens = numbers.on_lens();
        return make_.template ray<T>(across, down, lens_point(on_lens.x, on_lens.y));
    }
    /// How many pairs of the camera's numbers its rays depend on.
    std::uint32_t pairs() const { return make_.has_lens() ? 2 : 1; }

private:
    RayMaker make_;
    int width_;
    PixelFilter filter_;
    Sampler sampler_;
    std::uint64_t seed_;
};

/// The starts of many paths at once: those that PathCamera makes, whose numbers cost less so.
template <std::floating_point T>
class PathStartBatch {
public:
    /// For up to so many paths. Borrows the camera.
    PathStartBatch(const PathCamera& camera, std::size_t most)
        : camera_(camera), numbers_(most, camera.pairs()) {
        paths_.reserve(most);
    }

    void clear() { paths_.clear(), numbers_.clear(); }
    void add(const PixelSample& of) {
        paths_.push_back({of, camera_.samples_of(of)});
        numbers_.add(paths_.back().samples, 0);
    }
    /// Computes the numbers of all paths that were added.
    void compute() { numbers_.compute(); }
    /// The i-th path that was added.
    PathStart<T> operator[](std::size_t i) const {
        return {camera_.ray<T>(paths_[i].of, numbers_.at_camera(i)), paths_[i].samples};
    }

private:
    struct Path {
        PixelSample of;
        PathSamples samples;
    };
    const PathCamera& camera_;
    std::vector<Path> paths_;
    SampleBatch numbers_;
};

}  // namespace hedgerow
