/// Beams through a tree: a tile of a picture and its parts, down to 8 × 8 samples, descend together with the
/// cells that they may meet (Overbeck, Ramamoorthi and Mark, EGSR 2007, have beams that are split at edges;
/// Reshetov, Soupikov and Hurley, SIGGRAPH 2005, tiles that find where their rays may enter the tree).
#if defined(HEDGEROW_RENDER_BEAMS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_RENDER_BEAMS_INL_H
#undef HEDGEROW_RENDER_BEAMS_INL_H
#else
#define HEDGEROW_RENDER_BEAMS_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cstdint>

#include <hwy/highway.h>

#include <hedgerow/render/visibility/beam_kernels.h>

#include "beam_opening-inl.h"
#include "engine/packet-inl.h"
#include "engine/single-inl.h"
#include "engine/width-inl.h"
#include "tile_fill-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A beam has a list of what it may meet: cells that are larger than the beam is wide where they begin are
// opened, the others are left to its parts. A triangle that covers the beam ends it at the depth of that
// triangle. A beam is done where nothing is left, or one triangle that covers it; the others are split in
// four, and those of 8 × 8 samples go on as packets, from the cells that are left.
//
// What is passed over is surely beside the beam, or surely beyond its end. That all samples have hits before
// the end is only likely, so it is tested: samples that do not are answered again, one by one.
template <int W>
class Beams {
public:
    Beams(const WideScene& scene, const BeamTile& tile, BeamCounts& counts)
        : scene_(scene),
          tile_(tile),
          counts_(counts),
          widest_(tile.frame.sound ? tile.widest : 0),
          eye_(tile.plane, tile.frame, scene.tree.bounds),
          rays_(tile),
          fill_(scene, tile, eye_),
          opening_(scene, tile, eye_, counts),
          prefetch_(scene),
          packet_(scene) {}

    void trace() {
        if (scene_.tree.empty()) return fill_.fill_with_none(tile_.pixels);
        BeamList& all = lists_[0];
        Beam beam(eye_, tile_.pixels);
        all.clear();
        if (widest_ >= side) opening_.open(0, beam, all);
        trace(all, beam, &lists_[1], tile_.pixels, beam_side);
        counts_.visits += packet_.counts().visits;
    }

private:
    static constexpr int side = static_cast<int>(block_side);
    static constexpr auto f = PacketRays::f;
    static constexpr hn::RebindToUnsigned<PacketRays::F> u32{};
    static constexpr int lanes = PacketRays::lanes;
    // ---- The tree of tiles ----

    void trace(const BeamList& larger, const Beam& around, BeamList* own, const PixelBox& pixels, int wide) {
        if (wide > widest_) return split(larger, around, own, pixels, wide);
        ++counts_.beams;
        Beam beam(eye_, pixels);
        beam.farthest = around.farthest;
        opening_.keep(larger, beam, *own);
        if (wide > side) opening_.open_large(beam, *own, wide);
        if (own->cells.count == 0) {
            if (own->triangles.count == 0 && beam.farthest == std::numeric_limits<float>::infinity()) {
                counts_.filled += samples_of(pixels);
                return fill_.fill_with_none(pixels);
            }
            if (own->triangles.count == 1 && own->triangles.word[0][0] == own->cover)
                return fill(*own, beam, pixels);
        }
        if (wide == side)
            answer_by_packet(*own, beam, pixels);
        else
            split(*own, beam, own + 1, pixels, wide);
    }
    void split(const BeamList& list, const Beam& beam, BeamList* own, const PixelBox& pixels, int wide) {
        const int half = wide / 2;
        if (wide == side) return answer_by_packet(list, beam, pixels);
        for (int y = pixels.top; y <= pixels.bottom; y += half)
            for (int x = pixels.left; x <= pixels.right; x += half)
                trace(list, beam, own,
                      {x, y, std::min(x + half - 1, pixels.right), std::min(y + half - 1, pixels.bottom)},
                      half);
    }
    static std::uint64_t samples_of(const PixelBox& pixels) {
        return static_cast<std::uint64_t>(pixels.right - pixels.left + 1) *
               static_cast<std::uint64_t>(pixels.bottom - pixels.top + 1);
    }
    void fill(const BeamList& list, const Beam& beam, const PixelBox& pixels) {
        counts_.filled += samples_of(pixels);
        fill_.take(list.triangles.word[0][0]);
        if (fill_.fill(pixels, beam.farthest)) [[likely]]
            return;
        for (int y = pixels.top; y <= pixels.bottom; y += side)
            for (int x = pixels.left; x <= pixels.right; x += side)
                answer_by_packet(
                    list, beam,
                    {x, y, std::min(x + side - 1, pixels.right), std::min(y + side - 1, pixels.bottom)});
    }

    // ---- Packets ----

    void answer_by_packet(const BeamList& list, const Beam& beam, const PixelBox& pixels) {
        ++counts_.packets;
        fill_.prefetch(pixels);
        const std::uint32_t ways = packet_.hits().look([&](int p) __attribute__((always_inline)) {
            rays_.write(pixels.left, pixels.top, p, packet_.hits().numbers[p]);
        });
        if (ways == 0) return answer_again(pixels);
        const bool from_root = widest_ < side;
        for (std::uint32_t left = ways; left != 0; left &= left - 1) {
            const auto way = static_cast<std::uint32_t>(std::countr_zero(left));
            auto& hits = packet_.hits();
            if (from_root || list.cells.count > 0)
                hits.prepare(way, scene_.tree.bounds);
            else
                hits.prepare_for_triangles(way, true);
            hits.clear_hits();
            test_triangles_of(list);
            if (from_root)
                packet_.trace([&](auto& stack) __attribute__((always_inline)) { packet_.open_root(stack); });
            else if (list.cells.count > 0)
                packet_.template trace<BeamCells::room>([&](auto& stack) __attribute__((always_inline)) {
                    push(list.cells, stack);
                });
            if (!all_before(beam.farthest, way)) return answer_again(pixels);
            for (int y = pixels.top; y <= pixels.bottom; ++y)
                for (int x = pixels.left; x <= pixels.right; ++x) {
                    const int i = (y - pixels.top) * side + x - pixels.left;
                    if (hits.ways[i] == way)
                        *fill_.place_of(x, y) =
                            hit_of(scene_, hits.t_limit[i], hits.u[i], hits.v[i], hits.element[i]);
                }
        }
    }
    // Tests the single triangles, eight at a time.
    HWY_INLINE void test_triangles_of(const BeamList& list) {
        TriangleBlock<float> block;
        for (int at = 0; at < list.triangles.count; at += 8) {
            const int count = std::min(8, list.triangles.count - at);
            for (int i = 0; i < 8; ++i) {
                const std::uint32_t place = list.triangles.word[0][at + std::min(i, count - 1)];
                const TriangleBlock<float>& from = scene_.blocks[place / 8];
                for (int k = 0; k < 3; ++k)
                    for (int c = 0; c < 3; ++c)
                        block.corner[k][c][i] = i < count ? from.corner[k][c][place % 8]
                                                          : std::numeric_limits<float>::quiet_NaN();
                block.id[i] = from.id[place % 8];
            }
            ++counts_.visits;
            packet_.hits().test_leaf(scene_, block, ~std::uint64_t(0));
        }
        packet_.hits().take_last();
    }
    // Pushes the cells that a ray of the packet may enter, the nearest last.
    template <class Stack>
    HWY_INLINE void push(const BeamCells& cells, Stack& stack) {
        const auto& rays = packet_.rays();
        std::uint64_t sorted[BeamCells::room];
        int count = 0;
        for (int at = 0; at < cells.count; at += lanes) {
            auto entry = hn::Set(f, rays.s_first), exit = hn::Set(f, rays.s_last);
            for (int k = 0; k < 3; ++k) {
                const int near = 2 * k + rays.down[k];
                // In this order: of zeros of either sign, Max keeps the second, and the stack orders bits.
                entry = hn::Max(rays.earliest(f, k, hn::Load(f, cells.of[near] + at)), entry);
                exit = hn::Min(exit, rays.latest(f, k, hn::Load(f, cells.of[near ^ 1] + at)));
            }
            const auto entered =
                hn::And(hn::Le(entry, exit),
                        hn::FirstN(f, static_cast<std::size_t>(std::min(cells.count - at, lanes))));
            alignas(64) float s[lanes];
            hn::Store(entry, f, s);
            for (unsigned left = bits_of(f, entered); left != 0; left &= left - 1) {
                const int i = std::countr_zero(left);
                prefetch_(cells.word[BeamCells::child][at + i]);
                const std::uint64_t cell = waiting(s[i], cells.word[BeamCells::place][at + i]);
                int place = count++;
                for (; place > 0 && sorted[place - 1] < cell; --place) sorted[place] = sorted[place - 1];
                sorted[place] = cell;
            }
        }
        for (int i = 0; i < count; ++i) stack.push(sorted[i]);
    }
    // Whether each ray that goes this way has a hit no farther than the beam is open.
    HWY_INLINE bool all_before(float farthest, std::uint32_t way) const {
        if (!(farthest < std::numeric_limits<float>::infinity())) return true;
        const auto& rays = packet_.rays();
        auto beyond = hn::Lt(hn::Zero(f), hn::Zero(f));
        for (int p = 0; p < PacketRays::parts; ++p) {
            const int at = p * lanes;
            auto forward = hn::Zero(f);
            for (int k = 0; k < 3; ++k)
                forward =
                    hn::MulAdd(hn::Load(f, rays.numbers[p][3 + k]), hn::Set(f, eye_.axes[2][k]), forward);
            const auto goes = hn::RebindMask(f, hn::Eq(hn::Load(u32, rays.ways + at), hn::Set(u32, way)));
            const auto depth = hn::Mul(hn::Load(f, rays.t_limit + at), forward);
            beyond = hn::Or(beyond, hn::And(goes, hn::Gt(depth, hn::Set(f, farthest * (1 - 0x1p-18f)))));
        }
        return hn::AllFalse(f, beyond);
    }
    // Answers samples one by one, from the root.
    HWY_NOINLINE void answer_again(const PixelBox& pixels) {
        ++counts_.again;
        for (int y = pixels.top; y <= pixels.bottom; ++y)
            for (int x = pixels.left; x <= pixels.right; ++x) {
                const int i = (y - pixels.top) * side + x - pixels.left;
                *fill_.place_of(x, y) =
                    cast_one<W, Wanted::closest>(scene_, rays_.ray(pixels.left, pixels.top, i));
            }
    }

    const WideScene& scene_;
    const BeamTile& tile_;
    BeamCounts& counts_;
    const int widest_;  // 0: packets alone
    const BeamEye eye_;
    const PictureRays rays_;
    TileFill fill_;
    BeamOpening<W> opening_;
    const Prefetch<W> prefetch_;
    Packet<W, Wanted::closest> packet_;
    BeamList lists_[5];  // of all that the tile may meet, and of tiles of 64, 32, 16 and 8
};

template <int W>
struct BeamsOf {
    static void answer(const WideScene& scene, const BeamTile* tile, BeamCounts* counts) {
        Beams<W>(scene, *tile, *counts).trace();
    }
};
inline void trace_beams(const WideScene& scene, const BeamTile& tile, BeamCounts& counts) {
    by_width<BeamsOf>(scene, &tile, &counts);
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
