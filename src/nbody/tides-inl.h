/// Tidal tensors of charges at targets, with sources in lanes.
#if defined(HEDGEROW_NBODY_TIDES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_NBODY_TIDES_INL_H
#undef HEDGEROW_NBODY_TIDES_INL_H
#else
#define HEDGEROW_NBODY_TIDES_INL_H
#endif

#include "direct-inl.h"
#include "tides.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Of softened charges, −φ'/r and −(φ'/r)'/r as shares of what the reach's powers make of them, at a distance
// of u reaches: SoftenedInverse in lanes.
template <class F, class V = hn::Vec<F>>
HWY_INLINE void softened_slopes(F f, SofteningKernel kernel, V u, V& slope, V& bend) {
    using T = hn::TFromD<F>;
    const auto sum = [&](auto... coefficients) HWY_ATTR {  // of powers of u, the highest first
        V all = hn::Zero(f);
        ((all = hn::MulAdd(all, u, hn::Set(f, T(coefficients)))), ...);
        return all;
    };
    if (kernel == SofteningKernel::wendland) {
        slope = sum(21.0, -90.0, 140.0, -84.0, 0.0, 14.0);
        bend = sum(105.0, -360.0, 420.0, -168.0);
        return;
    }
    const auto inner = hn::Lt(u, hn::Set(f, T(0.5)));
    const V one = hn::Set(f, T(1)), per_u = hn::Div(one, hn::IfThenElse(inner, one, u)),
            per_u2 = hn::Mul(per_u, per_u), tail = hn::Mul(hn::Set(f, T(1.0 / 15)), hn::Mul(per_u, per_u2));
    slope = hn::IfThenElse(inner, sum(32.0, -38.4, 0.0, 32.0 / 3),
                           hn::Sub(sum(-32.0 / 3, 38.4, -48.0, 64.0 / 3), tail));
    bend = hn::IfThenElse(inner, sum(96.0, -76.8),
                          hn::Add(hn::MulAdd(hn::Set(f, T(-48)), per_u, sum(-32.0, 76.8)),
                                  hn::Mul(hn::Set(f, T(3)), hn::Mul(tail, per_u2))));
}

// Adds the tidal tensors of all sources at all targets but of none at itself, and of bare ones in one place
// none: q·(3·d·dᵀ/r⁵ − 1/r³). Places are in two parts.
template <class T>
void direct_tides(const ChargeRows<T>& sources, const TargetRows<T>& targets, SofteningKernel kernel,
                  const detail::TideRows& tides) {
    const hn::ScalableTag<T> f;
    using V = hn::Vec<decltype(f)>;
    const V three = hn::Set(f, T(3));
    for (std::size_t t = 0; t < targets.count; ++t) {
        const V x = hn::Set(f, targets.x[t]), y = hn::Set(f, targets.y[t]), z = hn::Set(f, targets.z[t]);
        const V low_x = hn::Set(f, targets.low_x[t]), low_y = hn::Set(f, targets.low_y[t]),
                low_z = hn::Set(f, targets.low_z[t]);
        V xx = hn::Zero(f), yy = xx, zz = xx, xy = xx, xz = xx, yz = xx;
        for (std::size_t s = 0; s < sources.count; s += hn::Lanes(f)) {
            const auto apart_by = [&](const T* high, const T* low, V of_high, V of_low) HWY_ATTR {
                return hn::Add(hn::Sub(hn::LoadU(f, high + s), of_high),
                               hn::Sub(hn::LoadU(f, low + s), of_low));
            };
            const V dx = apart_by(sources.x, sources.low_x, x, low_x),
                    dy = apart_by(sources.y, sources.low_y, y, low_y),
                    dz = apart_by(sources.z, sources.low_z, z, low_z),
                    charge = hn::LoadU(f, sources.charge + s);
            const V r2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
            const auto apart = hn::Gt(r2, hn::Zero(f));
            const V per_r = hn::IfThenElseZero(apart, inverse_root(f, r2)), per_r2 = hn::Mul(per_r, per_r);
            V slope = hn::Mul(per_r, per_r2), bend = hn::Mul(three, hn::Mul(slope, per_r2));
            if (sources.reach != nullptr) {
                const V reach = hn::Max(hn::LoadU(f, sources.reach + s), hn::Set(f, targets.reach[t]));
                // The number of the lane that is the target itself; none has −1.
                const std::ptrdiff_t own =
                    targets.self == no_self
                        ? -1
                        : static_cast<std::ptrdiff_t>(targets.self + t) - static_cast<std::ptrdiff_t>(s);
                const auto others = hn::Ne(hn::Iota(f, T(0)), hn::Set(f, static_cast<T>(own)));
                const auto near = hn::And(others, hn::Lt(r2, hn::Mul(reach, reach)));
                if (!hn::AllFalse(f, near)) {
                    const V per = hn::Div(hn::Set(f, T(1)), hn::IfThenElse(near, reach, hn::Set(f, T(1)))),
                            per2 = hn::Mul(per, per), per3 = hn::Mul(per, per2);
                    V soft_slope, soft_bend;
                    softened_slopes(f, kernel, hn::Mul(hn::Mul(r2, per_r), per), soft_slope, soft_bend);
                    slope = hn::IfThenElse(near, hn::Mul(soft_slope, per3), slope);
                    bend = hn::IfThenElse(near, hn::Neg(hn::Mul(soft_bend, hn::Mul(per3, per2))), bend);
                }
            }
            slope = hn::Mul(slope, charge), bend = hn::Mul(bend, charge);
            const V bx = hn::Mul(bend, dx), by = hn::Mul(bend, dy), bz = hn::Mul(bend, dz);
            xx = hn::Add(xx, hn::MulSub(bx, dx, slope)), yy = hn::Add(yy, hn::MulSub(by, dy, slope));
            zz = hn::Add(zz, hn::MulSub(bz, dz, slope));
            xy = hn::MulAdd(bx, dy, xy), xz = hn::MulAdd(bx, dz, xz), yz = hn::MulAdd(by, dz, yz);
        }
        const auto all = [&](V v) { return static_cast<double>(hn::GetLane(hn::SumOfLanes(f, v))); };
        tides.add(t, {all(xx), all(yy), all(zz), all(xy), all(xz), all(yz)});
    }
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
