/// Paths in scenes that are wrong or extreme: each is refused by name or has finite light everywhere.
#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <string>

#include "path_scenes.h"

using namespace hedgerow;
using namespace hedgerow::test;

namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity(),
                huge = std::numeric_limits<float>::max();

/// A box in a bright room.
Model<float> box_in_room(const Material& of_box) {
    return model_of<float>(
        {{box<float>(1, 1, 1), of_box}, {box<float>(5, 5, 5), matte(Vec3f::all(0.5f), Vec3f::all(1))}});
}
PathPicture look(const Model<float>& model, const Vec3f& eye = {3, 2, 1.5f}) {
    return trace(model, few_pixels(camera_at(eye, {0, 0, 0.1f}), 16));
}
void expect_finite(const PathPicture& picture) {
    for (std::size_t i = 0; i < picture.light.size(); ++i) {
        ASSERT_TRUE(finite(picture.light.mean(i))) << i;
        ASSERT_EQ(max(picture.light.mean(i), Vec3f()), picture.light.mean(i)) << i;
        ASSERT_TRUE(std::isfinite(picture.light.standard_error(i))) << i;
    }
}

TEST(BadPaths, MaterialsOutOfRangeGiveFiniteLight) {
    for (const float bad : {nan, inf, -inf, huge, -huge, -1.0f, 1e-40f, 2.0f, 1e30f}) {
        SCOPED_TRACE(bad);
        const std::vector<std::function<void(Material&)>> changes = {
            [&](Material& m) {
                m.base_colour = {bad, 0.5f, 1};
            },
            [&](Material& m) { m.metallic = bad; },
            [&](Material& m) { m.roughness = bad; },
            [&](Material& m) { m.ior = bad; },
            [&](Material& m) { m.specular = bad; },
            [&](Material& m) { m.transmission = bad; },
            [&](Material& m) { m.attenuation_distance = bad; },
            [&](Material& m) { m.normal_scale = bad; },
            [&](Material& m) {
                m.specular_colour = {1, bad, 1};
            },
            [&](Material& m) {
                m.attenuation_colour = {bad, bad, 1};
            },
            [&](Material& m) { m.alpha_mode = AlphaMode::blend, m.alpha = bad; },
            [&](Material& m) { m.alpha_mode = AlphaMode::mask, m.alpha_cutoff = bad; }};
        for (std::size_t i = 0; i < changes.size(); ++i)
            for (const bool glass : {false, true}) {
                Material m = matte(Vec3f::all(0.8f));
                m.specular = 1, m.roughness = 0.3f;
                if (glass) m.transmission = 1, m.thin = false, m.attenuation_distance = 1;
                changes[i](m);
                SCOPED_TRACE(i);
                const PathPicture picture = look(box_in_room(m));
                expect_finite(picture);
                EXPECT_EQ(picture.dropped(), 0u);
            }
    }
}

TEST(BadPaths, EmissionThatIsNoneIsRefused) {
    for (const float bad : {nan, inf, -1.0f})
        for (const Vec3f& emission : {Vec3f(bad, 1, 1), Vec3f(1, 1, bad), Vec3f::all(bad)}) {
            EXPECT_THROW(look(box_in_room(matte(Vec3f::all(0.8f), emission))), InputError)
                << emission[0] << ' ' << emission[2];
            auto model = box_in_room(matte(Vec3f::all(0.8f)));
            model.lights.push_back(PointLight{"", {2, 2, 2}, emission});
            EXPECT_THROW(look(model), InputError);
            model.lights.clear();
            model.environment = Environment();
            model.environment->radiance = emission;
            EXPECT_THROW(look(model), InputError);
        }
    auto model = box_in_room(matte(Vec3f::all(0.8f)));
    for (const Vec3d& nowhere : {Vec3d(double(nan), 0, 0), Vec3d(0, 0, double(inf))}) {
        model.lights = {PointLight{"", nowhere, Vec3f::all(1)}};
        EXPECT_THROW(look(model), InputError);
    }
}

/// The message with which a model is refused.
std::string refusal_of(const Model<float>& model) {
    try {
        look(model);
    } catch (const InputError& e) {
        return e.what();
    }
    return "nothing";
}

TEST(BadPaths, LightsThatAreNoneAreNamedAsTheModelNamesThem) {
    const std::string no_light = "its emission must be finite";
    auto model = box_in_room(matte(Vec3f::all(0.8f), {1, -1, 1}));
    EXPECT_EQ(refusal_of(model).find("light 0: " + no_light), 0u) << refusal_of(model);
    model.objects[0].name = "box";
    EXPECT_EQ(refusal_of(model).find("light 'box': " + no_light), 0u) << refusal_of(model);
    model.materials[0].name = "neon";
    EXPECT_EQ(refusal_of(model).find("light 'neon': " + no_light), 0u) << refusal_of(model);
    model.materials[0].emission = {};
    const Vec3d down(0, 0, -1);
    const Light bad[] = {PointLight{"bulb", {}, {nan, 1, 1}}, SpotLight{"bulb", {}, down, {nan, 1, 1}},
                         DirectionalLight{"bulb", down, {nan, 1, 1}}};
    for (const Light& light : bad) {
        model.lights = {light};
        EXPECT_EQ(refusal_of(model).find("light 'bulb': " + no_light), 0u) << refusal_of(model);
    }
    model.lights = {DirectionalLight{"bulb", {}, Vec3f::all(1)}};
    EXPECT_EQ(refusal_of(model).find("light 'bulb': its direction"), 0u) << refusal_of(model);
}

/// A panorama of one bad texel is named, where it lies.
TEST(BadPaths, SkiesWithBadTexelsAreRefused) {
    for (const float bad : {nan, inf, -1.0f}) {
        std::vector<float> samples(8 * 4 * 3, 1.0f);
        samples[(2 * 8 + 5) * 3] = bad;
        auto model = box_in_room(matte(Vec3f::all(0.8f)));
        model.environment = Environment();
        model.environment->panorama.pixels = std::make_shared<const Pixels>(Pixels{8, 4, 3, samples});
        try {
            look(model);
            FAIL() << bad;
        } catch (const InputError& e) {
            EXPECT_NE(std::string(e.what()).find("(column 5, row 2)"), std::string::npos) << e.what();
        }
    }
}

TEST(BadPaths, LampsWithoutAreaGiveNoLight) {
    const Material lamp = matte({}, Vec3f::all(9));
    TriangleMesh<float> line{{{0, 0, 2}, {1, 0, 2}, {2, 0, 2}}, {{0, 1, 2}, {0, 0, 1}}, {}};
    const auto model = model_of<float>({{box<float>(1, 1, 1), matte(Vec3f::all(0.8f))}, {line, lamp}});
    const ModelScene<float> scene(model, serial_executor());
    const SceneLights<float> lights(scene, {.default_sky = false});
    EXPECT_TRUE(lights.emitters().empty());
    EXPECT_EQ(lights.emitters().without_area(), 2u);
    const PathPicture picture =
        trace(model, few_pixels(camera_at({3, 2, 1.5f}, {0, 0, 0}), 16), {.default_sky = false});
    for (std::size_t i = 0; i < picture.light.size(); ++i) EXPECT_EQ(picture.light.mean(i), Vec3f());
}

TEST(BadPaths, EyesInWallsSeeSomethingFinite) {
    Material glass = matte(Vec3f::all(1));
    glass.transmission = 1, glass.thin = false, glass.roughness = 0.2f;
    for (const Material& m : {matte(Vec3f::all(0.8f)), glass})
        for (const Vec3f& eye : {Vec3f(1, 0, 0), Vec3f(1, 1, 1), Vec3f(1, 1, 0), Vec3f(0, 0, 0),
                                 Vec3f(5, 5, 5), Vec3f(5, 0, 0), Vec3f(1 + 1e-7f, 0, 0), Vec3f(1e6f, 0, 0)})
            expect_finite(look(box_in_room(m), eye));
    EXPECT_THROW(look(box_in_room(matte({})), {0, 0, 0.1f}), InputError) << "the eye is at the target";
    EXPECT_THROW(look(box_in_room(matte({})), {nan, 0, 0}), InputError);
}

/// Light of which a sum is beyond the range of floats: such samples are dropped and counted.
TEST(BadPaths, SamplesThatAreNotFiniteAreDroppedAndCounted) {
    const auto model = model_of<float>({{box<float>(1, 1, 1), matte(Vec3f::all(1), Vec3f::all(huge))}});
    PathPictureOptions options = few_pixels(camera_at({0.1f, 0.2f, 0.3f}, {1, 1, 1}), 16);
    for (const bool light_sampling : {false, true}) {
        options.paths.light_sampling = light_sampling;
        const PathPicture picture = trace(model, options);
        expect_finite(picture);
        EXPECT_GT(picture.dropped(), 16u * 48 / 2);
        EXPECT_EQ(picture.samples, 16u) << "those that were dropped count, as black ones";
    }
    options.paths.bounces = 0;
    EXPECT_EQ(trace(model, options).dropped(), 0u);
}

/// A tracer whose hits are now and then no numbers, as of another ray tracer with a fault.
class FaultyTracer final : public Tracer<float> {
public:
    explicit FaultyTracer(const Tracer<float>& sound) : sound_(sound) {}
    Box3f bounds() const override { return sound_.bounds(); }
    KernelUse closest_hits(const RayArray<float, 3>& rays, std::span<Hit<float>> hits,
                           std::span<Visits> visits, const Filter& filter) const override {
        const KernelUse use = sound_.closest_hits(rays, hits, visits, filter);
        for (std::size_t i = 0; i < hits.size(); ++i) {
            // The fault hangs on the ray, so that it is the same for any batches.
            const auto bits = std::bit_cast<std::uint32_t>(rays[i].direction[0]);
            if (bits % 5 == 0) hits[i].t = nan;
            if (bits % 7 == 0) hits[i].u = nan;
        }
        return use;
    }
    KernelUse any_hits(const RayArray<float, 3>& rays, std::span<bool> hits, std::span<Visits> visits,
                       const Filter& filter) const override {
        return sound_.any_hits(rays, hits, visits, filter);
    }
    void first_hits(const RayArray<float, 3>& rays, std::size_t k, HitLists<float>& lists,
                    const AfterHits& after, const Filter& filter) const override {
        sound_.first_hits(rays, k, lists, after, filter);
    }

private:
    const Tracer<float>& sound_;
};

TEST(BadPaths, HitsThatAreNoNumbersLeaveNoneInThePicture) {
    Material glass = matte(Vec3f::all(1));
    glass.transmission = 1, glass.thin = false, glass.roughness = 0.2f;
    glass.attenuation_colour = {0.5f, 0.5f, 0.5f}, glass.attenuation_distance = 1;
    for (const Material& m : {matte(Vec3f::all(0.8f)), glass}) {
        const auto model = box_in_room(m);
        const ModelScene<float> scene(model, serial_executor());
        const SceneLights<float> lights(scene);
        const FaultyTracer faulty(scene.tracer());
        expect_finite(trace_paths(PathScene<float>{scene, lights, faulty},
                                  by(serial_executor(), few_pixels(camera_at({3, 2, 1.5f}, {0, 0, 0}), 64))));
    }
}

}  // namespace
