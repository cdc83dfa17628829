/// The rays of a tile of 64 samples, and the triangles that they are tested against: the test of a packet's
/// rays against the triangles of a leaf, where the leaf is eight triangles, each with samples of its own.
#if defined(HEDGEROW_RENDER_TILE_RAYS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_RENDER_TILE_RAYS_INL_H
#undef HEDGEROW_RENDER_TILE_RAYS_INL_H
#else
#define HEDGEROW_RENDER_TILE_RAYS_INL_H
#endif

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>

#include <hedgerow/render/visibility/raster_kernels.h>

#include "engine/coordinates-inl.h"
#include "engine/packet_hits-inl.h"
#include "picture_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Writes the corners of a triangle to a place of a block.
HWY_INLINE void take_corners(const TriangleMeshView<float>& mesh, std::size_t number,
                             TriangleBlock<float>& block, int place) {
    const auto corners = mesh.indices(number);
    for (std::size_t c = 0; c < 3; ++c) {
        const Vec<float, 3> p = mesh.vertex(corners[c]);
        for (std::size_t k = 0; k < 3; ++k) block.corner[k][c][place] = p[static_cast<int>(k)];
    }
}

class TileRays {
public:
    using F = PacketRays::F;
    using V = PacketRays::V;
    using M = PacketRays::M;
    static constexpr F f{};
    static constexpr auto u32 = PacketRays::u32;
    static constexpr int lanes = PacketRays::lanes, parts = PacketRays::parts, size = PacketRays::size;
    static constexpr std::uint32_t none = Hit<float>::none;

    TileRays(const TriangleMeshView<float>& mesh, const RasterTile& tile)
        : mesh_(mesh), tile_(tile), scene_{no_tree(), nullptr, {}} {}

    // Triangles that wait for the test, and at which samples.
    struct Waiting {
        TriangleBlock<float> block;
        std::uint64_t samples[8];
        int count = 0;

        bool full() const { return count == 8; }
    };
    HWY_INLINE void add(Waiting& waiting, std::uint32_t number, std::uint64_t samples) const {
        take(waiting.block, waiting.count, number);
        waiting.samples[waiting.count++] = samples;
    }

protected:
    // Makes the rays. Returns the ways that they go, a bit each; 0 if none is usable.
    HWY_INLINE std::uint32_t make_rays() {
        return tile_.rays != nullptr ? rays_.look(RayArray<float, 3>(tile_.rays, size), 0, tile_side)
                                     : rays_.look([&](int p) { rays_through_middles(p); });
    }
    // Prepares those that go this way, without hits.
    HWY_INLINE void prepare_rays(std::uint32_t way) {
        rays_.prepare_for_triangles(way, !tile_.plane.parallel);
        rays_.clear_hits();
    }
    // Tests what waits. True if a ray was hit.
    HWY_INLINE bool test(Waiting& waiting) {
        for (int i = waiting.count; i < 8; ++i) waiting.samples[i] = 0;
        waiting.count = 0;
        return rays_.test_each(scene_, waiting.block, waiting.samples);
    }
    HWY_INLINE void take(TriangleBlock<float>& block, int place, std::uint32_t number) const {
        take_corners(mesh_, number, block, place);
        block.id[place] = number + tile_.names.first_element;
    }
    // Of the samples of a row of elements, those of one element, a bit each.
    static HWY_INLINE std::uint64_t samples_of(const std::uint32_t* elements, std::uint32_t element) {
        std::uint64_t samples = 0;
        for (int at = 0; at < size; at += lanes) {
            const auto alike = hn::Eq(hn::Load(u32, elements + at), hn::Set(u32, element));
            samples |= std::uint64_t(bits_of(u32, alike)) << at;
        }
        return samples;
    }
    // Calls each(element, samples) for each element of a row, among these samples.
    template <class Each>
    static HWY_INLINE void for_each_element(const std::uint32_t* elements, std::uint64_t samples, Each each) {
        while (samples != 0) {
            const std::uint32_t element = elements[std::countr_zero(samples)];
            const std::uint64_t alike = samples_of(elements, element) & samples;
            samples &= ~alike;
            each(element, alike);
        }
    }
    // Calls each(i, at) for the samples in the picture, and their places in the buffer.
    template <class Each>
    HWY_INLINE void for_each_sample(Each each) const {
        for (int y = 0; y < tile_.pixels.height(); ++y)
            for (int x = 0; x < tile_.pixels.width(); ++x)
                each(tile_side * y + x,
                     static_cast<std::size_t>(y) * tile_.row + static_cast<std::size_t>(x));
    }

    const TriangleMeshView<float>& mesh_;
    const RasterTile& tile_;
    PacketHits<Wanted::closest> rays_;

private:
    static const WideTree<float, 3>& no_tree() {
        static const WideTree<float, 3> none_there;
        return none_there;
    }
    HWY_INLINE void rays_through_middles(int p) {
        constexpr auto i32 = MiddleRays::i32;
        const PicturePlane& plane = tile_.plane;
        const MiddleRays rays(plane);
        const auto place = MiddleRays::numbers(p * lanes);
        const auto column =
            hn::Add(hn::And(place, hn::Set(i32, tile_side - 1)), hn::Set(i32, tile_.pixels.left));
        const auto row = hn::Add(hn::ShiftRight<3>(place), hn::Set(i32, tile_.pixels.top));
        const bool parallel = plane.parallel;
        const auto origin = parallel ? rays.places(column, row) : all_lanes(f, plane.eye);
        const auto direction = parallel ? all_lanes(f, plane.forward) : rays.directions(column, row);
        auto& numbers = rays_.numbers[p];
        hn::Store(origin.x, f, numbers[0]), hn::Store(origin.y, f, numbers[1]),
            hn::Store(origin.z, f, numbers[2]);
        hn::Store(direction.x, f, numbers[3]), hn::Store(direction.y, f, numbers[4]);
        hn::Store(direction.z, f, numbers[5]);
        hn::Store(hn::Zero(f), f, numbers[6]);
        hn::Store(hn::Set(f, std::numeric_limits<float>::infinity()), f, numbers[7]);
    }

    const WideScene scene_;
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
