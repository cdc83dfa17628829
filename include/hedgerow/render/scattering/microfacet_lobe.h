/// Light that meets one microfacet of a rough surface: it is reflected, refracted, or goes straight on.
#pragma once

#include <concepts>

#include <hedgerow/render/scattering/ggx.h>
#include <hedgerow/render/scattering/surface_material.h>

namespace hedgerow {

/// A direction that a surface chose for a path.
template <class F>
struct ScatteredDirectionOf {
    /// Whether there is one. Otherwise the path ends, and the rest has no meaning.
    MaskOf<F> exists{false};
    Vec<F, 3> direction;  ///< in local space, of length 1
    /// The value of the surface times |cos| over the density: what a path's throughput is multiplied by.
    Vec<F, 3> weight;
    F density = 0;                 ///< per solid angle; 0 of a lobe that is a single direction
    MaskOf<F> specular{false};     ///< the direction is the only one of its lobe
    MaskOf<F> transmitted{false};  ///< to the other side of the surface

    explicit operator bool() const requires std::same_as<F, float> { return exists; }
};
using ScatteredDirection = ScatteredDirectionOf<float>;

/// What a surface scatters from one direction to another, apart from single directions.
template <class F>
struct ScatteredLightOf {
    Vec<F, 3> value;  ///< times |cos|
    F density = 0;    ///< of sampling that direction, per solid angle
};
using ScatteredLight = ScatteredLightOf<float>;

/// The reflection and transmission by microfacets, of all shares of a surface together: they have one
/// roughness. Refraction is that of Walter et al. 2007, in terms of radiance: where light comes from a medium
/// of index η_i to an eye in one of index η_o, it has the factor (η_o/η_i)². On a thin surface what goes
/// through is the reflection, mirrored to the other side (KHR_materials_transmission).
///
/// o[2] is above 0 in all functions.
template <class F>
class MicrofacetLobe {
    using Mask = MaskOf<F>;
    using Direction = Vec<F, 3>;

public:
    /// Borrows the parts.
    explicit MicrofacetLobe(const SurfacePartsOf<F>& parts)
        : parts_(parts),
          ggx_(greater(product(parts.roughness, parts.roughness), 1e-3f)),
          radiance_(1 / product(parts.eta, parts.eta)) {}

    Mask exists() const { return parts_.metal > 0 || parts_.through > 0 || parts_.has_coat(); }
    /// Whether reflection is a single direction, and whether transmission is.
    Mask mirrors() const { return parts_.mirror; }
    Mask transmits_singly() const { return parts_.mirror || (!parts_.thin && parts_.straight()); }

    /// The value times |cos| and the density of `sample` per solid angle, without single directions.
    ScatteredLightOf<F> at(const Direction& o, const Direction& i) const {
        const Half half = half_of(o, i);
        const Mask up = i[2] > 0, there = half.density > 0;
        if (!any(there)) return {};
        const F light = product(half.density, ggx_.unshadowed(o[2], magnitude(i[2])));
        const F reflects = chance_of_reflection(half.cosine);
        ScatteredLightOf<F> s{parts_.reflected_colour(half.cosine) * light, product(half.density, reflects)};
        if (any(there && !up)) {
            s.value = select(up, s.value, parts_.transmitted_colour(half.cosine) * product(light, radiance_));
            s.density = select(up, s.density, product(half.density, 1 - reflects));
        }
        return {only(there, s.value), only(there, s.density)};
    }
    /// Chooses a microfacet that o sees by (u, v), and whether it reflects by `choice`, in proportion to
    /// the luminance of both. The weight and density of the result are set only if it is specular. There is
    /// none where the mirror is black, or sends light into the surface.
    ScatteredDirectionOf<F> sample(const Direction& o, F choice, F u, F v) const {
        const auto h = select(parts_.mirror, Direction(0, 0, 1), ggx_.visible_normal(o, u, v));
        const F c = clamped(dot(o, h), 0, 1), reflects = chance_of_reflection(c);
        ScatteredDirectionOf<F> s;
        s.transmitted = !(choice < reflects);
        s.specular = select(s.transmitted, transmits_singly(), parts_.mirror);
        s.direction = reflected(o, h);
        if (any(s.transmitted)) s.direction = select(s.transmitted, through(o, h), s.direction);
        s.exists = select(s.transmitted, s.direction[2]<0, s.direction[2]> 0);
        if (!any(s.specular)) return s;
        const F chance = select(s.transmitted, 1 - reflects, reflects);
        const auto colour =
            select(s.transmitted, parts_.transmitted_colour(c) * radiance_, parts_.reflected_colour(c));
        s.exists = s.exists && (!s.specular || (chance > 0 && max_component(colour) > 0));
        s.weight = colour / chance;
        return s;
    }

private:
    /// The microfacet that sends o to i: the density of i if that mirror's kind of scattering is sure, and
    /// the cosine of o to its normal. The density is 0 where there is none.
    struct Half {
        F density = 0, cosine = 0;
    };

    Half half_of(const Direction& o, const Direction& i) const {
        const Mask down = i[2] < 0 && parts_.through > 0 && !transmits_singly();
        const Mask reflects = (i[2] > 0 && !parts_.mirror) || (down && parts_.thin),
                   refracts = down && !parts_.thin;
        Half half;
        if (any(reflects)) {
            const Half found = half_of_reflection(o, Direction(i[0], i[1], magnitude(i[2])));
            half = {only(reflects, found.density), only(reflects, found.cosine)};
        }
        if (any(refracts)) {
            const Half found = half_of_refraction(o, i);
            half = {select(refracts, found.density, half.density),
                    select(refracts, found.cosine, half.cosine)};
        }
        return half;
    }
    Half half_of_reflection(const Direction& o, const Direction& i) const {
        const auto h = normalized(o + i);
        return {ggx_.reflected_density(o, h), clamped(dot(o, h), 0, 1)};
    }
    Half half_of_refraction(const Direction& o, const Direction& i) const {
        auto h = o + i * parts_.eta;
        const F size2 = length2(h), size = root(size2);
        h = h / select(h[2] < 0, -size, size);
        const F c = dot(o, h), beyond = -dot(i, h);
        const Mask there = size2 > 0 && c > 0 && beyond > 0;
        // Both cosines are positive here, so that size2 = (η beyond − c)² is the squared sum of Walter et al.
        const F of_normal = 4 * product(c, ggx_.reflected_density(o, h));
        const F spread = product(product(parts_.eta, parts_.eta), beyond) / size2;
        return {only(there, product(of_normal, spread)), only(there, lesser(c, 1))};
    }
    /// Where light goes on beyond a microfacet.
    Direction through(const Direction& o, const Direction& h) const {
        const auto up = reflected(o, h);
        return select(parts_.thin, Direction(up[0], up[1], -up[2]),
                      select(parts_.straight(), -o, refracted(o, h, parts_.eta)));
    }
    F chance_of_reflection(F c) const {
        if (!any(parts_.through > 0)) return 1;
        const F up = luminance(parts_.reflected_colour(c)), down = luminance(parts_.transmitted_colour(c));
        return select(down > 0, up / (up + down), 1);  // nothing is transmitted where `through` is 0
    }

    const SurfacePartsOf<F>& parts_;
    GgxOf<F> ggx_;
    F radiance_;
};

}  // namespace hedgerow
