/// A regular grid of equal cells over a box. Cells are numbered by bricks.
#pragma once

#include <array>
#include <cstdint>

#include <hedgerow/geometry/box.h>

namespace hedgerow {

/// A grid of cells. Coordinates are double whatever the scene's scalar. Points outside the box belong to the
/// nearest cell.
template <int D>
struct Lattice {
    using Cell = std::array<std::int32_t, static_cast<std::size_t>(D)>;

    Vec<double, D> low, size, per_size;  // the box's low corner, a cell's size (> 0), 1 / size
    Cell resolution{};
    /// A primitive is inserted into every cell that is this near to it along each axis. So a probe that errs
    /// by less than half of `pad` need not visit the neighbours of the cells on its way.
    Vec<double, D> pad;

    /// The default `pad`, in cells.
    static constexpr double inflation = 0x1p-7;

    /// A lattice of `resolution` cells over a box. Along an axis in which the box is flat there must be one
    /// cell.
    template <std::floating_point T>
    static Lattice over(const Box<T, D>& box, const Cell& resolution) {
        const Vec<double, D> extent = Vec<double, D>(box.high) - Vec<double, D>(box.low);
        // Along a flat axis a cell is as thick as the thinnest that a divided axis has in space: 1/1024 of
        // the largest extent (or of 2^-10 of the magnitude of box.low, if more). Rays beside the box pass by.
        const double thin =
            std::max(max_component(extent), 0x1p-10 * max_component(abs(Vec<double, D>(box.low)))) / 1024;
        Lattice lattice;
        lattice.resolution = resolution;
        for (int a = 0; a < D; ++a) {
            lattice.low[a] = static_cast<double>(box.low[a]);
            const double size = extent[a] > 0 ? extent[a] / resolution[static_cast<std::size_t>(a)] : thin;
            lattice.size[a] = std::max(size, 0x1p-1000);  // so that per_size is finite
            lattice.per_size[a] = 1 / lattice.size[a];
        }
        lattice.pad = lattice.size * inflation;
        return lattice;
    }

    /// A lattice with half as many cells along each axis, rounded up, over the same box.
    template <std::floating_point T>
    Lattice halved(const Box<T, D>& box) const {
        Cell fewer = resolution;
        for (auto& r : fewer) r = (r + 1) / 2;
        return over(box, fewer);
    }

    /// Cells are numbered within bricks of 4³ cells (in the plane 8²), and bricks within blocks of as many
    /// bricks. So one 64-bit word has a bit for each cell of a brick, or for each brick of a block.
    static constexpr int brick_bits = D == 3 ? 2 : 3;
    /// The most cells along an axis, so that cell numbers have 30 bits.
    static constexpr std::int32_t most_cells = D == 3 ? 1024 : 32768;

    /// The cell of a coordinate along an axis; the nearest if x is outside the box.
    std::int32_t coordinate(double x, int axis) const {
        const double c = product(x - low[axis], per_size[axis]);
        const double last = resolution[static_cast<std::size_t>(axis)] - 1;
        const double inside = c > 0 ? (c < last ? c : last) : 0;
        return static_cast<std::int32_t>(inside);
    }
    /// The coordinate of the low plane of cell i along an axis.
    double plane(std::int32_t i, int axis) const { return low[axis] + product(double(i), size[axis]); }
    /// The number of a cell: from the low bits up, 6 for the cell in its brick, 6 for the brick in its block,
    /// then the block's number.
    std::uint32_t number(const Cell& c) const {
        std::uint32_t block = 0, brick = 0, inside = 0;
        for (std::size_t a = D; a-- > 0;) {
            const auto x = static_cast<std::uint32_t>(c[a]);
            block = block * blocks(a) + (x >> 2 * brick_bits);
            brick = brick << brick_bits | (x >> brick_bits & in_brick);
            inside = inside << brick_bits | (x & in_brick);
        }
        return block << 12 | brick << 6 | inside;
    }
    /// The cell with a number.
    Cell cell(std::uint32_t number) const {
        Cell c;
        std::uint32_t block = number >> 12, brick = number >> 6 & 63, inside = number & 63;
        for (std::size_t a = 0; a < D; ++a) {
            c[a] = static_cast<std::int32_t>(
                (block % blocks(a) << brick_bits | (brick & in_brick)) << brick_bits | (inside & in_brick));
            block /= blocks(a), brick >>= brick_bits, inside >>= brick_bits;
        }
        return c;
    }
    std::uint32_t block_count() const {
        std::uint32_t n = 1;
        for (std::size_t a = 0; a < D; ++a) n *= blocks(a);
        return n;
    }
    std::size_t cell_count() const {
        std::size_t n = 1;
        for (const auto r : resolution) n *= static_cast<std::size_t>(r);
        return n;
    }
    Box<double, D> bounds(const Cell& c) const {
        Box<double, D> b;
        for (int a = 0; a < D; ++a) {
            b.low[a] = plane(c[static_cast<std::size_t>(a)], a);
            b.high[a] = plane(c[static_cast<std::size_t>(a)] + 1, a);
        }
        return b;
    }

private:
    static constexpr std::uint32_t in_brick = (1u << brick_bits) - 1;

    std::uint32_t blocks(std::size_t a) const {
        return (static_cast<std::uint32_t>(resolution[a]) + (1u << 2 * brick_bits) - 1) >> 2 * brick_bits;
    }
};

/// A lattice with so many cells that a sweep must not go through all that its region is near. After
/// `most_skipped` cells that it would pass over, the sweep visits such cells too, and the visit may stop it.
template <int D>
struct VastLattice : Lattice<D> {
    std::size_t most_skipped = 0;
};

/// Moves c to the next cell of the block from `first` to `last`, both included. Returns false after the last
/// cell.
template <class Cell>
bool next_in_block(Cell& c, const Cell& first, const Cell& last) {
    std::size_t a = 0;
    while (a < c.size() && c[a] == last[a]) c[a] = first[a], ++a;
    if (a == c.size()) return false;
    ++c[a];
    return true;
}
/// Calls f(cell) for every cell of the block from `first` to `last`, both included, until f returns false.
/// Returns false if f did, else true.
template <class Cell, class F>
bool for_each_cell(const Cell& first, const Cell& last, F f) {
    Cell c = first;
    do {
        if (!f(c)) return false;
    } while (next_in_block(c, first, last));
    return true;
}
/// The same for the cells of a lattice's block of which reaches(cell) is true. A lattice too vast to look at
/// all cells says how many may be passed over (`most_skipped`); f is called for all after these.
template <class Cells, class Cell, class Reaches, class F>
bool for_each_reached_cell(const Cells& lattice, const Cell& first, const Cell& last, Reaches reaches, F f) {
    [[maybe_unused]] std::size_t skipped = 0;
    return for_each_cell(first, last, [&](const Cell& cell) {
        if (reaches(cell)) return f(cell);
        if constexpr (requires { lattice.most_skipped; })
            return skipped++ < lattice.most_skipped || f(cell);
        else
            return true;
    });
}

}  // namespace hedgerow
