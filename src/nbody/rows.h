/// What all ways to sum forces do with the caller's arrays.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

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

/// Of the cube that repeats, as it is in T.
template <class T>
double side_of(const Charges<T>& charges) {
    return static_cast<double>(static_cast<T>(charges.period));
}
template <class T>
bool softened(const Charges<T>& charges) {
    return charges.softening.length > 0 || !charges.lengths.empty();
}
/// How far a charge is softened, and a target: one without a length of its own leaves it to the charges.
template <class T>
T reach_of(const Charges<T>& charges, std::size_t i) {
    const double length =
        charges.lengths.empty() ? charges.softening.length : static_cast<double>(charges.lengths[i]);
    return static_cast<T>(charges.softening.reach(length));
}
template <class T>
T reach_of(const Targets<T>& targets, const Softening& softening, std::size_t i) {
    if (targets.lengths.empty())  // that of the charges, if they are some
        return targets.charges.empty() ? T(0) : static_cast<T>(softening.reach(softening.length));
    return static_cast<T>(softening.reach(static_cast<double>(targets.lengths[i])));
}

/// What a target that is a softened charge does at its own place, which is left out; else 0.
template <class T>
double own_potential(const Targets<T>& targets, const Softening& softening, std::size_t i) {
    if (targets.charges.empty()) return 0;
    const double reach = static_cast<double>(reach_of(targets, softening, i));
    return reach > 0 ? static_cast<double>(targets.charges[i]) *
                           SoftenedInverse{softening.kernel, reach}(0).potential
                     : 0;
}

/// The greatest coordinate and the greatest charge, by size. Throws InputError as `direct_sum` does.
template <class T>
struct Extremes {
    T coordinate = 0, charge = 0;

    explicit Extremes(const Charges<T>& charges) {
        const std::size_t n = charges.places.size();
        expect_one_charge_each(charges.charges.size(), n);
        if (!(charges.period >= 0 && charges.period <= double(largest_coordinate<T>)))
            throw InputError("a period of " + std::to_string(charges.period) +
                             ": give the side of the cube, or 0");
        if (!(charges.softening.length >= 0 && charges.softening.length <= 0x1p480))
            throw InputError("a length of softening of " + std::to_string(charges.softening.length) +
                             ": give 0 or more");
        expect_lengths(charges.lengths, n, "the length of source");
        T longest = 0;
        for (std::size_t i = 0; i < n; ++i) {
            longest = std::max(longest, reach_of(charges, i));
            expand(charges.places[i], "a coordinate of source", i);
            charge = std::max(charge, std::abs(sound_number(charges.charges[i], "the charge of source", i)));
        }
        expand_to_period(charges, longest);
    }
    /// Of targets of the charges.
    void expand(const Targets<T>& targets, const Charges<T>& charges) {
        T longest = 0;
        expect_lengths(targets.lengths, targets.places.size(), "the length of target");
        if (!targets.charges.empty()) expect_one_charge_each(targets.charges.size(), targets.places.size());
        for (std::size_t i = 0; i < targets.places.size(); ++i) {
            expand(targets.places[i], "a coordinate of target", i);
            longest = std::max(longest, reach_of(targets, charges.softening, i));
        }
        expand_to_period(charges, longest);
    }

private:
    // In a cube that repeats, places are brought into it; charges that are softened may not reach around it.
    void expand_to_period(const Charges<T>& charges, T longest) {
        if (!(charges.period > 0)) return;
        if (static_cast<double>(longest) > charges.period)
            throw InputError("a charge is softened as far as " + std::to_string(longest) +
                             ", beyond the period of " + std::to_string(charges.period));
        coordinate = static_cast<T>(charges.period);
    }
    void expand(const Vec<T, 3>& p, const char* what, std::size_t i) {
        for (int k = 0; k < 3; ++k) coordinate = std::max(coordinate, std::abs(sound_number(p[k], what, i)));
    }
    static void expect_lengths(const Strided<T>& lengths, std::size_t n, const char* what) {
        if (!lengths.empty() && lengths.size() != n)
            throw InputError(std::to_string(lengths.size()) + " lengths of softening for " +
                             std::to_string(n) + " places: give one each, or none");
        for (std::size_t i = 0; i < lengths.size(); ++i)
            if (sound_number(lengths[i], what, i) < 0)
                throw InputError(std::string(what) + " " + std::to_string(i) + " is below 0");
    }
};
/// A coordinate in a cube that repeats: from 0 to the side.
template <class T>
T in_period(T x, T side) {
    const T in = x - side * std::floor(x / side);
    return in >= 0 && in < side ? in : T(0);
}
/// An offset in a cube of a side that repeats: that of the nearest image. Without a side, the offset itself.
inline Vec3d to_nearest_image(const Vec3d& offset, double side) {
    if (!(side > 0)) return offset;
    Vec3d nearest = offset;
    for (int k = 0; k < 3; ++k) nearest[k] -= side * std::round(offset[k] / side);
    return nearest;
}
/// The cube that repeats, whose images of all places are taken: of a side, around a middle. Without a side
/// nothing repeats.
struct RepeatingCube {
    double side = 0;
    Vec3d middle;

    /// Chooses the middle so that few charges are near faces and corners, where expansions about it converge
    /// least: an axis has the middle with the least Σ |q|·|distance|⁸, of nine from 0 to half a side. These
    /// bring places of 0 to a side into the cube without a rounding. O(charges).
    template <class T>
    explicit RepeatingCube(const Charges<T>& charges) : side(side_of(charges)) {
        if (!(side > 0)) return;
        constexpr int bins = 64, steps = 16;
        for (int k = 0; k < 3; ++k) {
            std::array<double, bins> weight{};
            for (std::size_t i = 0; i < charges.places.size(); ++i) {
                const double x = static_cast<double>(charges.places[i][k]) / side, in = x - std::floor(x);
                weight[static_cast<std::size_t>(in * bins) % bins] +=
                    std::abs(static_cast<double>(charges.charges[i]));
            }
            const auto crowd = [&](int step) {  // near the faces of the cube around a middle
                double sum = 0;
                for (int b = 0; b < bins; ++b) {
                    const double apart = (b + 0.5) / bins - double(step) / steps,
                                 nearest = 2 * std::abs(apart - std::round(apart)), near2 = nearest * nearest;
                    sum += weight[static_cast<std::size_t>(b)] * near2 * near2 * near2 * near2;
                }
                return sum;
            };
            int best = steps / 2;
            // Even charge stays where it is.
            double least = 0.9 * crowd(best);
            for (int step = 0; step < steps / 2; ++step)
                if (const double here = crowd(step); here < least) best = step, least = here;
            middle[k] = side * best / steps;
        }
    }
    template <class T>
    T image(T x, int axis) const {
        const double low = middle[axis] - side / 2, at = static_cast<double>(x);
        if (at >= low && at < low + side) return x;
        const double moved = at - side * std::floor((at - low) / side);
        return static_cast<T>(moved);
    }
};
/// The images of places in a cube that repeats. Else the places themselves.
template <class T>
class PlacesInCube {
public:
    PlacesInCube(const Strided<Vec<T, 3>>& places, const RepeatingCube& cube) : places_(places) {
        if (!(cube.side > 0)) return;
        in_cube_.resize(places.size());
        for (std::size_t i = 0; i < places.size(); ++i)
            for (int k = 0; k < 3; ++k) in_cube_[i][k] = cube.image(places[i][k], k);
        places_ = in_cube_;
    }
    PlacesInCube(const PlacesInCube&) = delete;
    PlacesInCube& operator=(const PlacesInCube&) = delete;
    const Strided<Vec<T, 3>>& places() const { return places_; }

private:
    std::vector<Vec<T, 3>> in_cube_;
    Strided<Vec<T, 3>> places_;
};
inline void expect_room(std::size_t room, std::size_t targets) {
    if (room != targets)
        throw InputError("room for " + std::to_string(room) + " answers to " + std::to_string(targets) +
                         " targets: give one each");
}

}  // namespace hedgerow::detail
