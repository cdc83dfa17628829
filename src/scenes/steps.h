/// How generators report progress and check for cancellation.
#pragma once

#include <hedgerow/parallel/progress.h>

namespace hedgerow::detail {

/// Called for each of `total` elements, or for the first of every `row` elements. Reports progress and checks
/// for cancellation about once in 4096 elements. Throws Cancelled.
inline void step(const Progress& progress, std::uint64_t done, std::uint64_t total, std::uint64_t row = 1) {
    if (done % 4096 >= row) return;
    progress.look();
    progress(done, total);
}

/// The progress of a part of the work. It is cancelled with the whole, and reports nothing.
inline Progress part_of(const Progress& whole) {
    return {{}, whole.cancel};
}

}  // namespace hedgerow::detail
