/// Direct and indirect light apart: together they are the light, direct light is that of one bounce, and both
/// have the same bits however paths are followed.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <string>

#include <hedgerow/render/camera/presets.h>
#include <hedgerow/scenes/looks.h>

#include "path_scenes.h"

using namespace hedgerow;
using namespace hedgerow::test;

namespace {

template <class T>
class DirectLight : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(DirectLight, Scalars);

/// The Cornell box with a wall of rough metal and a floor that lets some light through.
template <class T>
struct Box {
    Model<T> model;
    ModelScene<T> scene;
    SceneLights<T> lights;
    PathScene<T> parts;
    PathPictureOptions options;

    Box()
        : model(changed_box()),
          scene(model, serial_executor()),
          lights(scene),
          parts{scene, lights, scene.tracer()} {
        options.camera = *camera_for("cornell-box");
        options.width = 24, options.height = 20, options.samples = 12;
        options.keeps_direct = true;
    }
    PathPicture picture() const { return trace_paths(parts, by(default_executor(), options)); }

private:
    static Model<T> changed_box() {
        auto model = generate_model<T>(parse_scene_spec("gen:cornell-box"));
        model.materials[0].alpha_mode = AlphaMode::blend, model.materials[0].alpha = 0.8f;
        model.materials[1].metallic = 1, model.materials[1].roughness = 0.3f;
        return model;
    }
};

void expect_same(const LightHalves& a, const LightHalves& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(a.mean(i), b.mean(i)) << i;
        ASSERT_EQ(a.samples(i), b.samples(i)) << i;
        ASSERT_EQ(a.standard_error(i), b.standard_error(i)) << i;
    }
}
void expect_same(const PathPicture& a, const PathPicture& b) {
    expect_same(a.light, b.light), expect_same(a.direct, b.direct);
}

TYPED_TEST(DirectLight, IsTheLightWithIndirectLight) {
    Box<TypeParam> box;
    const PathPicture with = box.picture();
    box.options.keeps_direct = false;
    const PathPicture plain = box.picture();
    expect_same(with.light, plain.light);
    EXPECT_FALSE(plain.keeps_direct());
    std::size_t lit = 0;
    for (std::size_t i = 0; i < with.light.size(); ++i) {
        const Vec3f light = with.light.mean(i), direct = with.direct.mean(i), indirect = with.indirect(i);
        for (int k = 0; k < 3; ++k) {
            ASSERT_NEAR(direct[k] + indirect[k], light[k], 1.2e-7f * light[k]) << i;
            ASSERT_GE(direct[k], 0) << i;
            ASSERT_GE(indirect[k], 0) << i;
        }
        lit += max_component(direct) > 0 && max_component(indirect) > 0;
    }
    EXPECT_GT(lit, with.light.size() / 2);
}

/// Paths of more bounces begin like those of one, so no bit differs; the limit of brightness is of indirect
/// light alone.
TYPED_TEST(DirectLight, IsThatOfOneBounce) {
    for (const Division division : {Division::even, Division::halves})
        for_each_way([&](const PathOptions& way, const char* name) {
            for (const std::uint32_t roulette_from : {0u, 3u}) {
                SCOPED_TRACE(name + std::string(", roulette from ") + std::to_string(roulette_from));
                Box<TypeParam> box;
                box.options.division = division, box.options.paths = way;
                box.options.paths.roulette_from = roulette_from;
                const PathPicture free = box.picture();
                box.options.paths.brightest_indirect = 0.01f;
                const PathPicture dim = box.picture();
                box.options.paths.bounces = 1;
                const PathPicture once = box.picture();
                expect_same(free.direct, once.light), expect_same(dim.direct, once.light);
                Vec3f all, most;
                for (std::size_t i = 0; i < free.light.size(); ++i) {
                    ASSERT_EQ(once.indirect(i), Vec3f()) << i;
                    all = max(all, free.indirect(i)), most = max(most, dim.indirect(i));
                }
                EXPECT_GT(max_component(all), 0.1f);
                EXPECT_GT(max_component(most), 0);
                EXPECT_LT(max_component(most), max_component(all) / 2);
            }
        });
}

/// In a closed room whose walls emit Le and reflect ρ, light that is scattered k times is Le·ρ^k.
TYPED_TEST(DirectLight, OfAClosedRoomIsTheBeginningOfItsSeries) {
    using T = TypeParam;
    const double emission = 0.5, reflected = 0.75;
    const auto model = model_of<T>({{box<T>(1, 2, 3), matte(Vec3f::all(0.75f), Vec3f::all(0.5f))}});
    for (const std::uint32_t bounces : {0u, 1u, 2u, 3u, 40u}) {
        PathPictureOptions options = few_pixels(camera_at({0.3f, -0.4f, 0.5f}, {1, 1, 1}), 16);
        options.paths.bounces = bounces, options.paths.light_sampling = false;
        options.paths.roulette_from = PathOptions::never, options.keeps_direct = true;
        double direct = emission, indirect = 0;
        for (std::uint32_t k = 1; k <= bounces; ++k)
            (k == 1 ? direct : indirect) += emission * std::pow(reflected, k);
        const PathPicture picture = trace(model, options);
        for (std::size_t i = 0; i < picture.light.size(); ++i) {
            EXPECT_NEAR(picture.direct.mean(i)[0], direct, 1e-5 * direct) << bounces;
            EXPECT_NEAR(picture.indirect(i)[0], indirect, 1e-5 * direct) << bounces;
        }
    }
}

/// A sky is direct light by itself and in a mirror, and indirect behind glass, whose two sides scatter it.
TYPED_TEST(DirectLight, MayBeMirroredOnce) {
    using T = TypeParam;
    Material mirror = matte(Vec3f::all(1)), glass = mirror, shown = matte(Vec3f::all(1));
    mirror.metallic = 1, mirror.roughness = 0;
    glass.transmission = 1, glass.thin = false, glass.roughness = 0, glass.ior = 1;
    shown.unlit = true;
    Camera camera = camera_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0});
    camera.field_of_view = 0.1f;
    const auto expect = [&](const TriangleMesh<T>& mesh, const Material& material, float direct,
                            const char* what) {
        auto model = model_of<T>({{mesh, material}});
        model.environment = Environment();
        PathPictureOptions options = few_pixels(camera, 4);
        options.keeps_direct = true;
        const PathPicture picture = trace(model, options);
        EXPECT_NEAR(picture.direct.mean(20)[0], direct, 1e-4f) << what;
        EXPECT_NEAR(picture.indirect(20)[0], 1 - direct, 1e-4f) << what;
    };
    expect(square<T>(1, 9), mirror, 1, "the sky alone");
    expect(square<T>(1, 0), mirror, 1, "a mirror");
    expect(square<T>(1, 0), shown, 1, "a surface that shows its colour");
    expect(box<T>(1, 1, 1), glass, 0, "glass");
}

TYPED_TEST(DirectLight, HasTheSameBitsHoweverPathsAreFollowed) {
    for (const Division division : {Division::even, Division::halves, Division::adaptive}) {
        SCOPED_TRACE(division_names[static_cast<std::size_t>(division)]);
        Box<TypeParam> box;
        box.options.width = 66, box.options.height = 8;  // two tiles
        box.options.division = division, box.options.samples = 40, box.options.in_flight = 0;
        const PathPicture one_by_one = box.picture();
        for (const unsigned threads : {1u, 2u}) {
            const ThreadLimit limit(threads);
            box.options.in_flight = threads == 1 ? 7 : 1024;
            expect_same(one_by_one, box.picture());
        }
        PathPicture in_steps(box.options.width, box.options.height, true);
        for (const std::uint32_t until : {1u, 33u})
            add_samples(in_steps, until, box.parts, by(default_executor(), box.options));
        box.options.keeps_direct = false;  // goes on all the same
        while (in_steps.samples < 40) {
            std::atomic<bool> stop{false};
            add_samples(in_steps, 40, box.parts, by(serial_executor(), box.options),
                        {[&](std::uint64_t done, std::uint64_t) { stop = done > 0; }, &stop});
        }
        expect_same(one_by_one, in_steps);
    }
}

TEST(PathPictures, DropSamplesThatAreNotFiniteFromDirectLight) {
    const float infinity = std::numeric_limits<float>::infinity();
    PathPicture picture(2, 1, true);
    picture.add(0, 0, {{1, 2, 3}, {1, 1, 1}}), picture.add(0, 0, {{infinity, 2, 3}, {4, 2, 3}});
    EXPECT_EQ(picture.light.mean(0), Vec3f(0.5f, 1, 1.5f));
    EXPECT_EQ(picture.direct.mean(0), Vec3f::all(0.5f));
    EXPECT_EQ(picture.indirect(0), Vec3f(0, 0.5f, 1));
    EXPECT_EQ(picture.direct.dropped(0), 1u);
    EXPECT_EQ(picture.dropped(), 1u);
}
TEST(PathPictures, ThatHaveNoDirectLightAreNotGivenSome) {
    Box<float> box;
    PathPicture picture(box.options.width, box.options.height);
    EXPECT_THROW(add_samples(picture, 1, box.parts, by(serial_executor(), box.options)), InputError);
    EXPECT_EQ(picture.samples, 0u);
}

}  // namespace
