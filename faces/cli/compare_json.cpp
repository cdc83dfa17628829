/// The results of `compare` as JSON: seconds, bytes and counts, not rounded.
#include <nlohmann/json.hpp>

#include <hedgerow/measure/break_even.h>

#include "compare_report.h"

namespace hedgerow::cli {

using namespace measure;
using nlohmann::ordered_json;

namespace {

ordered_json json_of(const QueryCost& q, bool timed) {
    ordered_json j = {{"ask", q.ask}, {"kind", q.kind}, {"asked", q.asked}};
    if (timed) j.update({{"seconds", q.seconds}, {"spread", q.spread}});
    j.update(
        {{"nodes", q.nodes}, {"leaves", q.leaves}, {"primitives", q.primitives}, {"skipped", q.skipped}});
    return j;
}

ordered_json json_of(const UpdateCost& u) {
    return {{"how", u.how},
            {"one_seconds", u.one},
            {"all_seconds", u.all},
            {"insert_seconds", u.insert},
            {"erase_seconds", u.erase},
            {"drift", u.drift},
            {"slowdown", u.slowdown}};
}

ordered_json json_of(const StructureCost& s, bool timed) {
    ordered_json queries = ordered_json::array();
    for (const QueryCost& q : s.queries) queries.push_back(json_of(q, timed));
    ordered_json j = {{"structure", s.structure}};
    if (timed) j.update({{"build_seconds", s.build_seconds}, {"builds", s.builds}});
    j.update({{"bytes", s.bytes},
              {"depth", s.depth},
              {"nodes", s.nodes},
              {"leaves", s.leaves},
              {"items", s.items},
              {"queries", queries}});
    if (timed) j["update"] = json_of(s.update);
    return j;
}

ordered_json json_of(const Comparison& c, bool timed) {
    ordered_json structures = ordered_json::array();
    for (const auto& s : c.structures) structures.push_back(json_of(s, timed));
    ordered_json rays = ordered_json::array();
    for (const RaySetSize& r : c.rays)
        rays.push_back({{"kind", r.kind}, {"rays", r.rays}, {"missed", r.missed}});
    return {{"primitive", c.primitive}, {"size", c.size}, {"dimension", c.dimension},
            {"finished", c.finished},   {"rays", rays},   {"seen_from_outside", c.seen_from_outside},
            {"structures", structures}};
}

ordered_json break_even_json(const Comparison& c, Ask ask) {
    constexpr const char* names[] = {"always", "from", "until", "never"};
    const auto cost = [&](const StructureCost& s) { return Cost{s.build_seconds, query_mean(s, ask)}; };
    ordered_json all = ordered_json::array();
    for (const auto& one : c.structures)
        for (const auto& other : c.structures) {
            if (&one == &other) continue;
            const BreakEven b = break_even(cost(one), cost(other));
            all.push_back({{"structure", one.structure},
                           {"against", other.structure},
                           {"costs_less", names[static_cast<int>(b.when)]},
                           {"queries", b.queries}});
        }
    return all;
}

ordered_json advice_json(const Comparison& c, Ask ask) {
    ordered_json all = ordered_json::array();
    for (const Recommendation& r : advise(c, ask)) {
        ordered_json ranking = ordered_json::array();
        for (const Ranked& k : r.ranking)
            ranking.push_back({{"structure", k.structure}, {"figure", k.figure}, {"terms", k.terms}});
        all.push_back({{"need", r.need},
                       {"structure", r.ranking.front().structure},
                       {"by", r.rule},
                       {"unit", r.unit},
                       {"reason", r.reason},
                       {"ranking", ranking}});
    }
    return all;
}

ordered_json growth_json(const CompareReport& r) {
    ordered_json all = ordered_json::array();
    for (const Growth& g : growth_of(r.by_size, r.ask)) {
        ordered_json laws = ordered_json::array();
        for (const Fit& f : g.fits)
            laws.push_back({{"law", name_of(f.law)}, {"a", f.a}, {"b", f.b}, {"residual", f.residual}});
        all.push_back({{"structure", g.structure},
                       {"figure", g.figure},
                       {"sizes", g.sizes},
                       {"values", g.values},
                       {"fits", laws}});
    }
    return all;
}

}  // namespace

ordered_json json_of(const CompareReport& r) {
    ordered_json j = {{"scene", r.scene}, {"notes", r.notes}, {"ask", r.ask}};
    if (r.comparison) j.update(json_of(*r.comparison, r.timed));
    if (r.comparison && r.timed) {
        j["break_even"] = break_even_json(*r.comparison, r.ask);
        j["advice"] = advice_json(*r.comparison, r.ask);
    }
    for (const auto& s : r.sweeps) {
        ordered_json swept = {
            {"structure", s.sweep.structure}, {"option", s.sweep.option}, {"values", s.sweep.values}};
        swept.update(json_of(s.comparison, r.timed));
        j["sweeps"].push_back(swept);
    }
    if (!r.by_size.empty()) {
        for (const auto& c : r.by_size) j["scale"]["scenes"].push_back(json_of(c, r.timed));
        j["scale"]["growth"] = growth_json(r);
    }
    return j;
}

}  // namespace hedgerow::cli
