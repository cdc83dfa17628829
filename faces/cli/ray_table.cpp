#include "ray_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace hedgerow::cli {

std::string TraceTable::summary() const {
    if (nearest)
        return fmt::format("stops after {} steps at primitive {}, t = {:.6g}; {} {}, t = {:.6g}", rows.size(),
                           hit->first, hit->second, wrong() ? "WRONG, the nearest is" : "the nearest is",
                           nearest->first, nearest->second);
    const std::string cost =
        fmt::format("{} steps: {} nodes, {} leaves, {} primitives tested{}", rows.size(), visits.nodes,
                    visits.leaves, visits.primitives,
                    visits.skipped > 0 ? fmt::format(" ({} skipped, tested before)", visits.skipped) : "");
    return cost +
           (hit ? fmt::format("; hits primitive {} at t = {:.6g}", hit->first, hit->second) : "; no hit");
}

void TraceTable::stop_at_first_hit() {
    // Find the first leaf with a hit, and its nearest hit.
    for (std::size_t i = 0; i < rows.size(); ++i) {
        std::optional<std::pair<PrimitiveId, double>> first;
        for (const auto& t : rows[i].tests)
            if (t.t && (!first || std::pair(*t.t, t.id) < std::pair(first->second, first->first)))
                first = {t.id, *t.t};  // for equal t the lower id, as in queries
        if (!first) continue;
        // Keep the true hit, end the table at that leaf, and count its visits anew.
        nearest = std::exchange(hit, first);
        // A grid counts every visited cell as a node.
        const bool cells_are_nodes = visits.nodes == rows.size();
        rows.resize(i + 1);
        visits = {};
        for (const auto& row : rows) {
            visits.nodes += cells_are_nodes || !row.leaf;
            visits.leaves += row.leaf && !row.tests.empty();
            for (const auto& t : row.tests) ++(t.skipped ? visits.skipped : visits.primitives);
        }
        return;
    }
}

namespace {

std::string point_text(const std::vector<double>& p) {
    std::string text;
    for (const double x : p) text += fmt::format("{}{:.4g}", text.empty() ? "(" : ", ", x);
    return text + ")";
}
std::string number_text(double x) {
    return std::isfinite(x) ? fmt::format("{:.5g}", x) : std::string(x > 0 ? "inf" : "-inf");
}
std::string tests_text(const TraceRow& row) {
    std::string text;
    for (const auto& t : row.tests) {
        text += fmt::format("{}{}", text.empty() ? "" : " ", t.id);
        if (t.skipped) text += "(skipped)";
        if (t.t) text += fmt::format("(t={:.5g})", *t.t);
    }
    return text.empty() ? "-" : text;
}
constexpr std::string_view step_columns[] = {"step", "node",          "level",   "kind",
                                             "box",  "t in the cell", "t limit", "primitives tested"};

}  // namespace

std::string interval_text(const Interval<double>& in) {
    return fmt::format("[{}, {}]", number_text(in.entry), number_text(in.exit));
}
std::span<const std::string_view> table_columns() {
    return step_columns;
}
std::vector<std::string> texts_of(const TraceRow& row, std::size_t step) {
    return {fmt::format("{}", step),
            fmt::format("{}", row.node),
            fmt::format("{}", row.level),
            row.leaf ? (row.tests.empty() ? "empty" : "leaf") : "node",
            point_text(row.low) + "-" + point_text(row.high),
            interval_text(row.inside),
            number_text(row.limit),
            tests_text(row)};
}

std::string text_of(const TraceTable& table) {
    std::vector<std::vector<std::string>> lines = {{std::begin(step_columns), std::end(step_columns)}};
    for (std::size_t i = 0; i < table.rows.size(); ++i) lines.push_back(texts_of(table.rows[i], i + 1));
    std::vector<std::size_t> wide(std::size(step_columns));
    for (const auto& line : lines)
        for (std::size_t c = 0; c < wide.size(); ++c) wide[c] = std::max(wide[c], line[c].size());
    std::string text;
    for (const auto& line : lines) {
        for (std::size_t c = 0; c + 1 < wide.size(); ++c)
            text += fmt::format("{}{}  ", std::string(c < 3 ? wide[c] - line[c].size() : 0, ' ') + line[c],
                                std::string(c < 3 ? 0 : wide[c] - line[c].size(), ' '));
        text += line.back() + "\n";
    }
    return text + table.summary() + "\n";
}

}  // namespace hedgerow::cli
