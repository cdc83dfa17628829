/// Uniform grid: equal cells, each with the primitives that meet it.
#pragma once

#include <hedgerow/structures/grid/entering.h>
#include <hedgerow/structures/grid/resolution.h>
#include <hedgerow/walks/lattice.h>
#include <hedgerow/walks/mailbox.h>

namespace hedgerow {

/// Only occupied cells take memory (cell_rows.h). Built in O(n + cells/64) by counting. Memory: 4 bytes an
/// item and about 8 an occupied cell. A ray steps from cell to cell in integer coordinates (Amanatides and
/// Woo 1987; RayProbe::sweep). It crosses an empty brick of 4³ cells, or an empty block of 16³ (in the plane
/// 8² and 64²), in one step, as with the macro-cells of later grids (Jevans and Wyvill 1989 have a hierarchy
/// of them).
template <std::floating_point T, int D>
class Grid {
public:
    struct Options {
        GridResolution cells = {};
        GridInsert insert = GridInsert::exact;
        /// Skips most repeated tests of a primitive within a query. Off only to measure its effect.
        bool mailbox = true;
        /// Rays pass over an empty brick, or block of bricks, in one step. Off only to measure its effect.
        bool skip_empty = true;
        /// The most items of a grid for each primitive, at least 1. Where primitives are as large as the
        /// scene, or many are in one place, the grid has fewer cells than its heuristic gives, each with more
        /// items. So the build and its memory are bounded. A resolution set by hand is kept. Meshes need 25.
        double items_per_primitive = 32;
        /// Bytes that a build may take. A build that would take more throws InputError.
        double budget = 8e9;

        /// Lists the options (option.h).
        template <class Option>
        void list(Option& option) {
            cells.list<D>(option);
            list_entering(*this, option);
            option("skip_empty", skip_empty, "rays pass over a block of empty cells in one step");
        }
    };
    static constexpr auto packed_order = PackedOrder::of_ids;
    static constexpr bool exclusive() { return false; }

    template <PrimitiveSet P>
    static Grid build(const P& set, const Options& options, Executor& executor) {
        Grid grid;
        grid.options_ = options;
        grid.count_ = set.size();
        grid.bounds_ = bounds_of(set, executor);
        if (grid.empty()) return grid;
        const std::uint64_t most = most_items(options.items_per_primitive, grid.count_);
        grid.rows_ =
            enter_all(set, grid.bounds_, options.cells, options.insert, most, options.budget, executor);
        return grid;
    }

    const Box<T, D>& bounds() const { return bounds_; }
    std::span<const PrimitiveId> items() const { return rows_.items(); }
    std::size_t bytes() const { return rows_.bytes(); }
    std::size_t node_count() const { return empty() ? 0 : lattice().cell_count(); }
    std::size_t leaf_count() const { return rows_.occupied(); }
    int depth() const { return empty() ? 0 : 1; }
    bool empty() const { return count_ == 0; }
    const Lattice<D>& lattice() const { return rows_.lattice(); }
    /// The items of a cell.
    Leaf leaf(const typename Lattice<D>::Cell& cell) const {
        const std::uint32_t row = rows_.cursor().row(cell);
        return row == CellRows<D>::none ? Leaf{nullptr, 0, 0} : rows_.leaf(row);
    }

    template <class Primitives, Query Q, class Count>
    void walk(const Primitives& primitives, Q& query, Count& count) const {
        if (empty()) return;
        Mailboxed mailed(primitives, count, options_.mailbox);
        auto cursor = rows_.cursor();
        walk_lattice(lattice(), query, [&](const auto& cell) {
            const Place place{lattice().number(cell)};
            count.node(place);
            const std::uint32_t row = cursor.row(cell);
            if (row == CellRows<D>::none) return options_.skip_empty ? cursor.emptiness() : Flow::go_on;
            const Leaf leaf = rows_.leaf(row);
            count.leaf(leaf.count, place);
            return Looked(test_leaf(mailed, query.probe(), leaf, query));
        });
    }

    /// What is wrong with the structure; empty if nothing is.
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        if (set.size() != count_) return "not built over these primitives";
        if (empty()) return "";
        const CellEntering entering(set, lattice(), options_.insert, cell_margin(bounds_));
        auto cursor = rows_.cursor();
        std::size_t entries = 0;
        std::string fault;
        for (std::uint32_t p = 0; p < set.size(); ++p)
            entering.for_each(p, set.bounds(p), [&](const auto& cell) {
                ++entries;
                const std::uint32_t row = cursor.row(cell);
                const Leaf l = row == CellRows<D>::none ? Leaf{nullptr, 0, 0} : rows_.leaf(row);
                if (!std::binary_search(l.ids + l.first, l.ids + l.first + l.count, p))
                    fault = "primitive " + std::to_string(p) + " is missing from a cell that it meets";
                return true;
            });
        if (fault.empty() && entries != items().size()) fault = "a primitive in a cell that it does not meet";
        return fault;
    }

private:
    Options options_;
    Box<T, D> bounds_;
    CellRows<D> rows_;
    std::size_t count_ = 0;
};

}  // namespace hedgerow
