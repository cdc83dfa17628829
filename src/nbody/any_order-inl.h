/// Expansions of an order that is known at run time, in lanes: for what is done once a charge.
#if defined(HEDGEROW_NBODY_ANY_ORDER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_NBODY_ANY_ORDER_INL_H
#undef HEDGEROW_NBODY_ANY_ORDER_INL_H
#else
#define HEDGEROW_NBODY_ANY_ORDER_INL_H
#endif

#include <hedgerow/nbody/kernels.h>

#include "shifts-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Calls f(n, m, R(n, m)) with the regular harmonics of the places in the lanes (harmonics.h).
template <class F, class V, class G>
HWY_INLINE void for_each_regular_up_to(F f, int order, V x, V y, V z, G g) {
    using T = hn::TFromD<F>;
    const V r2 = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
    ComplexLanes<V> diagonal{hn::Set(f, T(1)), hn::Zero(f)};
    for (int m = 0; m <= order; ++m) {
        if (m > 0) diagonal = next_on_diagonal(f, m, diagonal, x, y);
        ComplexLanes<V> before{hn::Zero(f), hn::Zero(f)}, now = diagonal;
        g(m, m, now);
        for (int n = m + 1; n <= order; ++n) {
            const ComplexLanes<V> next = next_degree(f, n, m, now, before, z, r2);
            before = now, now = next;
            g(n, m, now);
        }
    }
}

// Adds the multipole of charges, in double.
inline void add_multipole(const ChargeRows<double>& charges, int order, double* multipole) {
    const hn::ScalableTag<double> f;
    using V = hn::Vec<decltype(f)>;
    constexpr int most = packed_count(most_order_at_run_time);
    V sums[most];
    for (int k = 0; k < packed_count(order); ++k) sums[k] = hn::Zero(f);
    for (std::size_t i = 0; i < charges.count; i += hn::Lanes(f)) {
        const V charge = hn::LoadU(f, charges.charge + i);
        for_each_regular_up_to(f, order, hn::LoadU(f, charges.x + i), hn::LoadU(f, charges.y + i),
                               hn::LoadU(f, charges.z + i), [&](int n, int m, ComplexLanes<V> r) HWY_ATTR {
                                   V* const sum = sums + re(n, m);
                                   sum[0] = hn::MulAdd(charge, r.re, sum[0]);
                                   if (m > 0) sum[1] = hn::MulAdd(charge, r.im, sum[1]);
                               });
    }
    for (int k = 0; k < packed_count(order); ++k) multipole[k] += hn::GetLane(hn::SumOfLanes(f, sums[k]));
}

// Adds the potentials and gradients of a local expansion, in double.
inline void add_local(const double* local, int order, const TargetRows<double>& targets) {
    const hn::ScalableTag<double> f;
    using V = hn::Vec<decltype(f)>;
    const auto number = [&](double x) HWY_ATTR { return hn::Set(f, x); };
    for (std::size_t i = 0; i < targets.count; i += hn::Lanes(f)) {
        V potential = hn::Zero(f), gx = hn::Zero(f), gy = hn::Zero(f), gz = hn::Zero(f);
        // As in l2p of operators.h: terms of m and −m are conjugates, and the gradient's share of R(n, m)
        // gathers local numbers of the degree above.
        for_each_regular_up_to(f, order, hn::LoadU(f, targets.x + i), hn::LoadU(f, targets.y + i),
                               hn::LoadU(f, targets.z + i), [&](int n, int m, ComplexLanes<V> r) HWY_ATTR {
                                   const double twice = m == 0 ? 1 : 2;
                                   // Adds twice · Re(conj(R) · (a + ib)).
                                   const auto add = [&](V& sum, double a, double b) HWY_ATTR {
                                       sum = hn::MulAdd(number(twice * a), r.re, sum);
                                       sum = hn::MulAdd(number(twice * b), r.im, sum);
                                   };
                                   const auto real = [&](int k, int l) { return local[re(k, l)]; };
                                   const auto imaginary = [&](int k, int l) {
                                       return l > 0 ? local[im(k, l)] : 0;
                                   };
                                   add(potential, real(n, m), imaginary(n, m));
                                   if (n == order) return;
                                   const double ur = real(n + 1, m + 1), ui = imaginary(n + 1, m + 1);
                                   const double dr = m == 0 ? -real(n + 1, 1) : real(n + 1, m - 1);
                                   const double di = m == 0 ? imaginary(n + 1, 1) : imaginary(n + 1, m - 1);
                                   add(gx, 0.5 * (ur - dr), 0.5 * (ui - di));
                                   add(gy, 0.5 * (ui + di), -0.5 * (ur + dr));
                                   add(gz, real(n + 1, m), imaginary(n + 1, m));
                               });
        const auto add = [&](V sum, double* row)
                             HWY_ATTR { hn::StoreU(hn::Add(sum, hn::LoadU(f, row + i)), f, row + i); };
        add(potential, targets.potential), add(gx, targets.gx), add(gy, targets.gy), add(gz, targets.gz);
    }
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
