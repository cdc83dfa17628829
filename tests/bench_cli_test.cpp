/// `hedgerow bench` as its user sees it: tables, JSON, the page, the chart, messages and exit codes. The
/// tests judge no times, only what is computed from times.
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "page.h"
#include "tool.h"

namespace {

using namespace hedgerow;
namespace fs = std::filesystem;
using nlohmann::json;

class Bench : public ToolTest {
protected:
    ToolResult run(const std::string& arguments) const {
        return run_shell(HEDGEROW_TOOL_PATH " bench --quick --rounds 1 " + arguments + " 2>" +
                         file("errors"));
    }
    json parsed(const std::string& arguments) const {
        const auto r = run(arguments + " --json");
        EXPECT_EQ(r.code, 0) << bytes_of(file("errors"));
        return json::parse(r.output);
    }
    void expect_refused(int code, const std::string& arguments, const std::string& said) const {
        const auto r = run(arguments);
        const std::string all = r.output + bytes_of(file("errors"));
        EXPECT_EQ(r.code, code) << arguments << "\n" << all;
        EXPECT_NE(all.find(said), std::string::npos) << arguments << "\n" << all;
    }
};

double number(const json& j, const char* name) {
    return j.at(name).get<double>();
}
void expect_close(double a, double b) {
    EXPECT_NEAR(a, b, 1e-9 * std::fabs(b));
}

/// Expects that derived figures agree with the figures that they are computed from.
void expect_consistent(const json& j, const json& rate, const std::string& mode) {
    expect_close(number(rate, "mrays"), 1e3 / number(rate, "ns"));
    const double visits = number(rate, "nodes") + number(rate, "leaves");
    EXPECT_GT(visits, 0);
    expect_close(number(rate, "cycles_a_visit"), number(rate, "ns") * number(j, "clock_ghz") / visits);
    expect_close(number(rate, "times_floor"),
                 number(rate, "cycles_a_visit") / j["floors"][mode].get<double>());
}

TEST_F(Bench, HasARowForEverythingThatIsAsked) {
    const json j = parsed("gen:teapot:400 gen:soup:300");
    ASSERT_EQ(j["scenes"].size(), 2u);
    EXPECT_TRUE(j["finished"]);
    for (const char* fact : {"processor", "avx512", "compiler", "instruction_set"})
        EXPECT_FALSE(j[fact].get<std::string>().empty()) << fact;
    EXPECT_GT(number(j, "clock_ghz"), 0);
    for (const json& scene : j["scenes"]) {
        EXPECT_EQ(scene["builds"].size(), 3u);
        std::set<std::string> rows;
        for (const json& row : scene["rows"])
            rows.insert(row["set"].get<std::string>() + " " + row["question"].get<std::string>() + " " +
                        row["mode"].get<std::string>());
        EXPECT_EQ(rows.size(), 3u * 2 * 2 + 2 * 2) << "shadow and ambient rays are asked for any hit alone";
        EXPECT_EQ(scene["rows"].size(), rows.size());
    }
}
TEST_F(Bench, FiguresFollowFromEachOther) {
    const json j = parsed("gen:hairball:2000");
    for (const json& row : j["scenes"][0]["rows"]) {
        const std::string mode = row["mode"];
        double least = INFINITY;
        ASSERT_EQ(row["ours"].size(), 2u);
        // The best of our rates is the one of least time.
        for (const json& rate : row["ours"]) {
            expect_consistent(j, rate, mode);
            least = std::min(least, number(rate, "ns"));
            if (mode != "batch") continue;
            const json& by = rate["rays_by"];
            EXPECT_EQ(number(by, "single") + number(by, "phased") + number(by, "packets"),
                      number(row, "rays"));
        }
        EXPECT_EQ(number(row["best"], "ns"), least);
        EXPECT_LE(number(row, "sample"), 2000);
        // The ratio compares with the fastest peer that is not robust: a batch with calls of any kind.
        EXPECT_EQ(row.contains("ratio"), !j["peers"].empty());
        if (!row.contains("ratio")) continue;
        const json& against = row["against"];
        expect_close(number(row, "ratio"), number(row["best"], "mrays") / number(against, "mrays"));
        if (mode == "one") {
            EXPECT_EQ(against["calls_of"], 1);
        }
        double single = 0;
        for (const json& rate : row["theirs"]) {
            EXPECT_LE(number(rate, "differs"), 0.05) << "what a peer answers is much the same";
            if (rate["robust"].get<bool>()) continue;
            if (mode == "batch" || rate["calls_of"] == 1) {
                EXPECT_LE(number(rate, "mrays"), number(against, "mrays"));
            }
            if (rate["calls_of"] == 1) single = std::max(single, number(rate, "mrays"));
        }
        expect_close(number(row, "ratio_to_single_calls"), number(row["best"], "mrays") / single);
    }
}
TEST_F(Bench, HoldsBuildsAgainstTheirLike) {
    const json j = parsed("gen:soup:500 --sets random --questions any --modes one");
    for (const json& b : j["scenes"][0]["builds"]) {
        EXPECT_GT(number(b, "seconds"), 0);
        expect_close(number(b, "bytes_a_triangle"), number(b, "bytes") / 500);
        EXPECT_EQ(b.contains("ratio"), !j["peers"].empty());
        if (!b.contains("ratio")) continue;
        EXPECT_EQ(b["against"]["build"], b["builder"] == "high" ? "high" : "medium");
        expect_close(number(b, "ratio"), number(b, "seconds") / number(b["against"], "seconds"));
    }
}
TEST_F(Bench, MeansAreThoseOfTheRatios) {
    const json j = parsed("gen:teapot:400 gen:soup:300 --questions closest");
    if (j["peers"].empty()) {
        EXPECT_TRUE(j["means"].empty());
        return;
    }
    double logs = 0, worst = INFINITY;
    int count = 0;
    for (const json& scene : j["scenes"])
        for (const json& row : scene["rows"])
            if (row["mode"] == "one")
                logs += std::log(number(row, "ratio")), worst = std::min(worst, number(row, "ratio")),
                                                        ++count;
    ASSERT_EQ(count, 6);
    const json& mean = j["means"][0];
    EXPECT_EQ(mean["what"], "one, closest");
    EXPECT_EQ(mean["count"], count);
    expect_close(number(mean, "ratio"), std::exp(logs / count));
    EXPECT_EQ(number(mean, "worst"), worst);
    EXPECT_EQ(j["means"].size(), 5u + 3)
        << "one; batches of two kinds, each to two kinds of calls; three builds";
}
TEST_F(Bench, TakesWhatItIsTold) {
    const json j = parsed(
        "gen:teapot:400 --instruction-set plain --width 4 --sets random --questions any --modes batch "
        "--builders fast --threads 2");
    EXPECT_EQ(j["instruction_set"], "plain");
    EXPECT_EQ(j["width"], 4);
    ASSERT_EQ(j["scenes"][0]["rows"].size(), 1u);
    const json& row = j["scenes"][0]["rows"][0];
    ASSERT_EQ(row["ours"].size(), 1u);
    EXPECT_EQ(row["best"]["builder"], "fast");
    EXPECT_EQ(row["best"]["rays_by"]["single"], row["rays"]) << "without kernels a batch goes ray by ray";
    EXPECT_EQ(row["best"]["on_threads"]["threads"], 2);
    EXPECT_GT(number(row["best"]["on_threads"], "scaling"), 0);
    EXPECT_EQ(j["scenes"][0]["builds"][0]["on_threads"]["threads"], 2);
}
/// Rays from files take the place of those that are made, or follow them.
TEST_F(Bench, TracesTheRaysOfARender) {
    ASSERT_EQ(
        hedgerow::run(
            "render gen:cornell-box --shading path --size 30x20 --spp 2 --bounces 1 --quiet --save-rays " +
            file("rays") + " -o " + file("x.png"))
            .code,
        0);
    const std::string files = " --rays " + file("rays-0.npy") + " " + file("rays-0-shadow.npy");
    const json j = parsed("gen:cornell-box --modes batch" + files);
    const json& rows = j["scenes"][0]["rows"];
    ASSERT_EQ(rows.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(rows[i]["set"], i < 2 ? "rays-0" : "rays-0-shadow");
    EXPECT_EQ(number(rows[0], "rays"), 1200) << "a ray a sample";
    EXPECT_LT(number(rows[2], "rays"), 1200) << "one where light is looked for";
    const json both =
        parsed("gen:cornell-box --modes one --questions any --sets random -o " + file("x.svg") + files);
    ASSERT_EQ(both["scenes"][0]["rows"].size(), 3u);
    EXPECT_EQ(both["scenes"][0]["rows"][0]["set"], "random");
    EXPECT_NE(bytes_of(file("x.svg")).find("rays-0-shadow rays"), std::string::npos);

    expect_refused(2, "--rays " + file("rays-0.npy"), "name it");
    expect_refused(3, "gen:cube --rays " + file("none.npy"), "none.npy");
    std::ofstream(file("bad.csv")) << "0 0 0 1 0 0\n0 0 0 nan 0 0\n";
    expect_refused(3, "gen:cube --rays " + file("bad.csv"), "row 1 is no ray");
    std::ofstream(file("empty.csv")) << "ox,oy,oz,dx,dy,dz\n";
    expect_refused(3, "gen:cube --rays " + file("empty.csv"), "has no rays");
}

TEST_F(Bench, CountsTheSameEachTime) {
    const auto counts = [&] {
        json all;
        const json found = parsed("gen:grass:300 --modes one");
        for (const json& row : found["scenes"][0]["rows"])
            for (const json& rate : row["ours"])
                all.push_back({rate["nodes"], rate["leaves"], rate["primitives"]});
        return all;
    };
    EXPECT_EQ(counts(), counts());
}
TEST_F(Bench, NamesAFileWithoutItsFolder) {
    const std::string mesh = file("mesh.ply");
    ASSERT_EQ(run_shell(HEDGEROW_TOOL_PATH " generate gen:teapot:300 --quiet -o " + mesh).code, 0);
    const auto r = run(mesh + " --sets primary --questions closest");
    ASSERT_EQ(r.code, 0) << bytes_of(file("errors"));
    for (const char* said : {"mesh.ply: builds", "mesh.ply: rays", "primary, closest, one",
                             "primary, closest, batch", "cycles/visit", "Note: medians of 1 rounds"})
        EXPECT_NE(r.output.find(said), std::string::npos) << said << "\n" << r.output;
    EXPECT_EQ(r.output.find(folder.string()), std::string::npos);
    EXPECT_EQ(bytes_of(file("errors")), "");
    const bool alone = r.output.find("no peer is present") != std::string::npos;
    EXPECT_EQ(alone, r.output.find("against") == std::string::npos) << "ratios, or why there are none";
    EXPECT_EQ(alone, r.output.find("libembree-dev") != std::string::npos);
}
TEST_F(Bench, WritesAPageAndAChart) {
    const auto r =
        run("gen:teapot:400 gen:soup:300 --html " + file("page.html") + " -o " + file("chart.svg"));
    ASSERT_EQ(r.code, 0) << bytes_of(file("errors"));
    const std::string page = bytes_of(file("page.html")), chart = bytes_of(file("chart.svg"));
    EXPECT_EQ(page.rfind("<!DOCTYPE html>", 0), 0u);
    EXPECT_EQ(chart.rfind("<svg", 0), 0u);
    for (const auto& text : {page, chart}) {
        EXPECT_EQ(ill_formed(text), "");
        EXPECT_EQ(asked_for(text), "");
        EXPECT_EQ(text.find("nan"), std::string::npos);
        EXPECT_EQ(text.find("inf\""), std::string::npos);
        for (const char* said : {"teapot", "soup", "primary rays, closest hit", "shadow rays, any hit",
                                 "Hedgerow, a batch", "<rect"})
            EXPECT_NE(text.find(said), std::string::npos) << said;
    }
    for (const char* said : {"<table>", "diffuse rays, any hit", "Cycles a visit", "least in a batch"})
        EXPECT_NE(page.find(said), std::string::npos) << said;
    EXPECT_FALSE(fs::exists(file("page.html.part")));
}
TEST_F(Bench, SavesWhatWasFinishedWhenInterrupted) {
    EXPECT_EQ(run_interrupted({"bench", "gen:hairball:200000", "--quiet", "--rounds", "1000", "--html",
                               file("page.html")}),
              130);
    EXPECT_FALSE(fs::exists(file("page.html"))) << "that is for a whole page";
    const std::string unfinished = file("page.unfinished.html");
    if (fs::exists(unfinished)) {
        EXPECT_NE(bytes_of(unfinished).find("interrupted"), std::string::npos);
    }
}
TEST_F(Bench, RefusesWhatIsWrong) {
    const std::string cube = "gen:cube ";
    expect_refused(2, cube + "--sets primry", "did you mean 'primary'");
    expect_refused(2, cube + "--sets primary,", "--sets");
    expect_refused(2, cube + "--modes both", "one, batch");
    expect_refused(2, cube + "--questions farthest", "closest, any");
    expect_refused(2, cube + "--builders hig", "did you mean 'high'");
    expect_refused(2, cube + "--sets shadow --questions closest", "any hit");
    expect_refused(2, cube + "--instruction-set avx3", "avx3");
    expect_refused(2, cube + "--width 5", "width");
    expect_refused(3, "gen:points:100", "no triangles");
    expect_refused(3, "gen:soup:0", "is empty");
    expect_refused(3, cube + file("missing.ply"), "missing.ply");
    expect_refused(2, cube + "-o " + file("chart.png"), ".svg");
    expect_refused(1, cube + "--html " + file("no/folder/page.html"), "no folder");
    expect_refused(2, cube + "--rounds 0", "0");
    expect_refused(2, cube + "--precision double", "precision");
}

}  // namespace
