/// Points in the order of cells in rows: the first axis runs fastest, the last slowest.
#pragma once

#include <array>
#include <atomic>
#include <vector>

#include <hedgerow/base/bare_vector.h>
#include <hedgerow/parallel/radix_sort.h>
#include <hedgerow/parallel/select.h>
#include <hedgerow/primitives/concepts.h>

#include "cell_axes.h"

namespace hedgerow::detail {

/// Points sorted by cells, and the cells and rows that hold any. Points of a cell keep their order. Takes
/// O(n) time by a radix sort, and 4·D + 4 bytes a point (8·D + 4 of doubles).
template <std::floating_point T, int D>
class CellOrder {
public:
    using Points = Strided<Vec<T, D>>;
    /// A cell that begins at a point, and its number along the first axis.
    struct Cell {
        std::uint32_t first, number;
    };
    /// A row that begins at a cell, and its number.
    struct Row {
        std::uint64_t number;
        std::uint32_t first;
    };
    /// Numbers that may be read beyond the last coordinate.
    static constexpr std::size_t padding = 16;

    /// Sorts points, which must outlive the order, as the axes must.
    CellOrder(const Points& points, const CellAxes<T, D>& axes, Executor& executor)
        : points_(points), axes_(axes), order_(points.size()) {
        if (axes.key_bits() <= 32) {
            // The number of a point below its key.
            sort([](std::uint64_t key, std::size_t i) { return key << 32 | i; },
                 [](std::uint64_t e) { return e >> 32; },
                 [](std::uint64_t e) { return static_cast<PrimitiveId>(e); }, executor);
        } else {
            sort(
                [](std::uint64_t key, std::size_t i) {
                    return Keyed{key, static_cast<PrimitiveId>(i)};
                },
                [](const Keyed& e) { return e.key; }, [](const Keyed& e) { return e.id; }, executor);
        }
        copy_coordinates(executor);
    }

    std::size_t size() const { return order_.size(); }
    const CellAxes<T, D>& axes() const { return axes_; }
    /// The number of each point in the caller's array.
    const BareVector<PrimitiveId>& order() const { return order_; }
    /// Coordinates along an axis, within the period.
    const T* along(int axis) const { return at_[static_cast<std::size_t>(axis)].data(); }
    /// A point as it was given.
    Vec<T, D> point(std::size_t i) const {
        if (wrapped_) return points_[order_[i]];
        Vec<T, D> p;
        for (int k = 0; k < D; ++k) p[k] = along(k)[i];
        return p;
    }
    /// Whether coordinates were wrapped into the period, and so rounded.
    bool wrapped() const { return wrapped_; }
    /// The cells and the rows, ascending, and one more that ends the last.
    const BareVector<Cell>& cells() const { return cells_; }
    const std::vector<Row>& rows() const { return rows_; }

private:
    struct Keyed {
        std::uint64_t key;
        PrimitiveId id;
    };
    /// Sorts elements that make(key, id) makes.
    template <class Make, class KeyOf, class IdOf>
    void sort(Make make, KeyOf key_of, IdOf id_of, Executor& executor) {
        const std::size_t n = points_.size();
        BareVector<decltype(make(0, 0))> elements(n);
        axes_.with_keys([&](auto key_of_point) {
            executor.for_each_piece(n, worth_a_task, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) elements[i] = make(key_of_point(points_[i]), i);
            });
        });
        radix_sort(elements, key_of, 0, axes_.key_bits(), executor);
        executor.for_each_piece(n, worth_a_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) order_[i] = id_of(elements[i]);
        });
        find_cells([&](std::size_t i) { return key_of(elements[i]); }, executor);
    }
    /// Finds the cells and the rows of sorted points with these keys.
    template <class KeyOf>
    void find_cells(KeyOf key_of, Executor& executor) {
        BareVector<std::uint32_t> firsts, first_cells;
        select_numbers(size(), firsts, executor,
                       [&](std::size_t i) { return i == 0 || key_of(i) != key_of(i - 1); });
        cells_.resize(firsts.size() + 1);
        cells_.back() = {static_cast<std::uint32_t>(size()), 0};
        const auto row_of = [&](std::size_t cell) { return axes_.row(key_of(firsts[cell])); };
        executor.for_each_piece(firsts.size(), worth_a_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c)
                cells_[c] = {firsts[c], axes_.number_in_row(key_of(firsts[c]))};
        });
        select_numbers(firsts.size(), first_cells, executor,
                       [&](std::size_t c) { return c == 0 || row_of(c) != row_of(c - 1); });
        rows_.clear();
        for (const std::uint32_t c : first_cells) rows_.push_back({row_of(c), c});
        rows_.push_back({~std::uint64_t(0), static_cast<std::uint32_t>(firsts.size())});
    }
    void copy_coordinates(Executor& executor) {
        const std::size_t n = points_.size();
        for (auto& row : at_) row.resize(n + padding), std::fill_n(row.end() - padding, padding, T(0));
        std::atomic<bool> wrapped = false;
        // Writes each coordinate as along(x, k) says. Returns whether any is another then.
        const auto copy = [&](std::size_t begin, std::size_t end, auto along) {
            bool moved = false;
            for (std::size_t i = begin; i < end; ++i) {
                const Vec<T, D> p = points_[order_[i]];
                for (int k = 0; k < D; ++k) {
                    const T x = along(p[k], k);
                    moved |= x != p[k];
                    at_[static_cast<std::size_t>(k)][i] = x;
                }
            }
            return moved;
        };
        executor.for_each_piece(n, worth_a_task, [&](std::size_t begin, std::size_t end) {
            if (!axes_.repeats())
                copy(begin, end, [](T x, int) { return x; });
            else if (copy(begin, end, [&](T x, int k) { return static_cast<T>(axes_.in_period(x, k)); }))
                wrapped = true;
        });
        wrapped_ = wrapped;
    }

    Points points_;
    const CellAxes<T, D>& axes_;
    bool wrapped_ = false;
    BareVector<PrimitiveId> order_;
    std::array<BareVector<T>, D> at_;
    BareVector<Cell> cells_;
    std::vector<Row> rows_;
};

/// The first cell of parts with about as many points each, and the end of the last.
template <class Order>
std::vector<std::size_t> parts_of(const Order& order, std::size_t points_each = 4096) {
    const auto& cells = order.cells();
    std::vector<std::size_t> begins;
    for (std::size_t c = 0; c + 1 < cells.size(); ++c)
        if (begins.empty() || cells[c].first - cells[begins.back()].first >= points_each) begins.push_back(c);
    begins.push_back(cells.size() - 1);
    return begins;
}

}  // namespace hedgerow::detail
