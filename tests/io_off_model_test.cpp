/// Normals, colours and texture coordinates of OFF files.
#include <bit>

#include "chart.h"
#include "model_support.h"

namespace hedgerow {
namespace {

using namespace testing_chart;
using namespace testing_io;

void expect_chart(const Model<float>& model, float alpha) {
    expect_sound(model);
    const Object<float>& object = model.objects[0];
    ASSERT_EQ(object.mesh.size(), patches.size());
    for (std::size_t i = 0; i < patches.size(); ++i)
        for (const std::uint32_t v : object.attributes.colours.at_corners(object.mesh, i)) {
            const Rgba seen = object.attributes.colours.values[v];
            EXPECT_EQ(seen.colour,
                      Vec3f(linear(patches[i][0]), linear(patches[i][1]), linear(patches[i][2])));
            EXPECT_EQ(seen.alpha, alpha);
        }
    EXPECT_EQ(model.materials[0].base_colour, Vec3f::all(1));
    EXPECT_TRUE(model.not_shown.empty() && model.warnings.empty());
}

TEST(OffModels, ChartsComeOutExactly) {
    TempFolder folder;
    std::string vertices, triangles, faces, floats;
    for (std::size_t i = 0; i < patches.size(); ++i) {
        std::string bytes;
        char numbers[96];
        for (const std::uint8_t x : patches[i]) bytes += " " + std::to_string(x);
        std::snprintf(numbers, sizeof numbers, " %.9f %.9f %.9f", static_cast<double>(linear(patches[i][0])),
                      static_cast<double>(linear(patches[i][1])), static_cast<double>(linear(patches[i][2])));
        for (int corner = 0; corner < 3; ++corner)
            vertices += std::to_string(corner) + " 0 0" + bytes + " 51\n";
        const std::string first = std::to_string(3 * i), second = std::to_string(3 * i + 1);
        triangles += "3 " + first + " " + second + " " + std::to_string(3 * i + 2) + "\n";
        faces += "3 0 1 2" + bytes + "\n";
        floats += std::string("3 0 1 2") + numbers + " 0.5\n";
    }
    expect_chart(load_model(folder.file("a.off", "COFF\n72 24 0\n" + vertices + triangles)), 0.2f);
    const std::string three = "OFF 3 24 0\n0 0 0\n1 0 0\n0 1 0\n";
    expect_chart(load_model(folder.file("b.off", three + faces)), 1);
    expect_chart(load_model(folder.file("c.off", three + floats)), 0.5f);
}

/// Floats of binary files are shares, also where they are whole numbers.
TEST(OffModels, ColoursOfBinaryFiles) {
    TempFolder folder;
    std::string bytes = "OFF BINARY\n";
    const auto add = [&](auto number) {
        auto word = std::bit_cast<std::uint32_t>(number);
        for (int k = 3; k >= 0; --k) bytes += static_cast<char>(word >> 8 * k & 255);
    };
    for (const std::uint32_t count : {3u, 1u, 3u}) add(count);
    for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) add(x);
    for (const std::uint32_t number : {3u, 0u, 1u, 2u, 4u}) add(number);
    for (const float x : {1.f, 0.f, 0.5f, 1.f}) add(x);
    const auto model = load_model(folder.file("a.off", bytes));
    ASSERT_EQ(model.objects[0].attributes.colours.values.size(), 1u);
    EXPECT_EQ(model.objects[0].attributes.colours.values[0], (Rgba{Vec3f(1, 0, 0.5f), 1}));
}

TEST(OffModels, ValuesOfVertices) {
    TempFolder folder;
    const std::string corners = "0 0 0 0 0 1 10 20 30 0.25 0.75\n1 0 0 0 0 1 0.5 0.25 0 1 0 1\n0 1 0 0 x 1\n";
    const auto model =
        load_model(folder.file("a.off", "STCNOFF\n3 2 0\n" + corners + "3 0 1 2\n3 0 1 2 7\n"));
    expect_sound(model);
    const Attributes& a = model.objects[0].attributes;
    EXPECT_EQ(a.normals.values[0], Vec3f(0, 0, 1));
    EXPECT_EQ(a.normals.corners[0], (TriangleIndices{0, 1, no_value})) << "a word that is no number";
    EXPECT_EQ(a.texture_coordinates[0].values, (std::vector<Vec2f>{{0.25f, 0.25f}, {0, 0}, {0, 1}}));
    EXPECT_EQ(a.colours.values[0], (Rgba{Vec3f(linear(10), linear(20), linear(30)), 1}));
    EXPECT_EQ(a.colours.values[1], (Rgba{Vec3f(0.5f, 0.25f, 0), 1}));
    EXPECT_EQ(a.colours.values[2], (Rgba{Vec3f::all(1), 1})) << "white where there is none";
    EXPECT_EQ(model.not_shown, (std::vector<std::string>{"colours by a number of a colour map (OFF)"}));
    EXPECT_EQ(model.warnings.size(), 1u);
    EXPECT_EQ(corners_of(model), corners_of(load_mesh(folder / "a.off")));
}

}  // namespace
}  // namespace hedgerow
