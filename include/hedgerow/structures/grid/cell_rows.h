/// The occupied cells of a lattice and what stands in each.
#pragma once

#include <bit>

#include <hedgerow/geometry/lattice.h>
#include <hedgerow/structures/references.h>

namespace hedgerow {

/// A primitive in a cell, by the cell's number.
struct CellEntry {
    std::uint32_t cell;
    PrimitiveId id;
};

/// Empty cells take no room: a brick of 64 cells is there if one of them is occupied, and is found by hashing
/// its number; a bit for each cell says which are, and the bits before it where its row begins. Memory: 4
/// bytes an item, 4 an occupied cell, 32 to 48 an occupied brick.
template <int D>
class CellRows {
public:
    CellRows() = default;

    /// Sorts entries into rows: by bricks, then by the cells of each. In a row they keep their order. O(n +
    /// bricks), and `pieces` of entries are read twice in their order.
    CellRows(const Lattice<D>& lattice, const std::vector<std::vector<CellEntry>>& pieces)
        : lattice_(lattice) {
        std::vector<std::uint32_t> ends(lattice.brick_count() + 1, 0);
        for (const auto& piece : pieces)
            for (const CellEntry& e : piece) ++ends[e.cell >> 6];
        std::uint32_t sum = 0, bricks = 0;
        for (auto& end : ends) {
            bricks += end != 0;
            sum += end;
            end = sum - end;  // where its entries begin, until all are there
        }
        BareVector<CellEntry> sorted(sum);
        for (const auto& piece : pieces)
            for (const CellEntry& e : piece) sorted[ends[e.cell >> 6]++] = e;
        items_.resize(sum);
        bricks_.reserve(bricks);
        slots_.assign(std::bit_ceil(2 * std::size_t(bricks) + 1), none);
        std::uint32_t begin = 0;
        for (std::uint32_t number = 0; number + 1 < ends.size(); ++number) {
            if (ends[number] > begin)
                add_brick(number, std::span(sorted).subspan(begin, ends[number] - begin), begin);
            begin = ends[number];
        }
        starts_.push_back(sum);
        starts_.shrink_to_fit();
    }

    const Lattice<D>& lattice() const { return lattice_; }
    std::span<const PrimitiveId> items() const { return items_; }
    std::size_t occupied() const { return starts_.empty() ? 0 : starts_.size() - 1; }
    std::size_t bytes() const {
        return items_.capacity() * sizeof(PrimitiveId) + starts_.capacity() * sizeof(std::uint32_t) +
               bricks_.capacity() * sizeof(Brick) + slots_.capacity() * sizeof(std::uint32_t);
    }

    static constexpr std::uint32_t none = 0xFFFFFFFFu;
    Leaf leaf(std::uint32_t row) const {
        return {items_.data(), starts_[row], starts_[row + 1] - starts_[row]};
    }

    std::size_t brick_count() const { return bricks_.size(); }
    /// Calls f(cell, leaf) for the rows of some bricks, in the order of rows.
    template <class F>
    void for_each_row(std::size_t first_brick, std::size_t last_brick, F f) const {
        for (std::size_t b = first_brick; b < std::min(last_brick, bricks_.size()); ++b) {
            std::uint32_t row = bricks_[b].first;
            for (std::uint64_t left = bricks_[b].occupied; left != 0; left &= left - 1, ++row)
                f(lattice_.cell(bricks_[b].number << 6 | static_cast<std::uint32_t>(std::countr_zero(left))),
                  leaf(row));
        }
    }
    /// Keeps only which cells are occupied: the rows are somewhere else.
    void forget_items() {
        items_ = {};
        starts_ = {};
    }

    /// Finds cells, and remembers the brick that it was in: on its way a probe seldom leaves it.
    class Cursor {
    public:
        explicit Cursor(const CellRows& rows) : rows_(rows) {}
        /// The row of a cell; `none` if it is empty.
        std::uint32_t row(const typename Lattice<D>::Cell& cell) {
            const std::uint32_t number = rows_.lattice_.number(cell);
            if (number >> 6 != brick_.number) brick_ = rows_.find(number >> 6);
            const std::uint64_t bit = std::uint64_t(1) << (number & 63);
            if ((brick_.occupied & bit) == 0) return none;
            return brick_.first + static_cast<std::uint32_t>(std::popcount(brick_.occupied & (bit - 1)));
        }

    private:
        const CellRows& rows_;
        typename CellRows::Brick brick_{none, 0, 0};
    };
    Cursor cursor() const { return Cursor(*this); }

private:
    struct Brick {
        std::uint32_t number, first;  // first: the row of its first occupied cell
        std::uint64_t occupied;
    };

    void add_brick(std::uint32_t number, std::span<const CellEntry> entries, std::uint32_t first_item) {
        std::uint32_t at[64] = {};
        for (const CellEntry& e : entries) ++at[e.cell & 63];
        Brick brick{number, static_cast<std::uint32_t>(starts_.size()), 0};
        for (std::uint32_t cell = 0; cell < 64; ++cell) {
            if (at[cell] == 0) continue;
            brick.occupied |= std::uint64_t(1) << cell;
            starts_.push_back(first_item);
            first_item += std::exchange(at[cell], first_item);
        }
        for (const CellEntry& e : entries) items_[at[e.cell & 63]++] = e.id;
        std::size_t slot = first_slot(number);
        while (slots_[slot] != none) slot = (slot + 1) & (slots_.size() - 1);
        slots_[slot] = static_cast<std::uint32_t>(bricks_.size());
        bricks_.push_back(brick);
    }
    /// Fibonacci hashing (Knuth, vol. 3, 6.4).
    std::size_t first_slot(std::uint32_t number) const {
        return (number * std::uint64_t(0x9E3779B97F4A7C15)) >> 32 & (slots_.size() - 1);
    }
    Brick find(std::uint32_t number) const {
        for (std::size_t slot = first_slot(number); slots_[slot] != none;
             slot = (slot + 1) & (slots_.size() - 1))
            if (bricks_[slots_[slot]].number == number) return bricks_[slots_[slot]];
        return {number, 0, 0};
    }

    Lattice<D> lattice_;
    std::vector<Brick> bricks_;
    std::vector<std::uint32_t> slots_;   // of the hash table: positions in bricks_
    std::vector<std::uint32_t> starts_;  // of each row, and the end of the last
    BareVector<PrimitiveId> items_;
};

}  // namespace hedgerow
