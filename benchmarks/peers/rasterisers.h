/// Other rasterisers, to be measured beside ours: those that were found when the benchmark was compiled, or
/// null.
#pragma once

#include <memory>
#include <span>
#include <string>

#include <hedgerow/primitives/triangle_mesh.h>
#include <hedgerow/render/camera/camera.h>

namespace hedgerow {

/// A library's rasteriser with a mesh in its memory.
class RasterPeer {
public:
    virtual ~RasterPeer() = default;
    virtual std::string name() const = 0;
    /// Draws the number of the triangle and the depth of each pixel into buffers of its own.
    virtual void draw() = 0;
    /// Writes those numbers by rows from the top left; `Hit<float>::none` where nothing was drawn.
    virtual void read(std::span<std::uint32_t> elements) = 0;
};

/// Mesa's llvmpipe, which draws into memory (OSMesa), on one thread: numbers of 32 bits and depths of 32
/// bits.
std::unique_ptr<RasterPeer> osmesa(const TriangleMesh<float>& mesh, const Camera& camera, int width,
                                   int height);

#if !HEDGEROW_HAS_OSMESA
inline std::unique_ptr<RasterPeer> osmesa(const TriangleMesh<float>&, const Camera&, int, int) {
    return nullptr;
}
#endif

}  // namespace hedgerow
