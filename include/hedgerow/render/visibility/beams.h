/// Pictures by beams: tiles of a picture descend through an index together with its cells, so that a tile
/// that lies within one triangle, or sees nothing, is found at once (Heckbert and Hanrahan, SIGGRAPH 1984).
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include <hedgerow/ask/rays.h>
#include <hedgerow/base/error.h>
#include <hedgerow/parallel/by.h>
#include <hedgerow/parallel/ieee_executor.h>
#include <hedgerow/render/visibility/beam_kernels.h>
#include <hedgerow/render/visibility/visibility.h>

namespace hedgerow {

struct BeamOptions {
    /// The side of the largest tiles in pixels: 64, 32, 16 or 8. With 0 all rays go in packets, from the
    /// root; to measure what beams save.
    int widest = beam_side;
    /// Which samples matter, by number; empty: all. Of the others some have their hits, and some are left as
    /// they are. So a picture in a mirror takes the time of the part that the mirror covers.
    std::span<const bool> wanted = {};
    /// By which threads. What is answered does not depend on them.
    Threads threads = {};
};

namespace detail {
/// The tiles of a picture, over a kernel.
class BeamPicture {
public:
    BeamPicture(const WideScene& scene, const PictureSamples<float>& samples, const BeamOptions& options)
        : scene_(scene), samples_(samples), plane_(samples.plane()), bounds_(samples), options_(options) {}

    int columns() const { return (samples_.width() + beam_side - 1) / beam_side; }
    std::size_t tiles() const {
        return static_cast<std::size_t>(columns()) *
               static_cast<std::size_t>((samples_.height() + beam_side - 1) / beam_side);
    }
    /// Writes the hits of tile `number`, by rows from the top left.
    void trace(const BeamKernels& kernels, std::size_t number, std::span<Hit<float>> hits,
               BeamCounts& counts) const {
        const int left = static_cast<int>(number) % columns() * beam_side,
                  top = static_cast<int>(number) / columns() * beam_side;
        const PixelBox tile{left, top, std::min(left + beam_side, samples_.width()) - 1,
                            std::min(top + beam_side, samples_.height()) - 1};
        const PixelBox pixels = wanted_of(tile);
        if (pixels.empty()) return;
        std::vector<Ray<float, 3>> rays;
        if (!samples_.in_the_middle()) {
            rays.resize(std::size_t(beam_side) * beam_side);
            for (int y = pixels.top; y <= pixels.bottom; ++y)
                for (int x = pixels.left; x <= pixels.right; ++x)
                    rays[static_cast<std::size_t>((y - pixels.top) * beam_side + x - pixels.left)] =
                        samples_.ray(x, y);
        }
        kernels.trace(scene_,
                      {plane_, bounds_.frame(), rays.empty() ? nullptr : rays.data(), pixels,
                       &hits[samples_.number(pixels.left, pixels.top)],
                       static_cast<std::size_t>(samples_.width()), options_.widest},
                      counts);
    }

private:
    /// The least box of a tile's pixels that holds all samples that matter.
    PixelBox wanted_of(const PixelBox& tile) const {
        if (options_.wanted.empty()) return tile;
        PixelBox box{tile.right + 1, tile.bottom + 1, tile.left - 1, tile.top - 1};
        for (int y = tile.top; y <= tile.bottom; ++y)
            for (int x = tile.left; x <= tile.right; ++x)
                if (options_.wanted[samples_.number(x, y)])
                    box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x),
                           std::max(box.bottom, y)};
        return box;
    }

    const WideScene scene_;
    const PictureSamples<float>& samples_;
    const PicturePlane plane_;
    const PixelBounds bounds_;
    const BeamOptions& options_;
};
}  // namespace detail

/// Writes the closest hit of each sample of a picture to `hits`, by number: the bits that closest_hits writes
/// for the samples' rays, for any executor and options. Beams go through a WideBvh of triangles of float, by
/// kernels, if they come from one eye or its image in a mirror; any other index or camera, or a processor
/// without kernels, is asked the rays, and then nothing is counted. Throws InputError for too few places, and
/// UsageError for another width.
template <class S, class P>
BeamCounts beam_hits(const Index<S, P>& index, const PictureSamples<float>& samples,
                     std::span<Hit<float>> hits, const BeamOptions& options = {}) {
    detail::expect_room("samples", samples.size(), hits.size());
    if (!options.wanted.empty()) detail::expect_room("samples", samples.size(), options.wanted.size());
    if (const int w = options.widest; w != 0 && w != 8 && w != 16 && w != 32 && w != beam_side)
        throw UsageError("beams are 64, 32, 16 or 8 pixels wide, or 0 for none: not " + std::to_string(w));
    BeamCounts sum;
    if constexpr (detail::TrianglesForKernels<Index<S, P>>) {
        if (const BeamKernels* const kernels = in_use<BeamKernels>();
            kernels != nullptr && samples.from_one_eye()) {
            const detail::BeamPicture picture(detail::kernel_scene(index), samples, options);
            std::vector<BeamCounts> counts(picture.tiles());
            IeeeExecutor threads(options.threads.over(samples.size()));
            threads.for_each_piece(counts.size(), 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) picture.trace(*kernels, i, hits, counts[i]);
            });
            for (const BeamCounts& c : counts) sum += c;
            return sum;
        }
    }
    closest_hits(index, samples.rays(), hits.first(samples.size()), {.threads = options.threads});
    return sum;
}

/// Finds what is visible by beams through an index. Samples of double are rays of `closest_hits`. Borrows the
/// index.
template <class I>
class BeamTracing final : public WholePictures<typename I::Scalar> {
public:
    using T = typename I::Scalar;

    explicit BeamTracing(const I& index) : index_(index) {}
    void prepare(const PictureSamples<T>& samples, Executor& executor, PictureCosts& costs) override {
        const std::span<Hit<T>> hits = this->hits_of(samples);
        if constexpr (std::same_as<T, float>)
            costs.beams += beam_hits(index_, samples, hits, {.threads = executor});
        else
            closest_hits(index_, samples.rays(), hits, {.threads = executor});
        costs.rays += samples.size();
    }

private:
    const I& index_;
};

}  // namespace hedgerow
