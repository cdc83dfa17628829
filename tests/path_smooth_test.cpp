/// Paths at surfaces whose corners have normals: the light of the smooth surface, and no more than that.
#include <gtest/gtest.h>

#include <cmath>

#include "lights_of_tests.h"
#include "path_scenes.h"

using namespace hedgerow;
using namespace hedgerow::test;

namespace {

/// A ball of few triangles with the normals of a sphere.
Model<float> smooth_ball(std::uint64_t size, const Material& material) {
    auto model = model_of<float>({{ball(size), material}});
    model.objects[0].attributes.normals.values = model.objects[0].mesh.vertices;
    return model;
}

/// Inside, where the smooth surface is behind the triangles.
TEST(SmoothPaths, LoseNoLightInABall) {
    PathPictureOptions options = few_pixels(camera_at({0.3f, 0.1f, -0.6f}, {0.1f, 0.9f, 0}), 512);
    options.paths.light_sampling = false;
    for (const std::uint64_t size : {100u, 2000u}) {
        const auto model = smooth_ball(size, matte(Vec3f::all(0.75f), Vec3f::all(0.5f)));
        const Estimate found = estimate(trace(model, options));
        EXPECT_NEAR(found.mean, 2, 3 * found.error) << size;
        EXPECT_LT(found.error, 0.02) << size;
    }
}

/// Directions below a triangle that is before the smooth surface are mirrored: of light that comes so, the
/// three ways to look for light find the same.
TEST(SmoothPaths, FindTheSameLightInAllWaysInABall) {
    TriangleMesh<float> lamp = ball(100);
    for (auto& p : lamp.vertices) p = p * 0.2f + Vec3f(0.3f, -0.2f, 0.4f);
    for (const float roughness : {0.3f, 1.0f}) {
        Material walls = matte(Vec3f::all(0.6f));
        walls.roughness = roughness, walls.metallic = 1 - roughness;
        auto model = model_of<float>({{ball(50), walls}, {lamp, matte({}, Vec3f::all(10))}});
        model.objects[0].attributes.normals.values = model.objects[0].mesh.vertices;
        PathPictureOptions options = few_pixels(camera_at({0.3f, 0.1f, -0.6f}, {0.1f, 0.9f, 0}), 2048);
        std::vector<Estimate> found;
        for_each_way([&](PathOptions& paths, const char*) {
            options.paths = paths;
            found.push_back(estimate(trace(model, options)));
        });
        for (std::size_t i = 1; i < 3; ++i)
            EXPECT_NEAR(found[i].mean, found[0].mean, 3 * std::hypot(found[i].error, found[0].error)) << i;
        EXPECT_LT(found[0].error, 0.01 * found[0].mean);
    }
}

/// The ball from afar, in light from the side: pixels of which the sphere shows the height of the light over
/// the horizon, and their light.
struct LitPixel {
    double height, light;
};
std::vector<LitPixel> lit_from_the_side(std::uint64_t size, bool smooth) {
    constexpr int side = 96;
    Model<float> model = smooth_ball(size, matte(Vec3f::all(1)));
    if (!smooth) model.objects[0].attributes.normals.values.clear();
    model.lights.push_back(DirectionalLight{"", {-0.8, 0.6, 0}, Vec3f::all(static_cast<float>(pi))});
    PathPictureOptions options;
    options.camera = {{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 45, {}, Projection::orthographic, 2};
    options.width = options.height = side, options.samples = 16, options.paths.bounces = 1;
    const PathPicture picture = trace(model, options);
    std::vector<LitPixel> pixels;
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) {
            const std::size_t number = std::size_t(row) * side + std::size_t(column);
            const double x = 2 * (column + 0.5) / side - 1, y = 1 - 2 * (row + 0.5) / side;
            if (x * x + y * y > 0.8) continue;
            pixels.push_back({0.8 * x - 0.6 * y, double(picture.light.mean(number)[0])});
        }
    return pixels;
}
/// The mean error of the light of pixels, beside that of the sphere.
double error_of(const std::vector<LitPixel>& pixels) {
    double sum = 0;
    for (const LitPixel& p : pixels) sum += std::abs(p.light - std::max(0.0, p.height));
    return sum / double(pixels.size());
}

/// Faces that the light only just misses are lit where the sphere is, and faces that it just meets are dark
/// where the sphere is. Triangles alone end in steps.
TEST(SmoothPaths, FadeAtTheTerminatorAsASphere) {
    for (const std::uint64_t size : {100u, 500u, 5000u}) {
        const auto pixels = lit_from_the_side(size, true);
        EXPECT_LT(error_of(pixels), 0.2 * error_of(lit_from_the_side(size, false))) << size;
        double near = 0, expected = 0, beyond = 0;
        for (const LitPixel& p : pixels) {
            if (p.height > 0 && p.height < 0.3) near += p.light, expected += p.height;
            if (p.height < -0.1) beyond += p.light;
        }
        EXPECT_NEAR(near, expected, 0.1 * expected) << size;
        EXPECT_LT(beyond, 0.001 * expected) << size;
    }
}

/// A floor below a wall, and a lamp of the same size close behind the wall.
TEST(SmoothPaths, LampsCloseBehindAWallAreDark) {
    for (const double gap : {1e-4, 1e-3}) {
        const auto floor_below = [&](double lamp) {
            TriangleMesh<float> down = square<float>(1, 3 + lamp);
            for (auto& t : down.triangles) std::swap(t[1], t[2]);
            const auto model = model_of<float>({{square<float>(2, 0), matte(Vec3f::all(0.5f))},
                                                {square<float>(2, 3), matte(Vec3f::all(0.5f))},
                                                {down, matte({}, Vec3f::all(10))}});
            PathPictureOptions options = few_pixels(camera_at({0, -3, 1}, {0, 0, 0}), 64);
            options.camera.field_of_view = 20;
            return estimate(trace(model, options)).mean;
        };
        EXPECT_EQ(floor_below(gap), 0) << gap;
        EXPECT_GT(floor_below(-gap), 0.1) << gap;
    }
}
/// Points of light, too.
TEST(SmoothPaths, PointsCloseBehindAWallAreDark) {
    for (const double gap : {1e-4, -1e-4}) {
        auto model = model_of<float>(
            {{square<float>(2, 0), matte(Vec3f::all(0.5f))}, {square<float>(2, 3), matte(Vec3f::all(0.5f))}});
        model.lights.push_back(PointLight{"", {0.3, 0.2, 3 + gap}, Vec3f::all(10)});
        PathPictureOptions options = few_pixels(camera_at({0, -3, 1}, {0, 0, 0}), 4);
        options.camera.field_of_view = 20, options.paths.bounces = 1;
        const double light = estimate(trace(model, options)).mean;
        EXPECT_EQ(light > 0, gap < 0);
    }
}

}  // namespace
