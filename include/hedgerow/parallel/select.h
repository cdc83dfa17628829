/// Numbers of an array that fulfil a condition.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <hedgerow/base/bare_vector.h>
#include <hedgerow/parallel/blocks.h>

namespace hedgerow {

/// Writes the numbers i below `count` for which keep(i) holds to `kept`, ascending. O(count).
template <class Keep>
void select_numbers(std::size_t count, BareVector<std::uint32_t>& kept, Executor& executor, Keep keep) {
    const Blocks blocks{count, 8192};
    kept.resize(count);
    // Each block writes where its numbers begin, without branches; then they are moved together.
    std::vector<std::size_t> ends(blocks.number());
    blocks.each(executor, [&](std::size_t b, std::size_t begin, std::size_t end) {
        std::size_t to = begin;
        for (std::size_t i = begin; i < end; ++i) {
            kept[to] = static_cast<std::uint32_t>(i);
            to += static_cast<bool>(keep(i));
        }
        ends[b] = to;
    });
    std::uint32_t* to = kept.data();
    for (std::size_t b = 0; b < blocks.number(); ++b)
        to = std::copy(kept.data() + b * blocks.size, kept.data() + ends[b], to);
    kept.resize(static_cast<std::size_t>(to - kept.data()));
}

}  // namespace hedgerow
