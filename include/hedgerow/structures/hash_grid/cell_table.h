/// The occupied cells of an unbounded lattice, found by hashing.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include <hedgerow/base/bare_vector.h>

namespace hedgerow {

/// A cell by its integer coordinates, and its items: `count` from `first` on.
template <int D>
struct HashedCell {
    std::array<std::int32_t, static_cast<std::size_t>(D)> cell;
    std::uint32_t first, count;
};

/// Cells in the order in which they were first inserted, and an open-addressing table of their numbers
/// (linear probing: Knuth, vol. 3, 6.4) that is at most half full. Memory after `shrink`: 4·D + 8 bytes a
/// cell, and 8 to 16 in the table.
template <int D>
class CellTable {
public:
    using Cell = std::array<std::int32_t, static_cast<std::size_t>(D)>;
    static constexpr std::uint32_t none = 0xFFFFFFFFu;

    std::size_t size() const { return cells_.size(); }
    std::size_t bytes() const {
        return cells_.capacity() * sizeof(HashedCell<D>) + slots_.capacity() * sizeof(std::uint32_t);
    }
    const HashedCell<D>& operator[](std::size_t i) const { return cells_[i]; }
    HashedCell<D>& operator[](std::size_t i) { return cells_[i]; }

    /// The number of a cell, or none. O(1) expected.
    std::uint32_t find(const Cell& cell) const { return slots_.empty() ? none : slots_[slot_of(cell)]; }
    /// The number of a cell, which is added if it is new. O(1) expected, amortized.
    std::uint32_t insert(const Cell& cell) {
        if (2 * (cells_.size() + 1) > slots_.size()) resize(std::max<std::size_t>(16, 4 * cells_.size()));
        std::uint32_t& number = slots_[slot_of(cell)];
        if (number == none) {
            number = static_cast<std::uint32_t>(cells_.size());
            cells_.push_back({cell, 0, 0});
        }
        return number;
    }
    /// Frees the memory that insertions have reserved beyond need.
    void shrink() {
        cells_.shrink_to_fit();
        resize(2 * cells_.size());
    }

private:
    /// The slot of a cell, or the empty slot where it belongs.
    std::size_t slot_of(const Cell& cell) const {
        // Multiplicative hashing of the coordinates in turn; the topmost bits depend on all of them.
        std::uint64_t hash = 0;
        for (const std::int32_t c : cell)
            hash = std::rotl((hash ^ static_cast<std::uint32_t>(c)) * 0x9E3779B97F4A7C15u, 29);
        hash *= 0x9E3779B97F4A7C15u;
        std::size_t slot = static_cast<std::size_t>(hash >> shift_);
        while (slots_[slot] != none && cells_[slots_[slot]].cell != cell)
            slot = (slot + 1) & (slots_.size() - 1);
        return slot;
    }
    void resize(std::size_t least) {
        const std::size_t size = std::bit_ceil(std::max<std::size_t>(least, 2));
        shift_ = 64 - std::countr_zero(size);
        slots_ = std::vector<std::uint32_t>(size, none);
        for (std::uint32_t i = 0; i < cells_.size(); ++i) slots_[slot_of(cells_[i].cell)] = i;
    }

    std::vector<HashedCell<D>> cells_;
    std::vector<std::uint32_t> slots_;
    int shift_ = 0;
};

}  // namespace hedgerow
