/// The occupied cells of a lattice, and the primitives in each.
#pragma once

#include <bit>

#include <hedgerow/geometry/lattice.h>
#include <hedgerow/probes/concepts.h>
#include <hedgerow/structures/references.h>

namespace hedgerow {

/// A primitive in a cell. `cell` is the cell's number in its lattice.
struct CellEntry {
    std::uint32_t cell;
    PrimitiveId id;
};

/// A subset of 64 numbered things, as bits. Its members lie side by side in a list, from index `first` on.
struct Present {
    static constexpr std::uint32_t none = 0xFFFFFFFFu;

    std::uint64_t bits = 0;
    std::uint32_t first = 0;

    /// The index of member i in the list, or `none`. It is `first` plus the number of members before i (the
    /// rank of its bit; Jacobson 1989).
    std::uint32_t find(std::uint32_t i) const {
        const std::uint64_t bit = std::uint64_t(1) << i;
        if ((bits & bit) == 0) return none;
        return first + static_cast<std::uint32_t>(std::popcount(bits & (bit - 1)));
    }
    /// Calls f(i, place) for each member i; `place` is its index in the list.
    template <class F>
    void for_each(F f) const {
        std::uint32_t place = first;
        for (std::uint64_t left = bits; left != 0; left &= left - 1, ++place)
            f(static_cast<std::uint32_t>(std::countr_zero(left)), place);
    }
};

/// Empty cells take almost no memory. A brick of 64 cells is stored only if one of them is occupied, and 16
/// bytes say which of 64 bricks are stored. Memory: 4 bytes an item, 4 an occupied cell, 16 an occupied
/// brick, and a byte for every 256 cells, occupied or not. That is so little that lookups in empty space stay
/// in the cache.
template <int D>
class CellRows {
public:
    CellRows() = default;

    /// Sorts entries into rows: by bricks, then by the cells of each brick. The entries of a row keep their
    /// order. O(n + bricks), empty bricks included. The pieces are read twice, in their order.
    CellRows(const Lattice<D>& lattice, const std::vector<std::vector<CellEntry>>& pieces, Executor& executor)
        : lattice_(lattice) {
        // Count the entries of each brick.
        std::vector<std::uint32_t> ends(std::size_t(64) * lattice.block_count() + 1, 0);
        for (const auto& piece : pieces) {
            executor.look();
            for (const CellEntry& e : piece) ++ends[e.cell >> 6];
        }
        // Turn the counts into the index of each brick's first entry.
        std::uint32_t sum = 0, bricks = 0;
        for (auto& end : ends) {
            bricks += end != 0;
            sum += end;
            end = sum - end;  // where its entries begin; after the sort, where they end
        }
        // Sort the entries by brick.
        BareVector<CellEntry> sorted(sum);
        for (const auto& piece : pieces) {
            executor.look();
            for (const CellEntry& e : piece) sorted[ends[e.cell >> 6]++] = e;
        }
        // Sort the entries of each brick by cell, and store them as rows.
        items_.resize(sum);
        bricks_.reserve(bricks);
        blocks_.resize(lattice.block_count());
        std::uint32_t begin = 0;
        for (std::uint32_t number = 0; number + 1 < ends.size(); ++number) {
            if (number % worth_a_task == 0) executor.look();
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
               (blocks_.capacity() + bricks_.capacity()) * sizeof(Present);
    }

    static constexpr std::uint32_t none = Present::none;
    Leaf leaf(std::uint32_t row) const {
        return {items_.data(), starts_[row], starts_[row + 1] - starts_[row]};
    }

    /// Calls f(cell, leaf) for the rows of a block of bricks, in the order of rows.
    template <class F>
    void for_each_row(std::size_t block, F f) const {
        blocks_[block].for_each([&](std::uint32_t brick, std::uint32_t at) {
            bricks_[at].for_each([&](std::uint32_t cell, std::uint32_t row) {
                f(lattice_.cell(static_cast<std::uint32_t>(block) << 12 | brick << 6 | cell), leaf(row));
            });
        });
    }
    std::size_t block_count() const { return blocks_.size(); }
    /// Keeps only which cells are occupied, and the numbers of their rows. The caller has the items
    /// elsewhere.
    void forget_items() {
        items_ = {};
        starts_ = {};
    }

    /// Looks up cells, and remembers the brick of the last one: a probe's next cell is seldom in another
    /// brick.
    class Cursor {
    public:
        explicit Cursor(const CellRows& rows) : rows_(rows) {}
        /// The row of a cell; `none` if it is empty.
        std::uint32_t row(const typename Lattice<D>::Cell& cell) {
            const std::uint32_t number = rows_.lattice_.number(cell);
            if (number >> 6 != at_) {
                at_ = number >> 6;
                const Present& block = rows_.blocks_[at_ >> 6];
                const std::uint32_t brick = block.find(at_ & 63);
                brick_ = brick == none ? Present{} : rows_.bricks_[brick];
                empty_bits_ = brick != none ? 0 : Lattice<D>::brick_bits << int(block.bits == 0);
            }
            return brick_.find(number & 63);
        }
        /// After the lookup of an empty cell, tells the sweep whether its brick is empty, or its whole block
        /// of bricks.
        Looked emptiness() const { return {Flow::go_on, empty_bits_}; }

    private:
        const CellRows& rows_;
        std::uint32_t at_ = none;
        Present brick_;
        int empty_bits_ = 0;
    };
    Cursor cursor() const { return Cursor(*this); }

private:
    void add_brick(std::uint32_t number, std::span<const CellEntry> entries, std::uint32_t first_item) {
        std::uint32_t at[64] = {};
        for (const CellEntry& e : entries) ++at[e.cell & 63];
        Present brick{0, static_cast<std::uint32_t>(starts_.size())};
        for (std::uint32_t cell = 0; cell < 64; ++cell) {
            if (at[cell] == 0) continue;
            brick.bits |= std::uint64_t(1) << cell;
            starts_.push_back(first_item);
            first_item += std::exchange(at[cell], first_item);
        }
        for (const CellEntry& e : entries) items_[at[e.cell & 63]++] = e.id;
        Present& block = blocks_[number >> 6];
        if (block.bits == 0) block.first = static_cast<std::uint32_t>(bricks_.size());
        block.bits |= std::uint64_t(1) << (number & 63);
        bricks_.push_back(brick);
    }

    Lattice<D> lattice_;
    std::vector<Present> blocks_;        // of 64 bricks each, empty blocks too
    std::vector<Present> bricks_;        // only those with occupied cells
    std::vector<std::uint32_t> starts_;  // first item of each row, and the end of the last
    BareVector<PrimitiveId> items_;
};

}  // namespace hedgerow
