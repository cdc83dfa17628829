/// Local models of light in a noisy picture: what the denoiser predicts a pixel's light by.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <hedgerow/render/film/denoise.h>

#include "plane.h"

namespace hedgerow {

using Four = Lanes<float>;  // four pixels side by side
using Colour = std::array<Plane, 3>;

/// A noisy picture, ready for arithmetic on four pixels at once. Light is scaled to a mean of about 1.
struct DenoiserPlanes {
    static constexpr std::size_t features = 7;  ///< albedo, normal, nearness

    std::array<Colour, 2> light, variance;  ///< by half
    std::array<Plane, features> feature;
    /// How much squared steps of a feature count.
    std::array<Plane, features> precision;

    DenoiserPlanes(const Plane& empty, const Colour& colour)
        : light{colour, colour},
          variance{colour, colour},
          feature{empty, empty, empty, empty, empty, empty, empty},
          precision(feature) {}
};

/// The linear models of albedo, normal, nearness and position around each pixel: Bitterli et al. 2016, with
/// weights by the light (Rousselle, Knaus, Zwicker 2012) and features (Rousselle, Manzi, Zwicker 2013). The
/// weights for one half's light come from the other half's.
class LocalModels {
public:
    /// A part of the picture, of at most tile_width by tile_height pixels, whose weights fit the cache.
    struct Tile {
        int left, top, width, height;
    };
    static constexpr int tile_width = 32, tile_height = 16;

    LocalModels(const DenoiserPlanes& planes, const DenoiserOptions& options)
        : planes_(planes), o_(options) {}

    /// Predicts the light of a tile's pixels from their neighbours, by half.
    void predict(const Tile& tile, std::array<Colour, 2>& predictions) const {
        const int side = 2 * o_.radius + 1;
        std::vector<float> weights(static_cast<std::size_t>(2 * side * side * tile_width * tile_height));
        for_each_neighbour([&](int dx, int dy, int i) {
            const TileNumbers steps = feature_distances(tile, dx, dy);
            for (std::size_t h = 0; h < 2; ++h) weigh(tile, h, dx, dy, steps, weights_at(weights, h, i));
        });
        std::vector<Neighbour> neighbours;
        for (std::size_t h = 0; h < 2; ++h)
            for (int y = 0; y < tile.height; ++y)
                for (int x = 0; x < tile.width; x += 4) {
                    gather(tile, h, x, y, weights, neighbours);
                    const int count = std::min(4, tile.width - x);
                    store_fits(neighbours, tile.left + x, tile.top + y, count, predictions[h]);
                }
    }

private:
    static constexpr std::size_t colours = 3, features = DenoiserPlanes::features;
    /// The light at the pixel, and its slopes by feature, x and y.
    static constexpr std::size_t unknowns = 1 + features + 2;
    /// The normal equations: the lower triangle by rows, each row followed by its right sides.
    static constexpr std::size_t coefficients = unknowns * (unknowns + 1) / 2 + colours * unknowns;
    static constexpr std::size_t row_at(std::size_t row) { return row * (row + 1) / 2 + colours * row; }
    /// The radius of the patches whose light is compared.
    static constexpr int patch = 1;
    /// What a variance is at least, in units of the squared mean light.
    static constexpr float no_variance = 1e-6f;
    /// A slope costs as much as variance of its feature adds, so features that vary less explain little.
    static constexpr double slope_cost = 1e-4;

    using TileNumbers = std::array<float, static_cast<std::size_t>(tile_width* tile_height)>;
    /// A neighbour of four pixels: by how much it counts, and what the model is fitted to.
    struct Neighbour {
        Four weight;
        std::array<Four, unknowns> regressors;
        std::array<Four, colours> light;
    };

    /// Calls f(dx, dy, i) for each neighbour, i counting them.
    template <class F>
    void for_each_neighbour(F f) const {
        int i = 0;
        for (int dy = -o_.radius; dy <= o_.radius; ++dy)
            for (int dx = -o_.radius; dx <= o_.radius; ++dx) f(dx, dy, i++);
    }
    static float* weights_at(std::vector<float>& weights, std::size_t half, int neighbour) {
        return &weights[(static_cast<std::size_t>(neighbour) * 2 + half) * tile_width * tile_height];
    }
    static std::size_t in_tile(int x, int y) {
        return static_cast<std::size_t>(y) * tile_width + static_cast<std::size_t>(x);
    }

    /// The largest step of all features to a neighbour, squared.
    TileNumbers feature_distances(const Tile& tile, int dx, int dy) const {
        TileNumbers distances;
        for (int y = 0; y < tile.height; ++y)
            for (int x = 0; x < tile.width; x += 4) {
                const int u = tile.left + x, v = tile.top + y;
                Four most = Four::all(0);
                for (std::size_t k = 0; k < features; ++k) {
                    const Plane& feature = planes_.feature[k];
                    const Four step = Four::load(feature.at(u, v)) - Four::load(feature.at(u + dx, v + dy));
                    most = max(most, step * step * Four::load(planes_.precision[k].at(u, v)));
                }
                most.store(&distances[in_tile(x, y)]);
            }
        return distances;
    }
    /// The squared difference of the light of pixels, less what their noise explains, in units of that noise.
    Four light_distance(std::size_t half, int u, int v, int dx, int dy) const {
        Four sum = Four::all(0);
        for (std::size_t c = 0; c < colours; ++c) {
            const Plane &light = planes_.light[half][c], &variance = planes_.variance[half][c];
            const Four step = Four::load(light.at(u, v)) - Four::load(light.at(u + dx, v + dy));
            const Four here = Four::load(variance.at(u, v)), there = Four::load(variance.at(u + dx, v + dy));
            sum = sum + (step * step - (here + min(here, there))) / (Four::all(no_variance) + here + there);
        }
        return sum;
    }
    /// 1 − d/4 to the fourth power, 0 from d = 4 on: close to exp(−d), and it ends.
    static Four falloff(Four d) {
        const Four x = max(Four::all(0), Four::all(1) - d * Four::all(0.25f)), x2 = x * x;
        return x2 * x2;
    }
    /// The weights of a neighbour of each pixel of a tile, by the light of one half.
    void weigh(const Tile& tile, std::size_t half, int dx, int dy, const TileNumbers& steps,
               float* weights) const {
        constexpr int side = 2 * patch + 1;
        const float count = static_cast<float>(side * side) * static_cast<float>(colours);
        const Four unit = Four::all(1 / product(count, product(o_.light_tolerance, o_.light_tolerance)));
        float of_light[tile_height + 2 * patch][tile_width + 2 * patch + 6];
        for (int y = 0; y < tile.height + 2 * patch; ++y)
            for (int x = 0; x < tile.width + 2 * patch + 3; x += 4)
                light_distance(half, tile.left + x - patch, tile.top + y - patch, dx, dy)
                    .store(&of_light[y][x]);
        for (int y = 0; y < tile.height; ++y)
            for (int x = 0; x < tile.width; x += 4) {
                Four sum = Four::all(0);
                for (int v = 0; v < side; ++v)
                    for (int u = 0; u < side; ++u) sum = sum + Four::load(&of_light[y + v][x + u]);
                falloff(max(sum * unit, Four::load(&steps[in_tile(x, y)]))).store(weights + in_tile(x, y));
            }
    }

    /// Collects the neighbours of four pixels that count.
    void gather(const Tile& tile, std::size_t half, int x, int y, std::vector<float>& weights,
                std::vector<Neighbour>& neighbours) const {
        const int u = tile.left + x, v = tile.top + y;
        const float step = 1 / static_cast<float>(o_.radius);
        neighbours.clear();
        for_each_neighbour([&](int dx, int dy, int i) {
            Neighbour n;
            n.weight = Four::load(weights_at(weights, 1 - half, i) + in_tile(x, y));
            if (n.weight.positive() == 0) return;
            n.regressors[0] = Four::all(1);
            for (std::size_t k = 0; k < features; ++k) {
                const Plane& feature = planes_.feature[k];
                n.regressors[1 + k] = Four::load(feature.at(u + dx, v + dy)) - Four::load(feature.at(u, v));
            }
            n.regressors[unknowns - 2] = Four::all(product(step, static_cast<float>(dx)));
            n.regressors[unknowns - 1] = Four::all(product(step, static_cast<float>(dy)));
            for (std::size_t c = 0; c < colours; ++c)
                n.light[c] = Four::load(planes_.light[half][c].at(u + dx, v + dy));
            neighbours.push_back(n);
        });
    }
    /// Sums up a row of the normal equations. The sums of a row fit the registers.
    template <std::size_t row>
    static void add_row(const std::vector<Neighbour>& neighbours, std::array<Four, coefficients>& sums) {
        std::array<Four, row + 1 + colours> sum;
        sum.fill(Four::all(0));
        for (const Neighbour& n : neighbours) {
            const Four weighted = n.weight * n.regressors[row];
            for (std::size_t k = 0; k <= row; ++k) sum[k] = sum[k] + weighted * n.regressors[k];
            for (std::size_t c = 0; c < colours; ++c)
                sum[row + 1 + c] = sum[row + 1 + c] + weighted * n.light[c];
        }
        std::copy(sum.begin(), sum.end(), sums.begin() + row_at(row));
    }
    /// Fits the models of up to four pixels, and stores what they predict.
    static void store_fits(const std::vector<Neighbour>& neighbours, int u, int v, int count,
                           Colour& predictions) {
        std::array<Four, coefficients> sums;
        [&]<std::size_t... rows>(std::index_sequence<rows...>) {
            (add_row<rows>(neighbours, sums), ...);
        }
        (std::make_index_sequence<unknowns>());
        std::array<std::array<float, 4>, coefficients> by_pixel;
        for (std::size_t k = 0; k < coefficients; ++k) sums[k].store(by_pixel[k].data());
        for (int pixel = 0; pixel < count; ++pixel) {
            std::array<double, coefficients> of_pixel;
            for (std::size_t k = 0; k < coefficients; ++k)
                of_pixel[k] = static_cast<double>(by_pixel[k][static_cast<std::size_t>(pixel)]);
            const Vec3d light = solution(of_pixel);
            for (std::size_t c = 0; c < colours; ++c)
                *predictions[c].at(u + pixel, v) =
                    static_cast<float>(std::max(0.0, light[static_cast<int>(c)]));
        }
    }
    /// The light at the pixel, where all regressors but the first are 0. A pixel is a neighbour of its own,
    /// so the equations always have a solution.
    static Vec3d solution(const std::array<double, coefficients>& sums) {
        double a[unknowns][unknowns], b[unknowns][colours];
        for (std::size_t i = 0; i < unknowns; ++i) {
            for (std::size_t k = 0; k <= i; ++k) a[i][k] = a[k][i] = sums[row_at(i) + k];
            for (std::size_t c = 0; c < colours; ++c) b[i][c] = sums[row_at(i) + i + 1 + c];
        }
        const double cost = product(slope_cost, a[0][0]);
        for (std::size_t i = 1; i < unknowns; ++i) a[i][i] += cost;
        // Eliminate the slopes, the last one first.
        for (std::size_t last = unknowns - 1; last > 0; --last)
            for (std::size_t i = 0; i < last; ++i) {
                const double factor = a[i][last] / a[last][last];
                for (std::size_t k = 0; k < last; ++k) a[i][k] -= product(factor, a[last][k]);
                for (std::size_t c = 0; c < colours; ++c) b[i][c] -= product(factor, b[last][c]);
            }
        return Vec3d(b[0][0], b[0][1], b[0][2]) / a[0][0];
    }

    const DenoiserPlanes& planes_;
    const DenoiserOptions& o_;
};

}  // namespace hedgerow
