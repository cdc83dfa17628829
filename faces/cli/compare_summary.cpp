/// The results of `compare` in short: advice and one table.
#include <algorithm>

#include <fmt/format.h>

#include <hedgerow/measure/quantity.h>

#include "compare_report.h"

namespace hedgerow::cli {

using namespace measure;

std::vector<std::string> advice_lines(const CompareReport& r) {
    std::vector<std::string> lines;
    if (!r.comparison || !r.timed) return lines;
    for (const Recommendation& a : advise(*r.comparison, r.ask)) {
        std::string line = fmt::format("{}: {}. {}.", a.need, a.ranking[0].structure, a.reason);
        for (std::size_t i = 1; i < std::min<std::size_t>(3, a.ranking.size()); ++i)
            line += fmt::format("{} {} ({:.2f} x)", i == 1 ? " Then" : " and", a.ranking[i].structure,
                                a.ranking[i].figure / a.ranking[0].figure);
        lines.push_back(fmt::format("{}{} By {}: {}.", line, a.ranking.size() > 1 ? "." : "", a.rule,
                                    a.ranking[0].terms));
    }
    return lines;
}

std::optional<Table> summary_of(const CompareReport& r) {
    if (!r.comparison || r.comparison->structures.empty()) return std::nullopt;
    const Comparison& c = *r.comparison;
    const std::string sets = c.rays.empty() ? "" : "the mean over its sets of rays";
    const std::string scale = r.timed ? "x: times the fastest" : "";
    Table t{fmt::format("a {} query", r.ask),
            sets + (sets.empty() || scale.empty() ? "" : "; ") + scale,
            {"structure", "build", "memory", "time", "x", "nodes", "leaves", "primitives"},
            {}};
    double best = query_mean(c.structures.front(), r.ask);
    for (const auto& s : c.structures) best = std::min(best, query_mean(s, r.ask));
    for (const auto& s : c.structures) {
        const double time = query_mean(s, r.ask);
        std::vector<std::string> row = {s.structure, seconds_text(s.build_seconds),
                                        bytes_text(double(s.bytes)), seconds_text(time),
                                        best > 0 ? number_text(time / best) : ""};
        for (const auto figure : {&QueryCost::nodes, &QueryCost::leaves, &QueryCost::primitives})
            row.push_back(fmt::format("{:.2f}", query_mean(s, r.ask, figure)));
        t.rows.push_back(std::move(row));
    }
    if (!r.timed) drop(t, "build", 1), drop(t, "time", 2);
    return t;
}

std::vector<std::string> ray_notes(const Comparison& c) {
    std::vector<std::string> notes;
    if (!c.rays.empty()) {
        std::string text = "rays that meet nothing:";
        for (const RaySetSize& s : c.rays)
            text += fmt::format("{} {:.3g}% of the {} ones", &s == &c.rays.front() ? "" : ",",
                                100 * double(s.missed) / double(s.rays), s.kind);
        notes.push_back(text);
    }
    constexpr double hidden = 0.03;
    if (c.seen_from_outside < hidden)
        notes.push_back(fmt::format(
            "the eye is outside of the scene and sees {:.2g}% of the {}: nearly all coherent rays "
            "end at an outer shell; look from inside with --eye x,y,z --target x,y,z",
            100 * c.seen_from_outside, c.primitive));
    const auto engine = std::any_of(c.structures.begin(), c.structures.end(),
                                    [](const auto& s) { return s.structure.starts_with("wide"); });
    if (engine && c.primitive == "triangles")
        notes.emplace_back(
            "wide is timed in batches by its kernels, and counted by a walk without them, ray by ray");
    return notes;
}

}  // namespace hedgerow::cli
