/// Codes of cells along a Morton curve (Morton 1966): the bits of the cell's coordinates, interleaved.
#pragma once

#include <cstdint>

namespace hedgerow {

/// Moves bit i to bit D·i, for the low 21 bits in space and the low 32 in the plane.
template <int D>
constexpr std::uint64_t spread_bits(std::uint64_t x) {
    static_assert(D == 2 || D == 3);
    if constexpr (D == 3) {
        x = (x | x << 32) & 0x001F00000000FFFFu;
        x = (x | x << 16) & 0x001F0000FF0000FFu;
        x = (x | x << 8) & 0x100F00F00F00F00Fu;
        x = (x | x << 4) & 0x10C30C30C30C30C3u;
        return (x | x << 2) & 0x1249249249249249u;
    } else {
        x = (x | x << 16) & 0x0000FFFF0000FFFFu;
        x = (x | x << 8) & 0x00FF00FF00FF00FFu;
        x = (x | x << 4) & 0x0F0F0F0F0F0F0F0Fu;
        x = (x | x << 2) & 0x3333333333333333u;
        return (x | x << 1) & 0x5555555555555555u;
    }
}

}  // namespace hedgerow
