/// Paths: light in closed rooms, from lights of known shape, through glass and holes, and the same bits
/// whoever finds the hits.
#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <cmath>

#include <hedgerow/all.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/film/tone.h>
#include <hedgerow/render/integrators/path_picture.h>
#include <hedgerow/scenes/looks.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/structures/brute_force.h>

using namespace hedgerow;

namespace {

template <class T>
class Paths : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Paths, Scalars);

Material matte(const Vec3f& colour, const Vec3f& emission = {}) {
    Material m;
    m.base_colour = colour, m.emission = emission;
    return m;
}
/// One object a mesh, each with its material.
template <class T>
Model<T> model_of(const std::vector<std::pair<TriangleMesh<T>, Material>>& parts) {
    Model<T> model;
    for (const auto& [mesh, material] : parts) {
        Object<T> object;
        object.mesh = mesh;
        object.material = static_cast<std::uint32_t>(model.materials.size());
        model.instances.push_back({"", static_cast<std::uint32_t>(model.objects.size()), {}});
        model.objects.push_back(object);
        model.materials.push_back(material);
    }
    return model;
}
/// A closed box around the origin, its fronts outward.
template <class T>
TriangleMesh<T> box(double x, double y, double z, const Vec3d& middle = {}) {
    TriangleMesh<T> mesh;
    for (int i = 0; i < 8; ++i)
        mesh.vertices.push_back(
            Vec<T, 3>(middle + Vec3d((i & 1) != 0 ? x : -x, (i & 2) != 0 ? y : -y, (i & 4) != 0 ? z : -z)));
    const std::uint32_t faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& f : faces)
        mesh.triangles.push_back({f[0], f[1], f[2]}), mesh.triangles.push_back({f[0], f[2], f[3]});
    return mesh;
}
/// A square across z, with its front up.
template <class T>
TriangleMesh<T> square(double half, double z) {
    const T a = static_cast<T>(half), h = static_cast<T>(z);
    return {{{-a, -a, h}, {a, -a, h}, {a, a, h}, {-a, a, h}}, {{0, 1, 2}, {0, 2, 3}}, {}};
}
Camera camera_at(const Vec3f& eye, const Vec3f& target, const Vec3f& up = {0, 0, 1}) {
    Camera c;
    c.eye = eye, c.target = target, c.up = up, c.field_of_view = 90;
    return c;
}
PathPictureOptions few_pixels(const Camera& camera, std::uint32_t samples) {
    PathPictureOptions o;
    o.camera = camera, o.width = 8, o.height = 6, o.samples = samples;
    return o;
}
template <class T>
PathPicture trace(const Model<T>& model, const PathPictureOptions& options,
                  SceneLightsOptions of_lights = {}) {
    const ModelScene<T> scene(model, serial_executor());
    of_lights.compensates = options.paths.material_sampling;
    const SceneLights<T> lights(scene, of_lights);
    return trace_paths(PathScene<T>{scene, lights, scene.tracer()}, options, default_executor());
}
/// The mean of all pixels and samples, and its standard error, of the first colour.
struct Estimate {
    double mean = 0, error = 0;
};
Estimate estimate(const PathPicture& picture) {
    double sum = 0, squares = 0;
    const auto n = double(picture.light.size());
    for (std::size_t i = 0; i < picture.light.size(); ++i) {
        const auto value = double(picture.light.mean(i)[0]);
        const auto error = double(picture.light.standard_error(i));
        sum += value, squares += error * error;
    }
    return {sum / n, std::sqrt(squares) / n};
}
/// Three ways to look for light.
void for_each_way(const std::function<void(PathOptions&, const char*)>& look) {
    const std::pair<bool, bool> ways[] = {{true, true}, {true, false}, {false, true}};
    const char* const names[] = {"both", "light sampling", "material sampling"};
    for (int i = 0; i < 3; ++i) {
        PathOptions o;
        o.light_sampling = ways[i].first, o.material_sampling = ways[i].second;
        look(o, names[i]);
    }
}

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
        trace_paths(PathScene<T>{scene, lights, scene.tracer()}, options, serial_executor());
    const auto expect = [&](const auto& index, const char* name) {
        SCOPED_TRACE(name);
        const IndexTracer tracer(index);
        expect_same<T>(one, trace_paths(PathScene<T>{scene, lights, tracer}, options, default_executor()));
    };
    expect(build<BruteForce>(scene.instances()), "brute force");
    expect(build<KdTree>(scene.instances()), "kd-tree");
    expect(build<Grid>(scene.instances()), "grid");
    expect(build<Bvh>(scene.instances()), "bvh");
    options.paths.seed = 1;
    const PathPicture other =
        trace_paths(PathScene<T>{scene, lights, scene.tracer()}, options, serial_executor());
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
        const PathPicture one_by_one = trace_paths(parts, options, serial_executor());
        EXPECT_EQ(one_by_one.light.samples(0), samples);
        for (const std::size_t in_flight : {1u, 7u, 1024u, 5000u}) {
            SCOPED_TRACE(in_flight);
            options.in_flight = in_flight;
            expect_same<T>(one_by_one, trace_paths(parts, options, default_executor()));
        }
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

/// A hash of the linear light of a picture, bit by bit.
std::uint64_t hash_of(const PathPicture& picture) {
    std::uint64_t hash = 0;
    for (std::size_t i = 0; i < picture.light.size(); ++i)
        for (const float x : picture.light.mean(i).data)
            hash = scattered(hash + std::bit_cast<std::uint32_t>(x));
    return hash;
}
/// Pictures of 64 by 64 pixels that were looked at. Another processor, compiler or instruction set has these
/// bits.
TEST(PathPictures, HaveTheseBitsEverywhere) {
    const auto expect = [](const char* scene, std::uint64_t hash, auto change) {
        auto model = generate_model<float>(parse_scene_spec(scene));
        PathPictureOptions options;
        options.width = options.height = 64, options.samples = 8;
        const std::string name = parse_scene_spec(scene).name;
        change(model, options);
        const ModelScene<float> shown(model, default_executor());
        options.camera = camera_for(name).value_or(automatic_camera(shown.bounds()));
        const SceneLights<float> lights(shown, {.up = options.camera.up});
        const PathScene<float> parts{shown, lights, shown.tracer()};
        EXPECT_EQ(hash_of(trace_paths(parts, options, default_executor())), hash) << scene;
    };
    const auto as_it_is = [](Model<float>&, PathPictureOptions&) {};
    const auto of_glass = [](Model<float>& model, PathPictureOptions&) {
        for (Material& m : model.materials) {
            if (m.emission[0] > 0) continue;
            m.transmission = 1, m.thin = false, m.roughness = 0.2f;
            m.attenuation_colour = {0.5f, 0.7f, 0.9f}, m.attenuation_distance = 0.5f;
        }
    };
    const auto of_metal = [](Model<float>& model, PathPictureOptions& o) {
        for (Material& m : model.materials) m.metallic = 0.7f, m.roughness = 0.3f;
        o.paths.sampler = Sampler::independent;
    };
    expect("gen:cornell-box", 13072849632850776395u, as_it_is);
    expect("gen:cornell-box", 17444000207230064607u, of_metal);
    expect("gen:teapot-in-stadium:3000", 7045098765254368040u, as_it_is);
    expect("gen:teapot:3000", 13287473023831914717u, of_glass);
    expect("gen:teapot:3000", 15401192420194816110u, of_metal);
    expect("gen:grass:3000", 17898102663082475837u, as_it_is);
    expect("gen:hairball:3000", 4965994997278206487u, as_it_is);
    expect("gen:soup:100", 7654664720023267110u, of_glass);
}

/// Interrupted at any moment and continued, by other threads and in other steps.
TYPED_TEST(Paths, GoOnWithTheSameBits) {
    using T = TypeParam;
    const auto model = generate_model<T>(parse_scene_spec("gen:cornell-box"));
    const ModelScene<T> scene(model, serial_executor());
    const SceneLights<T> lights(scene);
    const PathScene<T> parts{scene, lights, scene.tracer()};
    PathPictureOptions options = few_pixels(*camera_for("cornell-box"), 23);
    options.width = 330, options.height = 20;
    const PathPicture at_once = trace_paths(parts, options, default_executor());
    PathPicture in_steps(options.width, options.height);
    for (const std::uint32_t until : {1u, 2u, 2u, 7u, 20u})
        add_samples(in_steps, until, parts, options, default_executor());
    EXPECT_EQ(in_steps.samples, 20u);
    std::size_t stops = 0;
    while (in_steps.samples < 23) {
        // Stop after a tile.
        std::atomic<bool> stop{false};
        add_samples(in_steps, 23, parts, options, serial_executor(),
                    {[&](std::uint64_t done, std::uint64_t) { stop = done > 0; }, &stop});
        ++stops;
    }
    EXPECT_GT(stops, 1u);
    expect_same<T>(at_once, in_steps);
    for (std::size_t i = 0; i < at_once.light.size(); ++i)
        ASSERT_EQ(at_once.light.standard_error(i), in_steps.light.standard_error(i));
    options.width = 8;
    EXPECT_THROW(add_samples(in_steps, 30, parts, options, serial_executor()), InputError);
}

/// Colour and normal of what scatters first, straight ahead and in a mirror, and nothing where the sky is.
TYPED_TEST(Paths, FirstSurfacesAreThoseThatScatter) {
    using T = TypeParam;
    Material mirror = matte({0.5f, 1, 1});
    mirror.metallic = 1, mirror.roughness = 0;
    TriangleMesh<T> above = square<T>(50, 8);
    for (auto& t : above.triangles) std::swap(t[1], t[2]);
    const auto model = model_of<T>({{square<T>(1, 0), mirror}, {above, matte({0.8f, 0.4f, 0.2f})}});
    const ModelScene<T> scene(model, serial_executor());
    const SceneLights<T> lights(scene);
    const PathScene<T> parts{scene, lights, scene.tracer()};
    PathPictureOptions options = few_pixels(camera_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0}), 4);
    options.width = options.height = 3;
    options.camera.field_of_view = 70;
    const auto down = first_surfaces(parts, options, 4, default_executor());
    EXPECT_LT(length(down[4].albedo - Vec3f(0.4f, 0.4f, 0.2f)), 1e-6f)
        << "what the mirror shows, in its colour";
    EXPECT_LT(length(down[4].normal - Vec3f(0, 0, -1)), 1e-6f);
    EXPECT_NEAR(down[4].depth, 4, 0.5);
    EXPECT_EQ(down[4].instance, 0u);
    EXPECT_EQ(down[0].albedo, Vec3f()) << "beside the mirror";
    EXPECT_EQ(down[0].normal, Vec3f());
    EXPECT_EQ(down[0].depth, std::numeric_limits<float>::infinity());
    options.camera.target = {0, 0, 8};
    const auto up = first_surfaces(parts, options, 1, serial_executor());
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
