/// Cells of space in rows, such that points within a radius of each other are in the same cell or in two that
/// touch.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <hedgerow/base/error.h>
#include <hedgerow/base/strided.h>
#include <hedgerow/geometry/box.h>
#include <hedgerow/geometry/periods.h>
#include <hedgerow/parallel/blocks.h>

#include "cell_axis.h"

namespace hedgerow::detail {

/// The cells along each axis, and the keys by which points are sorted: the number of a point's cell along the
/// first axis in the lowest bits, that along the last in the highest.
template <std::floating_point T, int D>
class CellAxes {
public:
    using Points = Strided<Vec<T, D>>;

    /// Cells for some sets of points, not all empty. Throws InputError for a point with a coordinate that is
    /// not finite or too large.
    ///
    /// Where cells as short as the radius were too many along an axis, only those near points are numbered;
    /// while keys are still too long, cells become longer.
    CellAxes(std::span<const Points> sets, double radius, const Periods<D>& periods, Executor& executor)
        : periods_(periods) {
        constexpr double most_cells = 0x1p20, room_for_roundings = 1 + 0x1p-20;
        constexpr double shortest = sizeof(T) == 4 ? 0x1p-100 : 0x1p-500;
        Box<double, D> box;
        for (const Points& points : sets) box.expand(box_of(points, executor));
        for (int k = 0; k < D; ++k)
            if (periods[k] > 0)
                farthest_ = std::max({farthest_, std::abs(box.low[k]), std::abs(box.high[k])});
        for (double length = std::max(radius * room_for_roundings, shortest);; length *= 16) {
            bits_ = 0;
            for (int k = 0; k < D; ++k) {
                const double extent = periods[k] > 0 ? periods[k] : box.high[k] - box.low[k];
                const double least = std::max(extent / most_cells, shortest);
                CellAxis& axis = axes_[static_cast<std::size_t>(k)];
                if (length < least && !(periods[k] > 0) && extent > 0)
                    axis = {coordinates(sets, k), length};
                else
                    axis = {box.low[k], box.high[k], std::clamp(length, least, 2 * std::max(extent, least)),
                            periods[k]};
                shift_[static_cast<std::size_t>(k)] = bits_;
                bits_ += width(k);
            }
            if (bits_ < 64) return;
        }
    }

    const CellAxis& operator[](int k) const { return axes_[static_cast<std::size_t>(k)]; }
    const Periods<D>& periods() const { return periods_; }
    /// How many bits a key has: fewer than 64.
    int key_bits() const { return bits_; }
    /// Calls f(key_of), where key_of(p) is the key of a point.
    template <class F>
    void with_keys(F f) const {
        const auto key_by = [shift = shift_](auto cell) {
            return [shift, cell](const Vec<T, D>& p) {
                std::uint64_t key = 0;
                for (int k = 0; k < D; ++k)
                    key |= std::uint64_t(cell(p[k], k)) << shift[static_cast<std::size_t>(k)];
                return key;
            };
        };
        std::array<CellAxis::Even, D> even;
        bool all_even = true;
        for (std::size_t k = 0; k < D; ++k) all_even &= axes_[k].is_even(), even[k] = axes_[k].even();
        if (!all_even)
            f(key_by([this](T x, int k) { return (*this)[k].cell(in_period(x, k)); }));
        else if (repeats())
            f(key_by([this, even](T x, int k) {
                return even[static_cast<std::size_t>(k)].cell(in_period(x, k));
            }));
        else
            f(key_by([even](T x, int k) {
                return even[static_cast<std::size_t>(k)].cell_below(static_cast<double>(x));
            }));
    }
    /// How far from 0 a coordinate is at most, as it is given, along the axes that repeat.
    double farthest() const { return farthest_; }
    /// Whether space repeats along any axis.
    bool repeats() const {
        bool any = false;
        for (int k = 0; k < D; ++k) any |= periods_[k] > 0;
        return any;
    }
    /// A coordinate's image from 0 to the period.
    double in_period(T coordinate, int k) const {
        const double x = static_cast<double>(coordinate), period = periods_[k];
        if (!(period > 0) || (x >= 0 && x < period)) return x;
        const double rest = std::fmod(x, period);
        return rest < 0 ? rest + period : rest;
    }

    /// The number of a key's cell along the first axis, and the row that it is in: the rest of the key.
    std::uint32_t number_in_row(std::uint64_t key) const {
        return static_cast<std::uint32_t>(key & ((std::uint64_t(1) << width(0)) - 1));
    }
    std::uint64_t row(std::uint64_t key) const { return key >> shift_[1]; }
    /// The row with these numbers along the second axis and the third, and the other way round; the third is
    /// 0 in the plane.
    std::uint64_t row(std::uint32_t second, std::uint32_t third) const {
        if constexpr (D == 2)
            return second;
        else
            return std::uint64_t(third) << width(1) | second;
    }
    std::array<std::uint32_t, 2> numbers(std::uint64_t row) const {
        if constexpr (D == 2)
            return {static_cast<std::uint32_t>(row), 0};
        else
            return {static_cast<std::uint32_t>(row & ((std::uint64_t(1) << width(1)) - 1)),
                    static_cast<std::uint32_t>(row >> width(1))};
    }

private:
    int width(int k) const { return static_cast<int>(std::bit_width((*this)[k].count() - 1)); }

    static std::vector<double> coordinates(std::span<const Points> sets, int axis) {
        std::vector<double> all;
        for (const Points& points : sets)
            for (std::size_t i = 0; i < points.size(); ++i)
                all.push_back(static_cast<double>(points[i][axis]));
        return all;
    }
    static Box<double, D> box_of(const Points& points, Executor& executor) {
        const Blocks blocks{points.size(), std::size_t(1) << 16};
        std::vector<Box<T, D>> boxes(blocks.number());
        blocks.each(executor, [&](std::size_t b, std::size_t begin, std::size_t end) {
            bool bad = false;
            Box<T, D> box;
            for (std::size_t i = begin; i < end; ++i) {
                const Vec<T, D> p = points[i];
                box.expand(p);
                for (int k = 0; k < D; ++k) bad |= !(std::abs(p[k]) <= largest_coordinate<T>);
            }
            if (bad) refuse(points, begin);
            boxes[b] = box;
        });
        Box<double, D> all;
        for (const auto& box : boxes) all.expand({Vec<double, D>(box.low), Vec<double, D>(box.high)});
        return all;
    }
    [[noreturn]] static void refuse(const Points& points, std::size_t begin) {
        std::size_t i = begin;
        const auto good = [&](const Vec<T, D>& p) {
            for (int k = 0; k < D; ++k)
                if (!(std::abs(p[k]) <= largest_coordinate<T>)) return false;
            return true;
        };
        while (i + 1 < points.size() && good(points[i])) ++i;
        throw InputError("point " + std::to_string(i) + " has a coordinate that is NaN, infinite or beyond " +
                         (sizeof(T) == 4 ? "±2^60" : "±2^480") + ". Leave it out");
    }

    Periods<D> periods_;
    std::array<CellAxis, D> axes_;
    std::array<int, D> shift_;  // where the number of each axis begins in a key
    int bits_ = 0;
    double farthest_ = 0;
};

}  // namespace hedgerow::detail
