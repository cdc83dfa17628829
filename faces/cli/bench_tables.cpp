/// The results of `bench` as tables.
#include <algorithm>

#include <fmt/format.h>

#include <hedgerow/measure/quantity.h>

#include "bench_report.h"
#include "kernel_use.h"

namespace hedgerow::cli {

using namespace measure;
using measure::name_of;

namespace {

std::string rate_text(double seconds_a_ray) {
    return fmt::format("{:.2f}", 1e-6 / seconds_a_ray);
}
std::string ratio_text(double ratio) {
    return ratio > 0 ? fmt::format("{:.2f}", ratio) : "";
}
std::string share_text(double share) {
    return share == 0 ? "0" : fmt::format("{:.3g}%", 100 * share);
}

Table builds_table(const BenchReport& r, const SceneCosts& s) {
    Table t{s.name + ": builds",
            fmt::format("{} triangles; B: bytes a triangle; x: our time to theirs, where less is better",
                        measure::number_text(static_cast<double>(s.triangles))),
            {"builder", "time", "B"},
            {}};
    if (r.threads > 1) {
        t.columns.push_back(fmt::format("on {} threads", r.threads));
        t.columns.emplace_back("times as fast");
    }
    if (!r.peers.empty())
        for (const char* column : {"against", "its time", "its B", "x"}) t.columns.emplace_back(column);
    // A row for each of our builds, with the peer's build that it is compared with.
    const auto n = static_cast<double>(s.triangles);
    const auto bytes = [&](std::size_t all) { return fmt::format("{:.1f}", static_cast<double>(all) / n); };
    for (const OurBuild& b : s.builds) {
        t.rows.push_back({std::string(name_of(b.builder)), measure::seconds_text(b.seconds), bytes(b.bytes)});
        auto& row = t.rows.back();
        if (r.threads > 1) {
            row.push_back(measure::seconds_text(b.on_threads));
            row.push_back(ratio_text(b.scaling));
        }
        if (const TheirBuild* const them = s.against(b)) {
            row.push_back(them->peer + " " + them->how.name);
            row.push_back(measure::seconds_text(them->seconds));
            row.push_back(bytes(them->bytes));
            row.push_back(ratio_text(s.ratio(b)));
        }
    }
    return t;
}

Table rays_table(const BenchReport& r, const SceneCosts& s) {
    Table t{
        s.name + ": rays",
        fmt::format("one thread; counts are a ray's, over {} to {} of them; floor: how many times the "
                    "least cycles a visit",
                    s.rows.empty() ? 0
                                   : std::min_element(s.rows.begin(), s.rows.end(),
                                                      [](auto& a, auto& b) { return a.sample < b.sample; })
                                         ->sample,
                    r.options.sample),
        {"rays", "Mrays/s", "ns", "tree", "nodes", "leaves", "triangles", "cycles/visit", "floor", "by"},
        {}};
    if (r.threads > 1) {
        t.columns.push_back(fmt::format("on {} threads", r.threads));
        t.columns.emplace_back("times as fast");
    }
    if (!r.peers.empty())
        for (const char* column : {"against", "its Mrays/s", "x", "x to single calls"})
            t.columns.emplace_back(column);
    // A row for each row of results: our best tree, then the peer that it is compared with.
    for (const Row& row : s.rows) {
        const OurRate& best = row.best();
        t.rows.push_back({name_of(row), rate_text(best.seconds), fmt::format("{:.0f}", best.seconds * 1e9),
                          std::string(name_of(best.builder)), fmt::format("{:.2f}", best.nodes),
                          fmt::format("{:.2f}", best.leaves), fmt::format("{:.2f}", best.primitives),
                          fmt::format("{:.1f}", best.cycles_a_visit(r.gigahertz)),
                          fmt::format("{:.2f}", r.times_floor(row)),
                          row.mode == Mode::one ? "" : most_used(row.best().use, row.rays)});
        auto& cells = t.rows.back();
        if (r.threads > 1) {
            cells.push_back(best.on_threads > 0 ? rate_text(best.on_threads) : "");
            cells.push_back(ratio_text(best.scaling));
        }
        if (const TheirRate* const them = row.against()) {
            cells.push_back(name_of(*them));
            cells.push_back(rate_text(them->seconds));
            cells.push_back(ratio_text(row.ratio()));
            cells.push_back(ratio_text(row.ratio_to(row.by_single_calls())));
        }
    }
    return t;
}

/// Shares of the sample's rays that a peer answers differently: by its first build, and by its robust ones.
std::string differs_text(const Row& row) {
    std::string text;
    for (const TheirRate& r : row.theirs)
        if (r.calls_of == 1 && (r.robust || text.empty()))
            text += (text.empty() ? "" : "; ") + share_text(r.differs);
    return text;
}

/// The rates of all trees, ours and the peers', with a row for each set of rays and kind of query.
Table all_table(const SceneCosts& s) {
    Table t{s.name + ": all trees", "Mrays/s", {"rays"}, {}};
    if (!s.their_builds.empty())
        t.note +=
            "; differs: the rays of the sample that a peer answers otherwise, by its first tree and by its "
            "robust one";
    const auto column = [&t](const std::string& name) {
        auto at = std::find(t.columns.begin() + 1, t.columns.end(), name);
        if (at == t.columns.end()) at = t.columns.insert(at, name);
        return static_cast<std::size_t>(at - t.columns.begin());
    };
    const auto name_in = [](const Row& row, const OurRate& rate) {
        return fmt::format("{}, {}", name_of(row.mode), name_of(rate.builder));
    };
    // Make the columns in their order: our trees, then the peers' by single rays, then by calls of 16.
    for (const Row& row : s.rows)
        for (const OurRate& r : row.ours) column(name_in(row, r));
    for (const int calls_of : {1, 16})
        for (const Row& row : s.rows)
            for (const TheirRate& r : row.theirs)
                if (r.calls_of == calls_of) column(name_of(r));
    if (!s.their_builds.empty()) column("differs");
    // Fill the cells. Rows of one set and query that differ in mode share a row of the table.
    for (const Row& row : s.rows) {
        const std::string asked = fmt::format("{}, {}", row.set, name_of(row.question));
        const auto known =
            std::find_if(t.rows.begin(), t.rows.end(), [&](const auto& r) { return r.front() == asked; });
        auto& cells = known != t.rows.end() ? *known : t.rows.emplace_back(t.columns.size());
        cells.front() = asked;
        for (const OurRate& r : row.ours) cells[column(name_in(row, r))] = rate_text(r.seconds);
        for (const TheirRate& r : row.theirs) cells[column(name_of(r))] = rate_text(r.seconds);
        if (!row.theirs.empty()) cells.back() = differs_text(row);
    }
    return t;
}

Table means_table(const std::vector<Mean>& means) {
    Table t{
        "all scenes",
        "geometric means; of rays our rate to theirs, of builds our time to theirs; worst: where it is worst "
        "for us",
        {"", "x", "worst", "scene", "rays", "of"},
        {}};
    for (const Mean& m : means)
        t.rows.push_back(
            {m.what, ratio_text(m.ratio), ratio_text(m.worst), m.scene, m.set, std::to_string(m.count)});
    return t;
}

}  // namespace

double BenchReport::times_floor(const Row& row) const {
    return row.best().cycles_a_visit(gigahertz) / floor_of(row.mode);
}

std::string name_of(const Row& row) {
    return fmt::format("{}, {}, {}", row.set, name_of(row.question), name_of(row.mode));
}
std::string name_of(const TheirRate& rate) {
    return fmt::format("{} {}{}", rate.peer, rate.build, rate.calls_of > 1 ? " by 16" : "");
}

std::string machine_of(const BenchReport& r) {
    std::string line = fmt::format("{}, {} core{}, {}, {:.2f} GHz, {}, {}, width {}", r.processor, r.cores,
                                   r.cores == 1 ? "" : "s", r.avx512_rate, r.gigahertz, r.compiler,
                                   r.instruction_set, r.width);
    for (const auto& p : r.peers) line += fmt::format(", beside {} {}", p.name, p.version);
    return line;
}

std::vector<Table> tables_of(const BenchReport& r) {
    std::vector<Table> all;
    for (const SceneCosts& s : r.scenes) {
        if (!s.builds.empty()) all.push_back(builds_table(r, s));
        if (s.rows.empty()) continue;
        all.push_back(rays_table(r, s));
        all.push_back(all_table(s));
    }
    if (const auto means = means_of(r.scenes); !means.empty()) all.push_back(means_table(means));
    for (Table& t : all)
        for (auto& row : t.rows) row.resize(t.columns.size());
    return all;
}

}  // namespace hedgerow::cli
