/// Colours and textures of PLY files, of vertices, faces and corners.
#include "chart.h"
#include "model_support.h"

namespace hedgerow {
namespace {

using namespace testing_chart;
using namespace testing_io;

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";

/// A binary file of three vertices for each patch of the chart, whose colours are of a type.
template <class U>
std::string chart_of_vertices(const std::string& type, U (*encode)(std::uint8_t), bool has_alpha,
                              std::endian order) {
    std::string header =
        std::string("ply\nformat binary_") + (order == std::endian::little ? "little" : "big") +
        "_endian 1.0\nelement vertex 72\n" + xyz + "property " + type + " red\nproperty " + type +
        " green\nproperty " + type + " blue\n" + (has_alpha ? "property " + type + " alpha\n" : "") +
        "element face 24\nproperty list uchar int vertex_indices\nend_header\n";
    std::string body;
    for (const Colour& c : patches)
        for (int corner = 0; corner < 3; ++corner) {
            for (int k = 0; k < 3; ++k) append(body, static_cast<float>(corner * k), order);
            for (const std::uint8_t x : c) append(body, encode(x), order);
            if (has_alpha) append(body, encode(51), order);
        }
    for (int i = 0; i < 24; ++i) {
        body += '\3';
        for (int k = 0; k < 3; ++k) append(body, std::int32_t(3 * i + k), order);
    }
    return header + body;
}

void expect_chart(const Model<float>& model, float alpha, float error = 0) {
    expect_sound(model);
    const Object<float>& object = model.objects[0];
    ASSERT_EQ(object.mesh.size(), patches.size());
    for (std::size_t i = 0; i < patches.size(); ++i) {
        const TriangleIndices corners = object.attributes.colours.at_corners(object.mesh, i);
        for (const std::uint32_t v : corners) {
            const Rgba seen = object.attributes.colours.values[v];
            for (std::size_t k = 0; k < 3; ++k)
                EXPECT_NEAR(seen.colour[static_cast<int>(k)], linear(patches[i][k]), error);
            EXPECT_EQ(seen.alpha, alpha);
        }
    }
    EXPECT_EQ(model.materials[0].base_colour, Vec3f::all(1)) << "the surface lets the colours be";
    EXPECT_TRUE(model.not_shown.empty());
}

TEST(PlyModels, ChartsOfVerticesComeOutExactly) {
    TempFolder folder;
    for (const auto order : {std::endian::little, std::endian::big}) {
        expect_chart(
            load_model(folder.file("a.ply", chart_of_vertices<std::uint8_t>(
                                                "uchar", [](std::uint8_t x) { return x; }, true, order))),
            0.2f);
        expect_chart(
            load_model(folder.file(
                "b.ply", chart_of_vertices<std::uint16_t>(
                             "ushort", [](std::uint8_t x) { return static_cast<std::uint16_t>(x * 257); },
                             false, order))),
            1);
        expect_chart(
            load_model(folder.file("c.ply", chart_of_vertices<float>("float", linear, false, order))), 1);
    }
}

TEST(PlyModels, ChartsOfFacesComeOutExactly) {
    TempFolder folder;
    std::string faces;
    for (const Colour& c : patches)
        faces += "3 0 1 2 " + std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(c[2]) +
                 "\n";
    const std::string file = "ply\nformat ascii 1.0\nelement vertex 3\n" + xyz +
                             "element face 24\nproperty list uchar int vertex_indices\nproperty uchar red\n"
                             "property uchar green\nproperty uchar blue\nend_header\n0 0 0\n1 0 0\n0 1 0\n" +
                             faces;
    const auto model = load_model(folder.file("a.ply", file));
    expect_chart(model, 1);
    EXPECT_EQ(model.objects[0].mesh.vertices.size(), 3u) << "the vertices are those of the file";
}

TEST(PlyModels, TexturesOfFaces) {
    TempFolder folder;
    folder.file("chart.png", png_chart());
    folder.file("grey.png", png(1, 1, 8, 0, text_of({51}), 1));
    const std::string file =
        "ply\nformat ascii 1.0\ncomment TextureFile chart.png\ncomment TextureFile grey.png\n"
        "comment TextureFile none.png\nelement vertex 4\n" +
        xyz +
        "element face 4\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
        "property int texnumber\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
        "3 0 1 2 6 0 0 1 0 1 1 1\n4 0 1 2 3 8 0 0 1 0 1 1 0 1 0\n3 0 1 2 0 7\n3 0 2 3 4 0 0 1 1 2\n";
    const auto model = load_model(folder.file("a.ply", file));
    expect_sound(model);
    const Object<float>& object = model.objects[0];
    ASSERT_EQ(model.materials.size(), 3u);
    EXPECT_EQ(object.materials, (std::vector<std::uint32_t>{1, 0, 0, 0, 2}))
        << "a face that names no texture has the first";
    const std::uint32_t no = no_value;
    EXPECT_EQ(object.attributes.texture_coordinates[0].corners,
              (std::vector<TriangleIndices>{{0, 1, 2}, {3, 4, 5}, {3, 5, 6}, {no, no, no}, {no, no, no}}));
    const auto colour = [&](std::size_t material) {
        return model.textures[model.materials[material].base_colour_texture.texture].texel(0, 0);
    };
    EXPECT_EQ(colour(0), (Rgba{Vec3f(linear(115), linear(82), linear(68)), 1}));
    EXPECT_EQ(colour(1), (Rgba{Vec3f::all(linear(51)), 1}));
    EXPECT_EQ(colour(2), (Rgba{Vec3f(1, 0, 1), 1})) << "missing";
    EXPECT_EQ(model.warnings.size(), 1u);
}

}  // namespace
}  // namespace hedgerow
