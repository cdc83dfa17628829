/// Tests `hedgerow nbody`: forces in files, runs with their folders, interrupted and killed ones,
/// comparisons.
#include <algorithm>
#include <random>

#include <nlohmann/json.hpp>

#include <hedgerow/io/image.h>
#include <hedgerow/io/npy.h>
#include <hedgerow/io/particle_file.h>
#include <hedgerow/nbody/forces.h>
#include <hedgerow/nbody/motion.h>
#include <hedgerow/scenes/particles.h>

#include "run_tool.h"

namespace {

using namespace hedgerow;
namespace fs = std::filesystem;
using nlohmann::json;

class Nbody : public RunTest {};

/// In a cube that repeats, with snapshots in HDF5, from the last of which the run goes on.
TEST_F(Nbody, RunsInAPeriodicCube) {
    const std::string options = "--period 1 --dt 0.01 --every 0.02 --size 0x0 --quiet ";
    const std::string snapshots = HEDGEROW_HAS_HDF5 ? "--snapshots hdf5 " : "";
    EXPECT_EQ(run("nbody gen:cold-cube:500 --until 0.06 " + options + snapshots + "-o " + file("whole")).code,
              0);
    EXPECT_EQ(run("nbody gen:cold-cube:500 --until 0.03 " + options + snapshots + "-o " + file("run")).code,
              0);
    EXPECT_EQ(run("nbody --resume --until 0.06 --quiet -o " + file("run")).code, 0);
    EXPECT_EQ(log_of("run"), log_of("whole"));
    EXPECT_EQ(named("run", "snapshot").size(), 5u);  // after 0, 2, 3, 4 and 6 steps
    EXPECT_EQ(run("nbody gen:cold-cube:500 --period 1 --forces --quiet -o " + file("a.csv")).code, 0);
    expect_usage("nbody gen:cold-cube:50 --period 0 --forces -o " + file("a.csv"), "--period");
    expect_usage("nbody gen:cold-cube:50 --period 1 --compare", "--period");
}
TEST_F(Nbody, ForcesAreThoseOfTheLibrary) {
    EXPECT_EQ(run("nbody gen:plummer:3000 --forces --accuracy 1e-5 --quiet -o " + file("a.npy")).code, 0);
    EXPECT_EQ(run("nbody gen:plummer:3000 --forces --accuracy 1e-5 --quiet -o " + file("a.csv")).code, 0);
    const Particles all = plummer(3000);
    std::vector<PotentialAt<double>> want(all.size());
    forces<double>({all.places, all.masses}, want, {.accuracy = 1e-5});
    std::ifstream csv(file("a.csv"));
    std::string line;
    std::getline(csv, line);
    EXPECT_EQ(line, "potential,ax,ay,az");
    for (const auto& at : want) {
        double found[4];
        for (double& x : found) csv >> x, csv.get();
        ASSERT_EQ(found[0], -at.potential);
        ASSERT_EQ(Vec3d(found[1], found[2], found[3]), at.gradient);
    }
    const auto checked =
        run("nbody gen:plummer:3000 --forces --accuracy 1e-5 --check --json -o " + file("a.npy"));
    EXPECT_EQ(checked.code, 0) << checked.output;
    const json errors = json::parse(checked.output).at("errors");
    EXPECT_EQ(errors.at("targets"), 1000);
    EXPECT_LE(errors.at("rms"), 1e-5);
    EXPECT_GT(errors.at("rms"), 1e-9);
    expect_usage("nbody gen:plummer:30 --until 1 --check -o " + file("x"), "--check");
    // At other places, softened.
    std::ofstream(file("places.csv")) << "x,y,z\n0,0,0\n1,2,3\n";
    const auto r = run("nbody gen:plummer:3000 --forces --gravity 2 --softening 0.1 --from " +
                       file("places.csv") + " --json -o " + file("b.json"));
    EXPECT_EQ(r.code, 0) << r.output;
    EXPECT_EQ(json::parse(r.output)["targets"], 2);
    const auto rows = json::parse(bytes_of(file("b.json")));
    const std::vector<Vec3d> places{{0, 0, 0}, {1, 2, 3}};
    std::vector<PotentialAt<double>> two(2);
    forces<double>({all.places, all.masses, {.length = 0.1}}, Targets<double>(places), two);
    EXPECT_EQ(rows[1]["ax"], 2 * two[1].gradient[0]);
}
TEST_F(Nbody, ARunHasSnapshotsPicturesAndALog) {
    const auto r =
        run("nbody gen:two-clusters:2000 --until 1 --dt 0.0625 --every 0.5 --size 200x100 --json -o " +
            file("run"));
    ASSERT_EQ(r.code, 0) << r.output;
    const auto summary = json::parse(r.output);
    EXPECT_EQ(summary["time"], 1);
    EXPECT_EQ(summary["step"], 16);
    EXPECT_LE(summary["energy_error"].get<double>(), 1e-3);
    const std::vector<std::string> snapshots{"snapshot-0000000.npy", "snapshot-0000008.npy",
                                             "snapshot-0000016.npy"};
    EXPECT_EQ(named("run", "snapshot"), snapshots);
    EXPECT_EQ(named("run", "picture").size(), 3u);
    const Image picture = load_png(folder / "run/picture-0000016.png");
    EXPECT_EQ(picture.width, 200);
    EXPECT_GT(
        std::count_if(picture.pixels.begin(), picture.pixels.end(), [](const auto& p) { return p[1] > 60; }),
        200);
    const MotionState last = load_state(folder / "run" / snapshots[2]);
    EXPECT_EQ(last.time, 1);
    EXPECT_EQ(last.particles.size(), 2000u);
    // The same motion by the library.
    Motion motion(two_clusters(2000), {.softening = {.length = summary["softening"]}});
    for (int i = 0; i < 16; ++i) motion.step(0.0625);
    EXPECT_EQ(last.particles.places, motion.state().particles.places);
    const std::string log = log_of("run");
    EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 18);
}
/// The colours of a run end at four times the greatest density of its first picture.
TEST_F(Nbody, DensitiesHaveTheSameBitsInAnyOrderOfParticles) {
    std::vector<std::string> rows;
    const Particles all = two_clusters(3000);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Vec3d& p = all.places[i];
        char row[200];
        std::snprintf(row, sizeof row, "%.17g,%.17g,%.17g,%.17g\n", p[0], p[1], p[2],
                      all.masses[i] * (1 + 0.001 * double(i)));
        rows.emplace_back(row);
    }
    std::mt19937 random(1);
    json frame;
    for (int times = 0; times < 4; ++times) {
        std::ofstream out(file("rows.csv"));
        out << "x,y,z,mass\n";
        for (const std::string& row : rows) out << row;
        out.close();
        fs::remove_all(folder / "run");
        const auto r =
            run("nbody " + file("rows.csv") + " --until 0 --dt 1 --size 60x60 --quiet -o " + file("run"));
        ASSERT_EQ(r.code, 0) << r.output;
        const json found = json::parse(bytes_of(folder / "run/run.json")).at("frame");
        if (times > 0) {
            EXPECT_EQ(found, frame);
        }
        frame = found;
        std::shuffle(rows.begin(), rows.end(), random);
    }
}
TEST_F(Nbody, AKilledRunGoesOnWithTheSameBits) {
    const std::string options = "nbody gen:plummer:2000 --until 2 --dt 0.015625 --every 0.0625 --quiet -o ";
    ASSERT_EQ(run(options + file("whole")).code, 0);
    const auto snapshots = named("whole", "snapshot");
    for (const int signal : {SIGKILL, SIGINT, SIGTERM, SIGUSR1})
        for (int milliseconds = 100;; milliseconds *= 2) {
            fs::remove_all(folder / "part");
            const int code = run_interrupted({"nbody", "gen:plummer:2000", "--until", "2", "--dt", "0.015625",
                                              "--every", "0.0625", "--quiet", "-o", file("part")},
                                             milliseconds, signal);
            if (!fs::exists(folder / "part/run.json") && milliseconds < 20000) continue;
            EXPECT_TRUE(code == 0 || code == (signal == SIGKILL ? 128 + SIGKILL : 130)) << code;
            if (signal != SIGKILL) {  // a snapshot of the last step was saved
                const std::string log = log_of("part");
                const auto last = log.rfind('\n', log.size() - 2) + 1;
                const std::string snapshot = named("part", "snapshot").back();
                EXPECT_EQ(std::stoi(snapshot.substr(snapshot.find('-') + 1)), std::stoi(log.substr(last)));
            }
            const auto r = run("nbody --resume --until 2 --quiet -o " + file("part"));
            EXPECT_EQ(r.code, 0) << r.output;
            EXPECT_EQ(bytes_of(folder / "part" / snapshots.back()),
                      bytes_of(folder / "whole" / snapshots.back()));
            EXPECT_EQ(log_of("part"), log_of("whole"));
            break;
        }
    // And beyond.
    ASSERT_EQ(run("nbody --resume --until 2.5 --quiet -o " + file("part")).code, 0);
    EXPECT_EQ(load_state(folder / "part" / named("part", "snapshot").back()).time, 2.5);
}
TEST_F(Nbody, InBlockStepsOrWithoutPictures) {
    const auto r = run("nbody gen:hernquist:1000 --until 0.5 --block-steps --dt 0.125 --size 0x0 --json -o " +
                       file("run"));
    ASSERT_EQ(r.code, 0) << r.output;
    EXPECT_EQ(json::parse(r.output)["step"], 4);
    EXPECT_GT(json::parse(r.output)["forces"], 4000);
    EXPECT_TRUE(named("run", "picture").empty());
}
TEST_F(Nbody, ComparesWays) {
    const auto r = run("nbody gen:plummer:3000 --compare --json -o " + file("plot.svg"));
    ASSERT_EQ(r.code, 0) << r.output;
    const auto ways = json::parse(r.output)["ways"];
    EXPECT_EQ(ways[0]["way"], "direct sum");
    for (const auto& way : ways) {
        ASSERT_FALSE(way["results"].empty());
        EXPECT_LE(way["results"].back()["error"], 0.02) << way["way"];
        EXPECT_GT(way["results"].back()["seconds"], 0);
    }
    EXPECT_NE(bytes_of(file("plot.svg")).find("barnes_hut"), std::string::npos);
    const auto text = run("nbody gen:plummer:1000 --compare").output;
    EXPECT_NE(text.find("forces, within 1e-03"), std::string::npos);
    expect_usage("nbody gen:plummer:1000 --compare -o " + file("plot.png"), ".svg");
}
TEST_F(Nbody, DrawsWhatActsOnAParticle) {
    const auto r = run("draw gen:disc:5000 --forces-at 1,1,0 --json -o " + file("a.svg"));
    ASSERT_EQ(r.code, 0) << r.output;
    std::size_t particles = 0;
    const auto facts = json::parse(r.output);
    for (const auto& kind : facts["acting"]) particles += kind["particles"].get<std::size_t>();
    EXPECT_EQ(particles, 5000u);
    EXPECT_NE(bytes_of(file("a.svg")).find("one by one, on the target"), std::string::npos);
    expect_usage("draw gen:disc:5000 --forces-at 1,1,0 -o " + file("a.png"), ".svg");
    expect_usage("draw gen:cube --forces-at 1,1,0 -o " + file("b.svg"), "gen:plummer");
    expect_bad("draw gen:disc:0 --forces-at 1,1,0 -o " + file("b.svg"), "no particle");
}
/// Two bodies that fall into each other: no step beyond --until or the next snapshot, and energy is kept.
TEST_F(Nbody, FewBareParticlesKeepTheirEnergy) {
    std::ofstream(file("two.csv")) << "x,y,z\n0,0,0\n0.5,0,0\n";
    const auto r =
        run("nbody " + file("two.csv") + " --until 0.5 --every 0.125 --size 0x0 --json -o " + file("run"));
    ASSERT_EQ(r.code, 0) << r.output;
    const json summary = json::parse(r.output);
    EXPECT_EQ(summary["time"], 0.5);
    EXPECT_EQ(summary["softening"], 0);
    EXPECT_LE(summary["energy_error"].get<double>(), 1e-3);
    std::vector<double> times;
    for (const std::string& name : named("run", "snapshot"))
        times.push_back(load_state(folder / "run" / name).time);
    EXPECT_EQ(times, (std::vector<double>{0, 0.125, 0.25, 0.375, 0.5}));
    // Half way, and then resumed: the same bits.
    ASSERT_EQ(
        run("nbody " + file("two.csv") + " --until 0.5 --every 0.125 --size 0x0 --quiet -o " + file("part"))
            .code,
        0);
    for (const std::string& name : named("part", "snapshot"))
        if (load_state(folder / "part" / name).time > 0.25) fs::remove(folder / "part" / name);
    ASSERT_EQ(run("nbody --resume --until 0.5 --quiet -o " + file("part")).code, 0);
    const std::string last = named("run", "snapshot").back();
    EXPECT_EQ(named("part", "snapshot").back(), last);
    EXPECT_EQ(bytes_of(folder / "part" / last), bytes_of(folder / "run" / last));
    EXPECT_EQ(log_of("part"), log_of("run"));
}
/// Steps that are too long for --until end there, and a loss of energy is said.
TEST_F(Nbody, StepsEndWhereTheRunEnds) {
    std::ofstream(file("two.csv")) << "x,y,z\n0,0,0\n0.5,0,0\n";
    const auto r = run("nbody " + file("two.csv") + " --until 0.5 --dt 1 --size 0x0 -o " + file("run"));
    ASSERT_EQ(r.code, 0) << r.output;
    EXPECT_EQ(load_state(folder / "run/snapshot-0000001.npy").time, 0.5);
    EXPECT_NE(r.output.find("warning: the energy changed"), std::string::npos) << r.output;
    // With softening too: snapshots are at multiples of --every.
    ASSERT_EQ(run("nbody gen:plummer:200 --until 0.3 --every 0.1 --size 0x0 --quiet -o " + file("soft")).code,
              0);
    std::vector<double> times;
    for (const std::string& name : named("soft", "snapshot"))
        times.push_back(load_state(folder / "soft" / name).time);
    ASSERT_EQ(times.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(times[i], 0.1 * double(i), 1e-12);
}
/// A snapshot is that of a start, whose forces are found by the options of the run.
TEST_F(Nbody, ASnapshotIsAStartLikeAnyOther) {
    ASSERT_EQ(run("nbody gen:plummer:100 --until 0.1 --size 0x0 --quiet -o " + file("a")).code, 0);
    MotionState state = load_state(folder / "a/snapshot-0000000.npy");
    for (auto& force : state.accelerations) force = {7, 7, 7};
    save_state(folder / "start.npy", state);
    const std::string options = " --gravity 2 --softening 0.1 --until 0.1 --size 0x0 --quiet -o ";
    ASSERT_EQ(run("nbody " + file("a/snapshot-0000000.npy") + options + file("b")).code, 0);
    ASSERT_EQ(run("nbody " + file("start.npy") + options + file("c")).code, 0);
    EXPECT_EQ(log_of("b"), log_of("c"));
}
/// Runs far shorter than a usual step, or none at all.
TEST_F(Nbody, ARunMayBeShort) {
    ASSERT_EQ(
        run("nbody gen:plummer:100 --softening 0.1 --until 1e-9 --size 0x0 --quiet -o " + file("a")).code, 0);
    EXPECT_NEAR(load_state(folder / "a" / named("a", "snapshot").back()).time, 1e-9, 1e-21);
    ASSERT_EQ(run("nbody gen:plummer:100 --softening 0.1 --until 0 --size 0x0 --quiet -o " + file("b")).code,
              0);
    ASSERT_EQ(run("nbody --resume --until 0.1 --quiet -o " + file("b")).code, 0);
    EXPECT_NEAR(load_state(folder / "b" / named("b", "snapshot").back()).time, 0.1, 1e-12);
}
TEST_F(Nbody, ForcesToAPipeAreRowsAlone) {
    const auto r =
        run_shell(HEDGEROW_TOOL_PATH " nbody gen:plummer:20 --forces --format csv -o - 2>/dev/null");
    EXPECT_EQ(r.code, 0);
    EXPECT_EQ(std::count(r.output.begin(), r.output.end(), '\n'), 21) << r.output;
    expect_usage("nbody gen:plummer:20 --forces -o " + file("a.csv.gz"), "leave .gz out");
}
TEST_F(Nbody, OfFewParticlesOrNone) {
    for (const char* count : {"0", "1", "2"}) {
        const std::string scene = std::string("gen:plummer:") + count;
        const auto r = run("nbody " + scene + " --until 1 --dt 0.5 --quiet -o " + file(count));
        EXPECT_EQ(r.code, 0) << r.output;
        EXPECT_EQ(run("nbody " + scene + " --forces --quiet -o " + file("few.npy")).code, 0);
    }
}
TEST_F(Nbody, RefusesBadInput) {
    expect_usage("nbody gen:plummer:100", "say what to do");
    expect_usage("nbody gen:plummer:100 --forces", "name the file");
    expect_usage("nbody gen:plummer:100 --until 1", "name the folder");
    expect_usage("nbody --until 1 -o " + file("x"), "name the particles");
    expect_usage("nbody gen:cube --until 1 -o " + file("x"), "gen:plummer");
    expect_usage("nbody gen:plummer:100 --until -1 -o " + file("x"), "--until -1");
    expect_usage("nbody gen:plummer:100 --until 1 --dt 0 -o " + file("x"), "--dt 0");
    expect_usage("nbody gen:plummer:100 --until 1 --size large -o " + file("x"), "large");
    expect_usage("nbody gen:plummer:100 --forces --accuracy 2 -o " + file("a.npy"), "accuracy of 2");
    expect_usage("nbody gen:plummer:100 --forces -o " + file("a.abc"), "abc");
    expect_bad("nbody --resume --until 1 -o " + file("x"), "no run");
    expect_usage("nbody --resume --until 1 --dt 0.1 -o " + file("x"), "--dt is that of the run");
    EXPECT_FALSE(fs::exists(folder / "x"));
    std::ofstream(file("nan.csv")) << "x,y,z\n1,2,3\n1,nan,3\n";
    expect_bad("nbody " + file("nan.csv") + " --forces -o " + file("a.npy"),
               file("nan.csv") + ": a coordinate of particle 1 is nan");
    // Particles are never left out.
    expect_usage("nbody --drop-bad " + file("nan.csv") + " --forces -o " + file("a.npy"), "--drop-bad");
    expect_usage("draw --drop-bad gen:disc:10 --forces-at 1,1,0 -o " + file("b.svg"), "--drop-bad");
    std::ofstream(file("nan.xyz")) << "1 2 3\n1 nan 3\n";
    expect_bad("nbody " + file("nan.xyz") + " --forces -o " + file("a.npy"),
               file("nan.xyz") + ": 1 of the points are NaN");
    ASSERT_EQ(run("nbody gen:plummer:10 --until 0.1 --quiet -o " + file("run")).code, 0);
    expect_usage("nbody gen:plummer:10 --until 0.1 -o " + file("run"), "--resume");
    // A snapshot that is cut short, and options that are damaged.
    const fs::path last = folder / "run" / named("run", "snapshot").back();
    fs::resize_file(last, fs::file_size(last) - 8);
    expect_bad("nbody --resume --until 0.2 -o " + file("run"), last.filename().string());
    std::ofstream(folder / "run/run.json") << "{";
    expect_bad("nbody --resume --until 0.2 -o " + file("run"), "run.json");
}

}  // namespace
