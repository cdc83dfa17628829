/// Ray casting: pictures of any index, in tiles of pixels over an executor.
#pragma once

#include <array>
#include <chrono>
#include <mutex>

#include <hedgerow/any_index.h>
#include <hedgerow/parallel/progress.h>
#include <hedgerow/render/colour.h>
#include <hedgerow/render/seen.h>
#include <hedgerow/render/visibility/samples.h>
#include <hedgerow/surface.h>

namespace hedgerow {

/// How a picture is coloured. The last three show measurements in a heat map: nodes, leaves and primitives
/// visited (steps), primitives tested (tests), nanoseconds (time). For times each ray is timed three times,
/// and the least counts.
enum class Shading { normals, depth, diffuse, steps, tests, time };
constexpr bool counted(Shading s) {
    return s >= Shading::steps;
}

inline Shading parse_shading(std::string_view name) {
    if (name == "normals") return Shading::normals;
    if (name == "depth") return Shading::depth;
    if (name == "steps") return Shading::steps;
    if (name == "tests") return Shading::tests;
    if (name == "time") return Shading::time;
    return Shading::diffuse;
}

struct RenderOptions {
    Camera camera;
    int width = 1024, height = 768, samples = 1;
    Shading shading = Shading::diffuse;
    std::uint64_t seed = 0;
    /// Top of the scale of a heat map; 0: the greatest value in the picture.
    std::uint64_t steps_max = 0;
    /// Whether the scale of a heat map is linear in the logarithm of 1 + the value.
    bool log_scale = false;
    /// Whether the picture stores the hits of its rays, for `Picture::layers`.
    bool layers = false;
    /// Whether the visits of rays are counted, which rules out the kernels. Layers and the shadings `steps`
    /// and `tests` imply it.
    bool counts = false;

    bool counted() const {
        return counts || layers || shading == Shading::steps || shading == Shading::tests;
    }
};

struct Picture {
    Image image;
    std::uint64_t rays = 0;
    Visits visits;  // 0 unless counted
    KernelUse use;  // kernels that answered; none if visits are counted
    /// Statistics of a heat map's values over the finished rows: the number of pixels, their mean and
    /// greatest value, and how many values are beyond the scale.
    std::uint64_t pixels = 0;
    double mean = 0, most = 0;
    std::uint64_t beyond = 0;
    /// Empty unless RenderOptions::layers. The colours as linear light, not clamped; for heat maps the value
    /// in all three components.
    std::vector<Vec3f> light;
    std::vector<Seen> seen;

    /// The layers for `save_exr`. They borrow from this picture.
    Layers layers() const& { return layers_of(image.width, image.height, light, seen); }
    Layers layers() const&& = delete;
};

/// Casts one or more rays a pixel; diffuse shading adds a shadow ray where the surface faces the light. The
/// rays of a tile of pixels are one batch. If the progress is cancelled, rows that are not finished stay
/// black, and their layers empty.
template <class T, class P>
class Raycast {
public:
    Raycast(const AnyIndex<T, 3>& index, const P& primitives, const RenderOptions& o)
        : index_(index),
          primitives_(view_of(primitives)),
          o_(o),
          values_(static_cast<std::size_t>(o.width) * static_cast<std::size_t>(o.height)),
          seen_(o.layers ? values_.size() : 0),
          done_(static_cast<std::size_t>(o.height)),
          light_(light_of(o.camera)),
          diagonal_(
              static_cast<float>(length(index.bounds().empty() ? Vec<T, 3>() : index.bounds().extent()))) {}

    Picture run(Executor& executor, const Progress& progress) {
        const int bands = (o_.height + band_rows - 1) / band_rows;
        std::atomic<std::uint64_t> rows{0};
        executor.for_each_piece(static_cast<std::size_t>(bands), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end && !progress.cancelled(); ++k) {
                const int top = static_cast<int>(k) * band_rows;
                const int height = std::min(band_rows, o_.height - top);
                if (!band(top, height, progress)) return;
                progress(rows += static_cast<std::uint64_t>(height), static_cast<std::uint64_t>(o_.height));
            }
        });
        return develop();
    }

private:
    /// Size of a tile: large enough for the kernels, small enough to be cancelled soon.
    static constexpr int band_rows = 8, tile_columns = 64;
    struct Tile {
        int left, top, width, height;

        std::size_t size() const {
            return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        }
        int x(std::size_t i) const { return left + static_cast<int>(i) % width; }
        int y(std::size_t i) const { return top + static_cast<int>(i) / width; }
    };
    template <class V>
    using OfTile = std::array<V, static_cast<std::size_t>(band_rows) * tile_columns>;
    /// Rays from the eye, one for each pixel of a tile, with their hits and the normals there, which point
    /// to the side of the ray.
    struct Looks {
        OfTile<Ray<T, 3>> rays;
        OfTile<Hit<T>> hits;
        OfTile<Vec3f> normals;
    };
    struct Total {
        Visits visits;
        std::uint64_t rays = 0;
        KernelUse use;
    };

    static Vec3f light_of(const Camera& c) {
        if (length2(c.light) > 0) return normalized(c.light);
        const Vec3f forward = normalized(c.target - c.eye);
        return normalized(c.up + cross(forward, c.up) * 0.5f - forward * 0.35f);
    }
    std::size_t pixel(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(o_.width) + static_cast<std::size_t>(x);
    }

    /// Casts a band of rows, tile by tile. Keeps the rows if all are finished; else clears them and returns
    /// false.
    bool band(int top, int height, const Progress& progress) {
        Total total;
        Tile tile{0, top, 0, height};
        for (; tile.left < o_.width; tile.left += tile.width) {
            tile.width = std::min(tile_columns, o_.width - tile.left);
            if (!see(tile, total, progress)) break;
        }
        // Clear the rows if the last tile was cancelled.
        const bool whole = tile.left == o_.width;
        if (!whole) {
            const auto begin = static_cast<std::ptrdiff_t>(pixel(0, top));
            const auto end = static_cast<std::ptrdiff_t>(pixel(0, top + height));
            std::fill(values_.begin() + begin, values_.begin() + end, Vec3f());
            if (o_.layers) std::fill(seen_.begin() + begin, seen_.begin() + end, Seen());
            return false;
        }
        // Mark the rows as finished, and add up the totals.
        const std::lock_guard lock(mutex_);
        std::fill_n(done_.begin() + top, height, std::uint8_t{1});
        total_.visits += total.visits;
        total_.rays += total.rays;
        total_.use += total.use;
        return true;
    }

    /// Casts every sample of a tile's pixels. Returns false if it was cancelled.
    bool see(const Tile& tile, Total& total, const Progress& progress) {
        OfTile<Visits> visits{};
        for (int sample = 0; sample < o_.samples; ++sample) {
            if (progress.cancelled()) return false;
            look(tile, sample, visits, total);
        }
        // Turn the sums over the samples into means.
        for (std::size_t i = 0; i < tile.size(); ++i) {
            const std::size_t p = pixel(tile.x(i), tile.y(i));
            const Visits& counts = visits[i];
            const auto mean = [&](std::uint64_t all) { return static_cast<float>(double(all) / o_.samples); };
            if (o_.shading == Shading::steps)
                values_[p] = Vec3f::all(mean(counts.nodes + counts.leaves + counts.primitives));
            else if (o_.shading == Shading::tests)
                values_[p] = Vec3f::all(mean(counts.primitives));
            else
                values_[p] = values_[p] / static_cast<float>(o_.samples);
            if (o_.layers) {
                seen_[p].nodes = mean(counts.nodes);
                seen_[p].leaves = mean(counts.leaves);
                seen_[p].primitives = mean(counts.primitives);
            }
            total.visits += counts;
        }
        return true;
    }
    /// Casts one sample of each of a tile's pixels, and adds it to their sums.
    void look(const Tile& tile, int sample, OfTile<Visits>& visits, Total& total) {
        // Find the closest hits of the tile in one batch.
        const std::size_t n = tile.size();
        const PictureSamples<T> samples(o_.camera, o_.width, o_.height, o_.seed, sample, o_.samples);
        Looks looks;
        for (std::size_t i = 0; i < n; ++i) looks.rays[i] = samples.ray(tile.x(i), tile.y(i));
        total.rays += n;
        total.use += index_.closest_hits(std::span(looks.rays).first(n), std::span(looks.hits).first(n),
                                         std::span(visits).first(o_.counted() ? n : 0));
        // Add the colours, and store the layers of the first sample.
        for (std::size_t i = 0; i < n; ++i) {
            const Hit<T>& hit = looks.hits[i];
            if (hit) looks.normals[i] = facing_normal(hit, looks.rays[i]);
            const std::size_t p = pixel(tile.x(i), tile.y(i));
            values_[p] = values_[p] + colour(looks.rays[i], hit, looks.normals[i]);
            if (o_.layers && sample == 0 && hit) {
                seen_[p].depth = static_cast<float>(hit.t);  // directions have length 1
                seen_[p].normal = looks.normals[i];
                seen_[p].id = hit.primitive;
            }
        }
        if (o_.shading == Shading::diffuse) add_light(tile, looks, total);
    }
    /// The value of a sample without its counts and without the direct light.
    Vec3f colour(const Ray<T, 3>& ray, const Hit<T>& hit, const Vec3f& normal) const {
        if (o_.shading == Shading::time) return Vec3f::all(nanoseconds(ray));
        if (!hit) return {0.28f, 0.36f, 0.48f};
        if (o_.shading == Shading::depth)
            return Vec3f::all(std::exp(-1.5f * static_cast<float>(hit.t) / (diagonal_ + 1e-30f)));
        if (o_.shading == Shading::normals) return (normal + Vec3f(1, 1, 1)) * 0.5f;
        return Vec3f(0.20f, 0.24f, 0.32f) * (0.6f + 0.4f * dot(normal, o_.camera.up)) * 0.62f;  // sky light
    }
    float nanoseconds(const Ray<T, 3>& ray) const {
        using Clock = std::chrono::steady_clock;
        auto least = Clock::duration::max();
        for (int k = 0; k < 3; ++k) {
            Hit<T> hit;
            const auto start = Clock::now();
            index_.closest_hits({&ray, 1}, {&hit, 1});
            least = std::min(least, Clock::now() - start);
        }
        return std::chrono::duration<float, std::nano>(least).count();
    }
    /// Adds direct light to the hits that face the light and are not in shadow.
    void add_light(const Tile& tile, const Looks& looks, Total& total) {
        OfTile<Ray<T, 3>> shadows;
        OfTile<std::size_t> pixels;
        OfTile<float> facing;
        OfTile<bool> blocked;
        OfTile<Visits> visits{};
        // Make a shadow ray for each hit that faces the light.
        std::size_t n = 0;
        for (std::size_t i = 0; i < tile.size(); ++i) {
            const Hit<T>& hit = looks.hits[i];
            if (!hit) continue;
            facing[n] = dot(looks.normals[i], light_);
            if (!(facing[n] > 0)) continue;
            const Vec<T, 3> normal(looks.normals[i]);
            shadows[n] = {
                offset_origin(looks.rays[i], hit.t, primitives_.bounds(hit.element), normal, normal),
                Vec<T, 3>(light_)};
            pixels[n++] = pixel(tile.x(i), tile.y(i));
        }
        // Cast the shadow rays in one batch.
        total.rays += n;
        total.use += index_.any_hits(std::span(shadows).first(n), std::span(blocked).first(n),
                                     std::span(visits).first(o_.counted() ? n : 0));
        for (std::size_t i = 0; i < n; ++i) {
            if (!blocked[i])
                values_[pixels[i]] = values_[pixels[i]] + Vec3f(0.85f, 0.80f, 0.70f) * facing[i] * 0.62f;
            total.visits += visits[i];
        }
    }

    Vec3f facing_normal(const Hit<T>& hit, const Ray<T, 3>& ray) const {
        const Vec3f n(hedgerow::normal(primitives_, ray, hit));
        return dot(n, Vec3f(ray.direction)) > 0 ? -n : n;
    }

    /// Makes the picture from the values of the finished rows.
    Picture develop() {
        Picture picture;
        picture.image = Image(o_.width, o_.height);
        picture.rays = total_.rays, picture.visits = total_.visits, picture.use = total_.use;
        // Sum up the statistics.
        for (int y = 0; y < o_.height; ++y) {
            if (!done_[static_cast<std::size_t>(y)]) continue;
            for (int x = 0; x < o_.width; ++x) {
                const float value = values_[pixel(x, y)][0];
                picture.most = std::max(picture.most, double(value));
                picture.mean += double(value);
                picture.beyond += o_.steps_max > 0 && value > static_cast<float>(o_.steps_max);
                ++picture.pixels;
            }
        }
        picture.mean /= double(std::max<std::uint64_t>(picture.pixels, 1));
        // Map the values to colours.
        const ColourScale scale{
            o_.steps_max > 0 ? o_.steps_max : static_cast<std::uint64_t>(std::ceil(picture.most)),
            o_.log_scale};
        for (int y = 0; y < o_.height; ++y) {
            if (!done_[static_cast<std::size_t>(y)]) continue;
            for (int x = 0; x < o_.width; ++x) {
                const Vec3f& v = values_[pixel(x, y)];
                picture.image.at(x, y) = counted(o_.shading) ? heat(scale.at(v[0])) : srgb(v);
            }
        }
        if (counted(o_.shading)) draw_colour_bar(picture.image, scale);
        if (o_.layers) picture.light = std::move(values_), picture.seen = std::move(seen_);
        return picture;
    }

    const AnyIndex<T, 3>& index_;
    ViewOf<P> primitives_;
    RenderOptions o_;
    std::vector<Vec3f> values_;
    std::vector<Seen> seen_;
    std::vector<std::uint8_t> done_;
    std::mutex mutex_;
    Total total_;
    Vec3f light_;
    float diagonal_;
};

/// Makes a picture of an index over `primitives`. Returns when all rows are finished or the progress is
/// cancelled.
template <class T, class P>
Picture raycast(const AnyIndex<T, 3>& index, const P& primitives, const RenderOptions& options,
                Executor& executor, const Progress& progress = {}) {
    return Raycast<T, P>(index, primitives, options).run(executor, progress);
}

}  // namespace hedgerow
