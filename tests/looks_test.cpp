/// Looks: lookups of textures, values at corners, and what the defaults are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include <hedgerow/looks/model.h>

namespace hedgerow {
namespace {

template <class U>
Texture texture_of(int width, int height, int channels, std::vector<U> samples,
                   ColourSpace space = ColourSpace::linear) {
    auto pixels = std::make_shared<Pixels>();
    *pixels = {width, height, channels, std::move(samples)};
    Texture texture;
    texture.pixels = std::move(pixels);
    texture.space = space;
    return texture;
}

TEST(Colours, SrgbIsWhatTheStandardSays) {
    EXPECT_EQ(linear_of_srgb8(0), 0.f);
    EXPECT_EQ(linear_of_srgb8(255), 1.f);
    EXPECT_NEAR(linear_of_srgb8(188), 0.5029f, 1e-4f) << "twice the light of 137 and a half";
    EXPECT_NEAR(linear_of_srgb8(10), 10 / 255.f / 12.92f, 1e-9f) << "the straight part";
    for (int i = 0; i < 256; ++i) {
        const double linear = linear_of_srgb8(static_cast<std::uint8_t>(i));
        EXPECT_NEAR(linear_to_srgb(linear) * 255, i, 1e-3);
        EXPECT_EQ(srgb8_of_linear(static_cast<float>(linear)), i);
    }
}

TEST(Colours, BytesAreTheNearestToTheEncodedValue) {
    for (int i = -50; i <= 4150; ++i) {
        const float linear = static_cast<float>(i) / 4096;
        const double encoded = linear_to_srgb(std::clamp(double(linear), 0.0, 1.0));
        EXPECT_EQ(srgb8_of_linear(linear), std::lround(encoded * 255)) << linear;
    }
    EXPECT_EQ(srgb8_of_linear(std::numeric_limits<float>::infinity()), 255);
    EXPECT_EQ(srgb8_of_linear(std::numeric_limits<float>::quiet_NaN()), 0);
}

TEST(Textures, TexelsOfEveryKind) {
    const auto grey = texture_of<std::uint8_t>(1, 1, 1, {51});
    EXPECT_EQ(grey.texel(0, 0), (Rgba{Vec3f::all(0.2f), 1}));
    const auto with_alpha = texture_of<std::uint8_t>(1, 1, 2, {188, 51}, ColourSpace::srgb);
    EXPECT_EQ(with_alpha.texel(0, 0), (Rgba{Vec3f::all(linear_of_srgb8(188)), 0.2f})) << "alpha is linear";
    const auto deep = texture_of<std::uint16_t>(1, 1, 3, {0, 13107, 65535});
    EXPECT_EQ(deep.texel(0, 0), (Rgba{Vec3f(0, 0.2f, 1), 1}));
    const auto deep_srgb =
        texture_of<std::uint16_t>(1, 1, 4, {0, 188 * 257, 65535, 13107}, ColourSpace::srgb);
    EXPECT_EQ(deep_srgb.texel(0, 0), (Rgba{Vec3f(0, linear_of_srgb8(188), 1), 0.2f}));
    const auto bright = texture_of<float>(1, 1, 3, {1000, 0.5f, -1}, ColourSpace::srgb);
    EXPECT_EQ(bright.texel(0, 0), (Rgba{Vec3f(1000, 0.5f, -1), 1})) << "floats are linear";
    const auto second = texture_of<std::uint8_t>(2, 2, 1, {0, 51, 102, 255});
    EXPECT_EQ(second.texel(1, 0).colour[0], 0.2f);
    EXPECT_EQ(second.texel(0, 1).colour[0], 0.4f) << "rows from the top";
}

TEST(Textures, WithoutPixelsIsWhite) {
    EXPECT_EQ(Texture().at({0.3f, 0.7f}), (Rgba{Vec3f::all(1), 1}));
}

TEST(Textures, NearestTakesTheTexelAtThePlace) {
    auto t = texture_of<float>(4, 2, 1, {0, 1, 2, 3, 4, 5, 6, 7});
    t.filter = TextureFilter::nearest;
    EXPECT_EQ(t.at({0, 0}).colour[0], 0);
    EXPECT_EQ(t.at({0.26f, 0.51f}).colour[0], 5);
    EXPECT_EQ(t.at({0.99f, 0.99f}).colour[0], 7);
    EXPECT_EQ(t.at({1.01f, 0.25f}).colour[0], 0) << "repeats";
    EXPECT_EQ(t.at({-0.01f, 0.25f}).colour[0], 3);
    t.wrap_s = Wrap::mirror;
    EXPECT_EQ(t.at({1.01f, 0.25f}).colour[0], 3);
    EXPECT_EQ(t.at({1.99f, 0.25f}).colour[0], 0);
    EXPECT_EQ(t.at({-0.3f, 0.25f}).colour[0], 1);
    t.wrap_s = Wrap::clamp, t.wrap_t = Wrap::clamp;
    EXPECT_EQ(t.at({17, 0.25f}).colour[0], 3);
    EXPECT_EQ(t.at({-17, 9}).colour[0], 4);
}

/// The texel of a coordinate in texels, by walking from tile to tile.
double texel_by_steps(const std::vector<float>& row, long i, Wrap wrap) {
    const long n = static_cast<long>(row.size());
    if (wrap == Wrap::clamp) return row[static_cast<std::size_t>(std::clamp(i, 0L, n - 1))];
    bool turned = false;
    while (i < 0) i += n, turned = !turned;
    while (i >= n) i -= n, turned = !turned;
    return row[static_cast<std::size_t>(wrap == Wrap::mirror && turned ? n - 1 - i : i)];
}

TEST(Textures, BilinearIsTheProductOfTwoHats) {
    std::mt19937_64 random(1);
    const std::vector<float> row{3, 1, 4, 1.5f, 9};
    for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp}) {
        auto across = texture_of<float>(5, 1, 1, row), down = texture_of<float>(1, 5, 1, row);
        across.wrap_s = down.wrap_t = wrap;
        for (int k = 0; k < 1000; ++k) {
            const float s = std::uniform_real_distribution<float>(-2.4f, 3.4f)(random);
            long double sum = 0;
            for (long i = -20; i < 25; ++i) {
                const long double hat = 1 - std::abs(static_cast<long double>(s) * 5 - (i + 0.5L));
                if (hat > 0) sum += hat * texel_by_steps(row, i, wrap);
            }
            EXPECT_NEAR(across.at({s, 0.5f}).colour[0], static_cast<double>(sum), 1e-5) << s;
            EXPECT_EQ(down.at({0.5f, s}), across.at({s, 0.5f})) << s;
        }
    }
    const auto both = texture_of<float>(2, 2, 1, {0, 1, 2, 5});
    EXPECT_EQ(both.at({0.5f, 0.5f}).colour[0], 2);
    EXPECT_EQ(both.at({0.25f, 0.75f}).colour[0], 2) << "a centre has its own value";
}

TEST(Textures, AnyCoordinateHasAValue) {
    const auto t = texture_of<float>(3, 3, 1, {1, 2, 3, 4, 5, 6, 7, 8, 9});
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const float x : {std::nanf(""), infinity, -infinity, 3e38f, -3e38f, 1e-45f})
        for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp})
            for (const TextureFilter filter : {TextureFilter::nearest, TextureFilter::bilinear}) {
                Texture any = t;
                any.wrap_s = any.wrap_t = wrap, any.filter = filter;
                const float value = any.at({x, -x}).colour[0];
                EXPECT_TRUE(value >= 1 && value <= 9) << x;
            }
}

TEST(Textures, TransformsAreAffine) {
    const TextureTransform t{{2, 0.5f, 1}, {-1, 3, 10}};
    EXPECT_EQ(t({1, 2}), Vec2f(4, 15));
    EXPECT_EQ(TextureTransform()({0.3f, 0.7f}), Vec2f(0.3f, 0.7f));
}

TEST(Attributes, CornersOfOneVertexMayDiffer) {
    // Two triangles that share an edge, as one closed sheet with a crease.
    TriangleMesh<float> mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 0, 3}}, {}};
    CornerValues<Vec3f> normals{{{0, 0, 1}, {0, -1, 0}}, {{0, 0, 0}, {1, 1, 1}}};
    EXPECT_EQ(normals.at(mesh, 0, 0.25f, 0.5f), Vec3f(0, 0, 1));
    EXPECT_EQ(normals.at(mesh, 1, 0.25f, 0.5f), Vec3f(0, -1, 0));
    normals.corners[1][2] = no_value;
    EXPECT_FALSE(normals.at(mesh, 1, 0, 0));

    CornerValues<Vec2f> by_vertex{{{0, 0}, {1, 0}, {0, 1}, {4, 8}}, {}};
    EXPECT_EQ(by_vertex.at(mesh, 0, 0.25f, 0.5f), Vec2f(0.25f, 0.5f));
    EXPECT_EQ(by_vertex.at(mesh, 1, 0.25f, 0.5f), Vec2f(2.25f, 4));
    EXPECT_FALSE(CornerValues<Rgba>().at(mesh, 0, 0, 0));
}

TEST(Attributes, NothingCostsNothing) {
    const Attributes none;
    EXPECT_EQ(none.normals.values.capacity() + none.normals.corners.capacity() +
                  none.texture_coordinates.capacity() + none.colours.values.capacity() +
                  none.colours.corners.capacity(),
              0u);
    EXPECT_EQ(sizeof(TriangleMesh<float>), 3 * sizeof(std::vector<int>)) << "the mesh has its arrays alone";
}

TEST(Models, CountTheTrianglesOfInstances) {
    Model<float> model;
    model.objects.resize(2);
    model.objects[0].mesh.triangles.resize(5);
    model.objects[1].mesh.triangles.resize(7);
    model.instances = {{"a", 0, {}}, {"b", 1, {}}, {"c", 1, Transform<3>::scaling(Vec3d(-1, 2, 3))}};
    EXPECT_EQ(model.triangles(), 19u);
    EXPECT_FALSE(model.instances[0].mirrors());
    EXPECT_TRUE(model.instances[2].mirrors());
    model.objects[0].material = 3;
    EXPECT_EQ(model.objects[0].material_of(4), 3u);
    model.objects[0].materials = {0, 1, 2, 1, 0};
    EXPECT_EQ(model.objects[0].material_of(3), 1u);
}

}  // namespace
}  // namespace hedgerow
