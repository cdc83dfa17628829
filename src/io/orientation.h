/// On which side of a line a point lies, exactly.
#pragma once

#include <array>
#include <cmath>

#include <hedgerow/geometry/rounding.h>
#include <hedgerow/geometry/vec.h>

namespace hedgerow::detail {

/// The sign of a sum of numbers, without rounding: an expansion whose components do not overlap grows by one
/// number at a time (Shewchuk 1997, GROW-EXPANSION). O(N²).
template <std::size_t N>
int sign_of_sum(const std::array<double, N>& numbers) {
    std::array<double, N> expansion{};
    std::size_t size = 0;
    for (double q : numbers) {
        for (std::size_t i = 0; i < size; ++i) {  // two_sum (Knuth): q + expansion[i] == sum + error
            const double sum = q + expansion[i], shared = sum - q;
            expansion[i] = (q - (sum - shared)) + (expansion[i] - shared);
            q = sum;
        }
        expansion[size++] = q;
    }
    for (std::size_t i = N; i-- > 0;)
        if (expansion[i] != 0) return expansion[i] > 0 ? 1 : -1;
    return 0;
}

/// 1 if a, b, c turn to the left, −1 to the right, 0 on one line: exact, short of underflow, for coordinates
/// of at most 2^480. A filter answers first (Shewchuk 1997, ORIENT2D's error bound A).
inline int turn(const Vec<double, 2>& a, const Vec<double, 2>& b, const Vec<double, 2>& c) {
    constexpr double u = unit_roundoff<double>;
    const double left = product(a[0] - c[0], b[1] - c[1]), right = product(a[1] - c[1], b[0] - c[0]);
    const double determinant = left - right;
    const double bound = (3 + 16 * u) * u * (std::abs(left) + std::abs(right));
    if (determinant > bound || -determinant > bound) return determinant > 0 ? 1 : -1;
    const auto p = two_product(a[0], b[1]), q = two_product(-a[1], b[0]), r = two_product(b[0], c[1]),
               s = two_product(-b[1], c[0]), t = two_product(c[0], a[1]), v = two_product(-c[1], a[0]);
    return sign_of_sum(std::array{p.low, q.low, r.low, s.low, t.low, v.low,  //
                                  p.high, q.high, r.high, s.high, t.high, v.high});
}

}  // namespace hedgerow::detail
