/// std::sort that can be stopped.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>

#include <hedgerow/parallel/executor.h>

namespace hedgerow {

/// Sorts in the calling thread and calls `executor.look()` about every 65,536 comparisons, some milliseconds
/// apart. If `look()` throws, the range is of no use any more: an element may be lost, and another may be
/// there twice.
template <class Iterator, class Less = std::less<>>
void sort_watched(Iterator begin, Iterator end, Executor& executor, Less less = {}) {
    std::uint32_t compared = 0;
    std::sort(begin, end, [&](const auto& a, const auto& b) {
        if ((++compared & 0xFFFFu) == 0) executor.look();
        return less(a, b);
    });
}

}  // namespace hedgerow
