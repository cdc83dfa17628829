/// The parts of plots: axes, colours, lines and texts.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "plot.h"

namespace hedgerow::cli::plot_parts {

inline constexpr double plot_width = 860, name_width = 210, left_edge = 64, top_edge = 34;

/// Ten colours that colour-blind people can distinguish too (after Okabe and Ito 2008). They repeat from the
/// eleventh series on, whose lines are dashed.
const char* colour_of(std::size_t i);
const char* dash_of(std::size_t i);

std::string tick_text(double value, Unit unit);

/// A logarithmic axis: maps positive values to places from `from` to `to`.
class LogAxis {
public:
    LogAxis(double from, double to) : from_(from), to_(to) {}
    void include(double value) {
        if (value > 0) least_ = std::min(least_, value), most_ = std::max(most_, value);
    }
    double at(double value) const {
        const double low = std::log(least()), high = std::log(most());
        return from_ + (to_ - from_) * (std::log(value) - low) / (high - low);
    }
    /// The values of the ticks: powers of ten, with some of their multiples if the axis has few powers, and
    /// every second power from seven decades on.
    std::vector<double> ticks() const {
        const double decades = std::log10(most() / least());
        const int apart = decades < 7 ? 1 : 2;
        const std::vector<double> digits = decades < 1   ? std::vector<double>{1, 1.5, 2, 3, 4, 5, 7}
                                           : decades < 3 ? std::vector<double>{1, 2, 5}
                                                         : std::vector<double>{1};
        std::vector<double> all;
        for (int p = static_cast<int>(std::floor(std::log10(least()))); p <= std::log10(most()); ++p)
            for (const double digit : digits) {
                const double v = digit * std::pow(10, p);
                if (p % apart == 0 && v >= least() && v <= most()) all.push_back(v);
            }
        return all;
    }

private:
    /// The ends of the axis: those of the included values with a margin; 1 and 10 without values.
    double least() const { return least_ <= most_ ? least_ / margin() : 1; }
    double most() const { return least_ <= most_ ? most_ * margin() : 10; }
    /// The factor by which the axis extends beyond the values at each end. The axis spans a factor of at
    /// least four, so that values that hardly differ look alike.
    double margin() const {
        const double range = most_ / least_;
        return std::max({1.05, std::pow(range, 0.03), 2 / std::sqrt(range)});
    }

    double from_, to_;
    double least_ = std::numeric_limits<double>::infinity(), most_ = 0;
};

/// The begin of a plot: its title on white, for viewers that have another background.
std::string opened(const std::string& title, double wide, double high);
std::string text(double x, double y, const char* anchor, const std::string& words,
                 const char* colour = "#222");
std::string line(double x1, double y1, double x2, double y2, const char* colour = "#ddd");
std::string dot(double x, double y, double radius, const char* colour);

}  // namespace hedgerow::cli::plot_parts
