/// Two-level grid: a coarse grid, of which each crowded cell is a grid of its own.
#pragma once

#include <hedgerow/structures/grid/grid.h>

namespace hedgerow {

/// For scenes with detail in few places (Jevans and Wyvill 1989; built from sorted pairs as in Kalojanov,
/// Billeter, Slusallek, EG 2011): each cell of the first level gets as many cells as what stands in it asks
/// for. A cell that asks for one stays a row of the first level.
///
/// Memory: of the first level as Grid; of the second 4 bytes a cell, empty or not, and 4 an item, 16 a cell
/// of the first. Items of the first level that are crowded out are kept no longer.
template <std::floating_point T, int D>
class TwoLevelGrid {
public:
    struct Options {
        /// Of the first level. Kalojanov et al. have 0.12.
        GridResolution cells = {.density = 0.12};
        /// Of the second: so many cells for each primitive in a cell. Kalojanov et al. have 2.4.
        double inner_density = 2.4;
        GridInsert insert = GridInsert::exact;
        /// Off only to show what it brings.
        bool mailbox = true;
        /// Bytes that a build may take; beyond them it is refused.
        double budget = 8e9;
    };
    static constexpr auto packed_order = PackedOrder::of_ids;
    static constexpr bool exclusive() { return false; }

    template <PrimitiveSet P>
    static TwoLevelGrid build(const P& set, const Options& options, Executor& executor) {
        const auto references = references_of(set, executor);
        TwoLevelGrid grid;
        grid.options_ = options;
        grid.count_ = references.size();
        if (references.empty()) return grid;
        for (const auto& r : references) grid.bounds_.expand(r.box());
        const auto lattice = options.cells.lattice_over(grid.bounds_, grid.count_);
        const CellEntering entering(set, lattice, options.insert, cell_margin(grid.bounds_));
        grid.rows_ =
            CellRows<D>(lattice, entries_of(entering, lattice, references, options.budget, executor));
        grid.divide(set, executor);
        return grid;
    }

    const Box<T, D>& bounds() const { return bounds_; }
    std::span<const PrimitiveId> items() const { return items_; }
    std::size_t bytes() const {
        return rows_.bytes() + inner_.capacity() * sizeof(Inner) +
               starts_.capacity() * sizeof(std::uint32_t) + items_.capacity() * sizeof(PrimitiveId);
    }
    /// Cells of both levels.
    std::size_t node_count() const {
        return empty() ? 0 : rows_.lattice().cell_count() + starts_.size() - inner_.size();
    }
    std::size_t leaf_count() const {
        std::size_t occupied = 0;
        for (std::size_t i = 1; i < starts_.size(); ++i) occupied += starts_[i] != starts_[i - 1];
        return occupied;
    }
    int depth() const { return empty() ? 0 : 2; }
    bool empty() const { return count_ == 0; }
    const Lattice<D>& lattice() const { return rows_.lattice(); }
    /// What stands in a cell of the first level that is a row of its own.
    Leaf leaf(const typename Lattice<D>::Cell& cell) const {
        const Inner* inner = inner_of(cell);
        return inner == nullptr ? Leaf{nullptr, 0, 0} : leaf(inner->start);
    }
    /// Calls f(lattice, leaf_of, place_of) if a cell of the first level is a grid of its own: with what
    /// stands in each of its cells, and how walks name them.
    template <class F>
    void with_lattice_in(const typename Lattice<D>::Cell& cell, F f) const {
        const Inner* inner = inner_of(cell);
        if (inner == nullptr || inner->cell_count() == 1) return;
        const auto start = [&](const auto& c) { return inner->start + inner->number(c); };
        f(
            inner->lattice_in(lattice(), cell), [&](const auto& c) { return leaf(start(c)); },
            [&](const auto& c) { return place_of(start(c)); });
    }

    template <class Primitives, Query Q, class Count>
    void walk(const Primitives& primitives, Q& query, Count& count) const {
        if (empty() || query.limit() < 0) return;
        with_mailbox(options_.mailbox, primitives, count, [&](auto& tested) {
            auto cursor = rows_.cursor();
            const auto look_into = [&](std::uint32_t start, const Place& place) {
                const Leaf found = leaf(start);
                if (found.count == 0) return Flow::go_on;
                count.leaf(found.count, place);
                return test_leaf(tested, query.probe(), found, query);
            };
            walk_lattice(rows_.lattice(), query, [&](const auto& cell) {
                const Place place{rows_.lattice().number(cell)};
                count.node(place);
                const std::uint32_t row = cursor.row(cell);
                if (row == CellRows<D>::none) return Flow::go_on;
                const Inner& inner = inner_[row];
                if (inner.cell_count() == 1) return look_into(inner.start, place);
                const auto lattice = inner.lattice_in(rows_.lattice(), cell);
                return walk_lattice(lattice, query, [&](const auto& c) {
                    const std::uint32_t start = inner.start + inner.number(c);
                    count.node(place_of(start));
                    return look_into(start, place_of(start));
                });
            });
        });
    }

    /// What is wrong with the structure; empty if nothing is.
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        if (set.size() != count_) return "not built over these primitives";
        if (empty()) return "";
        const auto& outer = rows_.lattice();
        const CellEntering entering(set, outer, options_.insert, cell_margin(bounds_));
        auto cursor = rows_.cursor();
        std::string fault;
        const auto expect = [&](std::uint32_t start, std::uint32_t p) {
            if (!std::binary_search(items_.begin() + starts_[start], items_.begin() + starts_[start + 1], p))
                fault = "primitive " + std::to_string(p) + " is missing from a cell that it meets";
        };
        for (std::uint32_t p = 0; p < set.size() && fault.empty(); ++p)
            entering.for_each(p, set.bounds(p), [&](const auto& cell) {
                const std::uint32_t row = cursor.row(cell);
                if (row == CellRows<D>::none) return void(fault = "an occupied cell is not there");
                const Inner& inner = inner_[row];
                if (inner.cell_count() == 1) return expect(inner.start, p);
                const auto lattice = inner.lattice_in(outer, cell);
                entering.within(lattice).for_each(
                    p, set.bounds(p), [&](const auto& c) { expect(inner.start + inner.number(c), p); });
            });
        return fault;
    }

private:
    using Cell = typename Lattice<D>::Cell;

    /// A cell of the first level: its own cells' places in `starts_`, and how many there are along each axis.
    struct Inner {
        static constexpr std::int32_t most_cells = 64;
        std::uint32_t start = 0;
        std::array<std::uint8_t, static_cast<std::size_t>(D)> resolution;

        std::uint32_t cell_count() const {
            std::uint32_t n = 1;
            for (const auto r : resolution) n *= r;
            return n;
        }
        std::uint32_t number(const Cell& c) const {
            std::uint32_t n = 0;
            for (std::size_t a = D; a-- > 0;) n = n * resolution[a] + static_cast<std::uint32_t>(c[a]);
            return n;
        }
        Lattice<D> lattice_in(const Lattice<D>& outer, const Cell& cell) const {
            Lattice<D> lattice;
            for (int a = 0; a < D; ++a) {
                const auto i = static_cast<std::size_t>(a);
                lattice.resolution[i] = resolution[i];
                lattice.low[a] = outer.plane(cell[i], a);
                lattice.size[a] = outer.size[a] / resolution[i];
            }
            return lattice;
        }
    };
    /// What some rows of the first level become.
    struct Divided {
        std::vector<Inner> inner;
        std::vector<std::uint32_t> starts;
        std::vector<PrimitiveId> items;
    };

    const Inner* inner_of(const Cell& cell) const {
        const std::uint32_t row = rows_.cursor().row(cell);
        return row == CellRows<D>::none ? nullptr : &inner_[row];
    }
    Leaf leaf(std::uint32_t start) const {
        return {items_.data(), starts_[start], starts_[start + 1] - starts_[start]};
    }
    /// Of a cell of the second level.
    static Place place_of(std::uint32_t start) { return {start, 1}; }

    template <PrimitiveSet P>
    void divide(const P& set, Executor& executor) {
        const CellEntering outer(set, rows_.lattice(), options_.insert, cell_margin(bounds_));
        constexpr std::size_t grain = 64;
        std::vector<Divided> pieces((rows_.brick_count() + grain - 1) / grain);
        executor.for_each_piece(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t p = begin; p < end; ++p)
                rows_.for_each_row(p * grain, (p + 1) * grain, [&](const Cell& cell, const Leaf& leaf) {
                    divide_row(set, outer, cell, leaf, pieces[p]);
                });
        });
        for (Divided& piece : pieces) {
            refuse_beyond(options_.budget, items_.size() + piece.items.size());
            for (Inner i : piece.inner) {
                i.start += static_cast<std::uint32_t>(starts_.size());
                inner_.push_back(i);
            }
            for (const std::uint32_t s : piece.starts)
                starts_.push_back(s + static_cast<std::uint32_t>(items_.size()));
            items_.insert(items_.end(), piece.items.begin(), piece.items.end());
            piece = {};
        }
        starts_.push_back(static_cast<std::uint32_t>(items_.size()));
        rows_.forget_items();
    }
    template <PrimitiveSet P>
    void divide_row(const P& set, const CellEntering<P>& outer, const Cell& cell, const Leaf& leaf,
                    Divided& piece) const {
        Inner inner = inner_for(set, outer, cell, leaf);
        inner.start = static_cast<std::uint32_t>(piece.starts.size());
        piece.inner.push_back(inner);
        const auto lattice = inner.lattice_in(rows_.lattice(), cell);
        const auto entering = outer.within(lattice);
        std::vector<CellEntry> entries;
        std::vector<std::uint32_t> ends(inner.cell_count(), 0);
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i)
            entering.for_each(leaf.ids[i], set.bounds(leaf.ids[i]), [&](const Cell& c) {
                entries.push_back({inner.number(c), leaf.ids[i]});
                ++ends[entries.back().cell];
            });
        auto sum = static_cast<std::uint32_t>(piece.items.size());
        for (auto& end : ends) {
            piece.starts.push_back(sum);
            sum += std::exchange(end, sum);
        }
        piece.items.resize(sum);
        for (const CellEntry& e : entries) piece.items[ends[e.cell]++] = e.id;
    }
    /// As many cells as the density asks for, but no more than what leaves a primitive in 8 of them: where
    /// many are as large as the cell, dividing parts none.
    template <PrimitiveSet P>
    Inner inner_for(const P& set, const CellEntering<P>& outer, const Cell& cell, const Leaf& leaf) const {
        const GridResolution wanted{.density = options_.inner_density};
        const auto whole = wanted.lattice_over(rows_.lattice().bounds(cell), leaf.count);
        Inner inner;
        for (std::size_t a = 0; a < D; ++a)
            inner.resolution[a] = static_cast<std::uint8_t>(std::min(whole.resolution[a], Inner::most_cells));
        while (inner.cell_count() > 1) {
            const auto lattice = inner.lattice_in(rows_.lattice(), cell);
            const auto entering = outer.within(lattice);
            std::uint64_t entries = 0;
            for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i)
                entries += entering.cells_reached(set.bounds(leaf.ids[i]));
            if (entries <= 8 * std::uint64_t(leaf.count)) break;
            for (auto& r : inner.resolution) r = static_cast<std::uint8_t>((r + 1) / 2);
        }
        return inner;
    }

    Options options_;
    Box<T, D> bounds_;
    CellRows<D> rows_;
    std::vector<Inner> inner_;           // by row
    std::vector<std::uint32_t> starts_;  // of each cell's items, and the end of the last
    std::vector<PrimitiveId> items_;
    std::size_t count_ = 0;
};

}  // namespace hedgerow
