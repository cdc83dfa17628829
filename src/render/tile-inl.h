/// Draws triangles into a tile of 64 samples: the test of a packet's rays against the triangles of a leaf,
/// where the rays are those of a tile, and the leaf is eight triangles that may cover some of it.
#if defined(HEDGEROW_RENDER_TILE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_RENDER_TILE_INL_H
#undef HEDGEROW_RENDER_TILE_INL_H
#else
#define HEDGEROW_RENDER_TILE_INL_H
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

class TileDrawing {
public:
    TileDrawing(const TriangleMeshView<float>& mesh, const RasterTile& tile)
        : mesh_(mesh), tile_(tile), scene_{no_tree(), nullptr, {}} {}

    HWY_INLINE void draw() {
        const std::uint32_t ways =
            tile_.rays != nullptr ? rays_.look(RayArray<float, 3>(tile_.rays, PacketRays::size), 0, tile_side)
                                  : rays_.look([&](int p) { rays_through_middles(p); });
        if (ways == 0) {  // no ray is usable
            if (!tile_.onto) for_each_sample([](int, Hit<float>& hit) { hit = {}; });
            return;
        }
        for (std::uint32_t left = ways; left != 0; left &= left - 1)
            draw(static_cast<std::uint32_t>(std::countr_zero(left)));
    }

private:
    using Rays = PacketHits<Wanted::closest>;

    static const WideTree<float, 3>& no_tree() {
        static const WideTree<float, 3> none;
        return none;
    }
    HWY_INLINE void rays_through_middles(int p) {
        constexpr auto f = PacketRays::f;
        constexpr auto i32 = MiddleRays::i32;
        const PicturePlane& plane = tile_.plane;
        const MiddleRays rays(plane);
        const auto place = MiddleRays::numbers(p * PacketRays::lanes);
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
    /// Draws for the rays that go this way.
    HWY_INLINE void draw(std::uint32_t way) {
        rays_.prepare_for_triangles(way, !tile_.plane.parallel);
        rays_.clear_hits();
        if (tile_.onto)
            for_each_hit(
                way, [&](int i, Hit<float>& hit) __attribute__((always_inline)) {
                    if (!hit) return;
                    rays_.t_limit[i] = hit.t, rays_.element[i] = element_so_far(hit);
                    rays_.s_limit[i] = s_limit_of(hit.t, rays_.z_length[i]);
                });
        float farthest = farthest_of(way);
        // Eight triangles at a time, but for those that are behind all hits. Places that are not filled have
        // no rays.
        TriangleBlock<float> block;
        std::uint64_t covered[8];
        int count = 0;
        const auto test = [&]() __attribute__((always_inline)) {
            for (int i = count; i < 8; ++i) covered[i] = 0;
            if (rays_.test_each(scene_, block, covered)) farthest = farthest_of(way);
            count = 0;
        };
        for (const std::uint32_t number : tile_.triangles) {
            const Sight& sight = tile_.sights[number];
            if (sight.nearest > farthest) continue;
            take(block, count, tile_.first + number);
            covered[count++] = samples_in(sight.box);
            if (count == 8) test();
        }
        if (count > 0) test();
        for_each_hit(
            way, [&](int i, Hit<float>& hit) __attribute__((always_inline)) {
                if (!tile_.onto || rays_.t_limit[i] != hit.t || rays_.element[i] != element_so_far(hit))
                    hit = hit_of(i);
            });
    }
    /// The element of a hit so far, as ties see it: equal t goes to the lowest (instance, element).
    HWY_INLINE std::uint32_t element_so_far(const Hit<float>& hit) const {
        if (hit.instance == tile_.names.instance) return hit.element;
        return hit.instance < tile_.names.instance ? 0 : Hit<float>::none;
    }
    HWY_INLINE Hit<float> hit_of(int i) const {
        const RasterNames& names = tile_.names;
        const std::uint32_t element = rays_.element[i];
        if (element == Hit<float>::none) return {};
        return {rays_.t_limit[i], rays_.u[i],
                rays_.v[i],       mesh_.id(element - names.first_element) + names.first_element,
                names.geometry,   names.instance,
                element};
    }
    /// No hit of the rays that go this way is farther forward of the eye.
    HWY_INLINE float farthest_of(std::uint32_t way) const {
        constexpr auto f = PacketRays::f;
        constexpr auto u32 = PacketRays::u32;
        auto most = hn::Zero(f);
        for (int p = 0; p < PacketRays::parts; ++p) {
            const int at = p * PacketRays::lanes;
            auto forward = hn::Set(f, tile_.names.placed ? 1.0f : 0.0f);  // at most that in the world
            for (int k = 0; k < 3 && !tile_.names.placed; ++k)
                forward = hn::MulAdd(hn::Load(f, rays_.numbers[p][3 + k]), hn::Set(f, tile_.plane.forward[k]),
                                     forward);
            const auto goes = hn::RebindMask(f, hn::Eq(hn::Load(u32, rays_.ways + at), hn::Set(u32, way)));
            most = hn::Max(most, hn::IfThenElseZero(goes, hn::Mul(hn::Load(f, rays_.t_limit + at), forward)));
        }
        return hn::GetLane(hn::MaxOfLanes(f, most)) * (1 + 0x1p-18f);
    }
    /// Calls f(i, hit) for the samples in the picture; or for those whose rays go this way.
    template <class F>
    HWY_INLINE void for_each_sample(F f) {
        for (int y = 0; y <= tile_.pixels.bottom - tile_.pixels.top; ++y)
            for (int x = 0; x <= tile_.pixels.right - tile_.pixels.left; ++x)
                f(tile_side * y + x,
                  tile_.hits[static_cast<std::size_t>(y) * tile_.row + static_cast<std::size_t>(x)]);
    }
    template <class F>
    HWY_INLINE void for_each_hit(std::uint32_t way, F f) {
        for_each_sample([&](int i, Hit<float>& hit) __attribute__((always_inline)) {
            if (rays_.ways[i] == way) f(i, hit);
        });
    }
    HWY_INLINE void take(TriangleBlock<float>& block, int place, std::uint32_t number) const {
        const auto corners = mesh_.indices(number);
        for (std::size_t c = 0; c < 3; ++c) {
            const Vec<float, 3> p = mesh_.vertex(corners[c]);
            for (std::size_t k = 0; k < 3; ++k) block.corner[k][c][place] = p[static_cast<int>(k)];
        }
        block.id[place] = number + tile_.names.first_element;
    }
    /// The samples of the tile in a box that meets it, a bit each.
    HWY_INLINE std::uint64_t samples_in(const PixelBox& box) const {
        const auto from = [](int first) { return first < 0 ? 0 : first; };
        const auto to = [](int last) { return last > tile_side - 1 ? tile_side - 1 : last; };
        const int left = from(box.left - tile_.pixels.left), right = to(box.right - tile_.pixels.left);
        const int top = from(box.top - tile_.pixels.top), bottom = to(box.bottom - tile_.pixels.top);
        const std::uint64_t columns = (0xFFu >> (7 - right)) & (0xFFu << left);
        const std::uint64_t rows =
            (~std::uint64_t(0) >> (8 * (7 - bottom))) & (~std::uint64_t(0) << (8 * top));
        return columns * 0x0101010101010101u & rows;
    }

    const TriangleMeshView<float>& mesh_;
    const RasterTile& tile_;
    const WideScene scene_;
    Rays rays_;
};

inline void draw_tile(const TriangleMeshView<float>& mesh, const RasterTile& tile) {
    TileDrawing(mesh, tile).draw();
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
