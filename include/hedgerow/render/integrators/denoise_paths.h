/// Pictures of paths with less noise.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <hedgerow/base/error.h>
#include <hedgerow/render/film/denoise.h>
#include <hedgerow/render/integrators/path_picture.h>

namespace hedgerow {

/// The samples that each half of a pixel needs before its picture can be denoised: fewer have no variance.
inline constexpr std::uint32_t samples_to_denoise = 2;

/// Whether a picture in halves has the samples to be denoised.
inline bool can_be_denoised(const PathPicture& picture) {
    for (std::size_t i = 0; i < picture.light.size(); ++i)
        for (const int half : {0, 1})
            if (picture.light.half(half).samples(i) < samples_to_denoise) return false;
    return true;
}

/// The linear light of a picture whose samples are in halves, with less noise (`denoised` in
/// film/denoise.h), by what is seen first: `first` is what first_surfaces returns for the picture. The
/// picture stays as it is. Throws InputError for a picture that cannot be denoised, and as `denoised` does.
inline std::vector<Vec3f> denoised(const PathPicture& picture, std::span<const FirstSurface> first,
                                   const DenoiserOptions& options = {}, const Progress& progress = {}) {
    if (!can_be_denoised(picture))
        throw InputError("a picture needs two samples in each half of its pixels to be denoised");
    std::array<std::vector<Vec3f>, 2> light;
    std::array<std::vector<float>, 2> variance;
    for (std::size_t h = 0; h < 2; ++h)
        for (std::size_t i = 0; i < picture.light.size(); ++i) {
            const LightSums& half = picture.light.half(static_cast<int>(h));
            const float error = half.standard_error(i);
            light[h].push_back(max(half.mean(i), Vec3f()));
            variance[h].push_back(std::min(error * error, std::numeric_limits<float>::max()));
        }
    std::vector<Vec3f> albedo, normal;
    std::vector<float> depth;
    for (const FirstSurface& f : first)
        albedo.push_back(f.albedo), normal.push_back(f.normal), depth.push_back(f.depth);
    NoisyPicture noisy{picture.width, picture.height, {}, {}, albedo, normal, depth};
    for (std::size_t h = 0; h < 2; ++h) noisy.light[h] = light[h], noisy.variance[h] = variance[h];
    return denoised(noisy, options, progress);
}

}  // namespace hedgerow
