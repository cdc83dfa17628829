/// How the samples of a picture are divided among its pixels.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <hedgerow/render/film/around.h>
#include <hedgerow/render/film/light_halves.h>

namespace hedgerow {

/// How much the samples of each pixel differ: their standard deviation as a share of the light, as
/// LightHalves::noise counts it, over the pixel and its neighbours. A few samples know little of a pixel, and
/// neighbours are mostly alike. By rows; the picture has `width` pixels a row. Pixels have at least a
/// twentieth of the mean, since few samples may all miss what is rare. O(pixels).
inline std::vector<float> spreads(const LightSums& light, int width) {
    const int height = width > 0 ? static_cast<int>(light.size() / static_cast<std::size_t>(width)) : 0;
    std::vector<float> own(light.size()), all;
    for (std::size_t i = 0; i < own.size(); ++i) {
        const double mean = LightHalves::grey(light.mean_in_double(i));
        own[i] = static_cast<float>(
            std::sqrt(light.variance(i) / (product(mean, mean) + LightHalves::least_light)));
    }
    double sum = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            float around = 0, count = 0;
            for_each_around(x, y, width, height, [&](std::size_t i) { around += own[i], count += 1; });
            all.push_back(around / count);
            sum += static_cast<double>(all.back());
        }
    const auto least = static_cast<float>(sum / static_cast<double>(all.size()) / 20);
    for (float& s : all) s = std::max(s, least);
    return all;
}

/// Numbers of samples in proportion to spreads, which minimises the picture's mean variance (Neyman 1934),
/// but at least `least` a pixel. More samples on the mean are more or as many in each pixel.
class Allocation {
public:
    /// Borrows the spreads, which are not negative; if none is above 0, all pixels have the mean. O(pixels)
    /// and few passes over them.
    Allocation(std::span<const float> spreads, std::uint32_t least, std::uint32_t mean)
        : spreads_(spreads), least_(least), mean_(std::max(least, mean)) {
        const double all = static_cast<double>(mean_) * static_cast<double>(spreads.size());
        scale_ = all / std::max(sum_above(0).sum, 1e-300);
        // Pixels that would get too few get the least. The others share the rest, so that their shares are
        // smaller, and some more of them may get too few.
        for (std::size_t with_least = 0;;) {
            const Above above = sum_above(least / scale_);
            const std::size_t few = spreads.size() - above.pixels;
            if (few == with_least || above.pixels == 0) return;
            with_least = few;
            scale_ = (all - static_cast<double>(few) * least) / above.sum;
        }
    }
    std::uint32_t operator[](std::size_t pixel) const {
        if (!(scale_ < 1e200)) return mean_;
        const double n = scale_ * static_cast<double>(spreads_[pixel]) + 0.5;
        return n > least_ ? static_cast<std::uint32_t>(std::min(n, 2147483647.0)) : least_;
    }

private:
    struct Above {
        double sum = 0;
        std::size_t pixels = 0;
    };
    /// The sum of the spreads above a limit.
    Above sum_above(double limit) const {
        Above above;
        for (const float s : spreads_)
            if (static_cast<double>(s) > limit) above.sum += static_cast<double>(s), ++above.pixels;
        return above;
    }

    std::span<const float> spreads_;
    std::uint32_t least_, mean_;
    double scale_ = 0;  // samples by spread
};

}  // namespace hedgerow
