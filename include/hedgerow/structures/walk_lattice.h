/// The walk through a lattice of cells: grids.
#pragma once

#include <hedgerow/queries/concepts.h>

namespace hedgerow {

/// The probe knows the way from cell to cell; `visit(cell)` looks into each, and may say that much around it
/// is empty, which the probe then may pass over. What is found in any cell is kept, and the walk ends when
/// the next cell begins beyond the limit, or when a visit stops it. A cell may itself be a lattice to be
/// walked.
template <class Lattice, Query Q, class Visit>
Flow walk_lattice(const Lattice& lattice, const Q& query, Visit visit) {
    Flow flow = Flow::go_on;
    query.probe().sweep(
        lattice, [&] { return query.limit(); },
        [&](const auto& cell) {
            const Looked looked = visit(cell);
            flow = looked.flow;
            return looked;
        });
    return flow;
}

}  // namespace hedgerow
