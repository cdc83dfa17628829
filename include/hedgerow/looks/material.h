/// What a surface does to light: the metallic-roughness model of glTF 2.0.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// An affine map of texture coordinates (KHR_texture_transform): u' = u·(u, v, 1), v' = v·(u, v, 1).
struct TextureTransform {
    Vec3f u{1, 0, 0}, v{0, 1, 0};

    Vec2f operator()(const Vec2f& c) const {
        const Vec3f point(c[0], c[1], 1);
        return {dot(u, point), dot(v, point)};
    }
    /// The map of a difference of coordinates.
    Vec2f of_difference(const Vec2f& d) const {
        const Vec3f difference(d[0], d[1], 0);
        return {dot(u, difference), dot(v, difference)};
    }
    friend bool operator==(const TextureTransform&, const TextureTransform&) = default;
};

/// The ordinal of a texture that does not exist.
inline constexpr std::uint32_t no_texture = 0xFFFFFFFFu;

/// Which texture of the model varies a property, and by which texture coordinates.
struct TextureSlot {
    std::uint32_t texture = no_texture;
    std::uint32_t set = 0;     ///< of the texture coordinates
    std::uint8_t channel = 0;  ///< 0 to 3 for red to opacity, of a property that is one number
    TextureTransform transform;

    explicit operator bool() const { return texture != no_texture; }
};

/// How opacity is used: not at all, as a decision at `alpha_cutoff`, or as coverage.
enum class AlphaMode : std::uint8_t { opaque, mask, blend };

/// Constants and textures; where a property has both, they are multiplied. Colours are linear with the
/// primaries of sRGB. The model is appendix B of the glTF 2.0 specification (Khronos Group 2021) with
/// extensions that are named below. The defaults are a grey matte surface with two sides.
struct Material {
    std::string name;

    Vec3f base_colour = Vec3f::all(0.8f);  ///< also multiplied by the colours of the corners
    float alpha = 1;                       ///< opacity; also multiplied by that of the corners
    TextureSlot base_colour_texture, alpha_texture;
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;  ///< opaque from here on, where the mode is `mask`

    float metallic = 0;
    float roughness = 1;  ///< the square root of GGX's α
    TextureSlot metallic_texture, roughness_texture;

    /// A dielectric reflects min(f0·specular_colour, 1)·specular at normal incidence, with
    /// f0 = ((ior − 1) / (ior + 1))² (KHR_materials_ior, KHR_materials_specular). `specular` is 0 for a
    /// surface that is only matte.
    float ior = 1.5f;
    float specular = 0;
    Vec3f specular_colour = Vec3f::all(1);

    /// Emitted radiance: the product of all three (KHR_materials_emissive_strength).
    Vec3f emission;
    float emission_strength = 1;
    TextureSlot emission_texture;

    /// A map of normals in tangent space. Its x and y are multiplied by the scale.
    TextureSlot normal_texture;
    float normal_scale = 1;

    /// The share of light that is not reflected at the surface and passes through it
    /// (KHR_materials_transmission).
    float transmission = 0;
    TextureSlot transmission_texture;
    /// Light goes through a surface that is thin without being refracted. A surface that is not thin bounds
    /// a body, in which light has the colour `attenuation_colour` after `attenuation_distance`
    /// (KHR_materials_volume). The distance is in the object's units.
    bool thin = true;
    Vec3f attenuation_colour = Vec3f::all(1);
    float attenuation_distance = std::numeric_limits<float>::infinity();

    bool double_sided = true;
    bool unlit = false;  ///< shows its base colour, whatever the light (KHR_materials_unlit)
};

}  // namespace hedgerow
