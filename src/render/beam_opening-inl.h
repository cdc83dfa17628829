/// Lists of what a beam may meet: kept from those of larger beams, and made longer by opening cells.
#if defined(HEDGEROW_RENDER_BEAM_OPENING_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_RENDER_BEAM_OPENING_INL_H
#undef HEDGEROW_RENDER_BEAM_OPENING_INL_H
#else
#define HEDGEROW_RENDER_BEAM_OPENING_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cstdint>

#include <hwy/highway.h>

#include <hedgerow/render/visibility/beam_kernels.h>

#include "beam_lists-inl.h"
#include "beam_sides-inl.h"
#include "engine/packet_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

struct BeamList {
    static constexpr std::uint32_t no_place = 0xFFFFFFFFu;

    BeamCells cells;
    BeamTriangles triangles;
    std::uint32_t cover;  // the place of the nearest triangle that covers the beam, if any

    HWY_INLINE void clear() { cells.count = triangles.count = 0, cover = no_place; }
};

template <int W>
class BeamOpening {
public:
    BeamOpening(const WideScene& scene, const BeamTile& tile, const BeamEye& eye, BeamCounts& counts)
        : scene_(scene), tile_(tile), eye_(eye), counts_(counts) {}

    // Keeps what a beam may meet of the list of a larger one.
    HWY_INLINE void keep(const BeamList& larger, Beam& beam, BeamList& list) {
        list.clear();
        for (int at = 0; at < larger.triangles.count; at += lanes) {
            const auto row = [&](int r) __attribute__((always_inline)) {
                return hn::Load(f, larger.triangles.of[r] + at);
            };
            auto sides = beam.sides_of(f, row);
            const auto is = first(larger.triangles.count - at);
            sides.meets = hn::And(sides.meets, is), sides.covers = hn::And(sides.covers, is);
            end_at_cover(f, sides, beam, list, hn::Load(u32, larger.triangles.word[0] + at));
            list.triangles.append_of(f, larger.triangles, at, sides.meets);
        }
        for (int at = 0; at < larger.cells.count; at += lanes) {
            const auto row = [&](int r) __attribute__((always_inline)) {
                return hn::Load(f, larger.cells.of[r] + at);
            };
            PacketRays::V depth;
            const auto met = hn::And(beam.meets(f, eye_, row, depth), first(larger.cells.count - at));
            list.cells.append_of(f, larger.cells, at, met);
        }
    }
    // Opens cells that are large beside a beam of a tile that is `wide` pixels wide, while the list is short.
    // Both limits are flat: half and twice as much change times by less than they vary.
    HWY_INLINE void open_large(Beam& beam, BeamList& list, int wide) {
        BeamCells& cells = list.cells;
        const float pixel = std::max(beam.right - beam.left, beam.high - beam.low) / static_cast<float>(wide);
        for (int i = 0; i < cells.count;) {
            const float depth = cells.of[BeamCells::depth][i];
            const std::uint32_t word = cells.word[BeamCells::child][i];
            const bool is_leaf = (word & WideChild::leaf_bit) != 0;
            const bool has_room = is_leaf ? list.triangles.has_room(8) : cells.count <= most_opened;
            const float large = is_leaf ? leaf_tiles * static_cast<float>(wide) : node_pixels;
            if (depth > beam.farthest) {
                cells.remove(i);
            } else if (!has_room || cells.of[BeamCells::side][i] <= large * pixel * std::max(depth, 0.0f)) {
                ++i;
            } else {
                cells.remove(i);
                if (is_leaf)
                    open_leaf(word & ~WideChild::leaf_bit, beam, list);
                else
                    open(word, beam, list);
            }
        }
        drop_beyond(beam, list);
    }
    // Appends the children of a node that the beam may meet.
    HWY_INLINE void open(std::uint32_t number, const Beam& beam, BeamList& list) {
        using B = Floats<W>;
        constexpr B b;
        constexpr hn::RebindToUnsigned<B> u;
        constexpr int parts = Boxes<W>::parts, wide = Boxes<W>::lanes;
        ++counts_.visits;
        const std::byte* const node = scene_.tree.nodes.at(number);
        for (int p = 0; p < parts; ++p) {
            const auto plane = [&](int r) __attribute__((always_inline)) {
                return row_of<W>(node, static_cast<std::size_t>(r) * 4 * W, p);
            };
            const auto words = hn::LoadU(u, children_of<W>(node) + p * wide);
            hn::Vec<B> depth;
            const auto is = hn::RebindMask(b, hn::Ne(words, hn::Set(u, WideChild::none().word)));
            const auto met = hn::And(beam.meets(b, eye_, plane, depth), is);
            const auto longest = hn::Max(hn::Sub(plane(1), plane(0)),
                                         hn::Max(hn::Sub(plane(3), plane(2)), hn::Sub(plane(5), plane(4))));
            const auto places =
                hn::Add(hn::Iota(u, 0), hn::Set(u, number * W + static_cast<std::uint32_t>(p * wide)));
            list.cells.append(
                b, met,
                [&](int r) __attribute__((always_inline)) {
                    return r == BeamCells::depth ? depth : r == BeamCells::side ? longest : plane(r);
                },
                [&](int r) __attribute__((always_inline)) { return r == BeamCells::child ? words : places; });
        }
    }

private:
    static constexpr auto f = PacketRays::f;
    static constexpr hn::RebindToUnsigned<PacketRays::F> u32{};
    static constexpr int lanes = PacketRays::lanes;
    // Nodes are opened that are longer than so many pixels where they begin: beams of fewer rays would open
    // most of them, too. Leaves are opened that are longer than so many tiles, where a triangle may cover
    // one.
    static constexpr float node_pixels = 64, leaf_tiles = 4;
    // With more cells than this, a beam is no quicker than the packets of its tiles.
    static constexpr int most_opened = 24;
    static_assert(most_opened + W - 1 <= BeamCells::room);

    static HWY_INLINE PacketRays::M first(int count) {
        return hn::FirstN(f, static_cast<std::size_t>(std::min(count, lanes)));
    }
    // Ends the beam at the nearest triangle that covers it.
    template <class D, class Places>
    static HWY_INLINE void end_at_cover(D d, const typename Beam::Sides<D>& sides, Beam& beam, BeamList& list,
                                        Places places) {
        if (hn::AllFalse(d, sides.covers)) return;
        alignas(64) float depth[16];
        alignas(64) std::uint32_t place[16];
        hn::Store(sides.farthest, d, depth);
        hn::Store(places, hn::RebindToUnsigned<D>(), place);
        for (unsigned left = bits_of(d, sides.covers); left != 0; left &= left - 1) {
            const int i = std::countr_zero(left);
            if (depth[i] <= beam.farthest) beam.farthest = depth[i], list.cover = place[i];
        }
    }
    // Drops what begins beyond the beam's end.
    HWY_INLINE void drop_beyond(const Beam& beam, BeamList& list) {
        drop_beyond(beam, list.cells, BeamCells::depth);
        drop_beyond(beam, list.triangles, BeamTriangles::nearest);
    }
    template <class Rows>
    static HWY_INLINE void drop_beyond(const Beam& beam, Rows& rows, int depth) {
        for (int i = 0; i < rows.count;)
            if (rows.of[depth][i] > beam.farthest)
                rows.remove(i);
            else
                ++i;
    }
    // Appends the triangles of a leaf that the beam may meet.
    HWY_INLINE void open_leaf(std::uint32_t leaf, Beam& beam, BeamList& list) {
        using E = Floats<8>;
        constexpr E e;
        constexpr hn::RebindToUnsigned<E> u;
        ++counts_.visits;
        const TriangleBlock<float>& block = scene_.blocks[leaf];
        for (int at = 0; at < 8; at += static_cast<int>(hn::MaxLanes(e))) {
            const auto corner = [&](int k, int c) __attribute__((always_inline)) {
                return hn::Sub(hn::Load(e, block.corner[k][c] + at), hn::Set(e, tile_.plane.eye[k]));
            };
            hn::Vec<E> rows[12];
            triangle_rows(e, eye_, corner, rows);
            const auto row = [&](int r) __attribute__((always_inline)) {
                return rows[r];
            };
            auto is = hn::Eq(corner(0, 0), corner(0, 0));  // not NaN
            if (tile_.plane.in_mirror()) [[unlikely]]
                is = hn::And(is, after_begin(e, eye_, corner, rows));
            auto sides = beam.sides_of(e, row);
            sides.meets = hn::And(sides.meets, is), sides.covers = hn::And(sides.covers, is);
            const auto places =
                hn::Add(hn::Iota(u, 0), hn::Set(u, leaf * 8 + static_cast<std::uint32_t>(at)));
            end_at_cover(e, sides, beam, list, places);
            list.triangles.append(
                e, sides.meets, row, [&](int) __attribute__((always_inline)) { return places; });
        }
    }

    const WideScene& scene_;
    const BeamTile& tile_;
    const BeamEye& eye_;
    BeamCounts& counts_;
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
