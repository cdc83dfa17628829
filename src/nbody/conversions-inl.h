/// Multipole to local, with sources in lanes: the expansions are turned until the other cell is on the z
/// axis, converted there, and turned back.
#if defined(HEDGEROW_NBODY_CONVERSIONS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_NBODY_CONVERSIONS_INL_H
#undef HEDGEROW_NBODY_CONVERSIONS_INL_H
#else
#define HEDGEROW_NBODY_CONVERSIONS_INL_H
#endif

#include <hwy/highway.h>

#include <type_traits>
#include <utility>

#include <hedgerow/nbody/swap_matrices.h>

#include "packed.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Calls f(std::integral_constant<int, i>) for i = first ... last, unrolled. HEDGEROW_UNROLLED, the attributes
// of such functions, says whether they become one piece of code; the file that includes this one defines it.
template <int first, int last, class F>
HWY_INLINE void unrolled(F f) {
    if constexpr (first <= last) [&]<int... i>(std::integer_sequence<int, i...>) HEDGEROW_UNROLLED {
            (f(std::integral_constant<int, first + i>()), ...);
        }
    (std::make_integer_sequence<int, last - first + 1>());
}

// The powers 1 to `order` of a number of modulus 1.
template <int order, class F, class V = hn::Vec<F>>
struct Turn {
    V c[order + 1], s[order + 1];
    HWY_INLINE Turn(F, V cosine, V sine) {
        c[1] = cosine, s[1] = sine;
        for (int m = 2; m <= order; ++m) {
            c[m] = hn::NegMulAdd(s[m - 1], sine, hn::Mul(c[m - 1], cosine));
            s[m] = hn::MulAdd(s[m - 1], cosine, hn::Mul(c[m - 1], sine));
        }
    }
};
// X(n, m) *= turnᵐ, or by its inverse.
template <int order, bool back, class F, class T, class V = hn::Vec<F>>
HWY_INLINE void turn_about_z(F, V* x, const T& turn) {
    unrolled<1, order>([&](auto n) HEDGEROW_UNROLLED {
        unrolled<1, n>([&](auto m) HEDGEROW_UNROLLED {
            const V a = x[re(n, m)], b = x[im(n, m)], c = turn.c[m], s = turn.s[m];
            if constexpr (back) {
                x[re(n, m)] = hn::MulAdd(b, s, hn::Mul(a, c));
                x[im(n, m)] = hn::NegMulAdd(a, s, hn::Mul(b, c));
            } else {
                x[re(n, m)] = hn::NegMulAdd(b, s, hn::Mul(a, c));
                x[im(n, m)] = hn::MulAdd(a, s, hn::Mul(b, c));
            }
        });
    });
}
template <int order>
inline constexpr SwapMatrices<order> swap_matrices{};

// Swaps the axes x and z.
template <int order, bool local, class F, class V = hn::Vec<F>>
HWY_INLINE void swap_x_z(F f, V* x) {
    using T = hn::TFromD<F>;
    unrolled<1, order>([&](auto n) HEDGEROW_UNROLLED {
        V out[2 * n + 1];
        unrolled<0, n>([&](auto m) HEDGEROW_UNROLLED {
            constexpr int N = n, M = m;
            const auto sum = [&](auto is_real) HEDGEROW_UNROLLED {
                constexpr bool real = is_real;
                V all = hn::Zero(f);
                bool first = true;
                unrolled<0, N>([&](auto l) HEDGEROW_UNROLLED {
                    constexpr int L = l;
                    constexpr double b = local ? swap_matrices<order>.local(N, M, L, real)
                                               : swap_matrices<order>.multipole(N, M, L, real);
                    if constexpr (b != 0 && (real || L > 0)) {
                        const V part = x[real ? re(N, L) : im(N, L)];
                        if (first)
                            all = b == 1 ? part : hn::Mul(hn::Set(f, T(b)), part);
                        else
                            all = b == 1 ? hn::Add(all, part) : hn::MulAdd(hn::Set(f, T(b)), part, all);
                        first = false;
                    }
                });
                return all;
            };
            out[M == 0 ? 0 : 2 * M - 1] = sum(std::true_type());
            if constexpr (M > 0) out[2 * M] = sum(std::false_type());
        });
        for (int i = 0; i < 2 * n + 1; ++i) x[n * n + i] = out[i];
    });
}
constexpr double factorial(int n) {
    return n < 2 ? 1 : n * factorial(n - 1);
}

// Adds to `local` (order q = p + 1) what the sources in the lanes do: their multipoles over powers of their
// scales, the offset from each source to the target, and the scale of the target's expansion.
template <int p, class F, class V = hn::Vec<F>>
HWY_INLINE void convert(F f, V* multipole, V dx, V dy, V dz, V source_scale, V target_scale, V* local) {
    using T = hn::TFromD<F>;
    constexpr int q = p + 1;
    const V one = hn::Set(f, T(1)), zero = hn::Zero(f);
    const V rho2 = hn::MulAdd(dx, dx, hn::Mul(dy, dy)), r2 = hn::MulAdd(dz, dz, rho2);
    const V rho = hn::Sqrt(rho2), per_r = hn::Div(one, hn::Sqrt(r2));
    const auto on_axis = hn::Eq(rho2, zero);
    const V per_rho = hn::Div(one, hn::IfThenElse(on_axis, one, rho));
    const Turn<q, F> first(f, hn::IfThenElse(on_axis, one, hn::Mul(dy, per_rho)), hn::Mul(dx, per_rho));
    const Turn<q, F> second(f, hn::Mul(dz, per_r), hn::Neg(hn::Mul(rho, per_r)));
    // Turn the multipole, and scale it to the distance.
    turn_about_z<p, false>(f, multipole, first);
    swap_x_z<p, false>(f, multipole);
    turn_about_z<p, false>(f, multipole, second);
    swap_x_z<p, false>(f, multipole);
    const V of_source = hn::Mul(source_scale, per_r), of_target = hn::Mul(target_scale, per_r);
    V power = of_source;
    for (int n = 1; n <= p; ++n) {
        for (int i = n * n; i < (n + 1) * (n + 1); ++i) multipole[i] = hn::Mul(multipole[i], power);
        power = hn::Mul(power, of_source);
    }
    // Convert along the axis.
    V turned[packed_count(q)];
    power = per_r;
    unrolled<0, q>([&](auto k) HEDGEROW_UNROLLED {
        unrolled<0, k>([&](auto l) HEDGEROW_UNROLLED {
            constexpr int K = k, L = l;
            const auto sum = [&](auto is_real) HEDGEROW_UNROLLED {
                constexpr bool real = is_real;
                V all = zero;
                unrolled<L, p>([&](auto n) HEDGEROW_UNROLLED {
                    constexpr double c = ((K + L) % 2 == 0 ? 1 : -1) * factorial(n + K);
                    all = hn::MulAdd(hn::Set(f, T(c)), multipole[real ? re(n, L) : im(n, L)], all);
                });
                return hn::Mul(all, power);
            };
            turned[re(K, L)] = L > p ? zero : sum(std::true_type());
            if constexpr (L > 0) turned[im(K, L)] = L > p ? zero : sum(std::false_type());
        });
        power = hn::Mul(power, of_target);
    });
    // Turn the local expansion back.
    swap_x_z<q, true>(f, turned);
    turn_about_z<q, true>(f, turned, second);
    swap_x_z<q, true>(f, turned);
    turn_about_z<q, true>(f, turned, first);
    for (int i = 0; i < packed_count(q); ++i) local[i] = hn::Add(local[i], turned[i]);
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
