/// Hash grid: points in cells of a given size, over unbounded space. Only occupied cells are stored.
#pragma once

#include <hedgerow/structures/grid/resolution.h>
#include <hedgerow/structures/hash_grid/cell_table.h>
#include <hedgerow/structures/references.h>
#include <hedgerow/walks/lattice.h>

namespace hedgerow {

struct HashGridOptions {
    /// Length of a cell's side, in the units of the points. Searches within a radius are fastest if it is
    /// about that radius. 0: chosen so that the occupied extent has half as many cells as points. A cell is
    /// at least a 2^29th of the extent.
    double cell = 0;

    /// Lists the options (option.h).
    template <class Option>
    void list(Option& option) {
        option("cell", cell, 0, 1e300,
               "length of a cell's side; 0: half as many cells as points in their extent");
    }
};

/// Points by the cell that contains them. A hash table leads from a cell to its points (Teschner,
/// Heidelberger, Müller, Pomeranets and Gross, Optimized spatial hashing for collision detection of
/// deformable objects, VMV 2003). Cells are stored with their coordinates, so that cells of equal hash are
/// not confused. It is built in O(n) without a sort, and is equally fast however far the particles spread.
/// For the neighbours of all particles at once, `neighbours_within` is many times faster (ask/neighbours.h).
///
/// Point and box queries look up the lattice's cells around them, within the extent of the occupied cells. A
/// search that has looked up as many cells as are occupied continues with the list of the occupied cells
/// instead, so no search takes longer than O(occupied cells + points). Rays are declined: without bounds on
/// what is empty they would have no end.
///
/// Memory: 4 bytes a point and 28 to 36 (in the plane 24 to 32) an occupied cell.
template <std::floating_point T, int D>
class HashGrid {
public:
    using Options = HashGridOptions;
    using Cell = typename Lattice<D>::Cell;
    static constexpr auto packed_order = PackedOrder::of_leaves;
    /// A search that continues in the list may offer a candidate twice.
    static constexpr bool exclusive() { return false; }
    template <class Probe>
    static constexpr bool answers = !std::same_as<Probe, RayProbe<T, D>>;

    /// Throws UsageError if `cell` is negative, infinite or NaN, and InputError for bad points. O(n).
    template <PointSet P>
    static HashGrid build(const P& set, const Options& options, Executor& executor) {
        if (!(options.cell >= 0) || !(options.cell <= std::numeric_limits<double>::max()))
            throw UsageError("cell=" + std::to_string(options.cell) + " is not a length of 0 or more");
        HashGrid grid;
        grid.bounds_ = bounds_of(set, executor);
        const std::size_t n = set.size();
        if (n == 0) return grid;
        static_cast<Lattice<D>&>(grid.lattice_) = lattice_over(grid.bounds_, n, options.cell);
        executor.expect(2 * n);

        // Number the cells in the order of their first point, and count the points of each.
        BareVector<std::uint32_t> cell_of(n);
        for (std::size_t i = 0; i < n; ++i) {
            if (i % worth_a_task == 0) executor.advance(std::min(n - i, worth_a_task));
            cell_of[i] = grid.cells_.insert(grid.cell_at(set.bounds(i).low));
            ++grid.cells_[cell_of[i]].count;
        }
        grid.cells_.shrink();
        grid.lattice_.most_skipped = grid.cells_.size();

        // Copy each point's id to the next place of its cell.
        std::uint32_t sum = 0;
        for (std::size_t c = 0; c < grid.cells_.size(); ++c) {
            grid.cells_[c].first = sum;
            sum += std::exchange(grid.cells_[c].count, 0);
        }
        grid.items_.resize(n);
        for (std::size_t i = 0; i < n; ++i) {
            if (i % worth_a_task == 0) executor.advance(std::min(n - i, worth_a_task));
            HashedCell<D>& row = grid.cells_[cell_of[i]];
            grid.items_[row.first + row.count++] = static_cast<PrimitiveId>(i);
        }
        return grid;
    }

    const Box<T, D>& bounds() const { return bounds_; }
    std::span<const PrimitiveId> items() const { return items_; }
    std::size_t bytes() const { return items_.capacity() * sizeof(PrimitiveId) + cells_.bytes(); }
    std::size_t node_count() const { return cells_.size(); }
    std::size_t leaf_count() const { return cells_.size(); }
    int depth() const { return items_.empty() ? 0 : 1; }
    /// Length of a cell's side.
    double cell_size() const { return lattice_.size[0]; }

    template <class Primitives, Query Q, class Count>
    void walk(const Primitives& primitives, Q& query, Count& count) const
        requires(answers<typename Q::Probe>) {
        if (items_.empty()) return;
        const auto& probe = query.probe();
        const auto test = [&](std::uint32_t number) {
            const HashedCell<D>& c = cells_[number];
            count.leaf(c.count, Place{number});
            return test_leaf(primitives, probe, Leaf{items_.data(), c.first, c.count}, query);
        };

        // Look up the cells around the probe, at most as many as are occupied.
        std::size_t looked_up = 0;
        walk_lattice(lattice_, query, [&](const Cell& cell) {
            if (++looked_up > cells_.size()) return Looked(Flow::stop);
            const std::uint32_t number = cells_.find(cell);
            count.node(Place{number});
            return Looked(number == CellTable<D>::none ? Flow::go_on : test(number));
        });
        if (looked_up <= cells_.size()) return;

        // Beyond that, visit the occupied cells instead.
        for (std::uint32_t number = 0; number < cells_.size(); ++number) {
            T at;
            count.node(Place{number});
            if (probe.enter(box_of(cells_[number].cell), query.limit(), at) && test(number) == Flow::stop)
                return;
        }
    }

    /// Calls f(number, box, leaf) for each occupied cell.
    template <class F>
    void for_each_cell(F f) const {
        for (std::uint32_t i = 0; i < cells_.size(); ++i)
            f(i, lattice_.bounds(cells_[i].cell), Leaf{items_.data(), cells_[i].first, cells_[i].count});
    }

    /// What is wrong with the structure; empty if nothing is. O(n).
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        if (set.size() != items_.size()) return "not built over these points";
        std::vector<std::uint8_t> seen(set.size());
        std::size_t items = 0;
        for (std::uint32_t number = 0; number < cells_.size(); ++number) {
            const HashedCell<D>& c = cells_[number];
            if (c.first != items || c.count == 0) return "a cell's points are not where they should be";
            items += c.count;
            if (items > items_.size()) return "cells hold more points than there are";
            if (cells_.find(c.cell) != number) return "a cell is not found by its coordinates";
            for (std::uint32_t i = c.first; i < items; ++i) {
                const PrimitiveId id = items_[i];
                if (id >= seen.size() || seen[id]++ != 0) return "a point is held twice";
                if (cell_at(set.bounds(id).low) != c.cell) return "a point is in another cell than its own";
            }
        }
        return items == items_.size() ? "" : "a point is in no cell";
    }

private:
    /// Cells of one size over the occupied extent. Points on a low side of the extent are in its cells 0.
    static Lattice<D> lattice_over(const Box<T, D>& bounds, std::size_t count, double cell) {
        constexpr double most_cells = 0x1p29;
        const Vec<double, D> low(bounds.low), extent = Vec<double, D>(bounds.high) - low;
        double side = cell > 0 ? cell : side_of_cells(extent, 0.5 * static_cast<double>(count));
        side = std::max({side, max_component(extent) / most_cells, 0x1p-1000});
        Lattice<D> lattice;
        lattice.low = low;
        lattice.size = Vec<double, D>::all(side);
        lattice.per_size = Vec<double, D>::all(1 / side);
        lattice.pad = lattice.size * Lattice<D>::inflation;
        for (int a = 0; a < D; ++a)
            lattice.resolution[static_cast<std::size_t>(a)] =
                static_cast<std::int32_t>(product(extent[a], lattice.per_size[a])) + 1;
        return lattice;
    }
    /// The side of cubes of which `cells` fill a box. Axes along which the box is flat do not count.
    static double side_of_cells(const Vec<double, D>& extent, double cells) {
        const double longest = max_component(extent);
        if (!(longest > 0)) return 1;
        return longest / SpannedAxes(extent / longest).cells_on_longest(cells);
    }
    Cell cell_at(const Vec<T, D>& p) const {
        Cell cell;
        for (int a = 0; a < D; ++a)
            cell[static_cast<std::size_t>(a)] = lattice_.coordinate(static_cast<double>(p[a]), a);
        return cell;
    }
    /// A box around the points of a cell: the cell's box, enlarged by more than the roundings of coordinates.
    Box<T, D> box_of(const Cell& cell) const {
        const Box<double, D> box = lattice_.bounds(cell);
        Box<T, D> around;
        for (int a = 0; a < D; ++a) {
            around.low[a] = rounded_down<T>(box.low[a] - lattice_.pad[a]);
            around.high[a] = rounded_up<T>(box.high[a] + lattice_.pad[a]);
        }
        return around;
    }

    Box<T, D> bounds_;
    VastLattice<D> lattice_;
    CellTable<D> cells_;
    BareVector<PrimitiveId> items_;
};

}  // namespace hedgerow
