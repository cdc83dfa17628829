/// Stable sorting by integer keys, one digit at a time from the least significant (LSD radix sort).
#pragma once

#include <array>
#include <cstdint>

#include <hedgerow/base/bare_vector.h>
#include <hedgerow/parallel/blocks.h>

namespace hedgerow {

/// Sorts by `digits` digits of 11 bits of key(element); the least significant one begins at bit `low`. Takes
/// O(n) time for each digit, and a second array. A digit that all elements share costs one read. Blocks count
/// and place their elements independently. A stable sort has only one result, so every executor gives the
/// same.
template <class E, class Key>
void radix_sort(BareVector<E>& elements, Key key, int low, int digits, Executor& executor) {
    constexpr std::size_t values = 1 << 11;
    using Histogram = std::array<std::uint32_t, values>;
    const std::size_t count = elements.size();
    const Blocks blocks{count, std::size_t(1) << 17};
    BareVector<E> other(count);
    BareVector<Histogram> places(blocks.number());
    for (int shift = low; shift < low + 11 * digits; shift += 11) {
        const auto digit = [&](const E& e) { return std::size_t(key(e) >> shift) & (values - 1); };
        // Count the values of the digit in each block.
        blocks.each(executor, [&](std::size_t b, std::size_t begin, std::size_t end) {
            places[b].fill(0);
            for (std::size_t i = begin; i < end; ++i) ++places[b][digit(elements[i])];
        });
        // Turn counts into places: by value, and within a value by block.
        std::uint32_t before = 0, most = 0;
        for (std::size_t v = 0; v < values; ++v) {
            const std::uint32_t first = before;
            for (std::size_t b = 0; b < blocks.number(); ++b) before += std::exchange(places[b][v], before);
            most = std::max(most, before - first);
        }
        // Skip a digit that all elements share.
        if (most == count) continue;
        // Move each element to its place.
        blocks.each(executor, [&](std::size_t b, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) other[places[b][digit(elements[i])]++] = elements[i];
        });
        elements.swap(other);
    }
}

}  // namespace hedgerow
