/// The walk through a lattice of cells: grids.
#pragma once

#include <hedgerow/queries/concepts.h>

namespace hedgerow {

/// The probe knows the way from cell to cell; each visited cell's primitives are tested. A hit found in any
/// cell is kept, and the walk ends when the next cell begins beyond the limit.
template <class Grid, class Primitives, Query Q, class Count>
void walk_lattice(const Grid& grid, Primitives& primitives, Q& query, Count& count) {
    if (grid.empty()) return;
    query.probe().sweep(
        grid.lattice(), [&] { return query.limit(); },
        [&](const auto& cell) {
            count.node();
            const Leaf leaf = grid.leaf(cell);
            if (leaf.count == 0) return Flow::go_on;
            count.leaf(leaf.count);
            return test_leaf(primitives, query.probe(), leaf, query);
        });
}

}  // namespace hedgerow
