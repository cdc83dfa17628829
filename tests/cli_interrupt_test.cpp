/// Ctrl-C during each verb, at several moments of its work: the exit code, and what was there before.
#include <hedgerow/io/image.h>

#include "tool.h"

namespace {

using namespace hedgerow;
namespace fs = std::filesystem;

class Interrupted : public ToolTest {
protected:
    /// Signals the verb at each of the moments. Whatever it does then, `output` is as before.
    void expect_untouched(const std::vector<std::string>& arguments, const std::string& output) {
        for (const int milliseconds : {5, 60, 400, 1200}) {
            std::ofstream(output) << "precious";
            EXPECT_EQ(run_interrupted(arguments, milliseconds), 130)
                << arguments[0] << " " << arguments[1] << " after " << milliseconds << " ms";
            EXPECT_EQ(bytes_of(output), "precious") << arguments[0];
            for (const auto& entry : fs::directory_iterator(folder))
                EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
        }
    }
};

// Each works for at least ten seconds where it is not stopped, on any machine.
TEST_F(Interrupted, WhileGenerating) {
    expect_untouched({"generate", "gen:terrain:40M", "-o", file("a.ply"), "--quiet"}, file("a.ply"));
    expect_untouched({"info", "gen:hairball:30M"}, file("nothing"));
}

TEST_F(Interrupted, WhileBuildingAndDrawing) {
    expect_untouched({"build", "gen:soup:3M", "--builder", "high", "-o", file("a.hedgerow"), "--quiet"},
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

TEST_F(Interrupted, APictureKeepsItsFinishedRowsBesideTheOneOfBefore) {
    const std::string output = file("a.png"), unfinished = file("a.unfinished.png");
    std::ofstream(output) << "precious";
    EXPECT_EQ(run_interrupted_render(output), 130);
    EXPECT_EQ(bytes_of(output), "precious");
    if (fs::exists(unfinished)) {
        EXPECT_EQ(load_png(unfinished).width, 1600);
    }
}

}  // namespace
