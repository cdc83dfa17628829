/// Where the samples of a picture differ so much that more are needed (Mitchell, Generating antialiased
/// images at low sampling densities, SIGGRAPH 1987).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <hedgerow/geometry/vec.h>
#include <hedgerow/render/film/around.h>

namespace hedgerow {

/// The contrast of the samples in and around each pixel: (most − least)/(most + least) by colour. Threads may
/// add to different pixels at once.
class Contrast {
public:
    /// Red, green and blue from which contrast is high: eyes see green best, and blue least.
    static constexpr std::array<float, 3> limits = {0.4f, 0.3f, 0.6f};

    explicit Contrast(std::size_t pixels) : ranges_(pixels) {}

    void add(std::size_t pixel, const Vec3f& light) {
        ranges_[pixel].least = min(ranges_[pixel].least, light);
        ranges_[pixel].most = max(ranges_[pixel].most, light);
    }
    /// Finds the pixels among whose samples, and those of their eight neighbours, contrast is high.
    /// O(pixels).
    void find(int width, int height) {
        high_.clear();
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                Range around;
                for_each_around(x, y, width, height, [&](std::size_t pixel) {
                    around.least = min(around.least, ranges_[pixel].least);
                    around.most = max(around.most, ranges_[pixel].most);
                });
                high_.push_back(around.has_contrast());
            }
    }
    bool is_high(std::size_t pixel) const { return high_[pixel] != 0; }

private:
    /// What light of less than this does is not seen, however it differs.
    static constexpr float darkest = 0.02f;

    struct Range {
        Vec3f least = Vec3f::all(std::numeric_limits<float>::infinity());
        Vec3f most = Vec3f::all(-std::numeric_limits<float>::infinity());

        bool has_contrast() const {
            for (std::size_t k = 0; k < 3; ++k) {
                const float low = least.data[k], high = most.data[k];
                if (high - low > limits[k] * std::max(high + low, darkest)) return true;
            }
            return false;
        }
    };

    std::vector<Range> ranges_;
    std::vector<std::uint8_t> high_;
};

}  // namespace hedgerow
