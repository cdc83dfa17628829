/// Sums of samples of light by pixel, in double: their mean, and how far it may be off.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// Threads may add to different pixels at once. A pixel's samples must be added in their order, so that sums
/// have the same bits whatever the threads do.
class LightSums {
public:
    struct Pixel {
        Vec3d sum;
        double squares = 0;  ///< of the mean of the colours
        std::uint32_t samples = 0, dropped = 0;
    };
    static_assert(sizeof(Pixel) == 40, "without gaps, so that sums can be stored byte by byte");

    explicit LightSums(std::size_t pixels) : pixels_(pixels) {}
    /// Goes on from sums that were stored.
    explicit LightSums(std::vector<Pixel> pixels) : pixels_(std::move(pixels)) {}
    const std::vector<Pixel>& pixels() const { return pixels_; }

    /// Adds a sample. One that is not finite counts as black, and as dropped.
    void add(std::size_t pixel, const Vec3f& light) {
        Pixel& p = pixels_[pixel];
        ++p.samples;
        if (!finite(light)) {
            ++p.dropped;
            return;
        }
        const Vec3d added(light);
        const double mean = (added[0] + added[1] + added[2]) / 3;
        p.sum = p.sum + added;
        p.squares += product(mean, mean);
    }

    std::size_t size() const { return pixels_.size(); }
    std::uint32_t samples(std::size_t pixel) const { return pixels_[pixel].samples; }
    /// Samples of a pixel that were not finite.
    std::uint32_t dropped(std::size_t pixel) const { return pixels_[pixel].dropped; }
    /// The mean of a pixel's samples; 0 of none.
    Vec3f mean(std::size_t pixel) const { return Vec3f(mean_in_double(pixel)); }
    Vec3d mean_in_double(std::size_t pixel) const {
        const Pixel& p = pixels_[pixel];
        return p.samples > 0 ? p.sum / static_cast<double>(p.samples) : Vec3d();
    }
    /// The variance of one of a pixel's samples, all colours averaged, if they are independent. 0 of fewer
    /// than two.
    double variance(std::size_t pixel) const {
        const Pixel& p = pixels_[pixel];
        if (p.samples < 2) return 0;
        const double n = p.samples, mean = (p.sum[0] + p.sum[1] + p.sum[2]) / 3 / n;
        const double variance = (p.squares / n - product(mean, mean)) * (n / (n - 1));
        return variance > 0 ? variance : 0;
    }
    /// The standard error of the mean of a pixel's samples, all colours averaged, if they are independent.
    /// Samples that are spread evenly err less. 0 of fewer than two.
    float standard_error(std::size_t pixel) const {
        const std::uint32_t n = pixels_[pixel].samples;
        return n > 1 ? static_cast<float>(std::sqrt(variance(pixel) / n)) : 0;
    }

private:
    std::vector<Pixel> pixels_;
};

}  // namespace hedgerow
