/// Pairs of Sobol's sequence, scrambled and shuffled by hashing: integers only (Burley, Practical hash-based
/// Owen scrambling, JCGT 2020).
#pragma once

#include <cstdint>

namespace hedgerow {

/// A bijection of 32 bits that scatters them (the constants are those of C. Wellons' lowbias32).
[[gnu::always_inline]] constexpr std::uint32_t scattered32(std::uint32_t x) {
    x = (x ^ (x >> 16)) * 0x7FEB352Du;
    x = (x ^ (x >> 15)) * 0x846CA68Bu;
    return x ^ (x >> 16);
}

[[gnu::always_inline]] constexpr std::uint32_t bits_reversed(std::uint32_t x) {
    x = (x << 16) | (x >> 16);
    x = ((x & 0x00FF00FFu) << 8) | ((x & 0xFF00FF00u) >> 8);
    x = ((x & 0x0F0F0F0Fu) << 4) | ((x & 0xF0F0F0F0u) >> 4);
    x = ((x & 0x33333333u) << 2) | ((x & 0xCCCCCCCCu) >> 2);
    return ((x & 0x55555555u) << 1) | ((x & 0xAAAAAAAAu) >> 1);
}

/// A bijection in which each bit depends on the bits below it alone, so that it is a nested scrambling of
/// numbers whose bits are reversed (Laine and Karras, EGSR 2011; the constants are those of N. Vegdahl,
/// who found these to scatter better than Burley's).
[[gnu::always_inline]] constexpr std::uint32_t scrambled_upward(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3D20ADEAu;
    x += seed;
    x *= (seed >> 16) | 1;
    x ^= x * 0x05526C56u;
    return x ^ (x * 0x53A22864u);
}

/// The bits of the second dimension of Sobol's sequence at an index, lowest first. Its matrix is Pascal's
/// triangle modulo 2, which is a Kronecker power of (1 1, 0 1); each step multiplies by one factor.
[[gnu::always_inline]] constexpr std::uint32_t pascal_product(std::uint32_t index) {
    index ^= (index & 0xAAAAAAAAu) >> 1;
    index ^= (index & 0xCCCCCCCCu) >> 2;
    index ^= (index & 0xF0F0F0F0u) >> 4;
    index ^= (index & 0xFF00FF00u) >> 8;
    return index ^ (index >> 16);
}

/// Two numbers of 32 bits, as fractions of 2^32.
struct FractionPair {
    std::uint32_t x, y;
};

/// Point `index` of a shuffled and scrambled Sobol sequence in the unit square. Sequences with other seeds
/// are independent. The first 2^m points of each are a (0, m, 2)-net: one of them in every box of sides 2^-a
/// and 2^-(m-a) at multiples of them.
[[gnu::always_inline]] constexpr FractionPair sobol_pair(std::uint32_t index, std::uint32_t seed) {
    const std::uint32_t shuffled = bits_reversed(scrambled_upward(bits_reversed(index), scattered32(seed)));
    return {bits_reversed(scrambled_upward(shuffled, scattered32(seed + 0x9E3779B9u))),
            bits_reversed(scrambled_upward(pascal_product(shuffled), scattered32(seed + 0x3C6EF372u)))};
}

}  // namespace hedgerow
