/// glTF 2.0, sections 3.8 and 3.9, and Khronos's extensions of materials and textures.
#include "gltf_materials.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <string>

#include <hedgerow/geometry/elementary.h>

#include "gltf_draco.h"
#include "text.h"

namespace hedgerow::detail {

namespace {

/// Values of glTF, which are those of OpenGL.
enum class SamplerValue : std::uint64_t {
    nearest = 9728,
    nearest_mipmap_nearest = 9984,
    nearest_mipmap_linear = 9986,
    clamp = 33071,
    mirror = 33648
};

Wrap wrap_of(std::uint64_t value) {
    if (value == static_cast<std::uint64_t>(SamplerValue::clamp)) return Wrap::clamp;
    return value == static_cast<std::uint64_t>(SamplerValue::mirror) ? Wrap::mirror : Wrap::repeat;
}

/// KHR_texture_transform: scales, then turns counterclockwise as seen with v downwards, then moves. The code
/// in its text turns the other way than its words and all programs do (KhronosGroup/glTF, issue 1563).
TextureTransform texture_transform_of(const GltfFile& file, const GltfFile::Json& json) {
    using Numbers = std::vector<double>;
    const Numbers offset = file.numbers(json, "offset", 2).value_or(Numbers{0, 0});
    const Numbers scale = file.numbers(json, "scale", 2).value_or(Numbers{1, 1});
    const double angle = file.real_or(json, "rotation", 0), c = cosine(angle), s = sine(angle);
    return {{rounded<float>(c * scale[0]), rounded<float>(s * scale[1]), rounded<float>(offset[0])},
            {rounded<float>(-s * scale[0]), rounded<float>(c * scale[1]), rounded<float>(offset[1])}};
}

/// The first three numbers as a colour, which must be from 0 to what a float can be multiplied with.
Vec3f colour_of(const GltfFile& file, const std::vector<double>& numbers, const char* key) {
    for (std::size_t k = 0; k < 3; ++k)
        if (!(numbers[k] >= 0 && numbers[k] <= 0x1p60))
            file.fail(std::string("'") + key + "' is negative or too large");
    return Vec3f(Vec3d(numbers[0], numbers[1], numbers[2]));
}

}  // namespace

bool is_read_by_models(const std::string& extension) {
    constexpr std::string_view known[] = {
        "KHR_materials_transmission", "KHR_materials_ior",
        "KHR_materials_volume",       "KHR_materials_unlit",
        "KHR_materials_specular",     "KHR_materials_emissive_strength",
        "KHR_texture_transform",      "KHR_lights_punctual",
        "KHR_mesh_quantization",      "KHR_materials_pbrSpecularGlossiness"};
    if (extension == "KHR_draco_mesh_compression") return draco_supported();
    return std::find(std::begin(known), std::end(known), extension) != std::end(known);
}

Material GltfMaterials::standard() {
    Material m;
    m.base_colour = Vec3f::all(1);
    m.metallic = 1;
    m.specular = 1;
    m.double_sided = false;
    return m;
}

Material GltfMaterials::read(std::uint64_t number) {
    const Json& json = file_.object("materials", number);
    Material m = standard();
    m.name = file_.text(json, "name");
    if (const Json* const pbr = file_.member(json, "pbrMetallicRoughness")) read_metallic_roughness(*pbr, m);
    read_specular_glossiness(json, m);
    read_alpha(json, m);
    read_emission(json, m);
    read_specular(json, m);
    read_transmission(json, m);
    m.normal_texture = slot(json, "normalTexture", ColourSpace::linear);
    if (const Json* const normal = file_.member(json, "normalTexture"))
        m.normal_scale = rounded<float>(file_.real_or(*normal, "scale", 1));
    if (json.contains("occlusionTexture")) not_shown_.add("occlusionTexture (glTF)");
    m.double_sided = file_.flag(json, "doubleSided");
    m.unlit = file_.extension(json, "KHR_materials_unlit") != nullptr;
    if (const Json* const all = file_.member(json, "extensions"))
        for (const auto& [name, value] : all->items())
            if (!is_read_by_models(name)) not_shown_.add(name);
    return m;
}

void GltfMaterials::read_metallic_roughness(const Json& json, Material& m) {
    if (const auto c = file_.numbers(json, "baseColorFactor", 4)) {
        m.base_colour = colour_of(file_, *c, "baseColorFactor");
        m.alpha = static_cast<float>(std::clamp((*c)[3], 0.0, 1.0));
    }
    m.base_colour_texture = slot(json, "baseColorTexture", ColourSpace::srgb);
    m.metallic = factor(json, "metallicFactor", 1);
    m.roughness = factor(json, "roughnessFactor", 1);
    m.roughness_texture = slot(json, "metallicRoughnessTexture", ColourSpace::linear, 1);
    m.metallic_texture = slot(json, "metallicRoughnessTexture", ColourSpace::linear, 2);
}

void GltfMaterials::read_specular_glossiness(const Json& json, Material& m) {
    const Json* const old = file_.extension(json, "KHR_materials_pbrSpecularGlossiness");
    if (old == nullptr) return;
    const auto diffuse = file_.numbers(*old, "diffuseFactor", 4).value_or(std::vector<double>{1, 1, 1, 1});
    m.base_colour = colour_of(file_, diffuse, "diffuseFactor");
    m.alpha = static_cast<float>(std::clamp(diffuse[3], 0.0, 1.0));
    m.base_colour_texture = slot(*old, "diffuseTexture", ColourSpace::srgb);
    m.metallic = 0, m.metallic_texture = {};
    m.roughness = 1 - factor(*old, "glossinessFactor", 1);
    m.roughness_texture = {};
    // The reflection at normal incidence, as a share of that of the usual index of refraction.
    m.specular_colour = colour(*old, "specularFactor", Vec3f::all(1)) * 25.f;
    if (old->contains("specularGlossinessTexture"))
        not_shown_.add("specularGlossinessTexture of KHR_materials_pbrSpecularGlossiness");
}

void GltfMaterials::read_alpha(const Json& json, Material& m) {
    const std::string mode = file_.text(json, "alphaMode");
    if (mode == "MASK")
        m.alpha_mode = AlphaMode::mask;
    else if (mode == "BLEND")
        m.alpha_mode = AlphaMode::blend;
    else if (!mode.empty() && mode != "OPAQUE")
        file_.fail("'alphaMode' is neither OPAQUE, MASK nor BLEND");
    m.alpha_cutoff = rounded<float>(file_.real_or(json, "alphaCutoff", 0.5));
    if (m.alpha_mode == AlphaMode::opaque || !m.base_colour_texture) return;
    m.alpha_texture = m.base_colour_texture;
    m.alpha_texture.channel = 3;
}

void GltfMaterials::read_emission(const Json& json, Material& m) {
    m.emission = colour(json, "emissiveFactor", {});
    m.emission_texture = slot(json, "emissiveTexture", ColourSpace::srgb);
    if (const Json* const strength = file_.extension(json, "KHR_materials_emissive_strength"))
        m.emission_strength =
            factor(*strength, "emissiveStrength", 1, static_cast<double>(std::numeric_limits<float>::max()));
}

void GltfMaterials::read_specular(const Json& json, Material& m) {
    if (const Json* const ior = file_.extension(json, "KHR_materials_ior")) {
        const double index = file_.real_or(*ior, "ior", 1.5);
        // 0 stands for an infinite index: all light is reflected.
        if (index != 0 && !(index >= 1 && index < 1e6)) file_.fail("'ior' is neither 0 nor 1 or more");
        m.ior = index == 0 ? 1e6f : static_cast<float>(index);
    }
    const Json* const specular = file_.extension(json, "KHR_materials_specular");
    if (specular == nullptr) return;
    m.specular = factor(*specular, "specularFactor", 1);
    m.specular_colour = colour(*specular, "specularColorFactor", Vec3f::all(1));
    for (const char* const key : {"specularTexture", "specularColorTexture"})
        if (specular->contains(key)) not_shown_.add(std::string(key) + " of KHR_materials_specular");
}

void GltfMaterials::read_transmission(const Json& json, Material& m) {
    if (const Json* const transmission = file_.extension(json, "KHR_materials_transmission")) {
        m.transmission = factor(*transmission, "transmissionFactor", 0);
        m.transmission_texture = slot(*transmission, "transmissionTexture", ColourSpace::linear);
    }
    const Json* const volume = file_.extension(json, "KHR_materials_volume");
    if (volume == nullptr) return;
    m.thin = !(file_.real_or(*volume, "thicknessFactor", 0) > 0);
    m.attenuation_colour = colour(*volume, "attenuationColor", Vec3f::all(1));
    if (volume->contains("attenuationDistance")) {
        const double distance = file_.real_or(*volume, "attenuationDistance", 0);
        if (!(distance > 0)) file_.fail("'attenuationDistance' is not positive");
        m.attenuation_distance = rounded<float>(distance);
    }
}

float GltfMaterials::factor(const Json& object, const char* key, double otherwise, double most) const {
    const double x = file_.real_or(object, key, otherwise);
    if (!(x >= 0 && x <= most))
        file_.fail(std::string("'") + key + "' is " + std::to_string(x) + ", but should be from 0 to " +
                   (most == 1 ? "1" : "the largest float"));
    return static_cast<float>(x);
}

Vec3f GltfMaterials::colour(const Json& object, const char* key, const Vec3f& otherwise) const {
    const auto c = file_.numbers(object, key, 3);
    return c ? colour_of(file_, *c, key) : otherwise;
}

TextureSlot GltfMaterials::slot(const Json& object, const char* key, ColourSpace space,
                                std::uint8_t channel) {
    TextureSlot slot;
    const Json* const info = file_.member(object, key);
    if (info == nullptr) return slot;
    slot.texture = texture(file_.needed_number(*info, "index"), space).value_or(no_texture);
    slot.channel = channel;
    std::uint64_t set = file_.number_or(*info, "texCoord", 0);
    if (const Json* const transform = file_.extension(*info, "KHR_texture_transform")) {
        slot.transform = texture_transform_of(file_, *transform);
        set = file_.number_or(*transform, "texCoord", set);
    }
    slot.set = static_cast<std::uint32_t>(std::min<std::uint64_t>(set, 0xFFFFFFFFu));
    return slot;
}

std::optional<std::uint64_t> GltfMaterials::image_of(std::uint64_t texture) const {
    const Json& json = file_.object("textures", texture);
    // An extension may name an image of another format beside one that everybody reads.
    if (const Json* const all = file_.member(json, "extensions"))
        for (const auto& [name, value] : all->items()) not_shown_.add(name);
    return file_.number(json, "source");
}

std::optional<std::uint32_t> GltfMaterials::texture(std::uint64_t number, ColourSpace space) {
    const auto image = image_of(number);
    const Json& json = file_.object("textures", number);
    Texture like;
    like.space = space;
    like.name = image ? file_.image_name(*image) : "texture " + std::to_string(number);
    if (const auto sampler = file_.number(json, "sampler")) {
        const Json& values = file_.object("samplers", *sampler);
        like.wrap_s = wrap_of(file_.number_or(values, "wrapS", 0));
        like.wrap_t = wrap_of(file_.number_or(values, "wrapT", 0));
        if (file_.number_or(values, "magFilter", 0) == static_cast<std::uint64_t>(SamplerValue::nearest))
            like.filter = TextureFilter::nearest;
    }
    return textures_.texture(like, space == ColourSpace::srgb, [&](const PixelLimits& limits) {
        if (!image) {
            std::string others;
            if (const Json* const all = file_.member(json, "extensions"))
                for (const auto& [name, value] : all->items()) others += (others.empty() ? "" : ", ") + name;
            file_.fail("texture " + std::to_string(number) +
                       (others.empty() ? " has no 'source'"
                                       : " has only an image of " + others + ", which is not read"));
        }
        std::string own;
        const std::string_view bytes = file_.image(*image, own);
        return decode_pixels(bytes, file_.name() + ", " + like.name, limits);
    });
}

}  // namespace hedgerow::detail
