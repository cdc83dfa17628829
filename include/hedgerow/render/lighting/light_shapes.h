/// Shapes of light sources, and how a path tracer samples the light that arrives from them. Geometry between
/// a point and a source is computed in double: there the products of edges and distances of float scenes
/// neither overflow nor underflow.
#pragma once

#include <algorithm>
#include <limits>

#include <hedgerow/geometry/offset.h>
#include <hedgerow/geometry/vec.h>
#include <hedgerow/render/sampling/warps.h>

namespace hedgerow {

/// Densities that the samplers return lie between 1 / most and most, in 1/sr, so that the sum of two squares
/// of them neither overflows nor underflows. Only sources that are almost points, seen edge-on or touched by
/// the point are beyond.
inline constexpr float most_light_density = 0x1p62f;
/// The most radiance or irradiance that a source without extent gives, however close the point lies to it.
inline constexpr float most_single_light = 0x1p100f;

/// Light that arrives at a point, as if nothing were in its way.
struct LightSample {
    Vec3f direction;     ///< from the point to the source, of length 1
    float distance = 0;  ///< to the source along the direction; infinity for the sun and the environment
    /// What is nearer than this is in the way of the light. Less than the distance by as much as a hit on the
    /// source may err, so that the source itself is not.
    float free = 0;
    /// Radiance, or for a single direction the irradiance of a surface that faces the source.
    Vec3f radiance;
    /// The probability density of the direction per solid angle. It is 0 for a single direction, and where no
    /// light arrives.
    float density = 0;
    /// Whether the source has no extent, so that light from it arrives from one direction only.
    bool single = false;
    /// The weights of the second and the third corner at the sampled place of a triangle, for emission that
    /// a texture varies.
    Vec2f weights;

    /// Whether any light arrives.
    explicit operator bool() const { return single || density > 0; }
};

namespace detail {

/// The mean of the colours: how much a source counts in choices.
inline double brightness(const Vec3f& c) {
    return (static_cast<double>(c[0]) + static_cast<double>(c[1]) + static_cast<double>(c[2])) / 3;
}

/// The way from a point to another: a direction of length 1, and a distance. The distance is 0 if the points
/// are less than the least normal float apart.
struct Sight {
    Vec3f direction;
    float distance = 0;
};
inline Sight sight(const Vec3f& from, const Vec3d& to) {
    const Vec3d way = to - Vec3d(from);
    const double l = length(way);
    if (!(l >= static_cast<double>(std::numeric_limits<float>::min()))) return {};
    return {Vec3f(way / l), rounded_to<float>(l)};
}
/// The part of a way from a point that nothing may block: until the source within these bounds is as near as
/// a hit on it may err. `cosine`: that of the way and the source's normal, positive.
inline float free_way(const Vec3f& from, float distance, const Box3f& source, double cosine) {
    return rounded_to<float>(static_cast<double>(distance) -
                             static_cast<double>(hit_error(from, source)) / cosine);
}

inline float bounded_density(double density) {
    constexpr auto most = static_cast<double>(most_light_density);
    return rounded_to<float>(std::min(std::max(density, 1 / most), most));
}

/// The irradiance by an intensity at a distance, which is not 0, of a surface that faces the source.
inline Vec3f irradiance(const Vec3f& intensity, double share, float distance) {
    const double factor = share / product(static_cast<double>(distance), static_cast<double>(distance));
    return map(intensity, [&](float i) {
        const double value = static_cast<double>(i) * factor;
        return rounded_to<float>(std::min(value, static_cast<double>(most_single_light)));
    });
}

/// Light from a place without extent. `share(direction)`: the part of the intensity that goes there, where
/// the direction is the way to the place.
template <class Share>
LightSample from_place(const Vec3f& point, const Vec3f& place, const Vec3f& intensity, const Share& share) {
    const auto [direction, distance] = sight(point, Vec3d(place));
    if (!(distance > 0)) return {};
    const double part = share(direction);
    if (!(part > 0)) return {};
    return {direction,
            distance,
            free_way(point, distance, {place, place}, 1),
            irradiance(intensity, part, distance),
            0,
            true,
            {}};
}

}  // namespace detail

/// A triangle that emits the same radiance from all of its front, from where its corners are
/// counterclockwise, or from both sides.
struct EmissiveTriangle {
    Vec3f a, b, c;
    Vec3f radiance;
    bool both_sides = false;

    /// The normal of the front, whose length is twice the area.
    Vec3d normal() const { return cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a)); }
    double area() const { return length(normal()) / 2; }
    Box3f bounds() const { return Box3f().expand(a).expand(b).expand(c); }

    /// Samples the area uniformly, by two numbers in [0, 1). (Sampling by solid angle has less noise at
    /// points close to the triangle: Arvo, SIGGRAPH 1995; Peters, TOG 40(4), 2021.) There is no light behind
    /// a triangle, unless both sides emit, nor in its plane.
    LightSample sample(const Vec3f& point, float u, float v) const {
        LightSample s;
        s.weights = triangle_point(u, v);
        const Vec3d at = Vec3d(a) + (Vec3d(b) - Vec3d(a)) * static_cast<double>(s.weights[0]) +
                         (Vec3d(c) - Vec3d(a)) * static_cast<double>(s.weights[1]);
        const auto [direction, distance] = detail::sight(point, at);
        s.direction = direction;
        s.distance = distance;
        const Vec3d n = normal();
        const double along = -dot(n, Vec3d(direction));
        s.density = density_at(along, distance);
        if (!s) return s;
        s.radiance = radiance;
        s.free = detail::free_way(point, distance, bounds(), std::abs(along) / length(n));
        return s;
    }
    /// The density that `sample` returns for the place where a ray hits the triangle: a ray of this
    /// direction, of length 1, at this distance. 0 where no light comes from.
    float density_toward(const Vec3f& direction, float distance) const {
        return density_at(-dot(normal(), Vec3d(direction)), distance);
    }
    /// The radiance that a ray of this direction meets.
    Vec3f radiance_toward(const Vec3f& direction) const {
        return both_sides || dot(normal(), Vec3d(direction)) < 0 ? radiance : Vec3f();
    }

private:
    /// The density of a hit where the normal, of twice the area's length, goes so far back along the ray.
    float density_at(double along, float distance) const {
        if (!(distance > 0) || !(both_sides ? along != 0 : along > 0)) return 0;
        const auto d = static_cast<double>(distance);
        return detail::bounded_density(2 * product(d, d) / (along < 0 ? -along : along));
    }
};

/// A point that shines alike in all directions.
struct PointEmitter {
    Vec3f position;
    Vec3f intensity;  ///< in candela

    /// There is no light at the position itself.
    LightSample sample(const Vec3f& point) const {
        return detail::from_place(point, position, intensity, [](const Vec3f&) { return 1.0; });
    }
};

/// A point that shines into a cone about an axis of length 1.
struct SpotEmitter {
    Vec3f position, axis;
    Vec3f intensity;                         ///< on the axis, in candela
    double inner = 0, outer = 0;             ///< angles from the axis in radians, inner <= outer <= π/2
    double cos_inner = 1, cos_outer = 0.99;  ///< their cosines

    /// The share of the intensity at an angle from the axis: the fall of KHR_lights_punctual. Equal cosines
    /// make a sharp edge.
    double share(double cosine_to_axis) const {
        const double span = cos_inner - cos_outer, above = cosine_to_axis - cos_outer;
        if (!(above > 0)) return 0;
        const double rise = above < span ? above / span : 1.0;
        return product(rise, rise);
    }
    LightSample sample(const Vec3f& point) const {
        return detail::from_place(point, position, intensity,
                                  [&](const Vec3f& d) { return share(-dot(Vec3d(axis), Vec3d(d))); });
    }
};

/// Light from one direction, infinitely far away.
struct SunEmitter {
    Vec3f toward;       ///< the direction to the sun, of length 1
    Vec3f illuminance;  ///< of a surface that faces the sun, in lux

    LightSample sample() const {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        return {toward, infinity, infinity, illuminance, 0, true, {}};
    }
};

}  // namespace hedgerow
