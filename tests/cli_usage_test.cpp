/// The tool's messages and exit codes for wrong usage, outputs that cannot be written, and too little memory.
#include <hedgerow/io/image.h>

#include "tool.h"

namespace {

using namespace hedgerow;
using Usage = ToolTest;

TEST_F(Usage, UnknownNamesAreTwoAndSuggestTheNearest) {
    const std::string to = " -o " + file("x.png");
    expect_usage("rendr gen:cube" + to, "did you mean 'render'");
    expect_usage("render gen:cube --shadin depth" + to, "did you mean '--shading'");
    expect_usage("render gen:cube --structure kdtre" + to, "did you mean 'kdtree'");
    expect_usage("render gen:cube --structure bvh:bilder=sweep" + to, "did you mean 'builder'");
    expect_usage("render gen:cube --structure bvh:builder=swep" + to, "did you mean 'sweep'");
    expect_usage("render gen:cube --structure quadtree" + to, "in space use 'octree'");
    expect_usage("render gen:cub" + to, "did you mean 'cube'");
    expect_usage("compare gen:cube --sweep bvh:bins=9..1", "no range");
    expect_usage("bench gen:cube --sets primry", "did you mean 'primary'");
    expect_usage("render gen:cube more" + to, "one argument too many");
}

TEST_F(Usage, ValuesOutOfRangeAreTwo) {
    const std::string to = " -o " + file("x.png");
    for (const char* const bad : {"--eye nan,0,0",
                                  "--eye inf,0,0",
                                  "--eye 1e99,0,0",
                                  "--target 0,0,-inf",
                                  "--fov nan",
                                  "--light 0,nan,0",
                                  "--light 0,0,0",
                                  "--radius inf",
                                  "--seed 99999999999999999999",
                                  "--seed -1",
                                  "--seed 1.5",
                                  "--steps-max 18446744073709551616",
                                  "--threads 4294967297",
                                  "--spp 0",
                                  "--size 0x0",
                                  "--size 4294967304x4294967304",
                                  "--size 8x",
                                  "--size x8",
                                  "--size 8x8x8",
                                  "--size ' 8x8'",
                                  "--structure octree:max_depth=33",
                                  "--structure ''",
                                  "--up w",
                                  "--eye 1,1,1 --target 1,1,1",
                                  "--eye 1e30,0,0",
                                  "--eye 0,0,5 --target 0,0,0 --up z"}) {
        const auto r = run("render gen:cube --quiet " + std::string(bad) + to);
        EXPECT_EQ(r.code, 2) << bad << "\n" << r.output;
        EXPECT_FALSE(r.output.empty()) << bad;
        EXPECT_FALSE(std::filesystem::exists(file("x.png"))) << bad;
    }
    expect_usage("compare gen:cube --time nan", "finite");
    expect_usage("render gen:cube --eye 1e39,0,0" + to, "from -3.4e38 to 3.4e38");
    expect_usage("bench gen:cube --width 3000000000", "from -2^31 to 2^31 - 1");
    expect_usage("render gen:cube -o ''", "empty");
    expect_usage("render '' -o x.png", "empty");
    expect_usage("render gen:cube -o " + file("x.jpg"), ".png");
    expect_usage("build gen:cube -o " + file("x.ply"), "NAME.hedgerow");
    expect_usage("info gen:cube:3000000000", "too large");
}

TEST_F(Usage, AnUnknownInstructionSetIsTwo) {
    const auto r = run_shell("HEDGEROW_INSTRUCTION_SET=foo " HEDGEROW_TOOL_PATH " info gen:cube 2>&1");
    EXPECT_EQ(r.code, 2);
    EXPECT_NE(r.output.find("HEDGEROW_INSTRUCTION_SET"), std::string::npos) << r.output;
    EXPECT_NE(r.output.find("plain"), std::string::npos) << r.output;
}

TEST_F(Usage, OutputsThatCannotBeWrittenAreOneBeforeAnyWork) {
    expect_failure(1, "render gen:cube -o " + file("no/such/folder/x.png"), "no folder");
    expect_failure(1, "build gen:cube -o " + file("no/such/folder/x.hedgerow"), "no folder");
    std::filesystem::create_directory(file("folder.png"));
    expect_failure(1, "render gen:cube -o " + file("folder.png"), "directory");
    for (const std::string ending : {".png", ".html", ".svg", ".hedgerow", ".ply"}) {
        const std::string path = file("read_only" + ending);
        std::ofstream(path) << "precious";
        std::filesystem::permissions(path, std::filesystem::perms::owner_read);
        const std::string verb = ending == ".png"        ? "render gen:cube -o "
                                 : ending == ".html"     ? "compare gen:cube --html "
                                 : ending == ".svg"      ? "draw gen:points2d:50 -o "
                                 : ending == ".hedgerow" ? "build gen:cube -o "
                                                         : "generate gen:cube -o ";
        expect_failure(1, verb + path, "read-only");
        EXPECT_EQ(bytes_of(path), "precious");
    }
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 6) << "nothing beside them";
}

TEST_F(Usage, ResultsThatCannotBePrintedAreOne) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP();
    for (const std::string arguments :
         {"info gen:cube", "--help", "compare gen:cube:100 --queries 16 --time 0.001",
          "generate gen:cube -o "}) {
        const std::string all = arguments.ends_with("-o ") ? arguments + file("c.ply") : arguments;
        EXPECT_EQ(run_shell(HEDGEROW_TOOL_PATH " " + all + " 2>/dev/null >/dev/full").code, 1) << all;
        EXPECT_EQ(run_shell(HEDGEROW_TOOL_PATH " " + all + " 2>/dev/null >&-").code, 1) << all << ", closed";
    }
    EXPECT_EQ(bytes_of(file("c.ply")).rfind("ply", 0), 0u) << "no message went into the file";
}

TEST_F(Usage, TheTableIsPrintedWhateverHappensToThePage) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP();
    std::filesystem::create_symlink("/dev/full", file("full.html"));
    const auto r =
        run("compare gen:cube:100 --structures bvh --queries 16 --time 0.001 --html " + file("full.html"));
    EXPECT_EQ(r.code, 1) << r.output;
    EXPECT_NE(r.output.find("brute-force"), std::string::npos) << r.output;
    EXPECT_NE(r.output.find("No space left"), std::string::npos) << r.output;
}

TEST_F(Usage, TooLittleMemoryIsOneWithTheFigure) {
#ifdef HEDGEROW_SANITIZED
    GTEST_SKIP() << "sanitizers take more addresses than any limit leaves";
#endif
    const auto limited = [](const std::string& arguments) {
        return run_shell("ulimit -v 2000000; " HEDGEROW_TOOL_PATH " " + arguments + " 2>&1");
    };
    for (const auto& [arguments, said] :
         {std::pair<std::string, const char*>{"info gen:soup:1000M", "84 GB"},
          {"render gen:cube --size 32768x32768 -o " + file("x.png"), "16.1 GB"},
          {"info gen:terrain:75M", "memory ran out while generating gen:terrain"}}) {
        const auto r = limited(arguments);
        EXPECT_EQ(r.code, 1) << r.output;
        EXPECT_NE(r.output.find(said), std::string::npos) << r.output;
        EXPECT_EQ(r.output.find("bad_alloc"), std::string::npos) << r.output;
    }
    const auto lines = limited("draw gen:points2d:50 --size 32768x32768 -o " + file("x.svg"));
    EXPECT_EQ(lines.code, 0) << lines.output << ": no pixel of an SVG is held";
}

TEST_F(Usage, OnePointIsAPicture) {
    for (const char* const point : {"0,0,0\n", "1000000,2,3\n"}) {
        std::ofstream(file("one.csv")) << point;
        const auto r = run("render --quiet --size 64x48 " + file("one.csv") + " -o " + file("one.png"));
        ASSERT_EQ(r.code, 0) << r.output;
        const auto image = load_png(file("one.png"));
        EXPECT_NE(image.at(32, 24), image.at(0, 0)) << point;
    }
}

}  // namespace
