/// Helpers for tests of models: their triangles written out.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include <hedgerow/io/model_file.h>

#include "io_support.h"

namespace hedgerow::testing_io {

template <class T>
using Corners = std::array<Vec<T, 3>, 3>;

template <class T>
std::vector<Corners<T>> corners_of(const TriangleMesh<T>& mesh) {
    std::vector<Corners<T>> all;
    for (const TriangleIndices& t : mesh.triangles)
        all.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
    return all;
}

/// The triangles of all instances, as load_mesh writes them out.
template <class T>
std::vector<Corners<T>> corners_of(const Model<T>& model) {
    return corners_of(model.in_world());
}

/// Expects a model whose ordinals all name something, and as many values as the mesh needs.
template <class T>
void expect_sound(const Model<T>& model) {
    ASSERT_FALSE(model.materials.empty());
    const auto expect_values = [](const auto& values, const TriangleMesh<T>& mesh) {
        if (values.empty()) return;
        ASSERT_EQ(values.corners.empty() ? values.values.size() : values.corners.size(),
                  values.corners.empty() ? mesh.vertices.size() : mesh.size());
        for (const TriangleIndices& corners : values.corners)
            for (const std::uint32_t v : corners) ASSERT_TRUE(v == no_value || v < values.values.size());
    };
    for (const Object<T>& object : model.objects) {
        ASSERT_TRUE(object.materials.empty() || object.materials.size() == object.mesh.size());
        for (std::size_t i = 0; i < object.mesh.size(); ++i)
            ASSERT_LT(object.material_of(i), model.materials.size());
        expect_values(object.attributes.normals, object.mesh);
        expect_values(object.attributes.colours, object.mesh);
        for (const auto& set : object.attributes.texture_coordinates) expect_values(set, object.mesh);
    }
    for (const PlacedObject& placed : model.instances) ASSERT_LT(placed.object, model.objects.size());
    for (const Material& m : model.materials)
        for (const TextureSlot* slot :
             {&m.base_colour_texture, &m.alpha_texture, &m.metallic_texture, &m.roughness_texture,
              &m.emission_texture, &m.normal_texture, &m.transmission_texture})
            ASSERT_TRUE(!*slot || slot->texture < model.textures.size());
    for (const Texture& texture : model.textures) ASSERT_TRUE(texture.pixels);
}

}  // namespace hedgerow::testing_io
