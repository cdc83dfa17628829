/// The results of `bench` as a page with plots, and as a chart.
#include <algorithm>

#include <fmt/format.h>

#include <hedgerow/measure/quantity.h>

#include "bench_report.h"
#include "report/page.h"
#include "report/plot.h"
#include "report/xml.h"

namespace hedgerow::cli {

using namespace measure;
using measure::name_of;

namespace {

constexpr const char *one_colour = "#7cc0e8", *batch_colour = "#0072b2", *their_one_colour = "#f2b37c",
                     *their_sixteen_colour = "#d55e00";

/// A scene's name, short enough for an axis: "dragon" for "dragon.ply.gz", "soup" for "gen:soup:200000".
std::string short_name(const SceneCosts& scene) {
    const bool generated = scene.name.starts_with("gen:");
    const std::string name = generated ? scene.name.substr(4) : scene.name;
    return name.substr(0, name.find(generated ? ':' : '.'));
}

/// The highest rate, in million rays a second, of the peers' trees that are not robust, in calls of
/// `calls_of` rays. 0 if there is none.
double fastest(const Row& row, int calls_of) {
    double rate = 0;
    for (const TheirRate& r : row.theirs)
        if (!r.robust && r.calls_of == calls_of) rate = std::max(rate, mrays(r.seconds));
    return rate;
}

struct SetName {
    std::string name;
    bool only_any_hit;
};
/// The sets of rays in the order in which they were traced.
std::vector<SetName> set_names(const BenchReport& r) {
    std::vector<SetName> all;
    for (const RayKind kind : r.options.sets) all.push_back({std::string(name_of(kind)), only_any_hit(kind)});
    for (const RaySet& set : r.options.more_sets) all.push_back({set.name, set.only_any_hit});
    return all;
}

/// A panel for one set of rays and one kind of query, with a group of bars for each scene.
BarPlot::Panel panel_of(const BenchReport& r, const std::string& set, Question question) {
    const std::string asked = question == Question::closest ? "closest hit" : "any hit";
    BarPlot::Panel panel{fmt::format("{} rays, {}", set, asked), {}};
    for (const SceneCosts& scene : r.scenes) {
        BarPlot::Group group{short_name(scene),
                             measure::number_text(static_cast<double>(scene.triangles)) + " triangles",
                             {0, 0, 0, 0}};
        for (const Row& row : scene.rows) {
            if (row.set != set || row.question != question) continue;
            group.values[row.mode == Mode::one ? 0 : 1] = mrays(row.best().seconds);
            group.values[2] = fastest(row, 1);
            group.values[3] = std::max(group.values[3], fastest(row, 16));
        }
        if (*std::max_element(group.values.begin(), group.values.end()) > 0)
            panel.groups.push_back(std::move(group));
    }
    return panel;
}

BarPlot bars(const BenchReport& r, std::string title,
             const std::vector<std::pair<std::string, Question>>& panels) {
    BarPlot plot{std::move(title),
                 {machine_of(r)},
                 {{"Hedgerow, a ray a call", one_colour}, {"Hedgerow, a batch", batch_colour}},
                 {}};
    for (const auto& p : r.peers) {
        plot.series.push_back({p.name + ", a ray a call", their_one_colour});
        plot.series.push_back({p.name + ", 16 rays a call", their_sixteen_colour});
    }
    for (const auto& [set, question] : panels)
        if (auto panel = panel_of(r, set, question); !panel.groups.empty())
            plot.panels.push_back(std::move(panel));
    return plot;
}

std::string question_plot(const BenchReport& r, Question question) {
    std::vector<std::pair<std::string, Question>> panels;
    for (const SetName& set : set_names(r)) panels.emplace_back(set.name, question);
    const auto plot = bars(r,
                           fmt::format("Million rays a second on one thread: {}",
                                       question == Question::closest ? "the closest hit" : "any hit"),
                           panels);
    return plot.panels.empty() ? "" : svg_of(plot);
}

/// Plots cycles per visit over visits per ray, beside the least cycles that are possible.
std::string visits_plot(const BenchReport& r) {
    PointPlot plot{"Cycles a visit of a node or a leaf",
                   "visits a ray",
                   "cycles a visit",
                   {},
                   {{latency_floor, "least of one ray alone"}, {throughput_floor, "least in a batch"}}};
    for (const Mode mode : {Mode::one, Mode::batch})
        for (const Question question : {Question::closest, Question::any}) {
            PointPlot::Kind kind{fmt::format("{}, {}", name_of(mode), name_of(question)),
                                 mode == Mode::one ? "#d55e00" : batch_colour,
                                 question == Question::any,
                                 {}};
            for (const SceneCosts& scene : r.scenes)
                for (const Row& row : scene.rows)
                    if (row.mode == mode && row.question == question)
                        kind.points.push_back({row.best().visits(), row.best().cycles_a_visit(r.gigahertz),
                                               scene.name + ": " + name_of(row)});
            if (!kind.points.empty()) plot.series.push_back(std::move(kind));
        }
    return plot.series.empty() ? "" : svg_of(plot);
}

}  // namespace

std::string chart_of(const BenchReport& r) {
    std::vector<std::pair<std::string, Question>> panels;
    const auto asked = [&](Question q) {
        return std::find(r.options.questions.begin(), r.options.questions.end(), q) !=
               r.options.questions.end();
    };
    for (const SetName& set : set_names(r))
        panels.emplace_back(
            set.name, !set.only_any_hit && asked(Question::closest) ? Question::closest : Question::any);
    return svg_of(bars(r, "Million rays a second on one thread", panels));
}

std::string page_of(const BenchReport& r) {
    std::string html = page_opened("Rays a second");
    html += fmt::format("<p>{}.</p>\n", escaped(machine_of(r)));
    for (const auto& n : r.notes) html += fmt::format("<p class=\"note\">{}.</p>\n", escaped(n));
    const auto tables = tables_of(r);
    const bool ratios = !tables.empty() && tables.back().title == "all scenes";
    if (ratios) html += "<h2>Beside the peers</h2>\n" + html_of(tables.back());
    html += "<h2>Plots</h2>\n";
    for (const Question q : {Question::closest, Question::any}) html += question_plot(r, q);
    html += visits_plot(r);
    html += "<h2>Tables</h2>\n";
    for (std::size_t i = 0; i + (ratios ? 1 : 0) < tables.size(); ++i) html += html_of(tables[i]);
    return html + page_closed();
}

}  // namespace hedgerow::cli
