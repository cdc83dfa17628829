/// What finds the closest hit of each sample of a picture, and what that costs.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include <hedgerow/base/bare_vector.h>
#include <hedgerow/parallel/executor.h>
#include <hedgerow/queries/hit.h>
#include <hedgerow/render/shading/layer_walk.h>
#include <hedgerow/render/visibility/samples.h>
#include <hedgerow/walks/engine.h>
#include <hedgerow/walks/visits.h>

namespace hedgerow {

/// What drawing took. Kernels (raster_kernels.h), which draw tiles of floats, count triangles alone.
struct RasterCounts {
    std::uint64_t triangles = 0;  ///< drawn
    std::uint64_t outside = 0;    ///< of these, how many have a box without samples
    std::uint64_t tests = 0;      ///< of a triangle at a sample
    std::uint64_t nearest = 0;    ///< fragments that were the nearest of their sample so far
    std::uint64_t hidden = 0;     ///< times that a triangle is behind all hits of a tile, and passed over

    RasterCounts& operator+=(const RasterCounts& more) {
        triangles += more.triangles, outside += more.outside, tests += more.tests, nearest += more.nearest,
            hidden += more.hidden;
        return *this;
    }
};

/// What beams did. A visit is a node whose children's boxes are tested, or a leaf whose triangles are, for a
/// whole tile or for a packet of 64 rays.
struct BeamCounts {
    std::uint64_t beams = 0;    ///< tiles of all sizes that were looked at
    std::uint64_t visits = 0;   ///< by beams and by packets
    std::uint64_t filled = 0;   ///< samples of tiles that lie within one triangle, or see nothing
    std::uint64_t packets = 0;  ///< tiles of 8 × 8 that a packet answers, from where their beam ends
    std::uint64_t again = 0;    ///< tiles of 8 × 8 that were answered without their beam

    BeamCounts& operator+=(const BeamCounts& more) {
        beams += more.beams, visits += more.visits, filled += more.filled, packets += more.packets;
        again += more.again;
        return *this;
    }
};

/// What making a picture took.
struct PictureCosts {
    std::uint64_t rays = 0;     ///< cast, those to the light included
    std::uint64_t cones = 0;    ///< in place of rays
    Visits visits;              ///< 0 unless counted
    KernelUse use;              ///< which algorithms answered; no kernel if visits are counted
    RasterCounts drawn;         ///< what rasterising took
    BeamCounts beams;           ///< what beams took
    TransparencyCounts layers;  ///< that rays from the eye went through, where surfaces may be transparent

    PictureCosts& operator+=(const PictureCosts& more) {
        rays += more.rays, cones += more.cones, visits += more.visits, use += more.use, drawn += more.drawn;
        beams += more.beams, layers += more.layers;
        return *this;
    }
};

/// One of the ways to find what is visible. All give a sample the same hit, bit for bit: the closest hit of
/// its ray.
template <std::floating_point T>
class Visibility {
public:
    virtual ~Visibility() = default;

    /// Whether samples of the whole picture are found at once, by `prepare`, which is then called before
    /// `look`, once for each set of samples. Else each call of `look` finds its own.
    virtual bool finds_whole_pictures() const { return false; }
    virtual void prepare(const PictureSamples<T>& samples, Executor& executor, PictureCosts& costs) {
        static_cast<void>(samples), static_cast<void>(executor), static_cast<void>(costs);
    }
    /// Writes the hits of a box of pixels, by rows: those of the samples' rays. Ways that find whole pictures
    /// need the rays of all its pixels, others may be given those of some. With `visits`, adds what was
    /// visited to one count a sample. Threads may look at once.
    virtual void look(const PixelBox& box, std::span<const Ray<T, 3>> rays, std::span<Hit<T>> hits,
                      std::span<Visits> visits, PictureCosts& costs) const = 0;
};

/// A way that finds the hits of a whole picture at once, in a buffer: 28 bytes a sample of float, 48 of
/// double. `prepare` of a derived class fills it.
template <std::floating_point T>
class WholePictures : public Visibility<T> {
public:
    bool finds_whole_pictures() const final { return true; }
    void look(const PixelBox& box, std::span<const Ray<T, 3>>, std::span<Hit<T>> hits, std::span<Visits>,
              PictureCosts&) const final {
        const auto columns = static_cast<std::size_t>(box.width());
        for (int y = box.top; y <= box.bottom; ++y)
            std::copy_n(&hits_[static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(box.left)],
                        columns, &hits[static_cast<std::size_t>(y - box.top) * columns]);
    }

protected:
    /// The buffer, with a place for each sample, by number. What it holds is to be written over.
    std::span<Hit<T>> hits_of(const PictureSamples<T>& samples) {
        hits_.resize(samples.size());
        width_ = static_cast<std::size_t>(samples.width());
        return hits_;
    }

private:
    BareVector<Hit<T>> hits_;
    std::size_t width_ = 0;
};

}  // namespace hedgerow
