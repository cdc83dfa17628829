/// Cells of one length along an axis, such that points within a radius are in the same cell or in two that
/// touch.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <hedgerow/geometry/rounding.h>

namespace hedgerow::detail {

/// The cells along an axis. Far-off places leave no empty cells between them: where a gap between
/// neighbouring places is longer than a cell, the cells after it are numbered on, with one number left out.
/// So there are at most twice as many numbers as places, wherever these are.
class CellAxis {
public:
    CellAxis() = default;
    /// Cells of at least `side` over [low, high], or over a period, which they fill without a rest.
    CellAxis(double low, double high, double side, double period) : low_(low), period_(period) {
        if (period > 0) {
            low_ = 0, count_ = number(std::max(1.0, std::floor(period / side))), side_ = period / count_;
        } else {
            side_ = side;
        }
        per_side_ = 1 / side_;
        if (!(period > 0)) count_ = 1 + number((high - low) * per_side_);
    }
    /// Cells over so many places that cells without gaps would be too many.
    CellAxis(std::vector<double> places, double side) : side_(side), per_side_(1 / side) {
        std::sort(places.begin(), places.end());
        for (const double x : places) {
            if (parts_.empty() || x - last_ > side) parts_.push_back({x, parts_.empty() ? 0 : count_ + 1});
            count_ = parts_.back().first + number(std::floor((x - parts_.back().low) * per_side_)) + 1;
            last_ = x;
        }
    }

    std::uint32_t count() const { return count_; }
    double side() const { return side_; }
    double period() const { return period_; }
    /// Whether cells are so few to a period that some touch from both sides.
    bool wraps() const { return period_ > 0 && count_ < 3; }
    /// The cell of a place; of one that lies within the period, if there is one.
    std::uint32_t cell(double x) const {
        const Part part = part_of(x);
        return std::min(part.first + number((x - part.low) * per_side_), count_ - 1);
    }
    /// The cells where they have no gaps.
    struct Even {
        double low, per_side;
        std::uint32_t last;
        std::uint32_t cell(double x) const { return std::min(cell_below(x), last); }
        /// That of a place which is not above all that the axis was made for.
        std::uint32_t cell_below(double x) const { return number((x - low) * per_side); }
    };
    bool is_even() const { return parts_.empty(); }
    Even even() const { return {low_, per_side_, count_ - 1}; }
    /// The middle of a cell.
    double middle(std::uint32_t cell) const {
        Part part{low_, 0};
        if (!parts_.empty())
            part = *std::prev(std::upper_bound(parts_.begin(), parts_.end(), cell,
                                               [](std::uint32_t c, const Part& p) { return c < p.first; }));
        return part.low + (cell - part.first + 0.5) * side_;
    }

private:
    /// Cells without a gap: where they begin, and the number of the first.
    struct Part {
        double low;
        std::uint32_t first;
    };
    static std::uint32_t number(double x) { return static_cast<std::uint32_t>(x); }
    Part part_of(double x) const {
        if (parts_.empty()) return {low_, 0};
        return *std::prev(std::upper_bound(parts_.begin(), parts_.end(), x,
                                           [](double a, const Part& p) { return a < p.low; }));
    }

    double low_ = 0, side_ = 1, per_side_ = 1, period_ = 0, last_ = 0;
    std::uint32_t count_ = 1;
    std::vector<Part> parts_;
};

}  // namespace hedgerow::detail
