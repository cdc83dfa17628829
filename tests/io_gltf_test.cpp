/// glTF: every way to describe where triangles are, and the files that are refused.
#include "gltf_text.h"

namespace hedgerow {
namespace {

using namespace testing_gltf;
using testing_io::TempFolder;

std::vector<ThreeCorners> triangles_of(const TriangleMesh<double>& mesh) {
    std::vector<ThreeCorners> all;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const auto t = mesh.view().triangle(i);
        all.push_back({t.a, t.b, t.c});
    }
    return all;
}

TEST(Gltf, HoldsTheTrianglesThatItSays) {
    TempFolder folder;
    for (const GltfCase& c : gltf_cases()) {
        write_buffer(folder, c.file);
        for (const auto& path :
             {folder.file("a.gltf", c.file.text()), folder.file("a.glb", c.file.container())}) {
            SCOPED_TRACE(c.name + path.extension().string());
            const auto mesh = load_mesh<double>(path);
            EXPECT_EQ(triangles_of(mesh), c.triangles);
            EXPECT_TRUE(mesh.faces.empty());
            const auto narrow = load_mesh<float>(path);
            EXPECT_EQ(narrow.triangles, mesh.triangles);
            for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
                EXPECT_EQ(narrow.vertices[i], Vec3f(mesh.vertices[i]));
        }
    }
}

TEST(Gltf, JoinsTheCornersOfInstances) {
    TempFolder folder;
    Gltf file = triangle();
    file.nodes = R"({"translation":[10,0,0],"children":[1,2]},{"mesh":0},{"mesh":0,"scale":[-2,1,1]})";
    const auto mesh = load_mesh<double>(folder.file("a.gltf", file.text()));
    EXPECT_EQ(mesh.vertices, (std::vector<Vec3d>{{10, 0, 0}, {11, 0, 0}, {10, 1, 0}, {8, 0, 0}}));
    EXPECT_EQ(mesh.triangles, (std::vector<TriangleIndices>{{0, 1, 2}, {2, 3, 0}}));
}

TEST(Gltf, ReadsOnlyWhatIsDrawnInTheScene) {
    TempFolder folder;
    Gltf file = triangle();
    file.nodes += R"(,{"mesh":0,"translation":[5,0,0]})";
    EXPECT_EQ(load_mesh(folder.file("a.gltf", file.text())).size(), 1u) << "the other node is in no scene";
    file.more = R"(,"scene":0)";
    EXPECT_EQ(load_mesh(folder.file("a.gltf", file.text())).size(), 1u);
    file = triangle();
    file.primitive += R"(},{"attributes":{"POSITION":0},"mode":0},{"attributes":{})";
    EXPECT_EQ(load_mesh(folder.file("a.gltf", file.text())).size(), 1u) << "points, and nothing";
}

TEST(Gltf, RefusesIndicesThatAreNone) {
    TempFolder folder;
    const auto refuse = [&](const Gltf& file, const std::string& why) {
        testing_io::expect_input_error([&] { load_mesh(folder.file("a.gltf", file.text())); },
                                       {"a.gltf", why});
    };
    const std::string wrong = "of a type that indices cannot have", bytes = packed<std::uint8_t>({0, 1, 2});
    refuse(triangle().indices(bytes, u1, 3, R"(,"normalized":true)"), wrong);
    refuse(triangle().indices(bytes, i1, 3), wrong);
    refuse(triangle().indices(packed<float>({0, 1, 2}), f4, 3), wrong);
    const auto sparse = [&](const std::string& places, int type) {
        Gltf file = Gltf().array(packed<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}), "VEC3", f4, 3,
                                 R"(,"sparse":{"count":1,"indices":{"bufferView":1,"componentType":)" +
                                     std::to_string(type) + R"(},"values":{"bufferView":2}})");
        return file.view(places).view(packed<float>({6, 8, 3}));
    };
    refuse(sparse(packed<float>({1}), f4), wrong);
    refuse(sparse(packed<std::int8_t>({1}), i1), wrong);
    refuse(sparse(packed<std::uint8_t>({3}), u1), "do not ascend within");
    Gltf children = triangle();
    children.nodes = R"({"children":[1.5]},{"mesh":0})";
    refuse(children, "no whole number");
}

}  // namespace
}  // namespace hedgerow
