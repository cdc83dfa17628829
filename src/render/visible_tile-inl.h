/// A tile of a visibility buffer.
#if defined(HEDGEROW_RENDER_VISIBLE_TILE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_RENDER_VISIBLE_TILE_INL_H
#undef HEDGEROW_RENDER_VISIBLE_TILE_INL_H
#else
#define HEDGEROW_RENDER_VISIBLE_TILE_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include <hwy/highway.h>

#include "tile-inl.h"
#include "tile_functions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Functions of triangles that are linear in the picture (tile_functions-inl.h) tell at most samples whether a
// triangle covers it, and whether it is nearer than another: such a sample has a *sure* triangle so far.
// Where they cannot tell, a triangle waits for the test of rays, whose nearest hit is kept beside the sure
// triangle. Of either the sample knows how near it is at least and at most, so that triangles are left out
// that are farther for sure. In the end the sure triangles of samples that have a hit, too, are tested.
class VisibleTile : TileRays {
public:
    using TileRays::TileRays;

    HWY_INLINE void draw() {
        if (!draw_sure()) draw_hits();
    }

private:
    // The greatest error of a depth, as a share of it.
    static constexpr float depth_error = 0x1p-12f;

    // Draws the tile, unless its rays go several ways, or some are not usable: false.
    HWY_INLINE bool draw_sure() {
        const V nothing = hn::Set(f, -std::numeric_limits<float>::infinity());
        for (int at = 0; at < size; at += lanes) {
            hn::Store(nothing, f, near_ + at), hn::Store(nothing, f, far_ + at);
            hn::Store(hn::Set(u32, none), u32, sure_ + at);
        }
        // Eight triangles at a time, but for those that are behind all that is seen.
        TriangleBlock<float> block;
        TileFunctions::Boxes boxes;
        TileFunctions functions;
        std::uint64_t samples[8];
        int count = 0;
        const auto look = [&]() __attribute__((always_inline)) {
            functions.prepare(tile_.frame, boxes, block, count);
            for (int i = 0; i < count; ++i)
                if (functions.nearest[i] >= least_near_ && !look_at(functions, i, block, samples[i]))
                    return false;
            count = 0;
            take_least_near();
            return true;
        };
        for (std::size_t n = 0; n < tile_.triangles.size(); ++n) {
            prefetch(n);
            const TileTriangle& triangle = tile_.triangles[n];
            if (triangle.nearest > farthest_seen()) continue;
            take(block, count, tile_.first + triangle.number());
            take_box(triangle, boxes, count);
            samples[count++] = triangle.samples();
            if (count == 8 && !look()) return false;
        }
        if (count > 0 && !look()) return false;
        if (!test_waiting()) return false;
        if (!test_sure()) return false;
        write();
        return true;
    }
    // Fetches what is read of triangles that come after the n-th of the list.
    HWY_INLINE void prefetch(std::size_t n) const {
        constexpr std::size_t indices_ahead = 16, corners_ahead = 8;
        const auto number = [&](std::size_t i) { return tile_.first + tile_.triangles[i].number(); };
        if (n + indices_ahead < tile_.triangles.size())
            __builtin_prefetch(mesh_.indices_at(number(n + indices_ahead)));
        if (n + corners_ahead >= tile_.triangles.size()) return;
        const auto corners = mesh_.indices(number(n + corners_ahead));
        for (std::size_t c = 0; c < 3; ++c) __builtin_prefetch(mesh_.vertex_at(corners[c]));
    }
    // Functions are asked at places from the middle of the tile, and prepared from the middle of the box.
    HWY_INLINE void take_box(const TileTriangle& triangle, TileFunctions::Boxes& boxes, int place) const {
        const PixelBox box = triangle.box({});
        const auto along = [&](int axis, int first, int last, int tile) __attribute__((always_inline)) {
            const float middle = 0.5f * static_cast<float>(first + last + 1);
            boxes.middle[axis][place] = middle + static_cast<float>(tile);
            boxes.reach[axis][place] = 0.5f * static_cast<float>(last - first);
            boxes.from[axis][place] = tile_side / 2 - middle;
        };
        along(0, box.left, box.right, tile_.pixels.left), along(1, box.top, box.bottom, tile_.pixels.top);
    }
    // Looks at triangle i of a block at some samples.
    HWY_INLINE bool look_at(const TileFunctions& functions, int i, const TriangleBlock<float>& block,
                            std::uint64_t samples) {
        constexpr std::uint64_t every = (std::uint64_t(1) << lanes) - 1;
        std::uint64_t surely = 0, perhaps = 0;
        for (std::uint64_t left = samples; left != 0;) {
            const int at = std::countr_zero(left) / lanes * lanes;
            const TileFunctions::Seen seen = functions.at(i, at / lanes);
            const V near = hn::Load(f, near_ + at), far = hn::Load(f, far_ + at);
            const M nearer = hn::Gt(seen.near, far);
            const M shut = hn::Or(seen.out, hn::Lt(seen.far, near));
            const unsigned open = static_cast<unsigned>(left >> at & every) & ~bits_of(f, shut);
            left &= ~(every << at);
            if (open == 0) continue;
            const unsigned in = open & bits_of(f, seen.in), first = in & bits_of(f, nearer),
                           other = open & ~first;
            if (first != 0) {
                const M is = PacketRays::mask_of(first);
                hn::BlendedStore(seen.near, is, f, near_ + at);
                hn::BlendedStore(seen.far, is, f, far_ + at);
                hn::BlendedStore(seen.nearness, is, f, nearness_ + at);
                hn::BlendedStore(hn::Set(u32, block.id[i]), hn::RebindMask(u32, is), u32, sure_ + at);
                surely |= std::uint64_t(first) << at;
            }
            if (other != 0) [[unlikely]] {
                const M waits = PacketRays::mask_of(other), covers = PacketRays::mask_of(in & ~first);
                hn::BlendedStore(hn::Max(near, seen.near), covers, f, near_ + at);
                hn::BlendedStore(hn::Max(far, seen.far), waits, f, far_ + at);
                perhaps |= std::uint64_t(other) << at;
            }
        }
        if (surely != 0)
            for (int k = 0; k < waiting_.count; ++k) waiting_.samples[k] &= ~surely;
        return perhaps == 0 || wait(block.id[i], perhaps);
    }
    // Has a triangle tested at some samples, later.
    HWY_NOINLINE bool wait(std::uint32_t element, std::uint64_t samples) {
        add(waiting_, element - tile_.names.first_element, samples);
        return !waiting_.full() || test_waiting();
    }
    HWY_INLINE bool test_waiting() { return waiting_.count == 0 || test_those_waiting(); }
    HWY_NOINLINE bool test_those_waiting() {
        if (!prepared_) {
            const std::uint32_t ways = make_rays();
            if (!std::has_single_bit(ways)) return false;
            prepare_rays(static_cast<std::uint32_t>(std::countr_zero(ways)));
            prepared_ = true;
        }
        if (test(waiting_)) note_hits();
        return true;
    }
    // What is seen is no less near than a hit, and no nearer than the nearest of a hit and a sure triangle.
    HWY_NOINLINE void note_hits() {
        constexpr float u = static_cast<float>(unit_roundoff<float>);
        for (int p = 0; p < parts; ++p) {
            const int at = p * lanes;
            const M hit = hn::RebindMask(f, hn::Ne(hn::Load(u32, rays_.element + at), hn::Set(u32, none)));
            const V t = hn::Load(f, rays_.t_limit + at);
            V near, far;
            if (tile_.plane.parallel) {
                const V error =
                    hn::MulAdd(t, hn::Set(f, 16 * u), hn::Set(f, static_cast<float>(tile_.frame.error)));
                near = hn::Neg(hn::Add(t, error)), far = hn::Sub(error, t);
            } else {
                const V nearness = hn::Div(slant(p), t);
                near = hn::Mul(nearness, hn::Set(f, 1 - 16 * u)),
                far = hn::Mul(nearness, hn::Set(f, 1 + 16 * u));
            }
            hn::BlendedStore(hn::Max(hn::Load(f, near_ + at), near), hit, f, near_ + at);
            hn::BlendedStore(hn::Max(hn::Load(f, far_ + at), far), hit, f, far_ + at);
        }
        take_least_near();
    }
    // The length of a ray to the plane at distance 1 forward of the eye.
    HWY_INLINE V slant(int p) const {
        constexpr auto i32 = MiddleRays::i32;
        const auto place = MiddleRays::numbers(p * lanes);
        const auto from_middle = [&](auto pixel, int first, float middle) __attribute__((always_inline)) {
            const V at = hn::ConvertTo(f, hn::Add(pixel, hn::Set(i32, first)));
            return hn::Mul(hn::Sub(at, hn::Set(f, middle - 0.5f)), hn::Set(f, tile_.plane.scale));
        };
        const V x = from_middle(hn::And(place, hn::Set(i32, tile_side - 1)), tile_.pixels.left,
                                tile_.plane.middle_x),
                y = from_middle(hn::ShiftRight<3>(place), tile_.pixels.top, tile_.plane.middle_y);
        return hn::Sqrt(hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Set(f, 1.0f))));
    }
    // What is seen at any sample is no farther forward of the eye.
    HWY_INLINE float farthest_seen() const {
        if (tile_.plane.parallel) return -least_near_;
        return least_near_ > 0 ? 1 / least_near_ * (1 + 0x1p-20f) : std::numeric_limits<float>::infinity();
    }
    HWY_INLINE void take_least_near() {
        V least = hn::Load(f, near_);
        for (int at = lanes; at < size; at += lanes) least = hn::Min(least, hn::Load(f, near_ + at));
        least_near_ = hn::GetLane(hn::MinOfLanes(f, least));
    }
    // Tests the sure triangles of samples that have a hit, too, or whose depth is not to be told from a
    // plane.
    HWY_INLINE bool test_sure() {
        std::uint64_t tested = prepared_ ? ~samples_of(rays_.element, none) : 0;
        for (int at = 0; at < size; at += lanes) {
            const V apart = hn::Sub(hn::Load(f, far_ + at), hn::Load(f, near_ + at));
            const V most = hn::Mul(hn::Abs(hn::Load(f, nearness_ + at)), hn::Set(f, 2 * depth_error));
            tested |= std::uint64_t(bits_of(f, hn::Gt(apart, most))) << at;
        }
        tested &= ~samples_of(sure_, none);
        bool done = true;
        for_each_element(sure_, tested, [&](std::uint32_t element, std::uint64_t samples) {
            done = done && wait(element, samples);
        });
        return done && test_waiting();
    }
    HWY_INLINE void write() {
        static_assert(sizeof(Visible) == 2 * sizeof(std::uint32_t));
        alignas(64) std::uint32_t all[2 * size];
        const V infinite = hn::Set(f, std::numeric_limits<float>::infinity());
        for (int p = 0; p < parts; ++p) {
            const int at = p * lanes;
            auto element = hn::Load(u32, sure_ + at);
            const V nearness = hn::Load(f, nearness_ + at);
            V depth = tile_.plane.parallel ? hn::Neg(nearness) : hn::Div(hn::Set(f, 1.0f), nearness);
            if (prepared_) {
                const auto hit = hn::Load(u32, rays_.element + at);
                const auto is = hn::Ne(hit, hn::Set(u32, none));
                element = hn::IfThenElse(is, hit, element);
                depth = hn::IfThenElse(hn::RebindMask(f, is), depth_of_hits(p), depth);
            }
            const M is = hn::RebindMask(f, hn::Ne(element, hn::Set(u32, none)));
            hn::StoreInterleaved2(element, hn::BitCast(u32, hn::IfThenElse(is, depth, infinite)), u32,
                                  all + 2 * at);
        }
        for (int y = 0; y < tile_.pixels.height(); ++y) {
            Visible* const row = tile_.visible + static_cast<std::size_t>(y) * tile_.row;
            const std::uint32_t* const from = all + 2 * tile_side * y;
            if (tile_.pixels.width() == tile_side)
                std::memcpy(static_cast<void*>(row), from, tile_side * sizeof(Visible));
            else
                std::memcpy(static_cast<void*>(row), from,
                            static_cast<std::size_t>(tile_.pixels.width()) * sizeof(Visible));
        }
    }
    HWY_INLINE V depth_of_hits(int p) const {
        const V t = hn::Load(f, rays_.t_limit + p * lanes);
        return tile_.plane.parallel ? t : hn::Div(t, slant(p));
    }
    // Where rays go several ways: what their hits show.
    HWY_NOINLINE void draw_hits() {
        Hit<float> hits[size];
        RasterTile tile = tile_;
        tile.hits = hits, tile.row = tile_side;
        TileDrawing(mesh_, tile).draw();
        alignas(64) float slants[size];
        for (int p = 0; p < parts; ++p) hn::Store(slant(p), f, slants + p * lanes);
        for_each_sample([&](int i, std::size_t at) {
            const float depth = tile_.plane.parallel ? hits[i].t : hits[i].t / slants[i];
            tile_.visible[at] = {hits[i].element, depth};
        });
    }

    // By sample: the nearness of what is seen, at least and at most; the sure triangle, and its nearness.
    alignas(64) float near_[size], far_[size], nearness_[size];
    alignas(64) std::uint32_t sure_[size];
    float least_near_ = -std::numeric_limits<float>::infinity();  // the least of near_
    Waiting waiting_;
    bool prepared_ = false;  // whether the rays are
};

inline void see_tile(const TriangleMeshView<float>& mesh, const RasterTile& tile) {
    VisibleTile(mesh, tile).draw();
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
