/// Tests Ctrl-C during each verb at several times: the exit code, the earlier output, and what is saved of
/// the unfinished work.
#include <hedgerow/io/image.h>

#include "tool.h"

namespace {

using namespace hedgerow;
namespace fs = std::filesystem;

class Interrupted : public ToolTest {
protected:
    /// Interrupts a verb after each of several times, in milliseconds. The earlier contents of `output` stay.
    void expect_untouched(const std::vector<std::string>& arguments, const std::string& output) {
        for (const int milliseconds : {5, 60, 400, 1200}) {
            std::ofstream(output) << "precious";
            EXPECT_EQ(run_interrupted(arguments, milliseconds), 130)
                << arguments[0] << " " << arguments[1] << " after " << milliseconds << " ms";
            EXPECT_TRUE(bytes_of(output) == "precious") << arguments[0];  // not printed: it may be large
            for (const auto& entry : fs::directory_iterator(folder))
                EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
        }
    }
};

// Each command below runs for several times the longest wait, on a fast machine too, if it is not stopped.
TEST_F(Interrupted, WhileGenerating) {
    expect_untouched({"generate", "gen:terrain:40M", "-o", file("a.ply"), "--quiet"}, file("a.ply"));
    expect_untouched({"info", "gen:hairball:30M"}, file("nothing"));
}

TEST_F(Interrupted, WhileBuildingAndDrawing) {
    expect_untouched({"build", "gen:soup:20M", "--builder", "high", "-o", file("a.hedgerow"), "--quiet"},
                     file("a.hedgerow"));
    expect_untouched({"render", "gen:soup:3M", "--structure", "kdtree", "-o", file("a.png"), "--quiet"},
                     file("a.png"));
    expect_untouched(
        {"draw", "gen:soup:1M", "--structure", "bvh:volume=hull", "-o", file("b.png"), "--quiet"},
        file("b.png"));
}

TEST_F(Interrupted, WhileMeasuring) {
    expect_untouched({"compare", "gen:soup:300k", "--html", file("a.html"), "--quiet"}, file("a.html"));
    expect_untouched({"bench", "gen:soup:2M", "--html", file("b.html"), "--quiet"}, file("b.html"));
}

/// An interrupted comparison writes what it has measured, and nothing of what would come after.
TEST_F(Interrupted, AComparisonKeepsWhatWasMeasured) {
    const std::string page = file("a.html"), unfinished = file("a.unfinished.html");
    // Three sizes are measured in 2.5 s, on a slow or sanitized machine later; the fourth takes longer than
    // any wait.
    const std::string kept = "growth: nodes a query";
    std::string measured;
    for (int milliseconds = 2500; milliseconds <= 160000 && measured.find(kept) == std::string::npos;
         milliseconds *= 2) {
        EXPECT_EQ(run_interrupted(
                      {"compare", "gen:soup", "--scale", "--sizes", "100,200,400,3M", "--structures",
                       "kdtree", "--sweep", "bvh:bins=4,8", "--time", "0.001", "--html", page, "--quiet"},
                      milliseconds),
                  130);
        measured = fs::exists(unfinished) ? bytes_of(unfinished) : "";
    }
    EXPECT_NE(measured.find(kept), std::string::npos) << "three sizes were measured";
    fs::remove(unfinished);

    EXPECT_EQ(
        run_interrupted({"compare", "gen:soup:60k", "--for", "overlap", "--sweep", "bvh:builder=lbvh,ploc",
                         "--sweep", "bsp:leaf_size=1,2", "--time", "0.001", "--html", page, "--quiet"},
                        4000),
        130);
    if (fs::exists(unfinished)) {
        EXPECT_NE(bytes_of(unfinished).find("a overlap query"), std::string::npos);
    }
}

TEST_F(Interrupted, APictureKeepsItsFinishedRowsBesideTheOneOfBefore) {
    const std::string output = file("a.png"), unfinished = file("a.unfinished.png");
    std::ofstream(output) << "precious";
    EXPECT_EQ(run_interrupted_render(output), 130);
    EXPECT_EQ(bytes_of(output), "precious");
    EXPECT_EQ(load_png(unfinished).width, 1600);
}

TEST_F(Interrupted, IsSaidByTheCodeWhereNobodyCanReadTheMessage) {
    const auto r = run_shell("timeout --preserve-status -s INT 1.5 " HEDGEROW_TOOL_PATH
                             " render gen:teapot:6000 --structure brute-force --size 1600x1200 -o " +
                             file("a.png") + " 2>&-");
    EXPECT_EQ(r.code, 130) << r.output;
}

}  // namespace
