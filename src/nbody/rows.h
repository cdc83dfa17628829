/// What all ways to sum forces do with the caller's arrays.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <hedgerow/base/error.h>
#include <hedgerow/nbody/direct_sum.h>
#include <hedgerow/structures/references.h>

namespace hedgerow::detail {

/// Throws InputError for a number that is not finite or too large.
template <class T>
T sound_number(T x, const char* what, std::size_t i) {
    if (std::abs(x) <= T(largest_coordinate<T>)) return x;
    throw InputError(std::string(what) + " " + std::to_string(i) + " is " + std::to_string(x) +
                     ": numbers are finite, and at most 2^" +
                     std::to_string(std::ilogb(largest_coordinate<T>)));
}
/// The power of two that brings a number to between 1/2 and 1.
template <class T>
T to_unit(T largest) {
    constexpr int most = std::numeric_limits<T>::max_exponent - 2;
    return largest > 0 ? std::ldexp(T(1), std::clamp(-std::ilogb(largest) - 1, -most, most)) : T(1);
}

/// The greatest coordinate and the greatest charge, by size. Throws InputError as `direct_sum` does.
template <class T>
struct Extremes {
    T coordinate = 0, charge = 0;

    explicit Extremes(const Charges<T>& charges) {
        const std::size_t n = charges.places.size();
        expect_one_charge_each(charges.charges.size(), n);
        for (std::size_t i = 0; i < n; ++i) {
            expand(charges.places[i], "a coordinate of source", i);
            charge = std::max(charge, std::abs(sound_number(charges.charges[i], "the charge of source", i)));
        }
    }
    void expand(const Vec<T, 3>& p, const char* what, std::size_t i) {
        for (int k = 0; k < 3; ++k) coordinate = std::max(coordinate, std::abs(sound_number(p[k], what, i)));
    }
};
inline void expect_room(std::size_t room, std::size_t targets) {
    if (room != targets)
        throw InputError("room for " + std::to_string(room) + " answers to " + std::to_string(targets) +
                         " targets: give one each");
}

}  // namespace hedgerow::detail
