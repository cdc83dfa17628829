/// Materials of OBJ files: what each word of MTL becomes, colours that come out exactly, and what is missing.
#include <cmath>

#include "chart.h"
#include "model_support.h"

namespace hedgerow {
namespace {

using namespace testing_chart;
using namespace testing_io;

/// Loads a triangle with a material of these lines.
Model<float> model_with(const TempFolder& folder, const std::string& lines) {
    folder.file("a.mtl", "# a comment\nnewmtl one\n" + lines + "\n");
    auto model =
        load_model(folder.file("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl one\nf 1 2 3\n"));
    expect_sound(model);
    return model;
}
Material material_with(const std::string& lines) {
    TempFolder folder;
    const auto model = model_with(folder, lines);
    EXPECT_EQ(model.materials.size(), 1u);
    EXPECT_EQ(model.materials[0].name, "one");
    return model.materials[0];
}

TEST(Mtl, MatteColours) {
    const Material m = material_with("Kd 0.1 0.2 0.3\nKe 1 2 3\nillum 1\nKs 0.5 0.5 0.5\nKa 1 1 1");
    EXPECT_EQ(m.base_colour, Vec3f(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.emission, Vec3f(1, 2, 3));
    EXPECT_EQ(m.specular, 0) << "illum 1 has no highlights";
    EXPECT_EQ(m.metallic, 0);
    EXPECT_EQ(m.alpha_mode, AlphaMode::opaque);
    EXPECT_TRUE(m.double_sided);
    EXPECT_EQ(material_with("Kd 0.25").base_colour, Vec3f::all(0.25f)) << "one number stands for all";
    EXPECT_EQ(material_with("").base_colour, Vec3f::all(0.8f));
    EXPECT_EQ(material_with("Kd 0.5 0.5 0.5\nKs 0 0 0\nillum 2").specular, 0);
}

TEST(Mtl, NegativeColoursCountAsBlackWithAWarning) {
    TempFolder folder;
    const auto model = model_with(folder, "Kd 0.5 -0.25 1\nKs 0 0 0\nKe -1\nTf 1 1 -1");
    const Material& m = model.materials[0];
    EXPECT_EQ(m.base_colour, Vec3f(0.5f, 0, 1));
    EXPECT_EQ(m.emission, Vec3f());
    ASSERT_EQ(model.warnings.size(), 3u);
    for (const auto& [i, told] :
         {std::pair(0, "line 3: Kd"), std::pair(1, "line 5: Ke"), std::pair(2, "line 6: Tf")})
        EXPECT_NE(
            model.warnings[std::size_t(i)].find(std::string("a.mtl: ") + told + " has a negative number"),
            std::string::npos)
            << model.warnings[std::size_t(i)];
}

TEST(Mtl, Highlights) {
    const Material m = material_with("Kd 0 0 0\nKs 0.5 0.25 1\nNs 198\nNi 1.25");
    EXPECT_EQ(m.specular, 1);
    EXPECT_EQ(m.specular_colour, Vec3f(1, 0.5f, 2)) << "1/2 is an ordinary dielectric";
    EXPECT_EQ(m.ior, 1.25f);
    EXPECT_NEAR(m.roughness * m.roughness, std::sqrt(2 / 200.f), 1e-6f);
    EXPECT_EQ(material_with("Ks 1 1 1").roughness, 1) << "without an exponent";
    EXPECT_EQ(material_with("Ks 1 1 1\nNi 1.0").ior, 1.5f) << "no index";
    // A mirror: f0 times the colour is Ks.
    const Material mirror = material_with("illum 3\nKs 0.9 0.8 0.7\nKd 0 0 0\nNi 2");
    EXPECT_NEAR(mirror.specular_colour[0] / 9, 0.9f, 1e-6f);
    EXPECT_NEAR(mirror.specular_colour[2] / 9, 0.7f, 1e-6f);
}

TEST(Mtl, OpacityAndGlass) {
    EXPECT_EQ(material_with("d 0.25").alpha, 0.25f);
    EXPECT_EQ(material_with("d 0.25").alpha_mode, AlphaMode::blend);
    EXPECT_EQ(material_with("Tr 0.25").alpha, 0.75f);
    EXPECT_EQ(material_with("Tr 1\nd 1").alpha, 1) << "d counts before Tr";
    EXPECT_EQ(material_with("Tr 1\nd 1").alpha_mode, AlphaMode::opaque);
    EXPECT_EQ(material_with("d 7").alpha, 1);
    for (const std::string illum : {"4", "6", "7", "9"}) {
        const Material glass = material_with("illum " + illum + "\nNi 1.0\nTf 1 0.5 0.25\nd 0.1\nKs 0 0 0");
        EXPECT_EQ(glass.transmission, 1);
        EXPECT_FALSE(glass.thin);
        EXPECT_EQ(glass.base_colour, Vec3f(1, 0.5f, 0.25f));
        EXPECT_EQ(glass.ior, 1);
        EXPECT_EQ(glass.alpha, 1);
        EXPECT_EQ(glass.specular, 1);
    }
}

TEST(Mtl, WordsOfPhysicallyBasedRendering) {
    const Material m = material_with("Kd 1 1 1\nPr 0.25\nPm 0.75\nNs 1000\nillum 2");
    EXPECT_EQ(m.roughness, 0.25f);
    EXPECT_EQ(m.metallic, 0.75f);
    EXPECT_EQ(m.specular, 1);
    EXPECT_EQ(m.specular_colour, Vec3f::all(1));
}

TEST(Mtl, Maps) {
    TempFolder folder;
    folder.file("a chart.png", png_chart());
    folder.file("rgba.png", png(1, 1, 8, 6, text_of({1, 2, 3, 102}), 4));
    const auto model = model_with(
        folder,
        "map_Kd -s 2 3 -o 0.5 0.25 0 -clamp on a chart.png\nmap_d rgba.png\nmap_Pr -imfchan g rgba.png\n"
        "norm -bm 0.5 rgba.png\nmap_Ke a chart.png\nmap_Bump rgba.png\nrefl -type sphere rgba.png");
    const Material& m = model.materials[0];
    ASSERT_TRUE(m.base_colour_texture);
    EXPECT_EQ(m.base_colour, Vec3f::all(1)) << "the map's colour alone";
    const Texture& chart = model.textures[m.base_colour_texture.texture];
    EXPECT_EQ(chart.space, ColourSpace::srgb);
    EXPECT_EQ(chart.wrap_s, Wrap::clamp);
    EXPECT_TRUE(chart.name.ends_with("a chart.png")) << chart.name;
    // (u, v) becomes (2u + 1/2, 3v + 1/4) with v from the bottom.
    const Vec2f from_top = m.base_colour_texture.transform({0.5f, 1 - 0.125f});
    EXPECT_EQ(from_top, Vec2f(1.5f, 1 - 0.625f));
    EXPECT_EQ(m.alpha_texture.channel, 3) << "the opacity of an image that has one";
    EXPECT_EQ(model.textures[m.alpha_texture.texture].at({0, 0}).alpha, 0.4f);
    EXPECT_EQ(m.alpha_mode, AlphaMode::blend);
    EXPECT_EQ(m.roughness_texture.channel, 1);
    EXPECT_EQ(m.normal_scale, 0.5f);
    EXPECT_EQ(m.emission, Vec3f::all(1)) << "a map without Ke";
    EXPECT_NE(m.emission_texture.texture, m.base_colour_texture.texture) << "another wrap mode";
    EXPECT_EQ(model.textures[m.emission_texture.texture].pixels, chart.pixels) << "decoded once";
    EXPECT_EQ(m.alpha_texture.texture, m.roughness_texture.texture) << "and one texture for one use";
    EXPECT_EQ(model.not_shown, (std::vector<std::string>{"map_Bump (MTL)", "refl (MTL)"}));
    EXPECT_TRUE(model.warnings.empty());
}

TEST(Mtl, ChartsOfColoursComeOutExactly) {
    // Kd has linear values, and a texture sRGB.
    TempFolder folder;
    std::string library, mesh = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n", text;
    for (std::size_t i = 0; i < patches.size(); ++i) {
        library += "newmtl p" + std::to_string(i) + "\nKd";
        for (const std::uint8_t x : patches[i]) {
            char number[32];
            std::snprintf(number, sizeof number, " %.9g", static_cast<double>(linear(x)));
            library += number;
        }
        library += "\n";
        mesh += "usemtl p" + std::to_string(i) + "\nf 1 2 3\n";
    }
    folder.file("a.mtl", library);
    const auto model = load_model(folder.file("a.obj", mesh));
    ASSERT_EQ(model.objects[0].mesh.size(), patches.size());
    for (std::size_t i = 0; i < patches.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_EQ(model.materials[model.objects[0].material_of(i)].base_colour[static_cast<int>(k)],
                      linear(patches[i][k]));
    // Through texture coordinates, whose v counts from the bottom.
    folder.file("chart.png", png_chart());
    folder.file("b.mtl", "newmtl chart\nmap_Kd chart.png\n");
    const auto mapped = load_model(
        folder.file("b.obj",
                    "mtllib b.mtl\nv 0 0 0\nv 6 0 0\nv 6 4 0\nv 0 4 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                    "usemtl chart\nf 1/1 2/2 3/3 4/4\n"));
    const Object<float>& object = mapped.objects[0];
    Texture texture = mapped.textures[mapped.materials[0].base_colour_texture.texture];
    texture.filter = TextureFilter::nearest;
    // Of the triangle (0 0), (6 0), (6 4), the place (5.5, 0.5) is in the last column and the lowest row.
    const auto place = object.attributes.texture_coordinates[0].at(object.mesh, 0, 5.5f / 6 - 0.125f, 0.125f);
    ASSERT_TRUE(place);
    const Rgba seen = texture.at(*place);
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(seen.colour[static_cast<int>(k)], linear(patches[23][k])) << "the last patch";
    // Colours of vertices are in sRGB.
    std::string coloured;
    for (const Colour& c : patches) {
        char line[96];
        std::snprintf(line, sizeof line, "v 0 0 0 %.9g %.9g %.9g\n", c[0] / 255.0, c[1] / 255.0,
                      c[2] / 255.0);
        coloured += line;
    }
    const auto vertices = load_model(folder.file("c.obj", "v 9 9 9\n" + coloured + "v 1 1 1\nf 1 2 3\n"));
    const auto& colours = vertices.objects[0].attributes.colours.values;
    ASSERT_EQ(colours.size(), 26u);
    EXPECT_EQ(colours[0], (Rgba{Vec3f::all(1), 1})) << "a vertex without a colour is white";
    EXPECT_EQ(colours[25], (Rgba{Vec3f::all(1), 1}));
    for (std::size_t i = 0; i < patches.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_NEAR(colours[i + 1].colour[static_cast<int>(k)], linear(patches[i][k]), 1e-7);
    EXPECT_EQ(vertices.materials[0].base_colour, Vec3f::all(1)) << "and the surface lets them be";
}

TEST(Mtl, MaterialsOfFaces) {
    TempFolder folder;
    folder.file("my lib.mtl", "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\nnewmtl a\nKd 0 0 1\n");
    const auto model = load_model(
        folder.file("a.obj",
                    "mtllib my lib.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nusemtl b\nusemtl a\n"
                    "f 1 2 3 4\nusemtl b\nf 1 2 3\nusemtl a\nf 1 2 4\nusemtl b\n"));
    const Object<float>& object = model.objects[0];
    std::vector<std::string> names;
    for (std::size_t i = 0; i < object.mesh.size(); ++i)
        names.push_back(model.materials[object.material_of(i)].name);
    EXPECT_EQ(names, (std::vector<std::string>{"", "a", "a", "b", "a"}));
    EXPECT_EQ(model.materials.size(), 3u);
    EXPECT_EQ(model.materials[object.material_of(1)].base_colour, Vec3f(1, 0, 0)) << "the first of a name";
    EXPECT_TRUE(model.warnings.empty());
    // One material alone needs no list.
    const auto one = load_model(folder.file(
        "b.obj", "mtllib none.mtl my.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl c\nf 1 2 3\nf 1 2 3\n"));
    EXPECT_TRUE(one.objects[0].materials.empty());
    EXPECT_EQ(one.materials[0].base_colour, Vec3f::all(0.8f));
    ASSERT_EQ(one.warnings.size(), 3u);
    EXPECT_NE(one.warnings[0].find("'none.mtl' is not in its folder"), std::string::npos);
    EXPECT_NE(one.warnings[2].find("material 'c' is in none"), std::string::npos);
}

TEST(Mtl, TexturesThatAreMissing) {
    TempFolder folder;
    folder.file("cut.png", png_chart().substr(0, 60));
    folder.file("huge.png", png(100000, 100000, 8, 2, text_of({1, 2, 3}), 3));
    for (const std::string name :
         {"none.png", "cut.png", "huge.png", "../a.png", "/etc/passwd", "C:\\a.png"}) {
        SCOPED_TRACE(name);
        const auto model = model_with(folder, "map_Kd " + name + "\nmap_Pr " + name + "\nmap_Kd " + name);
        const Material& m = model.materials[0];
        ASSERT_TRUE(m.base_colour_texture);
        EXPECT_EQ(model.textures[m.base_colour_texture.texture].at({0.3f, 0.3f}), (Rgba{Vec3f(1, 0, 1), 1}));
        EXPECT_FALSE(m.roughness_texture);
        ASSERT_EQ(model.warnings.size(), 1u) << "told once";
        EXPECT_NE(model.warnings[0].find("magenta"), std::string::npos) << model.warnings[0];
    }
    const auto skipped = [&] {
        model_with(folder, "map_Kd none.png");
        return load_model(folder / "a.obj", {.textures = false});
    }();
    EXPECT_TRUE(skipped.warnings.empty()) << "images are not read where they are not wanted";
    // Backslashes are slashes.
    std::filesystem::create_directory(folder / "maps");
    folder.file("maps/chart.png", png_chart());
    EXPECT_TRUE(model_with(folder, "map_Kd maps\\chart.png").warnings.empty());
}

TEST(Mtl, BadNumbersAreErrors) {
    TempFolder folder;
    const auto refuse = [&](const std::string& line, std::vector<std::string> parts) {
        parts.insert(parts.begin(), "a.mtl, ");
        parts[0] = "a.mtl: line 3";
        expect_input_error([&] { model_with(folder, line); }, parts);
    };
    refuse("Kd red", {"'red' where a number"});
    refuse("Kd", {"'' where a number"});
    refuse("Ns nan", {"'nan' where a number"});
    refuse("d inf", {"'inf' where a number"});
    refuse("map_Kd -s 1 1", {"a map without a file"});
    refuse("map_Kd -o x a.png", {"'x' where a number"});
    EXPECT_EQ(material_with("Kd -1 0.5 0").base_colour, Vec3f(0, 0.5f, 0)) << "nothing is darker than black";
    TempFolder other;
    const auto model =
        model_with(other, "Kd spectral a.rfl\nKs xyz 1 1 1\nTf xyz 1 1 1\nd -halo 0.5\nwhat 3");
    EXPECT_EQ(model.not_shown, (std::vector<std::string>{"Kd spectral (MTL)", "Ks xyz (MTL)", "Tf xyz (MTL)",
                                                         "d -halo (MTL)", "what (MTL)"}));
}

}  // namespace
}  // namespace hedgerow
