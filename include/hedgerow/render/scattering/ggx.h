/// A rough surface of many microfacets, whose normals have the distribution GGX (Walter et al., Microfacet
/// models for refraction through rough surfaces, EGSR 2007). Directions are in local space, with the mean
/// normal along z.
#pragma once

#include <hedgerow/render/sampling/warps.h>

namespace hedgerow {

/// The distribution for one α, the same in all directions around z. α is in (0, 1].
///
/// With s(μ) = √(μ² + α²(1 − μ²)), Smith's Λ is (s/μ − 1)/2. Formulas are written with s, which is never 0,
/// so that grazing directions divide nothing by 0. F is float or FloatLanes.
template <class F>
class GgxOf {
public:
    explicit GgxOf(F alpha) : alpha_(alpha), alpha2_(product(alpha, alpha)) {}

    /// The area of microfacets with normal h, a direction of length 1, per area of surface and solid angle.
    F distribution(const Vec<F, 3>& h) const {
        const F flat = product(h[0], h[0]) + product(h[1], h[1]);
        const F spread = flat + product(alpha2_, product(h[2], h[2]));
        return only(h[2] > 0, alpha2_ * inverse_pi_f / product(spread, spread));
    }
    F lambda(F cosine) const { return (slant(cosine) / cosine - 1) / 2; }
    F slant(F cosine) const {
        return root(product(cosine, cosine) + product(alpha2_, product(1 - cosine, 1 + cosine)));
    }
    /// G₂/(4 μo μi) for cosines μ > 0, or for those of a refraction, with the height-correlated shadowing
    /// G₂ = 1/(1 + Λo + Λi) (Heitz, Understanding the masking-shadowing function, JCGT 2014).
    F visibility(F o, F i) const { return 1 / (2 * (product(slant(o), i) + product(slant(i), o))); }
    /// G₂/G₁(o): what is left of light that a visible mirror sends to i.
    F unshadowed(F o, F i) const {
        const F s = slant(o);
        return product(i, o + s) / (product(s, i) + product(slant(i), o));
    }

    /// The density of visible_normal, per solid angle of the normal, over 4 dot(o, h). It is the density of
    /// the direction to which the microfacet reflects o.
    F reflected_density(const Vec<F, 3>& o, const Vec<F, 3>& h) const {
        return distribution(h) / (2 * (o[2] + slant(o[2])));
    }
    /// The normal of a microfacet that o sees, with density 4 dot(o, h)·reflected_density (Dupuy and
    /// Benyoub, Sampling visible GGX normals with spherical caps, HPG 2023). o[2] ≥ 0. Always above the plane
    /// z = 0, short of rounding.
    Vec<F, 3> visible_normal(const Vec<F, 3>& o, F u, F v) const {
        const auto stretched = normalized(Vec<F, 3>(alpha_ * o[0], alpha_ * o[1], o[2]));
        const F z = product(1 - v, 1 + stretched[2]) - stretched[2];
        const F sine = root(greater(product(1 - z, 1 + z), 0));
        const auto h = direction_around_z(u, sine, z) + stretched;
        const Vec<F, 3> normal(alpha_ * h[0], alpha_ * h[1], greater(h[2], 0));
        return select(length2(normal) > 0, normalized(normal), Vec<F, 3>(0, 0, 1));
    }

private:
    F alpha_, alpha2_;
};
using Ggx = GgxOf<float>;

}  // namespace hedgerow
