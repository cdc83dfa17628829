/// glTF 2.0, section 3.10, and KHR_lights_punctual.
#include "gltf_lights.h"

#include <numbers>
#include <string>

namespace hedgerow::detail {

namespace {

using Json = GltfFile::Json;

/// The member `key`, which is needed and must be in an open interval.
double within(const GltfFile& file, const Json& json, const char* key, double low, double high) {
    if (!json.contains(key)) file.fail(std::string("'") + key + "' is missing");
    const double x = file.real_or(json, key, 0);
    if (!(x > low && x < high))
        file.fail(std::string("'") + key + "' is " + std::to_string(x) + ", but should be between " +
                  std::to_string(low) + " and " + std::to_string(high));
    return x;
}

constexpr double largest_size = 0x1p60;

/// The name of a thing, or of its node.
std::string name_of(const GltfFile& file, const Json& json, const GltfPlacedNode& node) {
    const std::string own = file.text(json, "name");
    return own.empty() ? file.text(*node.node, "name") : own;
}

/// The direction −z of a node in the scene.
Vec3d forward(const GltfFile& file, const GltfPlacedNode& node) {
    const Vec3d d = node.to_scene.vector({0, 0, -1});
    if (!(length(d) > 0) || !finite(d)) file.fail("a light shines along a direction of length 0");
    return normalized(d);
}

}  // namespace

FileCamera camera_of(const GltfFile& file, const GltfPlacedNode& node, std::uint64_t camera) {
    const Json& json = file.object("cameras", camera);
    FileCamera found;
    found.name = name_of(file, json, node);
    found.to_world = node.to_scene;
    const std::string type = file.text(json, "type");
    if (type == "perspective") {
        const Json* const view = file.member(json, "perspective");
        if (view == nullptr) file.fail("camera " + std::to_string(camera) + " has no 'perspective'");
        found.view = PerspectiveView{within(file, *view, "yfov", 0, std::numbers::pi)};
        if (view->contains("aspectRatio")) found.aspect = within(file, *view, "aspectRatio", 0, largest_size);
    } else if (type == "orthographic") {
        const Json* const view = file.member(json, "orthographic");
        if (view == nullptr) file.fail("camera " + std::to_string(camera) + " has no 'orthographic'");
        const double width = within(file, *view, "xmag", 0, largest_size);
        const double height = within(file, *view, "ymag", 0, largest_size);
        found.view = OrthographicView{2 * height};
        found.aspect = width / height;
    } else {
        file.fail("camera " + std::to_string(camera) + " is neither perspective nor orthographic");
    }
    return found;
}

Light light_of(const GltfFile& file, const GltfPlacedNode& node, std::uint64_t light, NamedOnce& not_shown) {
    // Find the light in the extension of the root.
    const Json* const extension = file.extension(file.root(), "KHR_lights_punctual");
    const auto lights = extension == nullptr ? Json::const_iterator() : extension->find("lights");
    if (extension == nullptr || lights == extension->end() || !lights->is_array() ||
        light >= lights->size() || !(*lights)[static_cast<std::size_t>(light)].is_object())
        file.fail("a node has light " + std::to_string(light) + ", which is not there");
    const Json& json = (*lights)[static_cast<std::size_t>(light)];

    // Read what all lights have.
    using Numbers = std::vector<double>;
    const Numbers c = file.numbers(json, "color", 3).value_or(Numbers{1, 1, 1});
    const double strength = file.real_or(json, "intensity", 1);
    const Vec3d power = Vec3d(c[0], c[1], c[2]) * strength;
    for (int k = 0; k < 3; ++k)
        if (!(power[k] >= 0 && power[k] < largest_size))
            file.fail("light " + std::to_string(light) + " is negative or too bright");
    if (json.contains("range")) not_shown.add("range of lights (KHR_lights_punctual)");
    const std::string name = name_of(file, json, node), type = file.text(json, "type");
    const Vec3d position = node.to_scene.point({});

    if (type == "directional") return DirectionalLight{name, forward(file, node), Vec3f(power)};
    if (type == "point") return PointLight{name, position, Vec3f(power)};
    if (type != "spot")
        file.fail("light " + std::to_string(light) + " is neither directional, point nor spot");
    SpotLight spot{
        .name = name, .position = position, .direction = forward(file, node), .intensity = Vec3f(power)};
    if (const Json* const cone = file.member(json, "spot")) {
        spot.inner = file.real_or(*cone, "innerConeAngle", spot.inner);
        spot.outer = file.real_or(*cone, "outerConeAngle", spot.outer);
    }
    constexpr double right_angle = std::numbers::pi / 2;
    if (!(spot.inner >= 0 && spot.inner < spot.outer && spot.outer <= right_angle * (1 + 0x1p-20)))
        file.fail("the angles of light " + std::to_string(light) + " do not ascend from 0 to a right angle");
    return spot;
}

}  // namespace hedgerow::detail
