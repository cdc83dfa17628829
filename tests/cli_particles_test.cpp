/// Tests `hedgerow particles`: folders of runs, pictures, runs that go on, bad input.
#include <algorithm>

#include <nlohmann/json.hpp>

#include <hedgerow/io/image.h>
#include <hedgerow/io/rows.h>
#include <hedgerow/mesh_index.h>
#include <hedgerow/scenes/meshes.h>

#include "run_tool.h"

namespace {

using namespace hedgerow;
namespace fs = std::filesystem;
using nlohmann::json;

class ParticlesVerb : public RunTest {};

TEST_F(ParticlesVerb, ARunHasSnapshotsPicturesAndALog) {
    const auto r =
        run("particles gen:cube --emit rain --rate 300 --radius 0.05 --gravity 10 --restitution 0.1 --until "
            "1 --every 0.5 --dt "
            "0.01 "
            "--size 160x120 --json -o " +
            file("run"));
    ASSERT_EQ(r.code, 0) << r.output;
    const auto summary = json::parse(r.output);
    EXPECT_EQ(summary["time"], 1);
    EXPECT_EQ(summary["step"], 100);
    EXPECT_EQ(summary["emitted"], 300);
    EXPECT_EQ(
        named("run", "snapshot"),
        (std::vector<std::string>{"snapshot-0000000.npy", "snapshot-0000050.npy", "snapshot-0000100.npy"}));
    // The balls stay a radius above the cube, and some have reached it.
    const auto rows = open_rows<double>(folder / "run/snapshot-0000100.npy", RowFormat::npy,
                                        {{"x", "y", "z", "radius", "number"}});
    std::vector<double> numbers;
    ASSERT_EQ(rows->read(numbers, 1000), 300u);
    const auto mesh = cube<double>(12);
    const auto index = build(mesh);
    int touching = 0;
    for (std::size_t i = 0; i < 300; ++i) {
        const double* row = &numbers[5 * i];
        const double distance = std::sqrt(closest_point(index, Vec3d(row[0], row[1], row[2])).distance2);
        EXPECT_EQ(row[3], 0.05);
        EXPECT_EQ(row[4], static_cast<double>(i));
        EXPECT_GT(distance, 0.05 * 0.99);
        touching += distance < 0.05 * 1.01;
    }
    EXPECT_GT(touching, 10);
    // Balls have colours, the cube has none; a picture without balls has none but the sky's.
    const auto coloured = [&](const std::string& name) {
        const Image picture = load_png(folder / "run" / name);
        EXPECT_EQ(picture.width, 160);
        return std::count_if(picture.pixels.begin(), picture.pixels.end(),
                             [](const auto& p) { return p[1] > p[0] + 40 || p[2] > p[0] + 90; });
    };
    EXPECT_EQ(coloured("picture-0000000.png"), 0);
    EXPECT_GT(coloured("picture-0000100.png"), 300);
    const std::string log = log_of("run");
    EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 102);
    EXPECT_NE(log.find("\n100,1,300,300,"), std::string::npos);
}
TEST_F(ParticlesVerb, ARunGoesOnWithTheSameBits) {
    for (const std::string emit : {"fountain", "sparks"}) {
        const std::string options =
            "particles gen:teapot:2000 --size 0x0 --quiet --seed 3 --wind 1,0,0 --drag "
            "0.5 --every 0.3 --emit " +
            emit;
        ASSERT_EQ(run(options + " --until 1.2 -o " + file("whole-" + emit)).code, 0);
        ASSERT_EQ(run(options + " --until 0.5 --threads 1 -o " + file("part-" + emit)).code, 0);
        ASSERT_EQ(run("particles --resume --until 1.2 --quiet -o " + file("part-" + emit)).code, 0);
        EXPECT_EQ(log_of("part-" + emit), log_of("whole-" + emit));
        const std::string last = named("whole-" + emit, "snapshot").back();
        EXPECT_GT(fs::file_size(folder / ("whole-" + emit) / last), 10000u);
        EXPECT_EQ(bytes_of(folder / ("part-" + emit) / last), bytes_of(folder / ("whole-" + emit) / last));
        EXPECT_TRUE(named("whole-" + emit, "picture").empty());
    }
}
TEST_F(ParticlesVerb, AnInterruptedRunSavesItsLastStep) {
    const std::vector<std::string> options{"particles", "gen:teapot", "--size",  "0x0", "--until",  "1000",
                                           "--every",   "1000",       "--quiet", "-o",  file("run")};
    EXPECT_EQ(run_interrupted(options, 2000), 130);
    const std::string log = log_of("run"), snapshot = named("run", "snapshot").back();
    EXPECT_EQ(std::stoi(snapshot.substr(snapshot.find('-') + 1)),
              std::stoi(log.substr(log.rfind('\n', log.size() - 2) + 1)));
}
TEST_F(ParticlesVerb, RefusesBadInput) {
    expect_usage("particles gen:cube", "name the folder");
    expect_usage("particles -o " + file("x"), "name the mesh");
    expect_usage("particles gen:cube --emit snow -o " + file("x"), "--emit");
    expect_usage("particles gen:cube --rate -1 -o " + file("x"), "--rate -1");
    expect_usage("particles gen:cube --every 0 -o " + file("x"), "--every 0");
    expect_usage("particles gen:cube --dt nan -o " + file("x"), "not a finite number");
    expect_usage("particles gen:cube --restitution 2 -o " + file("x"), "restitution");
    expect_usage("particles gen:cube --radius 0 -o " + file("x"), "radius");
    expect_usage("particles gen:cube --size large -o " + file("x"), "large");
    expect_usage("particles gen:cube --eye 0,0,0 --target 0,0,0 -o " + file("x"), "camera");
    expect_usage("particles --resume -o " + file("x"), "--until");
    expect_bad("particles --resume --until 1 -o " + file("x"), "no run");
    expect_usage("particles --resume --until 1 --rate 3 -o " + file("x"), "--rate is that of the run");
    expect_bad("particles gen:points -o " + file("x"), "triangles");
    expect_bad("particles " + file("none.obj") + " -o " + file("x"), "none.obj");
    std::ofstream(file("dot.obj")) << "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n";
    expect_bad("particles " + file("dot.obj") + " -o " + file("x"), "extent");
    EXPECT_FALSE(fs::exists(folder / "x"));
    ASSERT_EQ(run("particles gen:cube --until 0.1 --every 0.1 --size 0x0 --quiet -o " + file("run")).code, 0);
    expect_usage("particles gen:cube --until 0.1 -o " + file("run"), "--resume");
    // A snapshot that is cut short, and options that are damaged.
    const fs::path last = folder / "run" / named("run", "snapshot").back();
    fs::resize_file(last, fs::file_size(last) - 8);
    expect_bad("particles --resume --until 0.2 -o " + file("run"), last.filename().string());
    std::ofstream(folder / "run/run.json") << "{}";
    expect_bad("particles --resume --until 0.2 -o " + file("run"), "run.json");
}

}  // namespace
