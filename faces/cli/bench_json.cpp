/// The results of `bench` as JSON: seconds, bytes and counts, not rounded.
#include <nlohmann/json.hpp>

#include "bench_report.h"
#include "kernel_use.h"

namespace hedgerow::cli {

using namespace measure;
using measure::name_of;
using nlohmann::ordered_json;

namespace {

ordered_json json_of(const OurRate& r, Mode mode, const BenchReport& report) {
    const double cycles = r.cycles_a_visit(report.gigahertz);
    ordered_json j = {{"builder", name_of(r.builder)},
                      {"mrays", mrays(r.seconds)},
                      {"ns", r.seconds * 1e9},
                      {"spread", r.spread},
                      {"nodes", r.nodes},
                      {"leaves", r.leaves},
                      {"primitives", r.primitives},
                      {"cycles_a_visit", cycles},
                      {"times_floor", cycles / floor_of(mode)}};
    if (mode == Mode::batch) j["rays_by"] = rays_by(r.use);
    if (r.on_threads > 0)
        j["on_threads"] = {
            {"threads", report.threads}, {"mrays", mrays(r.on_threads)}, {"scaling", r.scaling}};
    return j;
}

ordered_json json_of(const TheirRate& r) {
    return {{"peer", r.peer},         {"build", r.build},          {"robust", r.robust},
            {"calls_of", r.calls_of}, {"mrays", mrays(r.seconds)}, {"ns", r.seconds * 1e9},
            {"spread", r.spread},     {"differs", r.differs}};
}

ordered_json json_of(const Row& row, const BenchReport& report) {
    ordered_json ours = ordered_json::array(), theirs = ordered_json::array();
    for (const OurRate& r : row.ours) ours.push_back(json_of(r, row.mode, report));
    for (const TheirRate& r : row.theirs) theirs.push_back(json_of(r));
    ordered_json j = {{"set", row.set},
                      {"question", name_of(row.question)},
                      {"mode", name_of(row.mode)},
                      {"rays", row.rays},
                      {"sample", row.sample},
                      {"best", json_of(row.best(), row.mode, report)},
                      {"ours", ours},
                      {"theirs", theirs}};
    if (const TheirRate* const them = row.against()) {
        j["against"] = json_of(*them);
        j["ratio"] = row.ratio();
        j["ratio_to_single_calls"] = row.ratio_to(row.by_single_calls());
    }
    return j;
}

ordered_json json_of(const SceneCosts& s, const BenchReport& report) {
    const auto n = static_cast<double>(s.triangles);
    ordered_json builds = ordered_json::array(), theirs = ordered_json::array(), rows = ordered_json::array();
    // Our builds, each with the build of a peer that it is compared with.
    for (const OurBuild& b : s.builds) {
        ordered_json j = {{"builder", name_of(b.builder)},
                          {"seconds", b.seconds},
                          {"spread", b.spread},
                          {"bytes", b.bytes},
                          {"bytes_a_triangle", static_cast<double>(b.bytes) / n}};
        if (b.on_threads > 0)
            j["on_threads"] = {
                {"threads", report.threads}, {"seconds", b.on_threads}, {"scaling", b.scaling}};
        if (const TheirBuild* const them = s.against(b))
            j["against"] = {{"peer", them->peer}, {"build", them->how.name}, {"seconds", them->seconds}},
            j["ratio"] = s.ratio(b);
        builds.push_back(j);
    }
    for (const TheirBuild& b : s.their_builds)
        theirs.push_back({{"peer", b.peer},
                          {"build", b.how.name},
                          {"robust", b.how.robust},
                          {"seconds", b.seconds},
                          {"spread", b.spread},
                          {"bytes", b.bytes},
                          {"most_bytes", b.most_bytes},
                          {"bytes_a_triangle", static_cast<double>(b.bytes) / n}});
    for (const Row& row : s.rows) rows.push_back(json_of(row, report));
    return {{"scene", s.name},  {"triangles", s.triangles}, {"finished", s.finished},
            {"builds", builds}, {"their_builds", theirs},   {"rows", rows}};
}

}  // namespace

ordered_json json_of(const BenchReport& r) {
    ordered_json peers = ordered_json::array(), scenes = ordered_json::array(), means = ordered_json::array();
    for (const auto& p : r.peers)
        peers.push_back({{"peer", p.name}, {"version", p.version}, {"builds", p.builds}});
    for (const SceneCosts& s : r.scenes) scenes.push_back(json_of(s, r));
    for (const Mean& m : means_of(r.scenes))
        means.push_back({{"what", m.what},
                         {"of", m.of_times ? "times" : "rates"},
                         {"ratio", m.ratio},
                         {"worst", m.worst},
                         {"scene", m.scene},
                         {"set", m.set},
                         {"count", m.count}});
    return {{"processor", r.processor},
            {"avx512", r.avx512_rate},
            {"cores", r.cores},
            {"clock_ghz", r.gigahertz},
            {"compiler", r.compiler},
            {"instruction_set", r.instruction_set},
            {"width", r.width},
            {"threads", r.threads},
            {"rounds", r.options.rounds},
            {"floors", {{"one", latency_floor}, {"batch", throughput_floor}}},
            {"peers", peers},
            {"finished", r.finished},
            {"notes", r.notes},
            {"scenes", scenes},
            {"means", means}};
}

}  // namespace hedgerow::cli
