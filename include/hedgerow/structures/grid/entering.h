/// Finds the cells of a lattice that a primitive is inserted in.
#pragma once

#include <limits>
#include <optional>
#include <utility>

#include <hedgerow/structures/cells.h>
#include <hedgerow/structures/grid/cell_rows.h>
#include <hedgerow/structures/grid/resolution.h>
#include <hedgerow/structures/item_limit.h>
#include <hedgerow/walks/mailbox.h>

namespace hedgerow {

/// `box`: a primitive is inserted in every cell that its box reaches. `exact`: only in cells that the
/// primitive itself meets. The saving of `exact` shows on large triangles that lie askew to the axes.
enum class GridInsert { exact, box };
inline constexpr std::string_view grid_insert_names[] = {"exact", "box"};

/// Lists the options (option.h) of a grid that say how primitives are inserted.
template <class Options, class Option>
void list_entering(Options& o, Option& option) {
    option("insert", o.insert, grid_insert_names,
           "into which cells: all that the primitive meets, or all that its box meets");
    option("items_per_primitive", o.items_per_primitive, 1, most_items_per_primitive,
           "with more items a primitive there are fewer cells");
    option("budget", o.budget, 1e3, 1e15, "bytes; a build that would take more is refused");
    option("mailbox", o.mailbox, mailbox_meaning);
}

/// Finds the cells that a primitive is inserted in: those within the lattice's pad of it.
template <PrimitiveSet P>
class CellEntering {
public:
    using T = typename P::Scalar;
    static constexpr int D = P::dimension;
    using Cell = typename Lattice<D>::Cell;

    CellEntering(const P& set, const Lattice<D>& lattice, GridInsert insert, T margin)
        : set_(set), lattice_(lattice), insert_(insert), margin_(margin) {}

    /// A copy for another lattice, which must outlive the copy.
    CellEntering within(const Lattice<D>& inner) const { return {set_, inner, insert_, margin_}; }

    /// Calls f(cell) for each cell that the primitive is inserted in, until f returns false. The outermost
    /// cells also contain what lies beyond the lattice. A primitive spans its box. So if the box reaches
    /// several cells along one axis only, the primitive reaches all of them, and the primitive itself is
    /// tested only if the box reaches several cells along two axes or more.
    template <class F>
    void for_each(PrimitiveId id, const Box<T, D>& box, F f) const {
        const auto [first, last] = reached(box);
        if (first == last) return void(f(first));
        int spanned = 0;
        for (std::size_t a = 0; a < D; ++a) spanned += first[a] != last[a];
        if (spanned == 1 || insert_ == GridInsert::box) {
            for_each_cell(first, last, f);
        } else {
            const auto stands = stands_in(set_, id);
            for_each_cell(first, last,
                          [&](const Cell& cell) { return !stands(enlarged_cell(cell)) || f(cell); });
        }
    }
    /// Bounds of a primitive's part in a cell that it is inserted in.
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

/// The most entries that a build can list, sort and keep in `budget` bytes, at 24 bytes an entry.
inline std::uint64_t entries_within(double budget) {
    return static_cast<std::uint64_t>(std::min(4294967295.0, std::max(0.0, budget / 24)));
}
/// Throws InputError if a build from so many entries would take more than `budget` bytes.
inline void refuse_beyond(double budget, std::uint64_t entries) {
    if (entries > entries_within(budget))
        throw InputError("the grid would take more than " +
                         std::to_string(24e-6 * static_cast<double>(entries)) +
                         " MB to build, and its budget is " + std::to_string(budget * 1e-6) +
                         ": lower its density or resolution, or raise the budget");
}

/// Entries in pieces that follow each other by id.
using EntryPieces = std::vector<std::vector<CellEntry>>;

/// The entries of all primitives; nothing if they would be more than `most`. Throws InputError if a build
/// from them would take more than `budget` bytes.
template <PrimitiveSet P>
std::optional<EntryPieces> entries_of(const P& set, const CellEntering<P>& entering,
                                      const Lattice<P::dimension>& lattice, std::uint64_t most, double budget,
                                      Executor& executor) {
    constexpr std::size_t grain = 4096;
    const std::uint64_t stop = std::min(most, entries_within(budget));
    EntryPieces pieces((set.size() + grain - 1) / grain);
    std::atomic<std::uint64_t> entered{0};
    executor.expect(set.size());
    executor.for_each_piece(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            auto& piece = pieces[p];
            piece.reserve(2 * grain);
            std::size_t counted = 0;
            // Add the piece's new entries to the count of all. False beyond the limit.
            const auto few_enough = [&] {
                entered += piece.size() - std::exchange(counted, piece.size());
                return entered <= stop;
            };
            // Insert the piece's primitives. Look at the count every 4096 entries.
            const std::size_t last = std::min(set.size(), (p + 1) * grain);
            for (std::size_t i = p * grain; i < last && entered <= stop; ++i) {
                const auto id = static_cast<PrimitiveId>(i);
                entering.for_each(id, set.bounds(i), [&](const auto& cell) {
                    piece.push_back({lattice.number(cell), id});
                    return piece.size() - counted < grain || few_enough();
                });
            }
            few_enough();
            executor.advance(last - p * grain);
        }
    });
    // Beyond the budget the build is refused. Beyond `most` alone the caller can try fewer cells.
    if (entered <= stop) return pieces;
    if (stop < most) refuse_beyond(budget, entered);
    return std::nullopt;
}

/// How many cells the boxes of all primitives reach.
template <PrimitiveSet P>
std::uint64_t cells_reached_by_all(const P& set, const CellEntering<P>& entering, Executor& executor) {
    std::atomic<std::uint64_t> all{0};
    executor.for_each_piece(set.size(), 4096, [&](std::size_t begin, std::size_t end) {
        std::uint64_t sum = 0;
        for (std::size_t i = begin; i < end; ++i) sum += entering.cells_reached(set.bounds(i));
        all += sum;
    });
    return all;
}

/// Inserts all primitives of a set in the cells of a lattice over the scene. A resolution set by hand is
/// kept. A resolution by a heuristic is halved until there are at most `most` entries, which must be at least
/// the number of primitives. It is also halved until the boxes reach at most twice as many cells, since each
/// of these costs a test of the primitive (2^20 of them are always allowed, which small scenes do not
/// exceed). Throws InputError beyond `budget` bytes.
template <PrimitiveSet P>
CellRows<P::dimension> enter_all(const P& set, const Box<typename P::Scalar, P::dimension>& bounds,
                                 const GridResolution& wanted, GridInsert insert, std::uint64_t most,
                                 double budget, Executor& executor) {
    constexpr std::uint64_t all = std::numeric_limits<std::uint64_t>::max(), few = 1 << 20;
    if (wanted.resolution > 0) most = all;
    const std::uint64_t most_asked = most < all / 2 ? std::max(2 * most, few) : all;
    auto lattice = wanted.lattice_over(bounds, set.size());
    for (;; lattice = lattice.halved(bounds)) {
        const CellEntering entering(set, lattice, insert, cell_margin(bounds));
        if (most_asked < all && cells_reached_by_all(set, entering, executor) > most_asked) continue;
        if (const auto pieces = entries_of(set, entering, lattice, most, budget, executor))
            return CellRows<P::dimension>(lattice, *pieces, executor);
    }
}

}  // namespace hedgerow
