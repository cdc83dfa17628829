/// Kernels of the rasteriser, with the processor's vectors (src/render/), chosen at run time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <hedgerow/base/instruction_set.h>
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

/// What a sample of a visibility buffer (Burns and Hunt 2013) shows: the element that its ray hits first, or
/// none, and how far forward of the eye, within 1/4096 of it.
struct Visible {
    std::uint32_t element = Hit<float>::none;
    float depth = std::numeric_limits<float>::infinity();
};

/// A triangle that may cover some samples of a tile: those in a box.
class TileTriangle {
public:
    static constexpr std::size_t numbers = std::size_t(1) << 20;

    float nearest;  ///< where it covers samples of the tile, it is no nearer forward of the eye

    TileTriangle() = default;
    /// `box` meets the tile in this column and row of tiles.
    TileTriangle(std::size_t number, const PixelBox& box, int column, int row, float nearest_point)
        : nearest(nearest_point),
          packed_(static_cast<std::uint32_t>(number) | place(box.left, column) << 20 |
                  place(box.top, row) << 23 | place(box.right, column) << 26 | place(box.bottom, row) << 29) {
    }
    std::uint32_t number() const { return packed_ & (numbers - 1); }
    PixelBox box(const PixelBox& tile) const {
        const auto at = [&](int first, int shift) { return first + static_cast<int>(place_at(shift)); };
        return {at(tile.left, 20), at(tile.top, 23), at(tile.left, 26), at(tile.top, 29)};
    }
    /// The samples of the box, a bit each.
    std::uint64_t samples() const {
        const std::uint64_t columns = (0xFFu >> (7 - place_at(26))) & (0xFFu << place_at(20));
        const std::uint64_t rows =
            (~std::uint64_t(0) >> (8 * (7 - place_at(29)))) & (~std::uint64_t(0) << (8 * place_at(23)));
        return columns * 0x0101010101010101u & rows;
    }

private:
    static std::uint32_t place(int pixel, int tile) {
        return static_cast<std::uint32_t>(std::clamp(pixel - tile * tile_side, 0, tile_side - 1));
    }
    std::uint32_t place_at(int shift) const { return packed_ >> shift & (tile_side - 1); }

    std::uint32_t packed_;  // the number, and the sides of the box: left, top, right and bottom
};

/// Over a box of pixels, functions of a triangle that are linear in the place of a sample, in pixels from the
/// middle of the box: slopes right and down, and the value in the middle. Where an edge is below -1, no
/// sample is covered; where one is, the triangle is no nearer than `nearness` and `slack` say, 1 by the
/// distance forward of the eye, or of parallel rays the distance below 0. Numbers that are none compare as
/// nothing.
struct TriangleFunctions {
    float edge[3][3], nearness[3], slack;
};

/// A tile of a picture, and the triangles that may cover some of its samples.
struct RasterTile {
    const PicturePlane& plane;
    const PixelBounds::Frame& frame;  ///< that of the triangles' sights
    PixelBox pixels;                  ///< in the picture
    /// Triangles by their numbers from `first` on, best front to back.
    std::span<const TileTriangle> triangles;
    std::uint32_t first = 0;
    /// What is written, hits or a visibility buffer: the place of the tile's first sample, and the number of
    /// samples from row to row. Hits so far count if `onto`, and are written over if not.
    Hit<float>* hits = nullptr;
    Visible* visible = nullptr;
    std::size_t row = 0;
    bool onto = false;
    RasterNames names{};
    /// The rays of its samples, by rows of `tile_side`, all or none of them usable (RayProbe), from the eye
    /// of the plane or parallel; places beyond the picture repeat others. Null: those through the middles of
    /// the pixels, as RayMaker makes them, which are what a visibility buffer shows.
    const Ray<float, 3>* rays = nullptr;
};

struct RasterKernels {
    /// Writes sights[i] for triangle `first + i` of a mesh: what PixelBounds::of tells, but for roundings.
    /// The box of a triangle that has to be cut becomes `uncut`, and is left to that function.
    void (*bounds)(const PixelBounds&, const TriangleMeshView<float>&, std::size_t first,
                   std::span<Sight> sights);
    /// Writes the functions of triangles `first + numbers[i]`, each over a box of pixels.
    void (*functions)(const PixelBounds&, const TriangleMeshView<float>&, std::size_t first,
                      std::span<const std::uint32_t> numbers, const PixelBox* boxes,
                      TriangleFunctions* functions);
    /// Draws triangles into a tile of hits, or of a visibility buffer.
    void (*draw)(const TriangleMeshView<float>&, const RasterTile&);
    void (*see)(const TriangleMeshView<float>&, const RasterTile&);
    /// Computes the hits of a tile from what its samples show.
    void (*resolve)(const TriangleMeshView<float>&, const RasterTile&, const Visible*);
};
inline constexpr PixelBox uncut{-2, -2, -2, -2};

/// The kernels in use, or nullptr for the plain loops.
template <>
const RasterKernels* in_use<RasterKernels>();

}  // namespace hedgerow
