/// Where generators report progress and look whether they shall stop.
#pragma once

#include <hedgerow/parallel/progress.h>

namespace hedgerow::detail {

/// Called for each of `total` elements, or for the first of each row; acts about once in 4096. Throws
/// Cancelled.
inline void step(const Progress& progress, std::uint64_t done, std::uint64_t total, std::uint64_t row = 1) {
    if (done % 4096 >= row) return;
    progress.look();
    progress(done, total);
}

/// The progress of a part of the work: it stops as the whole does, and reports nothing.
inline Progress part_of(const Progress& whole) {
    return {{}, whole.cancel};
}

}  // namespace hedgerow::detail
