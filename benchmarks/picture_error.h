/// How far a picture is from another that is nearly right.
#pragma once

#include <cmath>
#include <cstddef>

#include <hedgerow/render/integrators/path_picture.h>

namespace hedgerow {

struct PictureError {
    double bias;  ///< of the mean light, as a share of it
    double root;  ///< of the mean over pixels of (x − r)² / (r² + m² / 100), where r is right and m its mean
};

/// The error of the grey of a picture.
inline PictureError error_of(const PathPicture& picture, const PathPicture& right) {
    const auto grey = [](const PathPicture& p, std::size_t i) {
        const Vec3d light(p.light.mean(i));
        return (light[0] + light[1] + light[2]) / 3;
    };
    const std::size_t pixels = right.light.size();
    double mean = 0, difference = 0, squares = 0;
    for (std::size_t i = 0; i < pixels; ++i) mean += grey(right, i) / double(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        const double r = grey(right, i), d = grey(picture, i) - r;
        difference += d, squares += d * d / (r * r + mean * mean / 100);
    }
    return {difference / double(pixels) / mean, std::sqrt(squares / double(pixels))};
}

}  // namespace hedgerow
