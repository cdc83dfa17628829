/// Plots as SVG, for a page: lines over an axis, dots along rows, bars, and points.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace hedgerow::cli {

/// What values are. Those in `percent` are shares, of which 1 is shown as 100%.
enum class Unit { number, percent, seconds, bytes };

struct Series {
    std::string name;
    std::size_t colour;  ///< any number; equal numbers have equal colours
    std::vector<std::pair<double, double>> points;
};

/// Lines, each with its name at the right end. Both axes are logarithmic. If `x_names` is not empty, the x
/// axis has these names instead, and x is an index into them. Values that are not positive are left out.
struct LinePlot {
    std::string title, x_label;
    Unit y_unit = Unit::number;
    std::vector<Series> series;
    std::vector<std::string> x_names;
};
std::string svg_of(const LinePlot& plot);

/// Rows of dots: a row for each name, with a dot for each of its values on a logarithmic axis. `series` names
/// the values of a row.
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

/// Bars from zero. Panels are one below the other, each with its own scale. A panel has a group for each
/// name, and a group has a bar for each series. A value that is not positive has no bar.
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

/// Points on two logarithmic axes, with dashed lines at `levels` that are named at the right. A browser shows
/// the hint of a point under the pointer.
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
