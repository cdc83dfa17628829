/// The walk through a lattice of cells: grids.
#pragma once

#include <hedgerow/walks/query.h>
#include <hedgerow/walks/visits.h>

namespace hedgerow {

/// The probe's `sweep` goes from cell to cell. `visit(cell)` tests a cell, and may report that a block of
/// cells around it is empty, which the probe may then skip. Any answer found in a cell is kept. The walk ends
/// when the next cell begins beyond the limit, or when a visit stops it. A visit may walk a lattice inside
/// the cell.
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
