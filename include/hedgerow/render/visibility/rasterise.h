/// The rasteriser: for each triangle, the samples of a picture that it covers (the lecture's first loop; a
/// ray caster asks for each sample which triangles cover it). Both fill a buffer with the closest hit of each
/// sample, with the same bits: a projection says which samples a triangle may cover (pixel_bounds.h), and the
/// test of a ray and a triangle decides.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <hedgerow/ask/asking.h>
#include <hedgerow/base/bare_vector.h>
#include <hedgerow/instances/instance_set.h>
#include <hedgerow/parallel/by.h>
#include <hedgerow/parallel/ieee_executor.h>
#include <hedgerow/probes/ray.h>
#include <hedgerow/queries/first_hits.h>
#include <hedgerow/render/visibility/pixel_bounds.h>
#include <hedgerow/render/visibility/raster_kernels.h>
#include <hedgerow/render/visibility/tile_lists.h>
#include <hedgerow/render/visibility/visibility.h>

namespace hedgerow {

/// At which samples a triangle is tested: at all; at those in its box of pixels; at those in its box, tile by
/// tile of 8 × 8 pixels and front to back, but in no tile of which all hits are nearer.
enum class Coverage { all, box, tiles };

struct RasterOptions {
    Coverage coverage = Coverage::tiles;
    /// Whether what the buffer holds counts too: hits of sets that were drawn before. Else it is written
    /// over.
    bool onto = false;
    /// Whether tests are counted, which rules out the kernels.
    bool counts = false;
    /// The number of the first triangle: where a set is a part of a larger one.
    std::uint32_t first_element = 0;
    /// By which threads. What is answered does not depend on them.
    Threads threads = {};
};
/// By which threads a visibility buffer is drawn or resolved.
struct VisibleOptions {
    Threads threads = {};
};

/// Shades no fragment: what is seen is shaded later, once (Saito and Takahashi 1990), or not at all.
struct NoShading {
    template <class T>
    void operator()(std::size_t, const Hit<T>&) const {}
};

/// Draws sets of triangles, one after the other, into a buffer with a Hit for each sample.
template <class T>
class Rasteriser {
public:
    explicit Rasteriser(const PictureSamples<T>& samples)
        : samples_(samples), plane_(samples.plane()), lists_(samples.width(), samples.height()) {
        if (!samples.has_plane()) throw InputError("a panorama or a lens cannot be rasterised: cast rays");
    }

    /// Draws triangles: the view has `triangle(i)`, `id(i)` and `size()`; or the instances of an
    /// InstanceSetView, one after the other. `hits` has a place for each sample, by number. The hits are
    /// those of the samples' rays, and do not depend on the coverage, on the executor, or on the order in
    /// which sets are drawn. Takes about 64 MiB beside them, however many triangles there are. Throws
    /// InputError for too few places.
    template <class Set>
    RasterCounts draw(const Set& set, std::span<Hit<T>> hits, const RasterOptions& options = {}) {
        return draw(set, hits, options, NoShading());
    }
    /// Forward shading: also calls shade(number, hit) for each fragment that is the nearest of its sample so
    /// far, which rules out the kernels. The last call for a sample is that for its hit. Threads of the
    /// executor call it at the same time, for different samples.
    template <class Set, class Shade>
    RasterCounts draw(const Set& set, std::span<Hit<T>> hits, const RasterOptions& options,
                      const Shade& shade) {
        detail::expect_room("samples", samples_.size(), hits.size());
        IeeeExecutor threads(options.threads.over(samples_.size()));
        counts_ = options.counts;
        bool onto = options.onto;
        if constexpr (Instanced<Set>)
            if (!std::exchange(onto, true)) std::fill_n(hits.begin(), samples_.size(), Hit<T>());
        return in_each_space(set, options.first_element, [&](const auto& triangles) {
            return draw_set(triangles, options.coverage, hits, threads, onto, shade);
        });
    }

    /// Draws a visibility buffer: what `draw` finds, in 8 bytes a sample, by number. `resolve` computes the
    /// hits. With kernels, for samples in the middles of their pixels and up to about a million triangles, it
    /// takes less time and memory than hits do; else hits are drawn first. Throws InputError for too few
    /// places.
    RasterCounts draw_visible(const TriangleMeshView<T>& mesh, std::span<Visible> visible,
                              const VisibleOptions& options = {}) {
        detail::expect_room("samples", samples_.size(), visible.size());
        IeeeExecutor threads(options.threads.over(samples_.size()));
        counts_ = false;
        enter(nullptr, {});
        if (see_in_tiles(mesh, visible, threads)) return {mesh.size()};
        BareVector<Hit<T>> hits(samples_.size());
        const RasterCounts counts = draw(mesh, hits, {.threads = threads});
        for_each_row(threads, [&](int x, int y, std::size_t i) {
            visible[i] = {hits[i].element, static_cast<float>(forward_of(x, y, hits[i].t))};
        });
        return counts;
    }
    /// Computes the hits of a visibility buffer of the same samples and mesh: those that `draw` finds. A
    /// sample whose ray does not hit its element gets no hit. Throws InputError for an element that the mesh
    /// has not, and for too few places.
    void resolve(const TriangleMeshView<T>& mesh, std::span<const Visible> visible, std::span<Hit<T>> hits,
                 const VisibleOptions& options = {}) {
        detail::expect_room("samples", samples_.size(), std::min(visible.size(), hits.size()));
        for (const Visible& v : visible.first(samples_.size()))
            if (v.element >= mesh.size() && v.element != Hit<T>::none)
                throw InputError("the visibility buffer names element " + std::to_string(v.element) +
                                 " of a mesh of " + std::to_string(mesh.size()) + " triangles");
        IeeeExecutor threads(options.threads.over(samples_.size()));
        counts_ = false;
        enter(nullptr, {});
        resolve_samples(mesh, visible, hits, threads);
    }

    /// Calls f(number, hit) for each sample in some rows of the picture and each triangle that covers it, of
    /// one sample in the order of the triangles: the fragments of the rows. Threads of the executor call f at
    /// the same time, for different samples.
    template <class Set, class F>
    RasterCounts for_each_fragment(const Set& set, int top, int bottom, Executor& executor, F f) {
        IeeeExecutor threads(executor);
        constexpr int rows_at_once = 16;
        const auto bands = static_cast<std::size_t>((bottom - top + rows_at_once) / rows_at_once);
        return in_each_space(set, 0, [&](const auto& triangles) {
            prepare_rays(threads);
            return in_parts(triangles, [&](std::size_t first, std::size_t count) {
                look(triangles, first, count, Coverage::box, threads);
                RasterCounts sum = counted(bands, 1, threads, [&](std::size_t band, RasterCounts& counts) {
                    const int from = top + static_cast<int>(band) * rows_at_once;
                    const PixelBox rows{0, from, samples_.width() - 1,
                                        std::min(from + rows_at_once - 1, bottom)};
                    for (std::size_t i = 0; i < sights_.size(); ++i)
                        meet_samples(triangles, first + i, common(sights_[i].box, rows), counts, f);
                });
                sum.outside = outside();
                return sum;
            });
        });
    }
    /// Bytes of memory that drawing has taken so far, beside the hits.
    std::size_t bytes() const {
        return rays_.capacity() * sizeof(rays_[0]) + sights_.capacity() * sizeof(sights_[0]) + lists_.bytes();
    }

private:
    /// Enters the space of triangles, to which `back` leads; null: they are in the world.
    void enter(const Affine<3>* back, const RasterNames& names) {
        back_ = back, names_ = names;
        bounds_ = PixelBounds(samples_, back);
    }
    /// Calls work(triangles) for a set of triangles, or for each instance of a set, in its space.
    template <class Set, class Work>
    RasterCounts in_each_space(const Set& set, std::uint32_t first_element, Work work) {
        RasterCounts counts;
        if constexpr (Instanced<Set>) {
            for (std::uint32_t i = 0; i < set.size(); ++i) {
                enter(&set[i].transform().back(), {0, i, set[i].geometry(), true});
                counts += work(set[i].index().primitives());
            }
        } else {
            enter(nullptr, {first_element, 0, 0, false});
            counts = work(set);
        }
        return counts;
    }
    /// Draws triangles of one space.
    template <class Triangles, class Shade>
    RasterCounts draw_set(const Triangles& triangles, Coverage coverage, std::span<Hit<T>> hits,
                          Executor& threads, bool onto, const Shade& shade) {
        if (!(coverage == Coverage::tiles && shades_nothing<Shade> && uses_kernels<Triangles>()))
            prepare_rays(threads);
        return in_parts(triangles, [&](std::size_t first, std::size_t count) {
            const bool over = std::exchange(onto, true);
            if (coverage == Coverage::tiles)
                return draw_in_tiles(triangles, first, count, hits, threads, over, shade);
            look(triangles, first, count, coverage, threads);
            return draw_in_bands(triangles, first, hits, threads, over, shade);
        });
    }

    static constexpr std::size_t at_once = TileTriangle::numbers;  // triangles that are looked at together
    static constexpr int band_rows = 64;
    struct Prepared {
        WatertightRay<T> ray;
        bool usable = false;
    };

    template <class Shade>
    static constexpr bool shades_nothing = std::is_same_v<Shade, NoShading>;
    /// The kernels for such triangles, or null.
    template <class Triangles>
    const RasterKernels* kernels() const {
        return std::is_same_v<Triangles, TriangleMeshView<float>> && !counts_ ? in_use<RasterKernels>()
                                                                              : nullptr;
    }
    template <class Triangles>
    bool uses_kernels() const {
        return kernels<Triangles>() != nullptr;
    }
    /// The ray of a sample, in the space of the triangles.
    Ray<T, 3> ray(int x, int y) const {
        const Ray<T, 3> ray = samples_.ray(x, y);
        return back_ != nullptr ? ray_inside(*back_, ray) : ray;
    }
    /// Prepares the rays of all samples, unless they are those that were prepared last.
    void prepare_rays(Executor& threads) {
        if (!rays_.empty() && back_ == nullptr && !rays_placed_) return;
        rays_placed_ = back_ != nullptr;
        rays_.assign(samples_.size(), Prepared());
        const auto width = static_cast<std::size_t>(samples_.width());
        threads.for_each_piece(rays_.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const auto given = ray(static_cast<int>(i % width), static_cast<int>(i / width));
                const RayProbe<T, 3> probe(given, {given.origin, given.origin});
                if (probe.usable()) rays_[i] = {probe.watertight(), true};
            }
        });
    }
    /// Calls work(first, count) for some triangles after the other.
    template <class Triangles, class Work>
    RasterCounts in_parts(const Triangles& triangles, Work work) {
        RasterCounts counts;
        for (std::size_t first = 0; first < std::max<std::size_t>(triangles.size(), 1) && lists_.size() > 0;
             first += at_once) {
            const std::size_t count = std::min(at_once, triangles.size() - first);
            counts += work(first, count);
            counts.triangles += count;
        }
        return counts;
    }
    template <class Triangles>
    TrianglesSeen<Triangles> seen(const Triangles& triangles) const {
        return {triangles, bounds_, kernels<Triangles>()};
    }
    /// Finds where triangles from `first` on are seen.
    template <class Triangles>
    void look(const Triangles& triangles, std::size_t first, std::size_t count, Coverage coverage,
              Executor& threads) {
        sights_.resize(count);
        threads.for_each_piece(count, 4096, [&](std::size_t begin, std::size_t end) {
            const std::span<Sight> some(sights_.data() + begin, end - begin);
            if (coverage == Coverage::all)
                std::fill(some.begin(), some.end(), Sight{bounds_.whole(), 0});
            else
                seen(triangles).find_sights(first + begin, some);
        });
    }
    std::uint64_t outside() const {
        return static_cast<std::uint64_t>(
            std::ranges::count_if(sights_, [](const Sight& s) { return s.box.empty(); }));
    }
    /// Calls work(i, counts) for i below `count`, over the executor, and sums up the counts.
    template <class Work>
    static RasterCounts counted(std::size_t count, std::size_t grain, Executor& threads, Work work) {
        std::vector<RasterCounts> counts(count);
        threads.for_each_piece(count, grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) work(i, counts[i]);
        });
        RasterCounts sum;
        for (const RasterCounts& c : counts) sum += c;
        return sum;
    }

    // ---- Bands of rows: in each, all triangles in their order, each at the samples in its box ----

    template <class Triangles, class Shade>
    RasterCounts draw_in_bands(const Triangles& triangles, std::size_t first, std::span<Hit<T>> hits,
                               Executor& threads, bool onto, const Shade& shade) {
        const auto bands = static_cast<std::size_t>((samples_.height() + band_rows - 1) / band_rows);
        RasterCounts sum = counted(bands, 1, threads, [&](std::size_t band, RasterCounts& counts) {
            const int top = static_cast<int>(band) * band_rows;
            const PixelBox rows =
                common({0, top, samples_.width() - 1, top + band_rows - 1}, bounds_.whole());
            if (!onto) clear(rows, hits);
            for (std::size_t i = 0; i < sights_.size(); ++i)
                test(triangles, first + i, common(sights_[i].box, rows), hits, counts, shade);
        });
        sum.outside = outside();
        return sum;
    }

    // ---- Tiles: in each, the triangles that may cover a sample of it ----

    template <class Triangles, class Shade>
    RasterCounts draw_in_tiles(const Triangles& triangles, std::size_t first, std::size_t count,
                               std::span<Hit<T>> hits, Executor& threads, bool onto, const Shade& shade) {
        RasterCounts counts;
        lists_.start(first, count);
        for (bool all = false; !all; onto = true) {
            all = lists_.fill(seen(triangles), threads);
            counts += counted(static_cast<std::size_t>(lists_.size()), 16, threads,
                              [&](std::size_t tile, RasterCounts& c) {
                                  draw_tile(triangles, first, static_cast<int>(tile), hits, onto, c, shade);
                              });
        }
        counts.outside = lists_.outside();
        return counts;
    }
    template <class Triangles, class Shade>
    void draw_tile(const Triangles& triangles, std::size_t first, int tile, std::span<Hit<T>> hits, bool onto,
                   RasterCounts& counts, const Shade& shade) {
        const PixelBox here = lists_.pixels(tile);
        const auto list = lists_.front_to_back(tile);
        if (list.empty()) return onto ? void() : clear(here, hits);
        if constexpr (std::is_same_v<Triangles, TriangleMeshView<float>> && shades_nothing<Shade>)
            if (const RasterKernels* const in_lanes = kernels<Triangles>())
                return draw_by_kernel(*in_lanes, triangles, first, here, list, hits, onto);
        if (!onto) clear(here, hits);
        float farthest = farthest_of(here, hits);
        for (const TileTriangle& triangle : list) {
            if (triangle.nearest > farthest)
                ++counts.hidden;
            else if (test(triangles, first + triangle.number(), triangle.box(here), hits, counts, shade))
                farthest = farthest_of(here, hits);
        }
    }
    RasterTile tile_of(const PixelBox& pixels, std::size_t first, std::span<const TileTriangle> list) const {
        RasterTile tile{plane_, bounds_.frame(), pixels, list};
        tile.first = static_cast<std::uint32_t>(first);
        tile.row = static_cast<std::size_t>(samples_.width()), tile.names = names_;
        return tile;
    }
    void draw_by_kernel(const RasterKernels& in_lanes, const TriangleMeshView<float>& triangles,
                        std::size_t first, const PixelBox& pixels, std::span<const TileTriangle> list,
                        std::span<Hit<float>> hits, bool onto) const {
        RasterTile tile = tile_of(pixels, first, list);
        tile.hits = &hits[samples_.number(pixels.left, pixels.top)], tile.onto = onto;
        if (samples_.in_the_middle() && back_ == nullptr) return in_lanes.draw(triangles, tile);
        // Make the rays. Those of an instance may be unusable: others take their places.
        std::array<Ray<float, 3>, tile_side * tile_side> rays;
        std::uint64_t unusable = 0;
        int usable = -1;
        for (int i = 0; i < tile_side * tile_side; ++i) {
            Ray<float, 3>& one = rays[static_cast<std::size_t>(i)];
            one = ray(std::min(pixels.left + i % tile_side, pixels.right),
                      std::min(pixels.top + i / tile_side, pixels.bottom));
            if (back_ != nullptr && !RayProbe<float, 3>(one, {one.origin, one.origin}).usable())
                unusable |= std::uint64_t(1) << i;
            else
                usable = i;
        }
        tile.rays = rays.data();
        if (unusable == 0 || usable < 0) return in_lanes.draw(triangles, tile);
        std::array<Hit<float>, tile_side * tile_side> before;
        const auto each_unusable = [&](auto f) {
            for (std::uint64_t left = unusable; left != 0; left &= left - 1) {
                const int i = std::countr_zero(left), x = i % tile_side, y = i / tile_side;
                if (pixels.left + x <= pixels.right && pixels.top + y <= pixels.bottom)
                    f(static_cast<std::size_t>(i), hits[samples_.number(pixels.left + x, pixels.top + y)]);
            }
        };
        each_unusable([&](std::size_t i, const Hit<float>& hit) { before[i] = onto ? hit : Hit<float>(); });
        for (std::uint64_t left = unusable; left != 0; left &= left - 1)
            rays[static_cast<std::size_t>(std::countr_zero(left))] = rays[static_cast<std::size_t>(usable)];
        in_lanes.draw(triangles, tile);
        each_unusable([&](std::size_t i, Hit<float>& hit) { hit = before[i]; });
    }

    // ---- Visibility buffers ----

    /// Draws one by kernels. False where that cannot be, or takes more than one list of triangles.
    template <class Triangles>
    bool see_in_tiles(const Triangles& triangles, std::span<Visible> visible, Executor& threads) {
        if constexpr (std::is_same_v<Triangles, TriangleMeshView<float>>) {
            const RasterKernels* const in_lanes = kernels<Triangles>();
            if (in_lanes == nullptr || !samples_.in_the_middle() || triangles.size() > at_once) return false;
            lists_.start(0, triangles.size());
            if (!lists_.fill(seen(triangles), threads)) return false;
            for_each_tile(threads, [&](int number) {
                const PixelBox here = lists_.pixels(number);
                const auto list = lists_.front_to_back(number);
                if (list.empty()) {
                    for (int y = here.top; y <= here.bottom; ++y)
                        std::fill_n(&visible[samples_.number(here.left, y)], here.width(), Visible());
                    return;
                }
                RasterTile tile = tile_of(here, 0, list);
                tile.visible = &visible[samples_.number(here.left, here.top)];
                in_lanes->see(triangles, tile);
            });
            return true;
        } else {
            return false;
        }
    }
    template <class Triangles>
    void resolve_samples(const Triangles& triangles, std::span<const Visible> visible, std::span<Hit<T>> hits,
                         Executor& threads) {
        if constexpr (std::is_same_v<Triangles, TriangleMeshView<float>>) {
            const RasterKernels* const in_lanes = kernels<Triangles>();
            if (in_lanes != nullptr && samples_.in_the_middle()) {
                for_each_tile(threads, [&](int number) {
                    const PixelBox here = lists_.pixels(number);
                    const std::size_t first = samples_.number(here.left, here.top);
                    RasterTile tile = tile_of(here, 0, {});
                    tile.hits = &hits[first];
                    in_lanes->resolve(triangles, tile, &visible[first]);
                });
                return;
            }
        }
        prepare_rays(threads);
        for_each_row(threads, [&](int x, int y, std::size_t i) {
            hits[i] = {};
            if (visible[i].element == Hit<T>::none) return;
            RasterCounts counts;
            meet_samples(triangles, visible[i].element, {x, y, x, y}, counts,
                         [&](std::size_t s, const Hit<T>& hit) { hits[s] = hit; });
        });
    }
    /// How far forward of the eye the point at t on the ray of a sample is.
    double forward_of(int x, int y, T t) const {
        if (plane_.parallel || !(t <= std::numeric_limits<T>::max())) return static_cast<double>(t);
        return static_cast<double>(t) * dot(Vec3d(samples_.ray(x, y).direction), Vec3d(plane_.forward));
    }
    /// Calls f(tile) over the executor; or f(x, y, number) for each sample.
    template <class F>
    void for_each_tile(Executor& threads, F f) const {
        threads.for_each_piece(static_cast<std::size_t>(lists_.size()), 16,
                               [&](std::size_t begin, std::size_t end) {
                                   for (std::size_t t = begin; t < end; ++t) f(static_cast<int>(t));
                               });
    }
    template <class F>
    void for_each_row(Executor& threads, F f) const {
        threads.for_each_piece(static_cast<std::size_t>(samples_.height()), 8,
                               [&](std::size_t begin, std::size_t end) {
                                   for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                                       for (int x = 0; x < samples_.width(); ++x)
                                           f(x, y, samples_.number(x, y));
                               });
    }

    // ---- A triangle at some samples ----

    static PixelBox common(const PixelBox& a, const PixelBox& b) {
        return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right),
                std::min(a.bottom, b.bottom)};
    }
    void clear(const PixelBox& box, std::span<Hit<T>> hits) const {
        for (int y = box.top; y <= box.bottom; ++y)
            std::fill_n(&hits[samples_.number(box.left, y)], box.right - box.left + 1, Hit<T>());
    }
    /// Calls f(number, hit) for the samples of a box that a triangle covers.
    template <class Triangles, class F>
    void meet_samples(const Triangles& triangles, std::size_t i, const PixelBox& box, RasterCounts& counts,
                      F f) const {
        if (box.empty()) return;
        const auto triangle = triangles.triangle(i);
        for (int y = box.top; y <= box.bottom; ++y)
            for (int x = box.left; x <= box.right; ++x) {
                const std::size_t s = samples_.number(x, y);
                ++counts.tests;
                if (!rays_[s].usable) continue;
                const auto m = meet(rays_[s].ray, triangle);
                if (!m || !(m->t >= 0 && m->t <= std::numeric_limits<T>::max())) continue;
                f(s, Hit<T>{m->t, m->u, m->v, triangles.id(i) + names_.first_element, names_.geometry,
                            names_.instance, static_cast<std::uint32_t>(i) + names_.first_element});
            }
    }
    /// Tests a triangle at the samples of a box. Returns whether it is the closest hit of any.
    template <class Triangles, class Shade>
    bool test(const Triangles& triangles, std::size_t i, const PixelBox& box, std::span<Hit<T>> hits,
              RasterCounts& counts, const Shade& shade) const {
        bool found = false;
        meet_samples(triangles, i, box, counts, [&](std::size_t s, const Hit<T>& hit) {
            if (hit_before(hits[s], hit)) return;
            hits[s] = hit;
            shade(s, hit);
            ++counts.nearest;
            found = true;
        });
        return found;
    }
    /// No hit in a box of pixels is farther forward of the eye than this: directions have length 1, but for
    /// roundings. Infinite where a sample has none.
    float farthest_of(const PixelBox& box, std::span<const Hit<T>> hits) const {
        T most = 0;
        for (int y = box.top; y <= box.bottom; ++y)
            for (int x = box.left; x <= box.right; ++x) most = std::max(most, hits[samples_.number(x, y)].t);
        return static_cast<float>(most) * (1 + 0x1p-18f);
    }

    const PictureSamples<T> samples_;
    const PicturePlane plane_;
    // What is drawn at the moment.
    PixelBounds bounds_{samples_};
    const Affine<3>* back_ = nullptr;
    RasterNames names_;
    bool counts_ = false;
    std::vector<Prepared> rays_;  // empty until they are needed
    bool rays_placed_ = false;    // whether these are in the space of an instance
    TileLists lists_;
    BareVector<Sight> sights_;  // where each triangle is seen that is drawn at the moment, but in tiles
};

/// Finds what is visible by drawing triangles, or instances. Borrows the view's arrays.
template <std::floating_point T, class Triangles = TriangleMeshView<T>>
class Rasterising final : public WholePictures<T> {
public:
    explicit Rasterising(const Triangles& triangles, Coverage coverage = Coverage::tiles)
        : triangles_(triangles), coverage_(coverage) {}
    void prepare(const PictureSamples<T>& samples, Executor& executor, PictureCosts& costs) override {
        costs.drawn += Rasteriser<T>(samples).draw(triangles_, this->hits_of(samples),
                                                   {.coverage = coverage_, .threads = executor});
    }

private:
    const Triangles triangles_;
    const Coverage coverage_;
};

}  // namespace hedgerow
