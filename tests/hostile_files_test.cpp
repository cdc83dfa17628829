/// Files made to do harm, which the tool reads under limits of time and memory. It refuses each with exit
/// code 3 and a sentence that names the file, and none ends it by a signal.
#include <cstdint>

#include <zlib.h>

#include "gltf_text.h"
#include "tool.h"

namespace {

using namespace hedgerow;

/// Limits the address space of a run, in KiB. Sanitizers map terabytes, so they run without a limit.
#ifdef HEDGEROW_SANITIZED
constexpr const char* limits = "";
#else
constexpr const char* limits = "ulimit -v 2000000; ";
#endif

class HostileFiles : public ToolTest {
protected:
    void expect_refused(const std::string& name, const std::string& said = "") const {
        const auto r = run_shell(limits + std::string("timeout 120 " HEDGEROW_TOOL_PATH " info '") +
                                 file(name) + "' 2>&1");
        EXPECT_EQ(r.code, 3) << name << "\n" << r.output;
        EXPECT_NE(r.output.find(name), std::string::npos) << r.output;
        EXPECT_NE(r.output.find(said), std::string::npos) << name << "\n" << r.output;
        EXPECT_LT(r.output.size(), 1000u);
    }
    void write(const std::string& name, const std::string& bytes) const {
        std::ofstream(file(name), std::ios::binary) << bytes;
    }
    void refuse(const std::string& name, const std::string& bytes, const std::string& said) const {
        write(name, bytes);
        expect_refused(name, said);
    }
    /// Writes a compressed file of `start` and then `part`, `times` times.
    void gzip(const std::string& name, const std::string& start, const std::string& part, int times) const {
        gzFile out = gzopen(file(name).c_str(), "wb6");
        gzwrite(out, start.data(), static_cast<unsigned>(start.size()));
        for (int i = 0; i < times; ++i) gzwrite(out, part.data(), static_cast<unsigned>(part.size()));
        gzclose(out);
    }
};

std::string repeated(const std::string& part, int times) {
    std::string all;
    for (int i = 0; i < times; ++i) all += part;
    return all;
}

std::string little(std::uint32_t value) {
    return testing_gltf::packed<std::uint32_t>({value});
}

/// A triangle on `nodes`, with further members `more` of the root, and `count` corners in its accessor.
testing_gltf::Gltf gltf(const std::string& nodes = R"({"mesh":0})", const std::string& more = "",
                        const std::string& count = "3") {
    auto file = testing_gltf::triangle(count);
    file.nodes = nodes, file.more = more;
    return file;
}
/// A triangle whose buffer is at a URI.
std::string gltf_at(const std::string& uri) {
    auto file = gltf();
    file.uri = uri;
    return file.text();
}

const char* const extensions[] = {"ply", "stl", "obj", "off", "gltf", "glb", "npy", "csv", "xyz", "hedgerow"};

TEST_F(HostileFiles, JunkUnderEveryExtension) {
    std::string noise;
    std::uint32_t state = 1;
    for (int i = 0; i < 4096; ++i)
        noise.push_back(static_cast<char>((state = state * 1664525 + 1013904223) >> 24));
    const std::string junk[] = {noise,   std::string(4096, '\0'), repeated("[", 100000), "glTF",
                                "solid", "\x1F\x8B\x08junk"};
    for (const std::string extension : extensions)
        for (const std::string& bytes : junk) {
            write("junk." + extension, bytes);
            expect_refused("junk." + extension);
        }
}

TEST_F(HostileFiles, FormatsThatAreNotRead) {
    for (const char* extension : {"3mf", "dae", "x3d", "ac", "x", "lws", "mot", "fbx", "3ds", "blend", "bin"})
        refuse(std::string("a.") + extension, "junk", ".ply .stl .obj .off .gltf .glb");
}

TEST_F(HostileFiles, CutShort) {
    write("whole.gltf", gltf().text());
    write("whole.glb", gltf().container());
    for (const char* name : {"whole.gltf", "whole.glb"})
        ASSERT_EQ(run("info " + file(name)).code, 0) << "the corpus is made of what can be read";
    for (const std::string name : {"whole.gltf", "whole.glb"}) {
        const std::string whole = bytes_of(file(name));
        for (std::size_t n = 1; n < whole.size(); n += 1 + whole.size() / 12) {
            write("cut-" + name, whole.substr(0, n));
            expect_refused("cut-" + name);
        }
    }
}

TEST_F(HostileFiles, NestedDeeply) {
    refuse("arrays.gltf", repeated("[", 1000000), "nested more than 64 deep");
    refuse("objects.gltf", repeated("{\"a\":", 200000), "nested more than 64 deep");
    refuse("closed.gltf", repeated("[", 500000) + repeated("]", 500000), "nested more than 64 deep");
    std::string chain;  // each node is a child of the one before
    for (int i = 1; i < 100000; ++i) chain += "{\"children\":[" + std::to_string(i) + "]},";
    refuse("chain.gltf", gltf(chain + R"({"children":[0],"mesh":0})").text(), "reached twice");
    write("long.gltf", gltf(chain + R"({"mesh":0})").text());
    EXPECT_EQ(run("info " + file("long.gltf")).code, 0) << "a chain of nodes is no crime";
}

TEST_F(HostileFiles, PathsThatLeaveTheFolder) {
    // Refuse URIs that leave the folder, also by a symbolic link.
    write("secret.bin", std::string(36, '\1'));
    std::filesystem::create_directory(folder / "scene");
    for (const std::string uri :
         {"../secret.bin", "%2e%2e/secret.bin", "x/../../secret.bin", "/etc/passwd", "file:///etc/passwd",
          "http://127.0.0.1/a", "C:/a.bin", "..\\\\secret.bin", "%00", "a%", "", "\\u0000"}) {
        write("scene/a.gltf", gltf_at(uri));
        expect_refused("scene/a.gltf", "folder");
    }
    std::filesystem::create_symlink(folder / "secret.bin", folder / "scene" / "link.bin");
    write("scene/a.gltf", gltf_at("link.bin"));
    expect_refused("scene/a.gltf", "leaves the folder");
    const auto here = run_shell("cd '" + file("scene") + "' && " HEDGEROW_TOOL_PATH " info a.gltf 2>&1");
    EXPECT_EQ(here.code, 3) << here.output;
    EXPECT_NE(here.output.find("leaves the folder"), std::string::npos) << here.output;
    // Read URIs inside the folder.
    write("scene/here it is.bin", std::string(36, '\1'));
    write("scene/a.gltf", gltf_at("./here%20it%20is.bin"));
    EXPECT_EQ(run("info " + file("scene/a.gltf")).code, 0);
    EXPECT_EQ(run_shell("cd '" + file("scene") + "' && " HEDGEROW_TOOL_PATH " info a.gltf 2>&1").code, 0);
    write("scene/a.gltf", gltf_at("missing.bin"));
    expect_refused("scene/a.gltf", "missing.bin");
}

TEST_F(HostileFiles, GltfThatLies) {
    const std::string node = R"({"mesh":0})";
    refuse("count.gltf", gltf(node, "", "4").text(), "needs 48 bytes");
    refuse("huge.gltf", gltf(node, "", "3000000000").text(), "needs 36000000000 bytes");
    refuse("minus.gltf", gltf(node, "", "-1").text(), "no whole number");
    refuse("mesh.gltf", gltf(R"({"mesh":7})").text(), "number 7 of its meshes");
    refuse("meshopt.gltf", gltf(node, R"(,"extensionsRequired":["EXT_meshopt_compression"])").text(),
           "EXT_meshopt_compression");
    refuse("old.gltf", R"({"asset":{"version":"1.0"}})", "only 2.0");
    refuse("self.gltf", gltf(R"({"mesh":0,"children":[0]})").text(), "reached twice");
    refuse("many.gltf", gltf(R"({"children":[0)" + repeated(",0", 9) + "]}").text(), "more nodes");
    refuse("nan.gltf", gltf(R"({"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1e999,0,0,0,0,1]})").text(), "JSON");
}

/// The file with `count` copies of its node, which all have the same mesh.
testing_gltf::Gltf with_instances(testing_gltf::Gltf file, int count) {
    file.nodes += repeated("," + file.nodes, count - 1);
    for (int i = 1; i < count; ++i) file.roots += "," + std::to_string(i);
    return file;
}

TEST_F(HostileFiles, BombsOfInstances) {
    if (*limits == '\0') GTEST_SKIP() << "without a limit of memory the triangles may fit";
    // Some 50 KB of JSON use a mesh of 10^6 triangles three thousand times.
    std::string zeros;
    zeros.resize(12'000'000);
    auto mesh = testing_gltf::Gltf().array(zeros, "VEC3", testing_gltf::f4, 1000000);
    mesh.primitive += R"(,"mode":5)";
    mesh.uri = "zeros.bin";
    write("zeros.bin", mesh.buffer);
    refuse("bomb.gltf", with_instances(mesh, 3000).text(), "triangles, all instances written out");
}

/// 30,000 nodes of 30,000 empty primitives: 9 · 10^8 pairs, but no triangle.
TEST_F(HostileFiles, BombsOfPrimitives) {
    auto empty = testing_gltf::triangle("0");
    empty.primitive += repeated("},{" + empty.primitive, 29999);
    refuse("bomb.gltf", with_instances(empty, 30000).text(), "neither faces nor points");
}

TEST_F(HostileFiles, FacesOfMillions) {
    if (*limits == '\0') GTEST_SKIP() << "without a limit of memory the face may fit";
    const std::string square = "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    refuse("face.off", square + "12000000" + repeated(" 0 1 2 3", 3000000) + "\n",
           "the 12000000 corners of one of its faces");
}

TEST_F(HostileFiles, ArraysOfManyAxes) {
    std::string header =
        "{'descr': '|u1', 'fortran_order': True, 'shape': (1000000" + repeated(",1", 500000) + "), }";
    refuse("axes.npy",
           std::string("\x93NUMPY\x02\0", 8) + little(static_cast<std::uint32_t>(header.size())) + header +
               std::string(1000000, '\0'),
           "more than 64 axes");
}

TEST_F(HostileFiles, AbsurdCounts) {
    const std::string vertex = "\nproperty float x\nproperty float y\nproperty float z\n";
    for (const std::string format : {"ascii", "binary_little_endian"})
        for (const std::string count : {"4000000000", "4294967296", "99999999999999999999"})
            refuse("a.ply",
                   "ply\nformat " + format + " 1.0\nelement vertex " + count + vertex + "end_header\n0 0 0",
                   count.size() == 10 && count[2] == '0' ? "at most" : "");
    refuse("a.off", "OFF\n4000000000 4000000000 0\n0 0 0\n", "at most 6 bytes follow");
    refuse("a.stl", std::string(80, 'x') + little(4000000000u) + std::string(50, 'x'),
           "at most 50 bytes follow");
    std::string array = "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999, 3)}";
    array.resize(118, ' ');
    refuse("a.npy", std::string("\x93NUMPY\x01\0\x76\0", 10) + array, "cut off");
    refuse("a.obj", "v 0 0 0\nf " + repeated("1 ", 300000) + "2\n", "names vertex");
}

TEST_F(HostileFiles, Bombs) {
    const std::string zeros(1 << 20, '\0');
    const std::string lines(1 << 20, '\n');
    gzip("zeros.stl.gz", std::string(80, 'x') + little(1000000), zeros, 64);
    expect_refused("zeros.stl.gz", "all zeros");
    gzip("zeros.ply.gz",
         "ply\nformat binary_little_endian 1.0\nelement vertex 26000000\nproperty float x\nproperty float "
         "y\nproperty float z\nend_header\n",
         zeros, 300);
    expect_refused("zeros.ply.gz", "unpacks to more than 500 times its size");
    gzip("lines.off.gz", "OFF\n", lines, 300);
    expect_refused("lines.off.gz", "unpacks to more than 500 times its size");
    gzip("json.gltf.gz", "[", std::string(1 << 20, ' '), 64);
    expect_refused("json.gltf.gz", "JSON");
    std::string values = "[";
    for (int i = 0; i < 16000000; ++i) values += "1,";
    refuse("values.gltf", values + "1]", *limits == '\0' ? "" : "JSON values");
}

/// A file of 3 GB that takes no room on the disk: its triangles are a hole.
TEST_F(HostileFiles, HolesOfZeros) {
    write("hole.stl", std::string(80, 'x') + little(64000000));
    std::filesystem::resize_file(file("hole.stl"), 84 + 50ull * 64000000);
    expect_refused("hole.stl", "");
    for (const std::string extension : extensions) {
        write("empty." + extension, "");
        std::filesystem::resize_file(file("empty." + extension), 1ull << 30);
        expect_refused("empty." + extension);
    }
}

}  // namespace
