/// The materials and textures of glTF 2.0.
#pragma once

#include <cstdint>

#include <hedgerow/looks/material.h>

#include "gltf_file.h"
#include "named_once.h"
#include "texture_shelf.h"

namespace hedgerow::detail {

/// Reads materials, which its textures are put on a shelf for. Whatever a Material lacks is added to
/// `not_shown`.
class GltfMaterials {
public:
    GltfMaterials(GltfFile& file, TextureShelf& textures, NamedOnce& not_shown)
        : file_(file), textures_(textures), not_shown_(not_shown) {}

    /// Throws InputError for a material that does not exist, and for members of a wrong type or range.
    Material read(std::uint64_t number);
    /// What the specification prescribes for a primitive without a material.
    static Material standard();

private:
    using Json = GltfFile::Json;

    void read_metallic_roughness(const Json& json, Material& m);
    void read_specular_glossiness(const Json& json, Material& m);
    void read_alpha(const Json& json, Material& m);
    void read_emission(const Json& json, Material& m);
    void read_specular(const Json& json, Material& m);
    void read_transmission(const Json& json, Material& m);

    /// The slot of the texture `key` of an object; without a texture if there is none.
    TextureSlot slot(const Json& object, const char* key, ColourSpace space, std::uint8_t channel = 0);
    std::optional<std::uint32_t> texture(std::uint64_t number, ColourSpace space);
    std::optional<std::uint64_t> image_of(std::uint64_t texture) const;
    float factor(const Json& object, const char* key, double otherwise, double most = 1) const;
    Vec3f colour(const Json& object, const char* key, const Vec3f& otherwise) const;

    GltfFile& file_;
    TextureShelf& textures_;
    NamedOnce& not_shown_;
};

/// Whether load_model reads an extension, or it changes nothing that a model shows.
bool is_read_by_models(const std::string& extension);

}  // namespace hedgerow::detail
