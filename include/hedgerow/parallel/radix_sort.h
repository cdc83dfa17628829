/// Stable sorting by integer keys, one digit at a time from the least significant (LSD radix sort).
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

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

/// The end of the keys from `first` on, within [first, last), that are alike above their low `ignored` bits.
inline std::size_t end_of_alike(const std::uint64_t* keys, std::size_t first, std::size_t last, int ignored) {
    std::size_t i = first + 1;
    while (i < last && (keys[i] ^ keys[first]) >> ignored == 0) ++i;
    return i;
}

/// Sorts keys by their first 33 bits by radix, in O(n), and calls sort_run(begin, end) for each run of keys
/// that are still alike, several runs at a time. Few keys are one run. So keys with distinct low bits have
/// one order, whatever the executor.
template <class SortRun>
void sort_by_first_bits(BareVector<std::uint64_t>& keys, Executor& executor, SortRun sort_run) {
    constexpr std::size_t few = 1024;
    constexpr int sorted_from = 31;  // the lowest bit that the radix sort orders
    if (keys.size() <= few) return sort_run(std::size_t(0), keys.size());
    radix_sort(
        keys, [](std::uint64_t key) { return key; }, sorted_from, 3, executor);
    // Each block sorts the runs that begin in it. The first run of each block is found before any run is
    // sorted, so that no block reads keys that another one moves.
    const Blocks blocks{keys.size(), 16384};
    std::vector<std::size_t> first(blocks.number() + 1, keys.size());
    for (std::size_t b = blocks.number(); b-- > 0;) {
        std::size_t i = b * blocks.size;
        const std::size_t end = std::min(keys.size(), i + blocks.size);
        if (i > 0) i = end_of_alike(keys.data(), i - 1, end, sorted_from);
        first[b] = i < end ? i : first[b + 1];
    }
    blocks.each(executor, [&](std::size_t b, std::size_t, std::size_t) {
        for (std::size_t begin = first[b], end; begin < first[b + 1]; begin = end) {
            end = end_of_alike(keys.data(), begin, first[b + 1], sorted_from);
            if (end - begin > 1) sort_run(begin, end);
        }
    });
}

}  // namespace hedgerow
