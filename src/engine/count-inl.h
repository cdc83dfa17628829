/// Counts the points in a ball.
#if defined(HEDGEROW_ENGINE_COUNT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_COUNT_INL_H
#undef HEDGEROW_ENGINE_COUNT_INL_H
#else
#define HEDGEROW_ENGINE_COUNT_INL_H
#endif

#include <bit>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <hedgerow/engine/kernels.h>
#include <hedgerow/geometry/ball.h>
#include <hedgerow/structures/bvh/build_tree.h>

#include "boxes-inl.h"
#include "distances-inl.h"
#include "stack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A ball, and the boxes of a node against it. A box whose nearest point is beyond the ball is passed over,
// and one whose farthest corner is in the ball is inside. Squared distances in float err by at most six
// roundings, 2^-21.4 of themselves, and where they underflow by less than 2^-120. The rule of radii adds
// 2^-23 (geometry/radius.h).
template <int W>
class BallAmongBoxes {
public:
    using V = hn::Vec<Floats<W>>;
    using Mask = hn::Mask<Floats<W>>;
    struct Sides {
        Mask across, inside;
    };

    HWY_INLINE explicit BallAmongBoxes(const Sphere<float, 3>& ball) : p_(all_lanes(f, ball.center)) {
        const double radius = static_cast<double>(ball.radius), radius2 = radius * radius;
        outer_ = hn::Set(f, static_cast<float>(radius2 * (1 + 0x1p-20) + 0x1p-120));
        inner_ = hn::Set(f, static_cast<float>(radius2 * (1 - 0x1p-20) - 0x1p-120));
    }
    HWY_INLINE Sides sides(const std::byte* node, int part) const {
        const V zero = hn::Zero(f);
        const auto low = [&](std::size_t axis) __attribute__((always_inline)) {
            return row_of<W>(node, axis * 8 * W, part);
        };
        const auto high = [&](std::size_t axis) __attribute__((always_inline)) {
            return row_of<W>(node, axis * 8 * W + 4 * W, part);
        };
        const Coordinates<Floats<W>> below = minus(Coordinates<Floats<W>>{low(0), low(1), low(2)}, p_);
        const Coordinates<Floats<W>> above = minus(p_, {high(0), high(1), high(2)});
        const Coordinates<Floats<W>> near = greatest(greatest(below, above), {zero, zero, zero});
        // The farther of −below and −above.
        const Coordinates<Floats<W>> far = least(below, above);
        const Mask inside = hn::Le(dot(far, far), inner_);
        return {hn::AndNot(inside, hn::Le(dot(near, near), outer_)), inside};
    }

private:
    static constexpr Floats<W> f{};
    Coordinates<Floats<W>> p_;
    V outer_, inner_;
};

// How many points of a block are in a ball: distances in double, and the test of single points where rounding
// to float may decide.
HWY_INLINE std::size_t count_of_block(const PointBlock<float, 3>& block, const Sphere<float, 3>& ball) {
    using Doubles = hn::CappedTag<double, 8>;
    constexpr Doubles d;
    constexpr int lanes = static_cast<int>(hn::MaxLanes(d));
    const double radius = static_cast<double>(ball.radius);
    const auto radius2 = hn::Set(d, radius * radius);
    std::size_t count = 0;
    for (int from = 0; from < 8; from += lanes) {
        const auto distance2 = distances2_in_double(d, block, from, Vec<double, 3>(ball.center));
        const auto error = hn::MulAdd(hn::Set(d, 0x1p-22), hn::Add(distance2, radius2), hn::Set(d, 0x1p-140));
        const auto apart = hn::Abs(hn::Sub(distance2, radius2));
        const auto sure = hn::And(hn::Gt(apart, error), hn::Lt(distance2, radius2));
        count += hn::CountTrue(d, sure);
        for (unsigned doubt = bits_of(d, hn::Le(apart, error)); doubt != 0; doubt &= doubt - 1) {
            const int i = from + std::countr_zero(doubt);
            count += lies_in(Vec<float, 3>(block.at[0][i], block.at[1][i], block.at[2][i]), ball);
        }
    }
    return count;
}

// The number of points in a ball. Nodes tell how many points are below each child, so a child that is inside
// of the ball is not opened.
template <int W>
std::size_t count_in_ball(const WidePoints& scene, const Sphere<float, 3>& ball) {
    if (scene.tree.empty()) return 0;
    using Stack = WalkStack<W, Wanted::any>;
    typename Stack::Place places[Stack::room(bvh_max_depth + 1)];
    Stack stack(places, 0, 0);
    stack.clear();
    const BallAmongBoxes<W> among(ball);
    constexpr hn::RebindToUnsigned<Floats<W>> u32;
    auto whole = hn::Zero(u32);  // what is below children inside, by lane; a tree has less than 2^32 points
    std::size_t tested = 0;
    for (std::uint32_t word = 0; word != Stack::end; word = stack.pop()) {
        if ((word & WideChild::leaf_bit) != 0) {
            tested += count_of_block(scene.blocks[word & ~WideChild::leaf_bit], ball);
            continue;
        }
        const std::byte* const node = scene.tree.nodes.data() + word * WideNodes<float, 3>::stride_of(W);
        const std::uint32_t* const children = children_of<W>(node);
        Boxes<W> boxes;
        for (int p = 0; p < Boxes<W>::parts; ++p) {
            const auto sides = among.sides(node, p);
            boxes.entered[p] = sides.across;
            const auto below = hn::LoadU(u32, children + W + p * Boxes<W>::lanes);
            whole = hn::Add(whole, hn::IfThenElseZero(hn::RebindMask(u32, sides.inside), below));
        }
        stack.push(boxes, children);
    }
    alignas(64) std::uint32_t sums[hn::MaxLanes(u32)];
    hn::Store(whole, u32, sums);
    for (const std::uint32_t sum : sums) tested += sum;
    return tested;
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
