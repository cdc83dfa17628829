/// The samples of a picture: one ray through each pixel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <hedgerow/render/camera/ray_maker.h>
#include <hedgerow/scenes/random.h>

namespace hedgerow {

/// Pixels from the left to the right column and from the top to the bottom row, both included. Empty if the
/// left is beyond the right or the top below the bottom.
struct PixelBox {
    int left = 0, top = 0, right = -1, bottom = -1;

    bool empty() const { return left > right || top > bottom; }
    int width() const { return right - left + 1; }
    int height() const { return bottom - top + 1; }
    std::size_t size() const {
        return empty() ? 0 : static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
    }
    friend bool operator==(const PixelBox&, const PixelBox&) = default;
};

/// One ray through each pixel: through its middle, or through a random point of it. Pixels are numbered by
/// rows from the top left. A ray depends on the camera, the size, the seed and its number alone.
template <class T>
class PictureSamples {
public:
    /// The place of samples in their pixels along either axis, from `least` to `most`.
    struct Within {
        float least, most;
    };

    PictureSamples(const Camera& camera, int width, int height)
        : make_(camera, width, height), width_(width), height_(height) {}
    /// Sample number `sample` of each pixel among `samples`, at a random point of it; of one sample, the
    /// middle.
    PictureSamples(const Camera& camera, int width, int height, std::uint64_t seed, int sample, int samples)
        : PictureSamples(camera, width, height) {
        seed_ = seed, sample_ = sample, samples_ = samples;
    }

    int width() const { return width_; }
    int height() const { return height_; }
    std::size_t size() const { return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_); }
    std::size_t number(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }
    bool in_the_middle() const { return samples_ == 1; }
    Within within_pixel() const { return in_the_middle() ? Within{0.5f, 0.5f} : Within{0, 1}; }
    /// The samples as they are seen in a mirror (RayMaker::in_mirror). Sample i is the reflection of sample
    /// i.
    PictureSamples in_mirror(const FlatMirror& mirror) const {
        PictureSamples seen = *this;
        seen.make_ = make_.in_mirror(mirror);
        return seen;
    }
    bool from_one_eye() const { return make_.from_one_eye(); }
    /// Whether all rays come from one eye or go one way, through a plane, where they begin.
    bool has_plane() const { return make_.has_plane(); }
    PicturePlane plane() const { return make_.plane(); }
    Ray<T, 3> ray(int x, int y) const {
        const auto left = static_cast<float>(x), top = static_cast<float>(y);
        if (in_the_middle() && !make_.has_lens()) return make_.template ray<T>(left + 0.5f, top + 0.5f);
        Random random(seed_, std::uint64_t{number(x, y)} * static_cast<std::uint64_t>(samples_) +
                                 static_cast<std::uint64_t>(sample_));
        const auto next = [&] { return static_cast<float>(random.uniform()); };
        const float dx = in_the_middle() ? 0.5f : next(), dy = in_the_middle() ? 0.5f : next();
        if (!make_.has_lens()) return make_.template ray<T>(left + dx, top + dy);
        const float u = next(), v = next();
        return make_.template ray<T>(left + dx, top + dy, lens_point(u, v));
    }

    /// The rays of all samples, by number.
    std::vector<Ray<T, 3>> rays() const {
        std::vector<Ray<T, 3>> all;
        all.reserve(size());
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) all.push_back(ray(x, y));
        return all;
    }

private:
    RayMaker make_;
    int width_, height_;
    std::uint64_t seed_ = 0;
    int sample_ = 0, samples_ = 1;
};

}  // namespace hedgerow
