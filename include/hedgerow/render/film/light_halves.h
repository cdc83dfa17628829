/// The light of a picture, whose samples may be in two halves that know nothing of each other.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <hedgerow/geometry/vec.h>
#include <hedgerow/render/film/light_sums.h>

namespace hedgerow {

/// Sums of light by pixel, in two halves with equal weights, or all in the first. Where the halves have
/// independent samples, their difference tells how far the mean is off. And where the number of samples in
/// one hangs on the other alone, no mean is biased by it. Threads may add to different pixels at once.
class LightHalves {
public:
    explicit LightHalves(std::size_t pixels) : halves_{LightSums(pixels), LightSums(pixels)} {}

    std::size_t size() const { return halves_[0].size(); }
    LightSums& half(int k) { return halves_[static_cast<std::size_t>(k)]; }
    const LightSums& half(int k) const { return halves_[static_cast<std::size_t>(k)]; }

    std::uint32_t samples(std::size_t pixel) const {
        return halves_[0].samples(pixel) + halves_[1].samples(pixel);
    }
    /// Samples of a pixel that were not finite.
    std::uint32_t dropped(std::size_t pixel) const {
        return halves_[0].dropped(pixel) + halves_[1].dropped(pixel);
    }
    /// The mean of a pixel's samples, with equal weights of the halves that have any; 0 of none.
    Vec3f mean(std::size_t pixel) const { return Vec3f(mean_in_double(pixel)); }
    /// The standard error of the mean, all colours averaged, if the samples are independent. Samples that are
    /// spread evenly err less. 0 if a half has a single sample.
    float standard_error(std::size_t pixel) const {
        const float a = halves_[0].standard_error(pixel);
        if (halves_[1].samples(pixel) == 0) return a;
        const float b = halves_[1].standard_error(pixel);
        return std::sqrt(product(a, a) + product(b, b)) / 2;
    }
    /// The noise of the picture: the root of the mean over its pixels of variance/(mean² + 0.01), all colours
    /// averaged, as a share of the light: 0.01 is 1%. Halves show it by their difference. Samples in one half
    /// are taken for independent, which is too much for those that are spread evenly. Infinite where samples
    /// are too few to tell.
    double noise() const {
        double sum = 0;
        for (std::size_t i = 0; i < size(); ++i) {
            const double mean = grey(mean_in_double(i));
            sum += variance(i) / (product(mean, mean) + least_light);
        }
        return std::sqrt(sum / static_cast<double>(size()));
    }

    static double grey(const Vec3d& light) { return (light[0] + light[1] + light[2]) / 3; }
    /// What is added to the square of a pixel's light, so that noise in the dark counts little.
    static constexpr double least_light = 0.01;

private:
    /// An estimate of the variance of a pixel's mean.
    double variance(std::size_t pixel) const {
        const LightSums &a = halves_[0], &b = halves_[1];
        if (a.samples(pixel) == 0) return std::numeric_limits<double>::infinity();
        if (b.samples(pixel) > 0) {
            const double off = (grey(a.mean_in_double(pixel)) - grey(b.mean_in_double(pixel))) / 2;
            return product(off, off);
        }
        if (a.samples(pixel) < 2) return std::numeric_limits<double>::infinity();
        return a.variance(pixel) / a.samples(pixel);
    }
    Vec3d mean_in_double(std::size_t pixel) const {
        const Vec3d first = halves_[0].mean_in_double(pixel);
        if (halves_[1].samples(pixel) == 0) return first;
        const Vec3d second = halves_[1].mean_in_double(pixel);
        return halves_[0].samples(pixel) == 0 ? second : (first + second) / 2.0;
    }

    std::array<LightSums, 2> halves_;
};

}  // namespace hedgerow
