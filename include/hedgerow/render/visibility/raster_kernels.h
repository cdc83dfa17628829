/// Kernels of the rasteriser, with the processor's vectors (src/render/), chosen at run time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <hedgerow/primitives/triangle_mesh.h>
#include <hedgerow/queries/hit.h>
#include <hedgerow/render/visibility/pixel_bounds.h>

namespace hedgerow {

/// The side of a tile, in pixels.
inline constexpr int tile_side = 8;

/// What the hits of a set of triangles report, beside t, u and v.
struct RasterNames {
    std::uint32_t first_element = 0;  ///< that of the set's first triangle; added to its id, too
    std::uint32_t instance = 0, geometry = 0;
    bool placed = false;  ///< whether the set is an instance: rays are in its space
};

/// A tile of a picture, and the triangles that may cover some of its samples.
struct RasterTile {
    /// The rays of its samples, by rows of `tile_side`, all or none of them usable (RayProbe), from the eye
    /// of the plane or parallel; places beyond the picture repeat others. Null: those through the middles of
    /// the pixels, as RayMaker makes them.
    const Ray<float, 3>* rays;
    const PicturePlane& plane;
    PixelBox pixels;  ///< in the picture
    /// Triangles by their numbers from `first` on, best front to back, and where each of these is seen.
    std::span<const std::uint32_t> triangles;
    std::uint32_t first;
    const Sight* sights;
    /// The hits: that of the tile's first sample, and the number of samples from row to row. Hits so far
    /// count if `onto`, and are written over if not.
    Hit<float>* hits;
    std::size_t row;
    bool onto;
    RasterNames names;
};

struct RasterKernels {
    /// Writes sights[i] for triangle `first + i` of a mesh: what PixelBounds::of tells, but for roundings.
    /// The box of a triangle that has to be cut becomes `uncut`, and is left to that function.
    void (*bounds)(const PixelBounds&, const TriangleMeshView<float>&, std::size_t first,
                   std::span<Sight> sights);
    /// Draws triangles into a tile.
    void (*draw)(const TriangleMeshView<float>&, const RasterTile&);
};
inline constexpr PixelBox uncut{-2, -2, -2, -2};

/// The kernels in use, or nullptr for the plain loops.
const RasterKernels* raster_kernels();

}  // namespace hedgerow
