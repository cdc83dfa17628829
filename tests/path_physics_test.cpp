/// The light of paths against closed forms: inside of closed meshes of any shape, white things of any
/// roughness, lamps whose irradiance is known, and three ways to look for light that must agree.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include <hedgerow/render/camera/presets.h>
#include <hedgerow/scenes/looks.h>
#include <hedgerow/scenes/meshes.h>

#include "lights_of_tests.h"
#include "long_runs.h"
#include "path_scenes.h"
#include "scattering_support.h"

using namespace hedgerow;
using namespace hedgerow::test;

namespace {

/// A box with an edge that points inward: a corner of the upper side is pushed in.
TriangleMesh<float> dented() {
    TriangleMesh<float> mesh = box<float>(1, 1, 1);
    mesh.vertices[7] = {0.2f, 0.2f, 0.2f};
    return mesh;
}

struct Closed {
    const char* name;
    TriangleMesh<float> mesh;
    Vec3f eye;
};
std::vector<Closed> closed_meshes() {
    return {{"cube", cube<float>(12), {0.3f, -0.4f, 0.5f}},
            {"ball", ball(500), {0.3f, 0.1f, -0.6f}},
            {"dented", dented(), {-0.5f, -0.5f, 0}},
            {"flat", box<float>(1, 1, 0.05), {0.3f, 0.2f, 0}}};
}

/// Le·(1 − ρ^(k+1))/(1 − ρ) after k bounces.
double series(double emission, double reflected, std::uint32_t bounces) {
    return emission * (1 - std::pow(reflected, bounces + 1.0)) / (1 - reflected);
}

TEST(PathPhysics, ClosedMeshesHaveTheLightOfTheirSeries) {
    const double emission = 0.5, reflected = 0.75;
    for (const Closed& c : closed_meshes())
        for (const std::uint32_t bounces : {0u, 1u, 2u, 5u, 100u}) {
            SCOPED_TRACE(std::string(c.name) + ", " + std::to_string(bounces) + " bounces");
            const auto model = model_of<float>({{c.mesh, matte(Vec3f::all(0.75f), Vec3f::all(0.5f))}});
            PathPictureOptions options = few_pixels(camera_at(c.eye, {0.1f, 0.9f, 0}), 8);
            options.paths.bounces = bounces, options.paths.roulette_from = PathOptions::never;
            options.paths.light_sampling = false;
            const double expected = series(emission, reflected, bounces);
            const PathPicture exact = trace(model, options);
            for (std::size_t i = 0; i < exact.light.size(); ++i)
                ASSERT_NEAR(exact.light.mean(i)[0], expected, 1e-5 * expected) << i;
        }
}
/// With all that paths have: pixels within 4.5 standard errors, and their mean within 3.
TEST(PathPhysics, RouletteAndLightSamplingKeepTheMean) {
    const double expected = series(0.5, 0.75, 100);
    for (const Closed& c : closed_meshes()) {
        SCOPED_TRACE(c.name);
        const auto model = model_of<float>({{c.mesh, matte(Vec3f::all(0.75f), Vec3f::all(0.5f))}});
        PathPictureOptions options = few_pixels(camera_at(c.eye, {0.1f, 0.9f, 0}), 512);
        options.paths.bounces = 100, options.paths.roulette_from = 1;
        options.paths.sampler = Sampler::independent;
        const PathPicture picture = trace(model, options);
        for (std::size_t i = 0; i < picture.light.size(); ++i)
            EXPECT_NEAR(picture.light.mean(i)[0], expected, 4.5 * double(picture.light.standard_error(i)))
                << i;
        const Estimate all = estimate(picture);
        EXPECT_NEAR(all.mean, expected, 3 * all.error);
        EXPECT_LT(all.error, 0.01 * expected);
    }
}
/// A material of a square below a white sky, seen along a ray at this angle to its normal.
Estimate under_white_sky(const Material& material, double cosine, bool compensation, std::uint32_t samples) {
    auto model = model_of<float>({{square<float>(1, 0), material}});
    model.environment = Environment();
    const double sine = std::sqrt(1 - cosine * cosine);
    Camera camera = camera_at(Vec3f(Vec3d(sine, 0, cosine) * 10.0), {0, 0, 0}, {0, 1, 0});
    camera.field_of_view = 0.01f;
    PathPictureOptions options = few_pixels(camera, samples);
    options.paths.compensation = compensation, options.paths.sampler = Sampler::independent;
    return estimate(trace(model, options));
}
/// The light of a surface in white light from all around: the integral of its values, by midpoints.
double integral_of_values(const SurfaceMaterial& material, double cosine, bool compensation) {
    const scatterings::Surface surface{"", material, false, compensation};
    const Vec3f o = scatterings::direction(cosine);
    const Scattering scattering = surface.at(o);
    const auto charts = scatterings::charts(surface, o);
    constexpr int n = 300;
    double sum = 0;
    for (std::size_t side = 0; side < 2; ++side)
        for (int k = 0; k < n * n; ++k) {
            const int down = k / n, across = k % n;
            const double t = (down + 0.5) / n;
            const Vec3f i = charts[side].at(t, (across + 0.5) / n);
            if ((i[2] > 0) == (side == 0))
                sum += double(scattering.value(i)[0]) * charts[side].area(t) / (n * n);
        }
    return sum;
}

TEST(PathPhysics, WhiteThingsUnderAWhiteSkyAreWhiteAtEveryAngle) {
    Material mirror = matte(Vec3f::all(1)), coat = mirror, thin = mirror;
    mirror.metallic = 1, mirror.roughness = 0, coat.specular = 1, coat.roughness = 0;
    thin.transmission = 1, thin.roughness = 0, thin.specular = 1;
    for (const double cosine : {1.0, 0.6, 0.2})
        for (const Material& m : {matte(Vec3f::all(1)), mirror, coat, thin}) {
            const Estimate found = under_white_sky(m, cosine, true, 4096);
            EXPECT_NEAR(found.mean, 1, 0.001 + 3 * found.error) << cosine;
            EXPECT_LT(found.error, 0.0007) << cosine;
        }
    // Within a closed body of smooth glass all light gets out.
    Material glass = thin;
    glass.thin = false;
    for (const TriangleMesh<float>& body : {box<float>(1, 1, 1), ball(500), dented()}) {
        auto model = model_of<float>({{body, glass}});
        model.environment = Environment();
        PathPictureOptions options = few_pixels(camera_at({3, 2, 1.5f}, {0, 0, 0}), 256);
        options.camera.field_of_view = 20;
        options.paths.bounces = 2000, options.paths.roulette_from = PathOptions::never;
        const Estimate found = estimate(trace(model, options));
        EXPECT_NEAR(found.mean, 1, 0.001);
    }
}

TEST(PathPhysics, RoughThingsHaveTheirAlbedo) {
    for (const float roughness : {0.2f, 0.4f, 0.6f, 0.8f, 1.0f})
        for (const double cosine : {0.95, 0.5, 0.15})
            for (const bool compensation : {true, false}) {
                SCOPED_TRACE(testing::Message() << roughness << ' ' << cosine << ' ' << compensation);
                Material metal = matte(Vec3f::all(1)), coat = matte(Vec3f()), glass = matte(Vec3f::all(1));
                metal.metallic = 1, coat.specular = glass.specular = 1;
                glass.transmission = 1, glass.thin = false;
                metal.roughness = coat.roughness = glass.roughness = roughness;
                const std::pair<Material, SurfaceMaterial> both[] = {
                    {metal, scatterings::metal(roughness, Vec3f::all(1))},
                    {coat, scatterings::coated(roughness, Vec3f())},
                    {glass, scatterings::glass(roughness)}};
                for (const auto& [material, surface] : both) {
                    const Estimate found = under_white_sky(material, cosine, compensation, 512);
                    const double expected = integral_of_values(surface, cosine, compensation);
                    EXPECT_NEAR(found.mean, expected, 3.5 * found.error + 1e-3 * expected);
                    EXPECT_LT(found.error, 0.01);
                    if (compensation && material.metallic > 0) {
                        EXPECT_NEAR(expected, 1, 0.01);
                    }
                }
            }
}

/// A ball of rough glass that loses nothing, in white light from all around, is white: one of flat triangles,
/// and one of few triangles whose corners have the normals of a sphere.
TEST(PathPhysics, BallsOfRoughGlassLoseNoLight) {
    for (const bool smooth : {false, true})
        for (const float roughness : {0.2f, 0.4f, 0.6f, 1.0f}) {
            Material glass = matte(Vec3f::all(1));
            glass.specular = glass.transmission = 1, glass.thin = false, glass.roughness = roughness;
            auto model = model_of<float>({{ball(smooth ? 100 : 500), glass}});
            if (smooth) model.objects[0].attributes.normals.values = model.objects[0].mesh.vertices;
            model.environment = Environment();
            PathPictureOptions options = few_pixels(camera_at({3, 2, 1.5f}, {0, 0, 0}), 0);
            options.camera.field_of_view = 20;
            options.paths.bounces = 2000, options.paths.light_sampling = false;
            options.paths.roulette_from = PathOptions::never;
            // Light that leaves after many reflections is rare, so rough balls take more samples.
            options.samples = roughness < 0.5f   ? 4096
                              : roughness < 0.9f ? 8192
                                                 : static_cast<std::uint32_t>(in_long_runs(65536, 8192));
            const Estimate found = estimate(trace(model, options));
            EXPECT_NEAR(found.mean, 1, std::max(0.005, 3 * found.error)) << smooth << ' ' << roughness;
            EXPECT_LT(found.error, roughness < 0.9f ? 0.0015 : 0.005) << smooth << ' ' << roughness;
        }
}

/// A matte floor of albedo ½ at z = 0 beneath a lamp, seen at a point all but one, by one bounce.
void expect_irradiance(const TriangleMesh<float>& lamp, double expected, const Vec3f& at = {}) {
    Material shines = matte({}, Vec3f::all(2));
    const auto model = model_of<float>({{square<float>(5, 0), matte(Vec3f::all(0.5f))}, {lamp, shines}});
    Camera camera = camera_at(at + Vec3f(0, 0, 0.1f), at, {0, 1, 0});
    camera.field_of_view = 0.1f;
    for_each_way([&](const PathOptions& way, const char* name) {
        PathPictureOptions options = few_pixels(camera, way.light_sampling ? 1024 : 8192);
        options.paths = way, options.paths.bounces = 1, options.paths.sampler = Sampler::independent;
        const Estimate found = estimate(trace(model, options, {.default_sky = false}));
        EXPECT_NEAR(found.mean, expected / pi, 3 * found.error) << name;
        EXPECT_LT(found.error, 0.02 * expected / pi) << name;
    });
}

TEST(PathPhysics, DiscsSpheresAndPolygonsGiveTheirIrradiance) {
    // A disc of 256 corners, less its triangles' share of the circle.
    TriangleMesh<float> disc;
    disc.vertices.push_back({0, 0, 1.25f});
    std::vector<Vec3d> rim;
    for (std::uint32_t i = 0; i < 256; ++i) {
        rim.push_back({0.75 * std::cos(2 * pi * i / 256), 0.75 * std::sin(2 * pi * i / 256), 1.25});
        disc.vertices.push_back(Vec3f(rim.back()));
        disc.triangles.push_back({0, i + 1, (i + 1) % 256 + 1});
    }
    const double of_disc = pi * 0.75 * 0.75 / (0.75 * 0.75 + 1.25 * 1.25);
    EXPECT_NEAR(lambert(rim, {}, {0, 0, 1}) / of_disc, 1, 2e-4);
    expect_irradiance(disc, of_disc);
    // A sphere wholly above the horizon: π (r/d)² cos θ.
    TriangleMesh<float> sphere = ball(20000);
    for (Vec3f& p : sphere.vertices) p = p * 0.8f + Vec3f(1, 0.5f, 2);
    const double d2 = 1 + 0.25 + 4;
    expect_irradiance(sphere, pi * 0.64 / d2 * 2 / std::sqrt(d2));
    // A triangle and a pentagon that is tilted.
    const TriangleMesh<float> triangle{{{-1, 0, 1}, {1.5f, -0.5f, 2}, {0.3f, 2, 1.5f}}, {{0, 1, 2}}, {}};
    expect_irradiance(triangle, lambert({{-1, 0, 1}, {1.5, -0.5, 2}, {float(0.3), 2, 1.5}}, {}, {0, 0, 1}));
    std::vector<Vec3d> pentagon;
    TriangleMesh<float> fan;
    for (std::uint32_t i = 0; i < 5; ++i) {
        const double angle = 2 * pi * i / 5, x = std::cos(angle), y = std::sin(angle);
        fan.vertices.push_back(Vec3f(Vec3d(x, y - 0.5, 1.5 + 0.5 * x)));
        pentagon.push_back(Vec3d(fan.vertices.back()));
        if (i > 1) fan.triangles.push_back({0, i - 1, i});
    }
    expect_irradiance(fan, lambert(pentagon, {0.5, 0.25, 0}, {0, 0, 1}), {0.5f, 0.25f, 0});
}

TEST(PathPhysics, TheLampOfTheCornellBoxGivesItsIrradiance) {
    auto model = generate_model<float>(parse_scene_spec("gen:cornell-box"));
    const auto& object = model.objects[0];
    const Vec3d at(400, 0, 100);  // on the floor, from where all of the lamp is seen
    double irradiance = 0, radiance = 0;
    for (std::size_t i = 0; i < object.mesh.size(); ++i) {
        const Material& m = model.materials[object.material_of(i)];
        const auto t = object.mesh.view().triangle(i);
        if (max_component(m.emission) == 0) continue;
        radiance = double(m.emission[0]) * double(m.emission_strength);
        irradiance += radiance * lambert({Vec3d(t.a), Vec3d(t.b), Vec3d(t.c)}, at, {0, 1, 0});
    }
    ASSERT_GT(irradiance, 0);
    const double albedo = double(model.materials[object.material_of(0)].base_colour[0]);
    Camera camera = camera_at({400, 300, -400}, Vec3f(at), {0, 1, 0});
    camera.field_of_view = 0.01f;
    for_each_way([&](const PathOptions& way, const char* name) {
        PathPictureOptions options = few_pixels(camera, way.light_sampling ? 1024 : 16384);
        options.paths = way, options.paths.bounces = 1, options.paths.sampler = Sampler::independent;
        const Estimate found = estimate(trace(model, options));
        EXPECT_NEAR(found.mean, albedo * irradiance / pi, 3 * found.error) << name;
        EXPECT_LT(found.error, 0.02 * found.mean) << name;
    });
}

/// A room with a matte floor, blocks of rough metal and glossy plastic, under coloured lamps.
Model<float> many_lamps() {
    Material plastic = matte({0.6f, 0.2f, 0.1f}), metal = matte({0.9f, 0.8f, 0.5f});
    plastic.specular = 1, plastic.roughness = 0.3f, metal.metallic = 1, metal.roughness = 0.4f;
    std::vector<std::pair<TriangleMesh<float>, Material>> parts = {
        {square<float>(4, 0), matte(Vec3f::all(0.7f))},
        {box<float>(0.5, 0.5, 1, {1, 0, 1}), plastic},
        {box<float>(0.5, 0.5, 1, {-1, 0.5, 1}), metal}};
    for (int i = 0; i < 6; ++i) {
        Random random(11, static_cast<std::uint64_t>(i));
        const Vec3d place = random.in_cube<3>() * 4.0 - Vec3d(2, 2, -2.5);
        parts.push_back({box<float>(0.3, 0.3, 0.1, place), matte({}, Vec3f(random.in_cube<3>()) * 5.0f)});
    }
    return model_of<float>(parts);
}
/// A sky with a bright part.
Environment bright_sky() {
    std::vector<float> samples;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x) samples.push_back(y == 2 && x > 4 && x < 8 ? 20.0f : 0.3f);
    Environment sky;
    sky.panorama.pixels = std::make_shared<const Pixels>(Pixels{16, 8, 1, samples});
    sky.to_world = {Vec3d(1, 0, 0), Vec3d(0, 0, -1), Vec3d(0, 1, 0)};
    return sky;
}

/// Means of whole pictures, which differ by no more than 3 of their standard errors.
TEST(PathPhysics, WaysToLookForLightAgree) {
    Camera camera = camera_at({3, -5, 4}, {0, 0, 1});
    camera.field_of_view = 50;
    auto lamps = many_lamps(), sky = many_lamps(), both = many_lamps();
    for (Material& m : sky.materials) m.emission = {};
    sky.environment = both.environment = bright_sky();
    for (Material& m : both.materials) m.roughness *= 0.7f;
    const std::pair<const char*, Model<float>*> scenes[] = {
        {"lamps", &lamps}, {"sky", &sky}, {"both", &both}};
    for (const auto& [name, model] : scenes) {
        std::vector<Estimate> found;
        for_each_way([&, scene = model](const PathOptions& way, const char*) {
            PathPictureOptions options = few_pixels(camera, 1024);
            options.width = 24, options.height = 18;
            options.paths = way, options.paths.bounces = 6, options.paths.sampler = Sampler::independent;
            found.push_back(estimate(trace(*scene, options)));
            EXPECT_LT(found.back().error, 0.02 * found.back().mean);
        });
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < i; ++j)
                EXPECT_NEAR(found[i].mean, found[j].mean, 3 * std::hypot(found[i].error, found[j].error))
                    << name << ' ' << i << ' ' << j;
        EXPECT_LT(found[0].error, std::min(found[1].error, found[2].error) * 1.05) << name;
    }
}

}  // namespace
