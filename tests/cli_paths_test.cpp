/// `render --shading path` where something is wrong: too little memory, no room on the disk, states of other
/// work. Each ends with a message and a code, and files that were there stay as they were.
#include <hedgerow/io/image.h>

#include "tool.h"

namespace {

using namespace hedgerow;

class CliPaths : public ToolTest {
protected:
    const std::string scene = "render gen:cornell-box --shading path --quiet ";

    /// Runs the tool with files of at most 1 KiB.
    static ToolResult run_with_little_room(const std::string& arguments) {
        return run_shell("(ulimit -f 1; " HEDGEROW_TOOL_PATH " " + arguments + ") 2>&1");
    }
    /// Expects a message of the file that could not be written, and no parts of it.
    void expect_full(const ToolResult& r, const std::string& name) {
        EXPECT_EQ(r.code, 1) << r.output;
        EXPECT_NE(r.output.find(name + ": cannot be written"), std::string::npos) << r.output;
        EXPECT_NE(r.output.find("space left"), std::string::npos) << r.output;
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            EXPECT_NE(entry.path().extension(), ".part") << entry.path();
    }
};

TEST_F(CliPaths, APictureBeyondTheMemoryIsRefusedWithBothFigures) {
    const auto limited = [&](const std::string& arguments) {
        return run_shell("ulimit -v 600000; " HEDGEROW_TOOL_PATH " " + arguments + " 2>&1");
    };
    for (const std::string& output : {file("x.png"), file("x.exr")}) {
        const auto r = limited(scene + "--spp 1 --size 4000x4000 -o " + output);
        EXPECT_EQ(r.code, 1);
        EXPECT_NE(r.output.find("a picture of 4000x4000 takes at least "), std::string::npos) << r.output;
        EXPECT_NE(r.output.find(" GB of memory, and there are 0."), std::string::npos) << r.output;
    }
    EXPECT_EQ(limited(scene + "--spp 1 --size 40x40 -o " + file("x.png")).code, 0);
    expect_usage(scene + "--size 100000x100000 -o " + file("x.png"), "each from 1 to 32768");
}

TEST_F(CliPaths, AFullDiskIsToldAndLosesNothing) {
    const std::string small = scene + "--size 64x64 ";
    const std::string png = file("x.png"), exr = file("x.exr"), state = file("state");
    ASSERT_EQ(run(small + "--spp 1 --resume " + state + " -o " + png).code, 0);
    ASSERT_EQ(run(small + "--spp 1 -o " + exr).code, 0);
    const std::string old_png = bytes_of(png), old_exr = bytes_of(exr), old_state = bytes_of(state);
    expect_full(run_with_little_room(small + "--spp 2 -o " + png), png);
    expect_full(run_with_little_room(small + "--spp 2 -o " + exr), exr);
    expect_full(run_with_little_room(small + "--spp 2 --resume " + state + " -o " + png), state);
    EXPECT_TRUE(bytes_of(png) == old_png && bytes_of(exr) == old_exr && bytes_of(state) == old_state);
    // The work goes on from where it was.
    ASSERT_EQ(run(small + "--spp 2 --resume " + state + " -o " + png).code, 0);
    ASSERT_EQ(run(small + "--spp 2 -o " + file("at_once.png")).code, 0);
    EXPECT_EQ(pixels_of(png), pixels_of(file("at_once.png")));
    if (!std::filesystem::exists("/dev/full")) return;
    for (const char* name : {"full.png", "full.exr"}) {
        std::filesystem::create_symlink("/dev/full", file(name));
        const auto r = run(small + "--spp 1 -o " + file(name));
        EXPECT_EQ(r.code, 1);
        EXPECT_NE(r.output.find("cannot be written"), std::string::npos) << r.output;
    }
}

/// What the state is of is named, where the command is of something else.
TEST_F(CliPaths, AStateOfOtherWorkIsRefusedByName) {
    const std::string state = file("state"), to = " --spp 2 --resume " + state + " -o " + file("x.png");
    ASSERT_EQ(run(scene + "--size 16x12 --spp 1 --resume " + state + " -o " + file("x.png")).code, 0);
    const std::string old = bytes_of(state);
    const std::pair<const char*, const char*> changes[] = {
        {"--size 12x16", "another size: 16x12, not 12x16"},
        {"--size 16x12 --eye 1,2,3", "another camera: "},
        {"--size 16x12 --fov 50", "another camera: "},
        {"--size 16x12 --seed 7", "another seed: 0, not 7"},
        {"--size 16x12 --bounces 3", "another bounces: 64, not 3"},
        {"--size 16x12 --sampler independent", "another sampler: sobol, not independent"},
        {"--size 16x12 --filter gaussian", "another filter: box, not gaussian"},
        {"--size 16x12 --precision double", "another precision: float, not double"}};
    for (const auto& [change, said] : changes) expect_bad(scene + change + to, said);
    expect_bad("render gen:cornell-box:500 --shading path --size 16x12" + to, "another scene: ");
    EXPECT_EQ(bytes_of(state), old);
    std::ofstream(state, std::ios::binary | std::ios::trunc) << old.substr(0, old.size() / 2);
    expect_bad(scene + "--size 16x12" + to, "cut short");
}

TEST_F(CliPaths, ValuesWithoutAMeaningAreRefused) {
    const std::string to = " -o " + file("x.png");
    expect_usage(scene + "--spp 0" + to, "--spp");
    expect_usage(scene + "--eye 1,2,3 --target 1,2,3" + to, "the camera is at its target");
    expect_usage(scene + "--eye nan,2,3" + to, "--eye");
    expect_usage(scene + "--eye 1,2,3 --target 1,5,3 --up y" + to, "looks along its up direction");
    expect_usage(scene + "--bounces -1" + to, "--bounces");
    expect_usage(scene + "--time 0s" + to, "--time");
    expect_usage(scene + "--filter lanczos" + to, "--filter");
}

}  // namespace
