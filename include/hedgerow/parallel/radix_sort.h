/// Stable sorting by whole numbers, a digit at a time from the last (LSD radix sort).
#pragma once

#include <array>
#include <cstdint>

#include <hedgerow/bare_vector.h>
#include <hedgerow/parallel/blocks.h>

namespace hedgerow {

/// Sorts by `digits` digits of 11 bits, the first at bit `low` of key(element). O(n) a digit and a second
/// array; a digit that all elements share costs one read. Blocks count and place their elements on their own,
/// and the order of a stable sort is one, so that any executor gives the same.
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
        blocks.each(executor, [&](std::size_t b, std::size_t begin, std::size_t end) {
            places[b].fill(0);
            for (std::size_t i = begin; i < end; ++i) ++places[b][digit(elements[i])];
        });
        std::uint32_t before = 0, most = 0;
        for (std::size_t v = 0; v < values; ++v) {
            const std::uint32_t first = before;
            for (std::size_t b = 0; b < blocks.number(); ++b) before += std::exchange(places[b][v], before);
            most = std::max(most, before - first);
        }
        if (most == count) continue;
        blocks.each(executor, [&](std::size_t b, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) other[places[b][digit(elements[i])]++] = elements[i];
        });
        elements.swap(other);
    }
}

}  // namespace hedgerow
