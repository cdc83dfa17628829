/// Work cut into numbered blocks that are the same for every executor, so that results can be stored by
/// block.
#pragma once

#include <algorithm>

#include <hedgerow/parallel/executor.h>

namespace hedgerow {

/// Cuts [0, count) into blocks of `size`. The pieces of an executor itself may begin and end anywhere.
struct Blocks {
    std::size_t count, size;

    std::size_t number() const { return (count + size - 1) / size; }
    /// Calls body(block, begin, end) for each block, in any order.
    template <class F>
    void each(Executor& executor, F body) const {
        executor.for_each_piece(number(), 1, [&](std::size_t from, std::size_t to) {
            for (std::size_t b = from; b < to; ++b) body(b, b * size, std::min(count, (b + 1) * size));
        });
    }
};

}  // namespace hedgerow
