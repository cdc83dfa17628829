/// Distances of points to a few elements, an element a lane (hedgerow/engine/near_elements.h).
#if defined(HEDGEROW_ENGINE_NEAR_ELEMENTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_NEAR_ELEMENTS_INL_H
#undef HEDGEROW_ENGINE_NEAR_ELEMENTS_INL_H
#else
#define HEDGEROW_ENGINE_NEAR_ELEMENTS_INL_H
#endif

#include <bit>
#include <limits>

#include <hwy/highway.h>

#include "boxes-inl.h"
#include "coordinates-inl.h"
#include "near_elements.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

// What near_elements.cpp does for one element after the other: the same operations in the same order, each
// rounded by itself.
class ElementLanes {
public:
    static void prepare(NearElements& near) {
        near.slivers = 0;
        for (int i = 0; i < near.count; i += lanes) near.slivers |= prepare(near, i) << i;
        near.slivers &= near.points ? 0 : (1u << near.count) - 1;
    }
    static void measure(const NearElements& near, const DistanceMargin& margin, const Vec3d* points,
                        int count, ToElements* found) {
        for (int n = 0; n < count; ++n) measure(near, margin, points[n], found[n]);
    }

private:
    using D = hn::CappedTag<double, NearElements::most>;  // 8, 4 or 2 lanes
    using V = hn::Vec<D>;
    using C = Coordinates<D>;
    static constexpr int lanes = static_cast<int>(hn::MaxLanes(D()));

    static HWY_INLINE C load(const double (&row)[3][NearElements::most], int i) {
        const D d;
        return {hn::Load(d, row[0] + i), hn::Load(d, row[1] + i), hn::Load(d, row[2] + i)};
    }
    static HWY_INLINE void store(const C& c, double (&row)[3][NearElements::most], int i) {
        const D d;
        hn::Store(c.x, d, row[0] + i), hn::Store(c.y, d, row[1] + i), hn::Store(c.z, d, row[2] + i);
    }
    static HWY_INLINE V reciprocal(V x) {
        const D d;
        return hn::IfThenElseZero(hn::Gt(x, hn::Set(d, detail::least_product)), hn::Div(hn::Set(d, 1.0), x));
    }
    // Returns the bits of slivers.
    static HWY_INLINE unsigned prepare(NearElements& near, int i) {
        const D d;
        const C a = load(near.a, i), ab = minus(load(near.b, i), a), ac = minus(load(near.c, i), a);
        const C bc = minus(ac, ab);
        const V ab2 = product(ab, ab), ac2 = product(ac, ac), abac = product(ab, ac);
        const V both = hn::Mul(ab2, ac2), area2 = hn::Sub(both, hn::Mul(abac, abac));
        const auto plain = hn::Gt(
            area2, hn::Max(hn::Mul(hn::Set(d, detail::least_area), both), hn::Set(d, detail::least_product)));
        store(ab, near.ab, i), store(ac, near.ac, i);
        hn::Store(ab2, d, near.ab2 + i), hn::Store(ac2, d, near.ac2 + i), hn::Store(abac, d, near.abac + i);
        hn::Store(reciprocal(ab2), d, near.per_ab2 + i);
        hn::Store(reciprocal(ac2), d, near.per_ac2 + i);
        hn::Store(reciprocal(product(bc, bc)), d, near.per_bc2 + i);
        hn::Store(reciprocal(area2), d, near.per_area2 + i);
        return bits_of(d, hn::Not(plain));
    }

    static HWY_INLINE V part_of_edge(V x) { return hn::Min(hn::Max(x, hn::Zero(D())), hn::Set(D(), 1.0)); }
    static HWY_INLINE V length2(const C& x) { return product(x, x); }
    static HWY_INLINE V distance2(const NearElements& near, const C& p, int i) {
        const D d;
        const C ab = load(near.ab, i), ac = load(near.ac, i), bc = minus(ac, ab);
        const C ap = minus(p, load(near.a, i)), bp = minus(ap, ab);
        const V along_ab = product(ap, ab), along_ac = product(ap, ac);
        const V ab2 = hn::Load(d, near.ab2 + i), ac2 = hn::Load(d, near.ac2 + i);
        const V abac = hn::Load(d, near.abac + i);
        // The edges.
        const V on_ab = part_of_edge(hn::Mul(along_ab, hn::Load(d, near.per_ab2 + i)));
        const V on_ac = part_of_edge(hn::Mul(along_ac, hn::Load(d, near.per_ac2 + i)));
        const V along_bc = hn::Add(hn::Sub(along_ac, along_ab), hn::Sub(ab2, abac));
        const V on_bc = part_of_edge(hn::Mul(along_bc, hn::Load(d, near.per_bc2 + i)));
        const V of_edges =
            hn::Min(hn::Min(length2(minus(ap, times(ab, on_ab))), length2(minus(ap, times(ac, on_ac)))),
                    length2(minus(bp, times(bc, on_bc))));
        // The face.
        const V per_area2 = hn::Load(d, near.per_area2 + i), zero = hn::Zero(d);
        const V v = hn::Mul(hn::Sub(hn::Mul(along_ab, ac2), hn::Mul(along_ac, abac)), per_area2);
        const V w = hn::Mul(hn::Sub(hn::Mul(along_ac, ab2), hn::Mul(along_ab, abac)), per_area2);
        const V of_face = length2(minus(minus(ap, times(ab, v)), times(ac, w)));
        const auto inside =
            hn::And(hn::And(hn::Ge(v, zero), hn::Ge(w, zero)), hn::Le(hn::Add(v, w), hn::Set(d, 1.0)));
        return hn::IfThenElse(inside, of_face, of_edges);
    }
    static HWY_INLINE void measure(const NearElements& near, const DistanceMargin& margin, const Vec3d& p,
                                   ToElements& found) {
        const D d;
        const C point = all_lanes(d, p);
        const V infinity = hn::Set(d, std::numeric_limits<double>::infinity());
        for (int i = 0; i < NearElements::most; i += lanes) {
            if (i >= near.count) {
                hn::Store(infinity, d, found.distance + i);
                continue;
            }
            const V distance = hn::Sqrt(distance2(near, point, i));
            const V above =
                hn::Add(hn::Mul(distance, hn::Set(d, 1 + margin.relative)), hn::Set(d, margin.absolute));
            const auto there = hn::FirstN(d, static_cast<std::size_t>(near.count - i));
            hn::Store(hn::IfThenElse(there, above, infinity), d, found.distance + i);
        }
        if (near.slivers != 0) detail::measure_slivers(near, margin, p, found.distance);
        V least = infinity;
        for (int i = 0; i < near.count; i += lanes) least = hn::Min(least, hn::Load(d, found.distance + i));
        least = hn::MinOfLanes(d, least);
        unsigned nearest = 0;
        for (int i = 0; i < near.count; i += lanes)
            nearest |= bits_of(d, hn::Eq(least, hn::Load(d, found.distance + i))) << i;
        found.nearest = std::countr_zero(nearest);
    }
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
