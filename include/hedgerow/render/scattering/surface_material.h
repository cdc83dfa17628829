/// A material at a point, and the shares of its surface that are metal, coated matter, and transparent.
#pragma once

#include <algorithm>
#include <cmath>

#include <hedgerow/render/scattering/fresnel.h>

namespace hedgerow {

/// A material at a point, its textures looked up. Each number means what it means in looks/material.h.
/// Numbers beyond their range are clamped to it.
struct SurfaceMaterial {
    Vec3f base_colour = Vec3f::all(0.8f);
    float metallic = 0, roughness = 1;
    float ior = 1.5f, specular = 0;  ///< a specular of 0 leaves an opaque surface matte
    Vec3f specular_colour = Vec3f::all(1);
    /// The share of the matter below the surface that is transparent in place of matte.
    float transmission = 0;
    /// Light goes through a thin surface without being refracted. The boundary of a body that is not thin
    /// reflects and refracts by `ior` alone; `specular` does not change that.
    bool thin = true;
};

/// A material in the terms of its lobes. The shares metal, opaque and through have the sum 1.
struct SurfaceParts {
    float metal = 0, opaque = 0, through = 0;
    Vec3f base;
    SchlickFresnel metal_fresnel, coat;
    float roughness = 0;
    bool thin = true;
    /// The index of refraction beyond the surface over that on the side of the eye. 1 for thin surfaces, and
    /// for bodies that refract so little that floats cannot tell it from going straight on.
    float eta = 1;
    /// The microfacets of a surface with α below 10⁻³ act as one.
    bool mirror = false;

    /// `inside`: the eye's side is within the body, which matters only if the material is not thin.
    SurfaceParts(const SurfaceMaterial& m, bool inside)
        : metal(within_one(m.metallic)),
          base(map(m.base_colour, within_one)),
          roughness(within_one(m.roughness)) {
        through = product(1 - metal, within_one(m.transmission));
        opaque = std::max(1 - metal - through, 0.0f);
        metal_fresnel = {base, 1};
        const float ior = m.ior >= 0 ? std::min(m.ior, 0x1p20f) : 1.0f;
        const float root = (ior - 1) / (ior + 1), f0 = product(root, root);
        const float specular = within_one(m.specular);
        coat = {
            map(m.specular_colour, [&](float c) { return product(within_one(product(f0, c)), specular); }),
            specular};
        const float alpha = product(roughness, roughness);
        mirror = alpha < 1e-3f;
        thin = m.thin;
        if (thin) return;
        const float body = std::clamp(ior, 0.1f, 10.0f);
        // The half vector of a refraction errs by about 10⁻⁷ / |η − 1|, which must be small beside α.
        if (product(std::abs(body - 1), mirror ? 1.0f : alpha) > 1e-4f) eta = inside ? 1 / body : body;
    }

    /// Whether light goes straight on through the transparent share.
    bool straight() const { return eta == 1; }
    bool has_coat() const { return opaque > 0 && coat.f90 > 0; }
    /// What share of `through` a microfacet reflects at an angle with this cosine.
    float reflected_share(float c) const {
        if (thin) return max_component(coat.at(c));
        return straight() ? 0.0f : dielectric_reflectance(c, eta);
    }
    /// The colour of a microfacet at an angle of incidence with cosine c.
    Vec3f reflected_colour(float c) const {
        Vec3f colour;
        if (metal > 0) colour += metal_fresnel.at(c) * metal;
        if (has_coat()) colour += coat.at(c) * opaque;
        if (through > 0) colour += (thin ? coat.at(c) : Vec3f::all(reflected_share(c))) * through;
        return colour;
    }
    /// The colour of what goes through a microfacet. It is that of energy, not yet of radiance.
    Vec3f transmitted_colour(float c) const {
        return through > 0 ? base * product(through, 1 - reflected_share(c)) : Vec3f();
    }

private:
    /// x clamped to [0, 1]; 0 for NaN.
    static float within_one(float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; }
};

}  // namespace hedgerow
