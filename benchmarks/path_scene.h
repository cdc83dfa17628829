/// What the benchmarks of paths share: scenes with lights and a camera, and pictures of them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <hedgerow/io/model_file.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/integrators/path_picture.h>
#include <hedgerow/scenes/looks.h>
#include <hedgerow/scenes/random.h>

namespace hedgerow {

/// Gives the one object of a model texture coordinates, by its two widest axes, and its materials textures of
/// noise: of colours, roughness and normals.
inline void add_textures(Model<float>& model) {
    Object<float>& object = model.objects[0];
    Box3f box;
    for (const Vec3f& v : object.mesh.vertices) box.expand(v);
    const Vec3f extent = box.extent();
    int narrowest = 0;
    for (int k = 1; k < 3; ++k)
        if (extent[k] < extent[narrowest]) narrowest = k;
    const int across = narrowest == 0 ? 1 : 0, along = narrowest == 2 ? 1 : 2;
    CornerValues<Vec2f> coordinates;
    for (const Vec3f& v : object.mesh.vertices)
        coordinates.values.emplace_back(8 * (v[across] - box.low[across]) / extent[across],
                                        8 * (v[along] - box.low[along]) / extent[along]);
    object.attributes.texture_coordinates.push_back(std::move(coordinates));
    for (std::uint8_t image = 0; image < 3; ++image) {
        constexpr int side = 512;
        Pixels pixels{side, side, 3, std::vector<std::uint8_t>(3 * side * side)};
        auto& samples = std::get<0>(pixels.samples);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const auto noise = static_cast<std::uint8_t>(scattered(3 * i + image) >> 58);
            // Normals lean a little to all sides; colours and roughness are in the upper half.
            samples[i] =
                static_cast<std::uint8_t>(image == 2 ? (i % 3 == 2 ? 255 : 96 + noise) : 191 + noise);
        }
        Texture& texture = model.textures.emplace_back();
        texture.pixels = std::make_shared<const Pixels>(std::move(pixels));
        texture.space = image == 0 ? ColourSpace::srgb : ColourSpace::linear;
    }
    for (Material& m : model.materials) {
        m.base_colour_texture.texture = 0, m.roughness_texture.texture = 1, m.normal_texture.texture = 2;
        m.specular = 1;
    }
}

/// A scene, named as a model file or as gen:NAME[:SIZE], with "+textures" for textures of noise. All its
/// triangles must be one object that stands where it is.
class PathBenchmarkScene {
public:
    explicit PathBenchmarkScene(const std::string& name)
        : model_(model_of(name)),
          scene_(model_, serial_executor()),
          camera_(camera_of(name)),
          lights_(scene_, {.up = camera_.up}) {}

    const TriangleMesh<float>& mesh() const { return model_.objects[0].mesh; }
    const MeshIndex<float>& index() const { return scene_.instances().view()[0].index(); }
    const Tracer<float>& tracer() const { return scene_.tracer(); }
    /// The scene, with a tracer that finds its hits.
    PathScene<float> with(const Tracer<float>& tracer) const { return {scene_, lights_, tracer}; }
    PathPictureOptions options(int size, std::uint32_t samples) const {
        PathPictureOptions o;
        o.camera = camera_, o.width = o.height = size, o.samples = samples;
        return o;
    }

private:
    static Model<float> model_of(const std::string& name) {
        const std::string scene = name.substr(0, name.find('+'));
        Model<float> model = scene.starts_with("gen:") ? generate_model<float>(parse_scene_spec(scene))
                                                       : load_model<float>(scene);
        if (model.instances.size() != 1 || !(model.instances[0].to_world == Transform<3>()))
            throw InputError(name + ": has instances, and Embree gets a single mesh here");
        if (name.ends_with("+textures")) add_textures(model);
        return model;
    }
    Camera camera_of(const std::string& name) const {
        const std::string kind =
            name.starts_with("gen:") ? name.substr(4, name.find_first_of(":+", 4) - 4) : "";
        return camera_for(kind).value_or(automatic_camera(scene_.bounds()));
    }

    const Model<float> model_;
    const ModelScene<float> scene_;
    const Camera camera_;
    const SceneLights<float> lights_;
};

}  // namespace hedgerow
