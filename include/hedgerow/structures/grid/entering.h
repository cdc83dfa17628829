/// Which cells of a lattice primitives are entered in.
#pragma once

#include <hedgerow/structures/cells.h>
#include <hedgerow/structures/grid/cell_rows.h>

namespace hedgerow {

/// By its box alone, or only where the primitive itself meets the cell. What that saves is seen on large
/// triangles that stand askew.
enum class GridInsert { exact, box };

/// Which cells of a lattice a primitive is entered in: those that it comes within the lattice's pad of.
template <PrimitiveSet P>
class CellEntering {
public:
    using T = typename P::Scalar;
    static constexpr int D = P::dimension;
    using Cell = typename Lattice<D>::Cell;

    CellEntering(const P& set, const Lattice<D>& lattice, GridInsert insert, T margin)
        : set_(set), lattice_(lattice), insert_(insert), margin_(margin) {}

    /// The same for another lattice.
    CellEntering within(const Lattice<D>& inner) const { return {set_, inner, insert_, margin_}; }

    /// Calls f(cell) for each cell of the lattice, whose outermost stand for what lies beyond. A row of cells
    /// that a box reaches is reached by what spans the box: only where it spans several along two axes does
    /// the primitive itself have to be asked.
    template <class F>
    void for_each(PrimitiveId id, const Box<T, D>& box, F f) const {
        const auto [first, last] = reached(box);
        if (first == last) return f(first);
        int spanned = 0;
        for (std::size_t a = 0; a < D; ++a) spanned += first[a] != last[a];
        if (spanned == 1 || insert_ == GridInsert::box) {
            for_each_cell(first, last, [&](const Cell& cell) { return f(cell), true; });
        } else {
            const auto stands = stands_in(set_, id);
            for_each_cell(first, last, [&](const Cell& cell) {
                if (stands(enlarged_cell(cell))) f(cell);
                return true;
            });
        }
    }
    /// The bounds of what stands in a cell of a primitive that is entered there.
    Box<T, D> part(PrimitiveId id, const Cell& cell) const {
        const auto enlarged = enlarged_cell(cell);
        return insert_ == GridInsert::exact ? part_in(set_, id, enlarged)
                                            : intersection(set_.bounds(id), enlarged);
    }
    /// How many cells a box reaches.
    std::uint64_t cells_reached(const Box<T, D>& box) const {
        const auto [first, last] = reached(box);
        std::uint64_t n = 1;
        for (std::size_t a = 0; a < D; ++a) n *= static_cast<std::uint64_t>(last[a] - first[a] + 1);
        return n;
    }

private:
    std::pair<Cell, Cell> reached(const Box<T, D>& box) const {
        std::pair<Cell, Cell> block;
        for (int a = 0; a < D; ++a) {
            const auto i = static_cast<std::size_t>(a);
            block.first[i] = lattice_.coordinate(static_cast<double>(box.low[a]) - lattice_.pad[a], a);
            block.second[i] = lattice_.coordinate(static_cast<double>(box.high[a]) + lattice_.pad[a], a);
        }
        return block;
    }
    Box<T, D> enlarged_cell(const Cell& cell) const {
        const auto b = lattice_.bounds(cell);
        return enlarged(Box<T, D>{Vec<T, D>(b.low - lattice_.pad), Vec<T, D>(b.high + lattice_.pad)},
                        margin_);
    }

    const P& set_;
    const Lattice<D>& lattice_;
    GridInsert insert_;
    T margin_;
};

/// Throws InputError when so many entries would take more than `budget` bytes to build from.
inline void refuse_beyond(double budget, std::uint64_t entries) {
    const double bytes = 24.0 * static_cast<double>(entries);  // listed, sorted, and kept
    if (bytes > budget || entries > 0xFFFFFFFFu)
        throw InputError("the grid would take more than " + std::to_string(bytes * 1e-6) +
                         " MB to build, and its budget is " + std::to_string(budget * 1e-6) +
                         ": lower its density or resolution, or raise the budget");
}

/// Where all primitives are entered, in pieces that follow each other by id. Throws InputError when building
/// from them would take more than `budget` bytes.
template <PrimitiveSet P>
std::vector<std::vector<CellEntry>> entries_of(const P& set, const CellEntering<P>& entering,
                                               const Lattice<P::dimension>& lattice, double budget,
                                               Executor& executor) {
    constexpr std::size_t grain = 4096;
    std::vector<std::vector<CellEntry>> pieces((set.size() + grain - 1) / grain);
    std::atomic<std::uint64_t> entered{0};
    executor.for_each_piece(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            auto& piece = pieces[p];
            piece.reserve(2 * grain);
            const std::size_t last = std::min(set.size(), (p + 1) * grain);
            for (std::size_t i = p * grain; i < last; ++i) {
                const std::size_t before = piece.size();
                const auto id = static_cast<PrimitiveId>(i);
                entering.for_each(id, set.bounds(i), [&](const auto& cell) {
                    piece.push_back({lattice.number(cell), id});
                    if (((piece.size() - before) & 0xFFFFu) == 0)
                        refuse_beyond(budget, entered + piece.size());
                });
            }
            refuse_beyond(budget, entered += piece.size());
        }
    });
    return pieces;
}

}  // namespace hedgerow
