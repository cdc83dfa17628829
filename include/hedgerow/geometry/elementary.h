/// Elementary functions that give the same bits with every processor, compiler and C library. They use only
/// sums, products, quotients, square roots, `floor`, `fmod`, which IEEE 754 defines to the last bit, and
/// integers. Angles are in radians where nothing else is said. NaN in gives NaN out.
///
/// Each function reduces its argument, evaluates a polynomial and puts the parts together (Cody and Waite
/// 1980, Software Manual for the Elementary Functions; Muller 2016, Elementary Functions, 3rd ed.). The
/// polynomials are minimax fits by Remez's algorithm to the relative error of the function.
#pragma once

#include <cmath>
#include <limits>

#include <hedgerow/geometry/elementary_parts.h>
#include <hedgerow/geometry/elementary_single.h>
#include <hedgerow/geometry/rounding.h>

namespace hedgerow {

namespace detail {
/// An angle as n·π/2 + rest, with n modulo 4 and |rest| at most slightly above π/4.
struct Quadrant {
    int n;
    TwoSum<double> rest;
};

/// Reduces an angle by a π/2 of 152 bits in four parts (Cody and Waite). The first three have 33 bits, so
/// their products with n are exact. Above 2^20 the angle is first reduced by the double next to 2π, which
/// changes it by less than half a unit in its last place.
inline Quadrant quadrant(double x) {
    if (!(std::abs(x) <= 0x1p20)) x = std::fmod(x, 0x1.921fb54442d18p+2);
    if (x != x) return {0, {x, x}};
    const double n = std::floor(product(x, 0x1.45f306dc9c883p-1) + 0.5);
    const double first = x - product(n, 0x1.921fb54400000p+0);
    const auto second = two_sum(first, -product(n, 0x1.0b4611a600000p-34));
    const auto third = two_sum(second.high, -product(n, 0x1.3198a2e000000p-69));
    const double low = (second.low + third.low) - product(n, 0x1.b839a252049c1p-104);
    return {static_cast<int>(n) & 3, two_sum(third.high, low)};
}

/// The sine of an angle up to π/4, and its rounding error.
inline TwoSum<double> sine_near_zero(const TwoSum<double>& x) {
    const double z = product(x.high, x.high);
    const double p = polynomial(z, -0x1.5555555555548p-3, 0x1.111111110f730p-7, -0x1.a01a019be9215p-13,
                                0x1.71de35552b1d2p-19, -0x1.ae5e4b83ad06ep-26, 0x1.5d8b5580a63d1p-33);
    const double low = (x.low - product(x.low, z / 2)) + product(product(z, x.high), p);
    return two_sum(x.high, low);
}
/// The cosine of an angle up to π/4, and its rounding error.
inline TwoSum<double> cosine_near_zero(const TwoSum<double>& x) {
    const auto square = two_product(x.high, x.high);
    const double z = square.high;
    const double p = polynomial(z, 0x1.555555555554bp-5, -0x1.6c16c16c15015p-10, 0x1.a01a019c8f24fp-16,
                                -0x1.27e4f7f1907ebp-22, 0x1.1ee9dbcde55b2p-29, -0x1.8fa6839e2c87bp-37);
    const auto begin = two_sum(1.0, -z / 2);
    const double low = (begin.low - square.low / 2) + (product(product(z, z), p) - product(x.high, x.low));
    return two_sum(begin.high, low);
}

/// The natural logarithm of a number, with a relative error of 2^-61. Infinite for 0 and infinity, NaN for
/// negative numbers.
inline TwoSum<double> logarithm_in_two(double x) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (!(x > 0)) return {x == 0 ? -infinity : std::numeric_limits<double>::quiet_NaN(), 0};
    if (x == infinity) return {x, 0};
    const auto [m, k] = split_at_root_two(x);
    // log(m) = 2·artanh(s) with s = (m − 1)/(m + 1).
    const auto s = quotient<double>({m - 1, 0}, two_sum(m, 1.0));
    const auto square = two_product(s.high, s.high), cube = two_product(square.high, s.high);
    const double z = square.high;
    const double p =
        polynomial(z, 0x1.9999999999b33p-2, 0x1.249249245777ep-2, 0x1.c71c722deef13p-3, 0x1.745ce9b2ed70fp-3,
                   0x1.3b1ef50d9ac94p-3, 0x1.0f7f114ad3280p-3, 0x1.0e4abd05cf505p-3);
    // The term 2/3·s³ needs more digits than a double has.
    const double cube_low = cube.low + product(s.high, square.low) + product(3 * z, s.low);
    const auto third = two_product(cube.high, 0x1.5555555555555p-1);
    const double third_low =
        third.low + product(cube_low, 0x1.5555555555555p-1) + product(cube.high, 0x1.5555555555555p-55);
    const auto artanh = two_sum(2 * s.high, third.high);
    const double rest = artanh.low + (2 * s.low + (third_low + product(product(cube.high, z), p)));
    // The first part of log(2) has 42 bits, so that its product with k is exact.
    const auto sum = two_sum(product(k, 0x1.62e42fefa3800p-1), artanh.high);
    return two_sum(sum.high, sum.low + (rest + product(k, 0x1.ef35793c76730p-45)));
}

/// e to the power of high + low, where |low| is at most a unit in the last place of high.
inline double exponential_of_two(double high, double low) {
    if (high != high) return high;
    if (high > 710) return std::numeric_limits<double>::infinity();
    if (high < -746) return 0;
    const double k = std::floor(product(high, 0x1.71547652b82fep+0) + 0.5);
    const auto reduced = two_sum(high - product(k, 0x1.62e42fefa3800p-1), -product(k, 0x1.ef35793c76730p-45));
    const auto r = two_sum(reduced.high, reduced.low + low);
    const double p = polynomial(r.high, 0x1.0000000000000p-1, 0x1.555555555555dp-3, 0x1.555555555556cp-5,
                                0x1.111111110e56bp-7, 0x1.6c16c16c0ac3ap-10, 0x1.a01a01b5db320p-13,
                                0x1.a01a01e424194p-16, 0x1.71ddeb06957e8p-19, 0x1.27e458af72e46p-22,
                                0x1.af7389da98683p-26, 0x1.2034168467b8dp-29);
    const double rest = (r.low + product(r.low, r.high)) + product(product(r.high, r.high), p);
    return times_power_of_two(1 + (r.high + rest), static_cast<int>(k));
}

/// The arctangent of least / most, and its rounding error, for 0 <= least <= most, with most > 0 and finite.
inline TwoSum<double> arc_tangent_to_eighth_turn(double least, double most) {
    // The arctangents of 0/8 to 8/8, each with its rounding error.
    static constexpr TwoSum<double> at_eighths[9] = {{0, 0},
                                                     {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                                     {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                                     {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                                     {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                                     {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                                     {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                                     {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                                     {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};
    const double ratio = least / most;
    if (ratio < 0x1p-30) return {ratio, 0};
    const double scale = scale_to_one(most);
    least = product(least, scale), most = product(most, scale);
    // atan(q) = atan(c) + atan((q − c) / (1 + c·q)), where c is the multiple of 1/8 next to q.
    const double eighths = std::floor(product(ratio, 8.0) + 0.5), c = eighths / 8;
    const auto above = two_product(c, most), below = two_product(c, least);
    const auto numerator = two_sum(least, -above.high), denominator = two_sum(most, below.high);
    const auto t = quotient<double>({numerator.high, numerator.low - above.low},
                                    {denominator.high, denominator.low + below.low});
    const double z = product(t.high, t.high);
    const double p = polynomial(z, -0x1.5555555555555p-2, 0x1.9999999998fcbp-3, -0x1.249249219b1bfp-3,
                                0x1.c71c64e34f6bbp-4, -0x1.744f7dd7bbc5ep-4, 0x1.3484293fcd67bp-4);
    const TwoSum<double>& begin = at_eighths[static_cast<int>(eighths)];
    const auto sum = two_sum(begin.high, t.high);
    return two_sum(sum.high, sum.low + (begin.low + (t.low + product(product(t.high, z), p))));
}
}  // namespace detail

/// The sine, cosine and tangent of an angle in radians, within 1 unit in the last place up to 2^20. The
/// argument of a larger angle is rounded, by less than half a unit in its last place. NaN for an infinite
/// angle.
inline double sine(double x) {
    if (std::abs(x) < 0x1p-27) return x;
    const auto [n, rest] = detail::quadrant(x);
    const auto s = (n & 1) != 0 ? detail::cosine_near_zero(rest) : detail::sine_near_zero(rest);
    return (n & 2) != 0 ? -s.high : s.high;
}
inline double cosine(double x) {
    const auto [n, rest] = detail::quadrant(x);
    const auto c = (n & 1) != 0 ? detail::sine_near_zero(rest) : detail::cosine_near_zero(rest);
    return ((n + 1) & 2) != 0 ? -c.high : c.high;
}
inline double tangent(double x) {
    if (std::abs(x) < 0x1p-27) return x;
    const auto [n, rest] = detail::quadrant(x);
    const auto s = detail::sine_near_zero(rest), c = detail::cosine_near_zero(rest);
    const auto t = (n & 1) != 0 ? detail::quotient(c, s) : detail::quotient(s, c);
    const double magnitude = t.high + t.low;
    return (n & 1) != 0 ? -magnitude : magnitude;
}

/// e to the power x, within 1 unit in the last place; infinity above 709.8, 0 below −745.2.
inline double exponential(double x) {
    return detail::exponential_of_two(x, 0);
}

/// The natural logarithm, within 1 unit in the last place. −infinity for 0, NaN for a negative number.
inline double logarithm(double x) {
    return detail::logarithm_in_two(x).high;
}

/// A base of 0 or more to the power of an exponent, within 2 units in the last place, and within 1 unit for
/// exponents up to 10. Limits are those of the C library; NaN for a negative base, unless the exponent is 0.
inline double power(double base, double exponent) {
    if (exponent == 0 || base == 1) return 1;
    const auto log = detail::logarithm_in_two(base);
    const double estimate = product(exponent, log.high);
    if (!(std::abs(estimate) < 800)) return detail::exponential_of_two(estimate, 0);
    const auto x = two_product(exponent, log.high);
    return detail::exponential_of_two(x.high, x.low + product(exponent, log.low));
}

/// The angle of the point (x, y), from −π to π, within 1 unit in the last place. Signed zeros and infinities
/// are treated as the C library treats them: the angle of (0, 0) is 0.
inline double arc_tangent(double y, double x) {
    if (x != x || y != y) return x + y;
    const double up = std::abs(y), along = std::abs(x);
    double least = up < along ? up : along, most = up < along ? along : up;
    if (most == 0 || least == std::numeric_limits<double>::infinity()) {
        least = least == 0 ? 0 : 1, most = 1;
    } else if (most == std::numeric_limits<double>::infinity()) {
        least = 0, most = 1;
    }
    auto angle = detail::arc_tangent_to_eighth_turn(least, most);
    const auto subtract_from = [&](double high, double low) {
        const auto difference = detail::two_sum(high, -angle.high);
        angle = {difference.high, difference.low + (low - angle.low)};
    };
    if (up > along) subtract_from(0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54);
    if (std::signbit(x)) subtract_from(0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53);
    return std::copysign(angle.high + angle.low, y);
}

/// The angle from 0 to π that has this cosine, within 2 units in the last place. The cosine is clamped to
/// −1..1.
inline double arc_cosine(double x) {
    if (x != x) return x;
    x = x < -1 ? -1 : x > 1 ? 1 : x;
    return arc_tangent(std::sqrt(product(1 - x, 1 + x)), x);
}

}  // namespace hedgerow
