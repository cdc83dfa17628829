/// The rows of `hedgerow query`: in every format, by pipe, interrupted, and bad ones.
#include <hedgerow/hedgerow.h>
#include <hedgerow/io/npy.h>
#include <hedgerow/io/rows.h>
#include <hedgerow/scenes/generate.h>
#include <hedgerow/scenes/random.h>

#include <nlohmann/json.hpp>

#include "query_tool.h"

namespace {

using namespace hedgerow;
namespace fs = std::filesystem;
using QueryRows = QueryTest;

TEST_F(QueryRows, ReadsAndWritesPipes) {
    const std::string tool = HEDGEROW_TOOL_PATH " query closest-point gen:cube --quiet --from - ";
    EXPECT_EQ(
        run_shell("printf '0,0,9\\n9,0,0\\n' | " + tool + "--format csv --output-format csv -o -").output,
        run_shell("echo '[[0,0,9],[9,0,0]]' | " + tool + "--format json --output-format csv -o -").output);
    const auto json =
        run_shell("printf '0 0 9\\n' | " + tool + "--format csv --output-format json -o -").output;
    const auto parsed = nlohmann::json::parse(json);
    ASSERT_EQ(parsed.size(), 1u);
    EXPECT_GT(parsed[0]["distance"].get<double>(), 7.0);
    // A million rows by pipe are the same as from a file.
    write_rows<float>("rows.npy", 300000, 3);
    expect_done("query closest-point gen:cube --quiet --from " + file("rows.npy") + " -o " + file("a.npy"));
    EXPECT_EQ(run_shell("cat " + file("rows.npy") + " | " + tool + "--format npy -o " + file("b.npy")).code,
              0);
    EXPECT_EQ(run_shell("cat " + file("rows.npy") + " | " + tool +
                        "--format npy --output-format npy -o - | cat > " + file("c.npy"))
                  .code,
              0);
    EXPECT_EQ(run_shell("mkfifo " + file("f") + "; cat " + file("rows.npy") + " > " + file("f") + " & " +
                        HEDGEROW_TOOL_PATH + " query closest-point gen:cube --quiet --format npy --from " +
                        file("f") + " -o " + file("d.npy"))
                  .code,
              0);
    for (const char* name : {"b.npy", "c.npy", "d.npy"})
        EXPECT_TRUE(bytes_of(file(name)) == bytes_of(file("a.npy"))) << name;
    EXPECT_EQ(run_shell(tool + "--format csv -o " + file("x.csv") + " </dev/null 2>&1").code, 3);
    EXPECT_EQ(run_shell(tool + "--format csv -o " + file("x.csv") + " <&- 2>&1").code, 3);
    expect_usage("query closest-point gen:cube --from - -o " + file("x.csv"), "--format");
    const auto lists =
        run_shell("echo 0,0,0 | " HEDGEROW_TOOL_PATH
                  " query within gen:cube --radius 1 --from - --format csv --output-format npy -o - "
                  "2>&1 | cat");
    EXPECT_NE(lists.output.find("number of rows"), std::string::npos) << lists.output;
}

TEST_F(QueryRows, SavedIndexesAreQueried) {
    expect_done("build gen:teapot:300 --quiet -o " + file("t.hedgerow"));
    write_rows<float>("3.npy", 100, 3);
    for (const std::string scene : {"gen:teapot:300", "t.hedgerow"})
        expect_done("query nearest " + (scene[0] == 'g' ? scene : file(scene)) + " -k 2 --from " +
                    file("3.npy") + " -o " + file(scene[0] == 'g' ? "a.npy" : "b.npy"));
    EXPECT_TRUE(bytes_of(file("a.npy")) == bytes_of(file("b.npy")));
}

TEST_F(QueryRows, SavedIndexesOfPointsAreQueried) {
    write_rows<float>("3.npy", 100, 3), write_rows<float>("2.npy", 100, 2);
    for (const auto& [scene, rows] : {std::pair<std::string, std::string>{"gen:points:300", "3.npy"},
                                      {"gen:points2d:300", "2.npy"},
                                      {"gen:points:300 --precision double", "3.npy"}}) {
        expect_done("build " + scene + " --quiet -o " + file("p.hedgerow"));
        const std::string rest = " --from " + file(rows) + " -o ";
        for (const std::string kind : {"nearest -k 2 ", "closest-point ", "count --radius 0.2 "}) {
            expect_done("query " + kind + scene + rest + file("a.npy"));
            expect_done("query " + kind + file("p.hedgerow") + rest + file("b.npy"));
            EXPECT_TRUE(bytes_of(file("a.npy")) == bytes_of(file("b.npy"))) << kind << scene;
            expect_done("query " + kind + file("p.hedgerow") + " --structure kdtree" + rest + file("b.npy"));
            EXPECT_TRUE(bytes_of(file("a.npy")) == bytes_of(file("b.npy"))) << kind << scene;
        }
    }
    const auto built = run("build gen:points:300 -o " + file("p.hedgerow"));
    EXPECT_NE(built.output.find("300 points (float)"), std::string::npos) << built.output;
    EXPECT_NE(run("info " + file("p.hedgerow")).output.find("coincident_points"), std::string::npos);
    expect_done("render " + file("p.hedgerow") + " --quiet --size 32x32 -o " + file("p.png"));
    expect_bad("build gen:spheres:10 -o " + file("s.hedgerow"), "triangles or of points");
    EXPECT_FALSE(fs::exists(file("s.hedgerow")));
}

TEST_F(QueryRows, RowsThatAreNotFiniteHaveNoAnswerAndAreNamed) {
    write("p.csv", "0,0,9\n1,nan,0\n0,0,-9\ninf,0,0\n");
    auto r = run("query closest-point gen:cube --quiet --from " + file("p.csv") + " -o " + file("a.csv"));
    EXPECT_EQ(r.code, 0) << r.output;
    EXPECT_NE(r.output.find("p.csv: row 1,"), std::string::npos) << r.output;
    EXPECT_NE(r.output.find("1 later"), std::string::npos) << r.output;
    const auto ids = rows_of(file("a.csv"), {"primitive"});
    EXPECT_EQ(ids[1], 4294967295.0);
    EXPECT_EQ(ids[3], 4294967295.0);
    EXPECT_LT(ids[2], 12.0);
    r = run("query within gen:cube --radius 9 --quiet --from " + file("p.csv") + " -o " + file("a.csv"));
    for (const double query : rows_of(file("a.csv"), {"query"})) EXPECT_TRUE(query == 0 || query == 2);
    write("r.json", "[[0,0,9,0,0,-1],[0,0,9,0,0,null],[null,0,9,0,0,-1],[0,0,9,0,0,-1,0,null]]");
    for (const std::string kind : {"closest-hit", "any-hit", "all-hits"}) {
        r = run("query " + kind + " gen:cube --quiet --from " + file("r.json") + " -o " + file("a.json"));
        EXPECT_EQ(r.code, 0) << r.output;
        EXPECT_NE(r.output.find("r.json: row 1,"), std::string::npos) << r.output;
        const auto answers = nlohmann::json::parse(bytes_of(file("a.json")));
        if (kind == "any-hit") {
            EXPECT_EQ(answers,
                      nlohmann::json::parse(R"([{"hit":true},{"hit":false},{"hit":false},{"hit":true}])"));
        }
    }
    write("b.csv", "-inf,-inf,-inf,inf,inf,inf\n1,1,1,0,0,0\nnan,0,0,1,1,1\n");
    r = run("query overlap gen:cube --quiet --from " + file("b.csv") + " -o " + file("a.csv"));
    EXPECT_NE(r.output.find("b.csv: row 2,"), std::string::npos) << r.output;
    EXPECT_EQ(rows_of(file("a.csv"), {"query"}), std::vector<double>(12, 0.0))
        << "all of the cube, or nothing";
}

TEST_F(QueryRows, MoreNeighboursThanThereAreAreAllOfThem) {
    write("p.csv", "0,0,9\n");
    expect_done("query nearest gen:cube -k 1000 --from " + file("p.csv") + " -o " + file("a.csv"));
    EXPECT_EQ(rows_of(file("a.csv"), {"query"}).size(), 12u);
    expect_done("query within gen:cube --radius 0 --from " + file("p.csv") + " -o " + file("a.csv"));
    EXPECT_TRUE(rows_of(file("a.csv"), {"query"}).empty());
    // Rows without a query in them are no fault.
    write("none.csv", "x,y,z\n");
    expect_done("query nearest gen:cube -k 3 --from " + file("none.csv") + " -o " + file("a.npy"));
    EXPECT_TRUE(rows_of(file("a.npy"), {"query"}).empty());
}

TEST_F(QueryRows, MoreAnswersThanWaitInMemoryAreInTheirOrder) {
    // About 48 MB of records in one chunk, of which 32 MB may wait.
    write_rows<float>("3.npy", 10000, 3);
    expect_done("query within gen:teapot:300 --radius 1e9 --quiet --from " + file("3.npy") + " -o " +
                file("a.npy"));
    const auto set = std::get<TriangleMesh<float>>(generate<float>(parse_scene_spec("gen:teapot:300")));
    const auto queries = rows_of(file("a.npy"), {"query"});
    ASSERT_EQ(queries.size(), 10000 * set.size());
    ASSERT_GT(queries.size() * 16, std::size_t(1) << 25);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const std::size_t query = i / set.size();
        ASSERT_EQ(queries[i], double(query));
    }
}

TEST_F(QueryRows, MemoryDoesNotGrowWithTheRows) {
#ifdef HEDGEROW_SANITIZED
    GTEST_SKIP() << "sanitizers keep memory that was freed";
#endif
    // Rows and answers of the larger file take 72 MB and 120 MB.
    write_rows<float>("few.npy", 600000, 3), write_rows<float>("many.npy", 6000000, 3);
    const std::string asked = "query closest-point gen:cube --quiet -o " + file("a.npy") + " --from ";
    const long few = peak_memory(asked + file("few.npy")), many = peak_memory(asked + file("many.npy"));
    EXPECT_LT(many, few + 20000) << few << " and " << many << " KiB";
    EXPECT_LT(many, 200000);
}

TEST_F(QueryRows, WrongUsageIsTwo) {
    write("p.csv", "0,0,9\n");
    const std::string from = " --from " + file("p.csv"), to = " -o " + file("x.csv");
    expect_usage("query closest-pint gen:cube" + from + to, "did you mean 'closest-point'");
    expect_usage("query nearest gen:cube" + from + to, "needs --count");
    expect_usage("query first-hits gen:cube" + from + to, "needs --count");
    expect_usage("query first-hits gen:cube --count 2 --radius 1" + from + to, "takes no --radius");
    expect_usage("query first-hits gen:cube --count 2 --factor 2" + from + to, "takes no --factor");
    expect_usage("query nearest gen:cube --count 0" + from + to, "at least 1");
    expect_usage("query within gen:cube" + from + to, "needs --radius");
    expect_usage("query within gen:cube --radius -1" + from + to, "at least 0");
    expect_usage("query within gen:cube --radius nan" + from + to, "finite");
    expect_usage("query closest-hit gen:cube --radius 1" + from + to, "takes no --radius");
    expect_usage("query side gen:cube --radius 1" + from + to, "takes no --radius");
    expect_usage("query closest-point gen:cube --radius -1" + from + to, "at least 0");
    expect_usage("query nearest gen:cube -k 1 --radius nan" + from + to, "finite");
    for (const std::string bad : {"0.99", "-2", "0"})
        expect_usage("query closest-point gen:cube --factor " + bad + from + to, "at least 1");
    expect_usage("query nearest gen:cube -k 1 --factor nan" + from + to, "finite");
    expect_usage("query within gen:cube --radius 1 --factor 2" + from + to, "takes no --factor");
    expect_usage("query pairs-within gen:points --radius 1 --factor 2" + to, "takes no --factor");
    expect_usage("query nearest gen:cube -k 1 --feature" + from + to, "takes no --feature");
    expect_usage("query self-intersections gen:cube --feature" + to, "takes no --feature");
    expect_usage("query closest-point gen:cube --count 1" + from + to, "takes no --count");
    expect_usage("query closest-point gen:cube --with gen:cube" + from + to, "leave out --with");
    expect_usage("query closest-point gen:cube" + to, "needs --from");
    expect_usage("query closest-point gen:cube" + from + " -o " + file("x.txt"), "npy, csv or json");
    expect_usage("query closest-point gen:cube --structure kdtre" + from + to, "did you mean 'kdtree'");
    EXPECT_FALSE(fs::exists(file("x.csv")));
}

TEST_F(QueryRows, BadInputIsThreeAndNamed) {
    const auto expect_refused = [&](const std::string& name, const std::string& said) {
        expect_bad("query closest-point gen:cube --from " + file(name) + " -o " + file("x.npy"), said);
        EXPECT_FALSE(fs::exists(file("x.npy")));
    };
    expect_refused("missing.csv", "no such file");
    write("p.csv", "1,2,3\n1,2\n");
    expect_refused("p.csv", "line 2");
    write_rows<float>("6.npy", 10, 6);
    expect_refused("6.npy", "(N, 3)");
    write_rows<float>("3.npy", 1000, 3);
    for (const std::size_t length : {5u, 60u, 128u, 1000u, 12000u}) {
        write("cut.npy", bytes_of(file("3.npy")).substr(0, length));
        expect_refused("cut.npy", "cut.npy");
    }
    const std::string from = " --from " + file("3.npy") + " -o " + file("x.npy");
    expect_bad("query closest-hit gen:points" + from, "rays pass between points");
    expect_bad("query closest-point " + file("missing.ply") + from, "missing.ply");
    write("none.csv", "x,y,z\n");
    expect_bad("query closest-point " + file("none.csv") + from, "none.csv");
    expect_usage("query closest-point gen:cube --structure hash-grid" + from, "holds points alone");
}

TEST_F(QueryRows, RowsBeforeAFaultAreAnswered) {
    std::string text;
    for (int i = 0; i < 200000; ++i) text += "0,0,9\n";
    write("p.csv", text + "0,0,oops\n");
    expect_bad("query closest-point gen:cube --from " + file("p.csv") + " -o " + file("a.npy"),
               "line 200001: 'oops' where a number should stand");
    EXPECT_FALSE(fs::exists(file("a.npy")));
    EXPECT_EQ(rows_of(file("a.unfinished.npy"), {"primitive"}).size(), 200000u);
}

TEST_F(QueryRows, FullDisksAreOne) {
    if (!fs::exists("/dev/full")) GTEST_SKIP();
    write_rows<float>("3.npy", 20000, 3);
    for (const char* format : {"npy", "csv", "json"})
        expect_failure(1,
                       "query closest-point gen:cube --from " + file("3.npy") + " --output-format " + format +
                           " -o /dev/full",
                       "No space left");
    EXPECT_EQ(run_shell(HEDGEROW_TOOL_PATH " query closest-point gen:cube --from " + file("3.npy") +
                        " --output-format csv -o - >/dev/full 2>&1")
                  .code,
              1);
    expect_failure(1, "query closest-point gen:cube --from " + file("3.npy") + " -o " + file("no/x.npy"),
                   "no folder");
}

TEST_F(QueryRows, AnInterruptLeavesTheRowsThatWereFinished) {
    // Brute force over enough triangles takes minutes over these rows.
    write_rows<float>("3.npy", 3000000, 3);
    for (const std::string ending : {"npy", "csv", "json"}) {
        const std::string output = file("a." + ending), unfinished = file("a.unfinished." + ending);
        std::ofstream(output) << "precious";
        for (int milliseconds = 2000; milliseconds <= 60000; milliseconds *= 3) {
            EXPECT_EQ(run_interrupted({"query", "nearest", "gen:teapot:3000", "-k", "4", "--structure",
                                       "brute-force", "--from", file("3.npy"), "--quiet", "-o", output},
                                      milliseconds),
                      130);
            if (fs::exists(unfinished)) break;
        }
        EXPECT_EQ(bytes_of(output), "precious");
        ASSERT_TRUE(fs::exists(unfinished));
        const auto rows = rows_of(unfinished, {"query"});
        ASSERT_GT(rows.size(), 0u);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const std::size_t query = i / 4;
            ASSERT_EQ(rows[i], double(query));
        }
    }
}

TEST_F(QueryRows, TheSummaryIsJsonWhereAsked) {
    write_rows<float>("3.npy", 100, 3);
    const auto r =
        run("query nearest gen:cube -k 2 --json --quiet --from " + file("3.npy") + " -o " + file("a.csv"));
    ASSERT_EQ(r.code, 0) << r.output;
    const auto j = nlohmann::json::parse(r.output);
    EXPECT_EQ(j["queries"], 100);
    EXPECT_EQ(j["rows"], 200);
    EXPECT_EQ(j["unusable"], 0);
    EXPECT_EQ(j["finished"], true);
    EXPECT_EQ(j["output"], file("a.csv"));
}

}  // namespace
