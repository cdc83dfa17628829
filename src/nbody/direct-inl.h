/// Sums over all pairs of sources and targets, with sources in lanes.
#if defined(HEDGEROW_NBODY_DIRECT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_NBODY_DIRECT_INL_H
#undef HEDGEROW_NBODY_DIRECT_INL_H
#else
#define HEDGEROW_NBODY_DIRECT_INL_H
#endif

#include <hwy/highway.h>

#include <hedgerow/nbody/kernels.h>

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// 1/√x from the processor's estimate e of b bits, by steps of Newton's: with h = 1 − x·e², a step e·(1 + h/2)
// errs by 3/8·h², and e·(1 + h/2 + 3/8·h²) by 5/16·h³.
// In float one step suffices for 2⁻²¹, two for about the last bit (`precise`).
template <bool precise = false, class F, class V = hn::Vec<F>>
HWY_INLINE V inverse_root(F f, V x) {
    using T = hn::TFromD<F>;
    const V one = hn::Set(f, T(1)), half = hn::Set(f, T(0.5));
    const auto error = [&](V e) { return hn::NegMulAdd(hn::Mul(x, e), e, one); };
    const auto step = [&](V e) { return hn::MulAdd(hn::Mul(e, error(e)), half, e); };
    if constexpr (sizeof(T) == 4) {
#if HWY_TARGET == HWY_NEON
        const V e = step(hn::ApproximateReciprocalSqrt(x));  // of 8 bits
        if constexpr (!precise) return step(e);
#else
        const V e = hn::ApproximateReciprocalSqrt(x);  // of 12 or 14 bits
        if constexpr (!precise) return step(e);
#endif
        return step(step(e));
    } else {
#if HWY_TARGET == HWY_AVX3
        const V e = V{_mm512_rsqrt14_pd(x.raw)};
        const V h = error(e);
        const V correction = hn::Mul(h, hn::MulAdd(h, hn::Set(f, T(0.375)), half));
        return hn::MulAdd(e, correction, e);
#else
        return hn::Div(one, hn::Sqrt(x));
#endif
    }
}

// Softens what charges do that are near: SoftenedInverse in lanes, of the distance as a share of the reach.
template <class F, class V = hn::Vec<F>, class M = hn::Mask<F>>
HWY_INLINE void soften(F f, SofteningKernel kernel, M near, V charge, V distance, V reach, V& of_potential,
                       V& of_gradient) {
    using T = hn::TFromD<F>;
    const V per_reach = hn::Div(hn::Set(f, T(1)), hn::IfThenElse(near, reach, hn::Set(f, T(1))));
    const V u = hn::IfThenElseZero(near, hn::Mul(distance, per_reach)), u2 = hn::Mul(u, u);
    const auto sum = [&](V x, auto... coefficients) HWY_ATTR {  // of powers of x, the highest first
        V all = hn::Zero(f);
        ((all = hn::MulAdd(all, x, hn::Set(f, T(coefficients)))), ...);
        return all;
    };
    V potential, force;
    if (kernel == SofteningKernel::wendland) {
        potential = hn::MulAdd(u2, hn::MulAdd(u2, sum(u, -3.0, 15.0, -28.0, 21.0), hn::Set(f, T(-7))),
                               hn::Set(f, T(3)));
        force = hn::MulAdd(u2, sum(u, 21.0, -90.0, 140.0, -84.0), hn::Set(f, T(14)));
    } else {
        const auto inner = hn::Lt(u, hn::Set(f, T(0.5)));
        const V tail = hn::Div(hn::Set(f, T(1.0 / 15)), hn::IfThenElse(inner, hn::Set(f, T(1)), u));
        const V inside =
            hn::NegMulAdd(u2, hn::MulAdd(u2, sum(u, 6.4, -9.6), hn::Set(f, T(16.0 / 3))), hn::Set(f, T(2.8)));
        const V outside =
            hn::Sub(hn::NegMulAdd(u2, sum(u, -32.0 / 15, 9.6, -16.0, 32.0 / 3), hn::Set(f, T(3.2))), tail);
        potential = hn::IfThenElse(inner, inside, outside);
        const V force_inside = hn::MulAdd(u2, sum(u, 32.0, -38.4), hn::Set(f, T(32.0 / 3)));
        const V rest = hn::Div(tail, hn::IfThenElse(inner, hn::Set(f, T(1)), u2));
        const V force_outside = hn::Sub(sum(u, -32.0 / 3, 38.4, -48.0, 64.0 / 3), rest);
        force = hn::IfThenElse(inner, force_inside, force_outside);
    }
    const V of_charge = hn::Mul(charge, per_reach);
    of_potential = hn::IfThenElse(near, hn::Mul(of_charge, potential), of_potential);
    of_gradient =
        hn::IfThenElse(near, hn::Mul(hn::Mul(of_charge, force), hn::Mul(per_reach, per_reach)), of_gradient);
}

// Adds what sources do to `block` targets. If places are split in two parts, each is summed of its own. The
// sums stay in registers: with 16 of them for two targets, with 32 for four.
template <int block, bool softened, bool split, class F, class T = hn::TFromD<F>>
HWY_INLINE void add_to_block(F f, const ChargeRows<T>& sources, std::size_t first, std::size_t end,
                             const TargetRows<T>& targets, std::size_t at, SofteningKernel kernel) {
    using V = hn::Vec<F>;
    V low_x[block], low_y[block], low_z[block];
    V x[block], y[block], z[block], potential[block], gx[block], gy[block], gz[block];
    for (int i = 0; i < block; ++i) {
        const std::size_t t = at + static_cast<std::size_t>(i);
        x[i] = hn::Set(f, targets.x[t]), y[i] = hn::Set(f, targets.y[t]), z[i] = hn::Set(f, targets.z[t]);
        if constexpr (split) {
            low_x[i] = hn::Set(f, targets.low_x[t]), low_y[i] = hn::Set(f, targets.low_y[t]);
            low_z[i] = hn::Set(f, targets.low_z[t]);
        }
        potential[i] = gx[i] = gy[i] = gz[i] = hn::Zero(f);
    }
    const V least = hn::Set(f, coincident2<T>);
    for (std::size_t s = first; s < end; s += hn::Lanes(f)) {
        const V sx = hn::LoadU(f, sources.x + s), sy = hn::LoadU(f, sources.y + s),
                sz = hn::LoadU(f, sources.z + s), charge = hn::LoadU(f, sources.charge + s);
        for (int i = 0; i < block; ++i) {
            V dx = hn::Sub(sx, x[i]), dy = hn::Sub(sy, y[i]), dz = hn::Sub(sz, z[i]);
            if constexpr (split) {
                dx = hn::Add(dx, hn::Sub(hn::LoadU(f, sources.low_x + s), low_x[i]));
                dy = hn::Add(dy, hn::Sub(hn::LoadU(f, sources.low_y + s), low_y[i]));
                dz = hn::Add(dz, hn::Sub(hn::LoadU(f, sources.low_z + s), low_z[i]));
            }
            const V r2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
            const auto apart = hn::Ge(r2, least);
            const V inverse = hn::IfThenElseZero(apart, inverse_root<split>(f, r2));
            V of_potential = hn::Mul(charge, inverse);
            V of_gradient = hn::Mul(of_potential, hn::Mul(inverse, inverse));
            if constexpr (softened) {
                const V reach = hn::Max(hn::LoadU(f, sources.reach + s),
                                        hn::Set(f, targets.reach[at + static_cast<std::size_t>(i)]));
                const auto near = hn::And(apart, hn::Lt(r2, hn::Mul(reach, reach)));
                if (HWY_UNLIKELY(!hn::AllFalse(f, near)))
                    soften(f, kernel, near, charge, hn::Mul(r2, inverse), reach, of_potential, of_gradient);
            }
            potential[i] = hn::Add(potential[i], of_potential);
            gx[i] = hn::MulAdd(of_gradient, dx, gx[i]);
            gy[i] = hn::MulAdd(of_gradient, dy, gy[i]);
            gz[i] = hn::MulAdd(of_gradient, dz, gz[i]);
        }
    }
    const auto sum = [&](V v) { return static_cast<double>(hn::GetLane(hn::SumOfLanes(f, v))); };
    for (int i = 0; i < block; ++i) {
        const std::size_t t = at + static_cast<std::size_t>(i);
        if (t >= targets.count) return;
        targets.potential[t] += sum(potential[i]);
        targets.gx[t] += sum(gx[i]), targets.gy[t] += sum(gy[i]), targets.gz[t] += sum(gz[i]);
    }
}

template <class T, bool split = false>
void direct(const ChargeRows<T>& sources, const TargetRows<T>& targets, SofteningKernel kernel) {
    constexpr int block = HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_NEON ? 4 : 2;
    constexpr std::size_t at_once = split ? 256 : 1024;
    const hn::ScalableTag<T> f;
    for (std::size_t first = 0; first < sources.count; first += at_once) {
        const std::size_t end = HWY_MIN(sources.count, first + at_once);
        for (std::size_t t = 0; t < targets.count; t += block)
            if (sources.reach == nullptr)
                add_to_block<block, false, split>(f, sources, first, end, targets, t, kernel);
            else
                add_to_block<block, true, split>(f, sources, first, end, targets, t, kernel);
    }
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
