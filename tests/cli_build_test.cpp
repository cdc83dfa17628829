/// `info` predicts memory without loading the scene, and `build` refuses before any work what it cannot save.
#include <nlohmann/json.hpp>

#include <hedgerow/measure/clock.h>

#include "tool.h"

namespace {

using namespace hedgerow;
using nlohmann::json;

double seconds_now() {
    return measure::now(measure::Clock::wall);
}

class CliBuild : public ToolTest {
protected:
    /// A file of `count` points in the plane or in space, which takes no room on the disk.
    std::string sparse_points(const std::string& name, std::size_t count, int dimension = 3) const {
        std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(count) +
                             ", " + std::to_string(dimension) + "), }";
        header.resize(117, ' ');
        header += '\n';
        std::ofstream out(file(name), std::ios::binary);
        out << "\x93NUMPY" << '\x01' << '\x00' << static_cast<char>(header.size()) << '\x00' << header;
        out.close();
        std::filesystem::resize_file(file(name), 128 + count * static_cast<std::size_t>(dimension) * 4);
        return file(name);
    }
    std::string binary_stl(const std::string& name, std::uint32_t count) const {
        std::ofstream out(file(name), std::ios::binary);
        out << std::string(80, ' ');
        out.write(reinterpret_cast<const char*>(&count), 4);
        out.close();
        std::filesystem::resize_file(file(name), 84 + 50 * std::uint64_t(count));
        return file(name);
    }
    static json memory(const std::string& arguments) {
        const auto r = run("info --json " + arguments);
        EXPECT_EQ(r.code, 0) << arguments << "\n" << r.output;
        return json::parse(r.output);
    }
    /// Runs the tool with 2 GB of addresses.
    static ToolResult limited(const std::string& arguments) {
        return run_shell("ulimit -v 2000000; " HEDGEROW_TOOL_PATH " " + arguments + " 2>&1");
    }
};

TEST_F(CliBuild, InfoPredictsFromNamesAndHeadersAlone) {
    // Far more than could be loaded or generated in the time of a test.
    const double start = seconds_now();
    const auto points = memory("--memory " + sparse_points("a.npy", 100000000));
    EXPECT_EQ(points["kind"], "points");
    EXPECT_EQ(points["points"], 100000000u);
    EXPECT_EQ(points["structure"], "wide");
    EXPECT_EQ(points["scene_bytes"], 1200000000u);
    EXPECT_EQ(points["predicted_index_bytes"], 2400000000u);
    EXPECT_EQ(points["predicted_bytes_each"], 24);
    EXPECT_EQ(points["predicted_build_peak"], 3600000000u);
    EXPECT_EQ(memory("--memory " + sparse_points("b.npy", 1000, 2))["dimension"], 2);
    const auto mesh = memory("--memory --structure bvh " + binary_stl("a.stl", 20000000));
    EXPECT_EQ(mesh["triangles"], 20000000u);
    EXPECT_EQ(mesh["predicted_bytes_each"], 68);
    const auto doubled = memory("--memory --precision double gen:soup:1000M");
    EXPECT_EQ(doubled["triangles"], 1000000000u);
    EXPECT_EQ(doubled["predicted_bytes_each"], 108);
    EXPECT_EQ(memory("--memory gen:segments2d:7")["kind"], "segments");
    EXPECT_LT(seconds_now() - start, 10) << "nothing may be loaded or generated";
}

TEST_F(CliBuild, InfoPredictsTheSameOfTheHeaderAndOfTheScene) {
    ASSERT_EQ(run("generate --quiet gen:boulder:3000 -o " + file("m.ply")).code, 0);
    ASSERT_EQ(run("generate --quiet gen:points:3000 -o " + file("p.ply")).code, 0);
    ASSERT_EQ(run("generate --quiet gen:boulder:3000 -o " + file("m.obj")).code, 0);
    ASSERT_EQ(run("build --quiet " + file("m.ply") + " -o " + file("m.hedgerow")).code, 0);
    for (const char* const name : {"m.ply", "p.ply", "m.obj", "m.hedgerow"}) {
        const auto header = memory("--memory " + file(name)), scene = memory(file(name));
        for (const char* const key : {"kind", "structure", "scene_bytes", "predicted_index_bytes",
                                      "predicted_bytes_each", "predicted_build_peak"})
            EXPECT_EQ(header[key], scene[key]) << name << " " << key;
        // The header of an OBJ file says nothing: it is loaded.
        EXPECT_EQ(header.contains("low"), std::string(name) == "m.obj") << name;
    }
    // What the saved index takes is near to what was predicted of the mesh.
    const auto saved = memory(file("m.hedgerow"));
    EXPECT_LT(double(saved["index_bytes"]), 1.3 * double(saved["predicted_index_bytes"]));
    EXPECT_GT(double(saved["index_bytes"]) * 1.3, double(saved["predicted_index_bytes"]));
}

TEST_F(CliBuild, InfoRefusesWhatIsNoStructure) {
    expect_usage("info --memory --structure wid gen:cube", "did you mean 'wide'");
    expect_usage("info --structure wid gen:cube", "did you mean 'wide'");
    expect_usage("info --memory --structure point-kdtree gen:cube", "points alone");
    expect_usage("info --memory --check gen:cube", "leave out --memory");
    expect_bad("info --memory " + file("missing.ply"), "missing.ply");
    // A header that promises more than the file has is not believed.
    std::ofstream(file("cut.npy"), std::ios::binary)
        << bytes_of(sparse_points("a.npy", 100000000)).substr(0, 200);
    expect_bad("info --memory " + file("cut.npy"), "cut.npy");
}

TEST_F(CliBuild, RefusesWhatNoFileCanHoldBeforeItIsMade) {
    const std::string to = " -o " + file("x.hedgerow");
    const double start = seconds_now();
    expect_bad("build gen:spheres:500M" + to, "these are spheres");
    expect_bad("build gen:segments2d:500M" + to, "these are segments");
    expect_usage("build gen:hairball:50M --structure kdtree" + to, "a file holds 'wide' alone");
    expect_usage("build gen:hairball:50M --structure bvh:volume=obb" + to, "a file holds 'wide' alone");
    expect_usage("build gen:hairball:50M -o " + file("x.ply"), ".hedgerow");
    EXPECT_LT(seconds_now() - start, 10) << "nothing may be generated";
    EXPECT_FALSE(std::filesystem::exists(file("x.hedgerow")));
    EXPECT_EQ(run("build --quiet --structure wide gen:cube" + to).code, 0);
}

TEST_F(CliBuild, RefusesOutputsThatCannotBeWrittenBeforeTheSceneIsMade) {
    const double start = seconds_now();
    expect_failure(1, "build gen:hairball:50M -o " + file("no/such/x.hedgerow"), "there is no folder");
    std::filesystem::create_directories(file("folder.hedgerow"));
    expect_failure(1, "build gen:hairball:50M -o " + file("folder.hedgerow"), "folder");
    std::ofstream(file("locked.hedgerow")) << "an index of before";
    std::filesystem::permissions(file("locked.hedgerow"), std::filesystem::perms(0444));
    expect_failure(1, "build gen:hairball:50M -o " + file("locked.hedgerow"), "read-only");
    EXPECT_EQ(bytes_of(file("locked.hedgerow")), "an index of before");
    EXPECT_LT(seconds_now() - start, 10) << "nothing may be generated";
}

TEST_F(CliBuild, RefusesABuildForWhichThereIsTooLittleMemory) {
#ifdef HEDGEROW_SANITIZED
    GTEST_SKIP() << "sanitizers take more addresses than any limit leaves";
#endif
    const std::string to = " -o " + file("x.hedgerow");
    const double start = seconds_now();
    for (const auto& [scene, peak] :
         {std::pair<std::string, const char*>{sparse_points("a.npy", 100000000), "3.6 GB"},
          {binary_stl("a.stl", 20000000), "2.76 GB"},
          {"gen:points:80M", "2.88 GB"},
          {"gen:points:50M --precision double", "3.6 GB"}}) {
        const auto r = limited("build " + scene + to);
        EXPECT_EQ(r.code, 1) << scene << "\n" << r.output;
        EXPECT_NE(r.output.find(peak), std::string::npos) << scene << "\n" << r.output;
        EXPECT_NE(r.output.find("to build an index of"), std::string::npos) << scene << "\n" << r.output;
    }
    EXPECT_LT(seconds_now() - start, 10) << "nothing may be loaded or generated";
    // As many as there is memory for are built.
    EXPECT_EQ(limited("build --quiet gen:points:1M" + to).code, 0);
}

}  // namespace
