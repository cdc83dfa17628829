/// Pictures of paths that were looked at, held to their bits: another processor, compiler or instruction set
/// has the same ones.
#include <gtest/gtest.h>
#include <array>

#include <bit>
#include <memory>

#include <hedgerow/render/camera/presets.h>
#include <hedgerow/scenes/looks.h>
#include <hedgerow/scenes/meshes.h>

#include "path_scenes.h"

using namespace hedgerow;
using namespace hedgerow::test;

namespace {

/// A hash of the linear light of a picture, bit by bit.
std::uint64_t hash_of(const PathPicture& picture) {
    std::uint64_t hash = 0;
    for (std::size_t i = 0; i < picture.light.size(); ++i)
        for (const float x : picture.light.mean(i).data)
            hash = scattered(hash + std::bit_cast<std::uint32_t>(x));
    return hash;
}
PathPictureOptions small_picture() {
    PathPictureOptions options;
    options.width = options.height = 64, options.samples = 8;
    return options;
}
template <class T>
PathPicture picture_of(const Model<T>& model, const PathPictureOptions& options) {
    const ModelScene<T> scene(model, default_executor());
    const SceneLights<T> lights(scene, {.up = options.camera.up});
    return trace_paths(PathScene<T>{scene, lights, scene.tracer()}, by(default_executor(), options));
}
/// A generated scene by its own camera, after a change of both.
template <class Change>
PathPicture picture_of(const char* scene, const Change& change) {
    const SceneSpec spec = parse_scene_spec(scene);
    auto model = generate_model<float>(spec);
    PathPictureOptions options = small_picture();
    options.camera = camera_for(spec.name).value_or(
        automatic_camera(ModelScene<float>(model, default_executor()).bounds()));
    change(model, options);
    return picture_of(model, options);
}

TEST(PathPictures, OfGeneratedScenesHaveTheseBits) {
    const auto expect = [](const char* scene, std::uint64_t hash, auto change) {
        EXPECT_EQ(hash_of(picture_of(scene, change)), hash) << scene;
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
    expect("gen:cornell-box", 7066504442951290153u, as_it_is);
    expect("gen:cornell-box", 14844099350915460409u, of_metal);
    expect("gen:teapot-in-stadium:3000", 6252762008982768980u, as_it_is);
    expect("gen:teapot:3000", 11397488465895745811u, of_glass);
    expect("gen:teapot:3000", 7611625634373196732u, of_metal);
    expect("gen:grass:3000", 7378059095410403513u, as_it_is);
    expect("gen:hairball:3000", 2716070847707934992u, as_it_is);
    expect("gen:soup:100", 15140185078112202311u, of_glass);
}

/// An image whose pixels are f(column, row).
template <class F>
std::shared_ptr<const Pixels> image(int width, int height, const F& f) {
    std::vector<float> samples;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const float c : f(x, y).data) samples.push_back(c);
    return std::make_shared<const Pixels>(Pixels{width, height, 3, samples});
}
std::uint32_t add_texture(Model<float>& model, std::shared_ptr<const Pixels> pixels) {
    Texture texture;
    texture.pixels = std::move(pixels);
    model.textures.push_back(texture);
    return static_cast<std::uint32_t>(model.textures.size() - 1);
}
/// A square floor from −half to half at a height, with texture coordinates from 0 to 1.
Object<float> floor_at(double half, double z, std::uint32_t material) {
    Object<float> floor;
    floor.mesh = square<float>(half, z);
    floor.material = material;
    floor.attributes.texture_coordinates.push_back({{{0, 1}, {1, 1}, {1, 0}, {0, 0}}, {}});
    return floor;
}
void place(Model<float>& model, std::uint32_t object, const Transform<3>& to_world) {
    model.instances.push_back({"", object, to_world});
}
/// The teapot, with smooth normals.
Object<float> pot(std::uint32_t material) {
    Object<float> object;
    object.mesh = teapot<float>(3000);
    object.material = material;
    CornerValues<Vec3f>& normals = object.attributes.normals;
    normals.values.resize(object.mesh.vertices.size());
    for (std::size_t i = 0; i < object.mesh.size(); ++i)
        for (const std::uint32_t v : object.mesh.triangles[i])
            normals.values[v] = normals.values[v] + object.mesh.view().normal(i);
    return object;
}

/// A pot of brass and tiles with a map of normals, colours and roughness under a sky with a sun.
PathPicture sky_and_tiles() {
    Model<float> model;
    Material tiles = matte(Vec3f::all(1)), brass = matte({0.9f, 0.7f, 0.3f});
    tiles.specular = 1, brass.metallic = 1, brass.roughness = 0.35f;
    const auto edge = [](int x) { return x % 8 == 0 ? -1 : x % 8 == 7 ? 1 : 0; };
    tiles.base_colour_texture.texture =
        add_texture(model, image(32, 32, [](int x, int y) {
                        return (x / 8 + y / 8) % 2 == 0 ? Vec3f(0.7f, 0.2f, 0.15f) : Vec3f(0.8f, 0.8f, 0.7f);
                    }));
    tiles.normal_texture.texture =
        add_texture(model, image(32, 32, [&](int x, int y) {
                        return Vec3f(0.5f + 0.3f * float(edge(x)), 0.5f - 0.3f * float(edge(y)), 0.9f);
                    }));
    tiles.roughness_texture.texture = add_texture(
        model, image(4, 4, [](int x, int y) { return Vec3f::all((x + y) % 2 == 0 ? 0.15f : 0.6f); }));
    model.materials = {tiles, brass};
    model.objects = {floor_at(6, 0, 0), pot(1)};
    place(model, 0, {}), place(model, 1, {});
    Environment sky;
    sky.panorama.pixels = image(32, 16, [](int x, int y) {
        if (y >= 3 && y < 5 && x >= 20 && x < 22) return Vec3f(60, 50, 35);
        return y < 8 ? Vec3f(0.2f, 0.35f, 0.7f) + Vec3f(0.08f, 0.06f, 0.02f) * float(y)
                     : Vec3f(0.15f, 0.1f, 0.07f);
    });
    sky.to_world = {Vec3d(1, 0, 0), Vec3d(0, 0, -1), Vec3d(0, 1, 0)};
    model.environment = sky;
    PathPictureOptions options = small_picture();
    options.camera = {{5, -8, 5}, {0, 0, 1}, {0, 0, 1}, 45};
    return picture_of(model, options);
}

/// The Cornell box in double, with blocks of gold and of smooth glass, through a lens.
PathPicture box_through_a_lens() {
    auto model = generate_model<double>(parse_scene_spec("gen:cornell-box"));
    Object<double>& object = model.objects[0];
    const auto first = static_cast<std::uint32_t>(model.materials.size());
    Material gold = matte({0.95f, 0.7f, 0.25f}), glass = matte(Vec3f::all(1));
    gold.metallic = 1, gold.roughness = 0.15f;
    glass.transmission = 1, glass.thin = false, glass.roughness = 0, glass.specular = 1;
    model.materials.push_back(gold), model.materials.push_back(glass);
    // The last ten triangles are the tall block, and those before them the short one.
    const std::size_t n = object.mesh.size();
    for (std::size_t i = n - 20; i < n; ++i) object.materials[i] = first + (i < n - 10 ? 1u : 0u);
    PathPictureOptions options = small_picture();
    options.camera = *camera_for("cornell-box");
    options.camera.lens_radius = 40, options.camera.focus = 1000;
    options.filter = PixelFilter::gaussian;
    return picture_of(model, options);
}

/// Pots that are turned, mirrored and stretched, under many coloured lamps of all kinds, by parallel rays.
PathPicture pots_and_lamps() {
    Model<float> model;
    Material plastic = matte({0.7f, 0.7f, 0.7f}), steel = plastic;
    plastic.specular = 1, plastic.roughness = 0.4f, steel.metallic = 1, steel.roughness = 0.25f;
    model.materials = {plastic, steel, matte(Vec3f::all(0.6f))};
    model.objects = {pot(0), pot(1), floor_at(12, 0, 2)};
    place(model, 2, {});
    const Rows<3> turned{Vec3d(0.6, -0.8, 0), Vec3d(0.8, 0.6, 0), Vec3d(0, 0, 1)},
        mirrored{Vec3d(-1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)},
        stretched{Vec3d(0.6, 0, 0), Vec3d(0, 0.6, 0), Vec3d(0, 0, 1.5)};
    const std::array forms{turned, mirrored, stretched};
    for (int row = -1; row <= 1; ++row)
        for (std::size_t column = 0; column < forms.size(); ++column) {
            const int x = static_cast<int>(column) - 1;
            place(model, static_cast<std::uint32_t>((row + x) & 1),
                  {forms[column], Vec3d(7 * x, 7 * row, 0)});
        }
    for (std::uint32_t i = 0; i < 15; ++i) {
        Random random(3, i);
        const Vec3f colour(random.in_cube<3>());
        const Vec3d at = random.in_cube<3>() * 20.0 - Vec3d(10, 10, 0);
        model.materials.push_back(matte({}, colour * 90.0f));
        Object<float> lamp;
        lamp.mesh = box<float>(0.15, 0.15, 0.15), lamp.material = 3 + i;
        model.objects.push_back(lamp);
        place(model, 3 + i, Transform<3>::translation({at[0], at[1], 6 + at[2] / 10}));
        if (i % 4 == 0) model.lights.push_back(PointLight{"", {at[1], at[0], 6}, colour * 60.0f});
        if (i % 4 == 1)
            model.lights.push_back(SpotLight{"", {at[1], at[0], 8}, {0, 0, -1}, colour * 600.0f, 0.1, 0.3});
    }
    PathPictureOptions options = small_picture();
    options.samples = 32;
    options.camera = {{10, -16, 18}, {0, 0, 1}, {0, 0, 1}, 45, {}, Projection::orthographic, 24};
    return picture_of(model, options);
}

/// From within a ring of posts of coloured rough glass, veils and leaves with holes, all around.
PathPicture glass_and_leaves() {
    Model<float> model;
    Material leaf = matte({0.2f, 0.5f, 0.1f}), veil = matte({0.9f, 0.4f, 0.3f});
    leaf.alpha_mode = AlphaMode::mask, veil.alpha_mode = AlphaMode::blend, veil.alpha = 0.4f;
    leaf.alpha_texture.texture = add_texture(model, image(16, 16, [](int x, int y) {
                                                 const int u = 2 * x - 15, v = 2 * y - 15;
                                                 return Vec3f::all(u * u + 2 * v * v < 180 ? 1.0f : 0.0f);
                                             }));
    leaf.alpha_texture.transform = {{4, 0, 0}, {0, 4, 0}};
    model.materials = {leaf, veil, matte(Vec3f::all(0.7f))};
    model.objects = {floor_at(2, 0, 0), floor_at(1, 0, 1), floor_at(9, 0, 2)};
    place(model, 2, Transform<3>::translation({0, 0, -1.5}));
    place(model, 0, Transform<3>::translation({0, 0, 2}));
    const Rows<3> upright{Vec3d(1, 0, 0), Vec3d(0, 0, -1), Vec3d(0, 1, 0)};
    place(model, 0, {upright, Vec3d(0, 5, 0.5)});
    place(model, 1, {upright, Vec3d(3.2, 2.2, 0)}), place(model, 1, {upright, Vec3d(3.6, 2.6, 0.3)});
    for (std::uint32_t i = 0; i < 6; ++i) {
        Material glass = matte(Vec3f::all(1));
        glass.transmission = 1, glass.thin = false, glass.specular = 1;
        glass.roughness = 0.1f * static_cast<float>(i), glass.ior = 1.3f + 0.1f * static_cast<float>(i);
        glass.attenuation_colour = Vec3f::all(0.9f), glass.attenuation_colour[static_cast<int>(i % 3)] = 0.2f;
        glass.attenuation_distance = 0.6f;
        model.materials.push_back(glass);
        Object<float> post;
        post.mesh = box<float>(0.4, 0.4, 1.2), post.material = 3 + i;
        model.objects.push_back(post);
        const double places[6][2] = {{3, 0}, {1.5, 2.6}, {-1.5, 2.6}, {-3, 0}, {-1.5, -2.6}, {1.5, -2.6}};
        place(model, 3 + i, Transform<3>::translation({places[i][0], places[i][1], 0}));
    }
    model.lights.push_back(DirectionalLight{"", normalized(Vec3d(-0.4, 0.5, -1)), Vec3f::all(3)});
    Environment sky;
    sky.radiance = {0.5f, 0.6f, 0.8f};
    model.environment = sky;
    PathPictureOptions options = small_picture();
    options.camera = {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 45, {}, Projection::panorama};
    return picture_of(model, options);
}

TEST(PathPictures, OfSkiesLensesInstancesAndHolesHaveTheseBits) {
    EXPECT_EQ(hash_of(sky_and_tiles()), 6157689883351750806u);
    EXPECT_EQ(hash_of(box_through_a_lens()), 10430445216754787071u);
    EXPECT_EQ(hash_of(pots_and_lamps()), 3465922395490728041u);
    EXPECT_EQ(hash_of(glass_and_leaves()), 8920157839927077422u);
}

}  // namespace
