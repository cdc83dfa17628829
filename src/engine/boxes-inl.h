/// The boxes of a node's children: which of them a probe enters, and where.
#if defined(HEDGEROW_ENGINE_BOXES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_BOXES_INL_H
#undef HEDGEROW_ENGINE_BOXES_INL_H
#else
#define HEDGEROW_ENGINE_BOXES_INL_H
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Which answers an asker wants: the closest of all; any, at which it stops; or those that are near, of which
// the limit shrinks little by little. Walks for near answers open the nearest child of a node first, and the
// others in any order.
enum class Wanted { closest, any, near };

template <class D>
HWY_INLINE unsigned bits_of(D d, hn::Mask<D> mask) {
    std::uint64_t bits = 0;
    hn::StoreMaskBits(d, mask, reinterpret_cast<std::uint8_t*>(&bits));
    return static_cast<unsigned>(bits);
}

// Vectors for a row of W floats: all of the row, or as much of it as a vector has room for.
template <int W>
using Floats = hn::CappedTag<float, W>;

// Part of the row that begins `at` bytes into a node.
template <int W>
HWY_INLINE hn::Vec<Floats<W>> row_of(const std::byte* node, std::size_t at, int part) {
    constexpr Floats<W> f;
    return hn::Load(f, reinterpret_cast<const float*>(node + at) + part * static_cast<int>(hn::MaxLanes(f)));
}

// The boxes of W children: a mask of those that a probe enters, and where it does: the s of a ray, the
// squared distance of a point. `slabs.enter(node, part, entry)` tests a part of the row.
template <int W>
struct Boxes {
    static constexpr Floats<W> f{};
    using V = hn::Vec<Floats<W>>;
    static constexpr int lanes = static_cast<int>(hn::MaxLanes(f)), parts = W / lanes;

    V entry[parts];
    hn::Mask<Floats<W>> entered[parts];

    HWY_INLINE Boxes() = default;
    template <class Slabs>
    HWY_INLINE Boxes(const std::byte* node, const Slabs& slabs) {
        for (int p = 0; p < parts; ++p) entered[p] = slabs.enter(node, p, entry[p]);
    }
    HWY_INLINE unsigned bits() const {
        unsigned all = 0;
        for (int p = 0; p < parts; ++p) all |= bits_of(f, entered[p]) << (p * lanes);
        return all;
    }
    HWY_INLINE void store(float* at) const {
        for (int p = 0; p < parts; ++p) hn::Store(entry[p], f, at + p * lanes);
    }
};

template <int W, class T = float>
HWY_INLINE const std::uint32_t* children_of(const std::byte* node) {
    return reinterpret_cast<const std::uint32_t*>(node + 6 * sizeof(T) * W);
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
