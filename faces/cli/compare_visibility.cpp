#include "compare_visibility.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/measure/break_even.h>
#include <hedgerow/measure/quantity.h>

#include "report/page.h"
#include "report/plot.h"
#include "report/xml.h"

namespace hedgerow::cli {

using namespace measure;
using nlohmann::ordered_json;

namespace {

/// Whether a way asks an index: rays and beams do.
bool casts(const VisibilityCost& way) {
    return !way.way.starts_with("raster:");
}
/// The fastest way that casts, or that rasterises; null without one.
const VisibilityCost* fastest(const VisibilityCase& c, bool casting) {
    const VisibilityCost* best = nullptr;
    for (const VisibilityCost& way : c.ways)
        if (casts(way) == casting && (best == nullptr || way.seconds < best->seconds)) best = &way;
    return best;
}
/// The number of pictures from which on a way takes less time than the fastest rasterising, the build
/// included: "1", "2", ..., or "never".
std::string pays_from(const VisibilityCase& c, const VisibilityCost& way) {
    const VisibilityCost* const raster = fastest(c, false);
    if (raster == nullptr || !casts(way)) return "";
    const BreakEven even = break_even({way.build_seconds, way.seconds}, {0, raster->seconds});
    switch (even.when) {
        case BreakEven::When::always:
            return "1";
        case BreakEven::When::from:
            return fmt::format("{:.0f}", std::floor(even.queries) + 1);
        default:
            return "never";
    }
}
std::string title_of(const VisibilityCase& c) {
    return fmt::format("{} triangles, {} x {} pixels", c.triangles, c.width, c.height);
}

/// Plots the time of a picture over the number of triangles, a line for each way.
std::string times_plot(const VisibilityReport& r, int width, int height, bool with_build) {
    LinePlot plot{
        fmt::format("a picture of {} x {}{}", width, height, with_build ? ", the build included" : ""),
        "triangles",
        Unit::seconds,
        {},
        {}};
    for (const VisibilityCase& c : r.cases) {
        if (c.width != width || c.height != height) continue;
        for (const VisibilityCost& way : c.ways) {
            auto line = std::find_if(plot.series.begin(), plot.series.end(),
                                     [&](const Series& s) { return s.name == way.way; });
            if (line == plot.series.end())
                line = plot.series.insert(line, Series{way.way, plot.series.size(), {}});
            line->points.emplace_back(double(c.triangles),
                                      way.seconds + (with_build ? way.build_seconds : 0));
        }
    }
    return svg_of(plot);
}

}  // namespace

std::vector<Table> tables_of(const VisibilityReport& r) {
    std::vector<Table> tables;
    for (const VisibilityCase& c : r.cases) {
        Table t{
            title_of(c),
            fmt::format("{:.1f}% of the samples hit; x: times the fastest; tests and nodes a sample; pays "
                        "from: pictures until casting, with its build, takes less time than rasterising",
                        100 * c.hit),
            {"way", "a picture", "x", "build", "with build", "x", "tests", "nodes", "memory", "pays from"},
            {}};
        double best = 1e300, best_built = 1e300;
        for (const VisibilityCost& w : c.ways) {
            best = std::min(best, w.seconds);
            best_built = std::min(best_built, w.build_seconds + w.seconds);
        }
        for (const VisibilityCost& w : c.ways)
            t.rows.push_back({w.way, seconds_text(w.seconds), fmt::format("{:.2f}", w.seconds / best),
                              casts(w) ? seconds_text(w.build_seconds) : "",
                              seconds_text(w.build_seconds + w.seconds),
                              fmt::format("{:.2f}", (w.build_seconds + w.seconds) / best_built),
                              w.tests > 0 ? fmt::format("{:.2f}", w.tests) : "",
                              casts(w) ? fmt::format("{:.2f}", w.nodes) : "", bytes_text(double(w.bytes)),
                              pays_from(c, w)});
        tables.push_back(std::move(t));
    }
    return tables;
}

std::vector<std::string> break_even_lines(const VisibilityReport& r) {
    std::vector<std::string> lines;
    for (const VisibilityCase& c : r.cases) {
        const VisibilityCost* cheapest = nullptr;  // that casts, by the first picture at which it pays
        const VisibilityCost* const raster = fastest(c, false);
        if (raster == nullptr) continue;
        double from = std::numeric_limits<double>::infinity();
        for (const VisibilityCost& w : c.ways) {
            if (!casts(w)) continue;
            const BreakEven even = break_even({w.build_seconds, w.seconds}, {0, raster->seconds});
            const double pictures = even.when == BreakEven::When::always ? 0
                                    : even.when == BreakEven::When::from
                                        ? even.queries
                                        : std::numeric_limits<double>::infinity();
            if (pictures < from) from = pictures, cheapest = &w;
        }
        lines.push_back(title_of(c) +
                        (cheapest == nullptr
                             ? ": rasterising is faster for any number of pictures"
                             : fmt::format(": from picture {} on, {} takes less time than {}",
                                           pays_from(c, *cheapest), cheapest->way, raster->way)));
    }
    return lines;
}

ordered_json json_of(const VisibilityReport& r) {
    ordered_json cases = ordered_json::array();
    for (const VisibilityCase& c : r.cases) {
        ordered_json ways = ordered_json::array();
        for (const VisibilityCost& w : c.ways)
            ways.push_back({{"way", w.way},
                            {"build_seconds", w.build_seconds},
                            {"seconds", w.seconds},
                            {"spread", w.spread},
                            {"tests_per_sample", w.tests},
                            {"nodes_per_sample", w.nodes},
                            {"bytes", w.bytes},
                            {"pays_from", pays_from(c, w)}});
        cases.push_back({{"triangles", c.triangles},
                         {"width", c.width},
                         {"height", c.height},
                         {"share_hit", c.hit},
                         {"ways", ways},
                         {"left_out", c.left_out}});
    }
    return {{"scene", r.scene}, {"cases", cases}};
}

std::string page_of(const VisibilityReport& r) {
    std::string html = page_opened("What is visible in " + r.scene);
    html += "<ul>\n";
    for (const std::string& line : break_even_lines(r)) html += fmt::format("<li>{}</li>\n", escaped(line));
    html += "</ul>\n<h2>Plots</h2>\n";
    std::vector<std::pair<int, int>> sizes;
    for (const VisibilityCase& c : r.cases)
        if (std::find(sizes.begin(), sizes.end(), std::pair(c.width, c.height)) == sizes.end())
            sizes.emplace_back(c.width, c.height);
    for (const auto& [width, height] : sizes)
        for (const bool with_build : {false, true}) html += times_plot(r, width, height, with_build);
    html += "<h2>Tables</h2>\n";
    for (const Table& t : tables_of(r)) html += html_of(t);
    return html + page_closed();
}

}  // namespace hedgerow::cli
