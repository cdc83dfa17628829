/// The cells of some points in turn, each with the points of others around it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "cell_order.h"

namespace hedgerow::detail {

/// Points of an order from `first` to `end`, and what is added to their places to be beside a cell.
template <int D>
struct NearRun {
    std::uint32_t first, end;
    Vec<double, D> shift;
};

/// Visits the cells of points that ask, in their order, with the points of another order (or the same one)
/// over the same axes that are in the cell or in cells that touch it. No search is made for these: as the
/// cells of a row ascend, so do those beside them in the rows around it.
template <std::floating_point T, int D>
class CellSweep {
public:
    CellSweep(const CellOrder<T, D>& asking, const CellOrder<T, D>& asked)
        : asking_(asking), order_(asked), axes_(asked.axes()) {}

    /// Calls f(cell, numbers, runs) for each cell from number `begin` to `end`; `numbers` are its own along
    /// each axis. The runs ascend; together they are all points of cells that touch the cell, each once.
    /// Along a period with fewer than three cells every cell touches every other, and runs are not shifted.
    template <class F>
    void for_each_cell(std::size_t begin, std::size_t end, F f) {
        if (begin == end) return;
        const auto& rows = asking_.rows();
        auto row = std::prev(std::upper_bound(rows.begin(), rows.end(), begin,
                                              [](std::size_t c, const auto& r) { return c < r.first; }));
        for (std::size_t cell = begin; cell < end; ++row) {
            find_rows_around(*row);
            const std::size_t last = std::min<std::size_t>(end, std::next(row)->first);
            for (; cell < last; ++cell) {
                numbers_[0] = asking_.cells()[cell].number;
                f(cell, std::as_const(numbers_), runs_around(cell));
            }
        }
    }

private:
    using Row = typename CellOrder<T, D>::Row;
    /// A row around the present one: its cells from `begin` to `end`, and those that touch the present cell.
    struct Near {
        std::uint32_t begin, end, low, high;
        Vec<double, D> shift;
    };
    /// A number of a cell or row beside another along an axis, and the shift to it.
    struct Beside {
        std::uint32_t number;
        double shift;
    };
    struct AllBeside {
        std::array<Beside, 3> all;
        std::size_t count = 0;
        void add(std::uint32_t at, double shift) { all[count++] = {at, shift}; }
        auto begin() const { return all.begin(); }
        auto end() const { return all.begin() + static_cast<std::ptrdiff_t>(count); }
    };
    static AllBeside beside(std::uint32_t at, const CellAxis& axis) {
        AllBeside found;
        const std::uint32_t count = axis.count();
        const double period = axis.period();
        if (axis.wraps()) {
            for (std::uint32_t i = 0; i < count; ++i) found.add(i, 0);
            return found;
        }
        if (at > 0)
            found.add(at - 1, 0);
        else if (period > 0)
            found.add(count - 1, -period);
        found.add(at, 0);
        if (at + 1 < count)
            found.add(at + 1, 0);
        else if (period > 0)
            found.add(0, period);
        return found;
    }

    void find_rows_around(const Row& row) {
        near_count_ = 0;
        const auto [second, third] = axes_.numbers(row.number);
        numbers_[1] = second, numbers_[D - 1] = D == 3 ? third : second;
        AllBeside slabs;
        if constexpr (D == 3)
            slabs = beside(third, axes_[2]);
        else
            slabs.add(0, 0);
        std::size_t n = 0;
        for (const Beside& c : slabs)
            for (const Beside& b : beside(second, axes_[1])) {
                const auto& rows = order_.rows();
                const std::uint64_t number = axes_.row(b.number, c.number);
                const std::size_t i = place_of(number, hints_[n++]);
                if (rows[i].number != number || i + 1 == rows.size()) continue;
                Near& near = near_[near_count_++];
                near = {rows[i].first, rows[i + 1].first, rows[i].first, rows[i].first, {}};
                near.shift[1] = b.shift;
                if constexpr (D == 3) near.shift[2] = c.shift;
            }
        std::sort(near_.begin(), near_.begin() + static_cast<std::ptrdiff_t>(near_count_),
                  [](const Near& a, const Near& b) { return a.begin < b.begin; });
    }
    /// The place of the first row with at least a number, which is looked for from the last such place on.
    std::size_t place_of(std::uint64_t number, std::size_t& hint) const {
        const auto& rows = order_.rows();
        if (hint > 0 && rows[hint - 1].number >= number) hint = 0;
        for (std::size_t i = 0; i < few && rows[hint].number < number; ++i) ++hint;
        if (rows[hint].number < number)
            hint = static_cast<std::size_t>(
                std::lower_bound(rows.begin() + static_cast<std::ptrdiff_t>(hint), rows.end(), number,
                                 [](const Row& r, std::uint64_t a) { return r.number < a; }) -
                rows.begin());
        return hint;
    }

    std::span<const NearRun<D>> runs_around(std::size_t cell) {
        const auto& cells = order_.cells();
        const CellAxis& axis = axes_[0];
        const std::uint32_t at = asking_.cells()[cell].number, count = axis.count();
        const bool all = axis.wraps(), repeats = axis.period() > 0 && !all;
        std::size_t n = 0;
        const auto add = [&](std::uint32_t low, std::uint32_t high, const Near& near, double shift) {
            if (low == high) return;
            NearRun<D>& run = runs_[n++];
            run = {cells[low].first, cells[high].first, near.shift};
            run.shift[0] = shift;
        };
        for (std::size_t i = 0; i < near_count_; ++i) {
            Near& near = near_[i];
            if (all) {
                add(near.begin, near.end, near, 0);
                continue;
            }
            if (repeats && at == count - 1 && cells[near.begin].number == 0)
                add(near.begin, near.begin + 1, near, axis.period());
            // The part, or what asks, may begin in the middle of the row.
            if (near.low == near.begin && cells[near.begin].number + few < at)
                near.low = near.high = first_at(near.begin, near.end, at - 1);
            while (near.low < near.end && cells[near.low].number + 1 < at) ++near.low;
            near.high = std::max(near.low, near.high);
            while (near.high < near.end && cells[near.high].number <= at + 1) ++near.high;
            add(near.low, near.high, near, 0);
            if (repeats && at == 0 && cells[near.end - 1].number == count - 1)
                add(near.end - 1, near.end, near, -axis.period());
        }
        return {runs_.data(), n};
    }
    /// The first cell of a row at or after a number.
    std::uint32_t first_at(std::uint32_t begin, std::uint32_t end, std::uint32_t at) const {
        const auto* const all = order_.cells().data();
        return static_cast<std::uint32_t>(
            std::lower_bound(all + begin, all + end, at,
                             [](const auto& c, std::uint32_t a) { return c.number < a; }) -
            all);
    }
    static constexpr std::uint32_t few = 8;  // steps that are faster than a search

    const CellOrder<T, D>&asking_, &order_;
    const CellAxes<T, D>& axes_;
    std::array<std::uint32_t, D> numbers_;
    std::array<Near, 9> near_;
    std::array<std::size_t, 9> hints_ = {};
    std::array<NearRun<D>, 27> runs_;
    std::size_t near_count_ = 0;
};

}  // namespace hedgerow::detail
