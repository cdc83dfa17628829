/// Bad mesh files: each throws an InputError that names the file, the place and the remedy.
#include <hedgerow/io/validate.h>

#include "gltf_text.h"

namespace hedgerow {
namespace {

using namespace testing_io;

class BadInput : public testing::Test {
protected:
    void expect_bad(const std::string& name, const std::string& bytes, std::vector<std::string> parts) {
        parts.insert(parts.begin(), name);
        const auto path = folder.file(name, bytes);
        expect_input_error([&] { load_mesh<float>(path); }, parts);
        expect_input_error([&] { load_mesh<double>(path); }, parts);
    }
    static std::string ply(const std::string& vertices, const std::string& faces, const std::string& body,
                           const std::string& format = "ascii") {
        return "ply\nformat " + format + " 1.0\nelement vertex " + vertices +
               "\nproperty double x\nproperty double y\nproperty double z\nelement face " + faces +
               "\nproperty list uchar int vertex_indices\nend_header\n" + body;
    }
    const std::string corners = "0 0 0\n1 0 0\n0 1 0\n";
    TempFolder folder;
};

TEST_F(BadInput, NoFile) {
    expect_input_error([&] { load_mesh(folder / "none.ply"); }, {"none.ply", "no such file", "Check"});
    expect_input_error([&] { load_mesh(folder / "none.gltf"); }, {"none.gltf", "no such file"});
    expect_input_error([&] { load_mesh(folder / "none.what"); }, {"none.what", "no such file"});
    std::filesystem::create_directory(folder / "d.ply");
    expect_input_error([&] { load_mesh(folder / "d.ply"); }, {"d.ply", "is a directory"});
    if (std::filesystem::exists("/dev/zero")) {
        std::filesystem::create_symlink("/dev/zero", folder / "zero.ply");
        expect_input_error([&] { load_mesh(folder / "zero.ply"); }, {"not a regular file"});
    }
}

TEST_F(BadInput, EmptyFile) {
    for (const std::string name : {"a.ply", "a.stl", "a.obj", "a.off", "a.gltf", "a.ply.gz"})
        expect_bad(name, "", {"the file is empty"});
}

TEST_F(BadInput, PointerOfGitLfs) {
    const std::string pointer =
        "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a214614ab2935c943f9e0ff69d2\nsize 12345\n";
    for (const std::string name : {"a.ply", "a.stl", "a.obj", "a.off", "a.gltf", "a.glb", "a.ply.gz"})
        expect_bad(name, pointer, {"Git LFS", "git lfs pull"});
}

TEST_F(BadInput, OtherEncodings) {
    for (const std::string mark : {"\xFF\xFE", "\xFE\xFF"})
        for (const std::string name : {"a.ply", "a.obj", "a.off", "a.gltf"})
            expect_bad(name, mark + "v\n", {"UTF-16", "UTF-8"});
}

TEST_F(BadInput, LongNumbersAreShort) {
    const auto path = folder.file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1e300 0\nf 1 2 3\n");
    expect_input_error([&] { load_mesh<double>(path); }, {"vertex 2 is (0, 1e+300, 0)"});
}

TEST_F(BadInput, CompressedGltf) {
    testing_gltf::Gltf file = testing_gltf::Gltf().view("no Draco").accessor("VEC3", testing_gltf::f4, "3");
    file.primitive +=
        R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}})";
    expect_bad("a.gltf", file.text(), {"Draco", "KHR_draco_mesh_compression"});
    file.more = R"(,"extensionsRequired":["KHR_draco_mesh_compression"])";
    expect_bad("b.gltf", file.text(), {"KHR_draco_mesh_compression"});
    file.more = R"(,"extensionsRequired":["EXT_meshopt_compression"])";
    expect_bad("c.gltf", file.text(), {"EXT_meshopt_compression"});
}

TEST_F(BadInput, SurplusElementsAreTold) {
    const auto told = [&](const std::string& name, const std::string& bytes) {
        LoadReport report;
        load_mesh(folder.file(name, bytes), {.report = &report});
        ASSERT_EQ(report.warnings.size(), 1u) << name;
        EXPECT_NE(report.warnings[0].find("follow"), std::string::npos) << report.warnings[0];
    };
    told("a.ply", ply("3", "1", corners + "3 0 1 2\n3 2 1 0\n"));
    told("a.off", "OFF\n3 1 0\n" + corners + "3 0 1 2\n3 2 1 0\n");
    std::string stl(80, ' ');
    append(stl, std::uint32_t(1));
    told("a.stl", stl + std::string(12, '\0') + std::string(36, '\1') + std::string(2 + 30, '\0'));
}

TEST_F(BadInput, NumbersThatStlCannotHold) {
    const auto path = folder.file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1e100 0\nf 1 2 3\n");
    const auto mesh = load_mesh<double>(path);
    expect_input_error([&] { save_mesh(folder / "a.stl", mesh); }, {"vertex 2", "1e+100", ".ply"});
    EXPECT_FALSE(std::filesystem::exists(folder / "a.stl"));
    EXPECT_NO_THROW(save_mesh(folder / "a.ply", mesh));
}

TEST_F(BadInput, UnknownExtension) {
    expect_bad("a.what", "x", {"'.what' is not known", ".ply .stl .obj .off .gltf .glb"});
    expect_bad("noextension", "x", {"no extension", ".ply"});
    expect_bad("a.gz", "x", {"'.gz'", ".ply"});
}

TEST_F(BadInput, OnlyPoints) {
    expect_bad("a.ply", ply("3", "0", corners), {"only points (3", "load_points"});
    expect_bad("a.obj", "v 0 0 0\nf 1 1\n", {"only points", "load_points"});
    expect_bad("a.off", "OFF\n3 0 0\n" + corners, {"only points"});
}

TEST_F(BadInput, NeitherFacesNorPoints) {
    expect_bad("a.ply", ply("0", "0", ""), {"neither faces nor points"});
    expect_bad("a.obj", "this is a letter\n", {"neither faces nor points"});
    expect_bad("a.stl", "solid x\nendsolid x\n", {"neither faces nor points"});
    expect_bad("b.stl", std::string(84, '\0'), {"neither faces nor points"});
    expect_bad("a.off", "OFF 0 0 0\n", {"neither faces nor points"});
}

TEST_F(BadInput, IndexOutOfRange) {
    expect_bad("a.ply", ply("3", "2", corners + "3 0 1 2\n3 0 1 3\n"), {"face 1 names vertex 3", "only 3"});
    expect_bad("b.ply", ply("3", "1", corners + "3 0 1 -1\n"), {"line 13", "'face', number 0", "vertex -1"});
    expect_bad("a.off", "OFF\n3 1 0\n" + corners + "3 0 1 4294967295\n", {"face 0 names vertex 4294967295"});
    expect_bad("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 9\n", {"face 1 names vertex 8"});
    expect_bad("b.obj", "v 0 0 0\nf 1 1 -2\n", {"line 2", "vertex -2", "only 1"});
    expect_bad("c.obj", "v 0 0 0\n\nf 0 1 1\n", {"line 3", "'0'", "begin at 1"});
    expect_bad("d.obj", "v 0 0 0\nf 1 1 99999999999999999999\n", {"line 2"});
}

TEST_F(BadInput, AbsurdCoordinates) {
    for (const std::string bad : {"nan", "inf", "-inf", "1e400", "-1e300"}) {
        const std::string vertices = "0 0 0\n1 0 0\n0 " + bad + " 0\n";
        expect_bad("a.ply", ply("3", "1", vertices + "3 0 1 2\n"), {"vertex 2 is (", "drop_bad"});
        expect_bad("a.off", "OFF\n3 1 0\n" + vertices + "3 0 1 2\n", {"vertex 2 is ("});
        expect_bad("a.obj", "v 0 0 0\nv 1 0 0\nv 0 " + bad + " 0\nf 1 2 3\n", {"vertex 2 is ("});
        const auto path = folder / "a.obj";
        expect_input_error([&] { load_mesh(path, {.drop_bad = true}); }, {"a.obj", "none is left"});
    }
    const auto path = folder.file("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1e30 0\nf 1 2 3\n");
    expect_input_error([&] { load_mesh<float>(path); }, {"2^60"});
    EXPECT_NO_THROW(load_mesh<double>(path));
}

TEST_F(BadInput, AbsurdCounts) {
    const std::string huge = "1000000000000000000";
    for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
        expect_bad("a.ply", ply(huge, "1", corners, format), {"more than 4294967295 vertices"});
        expect_bad("a.ply", ply("1", huge, std::string(24, '0') + " 1 1", format),
                   {"more than 4294967295 faces"});
        expect_bad("a.ply", ply("4000000000", "1", corners, format), {"4000000000", "cut off"});
        expect_bad("a.ply", ply("99999999999999999999", "1", corners, format),
                   {"line 3", "99999999999999999999"});
    }
    expect_bad("a.ply", ply("3", "-1", corners), {"line 7", "'-1'"});
    std::string stl(80, ' ');
    append(stl, std::uint32_t(0xFFFFFFFE));
    expect_bad("a.stl", stl + std::string(100, '\0'),
               {"promises 4294967294 triangles", "at most 100 bytes follow", "cut off"});
    std::string more(80, ' ');
    append(more, std::uint32_t(1));
    expect_bad("b.stl", more + std::string(100, '\0'), {"promises 1 triangles, but there are more"});
    expect_bad("a.off", "OFF\n4000000000 1 0\n" + corners, {"promises 4000000000 vertices", "cut off"});
    expect_bad("b.off", "OFF\n3 1 0\n" + corners + "4000000000 1 2 3\n", {"line 6", "face 0"});
}

TEST_F(BadInput, Truncated) {
    std::mt19937_64 random(1);
    const auto mesh = random_mesh<float>(random);
    for (const std::string extension : {".ply", ".stl"}) {
        save_mesh(folder / ("whole" + extension), mesh);
        const std::string whole = contents(folder / ("whole" + extension));
        for (std::size_t n = 1; n < whole.size(); n += 1 + n / 50)
            expect_bad("cut" + extension, whole.substr(0, n), {"cut"});
        gzip(folder / ("whole" + extension + ".gz"), whole);
        const std::string packed = contents(folder / ("whole" + extension + ".gz"));
        for (std::size_t n = 1; n < packed.size(); n += 1 + n / 20)
            expect_bad("packed" + extension + ".gz", packed.substr(0, n), {"packed"});
    }
    expect_bad("a.ply", ply("3", "1", corners + "3 0 1"), {"'face', number 0 of the 1", "cut off"});
    expect_bad("a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0", {"line 4"});
    expect_bad("b.stl", "solid x\n", {"'endsolid'", "cut off"});
    expect_bad("a.off", "OFF\n3 1 0\n" + corners, {"face 0 of 1", "cut off"});
    expect_bad("a.obj", "v 0 0 0\nv 1 0\n", {"line 2", "fewer than 3"});
    expect_bad("c.stl", "short", {"too short"});
}

TEST_F(BadInput, PlyHeaders) {
    expect_bad("a.ply", "plx\n", {"no PLY file"});
    expect_bad("a.ply", "ply\nformat ascii 2.0\n", {"line 2", "version '2.0'"});
    expect_bad("a.ply", "ply\nformat utf8 1.0\n", {"'utf8'", "binary_big_endian"});
    expect_bad("a.ply", "ply\nend_header\n", {"no line 'format'"});
    expect_bad("a.ply", "ply\nformat ascii 1.0\nproperty int x\n", {"line 3", "before any element"});
    expect_bad("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n", {"line 4", "'half'"});
    expect_bad("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nelement vertex 1\n", {"again"});
    expect_bad("a.ply", "ply\nformat ascii 1.0\nelement v 1\nproperty list float int x\n",
               {"floating-point"});
    expect_bad("a.ply", "ply\nformat ascii 1.0\nnonsense\n", {"line 3", "'nonsense'"});
    expect_bad("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n",
               {"'y'"});
    expect_bad("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty list int float x\nend_header\n0\n",
               {"'x'", "list"});
    expect_bad("a.ply", "ply\nformat ascii 1.0\nelement face 1\nproperty int x\nend_header\n0\n",
               {"vertex_indices"});
    expect_bad("a.ply",
               "ply\nformat ascii 1.0\nelement face 1\nproperty list int float vertex_index\nend_header\n0\n",
               {"whole numbers"});
    expect_bad("a.ply", ply("3", "1", "0 0 0\n1 x 0\n"), {"line 11", "'x'", "'vertex', number 1"});
    expect_bad("a.ply", ply("3", "1", corners + "-3 0 1 2\n"), {"line 13", "a list of -3"});
}

TEST_F(BadInput, Words) {
    expect_bad("a.stl", "solid x\nfacet normal 0 0 1\nouter hoop\n", {"line 3", "'hoop'", "'loop'"});
    expect_bad("a.stl", "solid x\nfacet normal 0 0 1\nouter loop vertex 0 a 0", {"line 3", "'a'"});
    expect_bad("a.stl", "solid x\nfacets\n", {"line 2", "'facets'"});
    expect_bad("a.off", "OFF\n3 x 0\n", {"line 2", "'x'"});
    expect_bad("a.off", "4OFF\n3 1 0\n", {"three dimensions"});
    expect_bad("a.off", "OFF BINARY\n", {"byte 11", "cut off"});
    expect_bad("a.off", "hello\n", {"'OFF'"});
    expect_bad("a.off", "OFF\n3 1 0\n0 0 0\n0 0\n", {"line 4"});
    expect_bad("a.obj", "v 0 0 zero\n", {"line 1", "'zero'"});
    expect_bad("a.gltf", "{nonsense", {"JSON cannot be read"});
}

TEST_F(BadInput, DamagedGzip) {
    gzip(folder / "a.ply.gz", ply("3", "1", corners + "3 0 1 2\n"));
    EXPECT_NO_THROW(load_mesh(folder / "a.ply.gz"));
    std::string bytes = contents(folder / "a.ply.gz");
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x55);
    expect_bad("b.ply.gz", bytes, {"b.ply.gz"});
}

TEST(Validate, SaysWhatIsWrongWithAMesh) {
    TriangleMesh<float> mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}}, {}};
    EXPECT_NO_THROW(validate_mesh(mesh, "it"));
    mesh.faces = {1};
    expect_input_error([&] { validate_mesh(mesh, "it"); }, {"it: ", "1 face ids for 2 triangles"});
    mesh.faces = {1, 0};
    expect_input_error([&] { validate_mesh(mesh, "it"); }, {"face id 1 stands before 0"});
    mesh.faces = {4, 4};
    EXPECT_NO_THROW(validate_mesh(mesh, "it"));
    mesh.triangles[1][0] = 7;
    expect_input_error([&] { validate_mesh(mesh, "it"); }, {"face 4 names vertex 7"});
}

}  // namespace
}  // namespace hedgerow
