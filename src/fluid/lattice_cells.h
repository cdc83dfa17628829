/// The cells of a lattice, by their numbers along each axis.
#pragma once

#include <array>
#include <cstddef>

#include <hedgerow/geometry/vec.h>

namespace hedgerow::detail {

/// The number of a cell of a lattice along each axis.
template <int D>
using Cell = std::array<int, static_cast<std::size_t>(D)>;

/// Calls f(cell) for each cell of a lattice from `low` up to `high`, the first axis fastest.
template <int D, class F>
void for_each_cell(const Cell<D>& low, const Cell<D>& high, F f) {
    for (int k = 0; k < D; ++k)
        if (low[static_cast<std::size_t>(k)] >= high[static_cast<std::size_t>(k)]) return;
    Cell<D> at = low;
    while (true) {
        f(at);
        std::size_t k = 0;
        while (k < D && ++at[k] == high[k]) at[k] = low[k], ++k;
        if (k == D) return;
    }
}

/// The middle of a cell of a lattice that has a corner at `origin`.
template <int D>
Vec<double, D> middle_of(const Vec<double, D>& origin, const Cell<D>& cell, double spacing) {
    Vec<double, D> p = origin;
    for (int k = 0; k < D; ++k) p[k] += (cell[static_cast<std::size_t>(k)] + 0.5) * spacing;
    return p;
}

}  // namespace hedgerow::detail
