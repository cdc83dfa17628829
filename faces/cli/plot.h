/// Plots as SVG, to stand in a page: lines over an axis, and dots along rows.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace hedgerow::cli {

enum class Unit { number, seconds, bytes };

struct Series {
    std::string name;
    std::size_t colour;  ///< any number: the same number is the same colour
    std::vector<std::pair<double, double>> points;
};

/// Lines, each named at its right end. Both axes are logarithmic, but x where it has names: there x is a
/// place in them. Values that are not positive are left out.
struct LinePlot {
    std::string title, x_label;
    Unit y_unit = Unit::number;
    std::vector<Series> series;
    std::vector<std::string> x_names;
};
std::string svg_of(const LinePlot& plot);

/// A row for each name, with a dot for each of its values on a logarithmic axis; `series` names the values.
struct DotPlot {
    std::string title;
    Unit unit = Unit::number;
    std::vector<std::string> series;
    struct Row {
        std::string name;
        std::vector<double> values;
    };
    std::vector<Row> rows;
};
std::string svg_of(const DotPlot& plot);

/// Text as it may stand in a page.
std::string escaped(const std::string& text);

}  // namespace hedgerow::cli
