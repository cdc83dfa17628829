/// Pictures of files are upright without a flag. The format defines the upward axis, or else a flat base on
/// which the mesh stands.
#include <cstdlib>
#include <cstring>

#include <nlohmann/json.hpp>

#include <hedgerow/io/image.h>
#include <hedgerow/io/mesh_file.h>
#include <hedgerow/scenes/meshes.h>

#include "gltf_text.h"
#include "tool.h"

namespace {

using namespace hedgerow;
using Upright = ToolTest;
using Mesh = TriangleMesh<float>;

/// A mesh that is taller than wide or deep, so that its longest extent would mislead. It stands on a flat
/// base, and z is up.
Mesh statue() {
    Mesh mesh = teapot<float>(500);
    for (auto& v : mesh.vertices) v[2] = v[2] < 0.16f ? 0 : v[2] * 3;
    return mesh;
}
/// The mesh without its flat base.
Mesh without_base(Mesh mesh) {
    std::erase_if(mesh.triangles, [&](const TriangleIndices& t) {
        float most = 0;
        for (const auto v : t) most = std::max(most, mesh.vertices[v][2]);
        return most < 0.3f;
    });
    return mesh;
}
/// The mesh turned so that y is up instead of z.
Mesh turned_to_y(Mesh mesh) {
    for (auto& v : mesh.vertices) v = {v[0], v[2], -v[1]};
    return mesh;
}

void save_glb(const std::string& path, const Mesh& mesh) {
    std::string corners, indices;
    for (const auto& v : mesh.vertices)
        for (int k = 0; k < 3; ++k) testing_io::append(corners, v[k]);
    for (const auto& t : mesh.triangles)
        for (const auto v : t) testing_io::append(indices, v);
    std::ofstream(path, std::ios::binary)
        << testing_gltf::Gltf()
               .array(corners, "VEC3", testing_gltf::f4, mesh.vertices.size())
               .indices(indices, testing_gltf::u4, 3 * mesh.triangles.size())
               .container();
}

/// The share of pixels that differ by more than rounding (8 of 255 in a channel).
double difference(const Image& a, const Image& b) {
    std::size_t differ = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            if (std::abs(int(a.pixels[i][k]) - int(b.pixels[i][k])) > 8) {
                ++differ;
                break;
            }
    return double(differ) / double(a.pixels.size());
}

class Pictures : public Upright {
protected:
    Image picture(const std::string& scene) const {
        const auto r = run("render " + scene + " --quiet --size 120x120 -o " + file("view.png"));
        EXPECT_EQ(r.code, 0) << r.output;
        return load_png(file("view.png"));
    }
    nlohmann::json up(const std::string& scene) const {
        const auto r = run("render " + scene + " --json --size 8x8 -o " + file("up.png"));
        EXPECT_EQ(r.code, 0) << r.output;
        return nlohmann::json::parse(r.output)["up"];
    }
};
const nlohmann::json y_up = {0.0, 1.0, 0.0}, z_up = {0.0, 0.0, 1.0};

TEST_F(Pictures, StandUprightInEveryFormat) {
    save_mesh(file("z.stl"), statue());
    const Image right = picture(file("z.stl"));
    const Mesh turned = turned_to_y(statue());
    save_glb(file("y.glb"), turned);
    for (const char* ending : {".obj", ".ply", ".off"}) {
        save_mesh(file("z") + ending, statue());  // its flat base overrides the default, y
        save_mesh(file("y") + ending, turned);
        save_mesh(file("scan") + ending, turned_to_y(without_base(statue())));
    }
    for (const char* name :
         {"y.glb", "z.obj", "z.ply", "z.off", "y.obj", "y.ply", "y.off", "scan.obj", "scan.ply", "scan.off"})
        EXPECT_LT(difference(picture(file(name)), right), 0.02) << name;
    std::filesystem::copy_file(file("scan.ply"), file("SCAN.PLY"));
    EXPECT_EQ(up(file("SCAN.PLY")), y_up);
    save_mesh(file("lying.ply"), without_base(statue()));
    EXPECT_EQ(up(file("lying.ply")), y_up) << "nothing says that its z is up";
    EXPECT_GT(difference(picture(file("lying.ply")), right), 0.1);
}

TEST_F(Pictures, TurnWithUp) {
    save_mesh(file("z.stl"), statue());
    const Image right = picture(file("z.stl"));
    Mesh on_x = statue();
    for (auto& v : on_x.vertices) v = {v[2], v[0], v[1]};
    save_mesh(file("x.stl"), on_x);
    save_mesh(file("y.stl"), turned_to_y(statue()));
    EXPECT_LT(difference(picture(file("x.stl") + " --up x"), right), 0.02);
    EXPECT_LT(difference(picture(file("y.stl") + " --up y"), right), 0.02);
    EXPECT_LT(difference(picture(file("z.stl") + " --up z"), right), 0.02);
    EXPECT_GT(difference(picture(file("y.stl")), right), 0.1) << "in an STL file z is up";
}

TEST_F(Pictures, OfGeneratedScenesAndPointsHaveZUp) {
    for (const char* scene : {"gen:teapot:500", "gen:spheres:50", "gen:soup:90", "gen:points:90"})
        EXPECT_EQ(up(scene), z_up) << scene;
    EXPECT_EQ(up("gen:cornell-box"), y_up) << "its own view";
    std::ofstream(file("tall.csv")) << "0,0,0\n1,0.1,9\n2,0.2,3\n";
    EXPECT_EQ(up(file("tall.csv")), z_up);
}

TEST_F(Pictures, SayWhatTheyChose) {
    save_mesh(file("y.ply"), turned_to_y(statue()));
    save_mesh(file("z.ply"), statue());
    const std::string to = " --size 8x8 -o " + file("p.png");
    for (const char* verb : {"render ", "draw ", "draw --heat tests "}) {
        EXPECT_NE(run(verb + file("y.ply") + to).output.find("y is up"), std::string::npos) << verb;
        EXPECT_NE(run(verb + file("z.ply") + to).output.find("z is up"), std::string::npos) << verb;
        EXPECT_EQ(run(verb + file("z.ply") + to + " --up z").output.find("is up"), std::string::npos) << verb;
        EXPECT_EQ(run(verb + file("z.ply") + to + " --quiet").output, "") << verb;
    }
}

TEST_F(Pictures, OfSlicesAndRaysCountAlikeWhateverIsUp) {
    save_mesh(file("y.ply"), turned_to_y(statue()));
    for (const char* what : {"--slice x=0.5", "--slice y=0.5", "--slice z=0.5", "--ray -9,3,0.1,1,0.1,0"}) {
        std::string first;
        for (const char* axis : {"auto", "x", "y", "z"}) {
            const auto r = run("draw " + file("y.ply") + " --structure kdtree --json " + what + " --up " +
                               axis + " -o " + file("p.svg"));
            ASSERT_EQ(r.code, 0) << r.output;
            if (first.empty()) first = r.output;
            EXPECT_EQ(r.output, first) << what << " " << axis;
        }
    }
}

TEST_F(Pictures, OfScansStandUpright) {
    for (const char* scan : {"bunny.ply", "dragon.ply.gz"}) {
        const std::string path = std::string(HEDGEROW_DATA "/") + scan;
        if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there (scripts/fetch-scenes)";
        EXPECT_EQ(up(path), y_up) << scan;
    }
}

}  // namespace
