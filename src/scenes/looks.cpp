/// The materials of generated scenes.
#include <hedgerow/scenes/looks.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <hedgerow/base/error.h>

#include "parts.h"

namespace hedgerow {
namespace {

Material matte(const char* name, const Vec3f& colour) {
    Material m;
    m.name = name;
    m.base_colour = colour;
    return m;
}
Material glossy(const char* name, const Vec3f& colour, float rough) {
    Material m = matte(name, colour);
    m.roughness = rough;
    m.specular = 1;
    return m;
}

/// The colours of the data, integrated as the header tells.
namespace cornell {
constexpr Vec3f white(0.738f, 0.736f, 0.740f), green(0.071f, 0.398f, 0.087f), red(0.487f, 0.050f, 0.051f);
constexpr Vec3f light_reflectance(0.78f, 0.78f, 0.78f), radiance(20.66f, 10.90f, 2.77f);
}  // namespace cornell

/// Materials, and how many triangles each has, one after the other. The last has all the rest. Without parts,
/// triangles have all materials in turn.
struct Looks {
    struct Part {
        std::uint64_t triangles;
        std::uint32_t material;
    };
    std::vector<Material> materials;
    std::vector<Part> parts = {};
};

Looks looks_of_cornell_box(std::uint64_t size) {
    Material light = matte("light", cornell::light_reflectance);
    light.emission = cornell::radiance;
    light.double_sided = false;  // it shines down
    const auto [floor, ceiling, back, right, left, lamp] = detail::parts_of_cornell_box(size);
    return {
        {matte("white", cornell::white), matte("green", cornell::green), matte("red", cornell::red), light},
        {{floor + ceiling + back, 0}, {right, 1}, {left, 2}, {lamp, 3}, {0, 0}}};
}

Material glaze() {
    return glossy("glaze", {0.8f, 0.78f, 0.72f}, 0.15f);
}
Material earth() {
    return matte("earth", {0.34f, 0.27f, 0.19f});
}

Looks looks_of_stadium(std::uint64_t size, std::uint64_t triangles) {
    const std::uint64_t pot = teapot<float>(detail::teapot_size_of_stadium(size)).size();
    return {{matte("concrete", {0.5f, 0.5f, 0.48f}), glaze()}, {{triangles - pot, 0}, {pot, 1}}};
}

Looks looks_of_grass(std::uint64_t size, std::uint64_t seed) {
    const std::uint64_t ground = terrain<float>(detail::ground_size_of_grass(size), seed).size();
    return {{earth(), glossy("blades", {0.14f, 0.36f, 0.06f}, 0.6f)}, {{ground, 0}, {0, 1}}};
}

Looks looks_of_soup() {
    return {{matte("red", {0.6f, 0.1f, 0.1f}), matte("yellow", {0.6f, 0.5f, 0.1f}),
             matte("green", {0.1f, 0.5f, 0.1f}), matte("cyan", {0.1f, 0.5f, 0.5f}),
             matte("blue", {0.1f, 0.15f, 0.6f}), matte("violet", {0.45f, 0.1f, 0.5f})}};
}

Looks looks_of(const SceneSpec& spec, std::uint64_t size, std::uint64_t triangles) {
    const std::string& name = spec.name;
    if (name == "cornell-box") return looks_of_cornell_box(size);
    if (name == "teapot-in-stadium" || name == "turned-stadium") return looks_of_stadium(size, triangles);
    if (name == "grass") return looks_of_grass(size, spec.seed);
    if (name == "soup") return looks_of_soup();
    if (name == "teapot") return {{glaze()}};
    if (name == "terrain") return {{earth()}};
    if (name == "hairball") return {{glossy("hair", {0.32f, 0.2f, 0.11f}, 0.4f)}};
    if (name == "boulder") return {{matte("stone", {0.45f, 0.42f, 0.38f})}};
    if (name == "interior") return {{matte("plaster", {0.75f, 0.73f, 0.7f})}};
    return {{Material()}};
}

/// The material of each triangle.
std::vector<std::uint32_t> materials_of(const Looks& looks, std::size_t count, std::size_t triangles) {
    std::vector<std::uint32_t> materials;
    materials.reserve(triangles);
    for (const Looks::Part& part : looks.parts)
        materials.insert(materials.end(), static_cast<std::size_t>(part.triangles), part.material);
    while (materials.size() < triangles)
        materials.push_back(looks.parts.empty() ? static_cast<std::uint32_t>(materials.size() % count)
                                                : looks.parts.back().material);
    return materials;
}

}  // namespace

template <class T>
Model<T> generate_model(const SceneSpec& spec, const Progress& progress) {
    // Make the mesh.
    Scene<T> scene = generate<T>(spec, progress);
    auto* const mesh = std::get_if<TriangleMesh<T>>(&scene);
    if (mesh == nullptr)
        throw UsageError("the scene '" + spec.name + "' has no triangles, and looks are those of surfaces");
    const auto all = scene_list();
    const auto info =
        std::find_if(all.begin(), all.end(), [&](const SceneInfo& i) { return i.name == spec.name; });
    Looks looks = looks_of(spec, spec.size.value_or(info->default_size), mesh->size());
    // Give each triangle its material.
    Model<T> model;
    model.materials = std::move(looks.materials);
    model.instances.push_back({spec.name, 0, {}});
    Object<T>& object = model.objects.emplace_back();
    object.name = spec.name;
    object.mesh = std::move(*mesh);
    if (model.materials.size() > 1)
        object.materials = materials_of(looks, model.materials.size(), object.mesh.size());
    return model;
}

template Model<float> generate_model(const SceneSpec&, const Progress&);
template Model<double> generate_model(const SceneSpec&, const Progress&);

}  // namespace hedgerow
