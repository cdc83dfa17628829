/// Textures averaged over areas: against means of many lookups, and where an area is a point.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include <hedgerow/looks/texture_levels.h>
#include <hedgerow/scenes/random.h>

namespace hedgerow {
namespace {

template <class F>
Texture grey_texture(int width, int height, const F& value) {
    std::vector<float> samples;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) samples.push_back(value(x, y));
    auto pixels = std::make_shared<Pixels>();
    *pixels = {width, height, 1, std::move(samples)};
    Texture texture;
    texture.pixels = std::move(pixels);
    return texture;
}
Texture noise(int width, int height, std::uint64_t seed) {
    return grey_texture(width, height, [&](int x, int y) {
        Random random(seed, static_cast<std::uint64_t>(y * width + x));
        return static_cast<float>(random.uniform());
    });
}
/// The mean of a texture over an ellipse, by many lookups.
double mean_over(const Texture& texture, const Vec2f& at, const TextureFootprint& area) {
    double sum = 0;
    int count = 0;
    for (float s = -0.99f; s < 1; s += 0.02f)
        for (float t = -0.99f; t < 1; t += 0.02f)
            if (s * s + t * t <= 1)
                sum += double(texture.at(at + area.a * s + area.b * t).colour[0]), ++count;
    return sum / count;
}

TEST(TextureLevels, LargeAreasShowTheMeanOfTheImage) {
    for (const auto& [width, height] : {std::pair(64, 64), {5, 7}, {1, 9}, {13, 2}, {100, 3}}) {
        const Texture texture = noise(width, height, 1);
        double mean = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) mean += double(texture.texel(x, y).colour[0]);
        mean /= width * height;
        const TextureLevels levels(texture);
        const Rgba got = levels.at(texture, {0.3f, 0.9f}, {{1000, 0}, {0, 1000}});
        EXPECT_NEAR(got.colour[0], mean, 1e-5) << width << " x " << height;
        EXPECT_NEAR(got.alpha, 1, 1e-5);
    }
}

TEST(TextureLevels, AreTheMeansOfAreas) {
    for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp}) {
        Texture texture = noise(64, 48, 2);
        texture.wrap_s = texture.wrap_t = wrap;
        const TextureLevels levels(texture);
        double error = 0, of_points = 0;
        for (std::uint64_t i = 0; i < 300; ++i) {
            Random random(3, i);
            const auto next = [&] { return static_cast<float>(random.uniform()); };
            const Vec2f at(2 * next() - 0.5f, 2 * next() - 0.5f);
            const float across = 0.02f + 0.1f * next(), turn = 6.2831853f * next(), stretch = 1 + 8 * next();
            const Vec2f axis(std::cos(turn), std::sin(turn));
            // Half axes that are not at right angles, of the same ellipse.
            const Vec2f major = axis * (across * stretch), minor = Vec2f(-axis[1], axis[0]) * across;
            const TextureFootprint area{major * 0.6f + minor * 0.8f, minor * 0.6f - major * 0.8f};
            const double mean = mean_over(texture, at, area);
            error += std::abs(double(levels.at(texture, at, area).colour[0]) - mean);
            of_points += std::abs(double(texture.at(at).colour[0]) - mean);
        }
        EXPECT_LT(error, 0.4 * of_points) << "noise is what levels are worst at";
    }
}

TEST(TextureLevels, LongAreasAreNotAveragedAcross) {
    const Texture stripes = grey_texture(64, 64, [](int x, int) { return static_cast<float>(x / 8 % 2); });
    const TextureLevels levels(stripes);
    const Vec2f in_dark(4.f / 64, 0.5f), in_light(12.f / 64, 0.5f);
    const TextureFootprint along{{0, 0.4f}, {0.01f, 0}}, across{{0.4f, 0}, {0, 0.01f}};
    EXPECT_NEAR(levels.at(stripes, in_dark, along).colour[0], 0, 0.01f);
    EXPECT_NEAR(levels.at(stripes, in_light, along).colour[0], 1, 0.01f);
    EXPECT_NEAR(levels.at(stripes, in_light, across).colour[0], 0.5f, 0.1f);
}

TEST(TextureLevels, AreasOfLessThanATexelAreLookups) {
    Texture texture = noise(32, 16, 4);
    const TextureLevels levels(texture);
    for (std::uint64_t i = 0; i < 100; ++i) {
        Random random(5, i);
        const Vec2f at(static_cast<float>(random.uniform()), static_cast<float>(random.uniform()));
        texture.filter = TextureFilter::bilinear;
        EXPECT_EQ(levels.at(texture, at, {{0.015f, 0}, {0, 0.03f}}), texture.at(at));
        texture.filter = TextureFilter::nearest;
        EXPECT_EQ(levels.at(texture, at, {}), texture.at(at));
        // A square of half a texel has parts of up to four texels.
        const float half = 0.25f / 1.7724539f;
        const TextureFootprint square{{2 * half / 32, 0}, {0, 2 * half / 16}};
        double mean = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const float s = (static_cast<float>(x) + 0.5f) / 64 - 0.5f,
                            t = (static_cast<float>(y) + 0.5f) / 64 - 0.5f;
                mean += double(texture.at({at[0] + s * 0.5f / 32, at[1] + t * 0.5f / 16}).colour[0]);
            }
        EXPECT_NEAR(levels.at(texture, at, square).colour[0], mean / 4096, 0.02) << i;
    }
}

TEST(TextureLevels, AnyAreaHasAValue) {
    const Texture texture = noise(8, 8, 6);
    const TextureLevels levels(texture);
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const float x : {std::nanf(""), infinity, -infinity, 3e38f, 1e18f, 1e-45f})
        for (const float at : {0.3f, infinity, 1e30f}) {
            const float value = levels.at(texture, {at, -at}, {{x, -x}, {x, 0}}).colour[0];
            EXPECT_TRUE(value >= 0 && value <= 1) << x << ' ' << at;
        }
    const Texture none;
    EXPECT_EQ(TextureLevels(none).at(none, {0.5f, 0.5f}, {{1, 0}, {0, 1}}), (Rgba{Vec3f::all(1), 1}));
}

}  // namespace
}  // namespace hedgerow
