/// Plots as SVG, to stand in a page: lines over an axis, dots along rows, bars, and points.
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

/// Bars from zero: a panel below the other for each of some scales of their own, in it a group for each name,
/// and in that a bar for each series. A value that is not positive has no bar.
struct BarPlot {
    std::string title;
    std::vector<std::string> notes;  ///< a line each, below the title
    struct Kind {
        std::string name, colour;
    };
    std::vector<Kind> series;
    struct Group {
        std::string name, note;
        std::vector<double> values;
    };
    struct Panel {
        std::string title;
        std::vector<Group> groups;
    };
    std::vector<Panel> panels;
};
std::string svg_of(const BarPlot& plot);

/// Points on two logarithmic axes, with levels that are named at the right. What a point is, a browser shows
/// under the pointer.
struct PointPlot {
    std::string title, x_label, y_label;
    struct Point {
        double x, y;
        std::string hint;
    };
    struct Kind {
        std::string name, colour;
        bool hollow = false;
        std::vector<Point> points;
    };
    std::vector<Kind> series;
    struct Level {
        double y;
        std::string name;
    };
    std::vector<Level> levels;
};
std::string svg_of(const PointPlot& plot);

}  // namespace hedgerow::cli
