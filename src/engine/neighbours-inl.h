/// Lists the points near those of a block.
#if defined(HEDGEROW_ENGINE_NEIGHBOURS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_NEIGHBOURS_INL_H
#undef HEDGEROW_ENGINE_NEIGHBOURS_INL_H
#else
#define HEDGEROW_ENGINE_NEIGHBOURS_INL_H
#endif

#include <cstddef>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>

#include <hedgerow/engine/kernels.h>
#include <hedgerow/structures/bvh/build_tree.h>

#include "boxes-inl.h"
#include "distances-inl.h"
#include "search-inl.h"
#include "stack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The box around the points of a block, and the squared distance to which they look. Boxes and points are
// measured as by Reach.
class BlockReach {
public:
    HWY_INLINE BlockReach(const PointBlock<float, 3>& block, float max_distance2)
        : limit2_(float_limit(limit_of_boxes(max_distance2))) {
        constexpr Floats<8> f;
        constexpr float none = std::numeric_limits<float>::infinity();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            auto low = hn::Set(f, none), high = hn::Set(f, -none);
            for (std::size_t at = 0; at < 8; at += hn::MaxLanes(f)) {
                const auto row = hn::Load(f, block.at[axis] + at);
                const auto there = hn::Eq(row, row);
                low = hn::Min(low, hn::IfThenElse(there, row, low));
                high = hn::Max(high, hn::IfThenElse(there, row, high));
            }
            low_[axis] = hn::GetLane(hn::MinOfLanes(f, low));
            high_[axis] = hn::GetLane(hn::MaxOfLanes(f, high));
        }
    }
    // Which boxes are within reach, given how to read their planes: low(axis) and high(axis).
    template <class F, class Low, class High>
    HWY_INLINE hn::Mask<F> reaches(F f, Low low, High high) const {
        const auto outside = [&](std::size_t axis) __attribute__((always_inline)) {
            const auto below = hn::Sub(low(axis), hn::Set(f, high_[axis]));
            const auto above = hn::Sub(hn::Set(f, low_[axis]), high(axis));
            return hn::Max(hn::Max(below, above), hn::Zero(f));
        };
        const Coordinates<F> away{outside(0), outside(1), outside(2)};
        return hn::Le(dot(away, away), hn::Set(f, limit2_));
    }

private:
    float low_[3], high_[3], limit2_;
};

// See NeighbourKernels.
template <int W>
std::size_t leaves_near(const WidePoints& scene, const PointBlock<float, 3>& block, float max_distance2,
                        std::uint32_t* leaves, std::size_t room) {
    const BlockReach reach(block, max_distance2);
    using Stack = WalkStack<W, Wanted::any>;
    typename Stack::Place places[Stack::room(bvh_max_depth + 1)];
    Stack stack(places, 0, 0);
    stack.clear();
    std::size_t count = 0;
    for (std::uint32_t word = 0; word != Stack::end; word = stack.pop()) {
        if ((word & WideChild::leaf_bit) != 0) {
            if (count < room) leaves[count] = word & ~WideChild::leaf_bit;
            ++count;
            continue;
        }
        const std::byte* const node = scene.tree.nodes.data() + word * WideNodes<float, 3>::stride_of(W);
        Boxes<W> boxes;
        for (int p = 0; p < Boxes<W>::parts; ++p) {
            const auto row = [&](std::size_t plane) __attribute__((always_inline)) {
                return row_of<W>(node, plane * 4 * W, p);
            };
            boxes.entered[p] = reach.reaches(
                Floats<W>(), [&](std::size_t axis) __attribute__((always_inline)) { return row(2 * axis); },
                [&](std::size_t axis) __attribute__((always_inline)) { return row(2 * axis + 1); });
        }
        stack.push(boxes, children_of<W>(node));
    }
    return count;
}

// Writes the lanes of a mask to the end of a list, and others beyond it.
template <class D>
HWY_INLINE void append(D, hn::Vec<D> lanes, hn::Mask<D> some, hn::TFromD<D>* end) {
    constexpr hn::RebindToSigned<D> i;
    hn::StoreU(compressed(i, hn::BitCast(i, lanes), hn::RebindMask(i, some)), i,
               reinterpret_cast<std::int32_t*>(end));
}

// The points of some leaves that are near a block's box, and above an id if `later`, in rows that are filled
// up with NaN to whole vectors. Returns how many places that is.
template <class F>
HWY_INLINE std::size_t gather(F f, const WidePoints& scene, const std::uint32_t* leaves, std::size_t count,
                              const BlockReach& reach, bool later, std::uint32_t least,
                              NeighbourArrays& arrays) {
    constexpr hn::RebindToUnsigned<F> u;
    constexpr std::size_t lanes = hn::MaxLanes(f);
    std::size_t size = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const PointBlock<float, 3>& block = scene.blocks[leaves[i]];
        for (std::size_t at = 0; at < 8; at += lanes) {
            const auto row = [&](std::size_t axis) __attribute__((always_inline)) {
                return hn::Load(f, block.at[axis] + at);
            };
            const auto id = hn::Load(u, block.id + at);
            auto near = reach.reaches(f, row, row);
            if (later) near = hn::And(near, hn::RebindMask(f, hn::Gt(id, hn::Set(u, least))));
            for (std::size_t axis = 0; axis < 3; ++axis) append(f, row(axis), near, arrays.at[axis] + size);
            append(u, id, hn::RebindMask(u, near), arrays.id + size);
            size += hn::CountTrue(f, near);
        }
    }
    const auto none = hn::Set(f, std::numeric_limits<float>::quiet_NaN());
    for (std::size_t axis = 0; axis < 3; ++axis) hn::StoreU(none, f, arrays.at[axis] + size);
    return (size + lanes - 1) / lanes * lanes;
}

// Writes a row of different ids, and what belongs to each, ascending: the place of an id is the number of
// those below it. Whole vectors are read, also beyond the row's end. O(n²), in vectors.
HWY_INLINE void write_in_order(const PrimitiveId* row, const float* distances2, std::size_t size,
                               PrimitiveId* ids, float* sorted2) {
    constexpr hn::CappedTag<std::uint32_t, 16> u;
    constexpr std::size_t lanes = hn::MaxLanes(u);
    alignas(64) std::uint32_t places[lanes];
    for (std::size_t i = 0; i < size; i += lanes) {
        const auto some = hn::LoadU(u, row + i);
        auto place = hn::Zero(u);
        for (std::size_t k = 0; k < size; ++k)
            place = hn::Sub(place, hn::VecFromMask(u, hn::Lt(hn::Set(u, row[k]), some)));
        hn::Store(place, u, places);
        for (std::size_t k = i; k < size && k < i + lanes; ++k) {
            ids[places[k - i]] = row[k];
            sorted2[places[k - i]] = distances2[k];
        }
    }
}

// See NeighbourKernels.
inline void list_neighbours(const WidePoints& scene, const std::uint32_t* leaves, std::size_t count,
                            const PointBlock<float, 3>& block, float max_distance2, bool later,
                            NeighbourArrays& arrays) {
    using F = Floats<8>;
    constexpr F f;
    constexpr hn::RebindToUnsigned<F> u;
    constexpr std::size_t lanes = hn::MaxLanes(f);
    std::uint32_t least = no_primitive;
    for (const PrimitiveId id : block.id) least = id < least ? id : least;
    const std::size_t near =
        gather(f, scene, leaves, count, BlockReach(block, max_distance2), later, least, arrays);
    const auto limit2 = hn::Set(f, max_distance2);
    PrimitiveId* ids = arrays.ids;
    float* distances2 = arrays.distances2;
    for (std::size_t i = 0; i < 8; ++i) {
        std::size_t size = 0;
        if (block.id[i] != no_primitive) {
            const Vec<double, 3> p(Vec<float, 3>(block.at[0][i], block.at[1][i], block.at[2][i]));
            const auto from = hn::Set(u, later ? block.id[i] : 0);
            for (std::size_t at = 0; at < near; at += lanes) {
                const auto d2 = distances2_of(f, arrays, static_cast<int>(at), p);
                const auto id = hn::Load(u, arrays.id + at);
                auto within = hn::Le(d2, limit2);
                if (later) within = hn::And(within, hn::RebindMask(f, hn::Gt(id, from)));
                append(f, d2, within, arrays.row_distances2 + size);
                append(u, id, hn::RebindMask(u, within), arrays.row_ids + size);
                size += hn::CountTrue(f, within);
            }
        }
        arrays.counts[i] = static_cast<std::uint32_t>(size);
        if (size <= most_ranked) {
            write_in_order(arrays.row_ids, arrays.row_distances2, size, ids, distances2);
        } else {
            for (std::size_t k = 0; k < size; ++k)
                ids[k] = arrays.row_ids[k], distances2[k] = arrays.row_distances2[k];
        }
        ids += size, distances2 += size;
    }
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
