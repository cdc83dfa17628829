/// Points and directions from points of the unit square, and their densities. Each map keeps ratios of areas
/// or, where that is said, of areas weighted by the cosine. u and v are in [0, 1). F is float or FloatLanes.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <hedgerow/geometry/elementary.h>
#include <hedgerow/geometry/vec.h>

namespace hedgerow {

inline constexpr float pi_f = std::numbers::pi_v<float>, inverse_pi_f = std::numbers::inv_pi_v<float>;

/// A point of the disc of radius 1. Near points stay near (Shirley and Chiu, A low distortion map between
/// disk and square, 1997). The density is 1/π per area.
template <class F>
Vec<F, 2> disc_point(F u, F v) {
    const F a = 2 * u - 1, b = 2 * v - 1;
    const auto wide = magnitude(a) > magnitude(b), middle = equal(a, 0) && equal(b, 0);
    const F radius = select(wide, a, b), turns = select(wide, b / a / 8, 0.25f - a / b / 8);
    const SineCosine<F> around = sine_cosine_of_turns(turns);
    return only(!middle, Vec<F, 2>(product(radius, around.cosine), product(radius, around.sine)));
}

/// A direction above the plane z = 0 with density z/π per solid angle. z may be 0.
template <class F>
Vec<F, 3> cosine_direction(F u, F v) {
    const Vec<F, 2> p = disc_point(u, v);
    return {p[0], p[1], root(greater(1 - length2(p), 0))};
}
template <class F>
F cosine_direction_density(F z) {
    return greater(z, 0) * inverse_pi_f;
}

/// A direction at a height z around the z axis, `u` turns from x. `sine` is √(1 − z²).
template <class F>
Vec<F, 3> direction_around_z(F u, F sine, F z) {
    const SineCosine<F> around = sine_cosine_of_turns(u);
    return {product(sine, around.cosine), product(sine, around.sine), z};
}

/// A direction from all around, with density 1/(4π) per solid angle.
inline Vec3f sphere_direction(float u, float v) {
    return direction_around_z(u, 2 * std::sqrt(product(v, 1 - v)), 1 - 2 * v);
}
inline constexpr float sphere_direction_density = inverse_pi_f / 4;

/// A direction above the plane z = 0, with density 1/(2π) per solid angle. z may be 0.
template <class F>
Vec<F, 3> hemisphere_direction(F u, F v) {
    return direction_around_z(u, root(product(1 - v, 1 + v)), v);
}
inline constexpr float hemisphere_direction_density = inverse_pi_f / 2;

/// A direction whose angle to the z axis has a cosine of at least 1 − `height`. The height is above 0 and at
/// most 2. It is given in place of the cosine because small cones would lose their digits.
inline Vec3f cone_direction(float height, float u, float v) {
    const float h = product(v, height);
    return direction_around_z(u, std::sqrt(product(h, std::max(2 - h, 0.0f))), 1 - h);
}
/// The density of cone_direction per solid angle, within its cone.
inline float cone_direction_density(float height) {
    return inverse_pi_f / (2 * height);
}

/// A point of a triangle as its barycentric coordinates (b, c) of the second and third corner. The density is
/// 1 over the area (Heitz, A low-distortion map between triangle and square, 2019).
template <class F>
Vec<F, 2> triangle_point(F u, F v) {
    const F half = lesser(u, v) / 2;
    return {u - half, v - half};
}

}  // namespace hedgerow
