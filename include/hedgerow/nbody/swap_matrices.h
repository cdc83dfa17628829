/// How solid harmonics change when the axes x and z are swapped.
#pragma once

#include <hedgerow/geometry/rounding.h>

namespace hedgerow {

/// Matrices B of each degree n ≤ order with R(n, m)(z, y, x) = Σ B(n, m, l) · R(n, l)(x, y, z), −n ≤ l ≤ n.
/// They are real. Turns about any axis are made of two swaps and turns about z, which only multiply (Dehnen
/// 2014, section 3.1).
///
/// By derivatives: ∂/∂z of both sides gives B(n, m, l) = (B(n−1, m−1, l) − B(n−1, m+1, l))/2 for |l| < n, and
/// ∂/∂x then the two others.
template <int order>
class SwapMatrices {
public:
    constexpr SwapMatrices() {
        set(0, 0, 0, 1);
        if constexpr (order > 0) {
            // R(1, 0) = z, R(1, ±1) = (±x + iy)/2.
            set(1, 0, 1, 1), set(1, 0, -1, -1);
            for (int m = -1; m <= 1; m += 2) set(1, m, 0, 0.5 * m), set(1, m, 1, 0.5), set(1, m, -1, 0.5);
        }
        for (int n = 2; n <= order; ++n)
            for (int m = -n; m <= n; ++m) {
                for (int l = 1 - n; l < n; ++l)
                    set(n, m, l, 0.5 * ((*this)(n - 1, m - 1, l) - (*this)(n - 1, m + 1, l)));
                set(n, m, n, (*this)(n, m, n - 2) + 2 * (*this)(n - 1, m, n - 1));
                set(n, m, -n, (*this)(n, m, 2 - n) - 2 * (*this)(n - 1, m, 1 - n));
            }
    }
    /// 0 where |m| or |l| is above n.
    constexpr double operator()(int n, int m, int l) const {
        return m < -n || m > n || l < -n || l > n ? 0 : numbers_[n][m + order][l + order];
    }

    /// What the real and the imaginary parts of X(n, l), l ≥ 0, add to those of the swapped X(n, m), m ≥ 0:
    /// both signs of l in one, for multipoles (whose X changes as R does) and for local expansions (by the
    /// transposed matrix, since Σ conj R · L stays).
    constexpr double multipole(int n, int m, int l, bool real) const {
        if (l == 0) return real ? (*this)(n, m, 0) : 0;
        const double other = sign(l) * (*this)(n, m, -l);
        return (*this)(n, m, l) + (real ? other : -other);
    }
    constexpr double local(int n, int m, int l, bool real) const {
        if (l == 0) return real ? (*this)(n, 0, m) : 0;
        const double other = sign(l) * (*this)(n, -l, m);
        return (*this)(n, l, m) + (real ? other : -other);
    }

private:
    static constexpr double sign(int l) { return l % 2 == 0 ? 1 : -1; }
    constexpr void set(int n, int m, int l, double x) { numbers_[n][m + order][l + order] = x; }

    double numbers_[order + 1][2 * order + 1][2 * order + 1] = {};
};

}  // namespace hedgerow
