/// The hits of a picture's rays, as layers of numbers beside its colours.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <hedgerow/geometry/vec.h>
#include <hedgerow/looks/layers.h>
#include <hedgerow/queries/hit.h>

namespace hedgerow {

/// The hits of a pixel's rays from the eye; by default no hit.
struct Seen {
    /// The hit of the first ray: its distance, the surface's unit normal on the ray's side, the id of the
    /// primitive.
    float depth = std::numeric_limits<float>::infinity();
    Vec3f normal;
    std::uint32_t id = Hit<float>::none;
    /// Visits to find the hit, the mean over all rays of the pixel.
    float nodes = 0, leaves = 0, primitives = 0;
};

/// The layers of width × height pixels: R, G, B; depth.Z; normal.X, .Y, .Z; id; nodes, leaves, primitives.
/// They borrow from `light` and `seen`. No channels if `seen` is empty.
inline Layers layers_of(int width, int height, const std::vector<Vec3f>& light,
                        const std::vector<Seen>& seen) {
    Layers layers{width, height, {}};
    const auto add = [&]<class Pixel, class V>(const char* name, const std::vector<Pixel>& pixels,
                                               const V& first) {
        layers.channels.push_back({name, Strided<V>(&first, pixels.size(), sizeof(Pixel))});
    };
    if (seen.empty()) return layers;
    const Vec3f& colour = light[0];
    const Seen& s = seen[0];
    add("R", light, colour.data[0]), add("G", light, colour.data[1]), add("B", light, colour.data[2]);
    add("depth.Z", seen, s.depth);
    add("normal.X", seen, s.normal.data[0]), add("normal.Y", seen, s.normal.data[1]);
    add("normal.Z", seen, s.normal.data[2]);
    add("id", seen, s.id);
    add("nodes", seen, s.nodes), add("leaves", seen, s.leaves), add("primitives", seen, s.primitives);
    return layers;
}

}  // namespace hedgerow
