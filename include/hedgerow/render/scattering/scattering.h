/// What surfaces do to light: the material of glTF 2.0 (appendix B) with transmission, for a path tracer. In
/// local space z is the shading normal, `o` points towards the eye, where the path comes from, and `i`
/// towards the light, where it goes on. Directions have length 1.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include <hedgerow/render/scattering/broad_lobe.h>
#include <hedgerow/render/scattering/microfacet_lobe.h>

namespace hedgerow {

/// Reflection and transmission at a point, for one o. A surface that o is not above (by 10⁻¹⁸ at
/// least) is black.
///
/// Values are of radiance: those of a refraction have the factor (η_o/η_i)², where η_o is the index on the
/// side of o. Except for that factor no surface reflects and transmits more light than it gets. Borrows the
/// tables.
class Scattering {
public:
    /// `inside`: o is within a body that is not thin. Without tables, rough surfaces lose the light that
    /// their microfacets send to each other.
    Scattering(const SurfaceMaterial& material, const Vec3f& o, bool inside, const Compensation* tables)
        : parts_(material, inside), o_(o), facets_(parts_), broad_(parts_, o, tables), lit_(o[2] >= lowest) {
        if (lit_) set_chances();
    }
    Scattering(const Scattering&) = delete;
    Scattering& operator=(const Scattering&) = delete;

    /// The value of the surface for light from i, times |cos θi|, and the density of `sample` per solid
    /// angle. Single directions have neither. The integral of the density is the probability that `sample`
    /// returns a direction that is not single.
    ScatteredLight at(const Vec3f& i) const {
        if (!lit_ || !(std::abs(i[2]) > 0)) return {};
        ScatteredLight s;
        const float matte = product(chance_matte_, cosine_direction_density(i[2])),
                    again = product(i[2] > 0 ? chance_up_ : chance_down_, hemisphere_direction_density);
        s.density = matte + again;
        if (facets_.exists()) {
            const ScatteredLight facets = facets_.at(o_, i);
            s.value = facets.value;
            s.density += product(chance_facets_, facets.density);
        }
        if (i[2] > 0 ? chance_matte_ + chance_up_ > 0 : chance_down_ > 0) s.value += broad_.value(i);
        return s;
    }
    Vec3f value(const Vec3f& i) const { return at(i).value; }
    float density(const Vec3f& i) const { return at(i).density; }
    /// Chooses a direction by three numbers in [0, 1). Returns nothing for a path that ends here.
    std::optional<ScatteredDirection> sample(float choose_lobe, float u, float v) const {
        if (!lit_) return std::nullopt;
        const float broad = chance_matte_ + chance_up_ + chance_down_;
        if (choose_lobe < broad || !(chance_facets_ > 0)) return sample_broad(choose_lobe, u, v);
        const float choice = std::min((choose_lobe - broad) / chance_facets_, 0x1.fffffep-1f);
        std::optional<ScatteredDirection> s = facets_.sample(o_, choice, u, v);
        if (!s) return s;
        if (!s->specular)
            weigh(s);
        else
            s->weight /= chance_facets_;
        return s;
    }
    /// Whether all directions are single ones, so that light cannot be sampled in place of the surface.
    bool only_specular() const { return only_specular_; }

private:
    /// Shares out the choice of a lobe by the light that each scatters.
    void set_chances() {
        const float c = std::min(o_[2], 1.0f);
        const float matte = luminance(broad_.matte_albedo()), up = luminance(broad_.again_albedo_up()),
                    down = luminance(broad_.again_albedo_down()), broad = matte + up + down;
        float facets = luminance(parts_.reflected_colour(c) + parts_.transmitted_colour(c));
        // The microfacets can be brighter elsewhere than at the cosine of o, where they may even be black.
        if (facets_.exists()) facets = std::max(facets, broad / 32);
        if (facets_.exists() && !(broad + facets > 0)) facets = 1;
        const float sum = broad + facets;
        lit_ = sum > 0;
        if (!lit_) return;
        chance_matte_ = matte / sum, chance_up_ = up / sum, chance_down_ = down / sum;
        chance_facets_ = facets / sum;
        const bool single = facets_.mirrors() || (facets_.transmits_singly() && parts_.through == 1);
        only_specular_ = broad == 0 && single;
    }

    std::optional<ScatteredDirection> sample_broad(float choose_lobe, float u, float v) const {
        std::optional<ScatteredDirection> s(std::in_place);
        // Light after several reflections leaves at grazing directions, for which cosines would be few.
        const bool matte = choose_lobe < chance_matte_ || !(chance_up_ + chance_down_ > 0);
        s->direction = matte ? cosine_direction(u, v) : hemisphere_direction(u, v);
        s->transmitted = !matte && chance_down_ > 0 && choose_lobe >= chance_matte_ + chance_up_;
        if (s->transmitted) s->direction[2] = -s->direction[2];
        weigh(s);
        return s;
    }
    /// Sets the density and weight of a direction that is not single. Leaves nothing if it is impossible.
    void weigh(std::optional<ScatteredDirection>& s) const {
        const ScatteredLight there = at(s->direction);
        if (!(there.density > 0)) return s.reset();
        s->density = there.density, s->weight = there.value / there.density;
    }

    /// Products with lower heights of o can vanish.
    static constexpr float lowest = 1e-18f;

    SurfaceParts parts_;
    Vec3f o_;
    MicrofacetLobe facets_;
    BroadLobe broad_;
    bool lit_, only_specular_ = false;
    float chance_matte_ = 0, chance_up_ = 0, chance_down_ = 0, chance_facets_ = 0;
};

}  // namespace hedgerow
