/// Value noise in any dimension.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include <hedgerow/scenes/random.h>

namespace hedgerow::detail {

/// The noise at p: random values in [0, 1) at the points of the integer lattice, with smooth steps between
/// them. Each seed has its own noise. Coordinates must be greater than −2^20.
template <int D>
double value_noise(std::uint64_t seed, const Vec<double, D>& p) {
    std::array<std::uint64_t, static_cast<std::size_t>(D)> cell{};
    Vec<double, D> weight;
    for (int k = 0; k < D; ++k) {
        const double shifted = p[k] + 0x1p20;  // positive, so that truncation is the floor
        cell[static_cast<std::size_t>(k)] = static_cast<std::uint64_t>(shifted);
        const double f = shifted - std::floor(shifted);
        weight[k] = product(product(f, f), 3 - 2 * f);
    }
    // The values at the corners of the cell. Bit k of a corner's number says whether it is the upper one
    // along axis k.
    std::array<double, std::size_t{1} << D> value{};
    for (std::size_t corner = 0; corner < value.size(); ++corner) {
        std::uint64_t point = 0;
        for (std::size_t k = 0; k < cell.size(); ++k)
            point = (point << (64 / D)) + cell[k] + (corner >> k & 1);
        value[corner] = Random(seed, point).uniform();
    }
    // Join neighbours axis by axis.
    for (int k = 0; k < D; ++k)
        for (std::size_t i = 0; i < value.size() >> (k + 1); ++i)
            value[i] = value[2 * i] + product(weight[k], value[2 * i + 1] - value[2 * i]);
    return value[0];
}

}  // namespace hedgerow::detail
