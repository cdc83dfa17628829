/// The pixels around a pixel.
#pragma once

#include <algorithm>
#include <cstddef>

namespace hedgerow {

/// Calls f with the number of each pixel in the square of three by three around (x, y), as far as it lies in
/// the picture, by rows from the top left.
template <class F>
void for_each_around(int x, int y, int width, int height, const F& f) {
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u)
            f(static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u));
}

}  // namespace hedgerow
