/// Tiles of a picture that are filled with the hits of one triangle, or with none.
#if defined(HEDGEROW_RENDER_TILE_FILL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_RENDER_TILE_FILL_INL_H
#undef HEDGEROW_RENDER_TILE_FILL_INL_H
#else
#define HEDGEROW_RENDER_TILE_FILL_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include <hwy/highway.h>

#include "beam_sides-inl.h"
#include "picture_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A Hit as seven words: t, u, v, and four that the hits of a triangle have in common.
inline constexpr int hit_words = 7;
static_assert(sizeof(Hit<float>) == 4 * hit_words && offsetof(Hit<float>, primitive) == 12);

// For each word of as many hits as there are lanes, in order: the number of its hit, and of the word in it.
template <int lanes>
struct WordsOfHits {
    alignas(64) std::int32_t hit[hit_words * lanes], word[hit_words * lanes];

    constexpr WordsOfHits() : hit{}, word{} {
        for (int i = 0; i < hit_words * lanes; ++i) hit[i] = i / hit_words, word[i] = i % hit_words;
    }
};

class TileFill {
public:
    using F = PacketRays::F;
    using V = PacketRays::V;
    static constexpr F f{};
    static constexpr int lanes = PacketRays::lanes, side = static_cast<int>(block_side);
    static constexpr int rows_ahead = 2;

    TileFill(const WideScene& scene, const BeamTile& tile, const BeamEye& eye)
        : scene_(scene), tile_(tile), eye_(eye), rays_(tile) {}

    // Chooses the triangle at a place of the blocks.
    HWY_INLINE void take(std::uint32_t place) {
        const TriangleBlock<float>& block = scene_.blocks[place / 8];
        for (int k = 0; k < 3; ++k)
            for (int c = 0; c < 3; ++c) corner_[k][c] = block.corner[k][c][place % 8] - tile_.plane.eye[k];
        const std::uint32_t element = block.id[place % 8];
        const Hit<float> hit = hit_of(scene_, 0, 0, 0, element);
        std::uint32_t words[hit_words];
        std::memcpy(words, &hit, sizeof words);
        for (int i = 0; i < hit_words * lanes; ++i) words_[i] = words[i % hit_words];
    }
    // Fills pixels with the hits of the triangle. False, and nothing counts that was written, if a ray does
    // not hit it, or farther than at this depth.
    HWY_INLINE bool fill(const PixelBox& pixels, float farthest) const {
        const int wide = pixels.right - pixels.left + 1;
        LanesOfHits m;
        if (wide % lanes == 0) {
            for (int y = pixels.top; y <= pixels.bottom; ++y)
                for (int x = pixels.left; x <= pixels.right; x += lanes) {
                    if (const int next = y + rows_ahead; next <= pixels.bottom)
                        prefetch({x, next, x + lanes - 1, next});
                    if (!meet(rays_.in_row(x, y), farthest, m)) return false;
                    write(m, place_of(x, y));
                }
            return true;
        }
        for (int top = pixels.top; top <= pixels.bottom; top += side)
            for (int left = pixels.left; left <= pixels.right; left += side)
                for (int p = 0; p < PacketRays::parts; ++p) {
                    if (!meet(rays_.in_block(left, top, p), farthest, m)) return false;
                    write(m, p, left, top);
                }
        return true;
    }
    HWY_INLINE void fill_with_none(const PixelBox& pixels) const {
        for (int y = pixels.top; y <= pixels.bottom; ++y)
            std::fill_n(place_of(pixels.left, y), pixels.right - pixels.left + 1, Hit<float>());
    }
    // Fetches the places of a block's hits, which are written later.
    HWY_INLINE void prefetch(const PixelBox& pixels) const {
        for (int y = pixels.top; y <= pixels.bottom; ++y) {
            const char* const from = reinterpret_cast<const char*>(place_of(pixels.left, y));
            const auto bytes = static_cast<std::size_t>(pixels.right - pixels.left + 1) * sizeof(Hit<float>);
            for (std::size_t at = 0; at < bytes; at += 64) __builtin_prefetch(from + at, 1);
            __builtin_prefetch(from + bytes - 1, 1);
        }
    }
    HWY_INLINE Hit<float>* place_of(int x, int y) const {
        return tile_.hits + static_cast<std::size_t>(y - tile_.pixels.top) * tile_.row +
               static_cast<std::size_t>(x - tile_.pixels.left);
    }

private:
    struct LanesOfHits {
        V t, u, v;

        HWY_INLINE LanesOfHits() {}
        HWY_INLINE LanesOfHits(V of_t, V of_u, V of_v) : t(of_t), u(of_u), v(of_v) {}
    };
    // Between which hits count: the t where each ray begins, and a depth.
    struct Bounds {
        V begins;
        float farthest;
    };
    // Tests the triangle with a vector of rays, as WatertightRay does. True if all hit it.
    HWY_INLINE bool meet(const Coordinates<F>& given, float farthest, LanesOfHits& m) const {
        constexpr unsigned every = (1u << lanes) - 1;
        const V d[3] = {usable_direction(f, given.x), usable_direction(f, given.y),
                        usable_direction(f, given.z)};
        const V length[3] = {hn::Abs(d[0]), hn::Abs(d[1]), hn::Abs(d[2])};
        const V longest = hn::Max(length[0], hn::Max(length[1], length[2]));
        // Rays that are not usable are left to others.
        const V largest = hn::Set(f, std::numeric_limits<float>::max());
        if (!hn::AllTrue(f, hn::And(hn::Gt(longest, hn::Zero(f)), hn::Le(longest, largest)))) return false;
        // The first of the longest axes, mostly of all rays the same.
        const auto is_x = hn::Eq(length[0], longest), is_y = hn::AndNot(is_x, hn::Eq(length[1], longest));
        const unsigned x = bits_of(f, is_x), y = bits_of(f, is_y), z = every & ~(x | y);
        const Bounds bounds{rays_.begins(given), farthest};
        if (x == every) return meet<0>(d, every, bounds, m);
        if (y == every) return meet<1>(d, every, bounds, m);
        if (z == every) return meet<2>(d, every, bounds, m);
        return meet_in_parts(d, x, y, z, bounds, m);
    }
    HWY_NOINLINE bool meet_in_parts(const V (&d)[3], unsigned x, unsigned y, unsigned z, const Bounds& bounds,
                                    LanesOfHits& m) const {
        LanesOfHits of[3];
        if (!meet<0>(d, x, bounds, of[0]) || !meet<1>(d, y, bounds, of[1]) || !meet<2>(d, z, bounds, of[2]))
            return false;
        const std::uint64_t of_x = x, of_y = y;
        const auto is_x = hn::LoadMaskBits(f, reinterpret_cast<const std::uint8_t*>(&of_x)),
                   is_y = hn::LoadMaskBits(f, reinterpret_cast<const std::uint8_t*>(&of_y));
        const auto chosen = [&](V a, V b, V c) {
            return hn::IfThenElse(is_x, a, hn::IfThenElse(is_y, b, c));
        };
        m = {chosen(of[0].t, of[1].t, of[2].t), chosen(of[0].u, of[1].u, of[2].u),
             chosen(of[0].v, of[1].v, of[2].v)};
        return true;
    }
    // Tests the rays of some lanes (a bit each), of which z is the longest axis.
    template <int z>
    HWY_INLINE bool meet(const V (&d)[3], unsigned some, const Bounds& bounds, LanesOfHits& m) const {
        constexpr int axis[3] = {(z + 1) % 3, (z + 2) % 3, z};
        const V along = d[z];
        const auto from_origin = [&](int k, int c) __attribute__((always_inline)) {
            return hn::Set(f, corner_[axis[k]][c]);
        };
        const ShearedCorners<F> corners(from_origin, hn::Div(d[axis[0]], along), hn::Div(d[axis[1]], along));
        if ((some & ~meet_exactly(corners, along, m)) != 0) return false;
        // The depth of the hits.
        V forward = hn::Mul(d[0], hn::Set(f, eye_.axes[2][0]));
        forward = hn::MulAdd(d[1], hn::Set(f, eye_.axes[2][1]), forward);
        forward = hn::MulAdd(d[2], hn::Set(f, eye_.axes[2][2]), forward);
        const auto within =
            hn::And(hn::Ge(m.t, bounds.begins), hn::Le(m.t, hn::Set(f, std::numeric_limits<float>::max())));
        const auto before = hn::Le(hn::Mul(m.t, forward), hn::Set(f, bounds.farthest * (1 - 0x1p-18f)));
        return (some & ~bits_of(f, hn::And(within, before))) == 0;
    }
    // The exact test of all lanes, as packets make it.
    HWY_INLINE unsigned meet_exactly(const ShearedCorners<F>& corners, V along, LanesOfHits& m) const {
        alignas(64) float directions[lanes];
        hn::Store(along, f, directions);
        const auto direction_z = [&](auto wide, int from) __attribute__((always_inline)) {
            return hn::PromoteTo(wide, hn::Load(hn::Rebind<float, decltype(wide)>(), directions + from));
        };
        Meetings all;
        const unsigned met = meet_exactly_among(f, corners, (1u << lanes) - 1, direction_z, all);
        m = {hn::Load(f, all.t), hn::Load(f, all.u), hn::Load(f, all.v)};
        return met;
    }

    // Writes a vector of hits one after the other: each vector of their words takes t, u and v where these
    // belong, and has the words of the triangle elsewhere.
    HWY_INLINE void write(const LanesOfHits& m, Hit<float>* to) const {
        static constexpr WordsOfHits<lanes> table;
        constexpr hn::RebindToSigned<F> i32;
        float* const words = reinterpret_cast<float*>(to);
        for (int i = 0; i < hit_words; ++i) {
            const auto hit = hn::IndicesFromVec(f, hn::Load(i32, table.hit + i * lanes));
            const auto word = hn::Load(i32, table.word + i * lanes);
            const auto is = [&](int n) __attribute__((always_inline)) {
                return hn::RebindMask(f, hn::Eq(word, hn::Set(i32, n)));
            };
            V all = hn::BitCast(f, hn::Load(hn::RebindToUnsigned<F>(), words_ + i * lanes));
            all = hn::IfThenElse(is(0), hn::TableLookupLanes(m.t, hit), all);
            all = hn::IfThenElse(is(1), hn::TableLookupLanes(m.u, hit), all);
            all = hn::IfThenElse(is(2), hn::TableLookupLanes(m.v, hit), all);
            hn::StoreU(all, f, words + i * lanes);
        }
    }
    // Writes vector p of a block.
    HWY_INLINE void write(const LanesOfHits& m, int p, int left, int top) const {
        alignas(64) Hit<float> hits[lanes];
        write(m, hits);
        for (int i = 0; i < lanes; ++i) {
            const int x = left + (p * lanes + i) % side, y = top + (p * lanes + i) / side;
            if (x <= tile_.pixels.right && y <= tile_.pixels.bottom) *place_of(x, y) = hits[i];
        }
    }

    const WideScene& scene_;
    const BeamTile& tile_;
    const BeamEye& eye_;
    const PictureRays rays_;
    float corner_[3][3];
    alignas(64) std::uint32_t words_[hit_words * lanes];
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
