/// Models from files: their triangles are those of load_mesh, and values at corners are those of the file.
#include "gltf_text.h"
#include "model_support.h"

namespace hedgerow {
namespace {

using namespace testing_gltf;
using namespace testing_io;

/// Expects the triangles of load_mesh, in the same order and to the last bit.
template <class T>
void expect_triangles_of_mesh(const std::filesystem::path& path) {
    SCOPED_TRACE(path.filename());
    const auto mesh = load_mesh<T>(path);
    const auto model = load_model<T>(path);
    expect_sound(model);
    EXPECT_EQ(corners_of(model), corners_of(mesh));
    EXPECT_EQ(model.triangles(), mesh.size());
    if (model.objects.size() == 1) {
        EXPECT_EQ(model.objects[0].mesh.faces, mesh.faces);
    }
}
void expect_triangles_of_mesh(const std::filesystem::path& path) {
    expect_triangles_of_mesh<float>(path);
    expect_triangles_of_mesh<double>(path);
}

TEST(Models, HaveTheTrianglesOfTheMesh) {
    TempFolder folder;
    std::mt19937_64 random(7);
    for (int i = 0; i < 10; ++i) {
        const auto mesh = random_mesh<float>(random);
        for (const std::string name : {"a.ply", "a.stl", "a.obj", "a.off"}) {
            save_mesh(folder / name, mesh);
            expect_triangles_of_mesh(folder / name);
            gzip(folder / (name + ".gz"), contents(folder / name));
            expect_triangles_of_mesh(folder / (name + ".gz"));
        }
    }
    for (const GltfCase& c : gltf_cases()) {
        SCOPED_TRACE(c.name);
        write_buffer(folder, c.file);
        for (const auto& path :
             {folder.file("a.gltf", c.file.text()), folder.file("a.glb", c.file.container())}) {
            const auto model = load_model<double>(path);
            EXPECT_EQ(corners_of(model), c.triangles);
            expect_triangles_of_mesh<double>(path);
            const bool is_rounded_twice =
                c.name.starts_with("normalized");  // first the object's, then the world's
            if (!is_rounded_twice) expect_triangles_of_mesh<float>(path);
        }
    }
}

/// Normals and a material that save_mesh writes are read back.
TEST(Models, SavedNormalsAndMaterialsAreRead) {
    TempFolder folder;
    folder.file("glass.mtl", "newmtl clear\nillum 7\nNi 1.25\nNs 1000000\n");
    std::mt19937_64 random(9);
    const auto mesh = random_mesh<double>(random);
    std::vector<Vec3f> normals;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
        normals.push_back(normalized(Vec3f(static_cast<float>(i) + 0.5f, 1, -2)));
    for (const std::string name : {"a.ply", "a.obj"}) {
        SCOPED_TRACE(name);
        SavedLooks looks{.normals = normals, .material_file = "", .material = ""};
        if (name == "a.obj") looks.material_file = "glass.mtl", looks.material = "clear";
        save_mesh(folder / name, mesh, {}, nullptr, looks);
        const auto model = load_model<double>(folder / name);
        EXPECT_TRUE(model.warnings.empty());
        ASSERT_EQ(model.objects.size(), 1u);
        const auto& object = model.objects[0];
        ASSERT_EQ(object.mesh.triangles, mesh.triangles);
        EXPECT_EQ(object.mesh.vertices, mesh.vertices);
        for (std::size_t t = 0; t < mesh.size(); ++t) {
            const auto corners = object.attributes.normals.at_corners(object.mesh, t);
            for (std::size_t k = 0; k < 3; ++k)
                EXPECT_EQ(object.attributes.normals.values.at(corners[k]), normals[mesh.triangles[t][k]]);
        }
        if (name == "a.obj") {
            const Material& material = model.materials.at(object.material_of(0));
            EXPECT_EQ(material.name, "clear");
            EXPECT_EQ(material.ior, 1.25f);
        }
    }
    const auto refuses = [&](const std::string& name, const SavedLooks& looks, const std::string& part) {
        try {
            save_mesh(folder / name, mesh, {}, nullptr, looks);
            ADD_FAILURE() << name << ": " << part;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        }
        EXPECT_FALSE(std::filesystem::exists(folder / name));
    };
    refuses("b.stl", {normals, "", ""}, "normals are not saved as .stl");
    refuses("b.off", {normals, "", ""}, "normals are not saved as .off");
    refuses("b.ply", {normals, "", "clear"}, "materials are not saved as .ply");
    normals.pop_back();
    refuses("b.obj", {normals, "", ""}, "Give each vertex one");
}

TEST(Models, WithoutLooksTakeNoMemoryForThem) {
    TempFolder folder;
    std::mt19937_64 random(8);
    const auto mesh = random_mesh<float>(random);
    std::vector<std::filesystem::path> paths;
    for (const std::string name : {"a.ply", "a.stl", "a.obj", "a.off"}) {
        save_mesh(folder / name, mesh);
        paths.push_back(folder / name);
    }
    paths.push_back(folder.file("a.gltf", triangle().text()));
    for (const auto& path : paths) {
        SCOPED_TRACE(path.filename());
        const auto model = load_model(path);
        ASSERT_EQ(model.objects.size(), 1u);
        const Attributes& a = model.objects[0].attributes;
        EXPECT_EQ(a.normals.values.capacity() + a.normals.corners.capacity() + a.colours.values.capacity() +
                      a.colours.corners.capacity() + a.texture_coordinates.capacity() +
                      model.objects[0].materials.capacity(),
                  0u);
        EXPECT_EQ(model.materials.size(), 1u);
        EXPECT_TRUE(model.textures.empty() && model.lights.empty() && model.cameras.empty());
        EXPECT_TRUE(model.not_shown.empty() && model.warnings.empty());
    }
}

/// A polygon with a reflex corner, so that its triangles are no fan; the boundary passes twice through the
/// point (0, 0), where its corners differ in all but place.
const std::vector<Vec2f> outline{{0, 0}, {4, 0}, {4, 4}, {0, 0}, {1, 3}, {-3, 3}, {-1, 1}, {-3, 0}};

TEST(Models, PolygonsKeepTheValuesOfEachCorner) {
    TempFolder folder;
    // Texture coordinates are the places, and normals have the number of the corner.
    std::string vertices, coordinates, normals, face = "f", ply_face = std::to_string(outline.size());
    std::string list = std::to_string(2 * outline.size()), ply_vertices;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const std::string n = std::to_string(i + 1);
        const std::string place = std::to_string(outline[i][0]) + " " + std::to_string(outline[i][1]);
        vertices += "v " + place + " 0\n";
        ply_vertices += place + " 0\n";
        coordinates += "vt " + place + "\n";
        normals += "vn " + n + " 0 1\n";
        face += " " + n + "/" + n + "/" + n;
        ply_face += " " + std::to_string(i);
        list += " " + place;
    }
    const auto expect = [&](const std::filesystem::path& path, bool has_normals) {
        SCOPED_TRACE(path.filename());
        expect_triangles_of_mesh(path);
        const auto model = load_model<float>(path);
        const Object<float>& object = model.objects[0];
        ASSERT_EQ(object.mesh.size(), outline.size() - 2);
        ASSERT_EQ(object.attributes.texture_coordinates.size(), 1u);
        const auto& set = object.attributes.texture_coordinates[0];
        for (std::size_t i = 0; i < object.mesh.size(); ++i) {
            const TriangleIndices corners = set.at_corners(object.mesh, i);
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3f place = object.mesh.vertices[object.mesh.triangles[i][k]];
                EXPECT_EQ(set.values[corners[k]], Vec2f(place[0], 1 - place[1])) << "v from the top";
                EXPECT_EQ(corners[k], object.mesh.triangles[i][k]) << "corners at one place are kept apart";
                if (!has_normals) continue;
                const auto& n = object.attributes.normals;
                EXPECT_EQ(n.values[n.corners[i][k]], Vec3f(static_cast<float>(corners[k] + 1), 0, 1));
            }
        }
    };
    expect(folder.file("a.obj", vertices + coordinates + normals + face + "\n"), true);
    expect(folder.file("a.ply", "ply\nformat ascii 1.0\nelement vertex " + std::to_string(outline.size()) +
                                    "\nproperty float x\nproperty float y\nproperty float z\n"
                                    "element face 1\nproperty list uchar float texcoord\n"
                                    "property list uchar int vertex_indices\nend_header\n" +
                                    ply_vertices + list + " " + ply_face + "\n"),
           false);
    // The fan would be other triangles.
    EXPECT_NE(load_mesh(folder / "a.obj").triangles[1], (TriangleIndices{0, 2, 3}));
}

TEST(Models, ObjVerticesMayHaveComments) {
    TempFolder folder;
    const auto model = load_model(folder.file(
        "a.obj", "v 0 0 0 # vertex 1 of 3\nv 1 0 0 1.0 # w\nv 0 1 0 1 1 1 # white\nf 1 2 3 # a face\n"));
    EXPECT_EQ(model.triangles(), 1u);
    EXPECT_EQ(model.objects[0].attributes.colours.values.size(), 3u);
}
TEST(Models, ObjCornersMayLackValues) {
    TempFolder folder;
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    const auto path = folder.file("a.obj", corners +
                                               "vt 0.25 0.75\nvt 1\nvn 0 0 1\nvn 1 0 0\n"
                                               "f 1 2 3\nf 1/1 2/1 3/2\nf\nf 1//1 2//-1 4\nf 1/2/1 3 4\n");
    const auto model = load_model(path);
    const Attributes& a = model.objects[0].attributes;
    using List = std::vector<TriangleIndices>;
    const std::uint32_t no = no_value;
    ASSERT_EQ(a.texture_coordinates.size(), 1u);
    EXPECT_EQ(a.texture_coordinates[0].corners, (List{{no, no, no}, {0, 0, 1}, {no, no, no}, {1, no, no}}));
    EXPECT_EQ(a.texture_coordinates[0].values, (std::vector<Vec2f>{{0.25f, 0.25f}, {1, 1}}));
    EXPECT_EQ(a.normals.corners, (List{{no, no, no}, {no, no, no}, {0, 1, no}, {0, no, no}}));
    EXPECT_EQ(model.objects[0].mesh.faces, (std::vector<std::uint32_t>{0, 1, 3, 4}));
}

TEST(Models, PlyKeepsTheValuesOfVertices) {
    TempFolder folder;
    const auto path = folder.file(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float nx\nproperty float x\nproperty float y\n"
        "property float z\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\n"
        "property float quality\nelement face 1\nproperty list uchar int vertex_indices\n"
        "element edge 1\nproperty int vertex1\nend_header\n"
        "0.5 0 0 0 -1 0.25 0.125 0.25 9\n0 1 0 0 0 1 1 0 9\n0 0 1 0 0 1 0 1 9\n3 0 1 2\n4\n");
    const auto model = load_model(path);
    const Attributes& a = model.objects[0].attributes;
    EXPECT_EQ(a.normals.values, (std::vector<Vec3f>{{0.5f, -1, 0.25f}, {0, 0, 1}, {0, 0, 1}}));
    EXPECT_TRUE(a.normals.corners.empty()) << "the mesh's own indices name them";
    EXPECT_EQ(a.texture_coordinates[0].values, (std::vector<Vec2f>{{0.125f, 0.75f}, {1, 1}, {0, 0}}));
    EXPECT_EQ(model.not_shown,
              (std::vector<std::string>{"property 'quality' (PLY)", "element 'edge' (PLY)"}));
}

TEST(Models, BadValuesAtCorners) {
    TempFolder folder;
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const auto refuse = [&](const std::string& lines, std::vector<std::string> parts) {
        parts.insert(parts.begin(), "a.obj");
        expect_input_error([&] { load_model(folder.file("a.obj", corners + lines)); }, parts);
    };
    refuse("vt 0 0\nf 1/1 2/1 3/2\n", {"face 0 names texture coordinate 1", "only 1"});
    // Coordinates of which there are none are left out.
    const auto without = load_model(folder.file("a.obj", corners + "f 1/1 2/1 3/1\n"));
    ASSERT_EQ(without.warnings.size(), 1u);
    EXPECT_NE(without.warnings[0].find("there are none"), std::string::npos);
    refuse("vn 0 0 1\nf 1//1 2//1 3//-2\n", {"line 5", "names normal -2", "only 1 so far"});
    refuse("vn 0 0 1\nf 1//1 2//1 3//0\n", {"line 5", "names normal '0'", "begin at 1"});
    refuse("vn 0 0 1\nf 1//1 2//1 3//x\n", {"line 5", "names normal 'x'"});
    refuse("vn 0 0\nf 1 2 3\n", {"line 4", "'' where a number should stand"});
    refuse("vt x\nf 1 2 3\n", {"line 4", "'x' where a number"});
    refuse("v 1 2 3 0.5 0.5 x\nf 1 2 3\n", {"line 4", "'x' where a number"});
    refuse("", {"only points"});
    // Values that are not finite are left out.
    const auto model =
        load_model(folder.file("a.obj", corners + "vn 0 nan 1\nvn 0 0 1\nvt inf 0\nf 1/1/1 2/1/2 3/1/2\n"));
    EXPECT_EQ(model.objects[0].attributes.normals.corners[0], (TriangleIndices{no_value, 1, 1}));
    EXPECT_EQ(model.objects[0].attributes.texture_coordinates[0].corners[0],
              (TriangleIndices{no_value, no_value, no_value}));
    ASSERT_EQ(model.warnings.size(), 2u);
    EXPECT_NE(model.warnings[0].find("a normal is not finite"), std::string::npos);
    // Those of vertices too, where a face names a vertex that is not there.
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "property float nx\nproperty float ny\nproperty float nz\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n0 0 0 0 0 nan\n1 0 0 0 0 1\n0 1 0 0 0 1\n";
    const auto ply = load_model(folder.file("a.ply", header + "3 0 1 2\n"));
    EXPECT_EQ(ply.objects[0].attributes.normals.corners[0], (TriangleIndices{no_value, 1, 2}));
    expect_input_error([&] { load_model(folder.file("b.ply", header + "3 0 1 7\n")); },
                       {"b.ply", "face 0 names vertex 7"});
}

TEST(Models, OtherFilesAreRefusedAsMeshesAre) {
    TempFolder folder;
    expect_input_error([&] { load_model(folder / "none.gltf"); }, {"none.gltf", "no such file"});
    expect_input_error([&] { load_model(folder.file("a.what", "x")); }, {"a.what", "'.what' is not known"});
    expect_input_error([&] { load_model(folder.file("a.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")); },
                       {"a.obj", "vertex 0 is (nan"});
    Gltf far = triangle();
    far.nodes = R"({"mesh":0,"name":"far","translation":[1e30,0,0]})";
    expect_input_error([&] { load_model<float>(folder.file("far.gltf", far.text())); },
                       {"far.gltf", "'far'", "too large"});
    Gltf none = triangle();
    none.nodes = "{}";
    expect_input_error([&] { load_model(folder.file("none.glb", none.container())); },
                       {"none.glb", "neither faces nor points"});
}

TEST(Models, ReadingCanBeCancelled) {
    TempFolder folder;
    const std::atomic<bool> cancel = true;
    const Progress progress{{}, &cancel};
    std::mt19937_64 random(8);
    save_mesh(folder / "a.ply", random_mesh<float>(random));
    save_mesh(folder / "a.obj", random_mesh<float>(random));
    for (const auto& path : {folder / "a.ply", folder / "a.obj", folder.file("a.gltf", triangle().text())})
        EXPECT_THROW(load_model(path, {}, progress), Cancelled);
}

}  // namespace
}  // namespace hedgerow
