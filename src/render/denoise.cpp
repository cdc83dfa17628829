#include <hedgerow/render/film/denoise.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>

#include <hedgerow/base/error.h>
#include <hedgerow/render/film/around.h>

#include "local_models.h"

namespace hedgerow {

namespace {

constexpr int colours = 3;
constexpr int levels = 5;               // the radius over which noise and errors are averaged
constexpr float seen_step = 1e-3f;      // smaller squared steps of features do not matter
constexpr float brightest = 1.5f;       // a half that is so many times brighter than its like is cut off
constexpr float most_level = 4;         // how far the halves may raise a variance
constexpr float told_from_none = 0.2f;  // the least squared error that counts, in units of the noise
constexpr float far_outside = 1e15f;    // the nearness of pixels beyond the picture
constexpr float dark = 0.01f;           // squared light below which errors are not relative to it

std::size_t pixels(const NoisyPicture& p) {
    return static_cast<std::size_t>(p.width) * static_cast<std::size_t>(p.height);
}
bool is_light(const Vec3f& c) {
    return finite(c) && c[0] >= 0 && c[1] >= 0 && c[2] >= 0;
}
void check(const NoisyPicture& p, const DenoiserOptions& o) {
    if (p.width < 1 || p.height < 1) throw InputError("a picture needs at least one pixel");
    const auto whole = [&](const auto& layer) { return layer.size() == pixels(p); };
    for (std::size_t h = 0; h < 2; ++h) {
        if (!whole(p.light[h]) || !whole(p.variance[h]))
            throw InputError("light and variance need one entry a pixel");
        if (!std::ranges::all_of(p.light[h], is_light))
            throw InputError("light must be finite and at least 0");
        if (!std::ranges::all_of(p.variance[h], [](float v) { return v >= 0; }))
            throw InputError("a variance must be at least 0");
    }
    const auto fits = [&](const auto& layer) { return layer.empty() || whole(layer); };
    if (!fits(p.albedo) || !fits(p.normal) || !fits(p.depth))
        throw InputError("albedo, normal and depth need one entry a pixel, or none");
    const auto is_finite = [](const Vec3f& v) { return finite(v); };
    if (!std::ranges::all_of(p.albedo, is_finite) || !std::ranges::all_of(p.normal, is_finite))
        throw InputError("albedo and normal must be finite");
    if (!std::ranges::all_of(p.depth, [](float d) { return d >= 0; }))
        throw InputError("a depth must be at least 0");
    if (o.radius < 1 || o.radius > 10) throw InputError("the radius of a denoiser must be from 1 to 10");
    for (const float tolerance : {o.light_tolerance, o.feature_tolerance})
        if (!(tolerance >= 0.01f && tolerance <= 1000))
            throw InputError("the tolerances of a denoiser must be from 0.01 to 1000");
}

float brightness(const Vec3f& c) {
    return c[0] + c[1] + c[2];
}
/// A power of two that scales the mean light of a picture to about 1; 0 for a black picture.
float scale_of(const NoisyPicture& p) {
    double sum = 0;
    for (const auto& half : p.light)
        for (const Vec3f& c : half)
            sum += static_cast<double>(c[0]) + static_cast<double>(c[1]) + static_cast<double>(c[2]);
    const double mean = sum / (6 * static_cast<double>(pixels(p)));
    return mean > 0 ? static_cast<float>(std::ldexp(1.0, std::clamp(-std::ilogb(mean), -120, 120))) : 0;
}

class Denoising {
public:
    Denoising(const NoisyPicture& p, const DenoiserOptions& o, float scale, Executor& executor)
        : p_(p), o_(o), scale_(scale), executor_(executor) {
        load_light();
        load_variances();
        load_features();
    }

    /// Predicts every pixel from its neighbours, once for each half.
    void predict(const Progress& progress) {
        using Tile = LocalModels::Tile;
        constexpr int wide = LocalModels::tile_width, high = LocalModels::tile_height;
        const int columns = (p_.width + wide - 1) / wide, rows = (p_.height + high - 1) / high;
        const LocalModels models(planes_, o_);
        std::atomic<std::uint64_t> done{0};
        const auto tiles = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
        executor_.for_each_piece(tiles, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                progress.look();
                const int left = static_cast<int>(i) % columns * wide,
                          top = static_cast<int>(i) / columns * high;
                const Tile tile{left, top, std::min(wide, p_.width - left), std::min(high, p_.height - top)};
                models.predict(tile, prediction_);
                const std::uint64_t count =
                    static_cast<std::uint64_t>(tile.width) * static_cast<std::uint64_t>(tile.height);
                progress(done += count, pixels(p_));
            }
        });
    }

    /// Mixes predictions with the samples of each pixel.
    std::vector<Vec3f> mixed() const {
        Plane error = plane(), noise = plane();
        error.for_each_pixel(executor_,
                             [&](int x, int y) { measure(x, y, *error.at(x, y), *noise.at(x, y)); });
        error.mirror(), noise.mirror();
        const Plane errors = box_mean(error, levels, executor_), noises = box_mean(noise, levels, executor_);
        std::vector<Vec3f> all(pixels(p_));
        error.for_each_pixel(executor_, [&](int x, int y) {
            const std::size_t i = number(x, y);
            // A pixel without noise stays. A black one may have missed the light by chance.
            if (p_.variance[0][i] == 0 && p_.variance[1][i] == 0 && p_.light[0][i] == p_.light[1][i] &&
                brightness(p_.light[0][i]) > 0) {
                all[i] = p_.light[0][i];
                return;
            }
            const float n = *noises.at(x, y),
                        e = std::max(0.f, *errors.at(x, y) - product(told_from_none, n));
            const float own = n > 0 ? e / (e + n) : 1;
            for (int c = 0; c < colours; ++c) {
                const float predicted = mean(prediction_, c, x, y), sampled = mean(planes_.light, c, x, y);
                const float light = product(own, sampled) + product(1 - own, predicted);
                all[i][c] = std::min(light / scale_, std::numeric_limits<float>::max());
            }
        });
        return all;
    }

private:
    Plane plane() const { return {p_.width, p_.height}; }
    Colour colour() const { return {plane(), plane(), plane()}; }
    std::size_t number(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(p_.width) + static_cast<std::size_t>(x);
    }
    static float mean(const std::array<Colour, 2>& halves, int c, int x, int y) {
        const auto k = static_cast<std::size_t>(c);
        return product(*halves[0][k].at(x, y) + *halves[1][k].at(x, y), 0.5f);
    }

    /// The share of a half's light at a pixel that is kept: 1 unless it is much brighter than the other half
    /// and than all but three of the halves of neighbours.
    float share_kept(std::size_t half, int x, int y) const {
        const float own = brightness(p_.light[half][number(x, y)]);
        const float other = brightness(p_.light[1 - half][number(x, y)]);
        if (!(own > product(brightest, other))) return 1;
        std::array<float, 18> near;
        std::size_t count = 0;
        for_each_around(x, y, p_.width, p_.height, [&](std::size_t i) {
            for (const auto& light : p_.light) near[count++] = brightness(light[i]);
        });
        const std::size_t rank = std::min<std::size_t>(3, count - 1);
        std::nth_element(near.begin(), near.begin() + rank, near.begin() + count, std::greater<>());
        const float limit = product(brightest, std::max(other, near[rank]));
        return own > limit ? limit / own : 1;
    }
    void load_light() {
        for (std::size_t h = 0; h < 2; ++h) {
            spread_[h].for_each_pixel(executor_, [&](int x, int y) {
                const std::size_t i = number(x, y);
                const float factor = product(share_kept(h, x, y), scale_);
                for (int c = 0; c < colours; ++c)
                    *planes_.light[h][static_cast<std::size_t>(c)].at(x, y) =
                        product(p_.light[h][i][c], factor);
                *spread_[h].at(x, y) = std::min(product(product(p_.variance[h][i], factor), factor), 1e20f);
            });
            for (Plane& c : planes_.light[h]) c.mirror();
        }
    }
    /// The variance by colour: that of all colours, at the level that the difference of the halves shows.
    void load_variances() {
        Plane sum = plane(), square = plane();
        sum.for_each_pixel(
            executor_, [&](int x, int y) { *sum.at(x, y) = *spread_[0].at(x, y) + *spread_[1].at(x, y); });
        sum.mirror();
        const Plane sums = box_mean(sum, levels, executor_);
        for (std::size_t c = 0; c < colours; ++c) {
            square.for_each_pixel(executor_, [&](int x, int y) {
                const float difference = *planes_.light[0][c].at(x, y) - *planes_.light[1][c].at(x, y);
                *square.at(x, y) = product(difference, difference);
            });
            square.mirror();
            const Plane seen = box_mean(square, levels, executor_);
            for (std::size_t h = 0; h < 2; ++h) {
                planes_.variance[h][c].for_each_pixel(executor_, [&](int x, int y) {
                    const float said = *sums.at(x, y);
                    const float level = said > 0 ? std::min(most_level, *seen.at(x, y) / said) : 0;
                    *planes_.variance[h][c].at(x, y) = product(*spread_[h].at(x, y), level);
                });
                planes_.variance[h][c].mirror();
            }
        }
    }
    /// Nearness is the inverse of depth, in units of its mean: planes have linear nearness in a picture.
    void load_features() {
        double sum = 0, hits = 0;
        for (const float d : p_.depth)
            if (d < std::numeric_limits<float>::infinity()) sum += 1 / std::max(double(d), 1e-30), ++hits;
        const double unit = sum > 0 ? hits / sum : 0;
        for (std::size_t k = 0; k < DenoiserPlanes::features; ++k) {
            planes_.feature[k].for_each_pixel(executor_, [&](int x, int y) {
                const std::size_t i = number(x, y);
                float& value = *planes_.feature[k].at(x, y);
                const auto axis = static_cast<int>(k % 3);
                if (k < 3)
                    value = p_.albedo.empty() ? 0 : std::clamp(p_.albedo[i][axis], -1e3f, 1e3f);
                else if (k < 6)
                    value = p_.normal.empty() ? 0 : std::clamp(p_.normal[i][axis], -1e3f, 1e3f);
                else if (!p_.depth.empty())
                    value = static_cast<float>(std::min(1e3, unit / std::max(double(p_.depth[i]), 1e-30)));
            });
            planes_.feature[k].mirror();
            load_precision(planes_.feature[k], planes_.precision[k]);
        }
        planes_.feature[DenoiserPlanes::features - 1].surround(far_outside);
    }
    /// How much squared steps of a feature count: less where it changes steadily anyway.
    void load_precision(const Plane& feature, Plane& precision) {
        precision.for_each_pixel(executor_, [&](int x, int y) {
            const auto slope = [&](int dx, int dy) {
                const float here = *feature.at(x, y);
                const float step = std::min(std::abs(*feature.at(x + dx, y + dy) - here),
                                            std::abs(here - *feature.at(x - dx, y - dy)));
                return product(step, step);
            };
            const float least = std::max(seen_step, slope(1, 0) + slope(0, 1));
            *precision.at(x, y) = 1 / product(product(o_.feature_tolerance, o_.feature_tolerance), least);
        });
    }

    /// Estimates of the squared error of a pixel's prediction and of the variance of its samples, relative to
    /// its light.
    void measure(int x, int y, float& error, float& noise) const {
        float light = 0, e = 0, n = 0;
        for (int c = 0; c < colours; ++c) light += mean(prediction_, c, x, y) / colours;
        for (std::size_t c = 0; c < colours; ++c) {
            for (std::size_t h = 0; h < 2; ++h) {
                // A prediction differs from the other half's samples by its error and their noise.
                const float off = *prediction_[h][c].at(x, y) - *planes_.light[1 - h][c].at(x, y);
                const float variance = *planes_.variance[1 - h][c].at(x, y);
                e += product(product(off, off) - variance, 0.5f), n += product(variance, 0.25f);
            }
            // The mean of both predictions has half of their variance.
            const float apart = *prediction_[0][c].at(x, y) - *prediction_[1][c].at(x, y);
            e -= product(product(apart, apart), 0.25f);
        }
        const float unit = product(light, light) + dark;
        error = e / unit, noise = n / unit;
    }

    const NoisyPicture& p_;
    const DenoiserOptions& o_;
    const float scale_;
    Executor& executor_;
    DenoiserPlanes planes_{plane(), colour()};
    /// By half, the variance of the mean of all colours, and the light that this half's neighbours predict.
    std::array<Plane, 2> spread_{plane(), plane()};
    std::array<Colour, 2> prediction_{colour(), colour()};
};

}  // namespace

std::vector<Vec3f> denoised(const NoisyPicture& p, const DenoiserOptions& o, const Progress& progress) {
    check(p, o);
    const float scale = scale_of(p);
    if (scale == 0) return {p.light[0].begin(), p.light[0].end()};
    Denoising denoising(p, o, scale, o.threads.over(p.light[0].size()));
    denoising.predict(progress);
    return denoising.mixed();
}

}  // namespace hedgerow
