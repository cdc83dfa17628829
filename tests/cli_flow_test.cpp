/// Tests `hedgerow flow`: folders of runs, checks, surfaces, runs that are killed and go on with the same
/// bits, bad input.
#include <algorithm>

#include <nlohmann/json.hpp>

#include <hedgerow/io/image.h>
#include <hedgerow/io/mesh_file.h>
#include <hedgerow/scenes/meshes.h>

#include "run_tool.h"

namespace {

using namespace hedgerow;
namespace fs = std::filesystem;
using nlohmann::json;

class FlowVerb : public RunTest {};

TEST_F(FlowVerb, ARunHasSnapshotsPicturesASheetAndALog) {
    const auto r = run("flow gen:dam:200 --plane --until 0.2 --every 0.1 --check --json -o " + file("dam"));
    ASSERT_EQ(r.code, 0) << r.output;
    const auto summary = json::parse(r.output);
    EXPECT_EQ(summary["time"], 0.2);
    EXPECT_EQ(summary["particles"], 200);
    EXPECT_TRUE(summary["check"]["kept"]);
    EXPECT_EQ(summary["check"]["leaks"], 0);
    EXPECT_EQ(named("dam", "snapshot").size(), 3u);
    EXPECT_EQ(named("dam", "picture").size(), 3u);
    EXPECT_EQ(load_png(folder / "dam/picture-0000000.png").width, 800);
    EXPECT_EQ(load_png(folder / "dam/sheet.png").width, 3 * 366 - 6);
    const std::string log = log_of("dam");
    EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 22);
}
TEST_F(FlowVerb, EveryGeneratedFluidFlowsInThePlaneAndInSpace) {
    for (const std::string name : {"dam", "long-dam", "column", "drop", "wave"})
        for (const std::string plane : {"--plane ", ""}) {
            const auto r = run("flow gen:" + name + ":300 " + plane + "--until 0.05 --size 0x0 --check -o " +
                               file("run"));
            EXPECT_EQ(r.code, 0) << r.output;
            EXPECT_NE(r.output.find("good"), std::string::npos) << r.output;
            fs::remove_all(folder / "run");
        }
}
TEST_F(FlowVerb, AColumnAtRestIsHeldAgainstItsWeight) {
    const auto r = run("flow gen:column:400 --plane --until 0.5 --size 0x0 --check -o " + file("c"));
    ASSERT_EQ(r.code, 0) << r.output;
    EXPECT_NE(r.output.find("of its weight by 0."), std::string::npos) << r.output;
}
TEST_F(FlowVerb, ARunThatWasInterruptedGoesOnWithTheSameBits) {
    for (const std::string plane : {" --plane", ""}) {
        const std::string options = "flow gen:drop:400" + plane + " --every 0.02 --size 0x0 ";
        ASSERT_EQ(run(options + "--until 0.06 -o " + file("whole")).code, 0);
        ASSERT_EQ(run(options + "--until 0.04 -o " + file("part")).code, 0);
        // What a kill leaves behind: half a line in the log, and lines of steps that are not in a snapshot.
        std::ofstream(folder / "part/log.csv", std::ios::app) << "99999,0.05,1,2,3,4,5,6,7\n123";
        ASSERT_EQ(run("flow --resume --until 0.06 -o " + file("part")).code, 0);
        const auto snapshots = named("whole", "snapshot");
        EXPECT_EQ(snapshots, named("part", "snapshot"));
        EXPECT_EQ(snapshots.size(), 4u);
        for (const auto& name : snapshots)
            EXPECT_EQ(bytes_of(folder / "whole" / name), bytes_of(folder / "part" / name)) << name;
        EXPECT_EQ(log_of("whole"), log_of("part"));
        fs::remove_all(folder / "whole"), fs::remove_all(folder / "part");
    }
}
TEST_F(FlowVerb, AMeshIsFilledAndFallsIntoAMesh) {
    auto ball = cube<double>(12), tank = cube<double>(12);
    for (auto& p : ball.vertices) p = p * 0.75;
    for (auto& p : tank.vertices) p = p * 2.0;
    save_mesh(folder / "ball.ply", ball), save_mesh(folder / "tank.ply", tank);
    const auto r =
        run("flow " + file("ball.ply") + " --walls " + file("tank.ply") +
            " --up z --spacing 0.25 --until 0.3 --every 0.15 --surface obj --check --json -o " + file("run"));
    ASSERT_EQ(r.code, 0) << r.output;
    const auto summary = json::parse(r.output);
    EXPECT_EQ(summary["particles"], 216);
    EXPECT_EQ(summary["check"]["leaks"], 0);
    EXPECT_EQ(named("run", "surface").size(), 3u);
    EXPECT_EQ(named("run", "water.mtl").size(), 1u);
    const auto info = run("info --json " + file("run/" + named("run", "surface").back()));
    EXPECT_TRUE(json::parse(info.output)["closed"]) << info.output;
}
/// The speed of sound is that of the start, and the end of the first part is a line of the log.
TEST_F(FlowVerb, AMeshThatHasFallenGoesOnWithTheSameBits) {
    save_mesh(folder / "box.ply", cube<double>(12));
    const std::string options =
        "flow " + file("box.ply") + " --up z --spacing 0.25 --every 0.1 --size 120x90 ";
    const auto whole = run(options + "--until 0.4 --json -o " + file("whole"));
    ASSERT_EQ(whole.code, 0) << whole.output;
    ASSERT_EQ(run(options + "--until 0.3 -o " + file("part")).code, 0);
    // A picture and a surface that were not finished are made again.
    fs::remove(folder / "part" / named("part", "snapshot").back());
    fs::remove(folder / "part" / named("part", "picture").back());
    const auto rest = run("flow --resume --until 0.4 --json -o " + file("part"));
    ASSERT_EQ(rest.code, 0) << rest.output;
    EXPECT_EQ(json::parse(whole.output)["sound"], json::parse(rest.output)["sound"]);
    EXPECT_EQ(named("whole", "picture"), named("part", "picture"));
    EXPECT_EQ(named("whole", "snapshot"), named("part", "snapshot"));
    for (const auto& name : named("whole", "snapshot"))
        EXPECT_EQ(bytes_of(folder / "whole" / name), bytes_of(folder / "part" / name)) << name;
}
TEST_F(FlowVerb, ARunOfNoTimeGoesOn) {
    ASSERT_EQ(run("flow gen:dam:100 --plane --size 0x0 --until 0 -o " + file("run")).code, 0);
    const auto r = run("flow --resume --until 0.3 --json -o " + file("run"));
    ASSERT_EQ(r.code, 0) << r.output;
    EXPECT_EQ(json::parse(r.output)["time"], 0.3);
    const auto ignored = run("flow --resume --until 0.4 --every 0.1 -o " + file("run"));
    EXPECT_EQ(ignored.code, 2);
    EXPECT_NE(ignored.output.find("--every is that of the run"), std::string::npos) << ignored.output;
}
TEST_F(FlowVerb, ASourceFlowsAndGoesOn) {
    auto tap = cube<double>(12);
    for (auto& p : tap.vertices) p = p * 0.15 + Vec3d(0.25, 0.25, 0.75);
    save_mesh(folder / "tap.ply", tap);
    const std::string options = "flow gen:column:300 --inflow " + file("tap.ply") +
                                " --inflow-velocity 0,0,-1 --every 0.1 --size 0x0 --json ";
    const auto whole = run(options + "--until 0.2 -o " + file("whole"));
    ASSERT_EQ(whole.code, 0) << whole.output;
    EXPECT_GT(json::parse(whole.output)["particles"], 343 + 40);
    ASSERT_EQ(run(options + "--until 0.1 -o " + file("part")).code, 0);
    ASSERT_EQ(run("flow --resume --until 0.2 -o " + file("part")).code, 0);
    for (const auto& name : named("whole", "snapshot"))
        EXPECT_EQ(bytes_of(folder / "whole" / name), bytes_of(folder / "part" / name)) << name;
}
TEST_F(FlowVerb, SurfacesHaveAFloorForPictures) {
    const auto r =
        run("flow gen:drop:300 --until 0.01 --every 0.01 --size 0x0 --surface obj --floor -o " + file("run"));
    ASSERT_EQ(r.code, 0) << r.output;
    const std::string surface = "run/" + named("run", "surface").back(), picture = file("water.png");
    EXPECT_NE(bytes_of(folder / surface).find("usemtl floor"), std::string::npos);
    EXPECT_NE(bytes_of(folder / "run/water.mtl").find("newmtl floor"), std::string::npos);
    const auto made =
        run("render " + file(surface) + " --up z --shading path --spp 1 --size 32x24 -o " + picture);
    EXPECT_EQ(made.code, 0) << made.output;
    EXPECT_EQ(load_png(picture).width, 32);
}
TEST_F(FlowVerb, BadInputIsRefusedWithASentence) {
    const auto refused = [&](const std::string& options, int code, const std::string& words) {
        const auto r = run("flow " + options);
        EXPECT_EQ(r.code, code) << options << "\n" << r.output;
        EXPECT_NE(r.output.find(words), std::string::npos) << r.output;
        EXPECT_FALSE(fs::exists(folder / "x"));
    };
    const std::string out = " -o " + file("x");
    refused("gen:damm" + out, 2, "did you mean 'dam'");
    refused("gen:dam:3" + out, 2, "from 10 to");
    refused("gen:dam:many" + out, 2, "not a size");
    refused("gen:dam", 2, "name the folder");
    refused(out, 2, "name the fluid");
    refused("gen:dam --until -1" + out, 2, "--until -1");
    refused("gen:dam --spacing 0.1" + out, 2, "number of particles");
    refused("gen:dam:200 --plane --surface obj" + out, 2, "in space");
    refused("gen:dam:200 --plane --viscosity 1e12" + out, 2, "steps are");
    refused("gen:dam:200 --floor" + out, 2, "--surface obj");
    refused("gen:dam:100G" + out, 2, "too large");
    save_mesh(folder / "cube.ply", cube<double>(12));
    auto open = cube<double>(12);
    for (auto& p : open.vertices) p = p * 3.0;
    open.triangles.pop_back();
    save_mesh(folder / "open.ply", open);
    auto half = cube<double>(12);
    for (auto& p : half.vertices) p[0] += 0.5;
    save_mesh(folder / "half.ply", half);
    refused(file("open.ply") + out, 3, "not closed");
    refused(file("cube.ply") + " --spacing 0.25 --walls " + file("open.ply") + out, 3, "not closed");
    refused(file("cube.ply") + " --spacing 0.25 --walls " + file("half.ply") + out, 3, "on one side");
    refused(file("cube.ply") + " --spacing 3" + out, 3, "no particle fits");
    refused(file("cube.ply") + " --plane" + out, 2, "filled in space");
    refused(file("missing.ply") + out, 3, "missing.ply");
    ASSERT_EQ(run("flow gen:column:100 --plane --until 0.01 -o " + file("held")).code, 0);
    EXPECT_EQ(run("flow gen:column:100 --plane --until 0.01 -o " + file("held")).code, 2);
    EXPECT_EQ(run("flow --resume -o " + file("nothing")).code, 3);
    // A snapshot that is cut off, and options that are no JSON.
    fs::resize_file(folder / "held" / named("held", "snapshot").back(), 300);
    EXPECT_EQ(run("flow --resume --until 0.02 -o " + file("held")).code, 3);
    std::ofstream(folder / "held/run.json") << "{";
    EXPECT_EQ(run("flow --resume -o " + file("held")).code, 3);
}

}  // namespace
