/// What a beam may meet: cells of the tree that are not yet opened, and single triangles, in rows.
#if defined(HEDGEROW_RENDER_BEAM_LISTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_RENDER_BEAM_LISTS_INL_H
#undef HEDGEROW_RENDER_BEAM_LISTS_INL_H
#else
#define HEDGEROW_RENDER_BEAM_LISTS_INL_H
#endif

#include <cstdint>

#include <hwy/highway.h>

#include "engine/stack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Rows of numbers, of which lanes are appended and kept by masks.
template <int floats, int words, int most>
struct BeamRows {
    static constexpr int room = most;
    // Whole vectors are written, up to 16 places beyond the last.
    alignas(64) float of[floats][most + 16];
    alignas(64) std::uint32_t word[words][most + 16];
    int count = 0;

    // Appends the lanes of a mask. `number(r)` and `index(r)` are vectors of row r.
    template <class D, class Number, class Index>
    HWY_INLINE void append(D d, hn::Mask<D> mask, Number number, Index index) {
        constexpr hn::RebindToSigned<D> i32;
        const auto some = hn::RebindMask(i32, mask);
        for (int r = 0; r < floats; ++r)
            hn::StoreU(compressed(i32, hn::BitCast(i32, number(r)), some), i32,
                       reinterpret_cast<std::int32_t*>(of[r] + count));
        for (int r = 0; r < words; ++r)
            hn::StoreU(compressed(i32, hn::BitCast(i32, index(r)), some), i32,
                       reinterpret_cast<std::int32_t*>(word[r] + count));
        count += static_cast<int>(hn::CountTrue(d, mask));
    }
    // Appends lanes of another list, from `at` on.
    template <class D>
    HWY_INLINE void append_of(D d, const BeamRows& other, int at, hn::Mask<D> mask) {
        constexpr hn::RebindToUnsigned<D> u;
        append(
            d, mask, [&](int r) __attribute__((always_inline)) { return hn::Load(d, other.of[r] + at); },
            [&](int r) __attribute__((always_inline)) { return hn::Load(u, other.word[r] + at); });
    }
    // Puts the last entry in place of entry i.
    HWY_INLINE void remove(int i) {
        --count;
        for (int r = 0; r < floats; ++r) of[r][i] = of[r][count];
        for (int r = 0; r < words; ++r) word[r][i] = word[r][count];
    }
    HWY_INLINE bool has_room(int more) const { return count + more <= room; }
};

// Cells: the planes of the box as in a node, the least depth, and the box's longest side. Words: where the
// child leads, and its place (node · W + child).
struct BeamCells : BeamRows<8, 2, 64> {
    static constexpr int depth = 6, side = 7;
    static constexpr int child = 0, place = 1;
};
// Triangles: for each edge, the numbers x, y and 1 of its function x·a + y·b + c at the place (a, b) of the
// picture, which has one sign where the triangle is; what the functions err by; the depth of a place times
// the sum of the functions; the least depth. The word is the triangle's place in the blocks.
struct BeamTriangles : BeamRows<12, 1, 64> {
    static constexpr int error = 9, depth_by_sum = 10, nearest = 11;
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
