/// `hedgerow compare` as its user sees it: tables, JSON, the page, messages and exit codes.
#include <algorithm>
#include <regex>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "page.h"
#include "tool.h"

namespace {

using namespace hedgerow;
namespace fs = std::filesystem;
using nlohmann::json;

struct Result : ToolResult {
    std::string errors;
};

class Compare : public ToolTest {
protected:
    /// Runs compare with few queries and little time, because figures do not matter here.
    Result run(const std::string& arguments) const {
        const bool timed = arguments.find("--time") != std::string::npos;
        const std::string command =
            HEDGEROW_TOOL_PATH " compare " + std::string(timed ? "" : "--time 0.002 ") +
            (arguments.find("--queries") != std::string::npos ? "" : "--queries 50 ") + arguments + " 2>" +
            file("errors");
        Result r{run_shell(command), bytes_of(file("errors"))};
        // Join the lines that were broken for the terminal.
        r.output = std::regex_replace(r.output, std::regex("\n  "), " ");
        return r;
    }
    json parsed(const std::string& arguments) const {
        const auto r = run(arguments + " --json");
        EXPECT_EQ(r.code, 0) << r.errors;
        return json::parse(r.output);
    }
    void expect_refused(int code, const std::string& arguments, const std::string& said) const {
        const auto r = run(arguments);
        EXPECT_EQ(r.code, code) << arguments << "\n" << r.errors;
        EXPECT_NE((r.output + r.errors).find(said), std::string::npos) << arguments << "\n" << r.errors;
    }
};

TEST_F(Compare, TellsWhatEachWayToSeeCosts) {
    const json j =
        parsed("gen:teapot --visibility --sizes 100,1k --pixels 40x30,80x60 --structures wide,kdtree");
    ASSERT_EQ(j["cases"].size(), 4u);
    std::vector<std::pair<int, int>> seen;
    for (const auto& c : j["cases"]) {
        seen.emplace_back(c["triangles"].get<int>(), c["width"].get<int>());
        EXPECT_GT(c["share_hit"], 0.05);
        EXPECT_TRUE(c["left_out"].empty());
        ASSERT_EQ(c["ways"].size(), 6u);
        double tests_of_all = 0;
        for (const auto& w : c["ways"]) {
            EXPECT_GT(w["seconds"], 0);
            EXPECT_EQ(w["tests_per_sample"] > 0, w["way"] != "beams:wide");
            const bool casts = !w["way"].get<std::string>().starts_with("raster:");
            EXPECT_EQ(w["build_seconds"] > 0, casts);
            EXPECT_EQ(w["nodes_per_sample"] > 0, casts);
            EXPECT_GT(w["bytes"], 0);
            if (w["way"] == "raster:all") tests_of_all = w["tests_per_sample"];
        }
        EXPECT_EQ(tests_of_all, c["triangles"]);
    }
    EXPECT_LT(seen[1].first, seen[2].first);
    EXPECT_EQ(seen[0], std::pair(seen[1].first, 40));
    EXPECT_EQ(seen[3].second, 80);
}

TEST_F(Compare, ShowsWaysToSeeAsTableAndPage) {
    const auto r = run("gen:cornell-box --visibility --pixels 64x48 --html " + file("v.html"));
    ASSERT_EQ(r.code, 0) << r.errors;
    for (const char* said : {"raster:tiles", "cast:wide", "beams:wide", "pays from", "bit for bit"})
        EXPECT_NE(r.output.find(said), std::string::npos) << r.output;
    const std::string page = bytes_of(file("v.html"));
    EXPECT_EQ(ill_formed(page) + asked_for(page), "");
    EXPECT_NE(page.find("<svg"), std::string::npos);
    EXPECT_NE(page.find("raster:all"), std::string::npos);
}

TEST_F(Compare, TellsWhatEachStructureCosts) {
    const json j = parsed("gen:teapot:400 --time 50 --structures bvh,kdtree,octree");
    ASSERT_EQ(j["structures"].size(), 4u) << "brute force is always there";
    EXPECT_EQ(j["structures"][0]["structure"], "brute-force");
    EXPECT_EQ(j["primitive"], "triangles");
    for (const auto& s : j["structures"]) {
        EXPECT_EQ(s["queries"].size(), 31u);
        EXPECT_GT(s["build_seconds"], 0);
        for (const auto& q : s["queries"]) EXPECT_GT(q["primitives"], 0);
    }
    EXPECT_EQ(j["break_even"].size(), 4u * 3);
    ASSERT_EQ(j["advice"].size(), 4u);
    for (const auto& a : j["advice"]) {
        EXPECT_EQ(a["structure"], a["ranking"][0]["structure"]);
        EXPECT_FALSE(a["ranking"][0]["terms"].get<std::string>().empty());
    }
}
TEST_F(Compare, HasTheSameCountsEachTime) {
    const auto counts = [&] {
        const json found = parsed("gen:grass:300 --time 50 --structures grid,bvh:builder=sweep,bins=8");
        json all;
        for (const auto& s : found["structures"])
            for (const auto& q : s["queries"])
                all.push_back({q["asked"], q["nodes"], q["leaves"], q["primitives"]});
        return all;
    };
    const json first = counts();
    EXPECT_EQ(first.size(), 3u * 31);
    EXPECT_EQ(first, counts());
}
std::ptrdiff_t lines_of(const std::string& text) {
    return std::count(text.begin(), text.end(), '\n');
}
TEST_F(Compare, PrintsAdviceAndOneTable) {
    const auto r = run("gen:segments2d:300");
    ASSERT_EQ(r.code, 0) << r.errors;
    for (const char* said :
         {"quadtree", "bvh:builder=lbvh", "a closest-hit query", "For a few queries", "For many queries",
          "For moving primitives", "For little memory", "at most 10 times", "Note: built on one thread",
          "rays that meet nothing:", "--full"})
        EXPECT_NE(r.output.find(said), std::string::npos) << said << "\n" << r.output;
    EXPECT_LT(r.output.find("For many queries"), r.output.find("build  ")) << "advice comes first";
    EXPECT_EQ(r.output.find("octree"), std::string::npos) << "which lives in space";
    EXPECT_EQ(r.output.find("break-even"), r.output.rfind("break-even")) << "only where --full is named";
    EXPECT_LT(lines_of(r.output), 60);
    EXPECT_EQ(r.errors, "");
    EXPECT_NE(run("gen:cube --quiet").output.find("For moving primitives"), std::string::npos);
}
TEST_F(Compare, PrintsAllTablesWhenAskedTo) {
    const auto r = run("gen:segments2d:300 --full");
    ASSERT_EQ(r.code, 0) << r.errors;
    for (const char* said : {"closest hit, random rays", "8 nearest", "box overlap", "break-even", "all by"})
        EXPECT_NE(r.output.find(said), std::string::npos) << said << "\n" << r.output;
}
TEST_F(Compare, CountsWithoutTimes) {
    const json j = parsed("gen:teapot:300 --counts --for closest-hit --structures bvh,octree");
    ASSERT_EQ(j["structures"].size(), 3u);
    for (const auto& s : j["structures"]) {
        ASSERT_EQ(s["queries"].size(), 3u) << "of that kind alone";
        for (const auto& q : s["queries"]) {
            EXPECT_GE(q["asked"], 49);
            EXPECT_FALSE(q.contains("seconds"));
        }
    }
    EXPECT_EQ(j.dump().find("seconds"), std::string::npos) << j;
    EXPECT_FALSE(j.contains("advice")) << "which rests on times";
    const auto r = run("gen:teapot:300 --counts --structures bvh,octree --full");
    ASSERT_EQ(r.code, 0) << r.errors;
    EXPECT_NE(r.output.find("nothing is timed"), std::string::npos) << r.output;
    EXPECT_EQ(r.output.find("nan"), std::string::npos) << r.output;
    // Tables, laws and plots of times are left out everywhere.
    for (const char* what : {"--full", "--sweep bvh:bins=4,8,16", "--scale --sizes 100,200,400"}) {
        const std::string arguments = std::string("gen:soup:300 --counts --structures bvh ") + what;
        const auto shown = run(arguments + " --html " + file("page.html"));
        ASSERT_EQ(shown.code, 0) << shown.errors;
        for (const std::string& text : {shown.output, bytes_of(file("page.html")), parsed(arguments).dump()})
            for (const char* time : {"seconds", "build", "time a query", "spread"})
                EXPECT_EQ(text.find(time), std::string::npos) << what << ": " << time << "\n" << text;
        EXPECT_NE(shown.output.find("primitives"), std::string::npos) << shown.output;
    }
}
TEST_F(Compare, SeesInteriorsFromInside) {
    const std::string rest = " --queries 400 --counts --for closest-hit --structures grid,kdtree,bvh";
    const std::string outside = " --eye 30,-30,20 --target 6,4,1";
    const json from_inside = parsed("gen:interior:20000" + rest),
               from_outside = parsed("gen:interior:20000" + rest + outside);
    const auto tests = [](const json& j, std::size_t structure) {
        return j["structures"][structure]["queries"][0]["primitives"].get<double>();
    };
    EXPECT_GT(tests(from_inside, 1), 2 * tests(from_outside, 1)) << "a grid's cells are full of small things";
    EXPECT_GT(tests(from_inside, 1), 4 * tests(from_inside, 3)) << "a BVH's leaves are not";
    EXPECT_EQ(from_inside["seen_from_outside"], 1);
    EXPECT_LT(from_outside["seen_from_outside"], 0.5);
    for (const auto& set : from_inside["rays"]) EXPECT_LE(set["missed"], set["rays"]);
    EXPECT_LT(from_inside["rays"][0]["missed"], 100) << "through the windows";

    // Warn of a camera outside a large interior.
    const std::string large = "gen:interior:100000 --queries 100 --counts --for closest-hit --structures bvh";
    const auto warned = run(large + outside), not_warned = run(large);
    EXPECT_NE(warned.output.find("look from inside with --eye"), std::string::npos) << warned.output;
    EXPECT_EQ(not_warned.output.find("look from inside"), std::string::npos) << not_warned.output;
}
TEST_F(Compare, SaysWhichStructureIsBestInsideAndWhy) {
    const json j =
        parsed("gen:interior:50000 --queries 400 --time 0.05 --structures grid,octree,kdtree,bvh,wide");
    const json& many = j["advice"][1];
    EXPECT_EQ(many["need"], "many queries");
    const json& best = many["ranking"][0];
    EXPECT_EQ(many["structure"], best["structure"]);
    EXPECT_NE(many["reason"].get<std::string>().find(" tests a query"), std::string::npos) << many["reason"];
    EXPECT_NE(many["reason"].get<std::string>().find(" takes "), std::string::npos) << many["reason"];
    EXPECT_NE(run("gen:interior:20000 --structures wide").output.find("counted by a walk without them"),
              std::string::npos);
}
TEST_F(Compare, IsAboutTheQueryThatIsAskedFor) {
    const json j = parsed("gen:points:300 --structures kdtree --for overlap");
    EXPECT_EQ(j["ask"], "overlap");
    EXPECT_EQ(parsed("gen:points:300 --structures kdtree")["ask"], "nearest");
    expect_refused(2, "gen:points:300 --structures kdtree --for any-hit", "cannot be asked that");
}
TEST_F(Compare, SweepsAnOption) {
    const json j = parsed("gen:soup:300 --sweep grid:resolution=2..32 --sweep bvh:builder=binned,sweep");
    ASSERT_EQ(j["sweeps"].size(), 2u);
    const json& grid = j["sweeps"][0];
    EXPECT_EQ(grid["values"], (json{"2", "4", "8", "16", "32"}));
    ASSERT_EQ(grid["structures"].size(), 5u);
    const auto figure = [&](std::size_t i, const char* name) {
        return grid["structures"][i]["queries"][2][name].get<double>();
    };
    EXPECT_GT(figure(0, "primitives"), figure(4, "primitives")) << "too few cells: long lists";
    EXPECT_LT(figure(0, "nodes"), figure(4, "nodes")) << "too many cells: many steps";
    EXPECT_FALSE(j.contains("structures"));
}
TEST_F(Compare, FitsLawsOfGrowth) {
    const json j = parsed("gen:soup --scale --sizes 200,800,3200 --structures bvh,grid");
    ASSERT_EQ(j["scale"]["scenes"].size(), 3u);
    EXPECT_EQ(j["scale"]["scenes"][2]["size"], 3200);
    bool seen = false;
    for (const auto& g : j["scale"]["growth"]) {
        EXPECT_EQ(g["values"].size(), 3u);
        EXPECT_EQ(g["fits"].size(), 5u);
        if (g["structure"] != "brute-force" || g["figure"] != "primitives a query") continue;
        seen = true;
        for (const auto& f : g["fits"])
            if (f["law"] == "power") {
                EXPECT_NEAR(f["b"].get<double>(), 1, 1e-9) << "brute force tests them all";
            }
    }
    EXPECT_TRUE(seen);
}
TEST_F(Compare, WritesOnePageThatNeedsNoOther) {
    for (const char* arguments :
         {"gen:teapot:300", "gen:soup:200 --sweep kdtree:builder=median,sah --sweep octree:leaf_size=1..8",
          "gen:soup --scale --sizes 100,200,400 --structures bvh,kdtree"}) {
        const auto r = run(std::string(arguments) + " --html " + file("page.html"));
        ASSERT_EQ(r.code, 0) << r.errors;
        const std::string page = bytes_of(file("page.html"));
        EXPECT_EQ(page.rfind("<!DOCTYPE html>", 0), 0u);
        EXPECT_EQ(ill_formed(page), "") << arguments;
        EXPECT_NE(page.find("<polyline"), std::string::npos) << arguments;
        EXPECT_NE(page.find("<table>"), std::string::npos);
        EXPECT_EQ(asked_for(page), "");
        EXPECT_EQ(page.find("nan"), std::string::npos) << arguments;
        EXPECT_EQ(page.find("inf,"), std::string::npos) << arguments;
        EXPECT_FALSE(fs::exists(file("page.html.part")));
    }
}
TEST_F(Compare, RefusesWhatIsWrong) {
    expect_refused(2, "", "scene");
    expect_refused(2, "gen:cube --for nonsense", "nonsense");
    expect_refused(2, "gen:cube --sizes 1,2,3", "--scale");
    expect_refused(2, "gen:cube --pixels 10x10", "--visibility");
    expect_refused(2, "gen:cube --visibility --pixels 10", "WIDTHxHEIGHT");
    expect_refused(2, "gen:cube --visibility --pixels 10x10,", "WIDTHxHEIGHT");
    expect_refused(2, "gen:cube --visibility --scale", "leave out");
    expect_refused(2, "gen:cube --visibility --structures kdtre", "kdtree");
    expect_refused(3, "gen:points --visibility", "only triangles");
    expect_refused(2, "gen:cube --queries 1", "1");
    expect_refused(3, "gen:points2d:100 --eye 1,2,3", "in space");
    expect_refused(2, "gen:cube --eye 0,0,9 --target 0,0,0", "--eye");
    expect_refused(2, "gen:cube --structures kdtre", "did you mean 'kdtree'");
    expect_refused(2, "gen:cube --structures bins=8", "option without a structure");
    expect_refused(2, "gen:cube --structures quadtree", "in space use 'octree'");
    expect_refused(2, "gen:cube --sweep grid:resolution=8", "no option has several values");
    expect_refused(2, "gen:cube --sweep grid:resolutoin=8..16", "did you mean 'resolution'");
    expect_refused(2, "gen:cube --sweep grid:resolution=9..8", "no range");
    expect_refused(2, "gen:cube --scale --sizes 10,20", "at least three");
    expect_refused(3, "gen:soup:0 --structures bvh", "no primitives");
    expect_refused(2, file("mesh.ply") + " --scale", "gen:terrain");
    expect_refused(1, "gen:cube --html " + file("no/folder/page.html"), "no folder");
}

}  // namespace
