#include <hedgerow/render/render.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <numbers>

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/elementary.h>
#include <hedgerow/render/film/contrast.h>
#include <hedgerow/render/shading/transparency.h>

namespace hedgerow {

namespace {

/// Size of a tile: large enough for the kernels, small enough to be cancelled soon.
constexpr int band_rows = 8, tile_columns = 64;
/// Samples of each pixel that decide whether it gets the others, if a picture is refined.
constexpr int first_samples = 4;
template <class V>
using OfTile = std::array<V, static_cast<std::size_t>(band_rows) * tile_columns>;

template <class T>
void check(const PictureParts<T>& parts, const RenderOptions& o) {
    check_camera(o.camera);
    if (o.width < 1 || o.height < 1) throw InputError("a picture needs at least one pixel");
    if (o.samples < 1) throw InputError("a picture needs at least one sample a pixel");
    if (parts.visibility.finds_whole_pictures() && counted(o.shading))
        throw InputError("this shading shows what rays cost, and the picture is not found ray by ray");
    if (parts.appearances == nullptr && o.shading == Shading::colour)
        throw InputError("this shading shows what a model looks like: give its appearances");
    if (parts.tracer == nullptr && (is_lit(o.shading) || o.shading == Shading::time))
        throw InputError("this shading casts rays: give a tracer, or shade by normals or depth");
    if (!(o.light_degrees >= 0 && o.light_degrees < 90))
        throw InputError("the diameter of the light must be 0 to 90 degrees");
    const bool soft = is_lit(o.shading) && o.light_degrees > 0;
    if ((o.cones || soft) && parts.cones == nullptr)
        throw InputError("smooth edges and soft shadows take cones: give what answers them");
    if ((o.cones || soft) && o.transparent) throw InputError("cones do not see through transparent surfaces");
    if ((o.cones || soft) && parts.appearances != nullptr && parts.appearances->has_masks())
        throw InputError("cones do not see through masks of opacity");
    if (o.cones && counted(o.shading)) throw InputError("this shading shows what rays cost, not cones");
    if (o.cones && o.samples > 1) throw InputError("a cone sees all of a pixel: take one sample");
    if (o.cones) cone_of_pixel(PictureSamples<T>(o.camera, o.width, o.height), 0, 0);  // throws without one
    if (o.refines && (counted(o.shading) || o.cones || parts.visibility.finds_whole_pictures()))
        throw InputError("pictures are refined by rays, where light differs: not what rays cost, not cones");
    if (o.footprints && o.camera.projection == Projection::panorama)
        throw InputError("footprints are what pixels of a plane see, not those of a panorama");
    if (!o.transparent) return;
    if (!(o.opacity >= 0 && o.opacity <= 1)) throw InputError("the opacity of surfaces must be 0 to 1");
    if (counted(o.shading)) throw InputError("this shading shows what rays cost, which end at the first hit");
    if (parts.tracer == nullptr) throw InputError("light through surfaces takes rays: give a tracer");
}

template <class T>
class Rendering {
public:
    Rendering(const PictureParts<T>& parts, const RenderOptions& o)
        : parts_(parts),
          o_(o),
          whole_(parts.visibility.finds_whole_pictures()),
          shading_(o.camera, diagonal(parts.surfaces, o.shading)),
          plane_(RayMaker(o.camera, o.width, o.height).plane()),
          film_(o.width, o.height, o.layers),
          contrast_(o.refines ? static_cast<std::size_t>(o.width) * static_cast<std::size_t>(o.height) : 0) {
        if ((o.shading == Shading::colour || o.transparent) && parts.appearances != nullptr &&
            parts.appearances->has_masks())
            keeps_ = [&looks = *parts.appearances](std::size_t, const Hit<T>& hit) {
                return looks.is_there(hit);
            };
    }

    Picture run(Executor& executor, const Progress& progress) {
        const int bands = (o_.height + band_rows - 1) / band_rows;
        std::uint64_t passes = 1;
        for (int last = after(0); last < o_.samples; last = after(last)) ++passes;
        const auto all_rows = static_cast<std::uint64_t>(o_.height) * passes;
        std::atomic<std::uint64_t> rows{0};
        for (int first = 0; first < o_.samples && !progress.cancelled(); first = after(first)) {
            const int last = after(first);
            if (whole_) parts_.visibility.prepare(samples(first), executor, costs_);
            if (o_.refines && first > 0) contrast_.find(o_.width, o_.height);
            const auto band_range = [&](std::size_t begin, std::size_t end) {
                for (std::size_t k = begin; k < end && !progress.cancelled(); ++k) {
                    const int top = static_cast<int>(k) * band_rows;
                    const int height = std::min(band_rows, o_.height - top);
                    if (!band(top, height, first, last, progress)) return;
                    progress(rows += static_cast<std::uint64_t>(height), all_rows);
                }
            };
            executor.for_each_piece(static_cast<std::size_t>(bands), 1, band_range);
        }
        const bool finished = film_.has(averages_counts() ? 1 : o_.samples);
        Picture picture =
            counted(o_.shading) ? std::move(film_).develop_heat(o_.scale) : std::move(film_).develop();
        picture.costs = costs_, picture.whole = finished;
        return picture;
    }

private:
    /// Rays from the eye, at most one for each pixel of a tile, with their hits and the surfaces there.
    struct Looks {
        OfTile<Ray<T, 3>> rays;
        OfTile<Hit<T>> hits;
        OfTile<Vec<T, 3>> normals;
        std::vector<Appearance> appearances;  // where they are asked for; else empty
        OfTile<Vec3f> light;                  // towards the eye
        OfTile<float> shares;                 // of a pixel, that a ray stands for
        OfTile<std::size_t> pixels;
        std::size_t size = 0;
    };
    using Walk = detail::LayerWalk<T, 3>;

    /// The samples that each pixel has after the pass that begins with `first`. Samples of whole pictures are
    /// found one after the other, those of tiles all at once, and of refined pictures some before the others.
    int after(int first) const {
        if (whole_) return first + 1;
        return o_.refines && first == 0 ? std::min(first_samples, o_.samples) : o_.samples;
    }
    static float diagonal(const Surfaces<T>& surfaces, Shading shading) {
        const Box<T, 3> box = shading == Shading::depth ? surfaces.bounds() : Box<T, 3>();
        return box.empty() ? 0 : static_cast<float>(length(box.extent()));
    }
    PictureSamples<T> samples(int sample) const {
        return {o_.camera, o_.width, o_.height, o_.seed, sample, o_.samples};
    }

    /// Adds samples to a band of rows, tile by tile. Returns false if that was cancelled; then the rows are
    /// as they were, or cleared.
    bool band(int top, int height, int first, int last, const Progress& progress) {
        PictureCosts costs;
        for (int left = 0; left < o_.width; left += tile_columns) {
            const PixelBox tile{left, top, std::min(left + tile_columns, o_.width) - 1, top + height - 1};
            if (add(tile, first, last, costs, progress)) continue;
            film_.clear_rows(top, height);
            film_.finish_rows(top, height, 0);
            return false;
        }
        if (o_.refines && first > 0) fill_up(top, height, first, last);
        film_.finish_rows(top, height, averages_counts() ? 1 : last);
        const std::lock_guard lock(mutex_);
        costs_ += costs;
        return true;
    }
    /// Gives the pixels that are not refined as much light as more samples alike would bring.
    void fill_up(int top, int height, int has, int samples) {
        const float more = static_cast<float>(samples) / static_cast<float>(has);
        for (std::size_t p = film_.pixel(0, top); p < film_.pixel(0, top + height); ++p)
            if (!contrast_.is_high(p)) film_.light(p) = film_.light(p) * more;
    }
    /// Whether a pixel's value is the mean of its counts, not a sum of light.
    bool averages_counts() const { return counts_visits(o_.shading); }

    /// Adds samples to the pixels of a tile, or to those that are refined. Returns false if that was
    /// cancelled.
    bool add(const PixelBox& tile, int first, int last, PictureCosts& costs, const Progress& progress) {
        if (o_.cones) {
            add_cones(tile, costs);
            return true;
        }
        OfTile<Visits> visits{};
        Looks looks;
        if (by_looks()) looks.appearances.resize(tile.size());
        for (int y = tile.top; y <= tile.bottom; ++y)
            for (int x = tile.left; x <= tile.right; ++x) {
                const std::size_t pixel = film_.pixel(x, y);
                if (!o_.refines || first == 0 || contrast_.is_high(pixel)) looks.pixels[looks.size++] = pixel;
            }
        if (looks.size == 0) return true;
        looks.shares.fill(share_of_sample());
        for (int sample = first; sample < last; ++sample) {
            // In later passes each pixel keeps the samples that it has.
            if (!whole_ && first == 0 && progress.cancelled()) return false;
            look(tile, sample, looks, visits, costs);
            shade(looks, sample, costs);
        }
        for (std::size_t i = 0; i < looks.size; ++i) costs.visits += visits[i];
        // Store the means of the counts.
        for (std::size_t i = 0; i < looks.size && o_.counted() && (whole_ || first == 0); ++i) {
            const Visits& v = visits[i];
            const auto mean = [&](std::uint64_t all) {
                return static_cast<float>(double(all) / (last - first));
            };
            Vec3f& value = film_.light(looks.pixels[i]);
            if (o_.shading == Shading::steps) value = Vec3f::all(mean(v.nodes + v.leaves + v.primitives));
            if (o_.shading == Shading::tests) value = Vec3f::all(mean(v.primitives));
            if (!o_.layers) continue;
            Seen& seen = film_.seen(looks.pixels[i]);
            seen.nodes = mean(v.nodes), seen.leaves = mean(v.leaves), seen.primitives = mean(v.primitives);
        }
        return true;
    }
    /// Finds the hits of a sample of each of a tile's pixels, in one batch.
    void look(const PixelBox& tile, int sample, Looks& looks, OfTile<Visits>& visits, PictureCosts& costs) {
        const PictureSamples<T> rays = samples(sample);
        const auto columns = static_cast<std::size_t>(o_.width);
        for (std::size_t i = 0; i < looks.size; ++i)
            looks.rays[i] = rays.ray(static_cast<int>(looks.pixels[i] % columns),
                                     static_cast<int>(looks.pixels[i] / columns));
        parts_.visibility.look(tile, std::span(looks.rays).first(looks.size),
                               std::span(looks.hits).first(looks.size),
                               std::span(visits).first(o_.counted() ? looks.size : 0), costs);
    }
    /// Adds the light of a tile's hits to the film, and stores the layers of the first sample.
    void shade(Looks& looks, int sample, PictureCosts& costs) {
        if (o_.transparent)
            composite(looks, costs);
        else
            find_light(looks, costs);
        for (std::size_t i = 0; i < looks.size; ++i) {
            add_light(looks.pixels[i], looks.light[i]);
            if (o_.refines) contrast_.add(looks.pixels[i], looks.light[i]);
        }
        if (o_.layers && sample == 0) store_seen(looks);
    }
    /// Stores the layers of hits.
    void store_seen(const Looks& looks) {
        for (std::size_t i = 0; i < looks.size; ++i) {
            const Hit<T>& hit = looks.hits[i];
            if (!hit) continue;
            Seen& seen = film_.seen(looks.pixels[i]);
            seen.depth = static_cast<float>(hit.t);  // directions have length 1
            seen.normal = Vec3f(parts_.surfaces.normal(looks.rays[i], hit));
            seen.id = hit.primitive;
        }
    }
    /// Adds what cones see of the pixels of a tile, in waves: each has the next fragment of every cone.
    void add_cones(const PixelBox& tile, PictureCosts& costs) {
        const PictureSamples<T> rays = samples(0);
        OfTile<std::vector<SeenFragment<T>>> seen;
        OfTile<std::size_t> pixels;
        std::size_t size = 0, waves = 0;
        for (int y = tile.top; y <= tile.bottom; ++y)
            for (int x = tile.left; x <= tile.right; ++x, ++size) {
                parts_.cones->look(cone_of_pixel(rays, x, y), seen[size]);
                pixels[size] = film_.pixel(x, y);
                waves = std::max(waves, seen[size].size());
                float open = 1;
                for (const auto& fragment : seen[size]) open -= fragment.share;
                add_light(pixels[size], shading_.background() * open);
            }
        costs.cones += size;
        Looks wave;
        if (by_looks()) wave.appearances.resize(size);
        for (std::size_t j = 0; j < waves; ++j) {
            wave.size = 0;
            for (std::size_t i = 0; i < size; ++i) {
                if (j >= seen[i].size()) continue;
                const std::size_t n = wave.size++;
                wave.rays[n] = seen[i][j].ray, wave.hits[n] = seen[i][j].hit;
                wave.pixels[n] = pixels[i], wave.shares[n] = seen[i][j].share;
            }
            find_light(wave, costs);
            for (std::size_t n = 0; n < wave.size; ++n)
                add_light(wave.pixels[n], wave.light[n] * wave.shares[n]);
            if (o_.layers && j == 0) store_seen(wave);
        }
    }
    void add_light(std::size_t pixel, const Vec3f& light) { film_.light(pixel) = film_.light(pixel) + light; }
    /// Finds the light of all layers on the rays of a tile, from those of its hits on.
    void composite(Looks& first, PictureCosts& costs) {
        OfTile<Vec3d> light{};
        OfTile<double> through;
        through.fill(1);
        Looks wave;
        wave.shares.fill(share_of_sample());
        if (by_looks()) wave.appearances.resize(first.size);
        const auto shade = [&](std::span<typename Walk::Step> steps) {
            wave.size = steps.size();
            for (std::size_t i = 0; i < wave.size; ++i)
                wave.rays[i] = first.rays[steps[i].ray], wave.hits[i] = steps[i].hit;
            find_light(wave, costs);
            for (std::size_t i = 0; i < wave.size; ++i) {
                auto& step = steps[i];
                step.opacity = opacity(parts_.appearances == nullptr ? 1 : wave.appearances[i].alpha);
                light[step.ray] =
                    light[step.ray] + detail::weighted(wave.light[i], step.through * step.opacity);
                through[step.ray] = step.through * (1 - step.opacity);
            }
        };
        costs.layers +=
            follow(std::span(first.rays).first(first.size), std::span(first.hits).first(first.size), shade);
        for (std::size_t i = 0; i < first.size; ++i)
            first.light[i] = Vec3f(light[i] + detail::weighted(shading_.background(), through[i]));
    }
    /// Follows rays through layers from their first hits on.
    template <class Shade>
    TransparencyCounts follow(std::span<const Ray<T, 3>> rays, std::span<const Hit<T>> first,
                              const Shade& shade) {
        const auto find = [&](const auto& some, std::size_t k, auto& lists, const auto& after, const auto&) {
            parts_.tracer->first_hits(some, k, lists, after, keeps_);
        };
        return Walk(o_.transparency).follow(rays, 0, rays.size(), first, find, shade);
    }
    double opacity(float alpha) const {
        return static_cast<double>(std::clamp(alpha * o_.opacity, 0.f, 1.f));
    }
    /// Finds the light that comes from a tile's hits, and the background's where nothing is hit.
    void find_light(Looks& looks, PictureCosts& costs) {
        for (std::size_t i = 0; i < looks.size; ++i) {
            const Hit<T>& hit = looks.hits[i];
            if (hit) looks.normals[i] = parts_.surfaces.normal(looks.rays[i], hit);
            const Vec3f normal(looks.normals[i]);
            if (hit && by_looks()) looks.appearances[i] = appearance(looks, i, normal);
            looks.light[i] = colour(looks, i, normal);
        }
        if (is_lit(o_.shading)) add_direct_light(looks, costs);
    }
    bool by_colour() const { return o_.shading == Shading::colour; }
    /// Whether the appearances of hits are asked for.
    bool by_looks() const { return by_colour() || (o_.transparent && parts_.appearances != nullptr); }
    float share_of_sample() const { return 1 / static_cast<float>(o_.samples); }
    /// What a hit looks like, with a normal on the side of the surface's, which it is where there is no
    /// other.
    Appearance appearance(const Looks& looks, std::size_t i, const Vec3f& normal) const {
        Appearance a = parts_.appearances->at(
            looks.hits[i], o_.footprints ? footprint(looks, i, normal) : SurfaceFootprint());
        if (length2(a.normal) == 0) a.normal = normal;
        if (dot(a.normal, normal) < 0) a.normal = -a.normal;
        return a;
    }
    /// What a ray's share of its pixel sees of the surface.
    SurfaceFootprint footprint(const Looks& looks, std::size_t i, const Vec3f& normal) const {
        const Vec3f direction(looks.rays[i].direction);
        const float radius = pixel_radius(plane_, direction, static_cast<float>(looks.hits[i].t));
        return footprint_of(Vec3d(direction), double(radius * std::sqrt(looks.shares[i])), Vec3d(normal));
    }
    /// What is reflected of light on a grey surface by one with a colour.
    static Vec3f coloured(const Vec3f& light, const Appearance& a) {
        Vec3f c;
        for (int k = 0; k < 3; ++k) c[k] = light[k] * (a.colour[k] / PlainShading::grey);
        return c;
    }
    /// The value of a sample without its counts and without the direct light.
    Vec3f colour(const Looks& looks, std::size_t i, const Vec3f& normal) const {
        const Hit<T>& hit = looks.hits[i];
        if (o_.shading == Shading::time) return Vec3f::all(nanoseconds(looks.rays[i]));
        if (!hit) return shading_.background();
        if (o_.shading == Shading::depth) return shading_.depth(static_cast<float>(hit.t));
        if (o_.shading == Shading::normals) return shading_.normal(normal);
        if (!by_colour()) return shading_.sky(normal);
        const Appearance& a = looks.appearances[i];
        return a.emission + (a.unlit ? a.colour : coloured(shading_.sky(a.normal), a));
    }
    float nanoseconds(const Ray<T, 3>& ray) const {
        using Clock = std::chrono::steady_clock;
        auto least = Clock::duration::max();
        for (int k = 0; k < 3; ++k) {
            Hit<T> hit;
            const auto start = Clock::now();
            parts_.tracer->closest_hits(RayArray<T, 3>(&ray, 1), {&hit, 1});
            least = std::min(least, Clock::now() - start);
        }
        return std::chrono::duration<float, std::nano>(least).count();
    }
    /// Adds direct light to the hits that face the light and are not in shadow.
    void add_direct_light(Looks& looks, PictureCosts& costs) {
        OfTile<Ray<T, 3>> shadows;
        OfTile<std::size_t> places;  // in the tile
        OfTile<float> facing;
        // Make a shadow ray for each hit that faces the light.
        std::size_t n = 0;
        for (std::size_t i = 0; i < looks.size; ++i) {
            if (!looks.hits[i] || (by_colour() && looks.appearances[i].unlit)) continue;
            const float above = dot(Vec3f(looks.normals[i]), shading_.to_light());
            facing[n] = by_colour() ? dot(looks.appearances[i].normal, shading_.to_light()) : above;
            if (!(above > 0 && facing[n] > 0)) continue;
            shadows[n] = {parts_.surfaces.origin(looks.rays[i], looks.hits[i], looks.normals[i]),
                          Vec<T, 3>(shading_.to_light())};
            places[n++] = i;
        }
        const auto open = let_through(std::span<const Ray<T, 3>>(shadows).first(n), costs);
        for (std::size_t i = 0; i < n; ++i) {
            const Vec3f direct = shading_.direct(facing[i]) * open[i];
            Vec3f& light = looks.light[places[i]];
            light = light + (by_colour() ? coloured(direct, looks.appearances[places[i]]) : direct);
        }
    }
    /// The share of the light that comes through along each ray. The rays are cast in one batch.
    OfTile<float> let_through(std::span<const Ray<T, 3>> rays, PictureCosts& costs) {
        OfTile<float> open;
        if (o_.light_degrees > 0) {
            const auto slope = static_cast<T>(tangent(double(o_.light_degrees) / 2 * std::numbers::pi / 180));
            for (std::size_t i = 0; i < rays.size(); ++i)
                open[i] = parts_.cones->open({rays[i], T(0), slope});
            costs.cones += rays.size();
            return open;
        }
        costs.rays += rays.size();
        if (o_.transparent) {
            OfTile<Hit<T>> first;
            const auto hits = std::span(first).first(rays.size());
            costs.use += parts_.tracer->closest_hits(rays, hits, {}, keeps_);
            open.fill(1);
            follow(rays, hits, [&](std::span<typename Walk::Step> steps) {
                for (auto& step : steps) {
                    step.opacity = opacity(
                        parts_.appearances == nullptr ? 1 : parts_.appearances->at(step.hit, {}).alpha);
                    open[step.ray] = static_cast<float>(step.through * (1 - step.opacity));
                }
            });
            return open;
        }
        OfTile<bool> blocked;
        OfTile<Visits> visits{};
        costs.use += parts_.tracer->any_hits(rays, std::span(blocked).first(rays.size()),
                                             std::span(visits).first(o_.counted() ? rays.size() : 0), keeps_);
        for (std::size_t i = 0; i < rays.size(); ++i) open[i] = blocked[i] ? 0 : 1, costs.visits += visits[i];
        return open;
    }

    const PictureParts<T> parts_;
    const RenderOptions& o_;
    const bool whole_;  // samples of the whole picture are found at once
    const PlainShading shading_;
    const PicturePlane plane_;
    typename Tracer<T>::Filter keeps_;
    Film film_;
    Contrast contrast_;  // of refined pictures
    std::mutex mutex_;
    PictureCosts costs_;
};

}  // namespace

template <std::floating_point T>
Picture render(const PictureParts<T>& parts, const RenderOptions& options, const Progress& progress) {
    check(parts, options);
    return Rendering<T>(parts, options)
        .run(options.threads.over(static_cast<std::size_t>(std::max(0, options.width)) *
                                  static_cast<std::size_t>(std::max(0, options.height))),
             progress);
}
template Picture render(const PictureParts<float>&, const RenderOptions&, const Progress&);
template Picture render(const PictureParts<double>&, const RenderOptions&, const Progress&);

}  // namespace hedgerow
