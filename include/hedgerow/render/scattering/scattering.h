/// What surfaces do to light: the material of glTF 2.0 (appendix B) with transmission, for a path tracer. In
/// local space z is the shading normal, `o` points towards the eye, where the path comes from, and `i`
/// towards the light, where it goes on. Directions have length 1.
#pragma once

#include <hedgerow/render/scattering/broad_lobe.h>
#include <hedgerow/render/scattering/microfacet_lobe.h>

namespace hedgerow {

/// Reflection and transmission at a point, for one o; or at four points, of F = FloatLanes. A surface that o
/// is not above (by 10⁻¹⁸ at least) is black.
///
/// Values are of radiance: those of a refraction have the factor (η_o/η_i)², where η_o is the index on the
/// side of o. Except for that factor no surface reflects and transmits more light than it gets. Borrows the
/// tables.
template <class F>
class ScatteringOf {
    using Mask = MaskOf<F>;
    using Direction = Vec<F, 3>;

public:
    /// `inside`: o is within a body that is not thin. Without tables, rough surfaces lose the light that
    /// their microfacets send to each other.
    ScatteringOf(const SurfaceMaterialOf<F>& material, const Direction& o, Mask inside,
                 const Compensation* tables)
        : parts_(material, inside), o_(o), facets_(parts_), broad_(parts_, o, tables), lit_(o[2] >= lowest) {
        set_chances();
    }
    ScatteringOf(const ScatteringOf&) = delete;
    ScatteringOf& operator=(const ScatteringOf&) = delete;

    /// The value of the surface for light from i, times |cos θi|, and the density of `sample` per solid
    /// angle. Single directions have neither. The integral of the density is the probability that `sample`
    /// returns a direction that is not single.
    ScatteredLightOf<F> at(const Direction& i) const {
        const Mask up = i[2] > 0, seen = lit_ && magnitude(i[2]) > 0;
        ScatteredLightOf<F> s;
        s.density = product(chance_matte_, cosine_direction_density(i[2])) +
                    product(select(up, chance_up_, chance_down_), hemisphere_direction_density);
        if (const Mask there = facets_.exists(); any(there)) {
            const ScatteredLightOf<F> facets = facets_.at(o_, i);
            s.value = only(there, facets.value);
            s.density = select(there, s.density + product(chance_facets_, facets.density), s.density);
        }
        const Mask broad = select(up, chance_matte_ + chance_up_, chance_down_) > 0;
        if (any(broad)) s.value = select(broad, s.value + broad_.value(i), s.value);
        return {only(seen, s.value), only(seen, s.density)};
    }
    Vec<F, 3> value(const Direction& i) const { return at(i).value; }
    F density(const Direction& i) const { return at(i).density; }
    /// Chooses a direction by three numbers in [0, 1). Where there is none, the path ends.
    ScatteredDirectionOf<F> sample(F choose_lobe, F u, F v) const {
        const F broad = chance_matte_ + chance_up_ + chance_down_;
        const Mask of_facets = !(choose_lobe < broad) && chance_facets_ > 0;
        ScatteredDirectionOf<F> s;
        if (any(of_facets)) {
            const F choice = lesser((choose_lobe - broad) / chance_facets_, 0x1.fffffep-1f);
            s = facets_.sample(o_, choice, u, v);
            s.weight = s.weight / chance_facets_;
        }
        if (any(!of_facets)) {
            const ScatteredDirectionOf<F> other = sample_broad(choose_lobe, u, v);
            s.exists = select(of_facets, s.exists, other.exists);
            s.direction = select(of_facets, s.direction, other.direction);
            s.specular = of_facets && s.specular;
            s.transmitted = select(of_facets, s.transmitted, other.transmitted);
        }
        // The value counts all lobes that might have chosen a direction.
        if (const Mask several = s.exists && !s.specular; any(several)) {
            const ScatteredLightOf<F> there = at(s.direction);
            s.density = only(several, there.density);
            s.weight = select(several, there.value / there.density, s.weight);
            s.exists = s.exists && (s.specular || there.density > 0);
        }
        s.exists = s.exists && lit_;
        return s;
    }
    /// Whether all directions are single ones, so that light cannot be sampled in place of the surface.
    Mask only_specular() const { return only_specular_; }

private:
    /// Shares out the choice of a lobe by the light that each scatters.
    void set_chances() {
        const F c = lesser(o_[2], 1);
        const F matte = luminance(broad_.matte_albedo()), up = luminance(broad_.again_albedo_up()),
                down = luminance(broad_.again_albedo_down()), broad = matte + up + down;
        F facets = 0;
        if (const Mask there = facets_.exists(); any(there)) {
            // The microfacets can be brighter elsewhere than at the cosine of o, where they may even be
            // black.
            facets = luminance(parts_.reflected_colour(c) + parts_.transmitted_colour(c));
            facets = greater(facets, broad / 32);
            facets = only(there, select(broad + facets > 0, facets, 1));
        }
        const F sum = broad + facets;
        lit_ = lit_ && sum > 0;
        chance_matte_ = only(lit_, matte / sum), chance_up_ = only(lit_, up / sum);
        chance_down_ = only(lit_, down / sum), chance_facets_ = only(lit_, facets / sum);
        const Mask single = facets_.mirrors() || (facets_.transmits_singly() && equal(parts_.through, 1));
        only_specular_ = lit_ && equal(broad, 0) && single;
    }
    /// A direction in which base or compensation scatter.
    ScatteredDirectionOf<F> sample_broad(F choose_lobe, F u, F v) const {
        ScatteredDirectionOf<F> s;
        s.exists = Mask(true);
        // Light after several reflections leaves at grazing directions, for which cosines would be few.
        const Mask matte = choose_lobe < chance_matte_ || !(chance_up_ + chance_down_ > 0);
        s.direction = cosine_direction(u, v);
        if (!any(!matte)) return s;
        s.direction = select(matte, s.direction, hemisphere_direction(u, v));
        s.transmitted = !matte && chance_down_ > 0 && choose_lobe >= chance_matte_ + chance_up_;
        s.direction[2] = select(s.transmitted, -s.direction[2], s.direction[2]);
        return s;
    }

    /// Products with lower heights of o can vanish.
    static constexpr float lowest = 1e-18f;

    SurfacePartsOf<F> parts_;
    Direction o_;
    MicrofacetLobe<F> facets_;
    BroadLobe<F> broad_;
    Mask lit_, only_specular_{false};
    F chance_matte_ = 0, chance_up_ = 0, chance_down_ = 0, chance_facets_ = 0;
};
using Scattering = ScatteringOf<float>;

}  // namespace hedgerow
