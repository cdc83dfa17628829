/// Solid harmonics, of which the potentials of far masses are expanded.
#pragma once

#include <array>
#include <cstddef>

#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// Numbers X(n, m) for the degrees n = 0 to `order` and m = 0 to n, complex. Those of negative m follow:
/// X(n, −m) = (−1)^m · conj X(n, m).
template <std::floating_point T, int order>
struct Harmonics {
    static constexpr std::size_t count = std::size_t(order + 1) * (order + 2) / 2;
    static constexpr std::size_t at(int n, int m) {
        const int place = n * (n + 1) / 2 + m;
        return static_cast<std::size_t>(place);
    }

    std::array<T, count> re{}, im{};

    friend bool operator==(const Harmonics&, const Harmonics&) = default;
};

/// A complex number, bare: std::complex multiplies with checks for NaN.
template <std::floating_point T>
struct Complex {
    T re, im;
    friend constexpr Complex operator+(Complex a, Complex b) { return {a.re + b.re, a.im + b.im}; }
    friend constexpr Complex operator-(Complex a, Complex b) { return {a.re - b.re, a.im - b.im}; }
    friend constexpr Complex operator*(T s, Complex a) { return {s * a.re, s * a.im}; }
    friend constexpr Complex operator*(Complex a, Complex b) {
        return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
    }
    friend constexpr Complex conj(Complex a) { return {a.re, -a.im}; }
};

/// X(n, m) for any −n ≤ m ≤ n.
template <std::floating_point T, int order>
Complex<T> harmonic(const Harmonics<T, order>& x, int n, int m) {
    if (m >= 0) return {x.re[x.at(n, m)], x.im[x.at(n, m)]};
    const T sign = m % 2 == 0 ? T(1) : T(-1);
    return {sign * x.re[x.at(n, -m)], -sign * x.im[x.at(n, -m)]};
}

/// Calls f(n, m, R(n, m)) with the regular harmonics of a place v,
///
///     R(n, m) = rⁿ · P(n, m)(cos θ) · e^(imφ) / (n + m)!,
///
/// by recurrence: R(m, m) from R(m − 1, m − 1), then upward in n (Dehnen 2014, appendix A).
template <int order, std::floating_point T, class F>
void for_each_regular(const Vec<T, 3>& v, F f) {
    const T r2 = length2(v);
    Complex<T> diagonal{T(1), T(0)};
    for (int m = 0; m <= order; ++m) {
        if (m > 0) diagonal = T(0.5) / T(m) * (Complex<T>{v[0], v[1]} * diagonal);
        Complex<T> before{T(0), T(0)}, now = diagonal;
        f(m, m, now);
        for (int n = m + 1; n <= order; ++n) {
            const T scale = T(1) / T((n + m) * (n - m));
            const Complex<T> next = scale * (T(2 * n - 1) * v[2] * now - r2 * before);
            before = now, now = next;
            f(n, m, now);
        }
    }
}
template <int order, std::floating_point T>
Harmonics<T, order> regular_harmonics(const Vec<T, 3>& v) {
    Harmonics<T, order> all;
    for_each_regular<order>(
        v, [&](int n, int m, Complex<T> x) { all.re[all.at(n, m)] = x.re, all.im[all.at(n, m)] = x.im; });
    return all;
}

/// The singular harmonics of a place v other than 0,
///
///     S(n, m) = (n − m)! · r^(−n−1) · P(n, m)(cos θ) · e^(imφ),
///
/// for which 1/|x − y| = Σ conj R(n, m)(y) · S(n, m)(x) over all n and −n ≤ m ≤ n, where |y| < |x|.
template <int order, std::floating_point T>
Harmonics<T, order> singular_harmonics(const Vec<T, 3>& v) {
    Harmonics<T, order> all;
    const T per_r2 = T(1) / length2(v);
    Complex<T> diagonal{std::sqrt(per_r2), T(0)};
    for (int m = 0; m <= order; ++m) {
        if (m > 0) diagonal = T(2 * m - 1) * per_r2 * (Complex<T>{v[0], v[1]} * diagonal);
        Complex<T> before{T(0), T(0)}, now = diagonal;
        for (int n = m;; ++n) {
            all.re[all.at(n, m)] = now.re, all.im[all.at(n, m)] = now.im;
            if (n == order) break;
            const Complex<T> next = per_r2 * (T(2 * n + 1) * v[2] * now - T(n * n - m * m) * before);
            before = now, now = next;
        }
    }
    return all;
}

}  // namespace hedgerow
