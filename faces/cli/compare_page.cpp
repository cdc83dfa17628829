/// The results of `compare` as a page with plots. The page is well-formed as XML too, and needs no other
/// file.
#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include <hedgerow/measure/break_even.h>
#include <hedgerow/questions.h>

#include "compare_report.h"
#include "report/page.h"
#include "report/plot.h"
#include "report/xml.h"

namespace hedgerow::cli {

using namespace measure;

namespace {

/// Plots the time of a build and n queries over n, as a multiple of the least of all structures. A structure
/// at 1 is the best for that n.
std::string total_plot(const Comparison& c, Ask ask) {
    constexpr double most = 30;
    LinePlot plot{fmt::format("a build and so many {} queries, times the least (up to {})", ask, most),
                  "queries",
                  Unit::number,
                  {},
                  {}};
    for (std::size_t i = 0; i < c.structures.size(); ++i)
        plot.series.push_back({c.structures[i].structure, i, {}});
    // Sample n from 1 to 10^8, eight times a decade. Points beyond `most` are left out.
    for (int step = 0; step <= 64; ++step) {
        const double queries = std::pow(10, step / 8.0);
        const auto total = [&](const StructureCost& s) {
            return Cost{s.build_seconds, query_mean(s, ask)}.after(queries);
        };
        double best = total(c.structures.front());
        for (const auto& s : c.structures) best = std::min(best, total(s));
        for (std::size_t i = 0; i < c.structures.size(); ++i)
            if (const double times = total(c.structures[i]) / best; times <= most)
                plot.series[i].points.emplace_back(queries, times);
    }
    std::erase_if(plot.series, [](const Series& s) { return s.points.empty(); });
    return svg_of(plot);
}

template <class F>
std::string structures_plot(const Comparison& c, std::string title, Unit unit, F figure) {
    DotPlot plot{std::move(title), unit, {}, {}};
    for (const auto& s : c.structures) plot.rows.push_back({s.structure, {figure(s)}});
    return svg_of(plot);
}

/// Plots one figure of the query `ask`: a row for each structure, a dot for each kind of the query.
std::string kinds_plot(const Comparison& c, Ask ask, std::string title, Unit unit,
                       double QueryCost::*figure) {
    DotPlot plot{std::move(title), unit, {}, {}};
    for (const auto& s : c.structures) {
        plot.rows.push_back({s.structure, {}});
        for (const QueryCost& q : s.queries) {
            if (q.ask != ask) continue;
            plot.rows.back().values.push_back(q.*figure);
            if (plot.rows.size() == 1) plot.series.push_back(q.kind);
        }
    }
    return plot.series.empty() ? "" : svg_of(plot);
}

std::string comparison_plots(const Comparison& c, Ask ask, bool timed) {
    std::string html;
    if (timed) {
        html += total_plot(c, ask);
        html +=
            structures_plot(c, "build time", Unit::seconds, [](const auto& s) { return s.build_seconds; });
    }
    html += structures_plot(c, "memory beyond the primitives", Unit::bytes,
                            [](const auto& s) { return double(s.bytes); });
    if (timed)
        html += structures_plot(c, "to follow primitives that all moved", Unit::seconds,
                                [](const auto& s) { return s.update.all; });
    for (const Ask asked : question_names<TriangleMesh<float>>())
        if (timed)
            html += kinds_plot(c, asked, fmt::format("time a query: {}", asked), Unit::seconds,
                               &QueryCost::seconds);
    html += kinds_plot(c, ask, fmt::format("nodes a query: {}", ask), Unit::number, &QueryCost::nodes);
    html += kinds_plot(c, ask, fmt::format("primitives tested a query: {}", ask), Unit::number,
                       &QueryCost::primitives);
    return html;
}

/// Plots times, counts and memory over the values of a sweep's option, with a line for each figure.
std::string sweep_plots(const CompareReport::Swept& swept, Ask ask, bool timed) {
    const auto& all = swept.comparison.structures;
    // Values that are all positive numbers have an axis; other values have a place each.
    const auto number = [](const std::string& text) {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        return end == text.c_str() + text.size() && value > 0 ? value : 0;
    };
    const bool numbers = std::all_of(swept.sweep.values.begin(), swept.sweep.values.end(),
                                     [&](const std::string& v) { return number(v) > 0; });
    const auto plot = [&](const char* title, Unit unit, const auto& lines) {
        LinePlot p{fmt::format("{}: {}", swept.sweep.structure, title),
                   swept.sweep.option,
                   unit,
                   {},
                   numbers ? std::vector<std::string>() : swept.sweep.values};
        for (const auto& [name, figure] : lines) {
            Series line{name, p.series.size(), {}};
            for (std::size_t i = 0; i < all.size(); ++i)
                line.points.emplace_back(numbers ? number(swept.sweep.values[i]) : double(i), figure(all[i]));
            p.series.push_back(std::move(line));
        }
        return svg_of(p);
    };
    // Time has a line for each kind of the query; counts are means over the kinds.
    using Line = std::pair<std::string, std::function<double(const StructureCost&)>>;
    std::vector<Line> times;
    for (std::size_t q = 0; q < all.front().queries.size(); ++q)
        if (all.front().queries[q].ask == ask)
            times.emplace_back(all.front().queries[q].kind,
                               [q](const auto& s) { return s.queries[q].seconds; });
    const auto mean = [&](double QueryCost::*figure) {
        return [figure, ask](const StructureCost& s) { return query_mean(s, ask, figure); };
    };
    const auto build = [](const StructureCost& s) { return s.build_seconds; };
    return (timed ? plot("time a query", Unit::seconds, times) : "") +
           plot("what a query looks at", Unit::number,
                std::vector<Line>{{"nodes", mean(&QueryCost::nodes)},
                                  {"leaves", mean(&QueryCost::leaves)},
                                  {"primitives", mean(&QueryCost::primitives)}}) +
           (timed ? plot("build time", Unit::seconds, std::vector<Line>{{"build", build}}) : "") +
           plot("memory", Unit::bytes,
                std::vector<Line>{{"memory", [](const StructureCost& s) { return double(s.bytes); }}});
}

std::string growth_plot(const CompareReport& r, std::string_view figure) {
    LinePlot plot{"growth: " + std::string(figure),
                  "primitives",
                  figure.find("seconds") != figure.npos ? Unit::seconds : Unit::number,
                  {},
                  {}};
    const auto& names = r.by_size.front().structures;
    for (const Growth& g : growth_of(r.by_size, r.ask)) {
        if (g.figure != figure) continue;
        const auto at = std::find_if(names.begin(), names.end(),
                                     [&](const auto& s) { return s.structure == g.structure; });
        Series line{g.structure, static_cast<std::size_t>(at - names.begin()), {}};
        for (std::size_t i = 0; i < g.sizes.size(); ++i) line.points.emplace_back(g.sizes[i], g.values[i]);
        plot.series.push_back(std::move(line));
    }
    return plot.series.empty() ? "" : svg_of(plot);
}

}  // namespace

std::string page_of(const CompareReport& r) {
    std::string html = page_opened("Structures over " + r.scene);
    if (r.comparison) html += fmt::format("<p>{} {}.</p>\n", r.comparison->size, r.comparison->primitive);
    for (const auto& n : r.notes) html += fmt::format("<p class=\"note\">{}.</p>\n", escaped(n));
    if (const auto lines = advice_lines(r); !lines.empty()) {
        html += "<h2>What to use</h2>\n<ul>\n";
        for (const auto& l : lines) html += fmt::format("<li>For {}</li>\n", escaped(l));
        html += "</ul>\n";
    }
    html += "<h2>Plots</h2>\n";
    if (r.comparison && !r.comparison->structures.empty())
        html += comparison_plots(*r.comparison, r.ask, r.timed);
    for (const auto& s : r.sweeps)
        if (!s.comparison.structures.empty()) html += sweep_plots(s, r.ask, r.timed);
    if (!r.by_size.empty())
        for (const auto figure : growth_figures) html += growth_plot(r, figure);
    html += "<h2>Tables</h2>\n";
    for (const Table& t : tables_of(r)) html += html_of(t);
    return html + page_closed();
}

}  // namespace hedgerow::cli
