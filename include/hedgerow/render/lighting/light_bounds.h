/// Bounds of a group of lights: where they are, and to where they shine (Conty Estevez & Kulla, Importance
/// Sampling of Many Lights with Adaptive Tree Splitting, HPG 2018).
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <hedgerow/geometry/box.h>
#include <hedgerow/geometry/elementary.h>
#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// Directions within an angle of an axis of length 1: up to π, which is all of them. The cosine and the sine
/// of the angle are stored, since neither gives the other with small error everywhere.
struct NormalCone {
    Vec3f axis{0, 0, 1};
    float cosine = 1, sine = 0;

    static NormalCone all() { return {{0, 0, 1}, -1, 0}; }
    bool is_all() const { return cosine <= -1; }
};

/// Bounds of lights that have a position. `LightBounds()` bounds none.
struct LightBounds {
    Box3f box;
    NormalCone normals;       ///< contains the directions in which the lights face
    float cos_emission = 1;   ///< of the largest angle from its normal at which a light emits, up to π/2
    bool both_sides = false;  ///< whether a light emits alike about the opposite of its normal
    double intensity = 0;     ///< the sum of the greatest intensities: radiance times area, or candela
};

namespace detail {

/// A cone that contains both. Its angle is widened beyond the rounding of its axis to float.
inline NormalCone merged(const NormalCone& a, const NormalCone& b) {
    constexpr double pi = std::numbers::pi, slack = 4e-7;
    const auto angle = [](const NormalCone& c) {
        return arc_tangent(static_cast<double>(c.sine), static_cast<double>(c.cosine));
    };
    if (a.is_all() || b.is_all()) return NormalCone::all();
    const bool swaps = angle(a) < angle(b);
    const NormalCone &wide = swaps ? b : a, &slim = swaps ? a : b;
    const double wide_angle = angle(wide), slim_angle = angle(slim);
    const Vec3d from = normalized(Vec3d(wide.axis)), to = normalized(Vec3d(slim.axis));
    const double between = arc_tangent(length(cross(from, to)), dot(from, to));
    if (between + slim_angle <= wide_angle) return wide;
    // The cone from the far side of one to the far side of the other. Its axis lies between theirs.
    const double half = (wide_angle + between + slim_angle) / 2 + slack;
    const Vec3d aside = to - from * dot(from, to);
    if (!(half < pi)) return NormalCone::all();
    if (length(aside) < slack) {
        // The axes are equal or opposite, up to rounding, so no plane goes through both.
        if (dot(from, to) < 0) return NormalCone::all();
        return {wide.axis, rounded_to<float>(cosine(half + slack)), rounded_to<float>(sine(half + slack))};
    }
    const double turn = half - wide_angle;
    const Vec3d axis = normalized(from * cosine(turn) + normalized(aside) * sine(turn));
    return {Vec3f(axis), rounded_to<float>(cosine(half)), rounded_to<float>(sine(half))};
}

}  // namespace detail

/// Bounds of two groups together.
inline LightBounds merged(const LightBounds& a, const LightBounds& b) {
    if (a.box.empty()) return b;
    if (b.box.empty()) return a;
    // The normals of lights with two sides may as well be the opposite.
    NormalCone of_b = b.normals;
    if (b.both_sides && dot(a.normals.axis, of_b.axis) < 0) of_b.axis = -of_b.axis;
    return {merged(a.box, b.box), detail::merged(a.normals, of_b), std::min(a.cos_emission, b.cos_emission),
            a.both_sides || b.both_sides, a.intensity + b.intensity};
}

}  // namespace hedgerow
