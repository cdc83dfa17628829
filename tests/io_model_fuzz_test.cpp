/// Thousands of damaged models: every outcome is a sound model with the triangles of load_mesh, or an
/// InputError that names the file.
#include "chart.h"
#include "damage.h"
#include "gltf_text.h"
#include "model_support.h"

namespace hedgerow {
namespace {

using namespace testing_chart;
using namespace testing_gltf;
using namespace testing_io;

constexpr int rounds = 2500;

void read(const std::filesystem::path& path) {
    const auto model = load_model<double>(path, {.limits = {.most_pixels = 1 << 16}});
    expect_sound(model);
    EXPECT_EQ(corners_of(model), corners_of(load_mesh<double>(path)));
}

/// Replaces every byte of a file by some others, one after the other.
void replace_every_byte(const TempFolder& folder, const std::string& name, const std::string& whole) {
    for (std::size_t at = 0; at < whole.size(); ++at)
        for (const char c : {'\0', '9', '-', '/', '\xFF', ' '}) {
            std::string changed = whole;
            changed[at] = c;
            try {
                read(folder.file(name, changed));
            } catch (const InputError& error) {
                EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
            }
        }
}

const char* const obj =
    "mtllib a.mtl\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0 0 0 1\nvt 0 0\nvt 1 1\nvn 0 0 1\nvn 1 0 0\n"
    "usemtl a\nf 1/1/1 2/2/2 3/1/1 4/2\nusemtl b\nf -4//1 -3//2 \\\n-2//1\n";
const char* const mtl =
    "newmtl a\nKd 1 0.5 0.25\nKs 0.5 0.5 0.5\nNs 10\nd 0.5\nillum 2\nmap_Kd -s 2 2 1 -o 0.5 0 chart.png\n"
    "newmtl b\nKe 1 1 1\nTf 1 1 1\nillum 7\nNi 1.5\nmap_d -imfchan r chart.png\nnorm -bm 2 chart.png\n";
const char* const ply =
    "ply\nformat ascii 1.0\ncomment TextureFile chart.png\nelement vertex 4\nproperty float x\nproperty "
    "float y\n"
    "property float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n"
    "property uchar green\nproperty uchar blue\nproperty float s\nproperty float t\nelement face 2\n"
    "property list uchar int vertex_indices\nproperty list uchar float texcoord\nproperty int texnumber\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
    "0 0 0 0 0 1 255 0 0 0 0\n1 0 0 0 0 1 0 255 0 1 0\n1 1 0 0 0 1 0 0 255 1 1\n0 1 0 0 0 1 9 9 9 0 1\n"
    "4 0 1 2 3 8 0 0 1 0 1 1 0 1 0 1 2 3\n3 0 1 2 0 0 4 5 6\n";

/// A scene with all that a model keeps.
Gltf scene() {
    Gltf file = triangle();
    file.primitive =
        R"("attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2,"COLOR_0":3},"indices":4,"material":0)";
    file.array(packed<float>({0, 0, 1, 0, 0, 1, 0, 1, 0}), "VEC3", f4, 3)
        .array(packed<float>({0, 0, 1, 0, 0, 1}), "VEC2", f4, 3)
        .array(packed<std::uint8_t>({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}), "VEC4", u1, 3,
               R"(,"normalized":true)")
        .array(packed<std::uint16_t>({0, 1, 2}), "SCALAR", u2, 3);
    file.view(png_chart());
    file.roots = "0,1,2";
    file.nodes =
        R"({"mesh":0,"name":"a"},{"mesh":0,"scale":[-1,2,3],"children":[3]},)"
        R"({"camera":0,"extensions":{"KHR_lights_punctual":{"light":0}}},{"mesh":0,"scale":[1,0,1]})";
    file.more =
        R"(,"materials":[{"name":"m","pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0.25,1],)"
        R"("baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":{"offset":[0,1],"scale":[2,2]}}},)"
        R"("metallicRoughnessTexture":{"index":0,"texCoord":0}},"alphaMode":"MASK","emissiveFactor":[1,1,1],)"
        R"("extensions":{"KHR_materials_ior":{"ior":1.4},"KHR_materials_volume":{"thicknessFactor":1}}}],)"
        R"("textures":[{"source":0,"sampler":0}],"samplers":[{"wrapS":33071}],"images":[{"bufferView":5}],)"
        R"("cameras":[{"type":"perspective","perspective":{"yfov":1}}],"extensions":{"KHR_lights_punctual":)"
        R"({"lights":[{"type":"spot","intensity":3,"spot":{"outerConeAngle":1}}]}})";
    return file;
}

TEST(ModelFuzz, Obj) {
    TempFolder folder;
    folder.file("chart.png", png_chart());
    folder.file("a.mtl", mtl);
    ASSERT_TRUE(load_model(folder.file("a.obj", obj)).warnings.empty());
    EXPECT_GT(survivors(folder, "a.obj", obj, rounds, read), 100);
    replace_every_byte(folder, "a.obj", obj);
    folder.file("a.obj", obj);
    EXPECT_GT(survivors(folder, "a.mtl", mtl, rounds, [&](const auto&) { read(folder / "a.obj"); }), 100);
}

TEST(ModelFuzz, Ply) {
    TempFolder folder;
    folder.file("chart.png", png_chart());
    ASSERT_TRUE(load_model(folder.file("a.ply", ply)).warnings.empty());
    EXPECT_GT(survivors(folder, "a.ply", ply, rounds, read), 100);
    replace_every_byte(folder, "a.ply", ply);
}

TEST(ModelFuzz, Off) {
    TempFolder folder;
    const std::string off =
        "STCNOFF\n4 3 0\n0 0 0 0 0 1 255 0 0 255 0 0\n1 0 0 0 0 1 0.5 0 0 1 0 1\n1 1 0 0 1 0 1 2 3 1 1\n"
        "0 1 0 1 0 0 9 9 9 0 1\n4 0 1 2 3 255 0 0\n3 0 1 2 0.5 0.5 0.5 1\n3 0 2 3 7\n";
    EXPECT_GT(survivors(folder, "a.off", off, rounds, read), 100);
    replace_every_byte(folder, "a.off", off);
}

TEST(ModelFuzz, Gltf) {
    TempFolder folder;
    const Gltf file = scene();
    const auto whole = load_model(folder.file("a.gltf", file.text()));
    ASSERT_TRUE(whole.warnings.empty() && whole.not_shown.empty());
    ASSERT_EQ(whole.instances.size(), 3u);
    // Damage the JSON more than the buffer, which is long.
    Gltf outside = file;
    outside.uri = "corners%20of.bin";
    write_buffer(folder, outside);
    EXPECT_GT(survivors(folder, "a.gltf", outside.text(), 2 * rounds, read), 100);
    replace_every_byte(folder, "a.gltf", outside.text());
    EXPECT_GT(survivors(folder, "a.glb", file.container(), rounds, read), 50);
}

}  // namespace
}  // namespace hedgerow
