/// Expansions of points and shifts of expansions, in lanes: points of a leaf, or the children of a cell, side
/// by side.
#if defined(HEDGEROW_NBODY_SHIFTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_NBODY_SHIFTS_INL_H
#undef HEDGEROW_NBODY_SHIFTS_INL_H
#else
#define HEDGEROW_NBODY_SHIFTS_INL_H
#endif

#include "conversions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A complex number in each lane.
template <class V>
struct ComplexLanes {
    V re, im;
};

// The recurrences of regular harmonics (harmonics.h): R(m, m) from R(m − 1, m − 1), and R(n, m) from the two
// of the degrees below.
template <class F, class V>
HWY_INLINE ComplexLanes<V> next_on_diagonal(F f, int m, ComplexLanes<V> r, V x, V y) {
    using T = hn::TFromD<F>;
    const V half = hn::Set(f, T(0.5) / T(m));
    const V a = hn::Mul(half, r.re), b = hn::Mul(half, r.im);
    return {hn::NegMulAdd(b, y, hn::Mul(a, x)), hn::MulAdd(b, x, hn::Mul(a, y))};
}
template <class F, class V>
HWY_INLINE ComplexLanes<V> next_degree(F f, int n, int m, ComplexLanes<V> now, ComplexLanes<V> before, V z,
                                       V r2) {
    using T = hn::TFromD<F>;
    const T per = T(1) / T((n + m) * (n - m));
    const V of_now = hn::Mul(hn::Set(f, T(2 * n - 1) * per), z), of_before = hn::Mul(hn::Set(f, per), r2);
    return {hn::NegMulAdd(of_before, before.re, hn::Mul(of_now, now.re)),
            hn::NegMulAdd(of_before, before.im, hn::Mul(of_now, now.im))};
}

// Calls f(n, m, R(n, m)) with the regular harmonics of the places in the lanes (harmonics.h).
template <int order, class F, class V, class G>
HWY_INLINE void for_each_regular_in_lanes(F f, V x, V y, V z, G g) {
    using T = hn::TFromD<F>;
    const V r2 = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
    ComplexLanes<V> diagonal{hn::Set(f, T(1)), hn::Zero(f)};
    unrolled<0, order>([&](auto m) HEDGEROW_UNROLLED {
        constexpr int M = m;
        if constexpr (M > 0) diagonal = next_on_diagonal(f, M, diagonal, x, y);
        ComplexLanes<V> before{hn::Zero(f), hn::Zero(f)}, now = diagonal;
        g(m, m, now);
        unrolled<M + 1, order>([&](auto n) HEDGEROW_UNROLLED {
            const ComplexLanes<V> next = next_degree(f, n, m, now, before, z, r2);
            before = now, now = next;
            g(n, m, now);
        });
    });
}

// Adds the charges in the lanes to sums of multipoles in lanes.
template <int p, class F, class V>
HWY_INLINE void expand_points(F f, V charge, V x, V y, V z, V* sums) {
    for_each_regular_in_lanes<p>(f, x, y, z, [&](auto n, auto m, ComplexLanes<V> r) HEDGEROW_UNROLLED {
        sums[re(n, m)] = hn::MulAdd(charge, r.re, sums[re(n, m)]);
        if constexpr (m > 0) sums[im(n, m)] = hn::MulAdd(charge, r.im, sums[im(n, m)]);
    });
}

// The numbers of all −n ≤ m ≤ n, from packed ones.
constexpr int full(int n, int m) {
    return n * n + n + m;
}
template <int order, class V>
struct Unpacked {
    V re[packed_count(order)], im[packed_count(order)];

    template <class F>
    HWY_INLINE Unpacked(F f, const V* packed) {
        for (int n = 0; n <= order; ++n) {
            re[full(n, 0)] = packed[hedgerow::re(n, 0)], im[full(n, 0)] = hn::Zero(f);
            for (int m = 1; m <= n; ++m) {
                const V a = packed[hedgerow::re(n, m)], b = packed[hedgerow::im(n, m)];
                re[full(n, m)] = a, im[full(n, m)] = b;
                re[full(n, -m)] = m % 2 == 0 ? a : hn::Neg(a);
                im[full(n, -m)] = m % 2 == 0 ? hn::Neg(b) : b;
            }
        }
    }
};
template <int order, class F, class V>
HWY_INLINE void regular_in_lanes(F f, V x, V y, V z, V* packed) {
    for_each_regular_in_lanes<order>(f, x, y, z, [&](auto n, auto m, ComplexLanes<V> r) HEDGEROW_UNROLLED {
        packed[re(n, m)] = r.re;
        if constexpr (m > 0) packed[im(n, m)] = r.im;
    });
}

// Shifts multipoles, whose centers are at the offsets: whole(n, m) = Σ part(k, l) · R(n − k, m − l).
template <int p, class F, class V>
HWY_NOINLINE void shift_multipoles(F f, const V* part, V x, V y, V z, V* whole) {
    V shift[packed_count(p)];
    regular_in_lanes<p>(f, x, y, z, shift);
    const Unpacked<p, V> a(f, part), b(f, shift);
    for (int n = 0; n <= p; ++n)
        for (int m = 0; m <= n; ++m) {
            V sr = hn::Zero(f), si = hn::Zero(f);
            for (int k = 0; k <= n; ++k) {
                const int first = HWY_MAX(-k, m - (n - k)), last = HWY_MIN(k, m + (n - k));
                for (int l = first; l <= last; ++l) {
                    const int i = full(k, l), j = full(n - k, m - l);
                    sr = hn::NegMulAdd(a.im[i], b.im[j], hn::MulAdd(a.re[i], b.re[j], sr));
                    si = hn::MulAdd(a.im[i], b.re[j], hn::MulAdd(a.re[i], b.im[j], si));
                }
            }
            whole[re(n, m)] = sr;
            if (m > 0) whole[im(n, m)] = si;
        }
}
// Shifts a local expansion to centers at the offsets: part(n, m) = Σ conj R(k − n, l − m) · whole(k, l).
template <int q, class F, class V>
HWY_NOINLINE void shift_locals(F f, const V* whole, V x, V y, V z, V* part) {
    V shift[packed_count(q)];
    regular_in_lanes<q>(f, x, y, z, shift);
    const Unpacked<q, V> a(f, whole), b(f, shift);
    for (int n = 0; n <= q; ++n)
        for (int m = 0; m <= n; ++m) {
            V sr = hn::Zero(f), si = hn::Zero(f);
            for (int k = n; k <= q; ++k)
                for (int l = m - (k - n); l <= m + (k - n); ++l) {
                    const int i = full(k, l), j = full(k - n, l - m);
                    sr = hn::MulAdd(a.im[i], b.im[j], hn::MulAdd(a.re[i], b.re[j], sr));
                    si = hn::NegMulAdd(a.re[i], b.im[j], hn::MulAdd(a.im[i], b.re[j], si));
                }
            part[re(n, m)] = sr;
            if (m > 0) part[im(n, m)] = si;
        }
}

// The potential and its gradient at the places in the lanes, of one local expansion.
template <int q, class F, class V, class T>
HWY_INLINE void evaluate_local(F f, const T* local, V x, V y, V z, V& potential, V& gx, V& gy, V& gz) {
    potential = gx = gy = gz = hn::Zero(f);
    for_each_regular_in_lanes<q>(f, x, y, z, [&](auto n, auto m, ComplexLanes<V> r) HEDGEROW_UNROLLED {
        constexpr int N = n, M = m;
        constexpr T twice = M == 0 ? T(1) : T(2);
        // Adds twice · Re(conj(R) · (a + ib)).
        const auto add = [&](V& sum, T a, T b) HEDGEROW_UNROLLED {
            sum = hn::MulAdd(hn::Set(f, twice * a), r.re, sum);
            if constexpr (M > 0) sum = hn::MulAdd(hn::Set(f, twice * b), r.im, sum);
        };
        add(potential, local[re(N, M)], M > 0 ? local[im(N, M)] : T(0));
        if constexpr (N < q) {
            // L(n + 1, m ± 1), by symmetry where m is 0.
            const T ur = local[re(N + 1, M + 1)], ui = local[im(N + 1, M + 1)];
            const T dr = M == 0 ? -local[re(N + 1, 1)] : local[re(N + 1, M - 1 > 0 ? M - 1 : 0)];
            const T di = M == 0 ? local[im(N + 1, 1)] : M == 1 ? T(0) : local[im(N + 1, M - 1)];
            add(gx, T(0.5) * (ur - dr), T(0.5) * (ui - di));
            add(gy, T(0.5) * (ui + di), T(-0.5) * (ur + dr));
            add(gz, local[re(N + 1, M)], M > 0 ? local[im(N + 1, M)] : T(0));
        }
    });
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
