/// The denoiser: noise that goes, edges and textures that stay, single bright pixels, and the same bits
/// everywhere.
#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/film/denoise.h>
#include <hedgerow/render/integrators/path_picture.h>
#include <hedgerow/scenes/looks.h>
#include <hedgerow/scenes/random.h>

#include "backwards.h"

using namespace hedgerow;

namespace {

/// A picture with noise, and what it is without.
struct Case {
    int width, height;
    std::array<std::vector<Vec3f>, 2> light;
    std::array<std::vector<float>, 2> variance;
    std::vector<Vec3f> albedo, normal;
    std::vector<float> depth;
    std::vector<Vec3f> truth;

    NoisyPicture picture() const {
        return {width, height, {light[0], light[1]}, {variance[0], variance[1]}, albedo, normal, depth};
    }
    std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};
using Truth = std::function<Vec3f(int, int)>;

/// Two halves of eight samples, each off by up to `noise` of the light.
Case noisy(int width, int height, const Truth& truth, float noise = 1) {
    Case made{width, height, {}, {}, {}, {}, {}, {}};
    Random random(1, 0);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Vec3f light = truth(x, y);
            made.truth.push_back(light);
            for (std::size_t h = 0; h < 2; ++h) {
                LightSums sums(1);
                for (int k = 0; k < 8; ++k) {
                    const auto off = static_cast<float>(2 * random.uniform() - 1);
                    sums.add(0, light * (1 + product(noise, off)));
                }
                made.light[h].push_back(sums.mean(0));
                made.variance[h].push_back(product(sums.standard_error(0), sums.standard_error(0)));
            }
        }
    return made;
}
std::vector<Vec3f> denoised(const Case& c, const DenoiserOptions& o = {}) {
    return denoised(c.picture(), by(serial_executor(), o));
}
std::vector<Vec3f> raw(const Case& c) {
    std::vector<Vec3f> all;
    for (std::size_t i = 0; i < c.truth.size(); ++i) all.push_back((c.light[0][i] + c.light[1][i]) / 2.f);
    return all;
}
bool is_light(const Vec3f& c) {
    return finite(c) && c[0] >= 0 && c[1] >= 0 && c[2] >= 0;
}
/// The root of the mean squared relative error.
double error(const std::vector<Vec3f>& light, const std::vector<Vec3f>& truth) {
    double sum = 0;
    for (std::size_t i = 0; i < light.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const auto off = double(light[i][c]) - double(truth[i][c]), is = double(truth[i][c]);
            sum += off * off / (is * is + 0.01);
        }
    return std::sqrt(sum / (3 * double(light.size())));
}
double mean(const std::vector<Vec3f>& light) {
    double sum = 0;
    for (const Vec3f& c : light) sum += double(c[0]) + double(c[1]) + double(c[2]);
    return sum / (3 * double(light.size()));
}

TEST(Denoiser, TakesNoiseOutOfEvenLight) {
    const Case c = noisy(64, 48, [](int, int) { return Vec3f(2, 1, 0.5f); });
    const auto less = denoised(c);
    EXPECT_LT(error(less, c.truth), 0.3 * error(raw(c), c.truth));
    EXPECT_NEAR(mean(less) / mean(c.truth), 1, 5e-3);
}
TEST(Denoiser, DoesNotDependOnTheUnitOfLight) {
    const Case c = noisy(32, 16, [](int x, int) { return Vec3f::all(1 + static_cast<float>(x) / 32); });
    const auto once = denoised(c);
    for (const float unit : {0x1p-40f, 0x1p30f}) {
        Case other = c;
        for (std::size_t h = 0; h < 2; ++h) {
            for (Vec3f& light : other.light[h]) light = light * unit;
            for (float& v : other.variance[h]) v = v * unit * unit;
        }
        const auto light = denoised(other);
        for (std::size_t i = 0; i < once.size(); ++i) ASSERT_EQ(light[i], once[i] * unit) << unit;
    }
}
TEST(Denoiser, KeepsEdgesOfFeatures) {
    // The halves of the picture differ by less than the noise.
    Case c = noisy(
        48, 48, [](int x, int) { return Vec3f::all(x < 24 ? 1 : 1.4f); }, 1.5f);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 48; ++x) c.normal.push_back(x < 24 ? Vec3f(1, 0, 0) : Vec3f(0, 1, 0));
    const auto less = denoised(c);
    Vec3f left, right;
    for (int y = 0; y < 48; ++y)
        left = left + less[c.at(23, y)] / 48.f, right = right + less[c.at(24, y)] / 48.f;
    EXPECT_NEAR(left[0], 1, 0.08);
    EXPECT_NEAR(right[0], 1.4f, 0.08);
    EXPECT_LT(error(less, c.truth), 0.4 * error(raw(c), c.truth));
    Case blind = c;
    blind.normal.clear();
    EXPECT_GT(error(denoised(blind), c.truth), 1.2 * error(less, c.truth)) << "the normals must matter";
}
TEST(Denoiser, KeepsTexturesAndShadows) {
    const auto albedo = [](int x, int y) {
        return (x / 2 + y / 3) % 2 == 0 ? Vec3f(0.8f, 0.5f, 0.1f) : Vec3f(0.2f, 0.3f, 0.4f);
    };
    // A shadow falls on a texture: no feature shows it.
    Case c = noisy(
        64, 64, [&](int x, int y) { return albedo(x, y) * (x + y < 64 ? 1 : 0.1f); }, 0.7f);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) c.albedo.push_back(albedo(x, y));
    const auto less = denoised(c);
    EXPECT_LT(error(less, c.truth), 0.6 * error(raw(c), c.truth));
    Case blind = c;
    blind.albedo.clear();
    EXPECT_GT(error(denoised(blind), c.truth), 1.2 * error(less, c.truth)) << "the albedo must matter";
}
TEST(Denoiser, LeavesPixelsWithoutNoiseAlone) {
    Case c =
        noisy(40, 20, [](int x, int y) { return Vec3f::all(static_cast<float>(1 + (x * 7 + y * 3) % 5)); });
    for (int y = 0; y < 20; ++y)
        for (int x = 20; x < 40; ++x)
            for (std::size_t h = 0; h < 2; ++h)
                c.light[h][c.at(x, y)] = c.truth[c.at(x, y)], c.variance[h][c.at(x, y)] = 0;
    const auto less = denoised(c);
    for (int y = 0; y < 20; ++y)
        for (int x = 20; x < 40; ++x) ASSERT_EQ(less[c.at(x, y)], c.truth[c.at(x, y)]);
}
/// Detail that no feature shows and no neighbour has stays, with its noise.
TEST(Denoiser, DoesNotBlurWhatItCannotPredict) {
    Random random(5, 0);
    const Case c = noisy(
        48, 48, [&](int, int) { return Vec3f::all(static_cast<float>(1 + random.uniform())); }, 0.3f);
    EXPECT_LT(error(denoised(c), c.truth), 1.1 * error(raw(c), c.truth));
}
TEST(Denoiser, CutsOffSingleBrightSamples) {
    Case c = noisy(
        48, 48, [](int, int) { return Vec3f::all(1); }, 0.5f);
    Random random(9, 0);
    for (int k = 0; k < 20; ++k) {
        const std::size_t i =
            c.at(static_cast<int>(random.uniform() * 48), static_cast<int>(random.uniform() * 48));
        c.light[static_cast<std::size_t>(k % 2)][i] = Vec3f::all(5000);
        c.variance[static_cast<std::size_t>(k % 2)][i] = 5000.f * 5000.f;
    }
    const auto less = denoised(c);
    for (const Vec3f& light : less) ASSERT_TRUE(light[0] > 0.7f && light[0] < 1.4f) << light[0];
}
TEST(Denoiser, KeepsALampOfOnePixel) {
    Case c = noisy(
        31, 31, [](int x, int y) { return Vec3f::all(x == 15 && y == 15 ? 40 : 1); }, 0.5f);
    EXPECT_NEAR(denoised(c)[c.at(15, 15)][0], 40, 10);
}

std::uint64_t hash_of(const std::vector<Vec3f>& light) {
    std::uint64_t hash = 0;
    for (const Vec3f& c : light)
        for (const float x : c.data) hash = scattered(hash + std::bit_cast<std::uint32_t>(x));
    return hash;
}
/// Shapes, a texture, sky and noise of every kind.
Case everything(int width, int height) {
    const auto is_sky = [](int x, int y) { return y < 5 + x % 3; };
    Case c = noisy(width, height, [&](int x, int y) {
        if (is_sky(x, y)) return Vec3f(0.3f, 0.4f, 0.9f);
        return Vec3f(0.5f + product(0.02f, static_cast<float>(x)), (x / 4 + y / 4) % 2 == 0 ? 0.9f : 0.3f,
                     0.2f);
    });
    Random random(2, 0);
    const auto some = [&] { return static_cast<float>(random.uniform()); };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const bool sky = is_sky(x, y);
            c.albedo.push_back(sky ? Vec3f() : Vec3f(0.5f, (x / 4 + y / 4) % 2 == 0 ? 0.9f : 0.3f, some()));
            c.normal.push_back(sky ? Vec3f() : Vec3f(0, some(), 1));
            c.depth.push_back(sky ? std::numeric_limits<float>::infinity() : 3 + some());
        }
    return c;
}
TEST(Denoiser, HasTheseBitsEverywhere) {
    const Case c = everything(77, 41);
    EXPECT_EQ(hash_of(denoised(c)), 12159633115700135955u);
    DenoiserOptions wide;
    wide.radius = 10, wide.feature_tolerance = 1;
    EXPECT_EQ(hash_of(denoised(c, wide)), 17422259974353967734u);
}
TEST(Denoiser, HasTheSameBitsWithAnyThreads) {
    const Case c = everything(150, 70);
    const auto alone = denoised(c);
    Backwards backwards;
    EXPECT_EQ(alone, denoised(c.picture(), {.threads = backwards}));
    EXPECT_EQ(alone, denoised(c.picture(), {.threads = default_executor()}));
}

TEST(Denoiser, TakesPicturesOfAnySizeAndLight) {
    for (const auto& [width, height] : {std::pair(1, 1), {1, 40}, {33, 1}, {2, 3}, {5, 5}, {65, 17}}) {
        SCOPED_TRACE(width);
        const Case c = everything(width, height);
        for (const auto& less : {denoised(c), denoised(c, {.radius = 10}), denoised(c, {.radius = 1})}) {
            ASSERT_EQ(less.size(), c.truth.size());
            for (const Vec3f& light : less) ASSERT_TRUE(is_light(light));
        }
        Case black = c;
        for (auto& half : black.light) half.assign(c.truth.size(), Vec3f());
        EXPECT_EQ(denoised(black), black.light[0]);
    }
    Random random(4, 0);
    const auto any = [&] { return static_cast<float>(power(10, 70 * random.uniform() - 35)); };
    Case wild = everything(20, 20);
    for (std::size_t i = 0; i < wild.truth.size(); ++i) {
        for (std::size_t h = 0; h < 2; ++h)
            wild.light[h][i] = {any(), random.uniform() < 0.5 ? 0 : any(), any()},
            wild.variance[h][i] = any();
        wild.albedo[i] = {any(), -any(), any()}, wild.normal[i] = {any(), any(), -any()},
        wild.depth[i] = any();
    }
    wild.depth[0] = 0, wild.variance[0][3] = std::numeric_limits<float>::infinity();
    for (const Vec3f& light : denoised(wild)) ASSERT_TRUE(is_light(light));
}
TEST(Denoiser, RefusesWhatHasNoMeaning) {
    const Case good = everything(8, 8);
    const auto expect_refused = [&](const char* what, auto change) {
        Case c = good;
        DenoiserOptions o;
        change(c, o);
        EXPECT_THROW(denoised(c, o), InputError) << what;
    };
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    expect_refused("no pixels", [](Case& c, auto&) { c.width = 0; });
    expect_refused("light of another size", [](Case& c, auto&) { c.light[1].pop_back(); });
    expect_refused("variance of another size", [](Case& c, auto&) { c.variance[0].pop_back(); });
    expect_refused("albedo of another size", [](Case& c, auto&) { c.albedo.pop_back(); });
    expect_refused("normals of another size", [](Case& c, auto&) { c.normal.pop_back(); });
    expect_refused("depths of another size", [](Case& c, auto&) { c.depth.pop_back(); });
    expect_refused("negative light", [](Case& c, auto&) { c.light[0][3][1] = -1; });
    expect_refused("light that is no number", [](Case& c, auto&) { c.light[0][3][1] = nan; });
    expect_refused("a variance that is no number", [](Case& c, auto&) { c.variance[1][3] = nan; });
    expect_refused("an infinite albedo",
                   [](Case& c, auto&) { c.albedo[3][1] = std::numeric_limits<float>::infinity(); });
    expect_refused("a normal that is no number", [](Case& c, auto&) { c.normal[3][1] = nan; });
    expect_refused("a depth that is no number", [](Case& c, auto&) { c.depth[3] = nan; });
    expect_refused("a radius of 0", [](Case&, DenoiserOptions& o) { o.radius = 0; });
    expect_refused("a radius of 11", [](Case&, DenoiserOptions& o) { o.radius = 11; });
    expect_refused("no tolerance of light", [](Case&, DenoiserOptions& o) { o.light_tolerance = 0; });
    expect_refused("no tolerance of features", [](Case&, DenoiserOptions& o) { o.feature_tolerance = nan; });
}
TEST(Denoiser, TellsHowFarItIsAndStops) {
    const Case c = everything(100, 40);
    std::uint64_t last = 0, whole = 0;
    const Progress progress{[&](std::uint64_t done, std::uint64_t total) { last = done, whole = total; },
                            nullptr};
    denoised(c.picture(), {.threads = serial_executor()}, progress);
    EXPECT_EQ(whole, 4000u);
    EXPECT_EQ(last, 4000u);
    const std::atomic<bool> stop{true};
    EXPECT_THROW(denoised(c.picture(), {.threads = serial_executor()}, {{}, &stop}), Cancelled);
}

/// The Cornell box below its lamp at 32 samples, held against 512. (Pixels that show a sliver of the lamp
/// have errors that no neighbour can mend.)
TEST(Denoiser, HalvesTheErrorOfAPathPicture) {
    const auto model = generate_model<float>(parse_scene_spec("gen:cornell-box"));
    const ModelScene<float> scene(model, serial_executor());
    const SceneLights<float> lights(scene);
    const PathScene<float> parts{scene, lights, scene.tracer()};
    PathPictureOptions options;
    options.camera = *camera_for("cornell-box");
    options.camera.target[1] = 200, options.camera.field_of_view = 25, options.width = options.height = 40,
    options.samples = 16;
    Case c{40, 40, {}, {}, {}, {}, {}, {}};
    for (std::size_t h = 0; h < 2; ++h) {
        options.paths.seed = 1 + h;
        const PathPicture half = trace_paths(parts, by(default_executor(), options));
        c.light[h] = half.means();
        for (std::size_t i = 0; i < half.light.size(); ++i)
            c.variance[h].push_back(half.light.standard_error(i) * half.light.standard_error(i));
    }
    for (const FirstSurface& first : first_surfaces(parts, 16, by(default_executor(), options)))
        c.albedo.push_back(first.albedo), c.normal.push_back(first.normal), c.depth.push_back(first.depth);
    options.paths.seed = 3, options.samples = 512;
    c.truth = trace_paths(parts, by(default_executor(), options)).means();
    const auto less = denoised(c);
    EXPECT_LT(error(less, c.truth), 0.5 * error(raw(c), c.truth));
    EXPECT_NEAR(mean(less) / mean(c.truth), 1, 0.015);
}

}  // namespace
