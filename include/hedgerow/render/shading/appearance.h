/// What surfaces look like at hits, by the looks of a model.
#pragma once

#include <span>
#include <vector>

#include <hedgerow/looks/model.h>
#include <hedgerow/queries/hit.h>

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
    virtual Appearance at(const Hit<T>& hit) const = 0;
    /// Whether some surfaces have masks, so that rays go through parts of them; and whether a hit is on a
    /// part that is there. Rays from the eye and to the light take the second as their filter.
    virtual bool has_masks() const = 0;
    virtual bool is_there(const Hit<T>& hit) const = 0;
};

/// The looks of a model: `instance` of a hit is a place in `instances`, which names an instance of the model,
/// and `element` a triangle of its object. Borrows the model.
template <std::floating_point T>
class ModelAppearances final : public Appearances<T> {
public:
    ModelAppearances(const Model<T>& model, std::vector<std::uint32_t> instances)
        : model_(model), instances_(std::move(instances)) {
        for (const Material& m : model.materials) has_masks_ |= m.alpha_mode == AlphaMode::mask;
    }

    bool has_masks() const override { return has_masks_; }
    bool is_there(const Hit<T>& hit) const override {
        const Material& m = material(hit);
        return m.alpha_mode != AlphaMode::mask || alpha(m, hit) > 0;
    }
    Appearance at(const Hit<T>& hit) const override {
        const Material& m = material(hit);
        Appearance a;
        a.colour = m.base_colour;
        if (m.base_colour_texture) a.colour = times(a.colour, texel(m.base_colour_texture, hit).colour);
        if (const auto corner =
                object(hit).attributes.colours.at(object(hit).mesh, hit.element, u(hit), v(hit)))
            a.colour = times(a.colour, corner->colour);
        a.alpha = alpha(m, hit);
        a.emission = m.emission * m.emission_strength;
        if (m.emission_texture) a.emission = times(a.emission, texel(m.emission_texture, hit).colour);
        a.normal = normal(hit);
        a.unlit = m.unlit;
        return a;
    }

private:
    const PlacedObject& placed(const Hit<T>& hit) const { return model_.instances[instances_[hit.instance]]; }
    const Object<T>& object(const Hit<T>& hit) const { return model_.objects[placed(hit).object]; }
    const Material& material(const Hit<T>& hit) const {
        return model_.materials[object(hit).material_of(hit.element)];
    }
    static float u(const Hit<T>& hit) { return static_cast<float>(hit.u); }
    static float v(const Hit<T>& hit) { return static_cast<float>(hit.v); }
    static Vec3f times(const Vec3f& a, const Vec3f& b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }

    /// The texture of a slot at a hit; white where the surface lacks its coordinates.
    Rgba texel(const TextureSlot& slot, const Hit<T>& hit) const {
        const auto& sets = object(hit).attributes.texture_coordinates;
        if (slot.set >= sets.size()) return {Vec3f::all(1), 1};
        const auto at = sets[slot.set].at(object(hit).mesh, hit.element, u(hit), v(hit));
        return at ? model_.textures[slot.texture].at(slot.transform(*at)) : Rgba{Vec3f::all(1), 1};
    }
    static float channel(const Rgba& texel, std::uint8_t k) { return k < 3 ? texel.colour[k] : texel.alpha; }
    float alpha(const Material& m, const Hit<T>& hit) const {
        if (m.alpha_mode == AlphaMode::opaque) return 1;
        float alpha = m.alpha;
        if (m.alpha_texture) alpha *= channel(texel(m.alpha_texture, hit), m.alpha_texture.channel);
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
    bool has_masks_ = false;
};

}  // namespace hedgerow
