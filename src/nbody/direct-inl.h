/// Sums over all pairs of sources and targets, with sources in lanes.
#if defined(HEDGEROW_NBODY_DIRECT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_NBODY_DIRECT_INL_H
#undef HEDGEROW_NBODY_DIRECT_INL_H
#else
#define HEDGEROW_NBODY_DIRECT_INL_H
#endif

#include <cmath>
#include <cstddef>
#include <limits>

#include <hwy/highway.h>

#include <hedgerow/nbody/kernels.h>

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// 1/√x from the processor's estimate e, by steps of Newton's: with h = 1 − x·e², a step e·(1 + h/2) errs by
// 3/8·h². In float one step suffices for 2⁻²¹, two for about the last bit (`precise`); in double two do.
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
        return step(step(e));
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

// How places are given: in one part, or in two. Charges in one place make sums that are not finite, but for
// `exact`, which takes two parts: bare charges in one place do nothing to each other, softened ones do.
enum class Pairs { plain, split, exact };

// Adds what sources do to `block` targets. The sums stay in registers: with 16 of them for two targets, with
// 32 for four.
template <int block, bool softened, Pairs pairs, class F, class T = hn::TFromD<F>>
class BlockSums {
    using V = hn::Vec<F>;
    static constexpr bool in_two_parts = pairs != Pairs::plain;

public:
    HWY_INLINE BlockSums(const ChargeRows<T>& sources, const TargetRows<T>& targets, std::size_t at,
                         SofteningKernel kernel)
        : sources_(sources), targets_(targets), at_(at), kernel_(kernel) {
        const F f;
        for (int i = 0; i < block; ++i) {
            const std::size_t t = at + static_cast<std::size_t>(i);
            x_[i] = hn::Set(f, targets.x[t]), y_[i] = hn::Set(f, targets.y[t]);
            z_[i] = hn::Set(f, targets.z[t]);
            if constexpr (in_two_parts) {
                low_x_[i] = hn::Set(f, targets.low_x[t]), low_y_[i] = hn::Set(f, targets.low_y[t]);
                low_z_[i] = hn::Set(f, targets.low_z[t]);
            }
            potential_[i] = gx_[i] = gy_[i] = gz_[i] = hn::Zero(f);
        }
        squares_ = softened_ = hn::Zero(f);
    }

    // Adds the sources from `first` to `end`. `with_self`: the targets may be among them.
    template <bool with_self>
    HWY_INLINE void add(std::size_t first, std::size_t end) {
        const F f;
        for (std::size_t s = first; s < end; s += hn::Lanes(f)) {
            const V sx = hn::LoadU(f, sources_.x + s), sy = hn::LoadU(f, sources_.y + s),
                    sz = hn::LoadU(f, sources_.z + s), charge = hn::LoadU(f, sources_.charge + s);
            for (int i = 0; i < block; ++i) {
                V dx = hn::Sub(sx, x_[i]), dy = hn::Sub(sy, y_[i]), dz = hn::Sub(sz, z_[i]);
                if constexpr (in_two_parts) {
                    dx = hn::Add(dx, hn::Sub(hn::LoadU(f, sources_.low_x + s), low_x_[i]));
                    dy = hn::Add(dy, hn::Sub(hn::LoadU(f, sources_.low_y + s), low_y_[i]));
                    dz = hn::Add(dz, hn::Sub(hn::LoadU(f, sources_.low_z + s), low_z_[i]));
                }
                const V r2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
                V inverse = inverse_root<in_two_parts>(f, r2);
                // Leave out the target itself, and charges in its place.
                hn::Mask<F> itself{}, one_place{};
                if constexpr (with_self) {
                    const auto own = static_cast<std::ptrdiff_t>(targets_.self + at_) + i;
                    itself = hn::Eq(hn::Iota(f, T(0)),
                                    hn::Set(f, static_cast<T>(own - static_cast<std::ptrdiff_t>(s))));
                    inverse = hn::IfThenZeroElse(itself, inverse);
                }
                if constexpr (pairs == Pairs::exact) {
                    one_place = hn::Eq(r2, hn::Zero(f));
                    inverse = hn::IfThenZeroElse(one_place, inverse);
                }
                V of_potential = hn::Mul(charge, inverse);
                V of_gradient = hn::Mul(of_potential, hn::Mul(inverse, inverse));
                if constexpr (softened) {
                    const V reach = hn::Max(hn::LoadU(f, sources_.reach + s),
                                            hn::Set(f, targets_.reach[at_ + static_cast<std::size_t>(i)]));
                    auto near = hn::Lt(r2, hn::Mul(reach, reach));
                    if constexpr (with_self) near = hn::AndNot(itself, near);
                    if (HWY_UNLIKELY(!hn::AllFalse(f, near))) {
                        const V distance = hn::Mul(r2, inverse);
                        soften(f, kernel_, near, charge, distance, reach, of_potential, of_gradient);
                        // A rounding of the target changes all these by the same, for they pull as springs.
                        V pull = hn::IfThenElseZero(near, hn::Abs(of_gradient));
                        if constexpr (pairs == Pairs::split)
                            pull = hn::Mul(pull, hn::Add(distance, hn::Set(f, T(split_distance))));
                        softened_ = hn::Add(softened_, pull);
                    }
                }
                potential_[i] = hn::Add(potential_[i], of_potential);
                gx_[i] = hn::MulAdd(of_gradient, dx, gx_[i]);
                gy_[i] = hn::MulAdd(of_gradient, dy, gy_[i]);
                gz_[i] = hn::MulAdd(of_gradient, dz, gz_[i]);
                // What the roundings of a pair do to its gradient.
                if constexpr (pairs == Pairs::split)
                    squares_ =
                        hn::MulAdd(hn::Mul(of_gradient, of_gradient),
                                   hn::Add(r2, hn::Set(f, T(split_distance * split_distance))), squares_);
                else
                    squares_ = hn::MulAdd(of_gradient, of_gradient, squares_);
                if constexpr (pairs == Pairs::exact) {  // distances whose squares vanish are not 0
                    const auto in_place = hn::Eq(hn::Or(dx, hn::Or(dy, dz)), hn::Zero(f));
                    squares_ = hn::IfThenElse(hn::AndNot(in_place, one_place),
                                              hn::Set(f, std::numeric_limits<T>::infinity()), squares_);
                }
            }
        }
    }

    HWY_INLINE void store() const {
        const F f;
        const auto sum = [&](V v) { return static_cast<double>(hn::GetLane(hn::SumOfLanes(f, v))); };
        const double squares = sum(squares_), of_softened = softened ? sum(softened_) : 0;
        for (int i = 0; i < block; ++i) {
            const std::size_t t = at_ + static_cast<std::size_t>(i);
            if (t >= targets_.count) return;
            targets_.potential[t] += sum(potential_[i]);
            targets_.gx[t] += sum(gx_[i]), targets_.gy[t] += sum(gy_[i]), targets_.gz[t] += sum(gz_[i]);
            const double root = std::sqrt(targets_.squares[t]) + of_softened;
            targets_.squares[t] = root * root + squares;
        }
    }

private:
    const ChargeRows<T>& sources_;
    const TargetRows<T>& targets_;
    const std::size_t at_;
    const SofteningKernel kernel_;
    V x_[block], y_[block], z_[block], low_x_[block], low_y_[block], low_z_[block];
    V potential_[block], gx_[block], gy_[block], gz_[block], squares_, softened_;
};

template <int block, bool softened, Pairs pairs, class F, class T = hn::TFromD<F>>
HWY_INLINE void add_to_block(F f, const ChargeRows<T>& sources, std::size_t first, std::size_t end,
                             const TargetRows<T>& targets, std::size_t at, SofteningKernel kernel) {
    BlockSums<block, softened, pairs, F> sums(sources, targets, at, kernel);
    // The vectors of sources that hold the targets themselves, if any do.
    std::size_t own = end, beyond = end;
    if (targets.self != no_self) {
        const std::size_t lanes = hn::Lanes(f), begin = targets.self + at;
        own = HWY_MIN(HWY_MAX(first, begin / lanes * lanes), end);
        beyond = HWY_MIN(HWY_MAX(own, (begin + block + lanes - 1) / lanes * lanes), end);
    }
    sums.template add<false>(first, own);
    sums.template add<true>(own, beyond);
    sums.template add<false>(beyond, end);
    sums.store();
}

template <class T, Pairs pairs = Pairs::plain>
void direct(const ChargeRows<T>& sources, const TargetRows<T>& targets, SofteningKernel kernel) {
    constexpr int block = HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_NEON ? 4 : 2;
    constexpr std::size_t at_once = pairs == Pairs::plain ? 1024 : 256;
    const hn::ScalableTag<T> f;
    for (std::size_t first = 0; first < sources.count; first += at_once) {
        const std::size_t end = HWY_MIN(sources.count, first + at_once);
        for (std::size_t t = 0; t < targets.count; t += block)
            if (sources.reach == nullptr)
                add_to_block<block, false, pairs>(f, sources, first, end, targets, t, kernel);
            else
                add_to_block<block, true, pairs>(f, sources, first, end, targets, t, kernel);
    }
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
