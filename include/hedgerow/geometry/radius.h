/// The rule by which radii bound distances: a distance is within a radius if it is at most the radius once it
/// is rounded, as it is printed. Every question that takes a radius uses it, so a distance that was answered
/// finds its primitive again as a radius.
#pragma once

#include <bit>
#include <cstdint>

#include <hedgerow/geometry/rounding.h>

namespace hedgerow {

/// Whether a squared distance is within a radius: its rounded root is at most the radius. False for a radius
/// that is negative or NaN.
template <std::floating_point T>
bool within_radius(T distance2, T radius) {
    return std::sqrt(distance2) <= radius;
}

/// The greatest number of T, or infinity, that is at most a number; NaN of NaN. A distance in T is at most a
/// radius if it is at most that.
template <std::floating_point T>
T greatest_at_most(double number) {
    if constexpr (std::same_as<T, double>) return number;
    if (number >= std::numeric_limits<T>::infinity()) return std::numeric_limits<T>::infinity();
    return in_ieee_mode([&] {
        const T nearest = rounded_to<T>(number);
        const bool above = static_cast<double>(nearest) > number;
        return above ? std::nextafter(nearest, -std::numeric_limits<T>::infinity()) : nearest;
    });
}

/// The largest finite squared distance within a radius, and −1 if none is: `within_radius(d2, r)` is
/// `d2 <= largest_square_within(r)` for every finite d2.
template <std::floating_point T>
T largest_square_within(T radius) {
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    constexpr T most = std::numeric_limits<T>::max();
    if (!(radius >= 0)) return T(-1);
    if (radius >= std::sqrt(most)) return most;
    // The square is at most two steps away, since a root has about half as many steps as its square.
    return in_ieee_mode([&] {
        const auto beside = [](T square, int step) {
            return std::bit_cast<T>(static_cast<Bits>(std::bit_cast<Bits>(square) + static_cast<Bits>(step)));
        };
        T square = rounded_to<T>(product(static_cast<double>(radius), static_cast<double>(radius)));
        while (square > 0 && !within_radius(square, radius)) square = beside(square, -1);
        while (square < most && within_radius(beside(square, 1), radius)) square = beside(square, 1);
        return square;
    });
}

/// The same for distances of T and a radius of double.
template <std::floating_point T>
T square_within(double radius) {
    return largest_square_within(greatest_at_most<T>(radius));
}

}  // namespace hedgerow
