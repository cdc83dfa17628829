/// Multipoles at points, and local expansions of points, in lanes: for large leaves of few charges beside
/// small cells, where one of the two expansions of a conversion would not converge.
#if defined(HEDGEROW_NBODY_POINTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_NBODY_POINTS_INL_H
#undef HEDGEROW_NBODY_POINTS_INL_H
#else
#define HEDGEROW_NBODY_POINTS_INL_H
#endif

#include "shifts-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Calls f(n, m, S(n, m)) with the singular harmonics of the places in the lanes (harmonics.h).
template <int order, class F, class V, class G>
HWY_INLINE void for_each_singular_in_lanes(F f, V x, V y, V z, G g) {
    using T = hn::TFromD<F>;
    const V r2 = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
    const V per_r2 = hn::Div(hn::Set(f, T(1)), r2);
    const V a = hn::Mul(x, per_r2), b = hn::Mul(y, per_r2), c = hn::Mul(z, per_r2);
    ComplexLanes<V> diagonal{hn::Sqrt(per_r2), hn::Zero(f)};
    unrolled<0, order>([&](auto m) HEDGEROW_UNROLLED {
        constexpr int M = m;
        if constexpr (M > 0) {
            const V odd = hn::Set(f, T(2 * M - 1));
            const V u = hn::Mul(odd, diagonal.re), v = hn::Mul(odd, diagonal.im);
            diagonal = {hn::NegMulAdd(v, b, hn::Mul(u, a)), hn::MulAdd(v, a, hn::Mul(u, b))};
        }
        ComplexLanes<V> before{hn::Zero(f), hn::Zero(f)}, now = diagonal;
        g(m, m, now);
        unrolled<M + 1, order>([&](auto n) HEDGEROW_UNROLLED {
            constexpr int N = n;
            const V of_now = hn::Mul(hn::Set(f, T(2 * N - 1)), c),
                    of_before = hn::Mul(hn::Set(f, T((N - 1) * (N - 1) - M * M)), per_r2);
            const ComplexLanes<V> next{hn::NegMulAdd(of_before, before.re, hn::Mul(of_now, now.re)),
                                       hn::NegMulAdd(of_before, before.im, hn::Mul(of_now, now.im))};
            before = now, now = next;
            g(n, m, now);
        });
    });
}

// Point to local: adds what charges do to sums of local expansions in lanes, about a center at the offsets
// from them: L(k, l) = (−1)ᵏ·q·S(k, l).
template <int q, class F, class V>
HWY_INLINE void expand_at(F f, V charge, V x, V y, V z, V* sums) {
    for_each_singular_in_lanes<q>(f, x, y, z, [&](auto k, auto l, ComplexLanes<V> s) HEDGEROW_UNROLLED {
        const V signed_charge = k % 2 == 0 ? charge : hn::Neg(charge);
        sums[re(k, l)] = hn::MulAdd(signed_charge, s.re, sums[re(k, l)]);
        if constexpr (l > 0) sums[im(k, l)] = hn::MulAdd(signed_charge, s.im, sums[im(k, l)]);
    });
}

// Multipole to point: the potential and its gradient at offsets from the center. With ∂S(n, m)/∂z = −S(n + 1,
// m), (∂/∂x + i∂/∂y) S(n, m) = −S(n + 1, m + 1) and (∂/∂x − i∂/∂y) S(n, m) = S(n + 1, m − 1), the gradient's
// share of S(n, m) gathers multipoles of n − 1.
template <int p, class F, class V, class T>
HWY_INLINE void evaluate_multipole(F f, const T* multipole, V x, V y, V z, V& potential, V& gx, V& gy,
                                   V& gz) {
    potential = gx = gy = gz = hn::Zero(f);
    for_each_singular_in_lanes<p + 1>(f, x, y, z, [&](auto n, auto m, ComplexLanes<V> s) HEDGEROW_UNROLLED {
        constexpr int N = n, M = m;
        constexpr T twice = M == 0 ? T(1) : T(2);
        // Adds twice · Re(conj(a + ib) · S).
        const auto add = [&](V& sum, T a, T b) HEDGEROW_UNROLLED {
            sum = hn::MulAdd(hn::Set(f, twice * a), s.re, sum);
            if constexpr (M > 0) sum = hn::MulAdd(hn::Set(f, twice * b), s.im, sum);
        };
        const auto real = [&](int k, int l) { return l <= k ? multipole[re(k, l)] : T(0); };
        const auto imaginary = [&](int k, int l) { return l > 0 && l <= k ? multipole[im(k, l)] : T(0); };
        if constexpr (N <= p) add(potential, real(N, M), imaginary(N, M));
        if constexpr (N > 0) {
            // M(n − 1, m ± 1), by symmetry where m is 0.
            const T ur = real(N - 1, M + 1), ui = imaginary(N - 1, M + 1);
            const T dr = M == 0 ? -real(N - 1, 1) : real(N - 1, M - 1);
            const T di = M == 0 ? imaginary(N - 1, 1) : imaginary(N - 1, M - 1);
            add(gx, T(0.5) * (ur - dr), T(0.5) * (ui - di));
            add(gy, T(0.5) * (ui + di), T(-0.5) * (ur + dr));
            add(gz, -real(N - 1, M), -imaginary(N - 1, M));
        }
    });
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
