#include <hedgerow/render/integrators/path_picture.h>

#include <algorithm>
#include <atomic>
#include <utility>

#include <hedgerow/base/error.h>
#include <hedgerow/render/sampling/allocation.h>
#include <hedgerow/render/visibility/samples.h>

namespace hedgerow {

namespace {

/// The side of blocks of pixels whose rays go together.
constexpr int block_side = 8;
/// Paths of a tile, at most: few, so that all threads have work to the end.
constexpr std::size_t paths_of_tile = std::size_t{1} << 10;
/// Paths that a thread follows in one go: many beside those in flight, so that few rounds are short; and few
/// enough for their light to take little memory, and for work to end soon where it should.
constexpr std::size_t paths_of_part = std::size_t{1} << 16;

/// Pixel i of a tile, block by block.
std::pair<int, int> place(const PixelBox& tile, std::size_t i) {
    const auto columns = static_cast<std::size_t>(tile.width());
    // All rows of blocks but the last have block_side rows of pixels, likewise columns.
    const std::size_t of_row = columns * block_side, row = i / of_row, in_row = i % of_row;
    const std::size_t rows =
        std::min<std::size_t>(block_side, static_cast<std::size_t>(tile.height()) - row * block_side);
    const std::size_t column = in_row / (rows * block_side), in_block = in_row % (rows * block_side);
    const std::size_t wide = std::min<std::size_t>(block_side, columns - column * block_side);
    return {tile.left + static_cast<int>(column * block_side + in_block % wide),
            tile.top + static_cast<int>(row * block_side + in_block / wide)};
}

/// The tiles of a picture: squares of whole blocks. Only those of a single block may have more paths than a
/// tile should.
class Tiles {
public:
    Tiles(const PathPictureOptions& o, std::uint32_t samples) : width_(o.width), height_(o.height) {
        const auto paths = [&](int side) { return std::size_t(side) * std::size_t(side) * samples; };
        while (paths(2 * side_) <= paths_of_tile) side_ *= 2;
        columns_ = (o.width + side_ - 1) / side_;
        of_part_ = std::max<std::size_t>(1, paths_of_part / paths(side_));
    }
    std::size_t size() const {
        return static_cast<std::size_t>(columns_) * static_cast<std::size_t>((height_ + side_ - 1) / side_);
    }
    /// Tiles that make a part.
    std::size_t of_part() const { return of_part_; }
    PixelBox operator[](std::size_t i) const {
        const int left = static_cast<int>(i) % columns_ * side_, top = static_cast<int>(i) / columns_ * side_;
        return {left, top, std::min(left + side_, width_) - 1, std::min(top + side_, height_) - 1};
    }

private:
    int width_, height_, side_ = block_side, columns_;
    std::size_t of_part_;
};

void check(std::uint32_t samples, const PathPictureOptions& o) {
    check_camera(o.camera);
    check_paths(o.paths);
    if (o.width < 1 || o.height < 1) throw InputError("a picture needs at least one pixel");
    if (samples < 1) throw InputError("a picture needs at least one sample a pixel");
}

/// The tables of compensation, which are the same for all pictures. The first use computes them, in 0.2 s.
const Compensation& compensation() {
    static const Compensation tables;
    return tables;
}

/// How many samples the halves of each pixel should have.
class Goal {
public:
    /// `until`: of both halves, on the mean. Borrows the picture.
    Goal(const PathPicture& picture, Division division, std::uint32_t until)
        : even_(division == Division::even), means_{even_ ? until : (until + 1) / 2, even_ ? 0 : until / 2} {
        if (division == Division::adaptive && !picture.spreads[0].empty())
            for (std::size_t half = 0; half < 2; ++half)
                shares_.emplace_back(picture.spreads[half], pilot_samples, means_[half]);
    }
    std::uint32_t operator()(std::size_t pixel, int half) const {
        const auto h = static_cast<std::size_t>(half);
        return shares_.empty() ? means_[h] : shares_[h][pixel];
    }

private:
    bool even_;
    std::array<std::uint32_t, 2> means_;
    std::vector<Allocation> shares_;  // of each half; none: all pixels have the mean
};

/// Samples that follow each other in half a pixel, which are paths from `first` on.
struct Run {
    int x, y, half;
    std::uint32_t begin;
    std::size_t first;

    PixelSample sample(std::size_t path) const {
        return {x, y, static_cast<std::uint32_t>(half), begin + static_cast<std::uint32_t>(path - first)};
    }
};
/// The runs of some pixels, in the order of their paths.
class Runs {
public:
    /// Adds the samples from one number to before another, if there are any.
    void add(int x, int y, int half, std::uint32_t begin, std::uint32_t end) {
        if (begin < end) all_.push_back({x, y, half, begin, paths_}), paths_ += end - begin;
    }
    std::size_t paths() const { return paths_; }
    /// The run of a path. `current` is that of a path before it, and becomes its own.
    const Run& of(std::size_t path, std::size_t& current) const {
        while (current + 1 < all_.size() && all_[current + 1].first <= path) ++current;
        return all_[current];
    }

private:
    std::vector<Run> all_;
    std::size_t paths_ = 0;
};

template <class T>
class PathTracing {
public:
    PathTracing(PathPicture& picture, const PathScene<T>& scene, const PathPictureOptions& o)
        : picture_(picture),
          o_(o),
          surfaces_(scene.model),
          world_{surfaces_, scene.lights, o.paths,
                 o.paths.compensation && surfaces_.has_facets() ? &compensation() : nullptr},
          tracer_(scene.tracer),
          camera_(o.camera, o.width, o.height, o.filter, o.paths.sampler, o.paths.seed) {}

    /// Goes over the picture again and again, with twice as many samples as before, so that an end at any
    /// time leaves all pixels about as many, or their shares.
    void run(std::uint32_t samples, Executor& executor, const Progress& progress) {
        const bool adapts = o_.division == Division::adaptive;
        std::uint64_t all =
            picture_.light.size() * std::uint64_t{samples - std::min(samples, picture_.samples)};
        std::atomic<std::uint64_t> done{0};
        while (picture_.samples < samples && !progress.cancelled()) {
            const bool in_pilot = adapts && picture_.samples < 2 * pilot_samples;
            if (adapts && !in_pilot && picture_.spreads[0].empty()) divide();
            std::uint32_t until = std::min(samples, std::max<std::uint32_t>(1, 2 * picture_.samples));
            if (in_pilot) until = std::min(until, 2 * pilot_samples);
            const Goal goal(picture_, o_.division, until);
            const Tiles tiles(o_, until - picture_.samples);
            std::atomic<std::size_t> finished{0};
            executor.for_each_piece(tiles.size(), 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end && !progress.cancelled(); i += tiles.of_part()) {
                    const std::size_t last = std::min(end, i + tiles.of_part());
                    const bool all_added = add(runs_of(tiles, i, last, goal), [&](std::size_t added) {
                        const std::uint64_t now = done += added;
                        progress(now, std::max(now, all));
                        return !progress.cancelled();
                    });
                    if (all_added) finished += last - i;
                }
            });
            if (finished == tiles.size()) picture_.samples = until;
        }
    }

private:
    /// What the first samples of one half show decides about the other, so that means stay unbiased.
    void divide() {
        for (const int half : {0, 1})
            picture_.spreads[static_cast<std::size_t>(half)] =
                spreads(picture_.light.half(1 - half), picture_.width);
    }
    /// The samples that the pixels of some tiles lack until each half has so many, in the order of paths.
    Runs runs_of(const Tiles& tiles, std::size_t begin, std::size_t end, const Goal& goal) const {
        Runs runs;
        for (std::size_t k = begin; k < end; ++k) {
            const PixelBox tile = tiles[k];
            for (std::size_t i = 0; i < tile.size(); ++i) {
                const auto [x, y] = place(tile, i);
                const std::size_t pixel = camera_.number(x, y);
                for (const int half : {0, 1})
                    runs.add(x, y, half, picture_.light.half(half).samples(pixel), goal(pixel, half));
            }
        }
        return runs;
    }
    /// Adds samples to their pixels, in their order, by parts. `goes_on` is told how many were added after
    /// each part, and may end the work there. Returns whether all were added.
    template <class GoesOn>
    bool add(const Runs& runs, const GoesOn& goes_on) {
        std::vector<PathLight> light;
        PathStartBatch<T> starts(camera_, std::max<std::size_t>(1, o_.in_flight));
        std::size_t started = 0, added = 0;  // runs, since paths are started in order
        for (std::size_t first = 0; first < runs.paths(); first += light.size()) {
            light.resize(std::min(runs.paths() - first, paths_of_part));
            std::size_t prepared = 0;
            follow(
                light.size(),
                [&](std::size_t from, std::size_t to) {
                    starts.clear(), prepared = from;
                    for (std::size_t path = first + from; path < first + to; ++path)
                        starts.add(runs.of(path, started).sample(path));
                    starts.compute();
                },
                [&](std::size_t i) { return starts[i - prepared]; },
                [&](std::size_t i, const PathLight& found) { light[i] = found; });
            for (std::size_t i = 0; i < light.size(); ++i) {
                const Run& run = runs.of(first + i, added);
                picture_.add(camera_.number(run.x, run.y), run.half, light[i]);
            }
            if (!goes_on(light.size()) && first + light.size() < runs.paths()) return false;
        }
        return true;
    }
    template <class Prepare, class OfNumber, class Finish>
    void follow(std::size_t count, const Prepare& prepare, const OfNumber& start,
                const Finish& finish) const {
        if (o_.in_flight > 0)
            return PathWavefront<T>(world_, tracer_, o_.in_flight).follow(count, prepare, start, finish);
        const PathReference<T> reference(world_, tracer_);
        for (std::size_t i = 0; i < count; ++i) {
            prepare(i, i + 1);
            const auto path = start(i);
            finish(i, reference.light(path.ray, path.samples));
        }
    }

    PathPicture& picture_;
    const PathPictureOptions& o_;
    const PathSurfaces<T> surfaces_;
    const PathWorld<T> world_;
    const Tracer<T>& tracer_;
    const PathCamera camera_;
};

/// Follows a path through mirrors and smooth glass up to the first surface that scatters.
template <class T>
FirstSurface first_surface(const PathWorld<T>& world, const Tracer<T>& tracer, const PathStart<T>& start) {
    const PathSteps<T> steps(world);
    const PathRays<T> rays(world.surfaces, tracer);
    PathState<T> path;
    path.ray = start.ray;
    FirstSurface found;
    while (path.vertex <= world.options.bounces) {
        const Hit<T> hit = rays.closest_hit(path.ray, start.samples.ray_key(path.vertex));
        if (!hit) return found;
        if (path.vertex == 0)
            found.depth = static_cast<float>(hit.t), found.primitive = hit.primitive,
            found.instance = hit.instance, found.uv = world.surfaces.texture_coordinates(hit);
        const PathVertex<T> vertex = world.surfaces.at(path.ray, hit);
        const PointScattering<float> scattering = steps.scattering_at(vertex);
        if (!scattering.only_specular() || vertex.unlit) {
            found.albedo = min(tinted(path.throughput, vertex.material.base_colour), Vec3f::all(1));
            found.normal = vertex.shading;
            return found;
        }
        if (!steps.leave(path, vertex, scattering, start.samples)) return found;
    }
    return found;
}

}  // namespace

template <std::floating_point T>
std::vector<FirstSurface> first_surfaces(const PathScene<T>& scene, std::uint32_t samples,
                                         const PathPictureOptions& o) {
    check(samples, o);
    const PathSurfaces<T> surfaces(scene.model);
    const PathWorld<T> world{surfaces, scene.lights, o.paths, nullptr};
    const PathCamera camera(o.camera, o.width, o.height, o.filter, o.paths.sampler, o.paths.seed);
    std::vector<FirstSurface> all(static_cast<std::size_t>(o.width) * static_cast<std::size_t>(o.height));
    o.threads.over(all.size())
        .for_each_piece(static_cast<std::size_t>(o.height), 1, [&](std::size_t begin, std::size_t end) {
            for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                for (int x = 0; x < o.width; ++x) {
                    FirstSurface& mean = all[camera.number(x, y)];
                    Vec3d albedo, normal;
                    for (std::uint32_t k = 0; k < samples; ++k) {
                        const auto [half, sample] = half_sample(o.division, k);
                        const FirstSurface one =
                            first_surface(world, scene.tracer, camera.start<T>({x, y, half, sample}));
                        if (k == 0) mean = one;
                        albedo = albedo + Vec3d(one.albedo), normal = normal + Vec3d(one.normal);
                    }
                    mean.albedo = Vec3f(albedo / static_cast<double>(samples));
                    mean.normal = Vec3f(normal / static_cast<double>(samples));
                }
        });
    return all;
}
template std::vector<FirstSurface> first_surfaces(const PathScene<float>&, std::uint32_t,
                                                  const PathPictureOptions&);
template std::vector<FirstSurface> first_surfaces(const PathScene<double>&, std::uint32_t,
                                                  const PathPictureOptions&);

template <std::floating_point T>
void add_samples(PathPicture& picture, std::uint32_t samples, const PathScene<T>& scene,
                 const PathPictureOptions& options, const Progress& progress) {
    check(samples, options);
    if (picture.width != options.width || picture.height != options.height)
        throw InputError("the picture has another size than its options");
    if (options.keeps_direct && !picture.keeps_direct())
        throw InputError("the picture was begun without its direct light");
    PathTracing<T>(picture, scene, options)
        .run(samples, options.threads.over(picture.light.size()), progress);
}
template void add_samples(PathPicture&, std::uint32_t, const PathScene<float>&, const PathPictureOptions&,
                          const Progress&);
template void add_samples(PathPicture&, std::uint32_t, const PathScene<double>&, const PathPictureOptions&,
                          const Progress&);

}  // namespace hedgerow
