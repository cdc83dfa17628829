/// What surfaces look like at hits, by the looks of a model.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include <hedgerow/looks/model.h>
#include <hedgerow/looks/texture_levels.h>
#include <hedgerow/queries/hit.h>
#include <hedgerow/render/shading/footprint.h>

namespace hedgerow {

/// What a surface shows at a hit. Colours are linear.
struct Appearance {
    Vec3f colour = Vec3f::all(0.8f);
    float alpha = 1;  ///< opacity; of a mask 0 or 1
    Vec3f emission;
    Vec3f normal;  ///< of length 1, in the world, on either side; 0 where the surface has no own normals
    bool unlit = false;
};

/// What hits look like, behind one type. Const use is thread-safe.
template <std::floating_point T>
class Appearances {
public:
    virtual ~Appearances() = default;
    /// What the part of the surface around a hit looks like in the mean; what the hit does, if the part has
    /// no extent.
    virtual Appearance at(const Hit<T>& hit, const SurfaceFootprint& part) const = 0;
    /// Whether some surfaces have masks, so that rays go through parts of them; and whether a hit is on a
    /// part that is there. Rays from the eye and to the light take the second as their filter.
    virtual bool has_masks() const = 0;
    virtual bool is_there(const Hit<T>& hit) const = 0;
};

/// The looks of a model: `instance` of a hit is a place in `instances`, which names an instance of the model,
/// and `element` a triangle of its object. Textures are averaged over parts of surfaces; the levels of a
/// texture are computed at its first lookup with an extent. Borrows the model.
template <std::floating_point T>
class ModelAppearances final : public Appearances<T> {
public:
    ModelAppearances(const Model<T>& model, std::vector<std::uint32_t> instances)
        : model_(model), instances_(std::move(instances)), levels_(model.textures.size()) {
        for (const Material& m : model.materials) has_masks_ |= m.alpha_mode == AlphaMode::mask;
    }

    bool has_masks() const override { return has_masks_; }
    bool is_there(const Hit<T>& hit) const override {
        const Material& m = material(hit);
        return m.alpha_mode != AlphaMode::mask || alpha(m, hit, {}) > 0;
    }
    Appearance at(const Hit<T>& hit, const SurfaceFootprint& part) const override {
        const Material& m = material(hit);
        const Extent extent = extent_of(hit, part);
        Appearance a;
        a.colour = m.base_colour;
        if (m.base_colour_texture)
            a.colour = times(a.colour, texel(m.base_colour_texture, hit, extent).colour);
        if (const auto corner =
                object(hit).attributes.colours.at(object(hit).mesh, hit.element, u(hit), v(hit)))
            a.colour = times(a.colour, corner->colour);
        a.alpha = alpha(m, hit, extent);
        a.emission = m.emission * m.emission_strength;
        if (m.emission_texture) a.emission = times(a.emission, texel(m.emission_texture, hit, extent).colour);
        a.normal = normal(hit);
        a.unlit = m.unlit;
        return a;
    }

private:
    /// Half axes of a part of a triangle, by how u and v change along them.
    struct Extent {
        Vec2f a, b;
    };
    struct LevelsOnDemand {
        std::once_flag computed;
        std::unique_ptr<const TextureLevels> levels;
    };

    const PlacedObject& placed(const Hit<T>& hit) const { return model_.instances[instances_[hit.instance]]; }
    const Object<T>& object(const Hit<T>& hit) const { return model_.objects[placed(hit).object]; }
    const Material& material(const Hit<T>& hit) const {
        return model_.materials[object(hit).material_of(hit.element)];
    }
    static float u(const Hit<T>& hit) { return static_cast<float>(hit.u); }
    static float v(const Hit<T>& hit) { return static_cast<float>(hit.v); }
    static Vec3f times(const Vec3f& a, const Vec3f& b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }

    Extent extent_of(const Hit<T>& hit, const SurfaceFootprint& part) const {
        if (part.a == Vec3d() && part.b == Vec3d()) return {};
        const auto triangle = object(hit).mesh.view().triangle(hit.element);
        const Vec3d ab = Vec3d(triangle.b) - Vec3d(triangle.a), ac = Vec3d(triangle.c) - Vec3d(triangle.a);
        const Vec3d normal = cross(ab, ac);
        const auto& back = placed(hit).to_world.back();
        const auto along = [&](const Vec3d& axis) {
            const Vec3d d = back.vector(axis);
            return Vec2f(Vec2d(dot(cross(d, ac), normal), dot(cross(ab, d), normal)) / length2(normal));
        };
        return {along(part.a), along(part.b)};
    }
    /// The texture of a slot around a hit; white where the surface lacks its coordinates.
    Rgba texel(const TextureSlot& slot, const Hit<T>& hit, const Extent& extent) const {
        const auto& sets = object(hit).attributes.texture_coordinates;
        if (slot.set >= sets.size()) return {Vec3f::all(1), 1};
        const CornerValues<Vec2f>& set = sets[slot.set];
        const TriangleMesh<T>& mesh = object(hit).mesh;
        const auto at = set.at(mesh, hit.element, u(hit), v(hit));
        if (!at) return {Vec3f::all(1), 1};
        const Texture& texture = model_.textures[slot.texture];
        if (extent.a == Vec2f() && extent.b == Vec2f()) return texture.at(slot.transform(*at));
        const auto along = [&](const Vec2f& axis) {
            return slot.transform.of_difference(*set.difference(mesh, hit.element, axis[0], axis[1]));
        };
        return levels_of(slot.texture).at(texture, slot.transform(*at), {along(extent.a), along(extent.b)});
    }
    /// Textures of the same pixels and colour space share their levels.
    const TextureLevels& levels_of(std::uint32_t texture) const {
        const Texture& t = model_.textures[texture];
        std::size_t first = 0;
        while (model_.textures[first].pixels != t.pixels || model_.textures[first].space != t.space) ++first;
        LevelsOnDemand& l = levels_[first];
        std::call_once(l.computed, [&] { l.levels = std::make_unique<const TextureLevels>(t); });
        return *l.levels;
    }
    static float channel(const Rgba& texel, std::uint8_t k) { return k < 3 ? texel.colour[k] : texel.alpha; }
    float alpha(const Material& m, const Hit<T>& hit, const Extent& extent) const {
        if (m.alpha_mode == AlphaMode::opaque) return 1;
        float alpha = m.alpha;
        if (m.alpha_texture) alpha *= channel(texel(m.alpha_texture, hit, extent), m.alpha_texture.channel);
        if (const auto corner =
                object(hit).attributes.colours.at(object(hit).mesh, hit.element, u(hit), v(hit)))
            alpha *= corner->alpha;
        if (m.alpha_mode == AlphaMode::mask) return alpha >= m.alpha_cutoff ? 1.0f : 0.0f;
        return alpha;
    }
    /// The surface's own normal, which transforms by the inverse transposed.
    Vec3f normal(const Hit<T>& hit) const {
        const auto own = object(hit).attributes.normals.at(object(hit).mesh, hit.element, u(hit), v(hit));
        if (!own) return {};
        const auto& back = placed(hit).to_world.back().linear;
        Vec3d there;
        for (int k = 0; k < 3; ++k)
            for (int j = 0; j < 3; ++j)
                there[k] += product(back[static_cast<std::size_t>(j)][k], static_cast<double>((*own)[j]));
        return Vec3f(normalized(there));
    }

    const Model<T>& model_;
    std::vector<std::uint32_t> instances_;
    mutable std::vector<LevelsOnDemand> levels_;  // by texture
    bool has_masks_ = false;
};

}  // namespace hedgerow
