/// Mesh files: saved meshes are read back, and every variant of a format gives the same mesh.
#include <atomic>
#include <charconv>
#include <cmath>

#include "gltf_text.h"

#define TINYOBJLOADER_USE_DOUBLE
#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>

namespace hedgerow {
namespace {

using namespace testing_io;

template <class T>
class MeshFile : public testing::Test {
protected:
    TempFolder folder;
    std::mt19937_64 random{7};
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(MeshFile, Scalars);

/// The mesh as PLY, with properties and elements that no reader needs, in an unusual order.
template <class T>
std::string odd_ply(const TriangleMesh<T>& mesh, const std::string& format) {
    // Write the header. The element `nothing` has 10^18 entries, but no properties and so no bytes.
    const std::string type = sizeof(T) == 4 ? "float32" : "double";
    std::string s = "ply\r\nformat " + format + " 1.0\ncomment x y z\nobj_info none\n";
    s += "element face " + std::to_string(mesh.size()) + "\nproperty short flags\n";
    s += "property list ushort uint vertex_index\nproperty list uchar double texture\n";
    s += "element material 2\nproperty int64 id\nproperty list int short more\nelement nothing "
         "1000000000000000000\n";
    s += "element vertex " + std::to_string(mesh.vertices.size()) + "\nproperty uchar red\n";
    for (const char a : {'z', 'x', 'y'}) s += "property " + type + " " + a + "\n";
    s += "property list uchar int ring\nend_header\n";
    const auto put = [&](auto value) {
        if (format != "ascii")
            return append(s, value, format == "binary_big_endian" ? std::endian::big : std::endian::little);
        char digits[64];
        s.append(digits, std::to_chars(digits, digits + 64, value).ptr) += ' ';
    };
    // Write the values: faces, materials, vertices.
    for (const auto& t : mesh.triangles) {
        put(std::int16_t(-5)), put(std::uint16_t(3));
        for (const auto v : t) put(v);
        put(std::uint8_t(2)), put(0.5), put(-1e300);
    }
    put(std::int64_t(-1)), put(std::int32_t(0)), put(std::int64_t(9)), put(std::int32_t(1)),
        put(std::int16_t(3));
    for (const auto& v : mesh.vertices) {
        put(std::uint8_t(200)), put(v[2]), put(v[0]), put(v[1]), put(std::uint8_t(1)), put(std::int32_t(-9));
    }
    return s;
}

TYPED_TEST(MeshFile, EveryPlyIsTheSame) {
    for (int round = 0; round < 50; ++round) {
        const auto mesh = random_mesh<TypeParam>(this->random);
        for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
            const std::string bytes = odd_ply(mesh, format);
            gzip(this->folder / "a.ply.gz", bytes);
            for (const auto& path : {this->folder.file("A.PLY", bytes), this->folder / "a.ply.gz"}) {
                const auto read = load_mesh<TypeParam>(path);
                ASSERT_TRUE(same_bits(read.vertices, mesh.vertices)) << format;
                ASSERT_EQ(read.triangles, mesh.triangles);
                ASSERT_TRUE(read.faces.empty());
            }
        }
    }
}

TYPED_TEST(MeshFile, WhatIsSavedIsReadBack) {
    for (int round = 0; round < 100; ++round) {
        const auto mesh = random_mesh<TypeParam>(this->random);
        for (const std::string extension : {".ply", ".obj", ".off", ".Ply"}) {
            const auto path = this->folder / ("mesh" + extension);
            save_mesh(path, mesh);
            const auto read = load_mesh<TypeParam>(path);
            ASSERT_TRUE(same_bits(read.vertices, mesh.vertices)) << extension;
            ASSERT_EQ(read.triangles, mesh.triangles);
            ASSERT_TRUE(read.faces.empty());
        }
    }
    EXPECT_EQ(this->folder.file_count(), 4u) << "a temporary file was left";
}

TYPED_TEST(MeshFile, StlKeepsTrianglesAndJoinsCorners) {
    for (int round = 0; round < 100; ++round) {
        const auto mesh = random_mesh<float>(this->random);
        save_mesh(this->folder / "mesh.stl", mesh);
        const auto read = load_mesh<TypeParam>(this->folder / "mesh.stl");
        ASSERT_EQ(read.size(), mesh.size());
        for (std::size_t i = 0; i < mesh.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k)
                ASSERT_EQ(read.vertices[read.triangles[i][k]],
                          (Vec<TypeParam, 3>(mesh.vertices[mesh.triangles[i][k]])));
        for (std::size_t i = 0; i < read.vertices.size(); ++i)
            for (std::size_t k = 0; k < i; ++k) ASSERT_NE(read.vertices[i], read.vertices[k]);
    }
}

TEST(Stl, AsciiInAnyCaseWithSeveralSolidsAndNegativeZero) {
    TempFolder folder;
    const std::string text =
        "SOLID one two\n FACET normal nan 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 "
        "0.1 0\n"
        "  endloop\n endfacet\nENDSOLID one two\nsolid b\nfacet normal 0 0 1 outer loop vertex -0 0.1 -0.0 "
        "vertex 1 0 0 vertex 1 1e0 0 endloop endfacet\nendsolid b\n";
    gzip(folder / "b.stl.gz", text);
    for (const auto& path : {folder.file("a.stl", text), folder / "b.stl.gz"}) {
        const auto mesh = load_mesh<double>(path);
        EXPECT_EQ(mesh.vertices.size(), 4u);
        EXPECT_EQ(mesh.triangles, (std::vector<TriangleIndices>{{0, 1, 2}, {2, 1, 3}}));
        EXPECT_EQ(mesh.vertices[2][1], 0.1);
    }
}

TEST(Stl, BinaryThatBeginsWithSolid) {
    TempFolder folder;
    TriangleMesh<float> mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}};
    save_mesh(folder / "a.stl", mesh);
    std::string bytes = contents(folder / "a.stl");
    bytes.replace(0, 6, "solid ");
    EXPECT_EQ(load_mesh(folder.file("b.stl", bytes)).triangles, mesh.triangles);
}

TEST(Polygons, ConvexOnesBecomeFansThatKnowTheirFace) {
    TempFolder folder;
    const std::string vertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n-1 0.5 0\n";
    const std::string faces = "3 0 1 2\n4 0 1 2 3\n2 0 1\n0\n5 0 1 2 3 4\n3 2 1 0\n";
    std::string obj;
    for (const std::string v : {"0 0 0", "1 0 0", "1 1 0", "0 1 0", "-1 0.5 0"}) obj += "v " + v + "\n";
    obj += "f 1 2 3\nf 1/1 2/2/2 3//3 -2\nf 1 2\nf\nf 1 2 \\\n3 4 5 # end\nf 3 2 1\n";
    const std::filesystem::path paths[] = {
        folder.file("a.ply",
                    "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty "
                    "float z\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n" +
                        vertices + faces),
        folder.file("a.off", "OFF # a comment\n5 6 0\n\n" + vertices + faces),
        folder.file("b.off", "COFF 5 6 0\n" + vertices + faces), folder.file("a.obj", obj)};
    for (const auto& path : paths) {
        const auto mesh = load_mesh(path);
        EXPECT_EQ(mesh.triangles,
                  (std::vector<TriangleIndices>{
                      {0, 1, 2}, {0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {2, 1, 0}}))
            << path;
        EXPECT_EQ(mesh.faces, (std::vector<std::uint32_t>{0, 1, 1, 4, 4, 4, 5})) << path;
    }
}

TEST(Off, HeadersAreReadAsTheyAreWritten) {
    TempFolder folder;
    const std::string rest = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    int n = 0;
    for (const std::string header : {"OFF\n3 1 0\n", "off\n3 1 0\n", "  \n\t OFF\r\n\n 3 1 0\n",
                                     "OFF 3\n# faces, edges\n1 0\n", "3 1 0\n", "OFF\n3 1\n"}) {
        const auto path = folder.file(std::to_string(n++) + ".off", header + rest);
        EXPECT_EQ(load_mesh(path).triangles, (std::vector<TriangleIndices>{{0, 1, 2}})) << header;
    }
    for (const std::string header :
         {"OOF\n3 1 0\n", "4OFF\n3 1 0\n", "OFF BINARY\n3 1 0\n", "OFF\nthree 1 0\n"})
        expect_input_error([&] { load_mesh(folder.file("bad.off", header + rest)); }, {"bad.off"});
}

TEST(Obj, AgreesWithTinyobjloader) {
    TempFolder folder;
    std::mt19937_64 random(3);
    for (int round = 0; round < 200; ++round) {
        // Write a random file: vertices, and faces with absolute and relative indices in every form.
        std::string text = "# random\nmtllib none.mtl\no thing\n";
        int vertices = 0;
        for (int i = 0; i < 30; ++i) {
            if (vertices < 3 || random() % 2 == 0) {
                text += "v";
                for (int k = 0; k < 3; ++k) text += " " + std::to_string(int(random() % 2001) - 1000);
                text += "\nvn 0 0 1\nvt 0.5 0.5\n", ++vertices;
                continue;
            }
            text += random() % 5 == 0 ? "s off\nusemtl m\ng part\nf" : "f";
            for (std::uint64_t k = 3 + random() % 3; k > 0; --k) {
                const int v = 1 + int(random() % std::uint64_t(vertices));
                const std::string index = std::to_string(random() % 2 == 0 ? v : v - vertices - 1);
                const std::string forms[] = {index, index + "/" + index, index + "//" + index,
                                             index + "/" + index + "/" + index};
                text += " " + forms[random() % 4];
            }
            text += random() % 2 == 0 ? "\n" : "\r\n";
        }
        text += "f 1 2 3\n";
        // Read it with tinyobjloader. List the corners and the number of the face of each triangle of its
        // fan.
        tinyobj::attrib_t attributes;
        std::vector<tinyobj::shape_t> shapes;
        std::vector<tinyobj::material_t> materials;
        std::string warning, error;
        std::istringstream in(text);
        ASSERT_TRUE(
            tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &in, nullptr, false));
        std::vector<std::vector<std::uint32_t>> expected;
        std::vector<std::uint32_t> ids;
        std::uint32_t face = 0;
        for (const auto& shape : shapes) {
            std::size_t at = 0;
            for (const std::size_t n : shape.mesh.num_face_vertices) {
                const auto v = [&](std::size_t k) {
                    return std::uint32_t(shape.mesh.indices[at + k].vertex_index);
                };
                std::vector<std::uint32_t> corners;
                for (std::size_t k = 0; k < n; ++k) corners.push_back(v(k));
                for (std::size_t k = 2; k < n; ++k) expected.push_back(corners), ids.push_back(face);
                at += n, ++face;
            }
        }
        // Compare: triangles in their face, vertices and face ids.
        const auto mesh = load_mesh<double>(folder.file("a.obj", text));
        ASSERT_EQ(mesh.size(), expected.size());
        for (std::size_t i = 0; i < mesh.size(); ++i) {
            const auto& [a, b, c] = mesh.triangles[i];
            if (expected[i].size() == 3) {
                ASSERT_EQ(expected[i], (std::vector<std::uint32_t>{a, b, c}));
            }
            for (const auto v : {a, b, c})
                ASSERT_NE(std::find(expected[i].begin(), expected[i].end(), v), expected[i].end());
        }
        ASSERT_EQ(mesh.vertices.size() * 3, attributes.vertices.size());
        for (std::size_t i = 0; i < attributes.vertices.size(); ++i)
            ASSERT_EQ(mesh.vertices[i / 3][int(i % 3)], attributes.vertices[i]);
        for (std::size_t i = 0; i < mesh.size(); ++i) ASSERT_EQ(mesh.view().id(i), ids[i]);
    }
}

TEST(DropBad, LeavesOutWholeFacesAndKeepsTheirIds) {
    TempFolder folder;
    const auto path = folder.file("a.obj",
                                  "v 0 0 0\nv nan 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1e30\nv 1 1 0\n"
                                  "f 1 2 3\nf 1 3 4\nf 1 3 6 5\nf 3 6 4\n");
    const auto mesh = load_mesh(path, {.drop_bad = true});
    EXPECT_EQ(mesh.vertices, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
    EXPECT_EQ(mesh.triangles, (std::vector<TriangleIndices>{{0, 1, 2}, {1, 3, 2}}));
    EXPECT_EQ(mesh.faces, (std::vector<std::uint32_t>{1, 3}));
    EXPECT_EQ(load_mesh<double>(path, {.drop_bad = true}).size(), 4u) << "1e30 is near enough in double";
}

TEST(Progress, IsToldAndCancels) {
    TempFolder folder;
    std::mt19937_64 random(5);
    TriangleMesh<float> mesh = random_mesh<float>(random);
    mesh.triangles.resize(200000);
    save_mesh(folder / "a.ply", mesh);
    std::vector<std::uint64_t> seen;
    std::atomic<bool> cancel = false;
    const std::uint64_t size = std::filesystem::file_size(folder / "a.ply");
    Progress progress{[&](std::uint64_t done, std::uint64_t total) {
                          EXPECT_EQ(total, size);
                          EXPECT_TRUE(seen.empty() || seen.back() <= done);
                          seen.push_back(done);
                      },
                      &cancel};
    load_mesh(folder / "a.ply", {}, progress);
    EXPECT_GT(seen.size(), 5u);
    progress.report = [&](std::uint64_t, std::uint64_t) { cancel = true; };
    EXPECT_THROW(load_mesh(folder / "a.ply", {}, progress), Cancelled);
    EXPECT_THROW(load_mesh(folder.file("a.gltf", testing_gltf::triangle().text()), {}, progress), Cancelled);
}

TEST(Progress, OfSavingEndsWithAllThatIsWritten) {
    TempFolder folder;
    TriangleMesh<float> mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}};
    mesh.vertices.resize(30000), mesh.triangles.assign(60000, {0, 1, 2});
    for (const std::string name : {"a.ply", "a.stl", "a.obj", "a.off"}) {
        std::uint64_t last = 0, all = 0;
        save_mesh(folder / name, mesh, {[&](std::uint64_t done, std::uint64_t total) {
                      EXPECT_LE(done, total);
                      last = done, all = total;
                  }});
        EXPECT_EQ(all, mesh.size() + (name == "a.stl" ? 0 : mesh.vertices.size()));
        EXPECT_LT(all - last, 4096u) << name;
    }
}

TEST(SaveMesh, ReportsWhatItCannotWrite) {
    TempFolder folder;
    const TriangleMesh<float> mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}};
    expect_output_error([&] { save_mesh(folder / "none/a.ply", mesh); }, {"a.ply", "cannot be written"});
    expect_input_error([&] { save_mesh(folder / "a.xyz", mesh); }, {"a.xyz", ".ply .stl .obj .off"});
    expect_input_error([&] { save_mesh(folder / "a", mesh); }, {"no extension"});
    std::filesystem::create_directory(folder / "d.ply");
    expect_output_error([&] { save_mesh(folder / "d.ply", mesh); }, {"d.ply", "directory"});
    TriangleMesh<float> broken = mesh;
    broken.triangles[0][1] = 3;
    expect_input_error([&] { save_mesh(folder / "a.stl", broken); }, {"triangle 0", "vertex 3"});
    EXPECT_EQ(folder.file_count(), 1u);
    if (std::filesystem::exists("/dev/full")) {
        std::filesystem::create_symlink("/dev/full", folder / "full.ply");
        expect_output_error([&] { save_mesh(folder / "full.ply", mesh); }, {"full", "cannot be written"});
    }
}

TEST(SaveMesh, ReplacesTheFileThatALinkNames) {
    TempFolder folder;
    const TriangleMesh<float> mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}};
    folder.file("real.ply", "old");
    std::filesystem::create_symlink(folder / "real.ply", folder / "link.ply");
    save_mesh(folder / "link.ply", mesh);
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.ply"));
    EXPECT_EQ(load_mesh(folder / "real.ply").triangles, mesh.triangles);
}

}  // namespace
}  // namespace hedgerow
