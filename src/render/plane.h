/// One number for each pixel of a picture, with a border.
#pragma once

#include <cstddef>
#include <vector>

#include <hedgerow/geometry/lanes.h>
#include <hedgerow/parallel/executor.h>

namespace hedgerow {

/// Numbers by pixel. A border of pixels mirrors the picture, so that neighbours exist everywhere, and rows
/// are long enough that the last four lanes of each may be read and written.
class Plane {
public:
    static constexpr int border = 14;  ///< pixels on each side, at least

    Plane(int width, int height)
        : width_(width),
          height_(height),
          stride_(static_cast<std::size_t>(width) + 2 * border + lanes),
          numbers_(stride_ * (static_cast<std::size_t>(height) + 2 * border)) {}

    int width() const { return width_; }
    int height() const { return height_; }
    /// Pixel (x, y), which may be in the border.
    float* at(int x, int y) { return &numbers_[index(x, y)]; }
    const float* at(int x, int y) const { return &numbers_[index(x, y)]; }

    /// Fills the border with the mirrored picture: pixel −1 is pixel 0.
    void mirror() {
        for (int y = -border; y < height_ + border; ++y)
            for (int x = -border; x < width_ + border + lanes; ++x)
                if (x < 0 || x >= width_ || y < 0 || y >= height_)
                    *at(x, y) = *at(mirrored(x, width_), mirrored(y, height_));
    }
    /// Fills the border with a number.
    void surround(float number) {
        for (int y = -border; y < height_ + border; ++y)
            for (int x = -border; x < width_ + border + lanes; ++x)
                if (x < 0 || x >= width_ || y < 0 || y >= height_) *at(x, y) = number;
    }
    /// Calls f(x, y) for all pixels of the picture.
    template <class F>
    void for_each_pixel(Executor& executor, F f) const {
        executor.for_each_piece(static_cast<std::size_t>(height_), 16,
                                [&](std::size_t begin, std::size_t end) {
                                    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                                        for (int x = 0; x < width_; ++x) f(x, y);
                                });
    }

private:
    static constexpr int lanes = 4;

    static int mirrored(int i, int size) {
        const int period = 2 * size, rest = (i % period + period) % period;
        return rest < size ? rest : period - 1 - rest;
    }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y + border) * stride_ + static_cast<std::size_t>(x + border);
    }

    int width_, height_;
    std::size_t stride_;
    std::vector<float> numbers_;
};

/// The mean of each pixel's square of neighbours up to `radius` away. The border of `plane` must be mirrored;
/// that of the result is not.
inline Plane box_mean(const Plane& plane, int radius, Executor& executor) {
    const int width = plane.width(), side = 2 * radius + 1;
    const auto share = Lanes<float>::all(1 / static_cast<float>(side * side));
    Plane mean(width, plane.height());
    executor.for_each_piece(
        static_cast<std::size_t>(plane.height()), 16, [&](std::size_t begin, std::size_t end) {
            std::vector<float> columns(static_cast<std::size_t>(width + side + 8));
            for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                for (int x = 0; x < width + side - 1; x += 4) {
                    auto sum = Lanes<float>::all(0);
                    for (int dy = -radius; dy <= radius; ++dy)
                        sum = sum + Lanes<float>::load(plane.at(x - radius, y + dy));
                    sum.store(&columns[static_cast<std::size_t>(x)]);
                }
                for (int x = 0; x < width; x += 4) {
                    auto sum = Lanes<float>::all(0);
                    for (int dx = 0; dx < side; ++dx)
                        sum = sum + Lanes<float>::load(&columns[std::size_t(x) + std::size_t(dx)]);
                    (sum * share).store(mean.at(x, y));
                }
            }
        });
    return mean;
}

}  // namespace hedgerow
