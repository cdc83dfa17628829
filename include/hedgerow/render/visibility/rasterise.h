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
#include <hedgerow/parallel/blocks.h>
#include <hedgerow/parallel/ieee_executor.h>
#include <hedgerow/probes/ray.h>
#include <hedgerow/queries/first_hits.h>
#include <hedgerow/render/visibility/pixel_bounds.h>
#include <hedgerow/render/visibility/raster_kernels.h>
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
        : samples_(samples),
          plane_(samples.plane()),
          columns_((samples.width() + tile_side - 1) / tile_side),
          tiles_(columns_ * ((samples.height() + tile_side - 1) / tile_side)) {
        if (!samples.has_plane()) throw InputError("a panorama or a lens cannot be rasterised: cast rays");
    }

    /// Draws triangles: the view has `triangle(i)`, `id(i)` and `size()`; or the instances of an
    /// InstanceSetView, one after the other. `hits` has a place for each sample, by number. The hits are
    /// those of the samples' rays, and do not depend on the coverage, on the executor, or on the order in
    /// which sets are drawn. Takes about 64 MiB beside them, however many triangles there are. Throws
    /// InputError for too few places.
    template <class Set>
    RasterCounts draw(const Set& set, std::span<Hit<T>> hits, Executor& executor,
                      const RasterOptions& options = {}) {
        return draw(set, hits, executor, options, NoShading());
    }
    /// Forward shading: also calls shade(number, hit) for each fragment that is the nearest of its sample so
    /// far, which rules out the kernels. The last call for a sample is that for its hit. Threads of the
    /// executor call it at the same time, for different samples.
    template <class Set, class Shade>
    RasterCounts draw(const Set& set, std::span<Hit<T>> hits, Executor& executor,
                      const RasterOptions& options, const Shade& shade) {
        detail::expect_room("samples", samples_.size(), hits.size());
        IeeeExecutor threads(executor);
        counts_ = options.counts;
        bool onto = options.onto;
        if constexpr (Instanced<Set>)
            if (!std::exchange(onto, true)) std::fill_n(hits.begin(), samples_.size(), Hit<T>());
        return in_each_space(set, options.first_element, [&](const auto& triangles) {
            return draw_set(triangles, options.coverage, hits, threads, onto, shade);
        });
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
            return in_parts(triangles, Coverage::box, threads, [&](std::size_t first) {
                return counted(bands, 1, threads, [&](std::size_t band, RasterCounts& counts) {
                    const int from = top + static_cast<int>(band) * rows_at_once;
                    const PixelBox rows{0, from, samples_.width() - 1,
                                        std::min(from + rows_at_once - 1, bottom)};
                    for (std::size_t i = 0; i < sights_.size(); ++i)
                        meet_samples(triangles, first + i, common(sights_[i].box, rows), counts, f);
                });
            });
        });
    }
    /// Bytes of memory that drawing has taken so far, beside the hits.
    std::size_t bytes() const {
        const auto of = [](const auto& list) { return list.capacity() * sizeof(list[0]); };
        std::size_t lists = of(lists_);
        for (const auto& list : lists_) lists += of(list);
        return of(rays_) + of(sights_) + lists + of(places_) + of(begins_) + of(listed_);
    }

private:
    /// Calls work(triangles) for a set of triangles, or for each instance of a set, in its space.
    template <class Set, class Work>
    RasterCounts in_each_space(const Set& set, std::uint32_t first_element, Work work) {
        const auto enter = [&](const Affine<3>* back, const RasterNames& names) {
            back_ = back, names_ = names;
            bounds_ = PixelBounds(samples_, back);
        };
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
        return in_parts(triangles, coverage, threads, [&](std::size_t first) {
            const bool over = std::exchange(onto, true);
            return coverage == Coverage::tiles ? draw_in_tiles(triangles, first, hits, threads, over, shade)
                                               : draw_in_bands(triangles, first, hits, threads, over, shade);
        });
    }

    /// Triangles that are looked at together, and entries of triangles in tiles that are sorted together.
    static constexpr std::size_t at_once = std::size_t(1) << 20, entries_at_once = std::size_t(1) << 21;
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
        return std::is_same_v<Triangles, TriangleMeshView<float>> && !counts_ ? raster_kernels() : nullptr;
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
    /// Calls work(first) for some triangles after the other, once it is known where they are seen.
    template <class Triangles, class Work>
    RasterCounts in_parts(const Triangles& triangles, Coverage coverage, Executor& threads, Work work) {
        RasterCounts counts;
        for (std::size_t first = 0; first < std::max<std::size_t>(triangles.size(), 1) && tiles_ > 0;
             first += at_once) {
            const std::size_t count = std::min(at_once, triangles.size() - first);
            look(triangles, first, count, coverage, threads);
            counts += work(first);
            for (const Sight& sight : sights_) counts.outside += sight.box.empty();
            counts.triangles += count;
        }
        return counts;
    }
    /// Finds where triangles from `first` on are seen.
    template <class Triangles>
    void look(const Triangles& triangles, std::size_t first, std::size_t count, Coverage coverage,
              Executor& threads) {
        sights_.resize(count);
        threads.for_each_piece(count, 4096, [&](std::size_t begin, std::size_t end) {
            const std::span<Sight> some(sights_.data() + begin, end - begin);
            std::fill(some.begin(), some.end(),
                      Sight{coverage == Coverage::all ? bounds_.whole() : uncut, 0});
            if (coverage == Coverage::all) return;
            if constexpr (std::is_same_v<Triangles, TriangleMeshView<float>>)
                if (const RasterKernels* const in_lanes = kernels<Triangles>())
                    in_lanes->bounds(bounds_, triangles, first + begin, some);
            for (std::size_t i = begin; i < end; ++i)
                if (sights_[i].box == uncut) sights_[i] = bounds_.of(triangles.triangle(first + i));
        });
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
        return counted(bands, 1, threads, [&](std::size_t band, RasterCounts& counts) {
            const int top = static_cast<int>(band) * band_rows;
            const PixelBox rows =
                common({0, top, samples_.width() - 1, top + band_rows - 1}, bounds_.whole());
            if (!onto) clear(rows, hits);
            for (std::size_t i = 0; i < sights_.size(); ++i)
                test(triangles, first + i, common(sights_[i].box, rows), hits, counts, shade);
        });
    }

    // ---- Tiles: in each, the triangles that may cover a sample of it ----

    template <class Triangles, class Shade>
    RasterCounts draw_in_tiles(const Triangles& triangles, std::size_t first, std::span<Hit<T>> hits,
                               Executor& threads, bool onto, const Shade& shade) {
        RasterCounts counts;
        std::size_t begin = 0;
        do {
            begin = list_triangles(triangles, first, begin, threads);
            counts += counted(static_cast<std::size_t>(tiles_), 16, threads,
                              [&](std::size_t tile, RasterCounts& c) {
                                  draw_tile(triangles, first, static_cast<int>(tile), hits, onto, c, shade);
                              });
            onto = true;
        } while (begin < sights_.size());
        return counts;
    }
    /// Lists triangles from `begin` on by tile, ascending, and returns where that ends: a sort by counting,
    /// over blocks of triangles.
    template <class Triangles>
    std::size_t list_triangles(const Triangles& triangles, std::size_t first, std::size_t begin,
                               Executor& threads) {
        const std::size_t end = end_of_list(begin);
        const Blocks blocks{end - begin, std::size_t(1) << 17};
        const auto tiles = static_cast<std::size_t>(tiles_);
        if (lists_.size() < blocks.number()) lists_.resize(blocks.number());
        places_.resize(blocks.number() * tiles);
        blocks.each(threads, [&](std::size_t block, std::size_t from, std::size_t to) {
            std::uint32_t* const counts = places_.data() + block * tiles;
            std::fill_n(counts, tiles, 0u);
            lists_[block].clear();
            for (std::size_t i = begin + from; i < begin + to; ++i)
                for_each_tile(triangles, first + i, sights_[i].box, [&](std::uint32_t tile) {
                    lists_[block].push_back({tile, static_cast<std::uint32_t>(i)});
                    ++counts[tile];
                });
        });
        // Turn counts into places: by tile, and within a tile by block.
        begins_.resize(tiles + 1);
        std::uint32_t before = 0;
        for (std::size_t tile = 0; tile < tiles; ++tile) {
            begins_[tile] = before;
            for (std::size_t b = 0; b < blocks.number(); ++b)
                before += std::exchange(places_[b * tiles + tile], before);
        }
        begins_[tiles] = before;
        listed_.resize(before);
        blocks.each(threads, [&](std::size_t block, std::size_t, std::size_t) {
            std::uint32_t* const places = places_.data() + block * tiles;
            for (const InTile& entry : lists_[block]) listed_[places[entry.tile]++] = entry.triangle;
        });
        return end;
    }
    /// How far triangles from `begin` on make a list that is not too long.
    std::size_t end_of_list(std::size_t begin) const {
        std::size_t end = begin, total = 0;
        for (; end < sights_.size(); ++end) {
            if (sights_[end].box.empty()) continue;
            const std::size_t more = tiles_of(sights_[end].box);
            if (total > 0 && total + more > entries_at_once) break;
            total += more;
        }
        return end;
    }
    static std::size_t tiles_of(const PixelBox& box) {
        const auto along = [](int first, int last) {
            const int tiles = last / tile_side - first / tile_side + 1;
            return static_cast<std::size_t>(tiles);
        };
        return along(box.left, box.right) * along(box.top, box.bottom);
    }
    PixelBox pixels_of(int tile) const {
        const int left = tile % columns_ * tile_side, top = tile / columns_ * tile_side;
        return common({left, top, left + tile_side - 1, top + tile_side - 1}, bounds_.whole());
    }
    /// Calls f(tile) for the tiles in which a triangle with this box may cover a sample.
    template <class Triangles, class F>
    void for_each_tile(const Triangles& triangles, std::size_t i, const PixelBox& box, F f) const {
        if (box.empty()) return;
        const int left = box.left / tile_side, right = box.right / tile_side, top = box.top / tile_side,
                  bottom = box.bottom / tile_side;
        const auto number = [&](int x, int y) { return static_cast<std::uint32_t>(y * columns_ + x); };
        constexpr std::size_t few = 4;  // to find the edges takes as long as to look at as many tiles in vain
        if (tiles_of(box) <= few) {
            for (int y = top; y <= bottom; ++y)
                for (int x = left; x <= right; ++x) f(number(x, y));
            return;
        }
        const PixelEdges edges(bounds_, triangles.triangle(i));
        for (int y = top; y <= bottom; ++y)
            for (int x = left; x <= right; ++x)
                if (!edges.exclude(pixels_of(static_cast<int>(number(x, y))))) f(number(x, y));
    }
    template <class Triangles, class Shade>
    void draw_tile(const Triangles& triangles, std::size_t first, int tile, std::span<Hit<T>> hits, bool onto,
                   RasterCounts& counts, const Shade& shade) {
        const PixelBox here = pixels_of(tile);
        const auto t = static_cast<std::size_t>(tile);
        const std::span<std::uint32_t> list(listed_.data() + begins_[t], begins_[t + 1] - begins_[t]);
        if (list.empty()) return onto ? void() : clear(here, hits);
        order_front_to_back(list);
        if constexpr (std::is_same_v<Triangles, TriangleMeshView<float>> && shades_nothing<Shade>)
            if (const RasterKernels* const in_lanes = kernels<Triangles>())
                return draw_by_kernel(*in_lanes, triangles, first, here, list, hits, onto);
        if (!onto) clear(here, hits);
        float farthest = farthest_of(here, hits);
        for (const std::uint32_t i : list) {
            if (sights_[i].nearest > farthest)
                ++counts.hidden;
            else if (test(triangles, first + i, common(sights_[i].box, here), hits, counts, shade))
                farthest = farthest_of(here, hits);
        }
    }
    /// Orders triangles by their nearest points in steps: a sort by counting. A few are left as they are.
    void order_front_to_back(std::span<std::uint32_t> list) const {
        constexpr std::size_t few = 8, steps = 32;
        if (list.size() <= few) return;
        static thread_local std::vector<std::uint32_t> given;
        given.assign(list.begin(), list.end());
        float least = std::numeric_limits<float>::max(), most = 0;
        for (const std::uint32_t i : given) {
            least = std::min(least, sights_[i].nearest);
            most = std::max(most, std::min(sights_[i].nearest, std::numeric_limits<float>::max()));
        }
        const float scale = most > least ? (steps - 1) / (most - least) : 0;
        const auto step = [&](std::uint32_t i) {
            return static_cast<std::size_t>((std::min(sights_[i].nearest, most) - least) * scale);
        };
        std::array<std::uint32_t, steps + 1> places{};
        for (const std::uint32_t i : given) ++places[step(i) + 1];
        for (std::size_t k = 0; k < steps; ++k) places[k + 1] += places[k];
        for (const std::uint32_t i : given) list[places[step(i)]++] = i;
    }
    void draw_by_kernel(const RasterKernels& in_lanes, const TriangleMeshView<float>& triangles,
                        std::size_t first, const PixelBox& pixels, std::span<const std::uint32_t> list,
                        std::span<Hit<float>> hits, bool onto) const {
        RasterTile tile{nullptr,
                        plane_,
                        pixels,
                        list,
                        static_cast<std::uint32_t>(first),
                        sights_.data(),
                        &hits[samples_.number(pixels.left, pixels.top)],
                        static_cast<std::size_t>(samples_.width()),
                        onto,
                        names_};
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
    const int columns_, tiles_;
    // What is drawn at the moment.
    PixelBounds bounds_{samples_};
    const Affine<3>* back_ = nullptr;
    RasterNames names_;
    bool counts_ = false;
    std::vector<Prepared> rays_;  // empty until they are needed
    bool rays_placed_ = false;    // whether these are in the space of an instance
    // Of the triangles that are drawn at the moment: where each is seen, and lists of those in each tile.
    struct InTile {
        std::uint32_t tile, triangle;
    };
    BareVector<Sight> sights_;
    std::vector<BareVector<InTile>> lists_;  // by block of triangles
    BareVector<std::uint32_t> places_, begins_, listed_;
};

/// Finds what is visible by drawing triangles, or instances. Borrows the view's arrays.
template <std::floating_point T, class Triangles = TriangleMeshView<T>>
class Rasterising final : public WholePictures<T> {
public:
    explicit Rasterising(const Triangles& triangles, Coverage coverage = Coverage::tiles)
        : triangles_(triangles), coverage_(coverage) {}
    void prepare(const PictureSamples<T>& samples, Executor& executor, PictureCosts& costs) override {
        costs.drawn += Rasteriser<T>(samples).draw(triangles_, this->hits_of(samples), executor, {coverage_});
    }

private:
    const Triangles triangles_;
    const Coverage coverage_;
};

}  // namespace hedgerow
