/// Light that meets one microfacet of a rough surface: it is reflected, refracted, or goes straight on.
#pragma once

#include <algorithm>
#include <optional>

#include <hedgerow/render/scattering/ggx.h>
#include <hedgerow/render/scattering/surface_material.h>

namespace hedgerow {

/// A direction that a surface chose for a path.
struct ScatteredDirection {
    Vec3f direction;  ///< in local space, of length 1
    /// The value of the surface times |cos| over the density: what a path's throughput is multiplied by.
    Vec3f weight;
    float density = 0;         ///< per solid angle; 0 of a lobe that is a single direction
    bool specular = false;     ///< the direction is the only one of its lobe
    bool transmitted = false;  ///< to the other side of the surface
};

/// What a surface scatters from one direction to another, apart from single directions.
struct ScatteredLight {
    Vec3f value;        ///< times |cos|
    float density = 0;  ///< of sampling that direction, per solid angle
};

/// The reflection and transmission by microfacets, of all shares of a surface together: they have one
/// roughness. Refraction is that of Walter et al. 2007, in terms of radiance: where light comes from a medium
/// of index η_i to an eye in one of index η_o, it has the factor (η_o/η_i)². On a thin surface what goes
/// through is the reflection, mirrored to the other side (KHR_materials_transmission).
///
/// o[2] is above 0 in all functions.
class MicrofacetLobe {
public:
    /// Borrows the parts.
    explicit MicrofacetLobe(const SurfaceParts& parts)
        : parts_(parts),
          ggx_(std::max(product(parts.roughness, parts.roughness), 1e-3f)),
          radiance_(1 / product(parts.eta, parts.eta)) {}

    bool exists() const { return parts_.metal > 0 || parts_.through > 0 || parts_.has_coat(); }
    /// Whether reflection is a single direction, and whether transmission is.
    bool mirrors() const { return parts_.mirror; }
    bool transmits_singly() const { return parts_.mirror || (!parts_.thin && parts_.straight()); }

    /// The value times |cos| and the density of `sample` per solid angle, without single directions.
    ScatteredLight at(const Vec3f& o, const Vec3f& i) const {
        const Half half = half_of(o, i);
        if (!(half.density > 0)) return {};
        const float light = product(half.density, ggx_.unshadowed(o[2], std::abs(i[2])));
        const float reflects = chance_of_reflection(half.cosine);
        if (i[2] > 0) return {parts_.reflected_colour(half.cosine) * light, product(half.density, reflects)};
        return {parts_.transmitted_colour(half.cosine) * product(light, radiance_),
                product(half.density, 1 - reflects)};
    }
    /// Chooses a microfacet that o sees by (u, v), and whether it reflects by `choice`, in proportion to
    /// the luminance of both. The weight and density of the result are set only if it is specular. Returns
    /// nothing where the mirror is black, or sends light into the surface.
    std::optional<ScatteredDirection> sample(const Vec3f& o, float choice, float u, float v) const {
        const Vec3f h = parts_.mirror ? Vec3f(0, 0, 1) : ggx_.visible_normal(o, u, v);
        const float c = std::clamp(dot(o, h), 0.0f, 1.0f), reflects = chance_of_reflection(c);
        ScatteredDirection s;
        s.transmitted = !(choice < reflects);
        s.specular = s.transmitted ? transmits_singly() : parts_.mirror;
        s.direction = s.transmitted ? through(o, h) : reflected(o, h);
        if (!(s.transmitted ? s.direction[2] < 0 : s.direction[2] > 0)) return std::nullopt;
        if (!s.specular) return s;
        const float chance = s.transmitted ? 1 - reflects : reflects;
        s.weight = s.transmitted ? parts_.transmitted_colour(c) * radiance_ : parts_.reflected_colour(c);
        if (!(chance > 0) || !(max_component(s.weight) > 0)) return std::nullopt;
        s.weight /= chance;
        return s;
    }

private:
    /// The microfacet that sends o to i: the density of i if that mirror's kind of scattering is sure, and
    /// the cosine of o to its normal. The density is 0 where there is none.
    struct Half {
        float density = 0, cosine = 0;
    };

    Half half_of(const Vec3f& o, const Vec3f& i) const {
        if (i[2] > 0) return parts_.mirror ? Half() : half_of_reflection(o, i);
        if (!(i[2] < 0) || !(parts_.through > 0) || transmits_singly()) return {};
        return parts_.thin ? half_of_reflection(o, Vec3f(i[0], i[1], -i[2])) : half_of_refraction(o, i);
    }
    Half half_of_reflection(const Vec3f& o, const Vec3f& i) const {
        const Vec3f h = normalized(o + i);
        return {ggx_.reflected_density(o, h), std::clamp(dot(o, h), 0.0f, 1.0f)};
    }
    Half half_of_refraction(const Vec3f& o, const Vec3f& i) const {
        Vec3f h = o + i * parts_.eta;
        const float size2 = length2(h);
        if (!(size2 > 0)) return {};
        h = h / (h[2] < 0 ? -std::sqrt(size2) : std::sqrt(size2));
        const float c = dot(o, h), beyond = -dot(i, h);
        if (!(c > 0 && beyond > 0)) return {};
        // Both cosines are positive here, so that size2 = (η beyond − c)² is the squared sum of Walter et al.
        const float of_normal = 4 * product(c, ggx_.reflected_density(o, h));
        const float spread = product(product(parts_.eta, parts_.eta), beyond) / size2;
        return {product(of_normal, spread), std::min(c, 1.0f)};
    }
    Vec3f through(const Vec3f& o, const Vec3f& h) const {
        if (parts_.thin) {
            const Vec3f up = reflected(o, h);
            return {up[0], up[1], -up[2]};
        }
        return parts_.straight() ? -o : refracted(o, h, parts_.eta);
    }
    float chance_of_reflection(float c) const {
        if (!(parts_.through > 0)) return 1;
        const float up = luminance(parts_.reflected_colour(c)),
                    down = luminance(parts_.transmitted_colour(c));
        return down > 0 ? up / (up + down) : 1.0f;
    }

    const SurfaceParts& parts_;
    Ggx ggx_;
    float radiance_;
};

}  // namespace hedgerow
