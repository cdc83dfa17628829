/// The film: sums of light by pixel, the layers beside them, and how they become a picture.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <hedgerow/render/film/colour.h>
#include <hedgerow/render/film/seen.h>
#include <hedgerow/render/visibility/visibility.h>

namespace hedgerow {

/// A finished picture, or what of it was finished.
struct Picture {
    Image image;
    PictureCosts costs;
    bool whole = true;         ///< whether all pixels have all their samples
    std::uint64_t pixels = 0;  ///< in finished rows
    /// Statistics of a heat map's values over the finished rows: their mean and greatest value, and how many
    /// are beyond the scale.
    double mean = 0, most = 0;
    std::uint64_t beyond = 0;
    /// Empty unless layers were asked for. The colours as linear light, not clamped; for heat maps the value
    /// in all three components.
    std::vector<Vec3f> light;
    std::vector<Seen> seen;

    /// The layers for `save_exr`. They borrow from this picture.
    Layers layers() const& { return layers_of(image.width, image.height, light, seen); }
    Layers layers() const&& = delete;
};

/// How values become the colours of a heat map.
struct HeatScale {
    std::uint64_t top = 0;  ///< 0: the greatest value in the picture
    bool logarithmic = false;
};

/// Light and layers by pixel. Threads may write to different rows at once.
class Film {
public:
    Film(int width, int height, bool layers)
        : width_(width),
          height_(height),
          light_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
          seen_(layers ? light_.size() : 0),
          samples_(static_cast<std::size_t>(height)) {}

    int width() const { return width_; }
    int height() const { return height_; }
    bool has_layers() const { return !seen_.empty(); }
    std::size_t pixel(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }
    /// The sum of a pixel's light over its samples.
    Vec3f& light(std::size_t pixel) { return light_[pixel]; }
    /// A pixel's layers; there are some if `has_layers`.
    Seen& seen(std::size_t pixel) { return seen_[pixel]; }
    /// Says that each pixel of some rows now has this many samples. Rows without samples are not finished.
    void finish_rows(int top, int rows, int samples) { std::fill_n(samples_.begin() + top, rows, samples); }
    /// Forgets all light and layers of some rows.
    void clear_rows(int top, int rows) {
        const std::size_t begin = pixel(0, top), count = pixel(0, top + rows) - begin;
        std::fill_n(&light_[begin], count, Vec3f());
        if (has_layers()) std::fill_n(&seen_[begin], count, Seen());
    }

    /// Whether all rows have this many samples.
    bool has(int samples) const {
        return std::all_of(samples_.begin(), samples_.end(), [&](int s) { return s >= samples; });
    }

    /// Makes the picture: each pixel's mean. Takes the film's memory for its layers.
    Picture develop() && {
        Picture picture = averaged();
        for_each_finished([&](std::size_t p) { picture.image.pixels[p] = srgb(light_[p]); });
        return with_layers(std::move(picture));
    }
    /// Makes a heat map of the means, and draws its scale beside it.
    Picture develop_heat(const HeatScale& heat_scale) && {
        Picture picture = averaged();
        for_each_finished([&](std::size_t p) {
            const float value = light_[p][0];
            picture.most = std::max(picture.most, double(value));
            picture.mean += double(value);
            picture.beyond += heat_scale.top > 0 && value > static_cast<float>(heat_scale.top);
        });
        picture.mean /= double(std::max<std::uint64_t>(picture.pixels, 1));
        const ColourScale scale{
            heat_scale.top > 0 ? heat_scale.top : static_cast<std::uint64_t>(std::ceil(picture.most)),
            heat_scale.logarithmic};
        for_each_finished([&](std::size_t p) { picture.image.pixels[p] = heat(scale.at(light_[p][0])); });
        draw_colour_bar(picture.image, scale);
        return with_layers(std::move(picture));
    }

private:
    /// Turns sums into means.
    Picture averaged() {
        Picture picture;
        picture.image = Image(width_, height_);
        for (int y = 0; y < height_; ++y) {
            const int samples = samples_[static_cast<std::size_t>(y)];
            if (samples == 0) continue;
            for (int x = 0; x < width_; ++x)
                light_[pixel(x, y)] = light_[pixel(x, y)] / static_cast<float>(samples);
            picture.pixels += static_cast<std::uint64_t>(width_);
        }
        return picture;
    }
    template <class F>
    void for_each_finished(F f) const {
        for (int y = 0; y < height_; ++y)
            if (samples_[static_cast<std::size_t>(y)] > 0)
                for (int x = 0; x < width_; ++x) f(pixel(x, y));
    }
    Picture with_layers(Picture picture) {
        if (has_layers()) picture.light = std::move(light_), picture.seen = std::move(seen_);
        return picture;
    }

    int width_, height_;
    std::vector<Vec3f> light_;
    std::vector<Seen> seen_;
    std::vector<int> samples_;  // by row
};

}  // namespace hedgerow
