/// Places of a fluid in fixed point, in which differences are exact.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace hedgerow::detail {

/// Places along an axis in fixed point, modulo 2^32 units.
class FixedAxis {
public:
    FixedAxis() = default;
    /// Along an axis that repeats a unit is a 2^32-th of the period or of a part of it, so that the period is
    /// a multiple of 2^32 units.
    FixedAxis(double h, double period) : unit_(std::ldexp(h, -22)) {
        if (period > 0) unit_ = std::ldexp(period / std::ceil(period / std::ldexp(h, 10)), -32);
        per_unit_ = 1 / unit_;
    }
    double unit() const { return unit_; }
    /// Whether there is a number for a place.
    bool holds(double place) const { return std::abs(place * per_unit_) < most_units; }
    double farthest() const { return most_units * unit_; }
    std::uint32_t operator()(double place) const {
        // The last bits of the sum are those of the nearest integer.
        return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(place * per_unit_ + 0x1.8p52));
    }

private:
    static constexpr double most_units = 0x1p50;
    double unit_ = 1, per_unit_ = 1;
};

}  // namespace hedgerow::detail
