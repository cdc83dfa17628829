/// How the samples of a picture are divided among its pixels: by spread, in two halves that do not bias each
/// other.
#include <atomic>
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <hedgerow/hedgerow.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/integrators/path_picture.h>
#include <hedgerow/render/sampling/allocation.h>
#include <hedgerow/scenes/looks.h>

#include "long_runs.h"

using namespace hedgerow;

namespace {

RC_GTEST_PROP(Allocations, HaveTheirMeanAndAreInProportion, ()) {
    const auto numbers = *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 1000)));
    const std::vector<float> spreads(numbers.begin(), numbers.end());
    const auto least = *rc::gen::inRange<std::uint32_t>(0, 50);
    const auto mean = least + *rc::gen::inRange<std::uint32_t>(0, 1000);
    const Allocation samples(spreads, least, mean), more(spreads, least, mean + 7);
    double sum = 0, scale = 0;
    for (std::size_t i = 0; i < spreads.size(); ++i) {
        sum += samples[i];
        RC_ASSERT(samples[i] >= least);
        RC_ASSERT(more[i] >= samples[i]);
        if (samples[i] > least && spreads[i] > 0)
            scale = std::max(scale, double(samples[i]) / double(spreads[i]));
    }
    const auto pixels = static_cast<double>(spreads.size());
    RC_ASSERT(std::abs(sum - mean * pixels) <= pixels / 2 + 1e-6 * sum);
    for (std::size_t i = 0; i < spreads.size(); ++i)
        if (samples[i] > least + 1 && spreads[i] > 0)
            RC_ASSERT(std::abs(samples[i] - scale * double(spreads[i])) <= 1 + 0.5 * double(spreads[i]));
}
TEST(Allocations, OfEqualOrNoSpreadsAreEven) {
    for (const float spread : {0.0f, 3.0f, 1e30f}) {
        const std::vector<float> spreads(5, spread);
        for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(Allocation(spreads, 4, 100)[i], 100u) << spread;
    }
    EXPECT_EQ(Allocation(std::vector<float>{0, 1}, 4, 4)[1], 4u) << "no more than the least is left";
}

TEST(Spreads, AreDeviationsAsShareOfTheLight) {
    // Samples of 1 and 3 in the left pixels, of 2 and 2 in the right ones.
    LightSums light(4 * 3);
    for (std::size_t i = 0; i < light.size(); ++i)
        for (const float off : {-1.0f, 1.0f, -1.0f, 1.0f})
            light.add(i, Vec3f::all(i % 4 < 2 ? 2 + off : 2.0f));
    const auto s = spreads(light, 4);
    const float own = std::sqrt(4.0f / 3 / 4.01f);
    EXPECT_NEAR(s[0], own, 1e-6f);
    EXPECT_NEAR(s[5], own * 2 / 3, 1e-6f) << "beside a pixel whose samples are alike";
    EXPECT_NEAR(s[7], own / 40, 1e-6f) << "a twentieth of the mean";
}

/// The Cornell box.
struct Box {
    Model<float> model = generate_model<float>(parse_scene_spec("gen:cornell-box"));
    ModelScene<float> scene{model, serial_executor()};
    SceneLights<float> lights{scene};
    PathScene<float> parts{scene, lights, scene.tracer()};
    PathPictureOptions options;

    Box(int width, int height, Division division, std::uint32_t samples) {
        options.camera = *camera_for("cornell-box");
        options.width = width, options.height = height, options.division = division;
        options.samples = samples;
    }
    PathPicture picture() const { return trace_paths(parts, by(default_executor(), options)); }
};

class Divisions : public testing::TestWithParam<Division> {};
INSTANTIATE_TEST_SUITE_P(All, Divisions,
                         testing::Values(Division::even, Division::halves, Division::adaptive),
                         [](const auto& test) {
                             return std::string(division_names[static_cast<std::size_t>(test.param)]);
                         });

/// Interrupted at any moment and continued, one by one or many at once.
TEST_P(Divisions, HaveTheSameBitsInWhateverSteps) {
    Box box(40, 24, GetParam(), 90);
    const PathPicture at_once = box.picture();
    box.options.in_flight = 0;
    PathPicture in_steps(box.options.width, box.options.height);
    for (const std::uint32_t until : {1u, 3u, 31u, 50u})
        add_samples(in_steps, until, box.parts, by(default_executor(), box.options));
    box.options.in_flight = 7;
    while (in_steps.samples < 90) {
        std::atomic<bool> stop{false};
        add_samples(in_steps, 90, box.parts, by(serial_executor(), box.options),
                    {[&](std::uint64_t done, std::uint64_t) { stop = done > 5000; }, &stop});
    }
    for (std::size_t i = 0; i < at_once.light.size(); ++i) {
        ASSERT_EQ(at_once.light.samples(i), in_steps.light.samples(i)) << i;
        ASSERT_EQ(at_once.light.mean(i), in_steps.light.mean(i)) << i;
    }
    EXPECT_NEAR(at_once.mean_samples(), 90, 0.5);
}

/// The mean of pictures with many seeds is that of even ones, and so is the light of each pixel.
TEST_P(Divisions, AreNotBiased) {
    const auto seeds = static_cast<std::uint32_t>(in_long_runs(1000, unless_sanitized(60, 6)));
    Box box(10, 8, GetParam(), 40), even(10, 8, Division::even, 64);
    constexpr std::size_t pixels = 80;
    std::vector<double> sums(pixels), squares(pixels), even_sums(pixels), even_squares(pixels);
    double mean = 0, mean_squares = 0, even_mean = 0, even_mean_squares = 0;
    for (std::uint32_t seed = 0; seed < seeds; ++seed) {
        box.options.paths.seed = seed, even.options.paths.seed = seed + 1000000;
        const auto add = [](const PathPicture& picture, auto& sum, auto& square, double& all,
                            double& all_squares) {
            double total = 0;
            for (std::size_t i = 0; i < pixels; ++i) {
                const double light = LightHalves::grey(Vec3d(picture.light.mean(i)));
                sum[i] += light, square[i] += light * light, total += light;
            }
            all += total, all_squares += total * total;
        };
        add(box.picture(), sums, squares, mean, mean_squares);
        add(even.picture(), even_sums, even_squares, even_mean, even_mean_squares);
    }
    const double n = seeds;
    const auto differ = [n](double a, double aa, double b, double bb) {
        const double variance = (aa / n - a / n * (a / n)) + (bb / n - b / n * (b / n));
        return a == b ? 0 : (a - b) / n / std::sqrt(variance / (n - 1));  // equal where all is black
    };
    EXPECT_LT(std::abs(differ(mean, mean_squares, even_mean, even_mean_squares)), 3);
    double chi2 = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        const double z = differ(sums[i], squares[i], even_sums[i], even_squares[i]);
        chi2 += z * z;
    }
    EXPECT_LT(chi2, pixels + 4 * std::sqrt(2.0 * pixels)) << "4 standard deviations";
}

/// Halves know how far their picture is off, and even samples that they are off no more than this.
TEST_P(Divisions, TellTheirNoise) {
    Box box(48, 48, GetParam(), 64);
    constexpr int seeds = 4;
    std::vector<std::vector<Vec3f>> pictures;
    double told = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        box.options.paths.seed = static_cast<std::uint64_t>(seed);
        const PathPicture picture = box.picture();
        pictures.push_back(picture.means()), told += picture.light.noise() * picture.light.noise() / seeds;
    }
    double squares = 0;
    for (std::size_t i = 0; i < pictures[0].size(); ++i) {
        double mean = 0, off = 0;
        for (const auto& p : pictures) mean += LightHalves::grey(Vec3d(p[i])) / seeds;
        for (const auto& p : pictures) off += std::pow(LightHalves::grey(Vec3d(p[i])) - mean, 2);
        squares += off / (seeds - 1) / (mean * mean + 0.01);
    }
    const double ratio = std::sqrt(told / (squares / double(pictures[0].size())));
    EXPECT_GT(ratio, 0.9);
    EXPECT_LT(ratio, GetParam() == Division::even ? 2.5 : 1.1);
}

/// Much of a picture is sky, where few samples are enough.
TEST(AdaptivePictures, HaveLessNoise) {
    const auto model = generate_model<float>(parse_scene_spec("gen:hairball:3000"));
    const ModelScene<float> scene(model, serial_executor());
    const SceneLights<float> lights(scene);
    const PathScene<float> parts{scene, lights, scene.tracer()};
    PathPictureOptions options;
    options.camera = automatic_camera(scene.bounds());
    options.width = options.height = 64, options.samples = 128;
    options.division = Division::halves;
    const double halves = trace_paths(parts, by(default_executor(), options)).light.noise();
    options.division = Division::adaptive;
    const double adaptive = trace_paths(parts, by(default_executor(), options)).light.noise();
    EXPECT_LT(adaptive, halves * 0.8) << halves;
}

}  // namespace
