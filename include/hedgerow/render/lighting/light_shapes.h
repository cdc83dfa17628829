/// Shapes of light sources, and how a path tracer samples the light that arrives from them. Geometry between
/// a point and a source is computed in double: there the products of edges and distances of float scenes
/// neither overflow nor underflow.
#pragma once

#include <algorithm>
#include <concepts>
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

/// Light that arrives at a point, as if nothing were in its way; at four points, of F = FloatLanes.
template <class F>
struct LightSampleOf {
    Vec<F, 3> direction;  ///< from the point to the source, of length 1
    F distance = 0;       ///< to the source along the direction; infinity for the sun and the environment
    /// What is nearer than this is in the way of the light. Less than the distance by as much as a hit on the
    /// source may err, so that the source itself is not.
    F free = 0;
    /// Radiance, or for a single direction the irradiance of a surface that faces the source.
    Vec<F, 3> radiance;
    /// The probability density of the direction per solid angle. It is 0 for a single direction, and where no
    /// light arrives.
    F density = 0;
    /// Whether the source has no extent, so that light from it arrives from one direction only.
    MaskOf<F> single{false};
    /// The weights of the second and the third corner at the sampled place of a triangle, for emission that
    /// a texture varies.
    Vec<F, 2> weights;

    /// Whether any light arrives.
    MaskOf<F> arrives() const { return single || density > 0; }
    explicit operator bool() const requires std::same_as<F, float> { return arrives(); }
};
using LightSample = LightSampleOf<float>;

inline LightSampleOf<FloatLanes> in_all_lanes(const LightSample& s) {
    const auto same = [&](int) -> const LightSample& { return s; };
    using S = LightSample;
    return {in_lanes(same, &S::direction), s.distance, s.free,
            in_lanes(same, &S::radiance),  s.density,  LaneMask(s.single),
            {s.weights[0], s.weights[1]}};
}
inline LightSampleOf<FloatLanes> select(LaneMask c, const LightSampleOf<FloatLanes>& a,
                                        const LightSampleOf<FloatLanes>& b) {
    return {select(c, a.direction, b.direction), select(c, a.distance, b.distance),
            select(c, a.free, b.free),           select(c, a.radiance, b.radiance),
            select(c, a.density, b.density),     select(c, a.single, b.single),
            select(c, a.weights, b.weights)};
}

namespace detail {

/// The mean of the colours: how much a source counts in choices.
inline double brightness(const Vec3f& c) {
    return (static_cast<double>(c[0]) + static_cast<double>(c[1]) + static_cast<double>(c[2])) / 3;
}

/// The way from a point to another: a direction of length 1, and a distance. The distance is 0 if the points
/// are less than the least normal float apart.
template <class F>
struct Sight {
    Vec<F, 3> direction;
    F distance = 0;
};
template <class F>
Sight<F> sight(const Vec<F, 3>& from, const Vec<WideOf<F>, 3>& to) {
    const auto way = to - widened(from);
    const WideOf<F> l = root(length2(way));
    const auto apart = l >= static_cast<double>(std::numeric_limits<float>::min());
    return {in_float(only(apart, way / l)), in_float(only(apart, l))};
}
/// The part of a way from a point that nothing may block: until the source within these bounds is as near as
/// a hit on it may err. `cosine`: that of the way and the source's normal, positive.
template <class F>
F free_way(const Vec<F, 3>& from, F distance, const Vec<F, 3>& low, const Vec<F, 3>& high, WideOf<F> cosine) {
    using D = WideOf<F>;
    return in_float(D(distance) - D(hit_error(from, low, high)) / cosine);
}

template <class D>
D bounded_density(D density) {
    constexpr auto most = static_cast<double>(most_light_density);
    return lesser(greater(density, 1 / most), most);
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
            free_way(point, distance, place, place, 1),
            irradiance(intensity, part, distance),
            0,
            true,
            {}};
}

}  // namespace detail

/// A triangle that emits the same radiance from all of its front, from where its corners are
/// counterclockwise, or from both sides; or four triangles, of F = FloatLanes.
template <class F>
struct EmissiveTriangleOf {
    using D = WideOf<F>;

    Vec<F, 3> a, b, c;
    Vec<F, 3> radiance;
    MaskOf<F> both_sides{false};

    /// The normal of the front, whose length is twice the area.
    Vec<D, 3> normal() const { return cross(widened(b) - widened(a), widened(c) - widened(a)); }
    double area() const requires std::same_as<F, float> { return length(normal()) / 2; }
    Box3f bounds() const requires std::same_as<F, float> { return Box3f().expand(a).expand(b).expand(c); }

    /// Samples the area uniformly, by two numbers in [0, 1). (Sampling by solid angle has less noise at
    /// points close to the triangle: Arvo, SIGGRAPH 1995; Peters, TOG 40(4), 2021.) There is no light behind
    /// a triangle, unless both sides emit, nor in its plane.
    LightSampleOf<F> sample(const Vec<F, 3>& point, F u, F v) const {
        LightSampleOf<F> s;
        s.weights = triangle_point(u, v);
        const auto corner = widened(a), ab = widened(b) - corner, ac = widened(c) - corner;
        const auto at = corner + ab * D(s.weights[0]) + ac * D(s.weights[1]);
        const detail::Sight<F> way = detail::sight(point, at);
        s.direction = way.direction, s.distance = way.distance;
        const auto n = cross(ab, ac);
        const D along = -dot(n, widened(way.direction));
        s.density = density_at(along, way.distance);
        const auto lit = s.density > 0;
        s.radiance = only(lit, radiance);
        s.free = only(lit, detail::free_way(point, way.distance, min(min(a, b), c), max(max(a, b), c),
                                            magnitude(along) / root(length2(n))));
        return s;
    }
    /// The density that `sample` returns for the place where a ray hits the triangle: a ray of this
    /// direction, of length 1, at this distance. 0 where no light comes from.
    F density_toward(const Vec<F, 3>& direction, F distance) const {
        return density_at(-dot(normal(), widened(direction)), distance);
    }
    /// The radiance that a ray of this direction meets.
    Vec3f radiance_toward(const Vec3f& direction) const requires std::same_as<F, float> {
        return both_sides || dot(normal(), Vec3d(direction)) < 0 ? radiance : Vec3f();
    }

private:
    /// The density of a hit where the normal, of twice the area's length, goes so far back along the ray.
    F density_at(D along, F distance) const {
        const D back = D(select(both_sides, F(1), F(0))), facing = greater(along, -along * back);
        const D d(distance), density = detail::bounded_density(2 * product(d, d) / facing);
        return in_float(only(d > 0 && facing > 0, density));
    }
};
using EmissiveTriangle = EmissiveTriangleOf<float>;

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
