/// Paths: light in closed rooms, from lights of known shape, through glass and holes, and the same bits
/// whoever finds the hits.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include <hedgerow/all.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/film/tone.h>
#include <hedgerow/scenes/looks.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/structures/brute_force.h>

#include "path_scenes.h"

using namespace hedgerow;
using namespace hedgerow::test;

namespace {

template <class T>
class Paths : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Paths, Scalars);

/// In a closed room whose walls emit Le and reflect ρ, the light after k bounces is Le·(1 − ρ^(k+1))/(1 − ρ).
TYPED_TEST(Paths, AClosedRoomHasTheLightOfItsSeries) {
    using T = TypeParam;
    const double emission = 0.5, reflected = 0.75;
    const auto model = model_of<T>({{box<T>(1, 2, 3), matte(Vec3f::all(0.75f), Vec3f::all(0.5f))}});
    const Camera camera = camera_at({0.3f, -0.4f, 0.5f}, {1, 1, 1});
    for (const std::uint32_t bounces : {0u, 1u, 3u, 40u}) {
        PathPictureOptions options = few_pixels(camera, 16);
        options.paths.bounces = bounces, options.paths.light_sampling = false;
        options.paths.roulette_from = PathOptions::never;
        const double expected = emission * (1 - std::pow(reflected, bounces + 1)) / (1 - reflected);
        const PathPicture exact = trace(model, options);
        for (std::size_t i = 0; i < exact.light.size(); ++i)
            EXPECT_NEAR(exact.light.mean(i)[0], expected, 1e-5 * expected) << bounces;
        options.samples = 512, options.paths.light_sampling = true, options.paths.roulette_from = 1;
        const Estimate with_lights = estimate(trace(model, options));
        EXPECT_NEAR(with_lights.mean, expected, 4 * with_lights.error + 1e-5) << bounces;
        EXPECT_LT(with_lights.error, 0.01 * expected);
    }
}

TYPED_TEST(Paths, ASealedRoomIsBlack) {
    using T = TypeParam;
    auto model = model_of<T>(
        {{box<T>(1, 2, 3), matte(Vec3f::all(0.9f))}, {square<T>(9, 5), matte({}, Vec3f::all(100))}});
    model.lights.push_back(PointLight{"", {4, 4, 4}, Vec3f::all(1000)});
    model.lights.push_back(DirectionalLight{"", {0, 0, -1}, Vec3f::all(1000)});
    model.environment = Environment();
    PathPictureOptions options = few_pixels(camera_at({0.3f, -0.4f, 0.5f}, {1, 2, 3}), 256);
    options.width = 40, options.height = 30;
    const PathPicture picture = trace(model, options);
    for (std::size_t i = 0; i < picture.light.size(); ++i) ASSERT_EQ(picture.light.mean(i), Vec3f());
}

/// A matte floor under a square light: Lambert's formula for polygons, and three ways to the same mean.
TYPED_TEST(Paths, ALightOfKnownShapeGivesItsIrradiance) {
    using T = TypeParam;
    const double half = 0.7, height = 1.5, radiance = 3;
    Material lamp = matte({}, Vec3f::all(3));
    lamp.double_sided = false;
    TriangleMesh<T> down = square<T>(half, height);
    for (auto& t : down.triangles) std::swap(t[1], t[2]);
    const auto model = model_of<T>({{square<T>(5, 0), matte(Vec3f::all(0.5f))}, {down, lamp}});
    // A pixel that shows the floor at a point all but one.
    Camera camera = camera_at({0.4f, 0.2f, 0.5f}, {0.4f, 0.2f, 0}, {0, 1, 0});
    camera.field_of_view = 0.1f;
    const Vec3d at(0.4, 0.2, 0);
    const Vec3d corners[] = {
        {-half, -half, height}, {half, -half, height}, {half, half, height}, {-half, half, height}};
    double irradiance = 0;
    for (int i = 0; i < 4; ++i) {
        const Vec3d a = normalized(corners[i] - at), b = normalized(corners[(i + 1) % 4] - at);
        irradiance += std::acos(dot(a, b)) * normalized(cross(a, b))[2];
    }
    irradiance = std::abs(irradiance) * radiance / 2;
    const double expected = 0.5 / 3.14159265358979 * irradiance;
    for_each_way([&](const PathOptions& way, const char* name) {
        PathPictureOptions options = few_pixels(camera, 2048);
        options.paths = way, options.paths.bounces = 1, options.paths.sampler = Sampler::independent;
        const Estimate found = estimate(trace(model, options, {.default_sky = false}));
        EXPECT_NEAR(found.mean, expected, 4 * found.error) << name;
        EXPECT_LT(found.error, 0.01 * expected) << name;
    });
}

TYPED_TEST(Paths, LightsWithoutExtentGiveTheirIrradiance) {
    using T = TypeParam;
    auto model = model_of<T>({{square<T>(5, 0), matte(Vec3f::all(0.5f))}});
    model.lights.push_back(PointLight{"", {1, 2, 2}, Vec3f::all(7)});
    model.lights.push_back(DirectionalLight{"", normalized(Vec3d(1, 0, -1)), Vec3f::all(2)});
    Camera camera = camera_at({0, 0, 0.5f}, {0, 0, 0}, {0, 1, 0});
    camera.field_of_view = 0.1f;
    const double expected = 0.5 / 3.14159265358979 * (7 / 9.0 * (2 / 3.0) + 2 * std::sqrt(0.5));
    PathPictureOptions options = few_pixels(camera, 1024);
    const Estimate found = estimate(trace(model, options));
    EXPECT_NEAR(found.mean, expected, 4 * found.error + 1e-4 * expected);
}

/// Whatever is white under a white sky cannot be seen.
TYPED_TEST(Paths, WhiteThingsUnderAWhiteSkyAreWhite) {
    using T = TypeParam;
    Material mirror = matte(Vec3f::all(1)), metal = mirror, glass = mirror, rough_glass = mirror;
    mirror.metallic = metal.metallic = 1, mirror.roughness = 0, metal.roughness = 0.6f;
    glass.transmission = rough_glass.transmission = 1, glass.thin = rough_glass.thin = false;
    glass.roughness = 0, rough_glass.roughness = 0.4f;
    const std::tuple<const char*, Material, double> things[] = {{"matte", matte(Vec3f::all(1)), 0.001},
                                                                {"mirror", mirror, 0.001},
                                                                {"metal", metal, 0.01},
                                                                {"glass", glass, 0.001},
                                                                {"rough glass", rough_glass, 0.01}};
    for (const auto& [name, material, tolerance] : things) {
        auto model = model_of<T>({{box<T>(1, 1, 1), material}});
        model.environment = Environment();
        PathPictureOptions options = few_pixels(camera_at({3, 2, 1.5f}, {0, 0, 0}), 1024);
        options.camera.field_of_view = 20;
        options.paths.bounces = 500, options.paths.roulette_from = PathOptions::never;
        const Estimate found = estimate(trace(model, options));
        EXPECT_NEAR(found.mean, 1, tolerance + 4 * found.error) << name;
        EXPECT_LT(found.error, 0.003) << name;
    }
}

/// Light of one colour remains after its distance in a body, and surfaces of an opacity let the rest through.
TYPED_TEST(Paths, BodiesAbsorbAndHolesLetThrough) {
    using T = TypeParam;
    Material glass = matte(Vec3f::all(1));
    glass.transmission = 1, glass.thin = false, glass.roughness = 0, glass.ior = 1;
    glass.attenuation_colour = {0.5f, 0.25f, 1}, glass.attenuation_distance = 2;
    auto model = model_of<T>({{box<T>(1, 1, 2), glass}});
    model.environment = Environment();
    Camera camera = camera_at({0, 0, 9}, {0, 0, 0}, {0, 1, 0});
    camera.field_of_view = 0.1f;
    const PathPicture through = trace(model, few_pixels(camera, 16));
    EXPECT_NEAR(through.light.mean(20)[0], 0.25, 1e-3) << "4 units of a body that halves the light each 2";
    EXPECT_NEAR(through.light.mean(20)[1], 0.0625, 1e-3);
    EXPECT_NEAR(through.light.mean(20)[2], 1, 1e-3);

    Material veil = matte(Vec3f::all(0));
    veil.alpha_mode = AlphaMode::blend, veil.alpha = 0.3f;
    auto veiled = model_of<T>({{square<T>(1, 0), veil}, {square<T>(1, 1), veil}});
    veiled.environment = Environment();
    const Estimate seen = estimate(trace(veiled, few_pixels(camera, 4096)));
    EXPECT_NEAR(seen.mean, 0.49, 4 * seen.error);
}

template <class T>
void expect_same(const PathPicture& a, const PathPicture& b) {
    for (std::size_t i = 0; i < a.light.size(); ++i) ASSERT_EQ(a.light.mean(i), b.light.mean(i)) << i;
}

TYPED_TEST(Paths, HaveTheSameBitsWhoeverFindsTheHits) {
    using T = TypeParam;
    const auto model = generate_model<T>(parse_scene_spec("gen:cornell-box"));
    const ModelScene<T> scene(model, serial_executor());
    const SceneLights<T> lights(scene);
    PathPictureOptions options = few_pixels(*camera_for("cornell-box"), 4);
    options.width = 30, options.height = 20;
    const PathPicture one =
        trace_paths(PathScene<T>{scene, lights, scene.tracer()}, by(serial_executor(), options));
    const auto expect = [&](const auto& index, const char* name) {
        SCOPED_TRACE(name);
        const IndexTracer tracer(index);
        expect_same<T>(one,
                       trace_paths(PathScene<T>{scene, lights, tracer}, by(default_executor(), options)));
    };
    expect(build<BruteForce>(scene.instances()), "brute force");
    expect(build<KdTree>(scene.instances()), "kd-tree");
    expect(build<Grid>(scene.instances()), "grid");
    expect(build<Bvh>(scene.instances()), "bvh");
    options.paths.seed = 1;
    const PathPicture other =
        trace_paths(PathScene<T>{scene, lights, scene.tracer()}, by(serial_executor(), options));
    EXPECT_NE(other.light.mean(310), one.light.mean(310)) << "another seed is another picture";
}

/// One by one, and many at once, however many; tiles and blocks of pixels that the picture cuts.
TYPED_TEST(Paths, HaveTheSameBitsHoweverManyAreFollowedAtOnce) {
    using T = TypeParam;
    auto model = generate_model<T>(parse_scene_spec("gen:cornell-box"));
    Material& floor = model.materials[0];
    floor.alpha_mode = AlphaMode::blend, floor.alpha = 0.8f;
    model.materials[1].metallic = 1, model.materials[1].roughness = 0.3f;
    const ModelScene<T> scene(model, serial_executor());
    const SceneLights<T> lights(scene);
    for (const auto& [width, height, samples] : {std::tuple(45, 29, 5u), {1, 1, 64u}, {300, 9, 1u}}) {
        PathPictureOptions options = few_pixels(*camera_for("cornell-box"), samples);
        options.width = width, options.height = height, options.in_flight = 0;
        const PathScene<T> parts{scene, lights, scene.tracer()};
        const PathPicture one_by_one = trace_paths(parts, by(serial_executor(), options));
        EXPECT_EQ(one_by_one.light.samples(0), samples);
        for (const std::size_t in_flight : {1u, 7u, 1024u, 5000u}) {
            SCOPED_TRACE(in_flight);
            options.in_flight = in_flight;
            expect_same<T>(one_by_one, trace_paths(parts, by(default_executor(), options)));
        }
    }
}

/// Tables of compensation are computed only where they change a path (Values.TablesChangeNothing...).
TEST(PathSurfaces, HaveFacetsWhereRoughOnesReflectOrTransmit) {
    const auto have = [](float roughness, float metallic, float specular, float transmission) {
        Material m = matte(Vec3f::all(0.5f));
        m.roughness = roughness, m.metallic = metallic, m.specular = specular, m.transmission = transmission;
        const auto model = model_of<float>({{square<float>(1, 0), matte({})}, {square<float>(1, 1), m}});
        const ModelScene<float> scene(model, serial_executor());
        return PathSurfaces<float>(scene).has_facets();
    };
    EXPECT_FALSE(have(1, 0, 0, 0));
    EXPECT_FALSE(have(0, 1, 1, 1));
    for (const float roughness : {0.01f, 1.0f}) {
        EXPECT_TRUE(have(roughness, 0.1f, 0, 0));
        EXPECT_TRUE(have(roughness, 0, 0.1f, 0));
        EXPECT_TRUE(have(roughness, 0, 0, 0.1f));
    }
}

/// The Gaussian's samples have its deviation within three of them, and blur an edge of the picture by as
/// much.
TEST(PixelFilters, HaveTheirShape) {
    const PixelSequence sequence(Sampler::sobol, 3, 0);
    double mean = 0, squares = 0;
    constexpr int n = 1 << 14;
    for (std::uint32_t i = 0; i < n; ++i) {
        const UnitPair p = sequence.pair(i, 0);
        EXPECT_EQ(place_in_pixel(PixelFilter::box, p.x, p.y), Vec2f(p.x, p.y));
        const Vec2f at = place_in_pixel(PixelFilter::gaussian, p.x, p.y) - Vec2f(0.5f, 0.5f);
        EXPECT_LE(length(at), 1.5001f);
        mean += double(at[0] + at[1]), squares += double(length2(at));
    }
    EXPECT_NEAR(mean / n, 0, 2e-3);
    // The mean of r² of a Gaussian that ends at r = R is 2σ² less the part beyond.
    const double beyond = std::exp(-4.5), expected = 2 * 0.25 - 2.25 * beyond / (1 - beyond);
    EXPECT_NEAR(squares / n, expected, 2e-3);
}
TEST(Tones, KeepColoursAndBendHighlights) {
    EXPECT_EQ(toned(Tone::linear, {-1, 0.5f, 7}), Vec3f(0, 0.5f, 1));
    // Colours that reflect at least 4% everywhere lose just that.
    const Vec3f grey = toned(Tone::neutral, {0.2f, 0.3f, 0.5f});
    EXPECT_NEAR(grey[0], 0.16f, 1e-6f);
    EXPECT_NEAR(grey[2], 0.46f, 1e-6f);
    float before = 0;
    for (float light = 0; light < 100; light = light * 1.1f + 0.01f) {
        const Vec3f c = toned(Tone::neutral, Vec3f::all(light));
        EXPECT_GE(c[0], before) << light;
        EXPECT_LE(c[0], 1) << light;
        before = c[0];
        const Vec3f red = toned(Tone::neutral, {light, light / 4, light / 8});
        EXPECT_TRUE(red[0] >= red[1] && red[1] >= red[2] && red[2] >= 0 && red[0] <= 1) << light;
    }
    EXPECT_GT(before, 0.99f);
    const Vec3f bright = toned(Tone::neutral, {1000, 1, 1});
    EXPECT_GT(bright[1], 0.9f) << "very bright colours turn white";
}

/// Interrupted at any moment and continued, by other threads and in other steps.
TYPED_TEST(Paths, GoOnWithTheSameBits) {
    using T = TypeParam;
    const auto model = generate_model<T>(parse_scene_spec("gen:cornell-box"));
    const ModelScene<T> scene(model, serial_executor());
    const SceneLights<T> lights(scene);
    const PathScene<T> parts{scene, lights, scene.tracer()};
    PathPictureOptions options = few_pixels(*camera_for("cornell-box"), 23);
    options.width = 330, options.height = 80;
    const PathPicture at_once = trace_paths(parts, by(default_executor(), options));
    PathPicture in_steps(options.width, options.height);
    for (const std::uint32_t until : {1u, 2u, 2u, 7u, 20u})
        add_samples(in_steps, until, parts, by(default_executor(), options));
    EXPECT_EQ(in_steps.samples, 20u);
    std::size_t stops = 0;
    while (in_steps.samples < 23) {
        // Stop at the first report, which is of pixels that had not all samples before.
        std::atomic<bool> stop{false};
        add_samples(in_steps, 23, parts, by(serial_executor(), options),
                    {[&](std::uint64_t, std::uint64_t) { stop = true; }, &stop});
        ASSERT_LT(++stops, 100u) << "work that is stopped again and again goes on";
    }
    EXPECT_GT(stops, 1u);
    expect_same<T>(at_once, in_steps);
    for (std::size_t i = 0; i < at_once.light.size(); ++i)
        ASSERT_EQ(at_once.light.standard_error(i), in_steps.light.standard_error(i));
    options.width = 8;
    EXPECT_THROW(add_samples(in_steps, 30, parts, by(serial_executor(), options)), InputError);
}

/// A single tile may take long, so work ends within it, too.
TEST(PathSteps, EndWithinATile) {
    const auto model = model_of<float>({{square<float>(1, 0), matte(Vec3f::all(0.5f))}});
    const ModelScene<float> scene(model, serial_executor());
    const SceneLights<float> lights(scene);
    const PathScene<float> parts{scene, lights, scene.tracer()};
    const PathPictureOptions options = few_pixels(camera_at({0, -1, 2}, {0, 0, 0}), 4096);
    const PathPicture at_once = trace_paths(parts, by(serial_executor(), options));
    PathPicture in_steps(options.width, options.height);
    add_samples(in_steps, 2048, parts, by(serial_executor(), options));
    std::atomic<bool> stop{false};
    add_samples(in_steps, 4096, parts, by(serial_executor(), options),
                {[&](std::uint64_t, std::uint64_t) { stop = true; }, &stop});
    EXPECT_EQ(in_steps.samples, 2048u);
    EXPECT_GT(in_steps.mean_samples(), 2048);
    EXPECT_LT(in_steps.mean_samples(), 4096);
    add_samples(in_steps, 4096, parts, by(default_executor(), options));
    expect_same<float>(at_once, in_steps);
}

/// Colour and normal of what scatters first, straight ahead and in a mirror, and nothing where the sky is.
TYPED_TEST(Paths, FirstSurfacesAreThoseThatScatter) {
    using T = TypeParam;
    Material mirror = matte({0.5f, 1, 1});
    mirror.metallic = 1, mirror.roughness = 0;
    TriangleMesh<T> above = square<T>(50, 8);
    for (auto& t : above.triangles) std::swap(t[1], t[2]);
    auto model = model_of<T>({{square<T>(1, 0), mirror}, {above, matte({0.8f, 0.4f, 0.2f})}});
    model.objects[0].attributes.texture_coordinates.push_back(
        {std::vector<Vec2f>(4, Vec2f(0.25f, 0.75f)), {}});
    const ModelScene<T> scene(model, serial_executor());
    const SceneLights<T> lights(scene);
    const PathScene<T> parts{scene, lights, scene.tracer()};
    PathPictureOptions options = few_pixels(camera_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0}), 4);
    options.width = options.height = 3;
    options.camera.field_of_view = 70;
    const auto down = first_surfaces(parts, 4, by(default_executor(), options));
    EXPECT_LT(length(down[4].albedo - Vec3f(0.4f, 0.4f, 0.2f)), 1e-6f)
        << "what the mirror shows, in its colour";
    EXPECT_LT(length(down[4].normal - Vec3f(0, 0, -1)), 1e-6f);
    EXPECT_NEAR(down[4].depth, 4, 0.5);
    EXPECT_EQ(down[4].instance, 0u);
    EXPECT_LT(length(down[4].uv - Vec2f(0.25f, 0.75f)), 1e-6f) << "of the mirror";
    EXPECT_EQ(down[0].albedo, Vec3f()) << "beside the mirror";
    EXPECT_EQ(down[0].normal, Vec3f());
    EXPECT_EQ(down[0].depth, std::numeric_limits<float>::infinity());
    options.camera.target = {0, 0, 8};
    const auto up = first_surfaces(parts, 1, by(serial_executor(), options));
    EXPECT_LT(length(up[4].albedo - Vec3f(0.8f, 0.4f, 0.2f)), 1e-6f);
    EXPECT_EQ(up[4].instance, 1u);
}

TYPED_TEST(Paths, RefuseOptionsWithoutAMeaning) {
    using T = TypeParam;
    const auto model = model_of<T>({{square<T>(1, 0), matte(Vec3f::all(0.5f))}});
    const auto refused = [&](auto change) {
        PathPictureOptions options = few_pixels(camera_at({0, 0, 1}, {0, 0, 0}, {0, 1, 0}), 1);
        change(options);
        EXPECT_THROW(trace(model, options), InputError);
    };
    refused([](PathPictureOptions& o) { o.width = 0; });
    refused([](PathPictureOptions& o) { o.samples = 0; });
    refused([](PathPictureOptions& o) { o.camera.field_of_view = 0; });
    refused([](PathPictureOptions& o) { o.paths.light_sampling = o.paths.material_sampling = false; });
    refused([](PathPictureOptions& o) { o.paths.least_throughput = 1; });
    refused([](PathPictureOptions& o) { o.paths.brightest_indirect = std::nanf(""); });
}

}  // namespace
