/// Two-level grid: a coarse grid whose cells contain grids of their own.
#pragma once

#include <hedgerow/structures/grid/grid.h>

namespace hedgerow {

/// For scenes with detail in few places (Jevans and Wyvill 1989; built from sorted pairs as in Kalojanov,
/// Billeter, Slusallek, EG 2011). A grid of the second level covers the bounds of the parts in it, not the
/// whole cell. A cell with large and small parts has a grid for each (by size, as Cazals, Drettakis and Puech
/// 1995 divide a scene). So if one cell contains a teapot and the grass of the stadium around it, the teapot
/// has cells of a teapot's size, and the grass has its own.
///
/// Memory: the first level takes as much as a Grid without its items. The second level takes 4 bytes an item,
/// 4 a cell, empty or not, and 32 a grid (in space, float); each occupied cell has one or two grids. One
/// thread builds the grids of a cell.
template <std::floating_point T, int D>
class TwoLevelGrid {
public:
    struct Options {
        /// Cells of the first level. Kalojanov et al. use a density of 0.12.
        GridResolution cells = {.density = 0.12};
        /// Cells of the second level for each primitive in a cell. Kalojanov et al. use 2.4.
        double inner_density = 2.4;
        GridInsert insert = GridInsert::exact;
        /// Skips most repeated tests of a primitive within a query. Off only to measure its effect.
        bool mailbox = true;
        /// The most items for each primitive, at least 1. The first level may have an eighth of that, and a
        /// grid of the second level 8 items for each part in it. Where primitives are as large as the scene,
        /// or many are in one place, there are fewer cells than requested, each with more items. So the build
        /// and its memory are bounded. A resolution of the first level set by hand is kept. Meshes need 13.
        double items_per_primitive = 64;
        /// Bytes that a build may take. A build that would take more throws InputError.
        double budget = 8e9;

        /// Lists the options (option.h).
        template <class Option>
        void list(Option& option) {
            cells.list<D>(option);
            option("inner_density", inner_density, 1e-9, 1e6, "cells a primitive, of the second level");
            list_entering(*this, option);
        }
    };
    static constexpr auto packed_order = PackedOrder::of_ids;
    static constexpr bool exclusive() { return false; }

    template <PrimitiveSet P>
    static TwoLevelGrid build(const P& set, const Options& options, Executor& executor) {
        TwoLevelGrid grid;
        grid.options_ = options;
        grid.count_ = set.size();
        grid.bounds_ = bounds_of(set, executor);
        if (grid.empty()) return grid;
        grid.margin_ = cell_margin(grid.bounds_);
        const std::uint64_t most = most_items(options.items_per_primitive, grid.count_);
        const std::uint64_t of_first = std::max<std::uint64_t>(most / most_cells_a_part, grid.count_);
        grid.rows_ =
            enter_all(set, grid.bounds_, options.cells, options.insert, of_first, options.budget, executor);
        grid.divide(set, executor);
        return grid;
    }

    const Box<T, D>& bounds() const { return bounds_; }
    std::span<const PrimitiveId> items() const { return items_; }
    std::size_t bytes() const {
        return rows_.bytes() + inner_.capacity() * sizeof(Inner) +
               (first_inner_.capacity() + starts_.capacity()) * sizeof(std::uint32_t) +
               items_.capacity() * sizeof(PrimitiveId);
    }
    /// Cells of both levels.
    std::size_t node_count() const { return empty() ? 0 : rows_.lattice().cell_count() + starts_.size() - 1; }
    std::size_t leaf_count() const {
        std::size_t occupied = 0;
        for (std::size_t i = 1; i < starts_.size(); ++i) occupied += starts_[i] != starts_[i - 1];
        return occupied;
    }
    int depth() const { return empty() ? 0 : 2; }
    bool empty() const { return count_ == 0; }
    const Lattice<D>& lattice() const { return rows_.lattice(); }
    /// Empty: the items of a cell of the first level are all in its grids.
    Leaf leaf(const typename Lattice<D>::Cell&) const { return {nullptr, 0, 0}; }
    /// Calls f(lattice, leaf_of, place_of) for each grid in a cell of the first level. leaf_of(c) returns the
    /// items of the grid's cell c, and place_of(c) its Place in walks.
    template <class F>
    void for_each_lattice_in(const typename Lattice<D>::Cell& cell, F f) const {
        for (const Inner& inner : grids_in(rows_.cursor().row(cell)))
            f(
                inner.lattice(margin_), [&](const auto& c) { return leaf(inner.start_of(c)); },
                [&](const auto& c) { return place_of(inner.start_of(c)); });
    }

    template <class Primitives, Query Q, class Count>
    void walk(const Primitives& primitives, Q& query, Count& count) const {
        if (empty()) return;
        Mailboxed mailed(primitives, count, options_.mailbox);
        auto cursor = rows_.cursor();
        walk_lattice(lattice(), query, [&](const auto& cell) {
            count.node(Place{lattice().number(cell)});
            Flow flow = Flow::go_on;
            const std::uint32_t row = cursor.row(cell);
            if (row == CellRows<D>::none) return cursor.emptiness();
            // Walk the grids in an occupied cell, until the query stops.
            for (const Inner& inner : grids_in(row))
                if (flow == Flow::go_on)
                    flow = walk_lattice(inner.lattice(margin_), query, [&](const auto& c) {
                        const Leaf found = leaf(inner.start_of(c));
                        const Place place = place_of(inner.start_of(c));
                        count.node(place);
                        if (found.count == 0) return Flow::go_on;
                        count.leaf(found.count, place);
                        return test_leaf(mailed, query.probe(), found, query);
                    });
            return Looked(flow);
        });
    }

    /// What is wrong with the structure; empty if nothing is.
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        if (set.size() != count_) return "not built over these primitives";
        if (empty()) return "";
        const CellEntering entering(set, lattice(), options_.insert, margin_);
        auto cursor = rows_.cursor();
        std::string fault;
        const auto holds = [&](std::uint32_t start, PrimitiveId p) {
            return std::binary_search(items_.begin() + starts_[start], items_.begin() + starts_[start + 1],
                                      p);
        };
        // Each part must be in a grid that covers it, in every cell that it reaches there.
        for (PrimitiveId p = 0; p < set.size() && fault.empty(); ++p)
            entering.for_each(p, set.bounds(p), [&](const auto& cell) {
                const auto part = entering.part(p, cell);
                bool held = part.empty();
                for (const Inner& inner : grids_in(cursor.row(cell))) {
                    if (held || !inner.parts.contains(part)) continue;
                    const auto lattice = inner.lattice(margin_);
                    held = true;
                    entering.within(lattice).for_each(
                        p, part, [&](const auto& c) { return held = held && holds(inner.start_of(c), p); });
                }
                if (!held) fault = "primitive " + std::to_string(p) + " is missing from a cell that it meets";
                return held;
            });
        return fault;
    }

private:
    using Cell = typename Lattice<D>::Cell;
    /// The most cells of a grid of the second level that a part is in, on average.
    static constexpr std::uint64_t most_cells_a_part = 8;

    /// A grid in a cell of the first level: the index in `starts_` of its first cell, and its number of cells
    /// along each axis.
    struct Inner {
        static constexpr std::int32_t most_cells = 255;
        Box<T, D> parts;  // bounds of the parts in it
        std::uint32_t start = 0;
        std::array<std::uint8_t, static_cast<std::size_t>(D)> resolution{};

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
        std::uint32_t start_of(const Cell& c) const { return start + number(c); }
        /// Inner cells can be smaller than the numeric error of an answer, so the pad is at least that error.
        Lattice<D> lattice(T margin) const {
            Cell along;
            for (std::size_t a = 0; a < D; ++a) along[a] = resolution[a];
            auto lattice = Lattice<D>::over(parts, along);
            lattice.pad = max(lattice.pad, Vec<double, D>::all(static_cast<double>(margin)));
            return lattice;
        }
    };
    /// A primitive's part in a cell of the first level.
    struct Part {
        Box<T, D> box;
        PrimitiveId id;
    };
    /// The second level of some rows of the first. Indexes count from 0 until all are joined.
    struct Divided {
        std::vector<std::uint32_t> first_inner;
        std::vector<Inner> inner;
        std::vector<std::uint32_t> starts;
        std::vector<PrimitiveId> items;
    };

    std::span<const Inner> grids_in(std::uint32_t row) const {
        if (row == CellRows<D>::none) return {};
        return std::span(inner_).subspan(first_inner_[row], first_inner_[row + 1] - first_inner_[row]);
    }
    Leaf leaf(std::uint32_t start) const {
        return {items_.data(), starts_[start], starts_[start + 1] - starts_[start]};
    }
    /// The place of a cell of the second level.
    static Place place_of(std::uint32_t start) { return {start, 1}; }

    /// Builds the second level.
    template <PrimitiveSet P>
    void divide(const P& set, Executor& executor) {
        const CellEntering entering(set, lattice(), options_.insert, margin_);
        std::vector<Divided> pieces(rows_.block_count());
        executor.expect(rows_.items().size());
        // Divide the rows of each block of bricks.
        executor.for_each_piece(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t p = begin; p < end; ++p) {
                std::size_t done = 0;
                rows_.for_each_row(p, [&](const Cell& cell, const Leaf& leaf) {
                    divide_row(entering, cell, leaf, pieces[p]);
                    done += leaf.count;
                    if (done >= worth_a_task) executor.advance(std::exchange(done, 0));
                });
                executor.advance(done);
            }
        });
        // Join the pieces in their order, and shift their indexes.
        for (Divided& piece : pieces) {
            refuse_beyond(options_.budget, items_.size() + piece.items.size());
            for (const std::uint32_t first : piece.first_inner)
                first_inner_.push_back(first + static_cast<std::uint32_t>(inner_.size()));
            for (Inner i : piece.inner) {
                i.start += static_cast<std::uint32_t>(starts_.size());
                inner_.push_back(i);
            }
            for (const std::uint32_t s : piece.starts)
                starts_.push_back(s + static_cast<std::uint32_t>(items_.size()));
            items_.insert(items_.end(), piece.items.begin(), piece.items.end());
            piece = {};
        }
        first_inner_.push_back(static_cast<std::uint32_t>(inner_.size()));
        starts_.push_back(static_cast<std::uint32_t>(items_.size()));
        rows_.forget_items();
    }
    template <PrimitiveSet P>
    void divide_row(const CellEntering<P>& entering, const Cell& cell, const Leaf& leaf,
                    Divided& piece) const {
        std::vector<Part> parts;
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i)
            if (const auto box = entering.part(leaf.ids[i], cell); !box.empty())
                parts.push_back({box, leaf.ids[i]});
        const std::size_t large = part_by_size(parts, lattice().bounds(cell).half_area());
        piece.first_inner.push_back(static_cast<std::uint32_t>(piece.inner.size()));
        add_grid(entering, std::span(parts).first(large), piece);
        add_grid(entering, std::span(parts).subspan(large), piece);
    }
    /// Sorts parts, large ones first, and returns how many of them get a grid of their own. The choice
    /// minimizes the expected work of a ray through the cell, whose half area is given. The ray meets the
    /// bounds of n parts with the chance that the SAH gives. Then it walks through some ∛n of their cells (in
    /// the plane √n), and tests as many parts.
    static std::size_t part_by_size(std::vector<Part>& parts, double cell_half_area) {
        const auto size = [](const Part& p) { return max_component(p.box.extent()); };
        std::ranges::sort(parts, [&](const Part& a, const Part& b) {
            return size(a) != size(b) ? size(a) > size(b) : a.id < b.id;
        });
        // The expected work of a grid over n parts.
        const auto work = [&](std::size_t n, const Box<T, D>& bounds) {
            if (n == 0) return 0.0;
            const double chance = static_cast<double>(bounds.half_area()) / cell_half_area;
            return 1 + 2 * chance * std::pow(static_cast<double>(n), 1.0 / D);
        };
        // The work of the grid of small parts, for each number k of large ones.
        std::vector<double> work_of_small(parts.size() + 1, 0);
        Box<T, D> bounds;
        for (std::size_t k = parts.size(); k-- > 0;)
            work_of_small[k] = work(parts.size() - k, bounds.expand(parts[k].box));
        // Choose the k of least work in both grids.
        std::size_t best = 0;
        double least = std::numeric_limits<double>::infinity();
        bounds = {};
        for (std::size_t k = 0; k < parts.size(); ++k) {
            if (const double all = work(k, bounds) + work_of_small[k]; all < least) least = all, best = k;
            bounds.expand(parts[k].box);
        }
        return best;
    }
    template <PrimitiveSet P>
    void add_grid(const CellEntering<P>& entering, std::span<const Part> parts, Divided& piece) const {
        if (parts.empty()) return;
        // Choose the grid's bounds and resolution.
        Inner inner;
        for (const Part& part : parts) inner.parts.expand(part.box);
        inner.start = static_cast<std::uint32_t>(piece.starts.size());
        set_resolution(inner, parts, entering);
        piece.inner.push_back(inner);

        // Insert the parts, and sort the entries by cell.
        const auto lattice = inner.lattice(margin_);
        std::vector<CellEntry> entries;
        for (const Part& part : parts)
            entering.within(lattice).for_each(part.id, part.box, [&](const Cell& c) {
                entries.push_back({inner.number(c), part.id});
                return true;
            });
        std::ranges::sort(entries, {}, [](const CellEntry& e) { return std::pair(e.cell, e.id); });
        // Append the items of each cell, empty cells included.
        auto entry = entries.begin();
        for (std::uint32_t c = 0; c < inner.cell_count(); ++c) {
            piece.starts.push_back(static_cast<std::uint32_t>(piece.items.size()));
            for (; entry != entries.end() && entry->cell == c; ++entry) piece.items.push_back(entry->id);
        }
    }
    /// As many cells as the density gives, but so few that a part's box reaches at most 8 of them on average,
    /// or at most `items_per_primitive` if that is less. Where many parts are as large as their common
    /// bounds, more cells would not separate them.
    template <PrimitiveSet P>
    void set_resolution(Inner& inner, std::span<const Part> parts, const CellEntering<P>& entering) const {
        const GridResolution wanted{.density = options_.inner_density};
        const auto along = wanted.lattice_over(inner.parts, parts.size()).resolution;
        for (std::size_t a = 0; a < D; ++a)
            inner.resolution[a] = static_cast<std::uint8_t>(std::min(along[a], Inner::most_cells));
        const auto most =
            static_cast<std::uint64_t>(std::min<double>(most_cells_a_part, options_.items_per_primitive));
        while (inner.cell_count() > 1) {
            const auto lattice = inner.lattice(margin_);
            std::uint64_t entries = 0;
            for (const Part& part : parts) entries += entering.within(lattice).cells_reached(part.box);
            if (entries <= most * parts.size()) return;
            for (auto& r : inner.resolution) r = static_cast<std::uint8_t>((r + 1) / 2);
        }
    }

    Options options_;
    Box<T, D> bounds_;
    CellRows<D> rows_;
    std::vector<std::uint32_t> first_inner_;  // first grid of each row, and the end of the last
    std::vector<Inner> inner_;
    std::vector<std::uint32_t> starts_;  // first item of each cell, and the end of the last
    std::vector<PrimitiveId> items_;
    T margin_ = T(0);
    std::size_t count_ = 0;
};

}  // namespace hedgerow
