/// What share of light a smooth surface reflects, and which way it refracts the rest.
#pragma once

#include <algorithm>
#include <cmath>

#include <hedgerow/geometry/vec.h>
#include <hedgerow/looks/colour.h>

namespace hedgerow {

/// The luminance of linear light with the primaries of sRGB.
inline float luminance(const Vec3f& c) {
    return dot(Vec3f(0.2126f, 0.7152f, 0.0722f), c);
}
inline float fifth_power(float x) {
    const float x2 = product(x, x);
    return product(product(x2, x2), x);
}

/// The reflectance f0 + (f90 − f0)(1 − c)⁵ at an angle of incidence with cosine c in [0, 1] (Schlick, An
/// inexpensive BRDF model for physically-based rendering, 1994).
struct SchlickFresnel {
    Vec3f f0;
    float f90 = 1;

    Vec3f at(float c) const { return of_bend(fifth_power(1 - c)); }
    /// The mean over incident light from all sides, weighted by the cosine.
    Vec3f average() const { return of_bend(1.0f / 21); }
    /// The reflectance where (1 − c)⁵, or its mean, is `bend`, out of an albedo of `white` for f0 = f90 = 1.
    Vec3f of_bend(float bend, float white = 1) const {
        return f0 * (white - bend) + Vec3f::all(product(f90, bend));
    }
};

/// The share of unpolarised light that the boundary between two dielectrics reflects. `c` is the cosine of
/// the angle of incidence, in [0, 1]; `eta` is the index of refraction beyond the boundary over that before
/// it, above 0. Returns 1 for total reflection.
inline float dielectric_reflectance(float c, float eta) {
    const float sine2 = product(1 - c, 1 + c) / product(eta, eta);
    if (!(sine2 < 1)) return 1;
    const float beyond = std::sqrt(1 - sine2);
    const float parallel_sum = product(eta, c) + beyond, across_sum = c + product(eta, beyond);
    if (!(parallel_sum > 0 && across_sum > 0)) return 1;
    const float parallel = (product(eta, c) - beyond) / parallel_sum,
                across = (c - product(eta, beyond)) / across_sum;
    return std::min((product(parallel, parallel) + product(across, across)) / 2, 1.0f);
}

/// The direction of length 1 to which light goes on beyond a boundary with normal h. `o` points away from the
/// boundary, to where the light comes from, and dot(o, h) ≥ 0. Where the boundary reflects all light, the
/// result grazes it.
inline Vec3f refracted(const Vec3f& o, const Vec3f& h, float eta) {
    const float c = dot(o, h);
    const float beyond = std::sqrt(std::max(1 - product(1 - c, 1 + c) / product(eta, eta), 0.0f));
    return normalized(h * (c / eta - beyond) - o / eta);
}
inline Vec3f reflected(const Vec3f& o, const Vec3f& h) {
    return h * (2 * dot(o, h)) - o;
}

}  // namespace hedgerow
