/// The six operators of the fast multipole method (Greengard and Rokhlin 1987), for the potential Σ q/r in
/// space.
///
/// A *multipole* expansion M about a center z tells of charges near z what they do far away; a *local*
/// expansion L tells what far charges do near z. With R and S of harmonics.h, sums over all degrees and −n ≤
/// m ≤ n:
///
///     M(n, m) = Σ q · R(n, m)(x − z)                    L(k, l): potential(x) = Σ conj R(k, l)(x − z) · L(k,
///     l)
///
/// in the conventions of Dehnen (A fast multipole method for stellar dynamics, 2014). The plain forms here
/// cost O(p⁴); they are the reference of the kernels.
#pragma once

#include <cmath>

#include <hedgerow/nbody/harmonics.h>
#include <hedgerow/nbody/potential.h>

namespace hedgerow {

/// Particle to multipole: adds a charge at `offset` from the center.
template <std::floating_point T, int p>
void p2m(T charge, const Vec<T, 3>& offset, Harmonics<T, p>& multipole) {
    for_each_regular<p>(offset, [&](int n, int m, Complex<T> x) {
        multipole.re[multipole.at(n, m)] += charge * x.re;
        multipole.im[multipole.at(n, m)] += charge * x.im;
    });
}

/// Multipole to multipole: adds that of a part, whose center is at `offset` from this one's. Exact.
template <std::floating_point T, int p>
void m2m(const Harmonics<T, p>& part, const Vec<T, 3>& offset, Harmonics<T, p>& whole) {
    const auto shift = regular_harmonics<p>(offset);
    for (int n = 0; n <= p; ++n)
        for (int m = 0; m <= n; ++m) {
            Complex<T> sum{T(0), T(0)};
            for (int k = 0; k <= n; ++k)
                for (int l = std::max(-k, m - (n - k)); l <= std::min(k, m + (n - k)); ++l)
                    sum = sum + harmonic(part, k, l) * harmonic(shift, n - k, m - l);
            whole.re[whole.at(n, m)] += sum.re, whole.im[whole.at(n, m)] += sum.im;
        }
}

/// Multipole to local: adds what charges with a multipole expansion of order p do around a center that is at
/// `offset` from theirs, to order q. All terms n ≤ p, k ≤ q are summed. With q = p + 1 two cells that act on
/// each other keep their momentum: the gradients of both come from the same products of multipoles.
template <std::floating_point T, int p, int q>
void m2l(const Harmonics<T, p>& multipole, const Vec<T, 3>& offset, Harmonics<T, q>& local) {
    const auto s = singular_harmonics<p + q>(offset);
    for (int k = 0; k <= q; ++k)
        for (int l = 0; l <= k; ++l) {
            Complex<T> sum{T(0), T(0)};
            for (int n = 0; n <= p; ++n)
                for (int m = -n; m <= n; ++m)
                    sum = sum + conj(harmonic(multipole, n, m)) * harmonic(s, n + k, m + l);
            const T sign = k % 2 == 0 ? T(1) : T(-1);
            local.re[local.at(k, l)] += sign * sum.re, local.im[local.at(k, l)] += sign * sum.im;
        }
}

/// Local to local: adds that of the whole to that of a part, whose center is at `offset` from the whole's.
/// Exact.
template <std::floating_point T, int q>
void l2l(const Harmonics<T, q>& whole, const Vec<T, 3>& offset, Harmonics<T, q>& part) {
    const auto shift = regular_harmonics<q>(offset);
    for (int n = 0; n <= q; ++n)
        for (int m = 0; m <= n; ++m) {
            Complex<T> sum{T(0), T(0)};
            for (int k = n; k <= q; ++k)
                for (int l = m - (k - n); l <= m + (k - n); ++l)
                    sum = sum + conj(harmonic(shift, k - n, l - m)) * harmonic(whole, k, l);
            part.re[part.at(n, m)] += sum.re, part.im[part.at(n, m)] += sum.im;
        }
}

/// Local to particle: the potential and its gradient at `offset` from the center. Derivatives of R are
/// harmonics of the degree below: ∂R(n, m)/∂z = R(n−1, m), (∂/∂x − i∂/∂y) R(n, m) = R(n−1, m−1), and (∂/∂x +
/// i∂/∂y) R(n, m) = −R(n−1, m+1).
template <std::floating_point T, int q>
PotentialAt<T> l2p(const Harmonics<T, q>& local, const Vec<T, 3>& offset) {
    PotentialAt<T> at;
    // The terms of m and −m are conjugates. The gradient's harmonic of (n, m) gathers the local ones of n
    // + 1.
    for_each_regular<q>(offset, [&](int n, int m, Complex<T> x) {
        const T twice = m == 0 ? T(1) : T(2);
        const auto share = [&](Complex<T> l) { return twice * (conj(x) * l).re; };
        at.potential += share(harmonic(local, n, m));
        if (n == q) return;
        const Complex<T> up = harmonic(local, n + 1, m + 1), down = harmonic(local, n + 1, m - 1);
        // Re conj(x)·(up − down)/2 is ∂x's share, and of ∂y it is Re conj(x)·(up + down)·i/2 with the sign
        // below.
        at.gradient[0] += share(T(0.5) * (up - down));
        at.gradient[1] += share(T(0.5) * Complex<T>{up.im + down.im, -(up.re + down.re)});
        at.gradient[2] += share(harmonic(local, n + 1, m));
    });
    return at;
}

/// Multipole to particle: the potential and its gradient at `offset` from the center.
template <std::floating_point T, int p>
PotentialAt<T> m2p(const Harmonics<T, p>& multipole, const Vec<T, 3>& offset) {
    Harmonics<T, 1> local;
    m2l(multipole, offset, local);
    return l2p(local, Vec<T, 3>());
}

/// Particle to particle: what a charge does at `offset` from it. Nothing at its own place.
template <std::floating_point T>
PotentialAt<T> p2p(T charge, const Vec<T, 3>& offset) {
    const T d2 = length2(offset);
    if (!(d2 > 0)) return {};
    const T potential = charge / std::sqrt(d2);
    return {potential, offset * (-potential / d2)};
}

}  // namespace hedgerow
