/// A material at a point, and the shares of its surface that are metal, coated matter, and transparent.
#pragma once

#include <hedgerow/render/scattering/fresnel.h>

namespace hedgerow {

/// A material at a point, its textures looked up; or the materials of four paths, of F = FloatLanes. Each
/// number means what it means in looks/material.h. Numbers beyond their range are clamped to it.
template <class F>
struct SurfaceMaterialOf {
    Vec<F, 3> base_colour = Vec<F, 3>::all(0.8f);
    F metallic = 0, roughness = 1;
    F ior = 1.5f, specular = 0;  ///< a specular of 0 leaves an opaque surface matte
    Vec<F, 3> specular_colour = Vec<F, 3>::all(1);
    /// The share of the matter below the surface that is transparent in place of matte.
    F transmission = 0;
    /// Light goes through a thin surface without being refracted. The boundary of a body that is not thin
    /// reflects and refracts by `ior` alone; `specular` does not change that.
    MaskOf<F> thin{true};
};
using SurfaceMaterial = SurfaceMaterialOf<float>;

/// A material in the terms of its lobes. The shares metal, opaque and through have the sum 1.
template <class F>
struct SurfacePartsOf {
    using Mask = MaskOf<F>;

    F metal = 0, opaque = 0, through = 0;
    Vec<F, 3> base;
    SchlickFresnelOf<F> metal_fresnel, coat;
    F roughness = 0;
    Mask thin{true};
    /// The index of refraction beyond the surface over that on the side of the eye. 1 for thin surfaces, and
    /// for bodies that refract so little that floats cannot tell it from going straight on.
    F eta = 1;
    /// The microfacets of a surface with α below 10⁻³ act as one.
    Mask mirror{false};

    /// `inside`: the eye's side is within the body, which matters only if the material is not thin.
    SurfacePartsOf(const SurfaceMaterialOf<F>& m, Mask inside)
        : metal(within_one(m.metallic)),
          base(map(m.base_colour, within_one)),
          roughness(within_one(m.roughness)),
          thin(m.thin) {
        through = product(1 - metal, within_one(m.transmission));
        opaque = greater(1 - metal - through, 0);
        metal_fresnel = {base, 1};
        const F ior = select(m.ior >= 0, lesser(m.ior, 0x1p20f), 1);
        const F amplitude = (ior - 1) / (ior + 1), f0 = product(amplitude, amplitude);
        const F specular = within_one(m.specular);
        coat = {map(m.specular_colour, [&](F c) { return product(within_one(product(f0, c)), specular); }),
                specular};
        const F alpha = product(roughness, roughness);
        mirror = alpha < 1e-3f;
        // The half vector of a refraction errs by about 10⁻⁷ / |η − 1|, which must be small beside α.
        const F body = clamped(ior, 0.1f, 10.0f);
        const F told = product(magnitude(body - 1), select(mirror, 1, alpha));
        eta = select(!thin && told > 1e-4f, select(inside, 1 / body, body), 1);
    }

    /// Whether light goes straight on through the transparent share.
    Mask straight() const { return equal(eta, 1); }
    Mask has_coat() const { return opaque > 0 && coat.f90 > 0; }
    /// What share of `through` a microfacet reflects at an angle with this cosine.
    F reflected_share(F c) const {
        return select(thin, max_component(coat.at(c)), only(!straight(), dielectric_reflectance(c, eta)));
    }
    /// The colour of a microfacet at an angle of incidence with cosine c.
    Vec<F, 3> reflected_colour(F c) const {
        Vec<F, 3> colour;
        if (any(metal > 0)) colour += only(metal > 0, metal_fresnel.at(c) * metal);
        if (any(has_coat())) colour += only(has_coat(), coat.at(c) * opaque);
        if (any(through > 0))
            colour +=
                only(through > 0, select(thin, coat.at(c), Vec<F, 3>::all(reflected_share(c))) * through);
        return colour;
    }
    /// The colour of what goes through a microfacet. It is that of energy, not yet of radiance.
    Vec<F, 3> transmitted_colour(F c) const {
        if (!any(through > 0)) return {};
        return only(through > 0, base * product(through, 1 - reflected_share(c)));
    }

private:
    /// x clamped to [0, 1]; 0 for NaN.
    static F within_one(F x) { return only(x > 0, lesser(x, 1)); }
};
using SurfaceParts = SurfacePartsOf<float>;

}  // namespace hedgerow
