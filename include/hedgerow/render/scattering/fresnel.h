/// What share of light a smooth surface reflects, and which way it refracts the rest. F is float or
/// FloatLanes.
#pragma once

#include <type_traits>

#include <hedgerow/geometry/number_lanes.h>
#include <hedgerow/looks/colour.h>

namespace hedgerow {

/// The luminance of linear light with the primaries of sRGB.
template <class F>
F luminance(const Vec<F, 3>& c) {
    return dot(Vec<F, 3>(0.2126f, 0.7152f, 0.0722f), c);
}
template <class F>
F fifth_power(F x) {
    const F x2 = product(x, x);
    return product(product(x2, x2), x);
}

/// The reflectance f0 + (f90 − f0)(1 − c)⁵ at an angle of incidence with cosine c in [0, 1] (Schlick, An
/// inexpensive BRDF model for physically-based rendering, 1994).
template <class F>
struct SchlickFresnelOf {
    Vec<F, 3> f0;
    F f90 = 1;

    Vec<F, 3> at(F c) const { return of_bend(fifth_power(1 - c)); }
    /// The mean over incident light from all sides, weighted by the cosine.
    Vec<F, 3> average() const { return of_bend(1.0f / 21); }
    /// The reflectance where (1 − c)⁵, or its mean, is `bend`, out of an albedo of `white` for f0 = f90 = 1.
    Vec<F, 3> of_bend(F bend, F white = 1) const {
        return f0 * (white - bend) + Vec<F, 3>::all(product(f90, bend));
    }
};
using SchlickFresnel = SchlickFresnelOf<float>;

/// The share of unpolarised light that the boundary between two dielectrics reflects. `c` is the cosine of
/// the angle of incidence, in [0, 1]; `eta` is the index of refraction beyond the boundary over that before
/// it, above 0. Returns 1 for total reflection.
template <class F>
F dielectric_reflectance(F c, std::type_identity_t<F> eta) {
    const F sine2 = product(1 - c, 1 + c) / product(eta, eta);
    const F beyond = root(1 - sine2);  // NaN of total reflection
    const F parallel_sum = product(eta, c) + beyond, across_sum = c + product(eta, beyond);
    const F parallel = (product(eta, c) - beyond) / parallel_sum,
            across = (c - product(eta, beyond)) / across_sum;
    return select(sine2 < 1 && parallel_sum > 0 && across_sum > 0,
                  lesser((product(parallel, parallel) + product(across, across)) / 2, 1), 1);
}

/// The direction of length 1 to which light goes on beyond a boundary with normal h. `o` points away from the
/// boundary, to where the light comes from, and dot(o, h) ≥ 0. Where the boundary reflects all light, the
/// result grazes it.
template <class F>
Vec<F, 3> refracted(const Vec<F, 3>& o, const Vec<F, 3>& h, std::type_identity_t<F> eta) {
    const F c = dot(o, h);
    const F beyond = root(greater(1 - product(1 - c, 1 + c) / product(eta, eta), 0));
    return normalized(h * (c / eta - beyond) - o / eta);
}
template <class F>
Vec<F, 3> reflected(const Vec<F, 3>& o, const Vec<F, 3>& h) {
    return h * (2 * dot(o, h)) - o;
}

}  // namespace hedgerow
