/// What surfaces look like at hits, by the looks of a model.
#pragma once

#include <hedgerow/render/shading/model_lookups.h>

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

/// The looks of a model, by its lookups, whose hits it is asked about. Borrows them.
template <std::floating_point T>
class ModelAppearances final : public Appearances<T> {
public:
    explicit ModelAppearances(const ModelLookups<T>& lookups) : lookups_(lookups) {
        for (const Material& m : lookups.model().materials) has_masks_ |= m.alpha_mode == AlphaMode::mask;
    }

    bool has_masks() const override { return has_masks_; }
    bool is_there(const Hit<T>& hit) const override {
        return lookups_.material(hit).alpha_mode != AlphaMode::mask || lookups_.alpha(hit, {}) > 0;
    }
    Appearance at(const Hit<T>& hit, const SurfaceFootprint& part) const override {
        const auto extent = lookups_.extent_of(hit, part);
        return {lookups_.base_colour(hit, extent), lookups_.alpha(hit, extent),
                lookups_.emission(hit, extent), lookups_.own_normal(hit, extent),
                lookups_.material(hit).unlit};
    }

private:
    const ModelLookups<T>& lookups_;
    bool has_masks_ = false;
};

}  // namespace hedgerow
