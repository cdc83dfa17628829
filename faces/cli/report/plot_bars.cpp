/// Plots of bars and of points.
#include <algorithm>

#include <fmt/format.h>

#include "plot_parts.h"
#include "xml.h"

namespace hedgerow::cli {

using namespace plot_parts;

namespace {

std::string small(double x, double y, const char* anchor, const std::string& words, int size,
                  const char* colour) {
    return fmt::format(
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{}\" fill=\"{}\">{}</text>\n", x, y,
        anchor, size, colour, escaped(words));
}
std::string filled(double x, double y, double wide, double high, const std::string& colour) {
    return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
                       x, y, wide, high, colour);
}
std::string bar_text(double value) {
    return value >= 99.5   ? fmt::format("{:.0f}", value)
           : value >= 9.95 ? fmt::format("{:.1f}", value)
                           : fmt::format("{:.2f}", value);
}
/// The step of an axis from 0 to `most`: 1, 2, 4 or 5 times a power of ten, so that there are three to six
/// steps.
double step_for(double most) {
    double step = std::pow(10, std::floor(std::log10(most)));
    if (most / step < 1.5) step /= 5;
    if (most / step < 3) step /= 2;
    if (most / step > 6) step *= 2;
    return step;
}

class Bars {
public:
    explicit Bars(const BarPlot& plot) : plot_(plot) {
        for (const auto& panel : plot.panels) groups_ = std::max(groups_, panel.groups.size());
        wide_ = std::max(plot_width, left + 16 + 104 * static_cast<double>(groups_));
        group_ =
            std::min(220.0, (wide_ - left - 16) / static_cast<double>(std::max<std::size_t>(1, groups_)));
    }
    std::string svg() {
        const double top = 30 + 16 * static_cast<double>(plot_.notes.size());
        const double head = top + 26;
        const double high = head + panel_high * static_cast<double>(plot_.panels.size());
        std::string svg = opened(plot_.title, wide_, high);
        for (std::size_t i = 0; i < plot_.notes.size(); ++i)
            svg += small(4, 35 + 16 * static_cast<double>(i), "start", plot_.notes[i], 12, "#555");
        // Draw the legend in a row, and the panels below.
        double at = left;
        for (const auto& s : plot_.series) {
            svg += filled(at, top + 3, 12, 12, s.colour) + text(at + 17, top + 13, "start", s.name);
            at += 44 + 6.2 * static_cast<double>(s.name.size());
        }
        for (std::size_t i = 0; i < plot_.panels.size(); ++i)
            svg += panel(plot_.panels[i], head + panel_high * static_cast<double>(i));
        return svg + "</svg>\n";
    }

private:
    static constexpr double left = 44, panel_high = 190, above = 30, below = 38;

    std::string panel(const BarPlot::Panel& panel, double top) const {
        const double low = top + panel_high - below, high = top + above;
        // Scale the panel to its largest value.
        double most = 0;
        for (const auto& g : panel.groups)
            for (const double v : g.values) most = std::max(most, v);
        if (most <= 0) return "";
        const auto y = [&](double value) { return low - (low - high - 12) * value / most; };
        // Write the title, and draw the axis.
        std::string svg =
            fmt::format("<text x=\"{}\" y=\"{:.1f}\" font-weight=\"bold\" fill=\"#222\">{}</text>\n", left,
                        top + 16, escaped(panel.title));
        for (double v = 0; v <= most; v += step_for(most)) {
            svg += line(left, y(v), left + group_ * static_cast<double>(groups_), y(v),
                        v > 0 ? "#e4e4e4" : "#444");
            svg += small(left - 6, y(v) + 4, "end", fmt::format("{:g}", v), 11, "#555");
        }
        // Draw the groups: bars side by side about the middle, each with its value, over the name and the
        // note.
        for (std::size_t g = 0; g < panel.groups.size(); ++g) {
            const auto& group = panel.groups[g];
            const double middle = left + group_ * (static_cast<double>(g) + 0.5);
            const auto bars = static_cast<double>(
                std::count_if(group.values.begin(), group.values.end(), [](double v) { return v > 0; }));
            const double bar = std::min(36.0, 0.86 * group_ / static_cast<double>(plot_.series.size()));
            double at = middle - bar * bars / 2;
            for (std::size_t s = 0; s < group.values.size(); ++s) {
                const double v = group.values[s];
                if (!(v > 0)) continue;
                svg += filled(at + 1, y(v), bar - 2, low - y(v), plot_.series[s].colour);
                svg += small(at + bar / 2, y(v) - 3, "middle", bar_text(v), 10, "#222");
                at += bar;
            }
            svg += text(middle, low + 14, "middle", group.name);
            svg += small(middle, low + 27, "middle", group.note, 10, "#555");
        }
        return svg;
    }

    const BarPlot& plot_;
    std::size_t groups_ = 0;
    double wide_, group_;
};

std::string marker(double x, double y, const PointPlot::Kind& kind, const std::string& hint) {
    return fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4.5\" fill=\"{}\" stroke=\"{}\" stroke-width=\"1.6\" "
        "fill-opacity=\"0.75\"><title>{}</title></circle>\n",
        x, y, kind.hollow ? "#ffffff" : kind.colour, kind.colour, escaped(hint));
}

}  // namespace

std::string svg_of(const BarPlot& plot) {
    return Bars(plot).svg();
}

std::string svg_of(const PointPlot& plot) {
    constexpr double height = 420;
    const double right = plot_width - name_width, bottom = height - 40, top = top_edge + 8;
    // Scale the axes to the points and levels.
    LogAxis x(left_edge, right), y(bottom, top);
    for (const auto& s : plot.series)
        for (const auto& p : s.points) x.include(p.x), y.include(p.y);
    for (const auto& l : plot.levels) y.include(l.y);
    // Draw the axes.
    std::string svg = opened(plot.title, plot_width, height);
    for (const double v : y.ticks()) {
        svg += line(left_edge, y.at(v), right, y.at(v));
        svg += text(left_edge - 6, y.at(v) + 4, "end", tick_text(v, Unit::number));
    }
    for (const double v : x.ticks()) {
        svg += line(x.at(v), top, x.at(v), bottom, "#eee");
        svg += text(x.at(v), bottom + 16, "middle", tick_text(v, Unit::number));
    }
    svg += line(left_edge, bottom, right, bottom, "#444");
    svg += text((left_edge + right) / 2, height - 6, "middle", plot.x_label);
    svg += text(4, top - 6, "start", plot.y_label, "#555");
    // Draw the levels, then the points with a legend at the right.
    for (const auto& l : plot.levels) {
        svg += fmt::format(
            "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#444\" "
            "stroke-dasharray=\"6 4\"/>\n",
            left_edge, y.at(l.y), right, y.at(l.y));
        svg += text(right + 8, y.at(l.y) + 4, "start", l.name, "#444");
    }
    double at = top + 10;
    for (const auto& s : plot.series) {
        svg += marker(right + 14, at - 4, s, s.name) + text(right + 26, at, "start", s.name);
        at += 18;
        for (const auto& p : s.points)
            if (p.x > 0 && p.y > 0) svg += marker(x.at(p.x), y.at(p.y), s, p.hint);
    }
    return svg + "</svg>\n";
}

}  // namespace hedgerow::cli
