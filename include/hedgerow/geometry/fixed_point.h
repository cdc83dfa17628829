/// Sums with the same bits in whatever order their terms are added.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <hedgerow/geometry/rounding.h>

namespace hedgerow {

/// Terms as integers, multiples of a unit that follows from the largest of them. Integers are added without
/// rounding, so threads, machines and pieces of work may sum their shares and join them in any order:
///
///     double largest = 0;
///     for (double x : terms) largest = FixedPoint::larger(largest, x);
///     const FixedPoint point(largest);
///     FixedPoint::Sum sum;
///     for (double x : terms) sum += point.integer(x);
///     return point.value(sum);
///
/// The unit is at most 2⁻⁶⁸ of the largest term (or 2⁻¹⁰²²). A term is rounded to a multiple of it, so a sum
/// of n terms errs by n/2 units, and is then rounded once. There is room for 2³⁹ terms.
class FixedPoint {
    static constexpr std::size_t parts = 3;
    static constexpr int bits = 23;  // of a part

public:
    /// An integer in parts, the highest first, each with room for many terms.
    struct Sum {
        std::array<std::int64_t, parts> part{};
        Sum& operator+=(const Sum& more) {
            for (std::size_t k = 0; k < parts; ++k) part[k] += more.part[k];
            return *this;
        }
    };

    /// The larger of a size so far and that of a term; not finite if one of them is not.
    static double larger(double size, double term) {
        return std::max(size, std::abs(term)) +
               0 * term;  // which is not a number where the term is not finite
    }
    /// For terms whose absolute values are at most `largest`. Where that is not finite, the value of every
    /// sum is not a number.
    explicit FixedPoint(double largest) : finite_(std::isfinite(largest)) {
        constexpr int least_exponent = -1022 + static_cast<int>(parts) * bits,
                      most_exponent = 1023 - 52 + bits;
        const int exponent = finite_ && largest > 0 ? std::ilogb(largest) + 1 : 0;
        // The sum of a number and 1.5·2^(52 + e) is rounded to a multiple of 2^e, and that multiple is in its
        // bits.
        scale_ = std::max(0, exponent - most_exponent);
        unit_ = std::max(exponent - scale_, least_exponent) - static_cast<int>(parts) * bits;
        for (std::size_t k = 0; k < parts; ++k)
            rounder_[k] = std::ldexp(1.5, 52 + unit_ + bits * static_cast<int>(parts - 1 - k));
    }

    Sum integer(double term) const {
        Sum sum;
        if (!finite_) return sum;
        double rest = scale_ == 0 ? term : std::ldexp(term, -scale_);
        for (std::size_t k = 0; k < parts; ++k) {
            const double rounded = rest + rounder_[k];
            sum.part[k] = std::bit_cast<std::int64_t>(rounded) - std::bit_cast<std::int64_t>(rounder_[k]);
            rest -= rounded - rounder_[k];
        }
        return sum;
    }
    double value(const Sum& sum) const {
        if (!finite_) return std::numeric_limits<double>::quiet_NaN();
        __extension__ __int128 whole = 0;
        for (const std::int64_t part : sum.part) whole = whole * (1 << bits) + part;
        return std::ldexp(static_cast<double>(whole), unit_ + scale_);
    }

private:
    bool finite_;
    int scale_, unit_;  // binary exponents: what terms are divided by, and the unit of what is left
    std::array<double, parts> rounder_;
};

}  // namespace hedgerow
