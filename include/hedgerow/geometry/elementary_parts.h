/// The arithmetic of which elementary functions are made: polynomials, exact sums, quotients of unevaluated
/// sums, and the exponents of numbers.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <hedgerow/geometry/rounding.h>

namespace hedgerow::detail {

/// c0 + c1·x + c2·x² and so on, by Horner's scheme.
template <class T, class... More>
constexpr T polynomial(T x, T c0, More... more) {
    if constexpr (sizeof...(More) == 0)
        return c0;
    else
        return product(polynomial(x, more...), x) + c0;
}

/// high + low == a + b exactly, short of overflow (Knuth).
template <class T>
constexpr TwoSum<T> two_sum(T a, T b) {
    const T sum = a + b, of_b = sum - a;
    return {sum, (a - (sum - of_b)) + (b - of_b)};
}

/// a / b for unevaluated sums, with a relative error of a few units of roundoff squared (Dekker 1971).
template <class T>
constexpr TwoSum<T> quotient(const TwoSum<T>& a, const TwoSum<T>& b) {
    const T q = a.high / b.high;
    const auto p = two_product(q, b.high);
    const T rest = ((a.high - p.high) - p.low) + (a.low - product(q, b.low));
    return {q, rest / b.high};
}

/// The integers as wide as T, and the layout of T.
template <class T>
struct FloatLayout;
template <>
struct FloatLayout<float> {
    using Bits = std::uint32_t;
    static constexpr int fraction_bits = 23, bias = 127;
};
template <>
struct FloatLayout<double> {
    using Bits = std::uint64_t;
    static constexpr int fraction_bits = 52, bias = 1023;
};

/// 2^k, for the k of normal numbers.
template <class T>
T power_of_two(int k) {
    using Layout = FloatLayout<T>;
    return std::bit_cast<T>(static_cast<typename Layout::Bits>(k + Layout::bias) << Layout::fraction_bits);
}

/// x·2^k with one rounding, for x near 1 and a k within twice the range of exponents. Two factors reach
/// subnormal and infinite results.
template <class T>
T times_power_of_two(T x, int k) {
    const int half = k >> 1;
    return x * power_of_two<T>(half) * power_of_two<T>(k - half);
}

/// A number as significand·2^exponent, with a significand from √½ to √2.
struct SplitNumber {
    double significand, exponent;
};
/// Splits a positive, finite number.
inline SplitNumber split_at_root_two(double x) {
    int exponent = 0;
    if (x < std::numeric_limits<double>::min()) x *= 0x1p54, exponent = -54;
    const auto bits = std::bit_cast<std::uint64_t>(x);
    exponent += static_cast<int>(bits >> 52) - 1023;
    double significand = std::bit_cast<double>((bits & 0x000FFFFFFFFFFFFFu) | 0x3FF0000000000000u);
    if (significand > 0x1.6a09e667f3bcdp+0) significand /= 2, ++exponent;
    return {significand, static_cast<double>(exponent)};
}

}  // namespace hedgerow::detail
