/// The results of `compare` as tables.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hedgerow/measure/break_even.h>
#include <hedgerow/measure/quantity.h>

#include "compare_report.h"

namespace hedgerow::cli {

using namespace measure;

namespace {

/// A value as a multiple of the best value: "1.00" for the best itself. Empty if the best is 0.
std::string against(double value, double best) {
    if (!(best > 0)) return "";
    return value / best < 100 ? fmt::format("{:.2f}", value / best) : count_text(std::round(value / best));
}
template <class F>
double least(const std::vector<StructureCost>& all, F figure) {
    double best = figure(all.front());
    for (const auto& s : all) best = std::min(best, figure(s));
    return best;
}

Table structures_table(const Comparison& c, bool timed) {
    Table t{"structures",
            "x: times the least",
            {"structure", "build", "x", "memory", "x", "bytes/primitive", "depth", "items/primitive", "nodes",
             "leaves"},
            {}};
    const auto n = static_cast<double>(c.size);
    const double build = least(c.structures, [](const auto& s) { return s.build_seconds; });
    const double bytes = least(c.structures, [](const auto& s) { return double(s.bytes); });
    for (const auto& s : c.structures)
        t.rows.push_back({s.structure, seconds_text(s.build_seconds), against(s.build_seconds, build),
                          bytes_text(double(s.bytes)), against(double(s.bytes), bytes),
                          fmt::format("{:.1f}", double(s.bytes) / n), std::to_string(s.depth),
                          fmt::format("{:.2f}", double(s.items) / n), number_text(double(s.nodes)),
                          number_text(double(s.leaves))});
    if (!timed) drop(t, "build", 2);
    return t;
}

Table kind_table(const Comparison& c, std::size_t kind, bool timed) {
    Table t{c.structures.front().queries[kind].kind,
            timed ? "a query, on the mean; x: times the fastest" : "a query, on the mean",
            {"structure", "time", "x", "spread", "nodes", "leaves", "primitives", "skipped", "asked"},
            {}};
    const double best = least(c.structures, [&](const auto& s) { return s.queries[kind].seconds; });
    for (const auto& s : c.structures) {
        const QueryCost& q = s.queries[kind];
        t.rows.push_back({s.structure, seconds_text(q.seconds), against(q.seconds, best),
                          fmt::format("{:.0f}%", 100 * q.spread), fmt::format("{:.2f}", q.nodes),
                          fmt::format("{:.2f}", q.leaves), fmt::format("{:.2f}", q.primitives),
                          fmt::format("{:.2f}", q.skipped), std::to_string(q.asked)});
    }
    if (!timed) drop(t, "time", 3);
    return t;
}

Table update_table(const Comparison& c) {
    Table t{"primitives that change",
            "one, all: to follow one primitive that moved, and all; drift: SAH cost after a refit against "
            "before; slowdown: a query after a refit against one after a build",
            {"structure", "erase", "insert", "one", "all", "x", "all by", "drift", "slowdown"},
            {}};
    const double best = least(c.structures, [](const auto& s) { return s.update.all; });
    for (const auto& s : c.structures) {
        const UpdateCost& u = s.update;
        const bool refit = u.how == "refit", single = u.insert > 0;
        t.rows.push_back(
            {s.structure, single ? seconds_text(u.erase) : "", single ? seconds_text(u.insert) : "",
             seconds_text(u.one), seconds_text(u.all), against(u.all, best), std::string(u.how),
             refit ? fmt::format("{:.2f}", u.drift) : "", refit ? fmt::format("{:.2f}", u.slowdown) : ""});
    }
    return t;
}

std::string text_of(const BreakEven& b) {
    switch (b.when) {
        case BreakEven::When::always:
            return "always";
        case BreakEven::When::never:
            return "never";
        case BreakEven::When::from:
            return "> " + count_text(std::ceil(b.queries));
        case BreakEven::When::until:
            break;
    }
    return "< " + count_text(std::floor(b.queries));
}

Table break_even_table(const Comparison& c, Ask ask) {
    Table t{
        "break-even",
        fmt::format(
            "for how many {} queries, with its build, the structure of the row costs less than that of the "
            "column",
            ask),
        {"structure"},
        {}};
    const auto cost = [&](const StructureCost& s) { return Cost{s.build_seconds, query_mean(s, ask)}; };
    std::string letter = "a";
    for (const auto& one : c.structures) {
        t.columns.push_back(letter);
        t.rows.push_back({letter + "  " + one.structure});
        for (const auto& other : c.structures)
            t.rows.back().push_back(&one == &other ? "" : text_of(break_even(cost(one), cost(other))));
        letter = letter == "z" ? "aa" : letter.substr(0, letter.size() - 1) + char(letter.back() + 1);
    }
    return t;
}

Table sweep_table(const CompareReport::Swept& swept, Ask ask, bool timed) {
    Table t{fmt::format("{}: {}", swept.sweep.structure, swept.sweep.option),
            fmt::format("a {} query, of rays the mean over their sets{}", ask,
                        timed ? "; x: times the least" : ""),
            {swept.sweep.option, "build", "x", "memory", "items/primitive", "time", "x", "nodes", "leaves",
             "primitives"},
            {}};
    const auto& all = swept.comparison.structures;
    const double build = least(all, [](const auto& s) { return s.build_seconds; });
    const double query = least(all, [&](const auto& s) { return query_mean(s, ask); });
    for (std::size_t i = 0; i < all.size(); ++i) {
        const auto& s = all[i];
        const auto mean = [&](double QueryCost::*figure) { return query_mean(s, ask, figure); };
        t.rows.push_back({swept.sweep.values[i], seconds_text(s.build_seconds),
                          against(s.build_seconds, build), bytes_text(double(s.bytes)),
                          fmt::format("{:.2f}", double(s.items) / double(swept.comparison.size)),
                          seconds_text(mean(&QueryCost::seconds)), against(mean(&QueryCost::seconds), query),
                          fmt::format("{:.2f}", mean(&QueryCost::nodes)),
                          fmt::format("{:.2f}", mean(&QueryCost::leaves)),
                          fmt::format("{:.2f}", mean(&QueryCost::primitives))});
    }
    if (!timed) drop(t, "build", 2), drop(t, "time", 2);
    return t;
}

/// A law with the numbers of its fit: "a + b log2 n" as "12 + 3.4 log2 n".
std::string text_of(const Fit& f) {
    switch (f.law) {
        case Law::power:
            return fmt::format("{:.3g} n^{:.2f}", f.a, f.b);
        case Law::logarithm:
            return fmt::format("{:.3g} + {:.3g} log2 n", f.a, f.b);
        case Law::root:
            return fmt::format("{:.3g} + {:.3g} n^(1/{})", f.a, f.b, f.dimension);
        case Law::linear:
            return fmt::format("{:.3g} + {:.3g} n", f.a, f.b);
        case Law::n_log_n:
            break;
    }
    return fmt::format("{:.3g} + {:.3g} n log2 n", f.a, f.b);
}

Table growth_table(const CompareReport& r, std::string_view figure) {
    Table t{"growth: " + std::string(figure),
            "power: its exponent; the laws: how far they miss, the root of the mean square, in per cent",
            {"structure"},
            {}};
    for (const auto& c : r.by_size) t.columns.push_back(number_text(double(c.size)));
    for (const char* law : {"exponent", "power", "log", "root", "linear", "n log n", "best law"})
        t.columns.emplace_back(law);
    for (const Growth& g : growth_of(r.by_size, r.ask)) {
        // Leave out structures that were not measured at every size.
        if (g.figure != figure || g.sizes.size() != r.by_size.size()) continue;
        t.rows.push_back({g.structure});
        auto& row = t.rows.back();
        for (const double v : g.values)
            row.push_back(figure.find("seconds") != figure.npos ? seconds_text(v) : fmt::format("{:.2f}", v));
        // Add the exponent, the residuals of the laws in per cent, and the best law.
        const auto by = [&](Law law) {
            return *std::find_if(g.fits.begin(), g.fits.end(), [&](const Fit& f) { return f.law == law; });
        };
        row.push_back(fmt::format("{:.2f}", by(Law::power).b));
        for (const Law law : {Law::power, Law::logarithm, Law::root, Law::linear, Law::n_log_n})
            row.push_back(fmt::format("{:.1f}", 100 * by(law).residual));
        row.push_back(text_of(g.fits.front()));
    }
    return t;
}

}  // namespace

std::vector<Table> tables_of(const CompareReport& r) {
    std::vector<Table> all;
    if (r.comparison && !r.comparison->structures.empty()) {
        const Comparison& c = *r.comparison;
        all.push_back(structures_table(c, r.timed));
        for (std::size_t kind = 0; kind < c.structures.front().queries.size(); ++kind)
            all.push_back(kind_table(c, kind, r.timed));
        if (r.timed) all.push_back(update_table(c)), all.push_back(break_even_table(c, r.ask));
    }
    for (const auto& swept : r.sweeps)
        if (!swept.comparison.structures.empty()) all.push_back(sweep_table(swept, r.ask, r.timed));
    if (!r.by_size.empty())
        for (const auto figure : growth_figures)
            if (Table t = growth_table(r, figure); !t.rows.empty()) all.push_back(std::move(t));
    return all;
}

}  // namespace hedgerow::cli
