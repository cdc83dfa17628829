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
template <class F, class V = hn::Vec<F>>
HWY_INLINE V inverse_root(F f, V x) {
    using T = hn::TFromD<F>;
    const V one = hn::Set(f, T(1)), half = hn::Set(f, T(0.5));
    const auto error = [&](V e) { return hn::NegMulAdd(hn::Mul(x, e), e, one); };
    const auto step = [&](V e) { return hn::MulAdd(hn::Mul(e, error(e)), half, e); };
    if constexpr (sizeof(T) == 4) {
#if HWY_TARGET == HWY_NEON
        return step(step(hn::ApproximateReciprocalSqrt(x)));  // of 8 bits
#else
        return step(hn::ApproximateReciprocalSqrt(x));  // of 12 or 14 bits
#endif
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

// Adds what sources do to `block` targets. The sums stay in registers: with 16 of them for two targets, with
// 32 for four.
template <int block, class F, class T = hn::TFromD<F>>
HWY_INLINE void add_to_block(F f, const ChargeRows<T>& sources, std::size_t first, std::size_t end,
                             const TargetRows<T>& targets, std::size_t at) {
    using V = hn::Vec<F>;
    V x[block], y[block], z[block], potential[block], gx[block], gy[block], gz[block];
    for (int i = 0; i < block; ++i) {
        const std::size_t t = at + static_cast<std::size_t>(i);
        x[i] = hn::Set(f, targets.x[t]), y[i] = hn::Set(f, targets.y[t]), z[i] = hn::Set(f, targets.z[t]);
        potential[i] = gx[i] = gy[i] = gz[i] = hn::Zero(f);
    }
    const V least = hn::Set(f, coincident2<T>);
    for (std::size_t s = first; s < end; s += hn::Lanes(f)) {
        const V sx = hn::LoadU(f, sources.x + s), sy = hn::LoadU(f, sources.y + s),
                sz = hn::LoadU(f, sources.z + s), charge = hn::LoadU(f, sources.charge + s);
        for (int i = 0; i < block; ++i) {
            const V dx = hn::Sub(sx, x[i]), dy = hn::Sub(sy, y[i]), dz = hn::Sub(sz, z[i]);
            const V r2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
            const V inverse = hn::IfThenElseZero(hn::Ge(r2, least), inverse_root(f, r2));
            const V of_potential = hn::Mul(charge, inverse);
            const V of_gradient = hn::Mul(of_potential, hn::Mul(inverse, inverse));
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

template <class T>
void direct(const ChargeRows<T>& sources, const TargetRows<T>& targets) {
    constexpr int block = HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_NEON ? 4 : 2;
    constexpr std::size_t at_once = 1024;
    const hn::ScalableTag<T> f;
    for (std::size_t first = 0; first < sources.count; first += at_once) {
        const std::size_t end = HWY_MIN(sources.count, first + at_once);
        for (std::size_t t = 0; t < targets.count; t += block)
            add_to_block<block>(f, sources, first, end, targets, t);
    }
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
