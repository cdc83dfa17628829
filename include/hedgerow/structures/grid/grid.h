/// Uniform grid: equal cells, each with the primitives whose box meets it.
#pragma once

#include <hedgerow/structures/references.h>
#include <hedgerow/structures/walk_lattice.h>

namespace hedgerow {

/// About `density` cells a primitive, as cubic as the scene allows (Cleary and Wyvill 1988). Cells are rows
/// of one list, filled by a counting sort: O(n + cells). Memory: 4 bytes a cell and 4 an item.
template <std::floating_point T, int D>
class Grid {
public:
    struct Options {
        double density = 4;
        /// Cells on the longest axis; 0: by density.
        int resolution = 0;
    };
    static constexpr bool exclusive = false;

    template <PrimitiveSet P>
    static Grid build(const P& set, const Options& options, Executor& executor) {
        const auto references = references_of(set, executor);
        Grid grid;
        grid.count_ = references.size();
        if (references.empty()) return grid;
        for (const auto& r : references) grid.bounds_.expand(r.box());
        grid.choose(options);
        grid.starts_.assign(grid.lattice_.cell_count() + 1, 0);
        const auto for_each_entry = [&](auto f) {
            for (const auto& r : references) {
                const auto [first, last] = grid.cells_of(r.box());
                for_each_cell(first, last,
                              [&](const auto& cell) { return f(grid.lattice_.number(cell), r.id()), true; });
            }
        };
        std::uint64_t entries = 0;
        for_each_entry([&](std::size_t cell, PrimitiveId) { ++grid.starts_[cell], ++entries; });
        if (entries > 0xFFFFFFFFu)
            throw InputError("the grid would hold more than 2^32 entries: give it a lower resolution");
        std::uint32_t end = 0;
        for (auto& start : grid.starts_) start = end += start;
        grid.items_.resize(entries);
        for_each_entry([&](std::size_t cell, PrimitiveId id) { grid.items_[--grid.starts_[cell]] = id; });
        return grid;
    }

    const Box<T, D>& bounds() const { return bounds_; }
    std::span<const PrimitiveId> items() const { return items_; }
    std::size_t bytes() const {
        return starts_.capacity() * sizeof(std::uint32_t) + items_.capacity() * sizeof(PrimitiveId);
    }
    std::size_t node_count() const { return empty() ? 0 : lattice_.cell_count(); }
    std::size_t leaf_count() const {
        std::size_t occupied = 0;
        for (std::size_t i = 1; i < starts_.size(); ++i) occupied += starts_[i] != starts_[i - 1];
        return occupied;
    }
    int depth() const { return empty() ? 0 : 1; }

    // What the walk asks.
    bool empty() const { return starts_.empty(); }
    const Lattice<D>& lattice() const { return lattice_; }
    Leaf leaf(const typename Lattice<D>::Cell& cell) const {
        const std::size_t i = lattice_.number(cell);
        return {items_.data(), starts_[i], starts_[i + 1] - starts_[i]};
    }

    template <class Primitives, Query Q, class Count>
    void walk(const Primitives& primitives, Q& query, Count& count) const {
        if (query.limit() < 0) return;
        walk_lattice(*this, primitives, query, count);
    }

    /// What is wrong with the structure; empty if nothing is.
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        if (set.size() != count_) return "not built over these primitives";
        for (std::size_t p = 0; p < set.size(); ++p) {
            const auto [first, last] = cells_of(set.bounds(p));
            const bool complete = for_each_cell(first, last, [&](const auto& cell) {
                const Leaf l = leaf(cell);
                return std::find(l.ids + l.first, l.ids + l.first + l.count, p) != l.ids + l.first + l.count;
            });
            if (!complete) return "primitive " + std::to_string(p) + " is missing from a cell that it meets";
        }
        return "";
    }

private:
    using Cell = typename Lattice<D>::Cell;

    void choose(const Options& options) {
        const Vec<double, D> extent = Vec<double, D>(bounds_.high) - Vec<double, D>(bounds_.low);
        const double longest = max_component(extent);
        const double wanted = std::max(1.0, options.density * static_cast<double>(count_));
        // Axes along which the scene is flat get one cell; the others share the wanted number.
        double volume = 1;
        int axes = 0;
        for (int a = 0; a < D; ++a)
            if (extent[a] > 1e-3 * longest) volume = product(volume, extent[a] / longest), ++axes;
        const double per_length = axes == 0 ? 1
                                            : (axes == 1   ? wanted / volume
                                               : axes == 2 ? std::sqrt(wanted / volume)
                                                           : std::cbrt(wanted / volume));
        for (int a = 0; a < D; ++a) {
            const double share = longest > 0 ? extent[a] / longest : 0;
            const double cells = (options.resolution > 0 ? options.resolution : per_length) * share;
            const auto i = static_cast<std::size_t>(a);
            lattice_.resolution[i] =
                static_cast<std::int32_t>(std::clamp(cells, 1.0, D == 2 ? 32768.0 : 1024.0));
            lattice_.low[a] = static_cast<double>(bounds_.low[a]);
            lattice_.size[a] =
                extent[a] > 0 ? extent[a] / lattice_.resolution[i] : (longest > 0 ? longest : 1.0);
        }
    }
    /// The block of cells that a box, enlarged by the lattice's inflation, meets.
    std::pair<Cell, Cell> cells_of(const Box<T, D>& box) const {
        std::pair<Cell, Cell> block;
        for (int a = 0; a < D; ++a) {
            const double pad = product(Lattice<D>::inflation, lattice_.size[a]);
            block.first[static_cast<std::size_t>(a)] =
                lattice_.coordinate(static_cast<double>(box.low[a]) - pad, a);
            block.second[static_cast<std::size_t>(a)] =
                lattice_.coordinate(static_cast<double>(box.high[a]) + pad, a);
        }
        return block;
    }

    Box<T, D> bounds_;
    Lattice<D> lattice_;
    std::vector<std::uint32_t> starts_;
    std::vector<PrimitiveId> items_;
    std::size_t count_ = 0;
};

}  // namespace hedgerow
