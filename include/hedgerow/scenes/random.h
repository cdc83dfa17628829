/// Random numbers with the same bits on every machine: a counter, hashed.
#pragma once

#include <cmath>
#include <cstdint>

#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// The finaliser of splitmix64 (Steele, Lea and Flood 2014): a bijection of 64 bits that scatters them.
constexpr std::uint64_t scattered(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

/// A stream of random numbers, chosen by (seed, index): element `index` of a scene draws from its own stream,
/// so that it does not depend on the elements before it. Eight bytes of state, a few operations a number.
class Random {
public:
    explicit constexpr Random(std::uint64_t seed, std::uint64_t index = 0)
        : state_(scattered(scattered(seed + step) + index)) {}

    constexpr std::uint64_t bits() { return scattered(state_ += step); }

    /// A multiple of 2^-53 in [0, 1), all equally likely.
    constexpr double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

    constexpr double uniform(double low, double high) { return low + product(high - low, uniform()); }

    /// A point of the unit cube (square), [0, 1)^D.
    template <int D>
    constexpr Vec<double, D> in_cube() {
        Vec<double, D> p;
        for (int i = 0; i < D; ++i) p[i] = uniform();
        return p;
    }

    /// A vector of length 1, all directions equally likely: by rejection from the cube, about 2 tries in 3D.
    template <int D>
    Vec<double, D> direction() {
        for (;;) {
            const Vec<double, D> p = in_cube<D>() * 2.0 - Vec<double, D>::all(1);
            const double l2 = length2(p);
            if (l2 > 0x1p-10 && l2 <= 1) return p / std::sqrt(l2);
        }
    }

private:
    static constexpr std::uint64_t step = 0x9E3779B97F4A7C15u;
    std::uint64_t state_;
};

}  // namespace hedgerow
