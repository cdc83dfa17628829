/// Work cut into blocks that are the same for every executor, where what a block finds is kept by its number.
#pragma once

#include <algorithm>

#include <hedgerow/parallel/executor.h>

namespace hedgerow {

/// [0, count) in blocks of `size`: an executor's own pieces may lie anywhere.
struct Blocks {
    std::size_t count, size;

    std::size_t number() const { return (count + size - 1) / size; }
    /// Calls body(block, begin, end) for each.
    template <class F>
    void each(Executor& executor, F body) const {
        executor.for_each_piece(number(), 1, [&](std::size_t from, std::size_t to) {
            for (std::size_t b = from; b < to; ++b) body(b, b * size, std::min(count, (b + 1) * size));
        });
    }
};

}  // namespace hedgerow
