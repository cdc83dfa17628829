/// Stable sorting by integer keys, one digit at a time from the least significant (LSD radix sort).
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <hedgerow/base/bare_vector.h>
#include <hedgerow/parallel/blocks.h>

namespace hedgerow {

/// Sorts by `bits` bits of key(element), the least significant of which is bit `low`: by digits of up to 11
/// bits, or by a single one of up to 16, if it has no more values than there are elements. Takes O(n) time
/// for each digit, and a second array. A digit that all elements share costs one read. Blocks count and place
/// their elements independently. A stable sort has only one result, so every executor gives the same.
template <class E, class Key>
void radix_sort(BareVector<E>& elements, Key key, int low, int bits, Executor& executor) {
    const std::size_t count = elements.size();
    const int digits = bits <= 16 && count >> bits > 0 ? std::min(bits, 1) : (bits + 10) / 11;
    if (digits == 0) return;
    const int width = (bits + digits - 1) / digits;
    const std::size_t values = std::size_t(1) << width;
    // Blocks for a dozen threads and more, each of far more elements than a digit has values.
    const Blocks blocks{
        count, std::max(4 * values, std::clamp(count / 16, std::size_t(1) << 15, std::size_t(1) << 17))};
    BareVector<E> other(count);
    BareVector<std::uint32_t> places(blocks.number() * values);
    for (int shift = low; shift < low + bits; shift += width) {
        const std::size_t mask = (std::size_t(1) << std::min(width, low + bits - shift)) - 1;
        // Each block copies it, for else its loops would read shift and mask anew after every write.
        const auto digit_of = [key, shift, mask](const E& e) { return std::size_t(key(e) >> shift) & mask; };
        const auto places_of = [&](std::size_t b) { return places.data() + b * values; };
        // Count the values of the digit in each block.
        blocks.each(executor, [&](std::size_t b, std::size_t begin, std::size_t end) {
            const auto digit = digit_of;
            std::uint32_t* const counts = places_of(b);
            std::fill_n(counts, values, 0);
            for (std::size_t i = begin; i < end; ++i) ++counts[digit(elements[i])];
        });
        // Turn counts into places: by value, and within a value by block.
        std::uint32_t before = 0, most = 0;
        for (std::size_t v = 0; v < values; ++v) {
            const std::uint32_t first = before;
            for (std::size_t b = 0; b < blocks.number(); ++b)
                before += std::exchange(places_of(b)[v], before);
            most = std::max(most, before - first);
        }
        // Skip a digit that all elements share.
        if (most == count) continue;
        // Move each element to its place.
        blocks.each(executor, [&](std::size_t b, std::size_t begin, std::size_t end) {
            const auto digit = digit_of;
            std::uint32_t* const next = places_of(b);
            for (std::size_t i = begin; i < end; ++i) other[next[digit(elements[i])]++] = elements[i];
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
        keys, [](std::uint64_t key) { return key; }, sorted_from, 33, executor);
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
