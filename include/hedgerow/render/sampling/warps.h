/// Points and directions from points of the unit square, and their densities. Each map keeps ratios of areas
/// or, where that is said, of areas weighted by the cosine. u and v are in [0, 1).
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
inline Vec2f disc_point(float u, float v) {
    const float a = 2 * u - 1, b = 2 * v - 1;
    if (a == 0 && b == 0) return {};
    const bool wide = std::abs(a) > std::abs(b);
    const float radius = wide ? a : b, turns = wide ? b / a / 8 : 0.25f - a / b / 8;
    const auto [sine, cosine] = sine_cosine_of_turns(turns);
    return {product(radius, cosine), product(radius, sine)};
}

/// A direction above the plane z = 0 with density z/π per solid angle. z may be 0.
inline Vec3f cosine_direction(float u, float v) {
    const Vec2f p = disc_point(u, v);
    return {p[0], p[1], std::sqrt(std::max(1 - length2(p), 0.0f))};
}
inline float cosine_direction_density(float z) {
    return std::max(z, 0.0f) * inverse_pi_f;
}

/// A direction at a height z around the z axis, `u` turns from x. `sine` is √(1 − z²).
inline Vec3f direction_around_z(float u, float sine, float z) {
    const auto [s, c] = sine_cosine_of_turns(u);
    return {product(sine, c), product(sine, s), z};
}

/// A direction from all around, with density 1/(4π) per solid angle.
inline Vec3f sphere_direction(float u, float v) {
    return direction_around_z(u, 2 * std::sqrt(product(v, 1 - v)), 1 - 2 * v);
}
inline constexpr float sphere_direction_density = inverse_pi_f / 4;

/// A direction above the plane z = 0, with density 1/(2π) per solid angle. z may be 0.
inline Vec3f hemisphere_direction(float u, float v) {
    return direction_around_z(u, std::sqrt(product(1 - v, 1 + v)), v);
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
inline Vec2f triangle_point(float u, float v) {
    const float half = std::min(u, v) / 2;
    return {u - half, v - half};
}

}  // namespace hedgerow
