/// Kernels of beams, with the processor's vectors (src/render/), chosen at run time.
#pragma once

#include <cstddef>
#include <cstdint>

#include <hedgerow/engine/kernels.h>
#include <hedgerow/render/visibility/pixel_bounds.h>
#include <hedgerow/render/visibility/visibility.h>

namespace hedgerow {

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
template <>
const BeamKernels* in_use<BeamKernels>();

}  // namespace hedgerow
