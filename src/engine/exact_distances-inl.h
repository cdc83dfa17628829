/// The exact distances of a point to triangles, several triangles at once.
#if defined(HEDGEROW_ENGINE_EXACT_DISTANCES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_EXACT_DISTANCES_INL_H
#undef HEDGEROW_ENGINE_EXACT_DISTANCES_INL_H
#else
#define HEDGEROW_ENGINE_EXACT_DISTANCES_INL_H
#endif

#include <limits>

#include <hwy/highway.h>

#include "coordinates-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Does what `closest_point` (geometry/distance.h) does for a triangle that it does not scale, in the lanes of
// D, which are doubles: the same operations in the same order, each rounded by itself. All choices are made
// by selection.
template <class D>
class ExactFeet {
public:
    using V = hn::Vec<D>;
    using C = Coordinates<D>;

    HWY_INLINE ExactFeet(D d, const C& p, const C& a, const C& b, const C& c)
        : distance2_(hn::Set(d, std::numeric_limits<double>::infinity())), point_(a) {
        const V zero = hn::Zero(d), one = hn::Set(d, 1.0);
        const C ab = minus(b, a), ac = minus(c, a), ap = minus(p, a);
        // The foot of the perpendicular to the plane.
        const V ab2 = product(ab, ab);
        const C height = minus(ac, times(ab, hn::Div(product(ac, ab), ab2)));
        const V along = hn::Div(product(ap, ab), ab2);
        const V height2 = product(height, height);
        const V w = hn::Div(product(minus(ap, times(ab, along)), height), height2);
        const V v = hn::Sub(along, hn::Mul(w, hn::Div(product(ac, ab), ab2)));
        const auto inside = hn::And(hn::And(hn::Ge(v, zero), hn::Ge(w, zero)), hn::Le(hn::Add(v, w), one));
        const C on_ab = times(ab, v), on_ac = times(ac, w), r = minus(minus(ap, on_ab), on_ac);
        take(inside, product(r, r), plus(plus(a, on_ab), on_ac));
        // The edges, unless the foot is inside of a triangle that is no sliver.
        const auto edges =
            hn::Not(hn::And(inside, hn::Gt(height2, hn::Mul(hn::Set(d, 0x1p-8), product(ac, ac)))));
        if (!hn::AllFalse(d, edges)) {
            try_segment(d, edges, p, a, b);
            try_segment(d, edges, p, b, c);
            try_segment(d, edges, p, c, a);
        }
        // No less than the distance to the triangle's box.
        const C low = least(a, least(b, c)), high = greatest(a, greatest(b, c));
        const C outside = greatest(greatest(minus(low, p), minus(p, high)), C{zero, zero, zero});
        distance2_ = hn::Max(distance2_, product(outside, outside));
    }
    HWY_INLINE V distance2() const { return distance2_; }
    /// Before it is rounded and clamped.
    HWY_INLINE const C& point() const { return point_; }

private:
    HWY_INLINE void take(hn::Mask<D> where, V distance2, const C& point) {
        distance2_ = hn::IfThenElse(where, distance2, distance2_);
        point_ = chosen<D>(where, point, point_);
    }
    // `foot_on_segment`
    HWY_INLINE void try_segment(D d, hn::Mask<D> where, const C& p, const C& a, const C& b) {
        const auto turned = hn::Or(
            hn::Lt(b.x, a.x),
            hn::And(hn::Eq(b.x, a.x), hn::Or(hn::Lt(b.y, a.y), hn::And(hn::Eq(b.y, a.y), hn::Lt(b.z, a.z)))));
        const C from = chosen<D>(turned, b, a), to = chosen<D>(turned, a, b);
        const C along = minus(to, from), x = minus(p, from);
        const V l = product(along, along), zero = hn::Zero(d);
        const V t = hn::IfThenElseZero(hn::Gt(l, zero), hn::Div(product(x, along), l));
        const auto begun = hn::Gt(t, zero), ended = hn::Ge(t, hn::Set(d, 1.0));
        const C on = times(along, t);
        const C r = chosen<D>(ended, minus(p, to), chosen<D>(begun, minus(x, on), x));
        const V distance2 = product(r, r);
        take(hn::AndNot(hn::Ge(distance2, distance2_), where), distance2,
             chosen<D>(ended, to, chosen<D>(begun, plus(from, on), from)));
    }

    V distance2_;
    C point_;
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
