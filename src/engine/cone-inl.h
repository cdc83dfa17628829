/// One cone against triangles (queries/cone_fragments.h): boxes are tested as ConeProbe tests them, and what
/// it enters at all 64 samples.
#if defined(HEDGEROW_ENGINE_CONE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_CONE_INL_H
#undef HEDGEROW_ENGINE_CONE_INL_H
#else
#define HEDGEROW_ENGINE_CONE_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>

#include <hedgerow/engine/cone_kernels.h>
#include <hedgerow/geometry/rounding.h>

#include "coordinates-inl.h"
#include "walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The cone in floats, which enters a box no later than its ConeProbe does, and leaves it no earlier.
//
// Along an axis the cone reaches, at depth t, from origin.low + t·direction.low to origin.high +
// t·direction.high. It meets a box while the upper end is above the box's low plane and the lower end below
// its high plane. Each holds on a half-line of t that begins or ends at (plane − origin) / direction; one of
// both begins.
class WideCone {
public:
    explicit WideCone(const ConeProbe<float, 3>& probe) {
        for (int k = 0; k < 3; ++k) {
            const auto& [origin, direction] = probe.along_axis(k);
            const bool upper_begins = direction.high > -least, lower_begins = direction.low < least;
            const HalfLine upper{2 * k, rounded_up<float>(origin.high),
                                 upper_begins ? begin(std::max(direction.high, least)) : end(direction.high)};
            const HalfLine lower{2 * k + 1, rounded_down<float>(origin.low),
                                 lower_begins ? begin(std::min(direction.low, -least)) : end(direction.low)};
            begins_[k] = upper_begins ? upper : lower;
            other_[k] = upper_begins ? lower : upper;
            both_begin_[k] = upper_begins && lower_begins;
        }
        const Interval<double> depths = probe.rays().depths();
        first_ = std::max(0.0f, rounded_down<float>(depths.entry));
        last_ = rounded_up<float>(std::min(depths.exit, double(std::numeric_limits<float>::max())));
    }

    // Which boxes are entered up to a depth, and the depths. row(i) is row i of the boxes' planes.
    template <class F, class Rows>
    HWY_INLINE hn::Mask<F> enter(F f, const Rows& row, float limit, hn::Vec<F>& entry) const {
        const auto depth = [&](const HalfLine& line) HWY_ATTR {
            return hn::Mul(hn::Sub(row(line.row), hn::Set(f, line.origin)), hn::Set(f, line.inverse));
        };
        entry = depth(begins_[0]);
        auto exit = hn::Set(f, std::min(last_, limit));
        for (int k = 0; k < 3; ++k) {
            if (k > 0) entry = hn::Max(entry, depth(begins_[k]));
            if (both_begin_[k])
                entry = hn::Max(entry, depth(other_[k]));
            else
                exit = hn::Min(exit, depth(other_[k]));
        }
        // In this order: of 0 and −0 some processors return the second, and the stack orders by bits.
        entry = hn::Max(entry, hn::Set(f, first_));
        return hn::Le(entry, exit);
    }

private:
    struct HalfLine {
        int row;  // of the box's planes: twice the axis, and 1 for the high one
        float origin, inverse;
    };
    // A direction this small counts as one along which the half-line begins, so that inverses are finite.
    static constexpr double least = 0x1p-60;
    // Inverses are changed by 8u, more than the roundings of a difference and a product.
    static float begin(double direction) {
        return static_cast<float>((1 - 8 * double(unit_roundoff<float>)) / direction);
    }
    static float end(double direction) {
        return static_cast<float>((1 + 8 * double(unit_roundoff<float>)) / direction);
    }

    HalfLine begins_[3], other_[3];
    bool both_begin_[3];
    float first_, last_;  // depths
};

// The test of a node's boxes, as Boxes asks for it.
template <int W>
struct ConeSlabs {
    const WideCone& cone;
    float limit;

    HWY_INLINE hn::Mask<Floats<W>> enter(const std::byte* node, int part, hn::Vec<Floats<W>>& entry) const {
        const auto row = [&](int i) HWY_ATTR {
            return row_of<W>(node, static_cast<std::size_t>(i) * W * sizeof(float), part);
        };
        return cone.enter(Floats<W>(), row, limit, entry);
    }
};

// ConeView::take, with samples in lanes. Returns whether a sample sees the triangle.
HWY_INLINE bool take(ConeView& view, const ConeFrame::Triangle& t, const Interval<double>& depths,
                     PrimitiveId id) {
    constexpr hn::CappedTag<double, 8> d;
    constexpr hn::RebindToUnsigned<decltype(d)> u64;
    const ConeSamples& samples = ConeSamples::all();
    const auto zero = hn::Zero(d);
    bool any = false;
    for (std::size_t i = 0; i < ConeView::count; i += hn::MaxLanes(d)) {
        const auto x = hn::Load(d, &samples.x[i]), y = hn::Load(d, &samples.y[i]);
        const auto at = [&](const ConeFrame::Linear& f) HWY_ATTR {
            return hn::Add(hn::Add(hn::Set(d, f.constant), hn::Mul(hn::Set(d, f.x), x)),
                           hn::Mul(hn::Set(d, f.y), y));
        };
        const auto u = at(t.u), v = at(t.v), w = at(t.w);
        const auto sum = hn::Add(hn::Add(u, v), w);
        const auto least = hn::Min(u, hn::Min(v, w)), most = hn::Max(u, hn::Max(v, w));
        auto seen = hn::And(hn::Or(hn::Ge(least, zero), hn::Le(most, zero)), hn::Ne(sum, zero));
        if (hn::AllFalse(d, seen)) continue;
        const auto depth = hn::Div(at(t.height), sum);
        const auto before = hn::Load(d, &view.depth[i]);
        const auto element = hn::Load(u64, &view.element[i]), own = hn::Set(u64, std::uint64_t{id});
        const auto nearer = hn::Or(hn::Lt(depth, before),
                                   hn::And(hn::Eq(depth, before), hn::RebindMask(d, hn::Lt(own, element))));
        seen = hn::And(hn::And(seen, nearer), hn::And(hn::Ge(depth, hn::Set(d, depths.entry)),
                                                      hn::Le(depth, hn::Set(d, depths.exit))));
        if (hn::AllFalse(d, seen)) continue;
        any = true;
        hn::Store(hn::IfThenElse(seen, depth, before), d, &view.depth[i]);
        hn::Store(hn::IfThenElse(hn::RebindMask(u64, seen), own, element), u64, &view.element[i]);
    }
    return any;
}

// The greatest depth of a sample.
HWY_INLINE double farthest(const ConeView& view) {
    constexpr hn::CappedTag<double, 8> d;
    auto most = hn::Load(d, view.depth.data());
    for (std::size_t i = hn::MaxLanes(d); i < ConeView::count; i += hn::MaxLanes(d))
        most = hn::Max(most, hn::Load(d, &view.depth[i]));
    return hn::GetLane(hn::MaxOfLanes(d, most));
}

// ConeView::share, with samples in lanes.
inline ConeView::Share share_of(const ConeView& view, std::uint64_t id) {
    constexpr hn::CappedTag<double, 8> d;
    constexpr hn::RebindToUnsigned<decltype(d)> u64;
    const auto infinity = hn::Set(d, std::numeric_limits<double>::infinity());
    std::uint64_t samples = 0;
    auto nearest = infinity;
    for (std::size_t i = 0; i < ConeView::count; i += hn::MaxLanes(d)) {
        const auto same = hn::Eq(hn::Load(u64, &view.element[i]), hn::Set(u64, id));
        samples |= std::uint64_t{bits_of(u64, same)} << i;
        nearest =
            hn::Min(nearest, hn::IfThenElse(hn::RebindMask(d, same), hn::Load(d, &view.depth[i]), infinity));
    }
    return {samples, hn::GetLane(hn::MinOfLanes(d, nearest))};
}

// Tells of triangles in lanes which ones a cone misses although it enters their boxes: two edges have
// functions (ConeFrame) of opposite signs in all of the disc. Floats decide where they are sure. With a
// corner B from the apex and an edge E, the function in the middle, axis · (B × E), errs by less than
// 24u·|B|·|E|, and by 2^-120 where products underflow; from there it changes by slope·|B × E| + radius·|E| at
// most.
class EdgesOfCone {
public:
    explicit EdgesOfCone(const ConeRays<float, 3>& cone)
        : apex_(cone.origin()),
          axis_(cone.axis()),
          slope_(rounded_up<float>(cone.slope() * (1 + 0x1p-20))),
          radius_(rounded_up<float>(cone.radius() * (1 + 0x1p-20))) {}

    // corner(c, k) is coordinate k of corner c of each triangle.
    template <class F, class Corner>
    HWY_INLINE hn::Mask<F> may_hit(F f, const Corner& corner) const {
        const auto axis = all_lanes(f, axis_), apex = all_lanes(f, apex_);
        const auto at = [&](int c) HWY_ATTR {
            return Coordinates<F>{corner(c, 0), corner(c, 1), corner(c, 2)};
        };
        auto above = hn::FirstN(f, 0), below = above;
        for (int c = 0; c < 3; ++c) {
            const int next = c == 2 ? 0 : c + 1;
            const auto from = minus(at(c), apex), edge = minus(at(next), at(c));
            const Coordinates<F> normal{hn::MulSub(from.y, edge.z, hn::Mul(from.z, edge.y)),
                                        hn::MulSub(from.z, edge.x, hn::Mul(from.x, edge.z)),
                                        hn::MulSub(from.x, edge.y, hn::Mul(from.y, edge.x))};
            const auto middle = dot(axis, normal);
            const auto change = hn::MulAdd(hn::Sqrt(dot(from, from)), hn::Set(f, 24 * unit_roundoff<float>),
                                           hn::Set(f, radius_));
            const auto most =
                hn::MulAdd(hn::Set(f, slope_), hn::Sqrt(dot(normal, normal)),
                           hn::MulAdd(hn::Sqrt(dot(edge, edge)), change, hn::Set(f, 0x1p-120f)));
            above = hn::Or(above, hn::Gt(middle, most));
            below = hn::Or(below, hn::Lt(middle, hn::Neg(most)));
        }
        return hn::Not(hn::And(above, below));
    }

private:
    const Vec3f apex_, axis_;
    const float slope_, radius_;
};

// A cone as an asker (see `walk`).
template <int W>
class ConeAsker {
public:
    ConeAsker(const WideScene& scene, const ConeProbe<float, 3>& probe, ConeView& view)
        : blocks_(scene.blocks),
          cone_(probe),
          edges_(probe.rays()),
          frame_(probe.rays()),
          apex_(probe.rays().origin()),
          depths_(probe.rays().depths()),
          view_(view) {}

    HWY_INLINE ConeSlabs<W> slabs() const { return {cone_, limit_}; }
    HWY_INLINE float limit() const { return limit_; }
    HWY_INLINE bool found() const { return true; }
    // Whether the limit has shrunk.
    HWY_INLINE bool test(std::uint32_t leaf) {
        const TriangleBlock<float>& block = blocks_[leaf];
        bool seen = false;
        for (unsigned left = entered(block); left != 0; left &= left - 1) {
            const int place = std::countr_zero(left);
            const auto corner = [&](int c) {
                const auto at = [&](int axis) { return static_cast<double>(block.corner[axis][c][place]); };
                return Vec3d(at(0), at(1), at(2)) - apex_;
            };
            const auto functions = frame_.triangle(corner(0), corner(1), corner(2));
            seen |= take(view_, functions, depths_, block.id[place]);
        }
        if (!seen) return false;
        const float before = limit_;
        limit_ = ConeView::limit<float>(farthest(view_));
        return limit_ < before;
    }

private:
    // The triangles of a block whose boxes the cone enters.
    HWY_INLINE unsigned entered(const TriangleBlock<float>& block) const {
        constexpr Floats<8> f;
        unsigned all = 0;
        for (std::size_t first = 0; first < 8; first += hn::MaxLanes(f)) {
            const auto row = [&](int i) HWY_ATTR {
                const auto& corner = block.corner[i / 2];
                const auto a = hn::Load(f, corner[0] + first), b = hn::Load(f, corner[1] + first),
                           c = hn::Load(f, corner[2] + first);
                return i % 2 == 0 ? hn::Min(a, hn::Min(b, c)) : hn::Max(a, hn::Max(b, c));
            };
            hn::Vec<Floats<8>> entry;
            const auto x = hn::Load(f, block.corner[0][0] + first);  // NaN in places that are not used
            auto may = hn::And(cone_.enter(f, row, limit_, entry), hn::Eq(x, x));
            if (hn::AllFalse(f, may)) continue;
            const auto corner = [&](int c, int k)
                                    HWY_ATTR { return hn::Load(f, block.corner[k][c] + first); };
            may = hn::And(may, edges_.may_hit(f, corner));
            all |= bits_of(f, may) << first;
        }
        return all;
    }

    const TriangleBlock<float>* const blocks_;
    const WideCone cone_;
    const EdgesOfCone edges_;
    const ConeFrame frame_;
    const Vec3d apex_;
    const Interval<double> depths_;
    ConeView& view_;
    float limit_ = std::numeric_limits<float>::max();
};

template <int W>
void look_along_cone(const WideScene& scene, const ConeProbe<float, 3>& probe, ConeView& view) {
    walk<W, Wanted::closest>(scene.tree, ConeAsker<W>(scene, probe, view));
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
