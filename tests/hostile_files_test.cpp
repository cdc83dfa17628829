/// Files that were made to hurt, read by the tool under limits of time and memory: each is refused with exit
/// code 3 and a sentence that names the file, and none ends the tool by a signal.
#include <cstdint>

#include <zlib.h>

#include "tool.h"

namespace {

using namespace hedgerow;

/// Address space of a run, in KiB. Sanitizers map terabytes, so they go without.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
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
    /// `start`, then `part` so many times, compressed.
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
    std::string bytes;
    for (int k = 0; k < 4; ++k) bytes.push_back(static_cast<char>(value >> (8 * k)));
    return bytes;
}

/// A triangle with a buffer at `uri`; `nodes` and `more` are put into the JSON as they are.
std::string gltf(const std::string& uri, const std::string& nodes = R"({"mesh":0})",
                 const std::string& more = "", const std::string& count = "3") {
    return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[)" + nodes +
           R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"buffers":[{"byteLength":36,"uri":")" +
           uri + R"("}],"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,)" +
           R"("componentType":5126,"type":"VEC3","count":)" + count + "}]" + more + "}";
}
const std::string data_uri =
    "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";

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
    write("whole.gltf", gltf(data_uri));
    ASSERT_EQ(run("info " + file("whole.gltf")).code, 0) << "the corpus is made of what can be read";
    const std::string json = gltf(data_uri);
    std::string glb = "glTF" + little(2) + little(static_cast<std::uint32_t>(20 + json.size()));
    glb += little(static_cast<std::uint32_t>(json.size())) + "JSON" + json;
    write("whole.glb", glb);
    ASSERT_EQ(run("info " + file("whole.glb")).code, 0);
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
    std::string chain;  // of nodes, each in the one before
    for (int i = 1; i < 100000; ++i) chain += "{\"children\":[" + std::to_string(i) + "]},";
    refuse("chain.gltf", gltf(data_uri, chain + R"({"children":[0],"mesh":0})"), "reached twice");
    write("long.gltf", gltf(data_uri, chain + R"({"mesh":0})"));
    EXPECT_EQ(run("info " + file("long.gltf")).code, 0) << "a chain of nodes is no crime";
}

TEST_F(HostileFiles, PathsThatLeaveTheFolder) {
    write("secret.bin", std::string(36, '\1'));
    std::filesystem::create_directory(folder / "scene");
    for (const std::string uri :
         {"../secret.bin", "%2e%2e/secret.bin", "x/../../secret.bin", "/etc/passwd", "file:///etc/passwd",
          "http://127.0.0.1/a", "C:/a.bin", "..\\\\secret.bin", "%00", "a%", "", "\\u0000"}) {
        write("scene/a.gltf", gltf(uri));
        expect_refused("scene/a.gltf", "folder");
    }
    std::filesystem::create_symlink(folder / "secret.bin", folder / "scene" / "link.bin");
    write("scene/a.gltf", gltf("link.bin"));
    expect_refused("scene/a.gltf", "leaves the folder");
    write("scene/here it is.bin", std::string(36, '\1'));
    write("scene/a.gltf", gltf("./here%20it%20is.bin"));
    EXPECT_EQ(run("info " + file("scene/a.gltf")).code, 0);
    write("scene/a.gltf", gltf("missing.bin"));
    expect_refused("scene/a.gltf", "missing.bin");
}

TEST_F(HostileFiles, GltfThatLies) {
    refuse("count.gltf", gltf(data_uri, R"({"mesh":0})", "", "4"), "needs 48 bytes");
    refuse("huge.gltf", gltf(data_uri, R"({"mesh":0})", "", "3000000000"), "");
    refuse("minus.gltf", gltf(data_uri, R"({"mesh":0})", "", "-1"), "no whole number");
    refuse("mesh.gltf", gltf(data_uri, R"({"mesh":7})"), "number 7 of its meshes");
    refuse("draco.gltf",
           gltf(data_uri, R"({"mesh":0})", R"(,"extensionsRequired":["KHR_draco_mesh_compression"])"),
           "KHR_draco_mesh_compression");
    refuse("old.gltf", R"({"asset":{"version":"1.0"}})", "only 2.0");
    refuse("self.gltf", gltf(data_uri, R"({"mesh":0,"children":[0]})"), "reached twice");
    std::string children = "0";
    for (int i = 0; i < 9; ++i) children += ",0";
    refuse("many.gltf", gltf(data_uri, R"({"children":[)" + children + "]}"), "more nodes");
    refuse("nan.gltf", gltf(data_uri, R"({"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1e999,0,0,0,0,1]})"),
           "JSON");
}

TEST_F(HostileFiles, BombsOfInstances) {
    // 100 KB name a mesh of 10^6 triangles three thousand times.
    std::string nodes, roots;
    for (int i = 0; i < 3000; ++i) {
        nodes += std::string(i == 0 ? "" : ",") + R"({"mesh":0})";
        roots += (i == 0 ? "" : ",") + std::to_string(i);
    }
    write("zeros.bin", std::string(12000000, '\0'));
    const std::string bomb =
        R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" + nodes +
        R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":5}]}],"buffers":[{"byteLength":)" +
        R"(12000000,"uri":"zeros.bin"}],"bufferViews":[{"buffer":0,"byteLength":12000000}],"accessors":)" +
        R"([{"bufferView":0,"componentType":5126,"type":"VEC3","count":1000000}]})";
    refuse("bomb.gltf", bomb, *limits == '\0' ? "" : "triangles, all instances written out");
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
    const std::string vertices = repeated("v 0 0 0\n", 1 << 17), lines(1 << 20, '\n');
    gzip("zeros.stl.gz", std::string(80, 'x') + little(1000000), zeros, 64);
    expect_refused("zeros.stl.gz", "all zeros");
    gzip("zeros.ply.gz",
         "ply\nformat binary_little_endian 1.0\nelement vertex 26000000\nproperty float x\nproperty float "
         "y\nproperty float z\nend_header\n",
         zeros, 300);
    expect_refused("zeros.ply.gz", "unpacks to more than 500 times its size");
    gzip("lines.off.gz", "OFF\n", lines, 300);
    expect_refused("lines.off.gz", "unpacks to more than 500 times its size");
    gzip("vertices.obj.gz", "", vertices, 64);
    expect_refused("vertices.obj.gz", "only points");
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
