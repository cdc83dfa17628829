/// Takes noise out of pictures whose pixels are means of random samples. The component `render` has it
/// compiled.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <hedgerow/geometry/vec.h>
#include <hedgerow/parallel/by.h>
#include <hedgerow/parallel/progress.h>

namespace hedgerow {

/// A picture with noise, by rows from the top left. Everything is borrowed.
///
/// Each pixel's samples come in two halves that are independent of each other: what one half says about the
/// noise of the other is then unbiased.
struct NoisyPicture {
    int width = 0, height = 0;
    /// Linear light: the mean of each half of a pixel's samples.
    std::array<std::span<const Vec3f>, 2> light;
    /// The variance of these means, all colours averaged: the squares of `LightSums::standard_error`, so each
    /// half needs at least two samples. Only its shape counts, not its level, which is taken from the
    /// difference of the halves; so it may assume that samples are independent where they are spread evenly.
    std::array<std::span<const float>, 2> variance;
    /// What is seen first (FirstSurface). Albedo and normal are means over a pixel, 0 where nothing is hit.
    /// Depth is infinite there. Each may be empty, which makes textures and edges less sharp.
    std::span<const Vec3f> albedo, normal;
    std::span<const float> depth;
};

struct DenoiserOptions {
    /// Pixels draw on neighbours up to so far away in x and y, from 1 to 10. The time grows with its square.
    int radius = 5;
    /// How much lights of neighbours may differ, in units of what their noise explains. More is smoother and
    /// may lose faint shadows.
    float light_tolerance = 1.7f;
    /// How much features of neighbours may differ, in units of a step that would be seen.
    float feature_tolerance = 3;
    /// By which threads. What is answered does not depend on them.
    Threads threads = {};
};

/// The linear light of a picture with less noise. Bits are the same with any executor, processor and
/// compiler.
///
/// The light of a pixel is predicted by a local linear model of albedo, normal, depth and position, fitted to
/// its neighbours (Bitterli et al. 2016, Nonlinearly Weighted First-Order Regression for Denoising Monte
/// Carlo Renderings, EGSR). Neighbours count by how alike small patches of light around them are (non-local
/// means: Rousselle, Knaus, Zwicker 2012, Adaptive Rendering with Non-Local Means Filtering, SIGGRAPH Asia)
/// and how alike their features are (Rousselle, Manzi, Zwicker 2013, Robust Denoising using Feature and Color
/// Information, Pacific Graphics). The likeness of one half of the samples decides what neighbours of the
/// other half count, so noise does not select itself. At last each pixel is mixed with its own samples, by
/// the share of their squared difference that noise does not explain (James and Stein 1961), so detail that
/// no neighbour predicts stays, with its noise.
///
/// Light is never negative. Pixels without variance whose halves agree stay as they are, unless they are
/// black, which may be by chance. A half that is far brighter than the other and than its neighbours is cut
/// off, which takes about a hundredth of the light of a picture that is full of such samples.
///
/// O(pixels · radius²): about 4 µs a pixel and thread at a radius of 5. Takes 160 bytes a pixel. Throws
/// InputError for sizes that do not match, options out of range, values that are no numbers, light, albedo or
/// normals that are not finite, and negative light, variances or depths; Cancelled if `progress`, which
/// counts pixels, is cancelled.
std::vector<Vec3f> denoised(const NoisyPicture& picture, const DenoiserOptions& options = {},
                            const Progress& progress = {});

}  // namespace hedgerow
