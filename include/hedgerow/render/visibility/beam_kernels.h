/// Kernels of beams, with the processor's vectors (src/render/), chosen at run time.
#pragma once

#include <cstddef>
#include <cstdint>

#include <hedgerow/engine/kernels.h>
#include <hedgerow/render/visibility/pixel_bounds.h>

namespace hedgerow {

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

/// A tile of a picture. `rays` are those of its samples, by rows of `beam_side`, from the eye of the plane;
/// null for those through the middles of the pixels, as RayMaker makes them. `hits` is the place of the
/// tile's first sample, and `row` the number of samples from row to row.
inline constexpr int beam_side = 64;
struct BeamTile {
    const PicturePlane& plane;
    const PixelBounds::Frame& frame;
    const Ray<float, 3>* rays;
    PixelBox pixels;  ///< in the picture, at most beam_side wide and high
    Hit<float>* hits;
    std::size_t row;
    /// Beams are as wide as this many pixels at most: 8, 16, 32 or 64.
    int widest;
};

struct BeamKernels {
    /// Writes the closest hit of each sample of a tile.
    void (*trace)(const WideScene&, const BeamTile&, BeamCounts&);
};

/// The kernels in use, or nullptr.
const BeamKernels* beam_kernels();

}  // namespace hedgerow
