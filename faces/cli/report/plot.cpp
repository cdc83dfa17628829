#include "plot.h"

#include <algorithm>

#include <fmt/format.h>

#include "plot_parts.h"

namespace hedgerow::cli {

using namespace plot_parts;

namespace {

/// Moves labels from their wanted `places` so that neighbours are at least `gap` apart. None is beyond
/// `high`, nor before `low` if there is room for all.
std::vector<double> spread(const std::vector<double>& places, double gap, double low, double high) {
    std::vector<std::size_t> order(places.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return places[a] < places[b]; });
    std::vector<double> at = places;
    // In ascending order: push each label beyond the one before.
    double next = low;
    for (const auto i : order) {
        at[i] = std::max(at[i], next);
        next = at[i] + gap;
    }
    // In descending order from `high`: push them back.
    double last = high;
    for (std::size_t k = order.size(); k-- > 0;) {
        double& place = at[order[k]];
        place = std::min(place, last);
        last = place - gap;
    }
    return at;
}

}  // namespace

std::string svg_of(const LinePlot& plot) {
    // Scale the axes to the points.
    const double height = std::max(340.0, 80 + 15.0 * static_cast<double>(plot.series.size()));
    const double right = plot_width - name_width, bottom = height - 40;
    LogAxis x(left_edge, right), y(bottom, top_edge);
    for (const Series& s : plot.series)
        for (const auto& [at, value] : s.points)
            if (value > 0) x.include(at), y.include(value);
    const auto place = [&](double at) {
        const double n = static_cast<double>(plot.x_names.size());
        return n > 0 ? left_edge + (at + 0.5) * (right - left_edge) / n : x.at(at);
    };
    // A line ends at the right if it ends in the last sixth, which allows for the margin of the axis or for
    // half the place of a name.
    const auto reaches_right = [&](double at) { return at > right - (right - left_edge) / 6; };
    // Draw the axes, with ticks or with the names on x.
    std::string svg = opened(plot.title, plot_width, height);
    for (const double v : y.ticks()) {
        svg += line(left_edge, y.at(v), right, y.at(v));
        svg += text(left_edge - 6, y.at(v) + 4, "end", tick_text(v, plot.y_unit));
    }
    if (plot.x_names.empty()) {
        for (const double v : x.ticks()) {
            svg += line(x.at(v), top_edge, x.at(v), bottom, "#eee");
            svg += text(x.at(v), bottom + 16, "middle", tick_text(v, Unit::number));
        }
    } else {
        for (std::size_t i = 0; i < plot.x_names.size(); ++i)
            svg += text(place(static_cast<double>(i)), bottom + 16, "middle", plot.x_names[i]);
    }
    svg += line(left_edge, bottom, right, bottom, "#444");
    svg += text((left_edge + right) / 2, height - 6, "middle", plot.x_label);
    // Draw the lines, with dots if they have few points, and keep their ends.
    const bool dotted = std::all_of(plot.series.begin(), plot.series.end(),
                                    [](const Series& s) { return s.points.size() <= 24; });
    struct End {
        double x, y;
    };
    std::vector<End> ends;
    std::vector<double> at_right;  // the ends that are named beside the plot
    for (const Series& s : plot.series) {
        std::string points, dots;
        End end{left_edge, bottom};
        for (const auto& [at, value] : s.points) {
            if (!(value > 0)) continue;
            end = {place(at), y.at(value)};
            points += fmt::format("{:.1f},{:.1f} ", end.x, end.y);
            if (dotted) dots += dot(end.x, end.y, 3, colour_of(s.colour));
        }
        svg += fmt::format("<polyline fill=\"none\" stroke-width=\"2\" stroke=\"{}\"{} points=\"{}\"/>\n",
                           colour_of(s.colour), dash_of(s.colour), points) +
               dots;
        ends.push_back(end);
        if (reaches_right(end.x)) at_right.push_back(end.y);
    }
    // Write the names: in a column beside the plot for lines that end at the right, else at the end of the
    // line.
    const auto labels = spread(at_right, 14, top_edge, bottom);
    auto label = labels.begin();
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
        const Series& s = plot.series[i];
        const char* colour = colour_of(s.colour);
        if (reaches_right(ends[i].x)) {
            svg += line(ends[i].x + 4, ends[i].y, right + 12, *label, colour);
            svg += text(right + 16, *label++ + 4, "start", s.name, colour);
        } else {
            svg += text(ends[i].x + 6, ends[i].y + 4, "start", s.name, colour);
        }
    }
    return svg + "</svg>\n";
}

std::string svg_of(const DotPlot& plot) {
    constexpr double row_height = 22;
    const double top = top_edge + (plot.series.size() > 1 ? 20 : 0), left = name_width;
    const double bottom = top + row_height * static_cast<double>(plot.rows.size()), height = bottom + 26;
    // Scale the axis to the values.
    LogAxis x(left, plot_width - 60);
    for (const auto& row : plot.rows)
        for (const double v : row.values) x.include(v);
    std::string svg = opened(plot.title, plot_width, height);
    // Draw a legend if a row has several values, and the ticks.
    double at = left;
    for (std::size_t i = 0; plot.series.size() > 1 && i < plot.series.size(); ++i) {
        svg += dot(at + 6, top_edge, 5, colour_of(i)) + text(at + 16, top_edge + 4, "start", plot.series[i]);
        at += 40 + 7 * static_cast<double>(plot.series[i].size());
    }
    for (const double v : x.ticks()) {
        svg += line(x.at(v), top, x.at(v), bottom);
        svg += text(x.at(v), bottom + 18, "middle", tick_text(v, plot.unit));
    }
    // Draw the rows: a name, a line to the largest value, and the dots. A single value is written beside its
    // dot.
    for (std::size_t r = 0; r < plot.rows.size(); ++r) {
        const auto& row = plot.rows[r];
        const double y = top + row_height * (static_cast<double>(r) + 0.5);
        svg += text(left - 10, y + 4, "end", row.name);
        double last = left;
        for (const double v : row.values)
            if (v > 0) last = std::max(last, x.at(v));
        svg += line(left, y, last, y, "#bbb");
        for (std::size_t i = 0; i < row.values.size(); ++i)
            if (row.values[i] > 0) svg += dot(x.at(row.values[i]), y, 5, colour_of(i));
        if (row.values.size() == 1 && row.values[0] > 0)
            svg += text(last + 9, y + 4, "start", tick_text(row.values[0], plot.unit));
    }
    return svg + "</svg>\n";
}

}  // namespace hedgerow::cli
