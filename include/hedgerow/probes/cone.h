/// A cone as a probe: the rays near an axis, as a ray whose error grows with its length (Amanatides, Ray
/// tracing with cones, SIGGRAPH 1984).
#pragma once

#include <hedgerow/base/error.h>
#include <hedgerow/probes/ray_family.h>

namespace hedgerow {

/// The rays whose origins are within `radius` of the axis's, in the plane across it, and whose directions are
/// within an angle of the axis's of which `slope` is the tangent; up to 16 roundings of the largest
/// component. So at depth t they are within radius + slope·t of the axis. A hit at t on a ray has the depth
/// t·(direction·axis), where the axis has length 1. The cone reaches from the depth of the axis's t_min to
/// that of its t_max.
///
/// Cone (geometry/cone.h) is the region inside, a closed set that `overlapping` decides exactly.
template <std::floating_point T, int D>
class ConeRays {
public:
    using Scalar = T;
    static constexpr int dimension = D;
    using Point = Vec<double, D>;
    static constexpr std::size_t face_count = 0;

    /// Throws InputError for an axis that cannot hit anything (RayProbe::usable), and for a radius or slope
    /// that is negative or not finite.
    ConeRays(const Ray<T, D>& axis, T radius, T slope)
        : ray_(axis), radius_(static_cast<double>(radius)), slope_(static_cast<double>(slope)) {
        const RayProbe<T, D> probe(axis, {axis.origin, axis.origin});
        if (!probe.usable())
            throw InputError(
                "the axis of a cone is no usable ray: give it finite numbers, a direction that is not 0 and "
                "t_min <= t_max");
        if (!(radius >= 0 && radius <= largest_coordinate<T> && slope >= 0 && slope <= T(0x1p20)))
            throw InputError(
                "a cone's radius and slope are numbers of 0 or more, and no larger than coordinates may be "
                "and 2^20");
        const Point d(probe.ray().direction);
        axis_ = normalized(d / max_component(abs(d)));
    }

    Point origin() const { return Point(ray_.origin); }
    const Point& axis() const { return axis_; }
    double radius() const { return radius_; }
    double slope() const { return slope_; }
    Interval<double> depths() const {
        const auto depth = [&](T t) { return t > 0 ? depth_of(ray_, t) : 0; };
        return {depth(ray_.t_min), depth(ray_.t_max)};
    }
    /// The depth of the point at t on a ray of the cone.
    double depth_of(const Ray<T, D>& ray, T t) const {
        return static_cast<double>(t) * dot(Point(ray.direction), axis_);
    }
    Extent origins(const Point& normal) const {
        return around(dot(normal, Point(ray_.origin)), product(radius_, across(normal)));
    }
    Extent directions(const Point& normal) const {
        return around(dot(normal, axis_), product(slope_, across(normal)));
    }
    /// Origins beside the axis's may be farther from the scene, and from 0, by the radius.
    double slack(const Box<T, D>& scene) const {
        return 4 * (static_cast<double>(RayProbe<T, D>(ray_, scene).slack()) +
                    product(32 * static_cast<double>(unit_roundoff<T>), radius_));
    }
    std::array<Slab<D>, 0> faces(const Box<T, D>&, double) const { return {}; }

private:
    /// How far a disc of radius 1 across the axis reaches along a normal.
    double across(const Point& normal) const { return length(normal - axis_ * dot(normal, axis_)); }
    static Extent around(double middle, double reach) { return {middle - reach, middle + reach}; }

    Ray<T, D> ray_;
    Point axis_;
    double radius_, slope_;
};

template <std::floating_point T, int D>
using ConeProbe = FamilyProbe<ConeRays<T, D>>;

}  // namespace hedgerow
