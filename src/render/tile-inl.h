/// The hits of a tile of 64 samples: all triangles that may cover some are tested, or those that a visibility
/// buffer names.
#if defined(HEDGEROW_RENDER_TILE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_RENDER_TILE_INL_H
#undef HEDGEROW_RENDER_TILE_INL_H
#else
#define HEDGEROW_RENDER_TILE_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "tile_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

class TileDrawing : TileRays {
public:
    using TileRays::TileRays;

    // Draws the triangles of the tile.
    HWY_INLINE void draw() {
        in_each_way([&](std::uint32_t way) __attribute__((always_inline)) { draw_triangles(way); });
    }
    // Computes the hits of the visibility buffer.
    HWY_INLINE void resolve(const Visible* visible) {
        alignas(64) std::uint32_t elements[size];
        std::fill_n(elements, size, none);
        for_each_sample([&](int i, std::size_t at) { elements[i] = visible[at].element; });
        const std::uint64_t seen = ~samples_of(elements, none);
        in_each_way([&](std::uint32_t way) __attribute__((always_inline)) {
            Waiting waiting;
            for_each_element(elements, seen & samples_of(rays_.ways, way),
                             [&](std::uint32_t element, std::uint64_t samples) {
                                 add(waiting, element - tile_.names.first_element, samples);
                                 if (waiting.full()) test(waiting);
                             });
            test(waiting);
        });
    }

private:
    // Calls find(way) for each way that rays go, with the rays prepared and hits so far loaded, and writes
    // the hits.
    template <class Find>
    HWY_INLINE void in_each_way(Find find) {
        const std::uint32_t ways = make_rays();
        if (ways == 0 && !tile_.onto) for_each_sample([&](int, std::size_t at) { tile_.hits[at] = {}; });
        for (std::uint32_t left = ways; left != 0; left &= left - 1) {
            const auto way = static_cast<std::uint32_t>(std::countr_zero(left));
            prepare_rays(way);
            if (tile_.onto) load_hits(way);
            find(way);
            write_hits(way);
        }
    }
    // Eight triangles at a time, but for those that are behind all hits.
    HWY_INLINE void draw_triangles(std::uint32_t way) {
        float farthest = farthest_of(way);
        Waiting waiting;
        for (const TileTriangle& triangle : tile_.triangles) {
            if (triangle.nearest > farthest) continue;
            add(waiting, tile_.first + triangle.number(), triangle.samples());
            if (waiting.full() && test(waiting)) farthest = farthest_of(way);
        }
        test(waiting);
    }
    HWY_INLINE void load_hits(std::uint32_t way) {
        for_each_sample([&](int i, std::size_t at) __attribute__((always_inline)) {
            const Hit<float>& hit = tile_.hits[at];
            if (rays_.ways[i] != way || !hit) return;
            rays_.t_limit[i] = hit.t, rays_.element[i] = element_so_far(hit);
            rays_.s_limit[i] = s_limit_of(hit.t, rays_.z_length[i]);
        });
    }
    HWY_INLINE void write_hits(std::uint32_t way) {
        for_each_sample([&](int i, std::size_t at) __attribute__((always_inline)) {
            if (rays_.ways[i] != way) return;
            Hit<float>& hit = tile_.hits[at];
            if (!tile_.onto || rays_.t_limit[i] != hit.t || rays_.element[i] != element_so_far(hit))
                hit = hit_of(i);
        });
    }
    // The element of a hit so far, as ties see it: equal t goes to the lowest (instance, element).
    HWY_INLINE std::uint32_t element_so_far(const Hit<float>& hit) const {
        if (hit.instance == tile_.names.instance) return hit.element;
        return hit.instance < tile_.names.instance ? 0 : none;
    }
    HWY_INLINE Hit<float> hit_of(int i) const {
        const RasterNames& names = tile_.names;
        const std::uint32_t element = rays_.element[i];
        if (element == none) return {};
        return {rays_.t_limit[i], rays_.u[i],
                rays_.v[i],       mesh_.id(element - names.first_element) + names.first_element,
                names.geometry,   names.instance,
                element};
    }
    // No hit of the rays that go this way is farther forward of the eye.
    HWY_INLINE float farthest_of(std::uint32_t way) const {
        V most = hn::Zero(f);
        for (int p = 0; p < parts; ++p) {
            const int at = p * lanes;
            auto forward = hn::Set(f, tile_.names.placed ? 1.0f : 0.0f);  // at most that in the world
            for (int k = 0; k < 3 && !tile_.names.placed; ++k)
                forward = hn::MulAdd(hn::Load(f, rays_.numbers[p][3 + k]), hn::Set(f, tile_.plane.forward[k]),
                                     forward);
            const auto goes = hn::RebindMask(f, hn::Eq(hn::Load(u32, rays_.ways + at), hn::Set(u32, way)));
            most = hn::Max(most, hn::IfThenElseZero(goes, hn::Mul(hn::Load(f, rays_.t_limit + at), forward)));
        }
        return hn::GetLane(hn::MaxOfLanes(f, most)) * (1 + 0x1p-18f);
    }
};

inline void draw_tile(const TriangleMeshView<float>& mesh, const RasterTile& tile) {
    TileDrawing(mesh, tile).draw();
}
inline void resolve_tile(const TriangleMeshView<float>& mesh, const RasterTile& tile,
                         const Visible* visible) {
    TileDrawing(mesh, tile).resolve(visible);
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
