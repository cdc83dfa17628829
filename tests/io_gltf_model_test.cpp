/// glTF with its looks: materials, textures and values at corners.
#include <cmath>

#include "chart.h"
#include "gltf_models.h"

namespace hedgerow {
namespace {

using namespace testing_chart;
using namespace testing_gltf;
using namespace testing_io;

class GltfModels : public GltfModelTest {};

TEST_F(GltfModels, DefaultsAreThoseOfTheSpecification) {
    for (const Material& m : {material(""), load(triangle()).materials[0]}) {
        EXPECT_EQ(m.base_colour, Vec3f::all(1));
        EXPECT_EQ(m.metallic, 1);
        EXPECT_EQ(m.roughness, 1);
        EXPECT_EQ(m.emission, Vec3f());
        EXPECT_EQ(m.alpha_mode, AlphaMode::opaque);
        EXPECT_EQ(m.alpha_cutoff, 0.5f);
        EXPECT_EQ(m.ior, 1.5f);
        EXPECT_EQ(m.specular, 1);
        EXPECT_FALSE(m.double_sided || m.unlit);
        EXPECT_TRUE(m.thin);
    }
}

TEST_F(GltfModels, MaterialsHaveTheirNumbers) {
    const Material m = material(
        R"("name":"one","pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,0.4],"metallicFactor":0.5,)"
        R"("roughnessFactor":0.25},"emissiveFactor":[1,0.5,0],"alphaMode":"MASK","alphaCutoff":0.75,)"
        R"("doubleSided":true,"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":20},)"
        R"("KHR_materials_ior":{"ior":1.25},"KHR_materials_transmission":{"transmissionFactor":0.9},)"
        R"("KHR_materials_volume":{"thicknessFactor":2,"attenuationColor":[0.5,0.25,1],"attenuationDistance":3},)"
        R"("KHR_materials_specular":{"specularFactor":0.125,"specularColorFactor":[2,1,0]},)"
        R"("KHR_materials_unlit":{}})");
    EXPECT_EQ(m.name, "one");
    EXPECT_EQ(m.base_colour, Vec3f(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.alpha, 0.4f);
    EXPECT_EQ(m.metallic, 0.5f);
    EXPECT_EQ(m.roughness, 0.25f);
    EXPECT_EQ(m.emission, Vec3f(1, 0.5f, 0));
    EXPECT_EQ(m.emission_strength, 20);
    EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(m.alpha_cutoff, 0.75f);
    EXPECT_TRUE(m.double_sided && m.unlit);
    EXPECT_EQ(m.ior, 1.25f);
    EXPECT_EQ(m.transmission, 0.9f);
    EXPECT_FALSE(m.thin);
    EXPECT_EQ(m.attenuation_colour, Vec3f(0.5f, 0.25f, 1));
    EXPECT_EQ(m.attenuation_distance, 3);
    EXPECT_EQ(m.specular, 0.125f);
    EXPECT_EQ(m.specular_colour, Vec3f(2, 1, 0));
    EXPECT_EQ(material(R"("alphaMode":"BLEND")").alpha_mode, AlphaMode::blend);
    EXPECT_TRUE(material(R"("extensions":{"KHR_materials_volume":{"thicknessFactor":0}})").thin);
    EXPECT_EQ(material(R"("extensions":{"KHR_materials_ior":{"ior":0}})").ior, 1e6f) << "0 reflects all";
}

TEST_F(GltfModels, SpecularAndGlossinessBecomeADielectric) {
    const Material m = material(
        R"("pbrMetallicRoughness":{"metallicFactor":1,"baseColorFactor":[1,0,0,1]},"extensions":{)"
        R"("KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[0.25,0.5,0.75,0.5],"specularFactor":[0.04,0.08,1],)"
        R"("glossinessFactor":0.75}})");
    EXPECT_EQ(m.base_colour, Vec3f(0.25f, 0.5f, 0.75f));
    EXPECT_EQ(m.alpha, 0.5f);
    EXPECT_EQ(m.metallic, 0);
    EXPECT_EQ(m.roughness, 0.25f);
    EXPECT_EQ(m.specular_colour, Vec3f(0.04f, 0.08f, 1) * 25.f);
}

TEST_F(GltfModels, BadMaterialsAreErrors) {
    refuse_material(R"("pbrMetallicRoughness":{"baseColorFactor":[1,1,1]})",
                    {"baseColorFactor", "4 numbers"});
    refuse_material(R"("pbrMetallicRoughness":{"baseColorFactor":[1,-1,1,1]})",
                    {"baseColorFactor", "negative"});
    refuse_material(R"("pbrMetallicRoughness":{"metallicFactor":1.5})", {"metallicFactor", "1.5", "0 to 1"});
    refuse_material(R"("pbrMetallicRoughness":{"roughnessFactor":"x"})", {"roughnessFactor", "no number"});
    refuse_material(R"("pbrMetallicRoughness":[])", {"pbrMetallicRoughness", "no object"});
    refuse_material(R"("emissiveFactor":[1e30,0,0])", {"emissiveFactor", "too large"});
    refuse_material(R"("alphaMode":"OTHER")", {"alphaMode", "MASK"});
    refuse_material(R"("doubleSided":1)", {"doubleSided", "neither true nor false"});
    refuse_material(R"("extensions":{"KHR_materials_ior":{"ior":0.5}})", {"'ior'"});
    refuse_material(R"("extensions":{"KHR_materials_volume":{"attenuationDistance":0}})",
                    {"attenuationDistance"});
    refuse_material(R"("normalTexture":{"index":3})", {"number 3 of its textures", "only 0"});
    refuse_material(R"("normalTexture":{})", {"'index' is missing"});
    Gltf file = triangle();
    file.primitive += R"(,"material":7)";
    refuse(file, {"number 7 of its materials"});
}

/// Members of the root: an image of the chart, and textures with samplers.
std::string chart_textures(const std::string& image) {
    return R"(,"images":[{"uri":")" + image +
           R"("}],"samplers":[{"wrapS":33071,"wrapT":33648,"magFilter":9728},{}],)"
           R"("textures":[{"source":0,"sampler":0},{"source":0,"sampler":1},{"source":0}])";
}

TEST_F(GltfModels, TexturesOfEveryProperty) {
    const std::string data = "data:image/png;base64," + base64(png_chart());
    const auto model = load(
        with_material(R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1},)"
                      R"("metallicRoughnessTexture":{"index":1}},"normalTexture":{"index":2,"scale":0.5},)"
                      R"("emissiveTexture":{"index":1},"occlusionTexture":{"index":1},"alphaMode":"BLEND",)"
                      R"("extensions":{"KHR_materials_transmission":{"transmissionTexture":{"index":1}},)"
                      R"("KHR_materials_clearcoat":{"clearcoatFactor":1}})",
                      chart_textures(data)));
    const Material& m = model.materials[0];
    const auto texture = [&](const TextureSlot& slot) -> const Texture& {
        return model.textures[slot.texture];
    };
    EXPECT_EQ(texture(m.base_colour_texture).space, ColourSpace::srgb);
    EXPECT_EQ(texture(m.base_colour_texture).wrap_s, Wrap::clamp);
    EXPECT_EQ(texture(m.base_colour_texture).wrap_t, Wrap::mirror);
    EXPECT_EQ(texture(m.base_colour_texture).filter, TextureFilter::nearest);
    EXPECT_EQ(m.base_colour_texture.set, 1u);
    EXPECT_EQ(m.alpha_texture.channel, 3);
    EXPECT_EQ(m.alpha_texture.texture, m.base_colour_texture.texture);
    EXPECT_EQ(m.roughness_texture.channel, 1) << "green";
    EXPECT_EQ(m.metallic_texture.channel, 2) << "blue";
    EXPECT_EQ(m.metallic_texture.texture, m.roughness_texture.texture);
    EXPECT_EQ(texture(m.metallic_texture).space, ColourSpace::linear);
    EXPECT_EQ(texture(m.metallic_texture).wrap_s, Wrap::repeat);
    EXPECT_EQ(texture(m.metallic_texture).filter, TextureFilter::bilinear);
    EXPECT_EQ(m.normal_scale, 0.5f);
    EXPECT_EQ(texture(m.emission_texture).space, ColourSpace::srgb);
    EXPECT_EQ(m.transmission_texture.channel, 0) << "red";
    for (const Texture& t : model.textures) EXPECT_EQ(t.pixels, model.textures[0].pixels) << "decoded once";
    EXPECT_EQ(model.not_shown,
              (std::vector<std::string>{"occlusionTexture (glTF)", "KHR_materials_clearcoat"}));
    EXPECT_TRUE(model.warnings.empty());
}

TEST_F(GltfModels, ChartsOfColoursComeOutExactly) {
    // As a texture in a data URI, in a file, and in a buffer view of a container; and as factors.
    const std::string chart = png_chart();
    folder.file("chart 1.png", chart);
    const std::string members = R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}})";
    Gltf in_container = with_material(
        members, R"(,"images":[{"bufferView":1,"mimeType":"image/png"}],"textures":[{"source":0}])");
    in_container.view(chart);
    for (const auto& path :
         {folder.file(
              "a.gltf",
              with_material(members, chart_textures("data:image/png;base64," + base64(chart))).text()),
          folder.file("b.gltf", with_material(members, chart_textures("chart%201.png")).text()),
          folder.file("c.glb", in_container.container())}) {
        const auto model = load_model(path);
        EXPECT_TRUE(model.warnings.empty());
        const Texture& texture = model.textures[model.materials[0].base_colour_texture.texture];
        for (int i = 0; i < columns * rows; ++i)
            for (int k = 0; k < 3; ++k)
                EXPECT_EQ(texture.texel(i % columns, i / columns).colour[k],
                          linear(patches[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)]));
    }
    for (const Colour& c : patches) {
        char factor[96];
        std::snprintf(factor, sizeof factor, "[%.9g,%.9g,%.9g,1]", static_cast<double>(linear(c[0])),
                      static_cast<double>(linear(c[1])), static_cast<double>(linear(c[2])));
        const Material m =
            material(R"("pbrMetallicRoughness":{"baseColorFactor":)" + std::string(factor) + "}");
        EXPECT_EQ(m.base_colour, Vec3f(linear(c[0]), linear(c[1]), linear(c[2])));
    }
}

TEST_F(GltfModels, TextureTransformsTurnAsProgramsTurnThem) {
    const auto transform = [&](const std::string& members) {
        return load(with_material(R"("normalTexture":{"index":0,"texCoord":2,"extensions":{)"
                                  R"("KHR_texture_transform":{)" +
                                      members + "}}}",
                                  chart_textures("data:image/png;base64," + base64(png_chart()))))
            .materials[0]
            .normal_texture;
    };
    EXPECT_EQ(transform("").transform, TextureTransform());
    EXPECT_EQ(transform("").set, 2u);
    EXPECT_EQ(transform(R"("texCoord":3)").set, 3u) << "the extension's counts";
    EXPECT_EQ(transform(R"("offset":[0.5,0.25],"scale":[2,3])").transform({1, 1}), Vec2f(2.5f, 3.25f));
    // A quarter turn counterclockwise where v points down: (1, 0), to the right, becomes (0, -1), upwards.
    const Vec2f up = transform(R"("rotation":1.5707963267948966)").transform({1, 0});
    EXPECT_NEAR(up[0], 0, 1e-6f);
    EXPECT_NEAR(up[1], -1, 1e-6f);
}

TEST_F(GltfModels, ImagesOfTheSameBytesAreDecodedOnce) {
    Gltf file = with_material(
        R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}},"emissiveTexture":{"index":1})",
        R"(,"images":[{"bufferView":1},{"bufferView":1}],"textures":[{"source":0},{"source":1}])");
    file.view(png_chart());
    const auto model = load(file);
    EXPECT_EQ(model.textures.size(), 1u);
    EXPECT_EQ(model.textures[0].name, "buffer view 1");
}

TEST_F(GltfModels, TexturesThatAreMissingOrBad) {
    folder.file("cut.png", png_chart().substr(0, 60));
    folder.file("text.png", "no image");
    for (const std::string uri :
         {"none.png", "cut.png", "text.png", "../a.png", "data:image/png;base64,####"}) {
        SCOPED_TRACE(uri);
        const auto model = load(with_material(
            R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}},"normalTexture":{"index":0})",
            chart_textures(uri)));
        const Material& m = model.materials[0];
        EXPECT_EQ(model.textures[m.base_colour_texture.texture].at({0.5f, 0.5f}), (Rgba{Vec3f(1, 0, 1), 1}));
        EXPECT_FALSE(m.normal_texture);
        ASSERT_EQ(model.warnings.size(), 1u);
        EXPECT_NE(model.warnings[0].find("magenta"), std::string::npos) << model.warnings[0];
    }
    // A texture of a format that is not read has no source.
    const auto model = load(with_material(
        R"("emissiveTexture":{"index":0})",
        R"(,"images":[{"uri":"a.webp"}],"textures":[{"extensions":{"EXT_texture_webp":{"source":0}}}])"));
    EXPECT_EQ(model.not_shown, (std::vector<std::string>{"EXT_texture_webp"}));
    EXPECT_EQ(model.warnings.size(), 1u);
}

TEST_F(GltfModels, ValuesAtCornersOfWeldedSurfaces) {
    // Two triangles of four corners that share an edge, each with its own normals: six vertices.
    const std::string places = packed<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1, 0, 1, 1, 1});
    const std::string normals = packed<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 1, 0, 0});
    const std::string uvs = packed<std::uint8_t>({0, 0, 255, 0, 0, 255, 51, 0, 0, 51, 255, 255});
    const std::string colours =
        packed<std::uint16_t>({0,     0,     0,     65535, 65535, 0, 0,     65535, 0,     65535, 0,     13107,
                               65535, 65535, 65535, 65535, 0,     0, 65535, 65535, 13107, 26214, 39321, 0});
    Gltf file = Gltf().array(places, "VEC3", f4, 6);
    file.primitive =
        R"("attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2,"COLOR_0":3,"TANGENT":0,"_ID":0})";
    file.array(normals, "VEC3", f4, 6)
        .array(uvs, "VEC2", u1, 6, R"(,"normalized":true)")
        .array(colours, "VEC4", u2, 6, R"(,"normalized":true)");
    const auto model = load(file);
    const Object<float>& object = model.objects[0];
    EXPECT_EQ(object.mesh.vertices.size(), 4u) << "a sheet, in spite of the crease";
    EXPECT_EQ(object.mesh.triangles, load_mesh(folder / "a.gltf").triangles);
    const Attributes& a = object.attributes;
    for (const float u : {0.f, 0.25f}) {
        EXPECT_EQ(a.normals.at(object.mesh, 0, u, 0.5f), Vec3f(0, 0, 1));
        EXPECT_EQ(a.normals.at(object.mesh, 1, u, 0.5f), Vec3f(1, 0, 0));
    }
    EXPECT_EQ(a.normals.values.size(), 2u) << "equal values are kept once";
    EXPECT_EQ(a.texture_coordinates[0].at(object.mesh, 0, 1, 0), Vec2f(1, 0)) << "v counts from the top";
    EXPECT_EQ(a.texture_coordinates[0].at(object.mesh, 1, 0, 0), Vec2f(0.2f, 0));
    EXPECT_EQ(a.colours.at(object.mesh, 0, 0, 1), (Rgba{Vec3f(0, 1, 0), 0.2f}));
    EXPECT_EQ(a.colours.at(object.mesh, 1, 0, 1), (Rgba{Vec3f(0.2f, 0.4f, 0.6f), 0}));
    EXPECT_EQ(model.not_shown,
              (std::vector<std::string>{"attribute 'TANGENT' (glTF)", "attribute '_ID' (glTF)"}));
}

TEST_F(GltfModels, PartsMayLackValuesAndHaveTheirMaterials) {
    Gltf file = triangle();
    file.array(packed<float>({0, 0, 1, 0, 0, 1, 0, std::nanf(""), 1}), "VEC3", f4, 3)
        .array(packed<float>({0, 0, 1, 0, 0, 1}), "VEC2", f4, 3);
    file.primitive += R"(},{"attributes":{"POSITION":0,"NORMAL":1},"material":1},)"
                      R"({"attributes":{"POSITION":0,"TEXCOORD_1":2},"material":0},)"
                      R"({"attributes":{"POSITION":0},"mode":1)";
    file.more = R"(,"materials":[{"name":"a"},{"name":"b"}],"skins":[{}],"animations":[{}])";
    const auto model = load(file);
    const Object<float>& object = model.objects[0];
    ASSERT_EQ(object.mesh.size(), 3u);
    const std::uint32_t no = no_value;
    EXPECT_EQ(object.attributes.normals.corners,
              (std::vector<TriangleIndices>{{no, no, no}, {0, 0, no}, {no, no, no}}));
    ASSERT_EQ(object.attributes.texture_coordinates.size(), 2u);
    EXPECT_TRUE(object.attributes.texture_coordinates[0].empty());
    EXPECT_EQ(object.attributes.texture_coordinates[1].corners[2], (TriangleIndices{0, 1, 2}));
    std::vector<std::string> names;
    for (std::size_t i = 0; i < 3; ++i) names.push_back(model.materials[object.material_of(i)].name);
    EXPECT_EQ(names, (std::vector<std::string>{"", "b", "a"}));
    EXPECT_EQ(model.not_shown, (std::vector<std::string>{"animations (glTF)", "skins (glTF)",
                                                         "primitives that are no triangles (glTF)"}));
    EXPECT_EQ(model.warnings.size(), 1u) << "of NaN";
}

TEST_F(GltfModels, BadValuesAreErrors) {
    Gltf few = triangle();
    few.primitive = R"("attributes":{"POSITION":0,"NORMAL":1})";
    few.array(packed<float>({0, 0, 1}), "VEC3", f4, 1);
    refuse(few, {"NORMAL has 1 values for 3 positions"});
    Gltf kind = triangle();
    kind.primitive = R"("attributes":{"POSITION":0,"TEXCOORD_0":0})";
    refuse(kind, {"accessor 0 is not of type VEC2"});
    Gltf outside = triangle();
    outside.indices(packed<std::uint8_t>({0, 1, 3}), u1, 3);
    refuse(outside, {"face 0 names vertex 3"});
    Gltf loop = triangle();
    loop.nodes = R"({"children":[1]},{"children":[0]})";
    refuse(loop, {"node 0 is reached twice"});
}

}  // namespace
}  // namespace hedgerow
