/// Keys: primitives at a distance from a point, in one number each. The kernels of points answer lists of
/// keys.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <hedgerow/queries/point_query.h>

namespace hedgerow {

/// The bits of the squared distance above the element. The order of the numbers is that of answers, by
/// (distance², element).
using NearKey = std::uint64_t;

inline NearKey key_of(float distance2, std::uint32_t element) {
    return NearKey(std::bit_cast<std::uint32_t>(distance2)) << 32 | element;
}
inline float distance2_of(NearKey key) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(key >> 32));
}
inline std::uint32_t element_of(NearKey key) {
    return static_cast<std::uint32_t>(key);
}

/// What a kernel answers in place of the number of keys, and in place of the first id of a row, where it gave
/// up: many points are at one place, and most of them only tie with those that are found. A walk that takes
/// the first points of a place answers then (NearestAmongTies).
inline constexpr std::size_t gave_up = std::size_t(-1);
inline constexpr PrimitiveId gave_up_id = no_primitive - 1;

/// A list of keys in the caller's memory. `grow` makes room for at least eight more.
struct NearKeys {
    NearKey* keys;
    std::size_t size, room;
    void (*grow)(NearKeys&);
};

/// Sorts keys. Long lists are sorted by the bytes of their distances, the least significant first (LSD radix
/// sort), and what is equally far away by element afterwards: O(k) where few are. `other` is memory for as
/// many keys, which grows as needed.
inline void sort_keys(std::span<NearKey> keys, std::vector<NearKey>& other) {
    constexpr std::size_t few = 96;
    if (keys.size() < few) return std::sort(keys.begin(), keys.end());
    if (other.size() < keys.size()) other.resize(keys.size());
    // Count the values of all four bytes in one read.
    std::array<std::array<std::uint32_t, 256>, 4> counts{};
    for (const NearKey key : keys)
        for (std::size_t digit = 0; digit < 4; ++digit) ++counts[digit][key >> (32 + 8 * digit) & 255];
    NearKey *from = keys.data(), *to = other.data();
    for (std::size_t digit = 0; digit < 4; ++digit) {
        std::array<std::uint32_t, 256>& places = counts[digit];
        const std::size_t shift = 32 + 8 * digit;
        if (places[*from >> shift & 255] == keys.size()) continue;  // all share the byte
        std::uint32_t before = 0;
        for (std::uint32_t& place : places) before += std::exchange(place, before);
        for (std::size_t i = 0; i < keys.size(); ++i) to[places[from[i] >> shift & 255]++] = from[i];
        std::swap(from, to);
    }
    if (from != keys.data()) std::copy(from, from + keys.size(), keys.data());
    // Sort runs of equal distances.
    for (std::size_t begin = 0; begin < keys.size();) {
        std::size_t end = begin + 1;
        while (end < keys.size() && keys[end] >> 32 == keys[begin] >> 32) ++end;
        if (end - begin > 1) std::sort(&keys[begin], keys.data() + end);
        begin = end;
    }
}

}  // namespace hedgerow
