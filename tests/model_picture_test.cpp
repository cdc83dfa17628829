/// Pictures of models with their looks: colours, textures, masks and normals are those of the model.
#include <gtest/gtest.h>

#include <hedgerow/base/error.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/model_cones.h>
#include <hedgerow/render/model_scene.h>
#include <hedgerow/render/render.h>
#include <hedgerow/render/visibility/rasterise.h>
#include <hedgerow/scenes/looks.h>

using namespace hedgerow;

namespace {

template <class T>
class ModelPictures : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(ModelPictures, Scalars);

/// A square from (-1, -1, 0) to (1, 1, 0), with texture coordinates from its upper left corner.
template <class T>
Object<T> square() {
    Object<T> object;
    object.mesh.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    object.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    object.attributes.texture_coordinates.push_back({{{0, 1}, {1, 1}, {1, 0}, {0, 0}}, {}});
    return object;
}
/// Four texels: red, green, blue, and white that is see-through.
Texture four_texels() {
    Texture texture;
    auto pixels = std::make_shared<Pixels>();
    pixels->width = pixels->height = 2, pixels->channels = 4;
    pixels->samples =
        std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 0};
    texture.pixels = pixels;
    texture.filter = TextureFilter::nearest;
    return texture;
}
template <class T>
Model<T> textured_square() {
    Model<T> model;
    model.objects.push_back(square<T>());
    model.instances.push_back({"square", 0, {}});
    model.textures.push_back(four_texels());
    Material m;
    m.base_colour = Vec3f::all(1), m.unlit = true;
    m.base_colour_texture.texture = 0;
    model.materials.push_back(m);
    return model;
}
/// A square picture, from above, of what lies between -1 and 1.
RenderOptions from_above() {
    RenderOptions options;
    options.width = options.height = 16;
    options.shading = Shading::colour, options.layers = true;
    options.camera.eye = {0, 0, 5}, options.camera.target = {0, 0, 0}, options.camera.up = {0, 1, 0};
    options.camera.projection = Projection::orthographic, options.camera.height = 2;
    return options;
}
template <class T>
Picture cast(const ModelScene<T>& scene, const RenderOptions& options) {
    const auto& looks = scene.appearances();
    RayCasting<T> casting(scene.tracer(), looks.has_masks()
                                              ? [&](const Hit<T>& hit) { return looks.is_there(hit); }
                                              : std::function<bool(const Hit<T>&)>());
    return render(PictureParts<T>{casting, scene.surfaces(), &scene.tracer(), &looks},
                  by(serial_executor(), options));
}
Vec3f light_at(const Picture& picture, int x, int y) {
    return picture.light[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.image.width) +
                         static_cast<std::size_t>(x)];
}

TYPED_TEST(ModelPictures, TexturesLieWhereTheirCoordinatesAre) {
    using T = TypeParam;
    const auto model = textured_square<T>();
    const ModelScene<T> scene(model, serial_executor());
    const Picture picture = cast(scene, from_above());
    EXPECT_EQ(light_at(picture, 2, 2), Vec3f(1, 0, 0));
    EXPECT_EQ(light_at(picture, 13, 2), Vec3f(0, 1, 0));
    EXPECT_EQ(light_at(picture, 2, 13), Vec3f(0, 0, 1));
    EXPECT_EQ(light_at(picture, 13, 13), Vec3f(1, 1, 1)) << "opaque, whatever the texture's opacity";
}

TYPED_TEST(ModelPictures, RaysGoThroughMasks) {
    using T = TypeParam;
    auto model = textured_square<T>();
    model.materials[0].alpha_mode = AlphaMode::mask;
    model.materials[0].alpha_texture = {0, 0, 3, {}};
    // Below it, another square in one colour, which the light reaches through the hole alone.
    model.objects.push_back(square<T>());
    model.objects[1].material = 1;
    model.instances.push_back({"below", 1, Transform<3>::translation({0, 0, -1})});
    Material below;
    below.base_colour = {0.5f, 0.25f, 0.125f}, below.unlit = true;
    model.materials.push_back(below);
    RenderOptions options = from_above();
    {
        const ModelScene<T> scene(model, serial_executor());
        const Picture picture = cast(scene, options);
        EXPECT_EQ(light_at(picture, 2, 2), Vec3f(1, 0, 0));
        EXPECT_EQ(light_at(picture, 13, 13), below.base_colour);
    }
    model.materials[1].unlit = false;
    options.camera.light = {0, 0, 1};
    const ModelScene<T> scene(model, serial_executor());
    const Vec3f lit = light_at(cast(scene, options), 13, 13);
    model.materials[0].alpha_cutoff = 0;  // all of it is there now, so the light is blocked
    const ModelScene<T> covered(model, serial_executor());
    EXPECT_EQ(light_at(cast(covered, options), 13, 13), Vec3f(1, 1, 1));
    const PlainShading shading(options.camera, 0);
    for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(
            lit[k],
            below.base_colour[k] / PlainShading::grey * (shading.sky({0, 0, 1}) + shading.direct(1))[k],
            1e-6f);
}

/// Three squares over each other, of which the upper two are transparent: in the picture, and for the light.
TYPED_TEST(ModelPictures, LightGoesThroughMaterials) {
    using T = TypeParam;
    auto model = textured_square<T>();
    model.materials.clear(), model.instances.clear();
    const float alphas[] = {0.25f, 0.5f, 0.3f};
    const Vec3f colours[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (std::uint32_t i = 0; i < 3; ++i) {
        Material m;
        m.base_colour = colours[i], m.alpha = alphas[i], m.unlit = i < 2;
        m.alpha_mode = i < 2 ? AlphaMode::blend : AlphaMode::opaque;  // the alpha of the lowest says nothing
        model.materials.push_back(m);
        if (i > 0) model.objects.push_back(square<T>());
        model.objects[i].material = i;
        model.instances.push_back({"", i, Transform<3>::translation({0, 0, -1.0 * i})});
    }
    const ModelScene<T> scene(model, serial_executor());
    RenderOptions options = from_above();
    options.camera.light = {0, 0, 1};
    options.camera.eye[0] = options.camera.target[0] =
        0.013f;  // no sample is on the common edge of two triangles, where both count
    EXPECT_EQ(light_at(cast(scene, options), 8, 8), colours[0]) << "opaque, unless asked for";
    options.transparent = true;
    const Picture picture = cast(scene, options);
    const PlainShading shading(options.camera, 0);
    const float through = 0.75f * 0.5f;  // the same towards the eye and from the light
    const Vec3f lowest = (shading.sky({0, 0, 1}) + shading.direct(1) * through) / PlainShading::grey;
    const Vec3f want(0.25f, 0.75f * 0.5f, through * lowest[2]);
    for (const int at : {1, 8, 14})
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(light_at(picture, at, at)[k], want[k], 1e-6f);
    EXPECT_EQ(picture.costs.layers.layers, 3u * 16 * 16);
    EXPECT_EQ(picture.costs.layers.ended, 16u * 16) << "at the lowest square";
    options.opacity = 0.5f;
    const float halved[] = {0.125f, 0.25f, 0.5f};
    EXPECT_NEAR(
        light_at(cast(scene, options), 8, 8)[1],
        (1 - halved[0]) * halved[1] + (1 - halved[0]) * (1 - halved[1]) * 0.5f * shading.background()[1],
        1e-6f);
}

TYPED_TEST(ModelPictures, NormalsOfCornersTurnTheLight) {
    using T = TypeParam;
    auto model = textured_square<T>();
    model.materials[0] = Material();
    model.objects[0].attributes.normals.values = {{1, 0, 1}, {1, 0, 1}, {1, 0, 1}, {1, 0, 1}};
    // The instance is turned about z, and its normals with it.
    model.instances[0].to_world = Transform<3>::rotation({0, 0, 1}, 3.14159265358979 / 2);
    RenderOptions options = from_above();
    options.camera.light = {0, 1, 1};
    const ModelScene<T> scene(model, serial_executor());
    const Vec3f lit = light_at(cast(scene, options), 8, 8);
    const PlainShading shading(options.camera, 0);
    const Vec3f normal = normalized(Vec3f(0, 1, 1));
    for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(lit[k], 0.8f / PlainShading::grey * (shading.sky(normal) + shading.direct(1))[k], 1e-5f);
}

/// The green of a map of normals points up in its image, the red to the right, also on a mirrored instance
/// and where texture coordinates run the other way.
TYPED_TEST(ModelPictures, MapsOfNormalsTurnTheLight) {
    using T = TypeParam;
    const Vec3f in_map = normalized(Vec3f(0.3f, 0.5f, 1));
    const auto light_of = [&](const Transform<3>& to_world, bool flipped, const Vec3f& expected) {
        auto model = textured_square<T>();
        model.materials[0] = Material();
        model.materials[0].normal_texture.texture = 1;
        if (flipped)
            for (Vec2f& c : model.objects[0].attributes.texture_coordinates[0].values) c[0] = -c[0];
        Texture map;
        auto pixels = std::make_shared<Pixels>();
        const Vec3f encoded = (in_map + Vec3f::all(1)) * 0.5f;
        *pixels = {1, 1, 3, std::vector<float>{encoded[0], encoded[1], encoded[2]}};
        map.pixels = pixels;
        model.textures.push_back(map);
        model.instances[0].to_world = to_world;
        RenderOptions options = from_above();
        options.camera.light = expected;
        const ModelScene<T> scene(model, serial_executor());
        const Vec3f lit = light_at(cast(scene, options), 8, 8);
        const PlainShading shading(options.camera, 0);
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(lit[k], 0.8f / PlainShading::grey * (shading.sky(expected) + shading.direct(1))[k],
                        1e-5f);
    };
    const auto x = in_map[0], y = in_map[1], z = in_map[2];
    light_of({}, false, {x, y, z});
    light_of({}, true, {-x, y, z});
    light_of(Transform<3>::rotation({0, 0, 1}, 3.14159265358979 / 2), false, {-y, x, z});
    light_of(Transform<3>::scaling(Vec3d(-2, 2, 2)), false, {-x, y, z});
    light_of(Transform<3>::scaling(Vec3d(2, -2, 2)), true, {-x, -y, z});
}

TYPED_TEST(ModelPictures, ByTrianglesAreThoseByRays) {
    using T = TypeParam;
    for (const char* name : {"cornell-box", "teapot-in-stadium"}) {
        SCOPED_TRACE(name);
        const auto model = generate_model<T>(parse_scene_spec(std::string("gen:") + name));
        const ModelScene<T> scene(model, default_executor());
        RenderOptions options;
        options.width = 90, options.height = 70, options.shading = Shading::colour, options.layers = true;
        options.camera = *camera_for(name);
        const Picture by_rays = cast(scene, options);
        Rasterising<T, InstanceSetView<MeshIndex<T>>> rasterising(scene.instances().view());
        const Picture by_triangles =
            render(PictureParts<T>{rasterising, scene.surfaces(), &scene.tracer(), &scene.appearances()},
                   by(default_executor(), options));
        EXPECT_EQ(by_rays.image, by_triangles.image);
        EXPECT_EQ(by_rays.light, by_triangles.light);
    }
    // The walls of the box: red on the left, green on the right.
    const auto model = generate_model<T>(parse_scene_spec("gen:cornell-box"));
    const ModelScene<T> scene(model, default_executor());
    RenderOptions options;
    options.width = options.height = 64, options.shading = Shading::colour, options.layers = true;
    options.camera = *camera_for("cornell-box");
    const Picture picture = cast(scene, options);
    const Vec3f left = light_at(picture, 4, 32), right = light_at(picture, 59, 32);
    EXPECT_GT(left[0], 3 * left[1]);
    EXPECT_GT(right[1], 2 * right[0]);
}

/// A floor of fine tiles up to the horizon: two instances, one of them mirrored and stretched.
template <class T>
Model<T> tiled_floor() {
    auto model = textured_square<T>();
    for (Vec2f& c : model.objects[0].attributes.texture_coordinates[0].values) c = c * 40.f;
    model.instances[0].to_world =
        Transform<3>::translation({-10, 0, 0}) * Transform<3>::scaling(Vec3d(-10, 10, 1));
    model.instances.push_back(
        {"", 0, Transform<3>::translation({10, 0, 0}) * Transform<3>::scaling(Vec3d(10, 10, 1))});
    return model;
}
RenderOptions along_the_floor() {
    RenderOptions options;
    options.width = 64, options.height = 48;
    options.shading = Shading::colour, options.layers = true;
    options.camera.eye = {0, -12, 2}, options.camera.target = {0, 0, 0}, options.camera.up = {0, 0, 1};
    options.camera.field_of_view = 50;
    return options;
}
/// The mean error of pixels beside others of the same picture.
double error_of(const Picture& picture, const Picture& truth) {
    double sum = 0;
    for (std::size_t i = 0; i < truth.light.size(); ++i)
        sum += double(max_component(abs(picture.light[i] - truth.light[i])));
    return sum / double(truth.light.size());
}

TYPED_TEST(ModelPictures, FootprintsShowTexturesAsManySamplesDo) {
    using T = TypeParam;
    const auto model = tiled_floor<T>();
    const ModelScene<T> scene(model, default_executor());
    for (const auto projection : {Projection::perspective, Projection::orthographic}) {
        RenderOptions options = along_the_floor();
        options.camera.projection = projection, options.camera.height = 16;
        const Picture points = cast(scene, options);
        options.footprints = true;
        const Picture areas = cast(scene, options);
        options.samples = 4;
        const Picture quarters = cast(scene, options);
        options.footprints = false;
        const Picture four_points = cast(scene, options);
        options.samples = 1024;
        const Picture many = cast(scene, options);
        EXPECT_LT(error_of(areas, many), 0.2 * error_of(points, many));
        EXPECT_LT(error_of(areas, many), 0.03);
        EXPECT_LT(error_of(quarters, many), 0.8 * error_of(four_points, many));
    }
    RenderOptions panorama = along_the_floor();
    panorama.camera.projection = Projection::panorama, panorama.footprints = true;
    EXPECT_THROW(cast(scene, panorama), InputError);
}

TYPED_TEST(ModelPictures, ConesSeeLooks) {
    using T = TypeParam;
    const auto expect = [](const Model<T>& model, RenderOptions options) {
        const ModelScene<T> scene(model, default_executor());
        const ModelCones<T> cones(model, default_executor());
        RayCasting<T> casting(scene.tracer());
        options.cones = options.footprints = true;
        const Picture by_cones =
            render(PictureParts<T>{casting, scene.surfaces(), &scene.tracer(), &scene.appearances(), &cones},
                   by(default_executor(), options));
        EXPECT_EQ(by_cones.costs.cones, by_cones.image.pixels.size());
        options.cones = options.footprints = false;
        const Picture one = cast(scene, options);
        options.samples = 1024;
        const Picture many = cast(scene, options);
        EXPECT_LT(error_of(by_cones, many), 0.03);
        EXPECT_LT(error_of(by_cones, many), 0.5 * error_of(one, many));
    };
    expect(tiled_floor<T>(), along_the_floor());
    // Two squares at a slant before the sky, of which one is turned over, so that edges cross many pixels.
    auto model = textured_square<T>();
    model.instances[0].to_world = Transform<3>::rotation({0, 0, 1}, 0.3);
    model.instances.push_back(
        {"", 0, Transform<3>::translation({0.4, 0.2, 0.5}) * Transform<3>::rotation({0, 1, 0}, 2.5)});
    RenderOptions options = from_above();
    options.width = options.height = 48, options.camera.height = 4;
    expect(model, options);
}

TYPED_TEST(ModelPictures, NeedLooksAndTriangles) {
    using T = TypeParam;
    auto model = textured_square<T>();
    const ModelScene<T> scene(model, serial_executor());
    RayCasting<T> casting(scene.tracer());
    EXPECT_THROW(render(PictureParts<T>{casting, scene.surfaces(), &scene.tracer()},
                        by(serial_executor(), from_above())),
                 InputError);
    model.objects[0].mesh.triangles.clear();
    EXPECT_THROW(ModelScene<T>(model, serial_executor()), InputError);
}

}  // namespace
