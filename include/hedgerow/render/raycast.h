/// Ray casting: a picture from any index, in tiles over an executor.
#pragma once

#include <chrono>
#include <mutex>

#include <hedgerow/any_index.h>
#include <hedgerow/parallel/progress.h>
#include <hedgerow/render/camera.h>
#include <hedgerow/render/colour.h>
#include <hedgerow/render/seen.h>
#include <hedgerow/scenes/random.h>

namespace hedgerow {

/// The last three are counted, not seen: cells and primitives looked at, primitives tested, nanoseconds.
/// Where time is measured a ray is cast three times, and the least counts.
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
    /// Top of the scale of what is counted; 0: the most that was seen.
    std::uint64_t steps_max = 0;
    /// Whether the picture keeps what its rays met, for `Picture::layers`.
    bool layers = false;
};

struct Picture {
    Image image;
    std::uint64_t rays = 0;
    Visits visits;
    /// Of what is counted: the mean and the most of all pixels, and how many lie beyond the scale.
    double mean = 0, most = 0;
    std::uint64_t beyond = 0;
    /// Empty unless layers were asked for. The colours as light, linear and unclamped; of what is counted,
    /// the count three times.
    std::vector<Vec3f> light;
    std::vector<Seen> seen;

    /// For `save_exr`; borrowed from this.
    Layers layers() const& { return layers_of(image.width, image.height, light, seen); }
    Layers layers() const&& = delete;
};

/// Casts one or more rays a pixel; diffuse adds a shadow ray where the light is faced. Rows that are not done
/// when the progress is cancelled stay black, and saw nothing.
template <class T, class P>
class Raycast {
public:
    Raycast(const AnyIndex<T, 3>& index, const P& primitives, const RenderOptions& o)
        : index_(index),
          primitives_(view_of(primitives)),
          o_(o),
          make_(o.camera, o.width, o.height),
          values_(static_cast<std::size_t>(o.width) * static_cast<std::size_t>(o.height)),
          seen_(o.layers ? values_.size() : 0),
          done_(static_cast<std::size_t>(o.height)),
          light_(light_of(o.camera)),
          diagonal_(
              static_cast<float>(length(index.bounds().empty() ? Vec<T, 3>() : index.bounds().extent()))) {}

    Picture run(Executor& executor, const Progress& progress) {
        std::atomic<std::uint64_t> rows{0};
        executor.for_each_piece(static_cast<std::size_t>(o_.height), 1,
                                [&](std::size_t begin, std::size_t end) {
                                    for (std::size_t y = begin; y < end && !progress.cancelled(); ++y) {
                                        if (!row(static_cast<int>(y), progress)) return;
                                        progress(++rows, static_cast<std::uint64_t>(o_.height));
                                    }
                                });
        return develop();
    }

private:
    static Vec3f light_of(const Camera& c) {
        if (length2(c.light) > 0) return normalized(c.light);
        const Vec3f forward = normalized(c.target - c.eye);
        return normalized(c.up + cross(forward, c.up) * 0.5f - forward * 0.35f);
    }
    /// A ray from the eye, and what it met.
    struct Look {
        Ray<T, 3> ray;
        Hit<T> hit;
        Visits visits;
    };
    struct Total {
        Visits visits;
        std::uint64_t rays = 0;
    };

    /// A row is kept whole or not at all.
    bool row(int y, const Progress& progress) {
        const auto width = static_cast<std::size_t>(o_.width), first = static_cast<std::size_t>(y) * width;
        std::vector<Vec3f> values(width);
        std::vector<Seen> seen(o_.layers ? width : 0);
        Total total;
        for (std::size_t x = 0; x < width; ++x) {
            if (x % 16 == 0 && progress.cancelled()) return false;
            values[x] = pixel(static_cast<int>(x), y, o_.layers ? &seen[x] : nullptr, total);
        }
        std::copy(values.begin(), values.end(), &values_[first]);
        if (o_.layers) std::copy(seen.begin(), seen.end(), &seen_[first]);
        const std::lock_guard lock(mutex_);
        done_[static_cast<std::size_t>(y)] = 1;
        visits_ += total.visits;
        rays_ += total.rays;
        return true;
    }

    /// Colour, or what is counted: the mean of the samples.
    Vec3f pixel(int x, int y, Seen* seen, Total& total) const {
        Vec3f sum;
        Visits visits;
        for (int s = 0; s < o_.samples; ++s) {
            const Look look = cast(ray_through(x, y, s));
            visits += look.visits;
            sum = sum + shade(look, total);
            if (seen != nullptr && s == 0 && look.hit) see(look, *seen);
        }
        if (seen != nullptr) count(visits, *seen);
        total.visits += visits;
        total.rays += static_cast<std::uint64_t>(o_.samples);
        return sum / static_cast<float>(o_.samples);
    }
    /// Through the pixel's middle, or where there are several samples anywhere in it.
    Ray<T, 3> ray_through(int x, int y, int sample) const {
        const auto left = static_cast<float>(x), top = static_cast<float>(y);
        if (o_.samples == 1) return make_.template ray<T>(left + 0.5f, top + 0.5f);
        Random random(o_.seed, (static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(o_.width) +
                                static_cast<std::uint64_t>(x)) *
                                       static_cast<std::uint64_t>(o_.samples) +
                                   static_cast<std::uint64_t>(sample));
        const auto dx = static_cast<float>(random.uniform()), dy = static_cast<float>(random.uniform());
        return make_.template ray<T>(left + dx, top + dy);
    }
    Look cast(const Ray<T, 3>& ray) const {
        Look look{ray, {}, {}};
        index_.closest_hits({&ray, 1}, {&look.hit, 1}, {&look.visits, 1});
        return look;
    }

    Vec3f shade(const Look& look, Total& total) const {
        const Visits& counts = look.visits;
        if (o_.shading == Shading::steps)
            return Vec3f::all(static_cast<float>(counts.nodes + counts.leaves + counts.primitives));
        if (o_.shading == Shading::tests) return Vec3f::all(static_cast<float>(counts.primitives));
        if (o_.shading == Shading::time) return Vec3f::all(nanoseconds(look.ray));
        if (!look.hit) return background();
        if (o_.shading == Shading::depth)
            return Vec3f::all(std::exp(-1.5f * static_cast<float>(look.hit.t) / (diagonal_ + 1e-30f)));
        const Vec3f n = facing_normal(look);
        if (o_.shading == Shading::normals) return (n + Vec3f(1, 1, 1)) * 0.5f;
        return lit(look, n, total);
    }
    void see(const Look& look, Seen& seen) const {
        seen.depth = static_cast<float>(look.hit.t);  // directions have length 1
        seen.normal = facing_normal(look);
        seen.id = look.hit.primitive;
    }
    void count(const Visits& visits, Seen& seen) const {
        const auto mean = [&](std::uint64_t all) { return static_cast<float>(double(all) / o_.samples); };
        seen.nodes = mean(visits.nodes);
        seen.leaves = mean(visits.leaves);
        seen.primitives = mean(visits.primitives);
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
    Vec3f lit(const Look& look, const Vec3f& n, Total& total) const {
        const Vec3f sky = Vec3f(0.20f, 0.24f, 0.32f) * (0.6f + 0.4f * dot(n, o_.camera.up));
        const float facing = dot(n, light_);
        Vec3f light = sky;
        if (facing > 0) {
            const Vec<T, 3> origin = offset_origin(look.ray, look.hit.t, primitives_.bounds(look.hit.element),
                                                   Vec<T, 3>(n), Vec<T, 3>(n));
            const Ray<T, 3> shadow{origin, Vec<T, 3>(light_)};
            bool blocked = false;
            Visits here;
            index_.any_hits({&shadow, 1}, {&blocked, 1}, {&here, 1});
            ++total.rays;
            total.visits += here;
            if (!blocked) light = light + Vec3f(0.85f, 0.80f, 0.70f) * facing;
        }
        return light * 0.62f;
    }
    static Vec3f background() { return {0.28f, 0.36f, 0.48f}; }

    Vec3f facing_normal(const Look& look) const {
        const Vec3f n = normal(look.hit, look.ray);
        return dot(n, Vec3f(look.ray.direction)) > 0 ? -n : n;
    }
    Vec3f normal(const Hit<T>& hit, const Ray<T, 3>& ray) const {
        if constexpr (requires { primitives_.normal(hit.element); })
            return normalized(Vec3f(normalized(Vec3d(primitives_.normal(hit.element)))));
        else
            return Vec3f(normalized(Vec3d(ray.at(hit.t)) - Vec3d(primitives_.sphere(hit.element).center)));
    }

    Picture develop() {
        Picture picture;
        picture.image = Image(o_.width, o_.height);
        picture.rays = rays_, picture.visits = visits_;
        for (const auto& v : values_) {
            picture.most = std::max(picture.most, double(v[0]));
            picture.mean += double(v[0]) / double(values_.size());
            picture.beyond += o_.steps_max > 0 && v[0] > static_cast<float>(o_.steps_max);
        }
        const float most = static_cast<float>(o_.steps_max > 0 ? double(o_.steps_max) : picture.most);
        for (int y = 0; y < o_.height; ++y) {
            if (!done_[static_cast<std::size_t>(y)]) continue;
            for (int x = 0; x < o_.width; ++x) {
                const Vec3f& v = values_[static_cast<std::size_t>(y) * static_cast<std::size_t>(o_.width) +
                                         static_cast<std::size_t>(x)];
                picture.image.at(x, y) = counted(o_.shading) ? heat(most > 0 ? v[0] / most : 0) : srgb(v);
            }
        }
        if (counted(o_.shading)) draw_colour_bar(picture.image, static_cast<std::uint64_t>(most));
        if (o_.layers) picture.light = std::move(values_), picture.seen = std::move(seen_);
        return picture;
    }

    const AnyIndex<T, 3>& index_;
    ViewOf<P> primitives_;
    RenderOptions o_;
    RayMaker make_;
    std::vector<Vec3f> values_;
    std::vector<Seen> seen_;
    std::vector<std::uint8_t> done_;
    std::mutex mutex_;
    Visits visits_;
    std::uint64_t rays_ = 0;
    Vec3f light_;
    float diagonal_;
};

template <class T, class P>
Picture raycast(const AnyIndex<T, 3>& index, const P& primitives, const RenderOptions& options,
                Executor& executor, const Progress& progress = {}) {
    return Raycast<T, P>(index, primitives, options).run(executor, progress);
}

}  // namespace hedgerow
