/// Bounds of a group of lights, and the importance of the group for a point: an upper bound of the light that
/// may arrive, by which a light tree is descended (Conty Estevez & Kulla, Importance Sampling of Many Lights
/// with Adaptive Tree Splitting, HPG 2018).
#pragma once

#include <algorithm>
#include <cmath>

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
    bool is_axis() const { return cosine == 1 && sine == 0; }
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
    constexpr double pi = 3.141592653589793, slack = 4e-7;
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

/// The cosine of an angle from 0 to π less another, or 1 where the other is larger.
inline double cosine_less(double cosine, double cos_other, double sin_other) {
    if (cosine >= cos_other) return 1;
    const double sine = std::sqrt(std::max(0.0, product(1 - cosine, 1 + cosine)));
    return product(cosine, cos_other) + product(sine, sin_other);
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

/// Bounds the light that arrives at a point from a group: intensity · cos · cos / d². The first cosine is of
/// the least angle between a light's normal and the way to the point, less what the cone of normals and the
/// extent of the box take off. The second is of the least angle between the receiver's normal and the way
/// to a light. A receiver's normal has length 1; a normal of 0 leaves the second cosine out, as for volumes
/// and transparent surfaces. Distances less than half the box's diagonal count as that.
///
/// The importance is 0 only where no light of the group can arrive: cosines are raised by more than they may
/// err by.
inline double importance(const LightBounds& lights, const Vec3f& point, const Vec3f& normal) {
    // What cosines are raised by. Axes, cosines and sines in float err by about 1e-7.
    constexpr double slack = 1e-5;
    if (!(lights.intensity > 0)) return 0;
    const Vec3d low = Vec3d(lights.box.low) - Vec3d(point), high = Vec3d(lights.box.high) - Vec3d(point);
    const Vec3d way = (low + high) / 2.0, n(normal);
    const double radius2 = length2(high - low) / 4, distance2 = length2(way);
    double received = 1, emitted = 1;
    const bool has_horizon = normal != Vec3f();
    if (has_horizon) {
        // The greatest height of the box above the receiver's horizon.
        double height = 0;
        for (int k = 0; k < 3; ++k) height += std::max(product(n[k], low[k]), product(n[k], high[k]));
        if (!(height > 0)) {
            double reach = 0;
            for (int k = 0; k < 3; ++k) reach += std::max(std::abs(low[k]), std::abs(high[k]));
            if (!(height > -product(slack / 4, reach))) return 0;
        }
    }
    // Angles are known where the point is outside of the sphere around the box.
    if (distance2 > radius2) {
        const double inverse = 1 / std::sqrt(distance2);
        const double sin_box = std::min(1.0, product(std::sqrt(radius2), inverse));
        const double cos_box = std::sqrt(product(1 - sin_box, 1 + sin_box));
        if (has_horizon)
            received = detail::cosine_less(product(dot(n, way), inverse), cos_box, sin_box) + slack;
        double facing = 1;
        if (!lights.normals.is_all()) {
            facing = -product(dot(Vec3d(lights.normals.axis), way), inverse);
            if (lights.both_sides) facing = std::abs(facing);
            if (!lights.normals.is_axis())
                facing = detail::cosine_less(facing, static_cast<double>(lights.normals.cosine),
                                             static_cast<double>(lights.normals.sine));
        }
        emitted = detail::cosine_less(facing, cos_box, sin_box) + slack;
        if (!(received > 0) || !(emitted > static_cast<double>(lights.cos_emission))) return 0;
    }
    return lights.intensity * received * emitted / std::max(std::max(distance2, radius2), 0x1p-200);
}

}  // namespace hedgerow
