#include "plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <hedgerow/compare/quantity.h>

namespace hedgerow::cli {

namespace {

constexpr double width = 860, name_width = 210, left_edge = 64, top_edge = 34;

/// Told apart by those who see colours differently too (after Okabe and Ito 2008); beyond ten, by dashes.
const char* colour_of(std::size_t i) {
    static constexpr const char* colours[] = {"#0072b2", "#d55e00", "#009e73", "#b3589a", "#c48a00",
                                              "#3d9bd1", "#7a3b10", "#555555", "#6a51a3", "#a50f15"};
    return colours[i % std::size(colours)];
}
const char* dash_of(std::size_t i) {
    return i < 10 ? "" : " stroke-dasharray=\"6 3\"";
}

std::string tick_text(double value, Unit unit) {
    switch (unit) {
        case Unit::seconds:
            return compare::seconds_text(value);
        case Unit::bytes:
            return compare::bytes_text(value);
        case Unit::number:
            break;
    }
    const double k = value >= 1e9 ? 1e9 : value >= 1e6 ? 1e6 : value >= 1e4 ? 1e3 : 1;
    return fmt::format("{:g}{}", value / k, k == 1e9 ? "G" : k == 1e6 ? "M" : k == 1e3 ? "k" : "");
}

/// Positive values to places along an axis, by their logarithms.
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
    /// Powers of ten; where there are few of them, also some of their multiples.
    std::vector<double> ticks() const {
        const double decades = std::log10(most() / least());
        const int apart = decades < 7 ? 1 : 2;
        const std::vector<double> digits = decades < 1     ? std::vector<double>{1, 1.5, 2, 3, 4, 5, 7}
                                           : decades < 2.5 ? std::vector<double>{1, 2, 5}
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
    /// A little more than there is; of nothing, something.
    double least() const { return least_ <= most_ ? least_ / margin() : 1; }
    double most() const { return least_ <= most_ ? most_ * margin() : 10; }
    /// A factor of four at least is shown, so that what hardly differs looks so.
    double margin() const {
        const double range = most_ / least_;
        return std::max({1.05, std::pow(range, 0.03), 2 / std::sqrt(range)});
    }

    double from_, to_;
    double least_ = std::numeric_limits<double>::infinity(), most_ = 0;
};

std::string opened(const std::string& title, double height) {
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
        "role=\"img\" "
        "font-family=\"sans-serif\" font-size=\"12\">\n<title>{2}</title>\n"
        "<text x=\"4\" y=\"18\" font-size=\"14\" font-weight=\"bold\">{2}</text>\n",
        width, height, escaped(title));
}
std::string text(double x, double y, const char* anchor, const std::string& words,
                 const char* colour = "#222") {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n", x, y,
                       anchor, colour, escaped(words));
}
std::string line(double x1, double y1, double x2, double y2, const char* colour = "#ddd") {
    return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x1,
                       y1, x2, y2, colour);
}
std::string dot(double x, double y, double radius, const char* colour) {
    return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>\n", x, y, radius, colour);
}

/// Moves labels apart that want to stand at `places`, so that none covers another, within limits.
std::vector<double> spread(const std::vector<double>& places, double gap, double low, double high) {
    std::vector<std::size_t> order(places.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return places[a] < places[b]; });
    std::vector<double> at = places;
    double next = low;
    for (const auto i : order) {
        at[i] = std::max(at[i], next);
        next = at[i] + gap;
    }
    double last = high;
    for (std::size_t k = order.size(); k-- > 0;) {
        double& place = at[order[k]];
        place = std::min(place, last);
        last = place - gap;
    }
    return at;
}

}  // namespace

std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text) {
        if (c == '&')
            safe += "&amp;";
        else if (c == '<')
            safe += "&lt;";
        else if (c == '>')
            safe += "&gt;";
        else if (c == '"')
            safe += "&quot;";
        else if (static_cast<unsigned char>(c) >= 0x20 || c == '\n')
            safe += c;
    }
    return safe;
}

std::string svg_of(const LinePlot& plot) {
    const double height = std::max(340.0, 80 + 15.0 * static_cast<double>(plot.series.size()));
    const double right = width - name_width, bottom = height - 40;
    LogAxis x(left_edge, right), y(bottom, top_edge);
    for (const Series& s : plot.series)
        for (const auto& [at, value] : s.points)
            if (value > 0) x.include(at), y.include(value);
    const auto place = [&](double at) {
        const double n = static_cast<double>(plot.x_names.size());
        return n > 0 ? left_edge + (at + 0.5) * (right - left_edge) / n : x.at(at);
    };
    // Within the margin that the axis leaves, or the half place of a name.
    const auto reaches_right = [&](double at) { return at > right - (right - left_edge) / 6; };
    std::string svg = opened(plot.title, height);
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
    LogAxis x(left, width - 60);
    for (const auto& row : plot.rows)
        for (const double v : row.values) x.include(v);
    std::string svg = opened(plot.title, height);
    double at = left;
    for (std::size_t i = 0; plot.series.size() > 1 && i < plot.series.size(); ++i) {
        svg += dot(at + 6, top_edge, 5, colour_of(i)) + text(at + 16, top_edge + 4, "start", plot.series[i]);
        at += 40 + 7 * static_cast<double>(plot.series[i].size());
    }
    for (const double v : x.ticks()) {
        svg += line(x.at(v), top, x.at(v), bottom);
        svg += text(x.at(v), bottom + 18, "middle", tick_text(v, plot.unit));
    }
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
