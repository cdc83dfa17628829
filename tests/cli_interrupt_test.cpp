/// Tests Ctrl-C and the signals of job schedulers during each verb at several times: the exit code, the
/// earlier output, and what is saved of the unfinished work.
#include <cstring>
#include <utility>

#include <sys/stat.h>

#include <hedgerow/io/image.h>

#include "tool.h"

namespace {

using namespace hedgerow;
namespace fs = std::filesystem;

class Interrupted : public ToolTest {
protected:
    /// Interrupts a verb after each of several times, in milliseconds. The earlier contents of `output` stay.
    void expect_untouched(const std::vector<std::string>& arguments, const std::string& output) {
        // SIGINT has its code also where it comes before the tool listens to signals; others come later.
        for (const auto& [milliseconds, signal] :
             {std::pair{5, SIGINT}, {60, SIGINT}, {400, SIGINT}, {1200, SIGTERM}, {1200, SIGUSR1}}) {
            std::ofstream(output) << "precious";
            EXPECT_EQ(run_interrupted(arguments, milliseconds, signal), 130)
                << arguments[0] << " " << arguments[1] << " after " << milliseconds << " ms by "
                << strsignal(signal);
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

TEST_F(Interrupted, ByTimeoutWhichSendsEachSignalTwice) {
    const std::string unfinished = file("a.unfinished.png");
    for (const char* signal : {"INT", "TERM", "USR1"}) {
        fs::remove(unfinished);
        // Wait longer and longer until some rows are done.
        for (int seconds = 1; !fs::exists(unfinished) && seconds < 60; seconds *= 4) {
            const auto r = run_shell(std::string("timeout --preserve-status -s ") + signal + " " +
                                     std::to_string(seconds) +
                                     " " HEDGEROW_TOOL_PATH
                                     " render gen:teapot:6000 --structure brute-force --size 1600x1200 -o " +
                                     file("a.png") + " 2>&-");
            EXPECT_EQ(r.code, 130) << signal << r.output;  // though nobody can read the message
        }
        EXPECT_TRUE(fs::exists(unfinished)) << signal;
    }
}

TEST_F(Interrupted, WhileItWaitsForInput) {
    ASSERT_EQ(mkfifo(file("pipe").c_str(), 0600), 0);
    for (const char* signal : {"INT", "TERM", "USR1"}) {
        const std::string query = std::string(" timeout --preserve-status -k 8 -s ") + signal +
                                  " 1 " HEDGEROW_TOOL_PATH " query nearest gen:teapot:300 -k 1 -o " +
                                  file("a.npy") + " --format csv --quiet 2>&1 --from ";
        EXPECT_EQ(run_shell(query + file("pipe")).code, 130) << signal << ", a pipe that nobody writes to";
        EXPECT_EQ(run_shell("exec 3<>" + file("pipe") + ";" + query + "- <&3").code, 130)
            << signal << ", a silent standard input";
    }
}

TEST_F(Interrupted, NotBySignalsThatWereIgnored) {
    const auto r = run_shell(
        "trap '' INT TERM USR1; " HEDGEROW_TOOL_PATH " generate gen:terrain:3M -o " + file("a.ply") +
        " --quiet & p=$!; sleep 0.2; kill -INT $p; kill -TERM $p; kill -USR1 $p; wait $p");
    EXPECT_EQ(r.code, 0) << r.output;
    EXPECT_TRUE(fs::exists(file("a.ply")));
}

}  // namespace
