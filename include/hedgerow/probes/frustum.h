/// A beam as a probe: the rays between four rays (in the plane, two) from one eye, or between parallel ones
/// (Heckbert and Hanrahan, Beam tracing polygonal objects, SIGGRAPH 1984).
#pragma once

#include <string>

#include <hedgerow/base/error.h>
#include <hedgerow/probes/ray_family.h>

namespace hedgerow {

/// The rays between corner rays, which are given in their order around the beam, either way round. A ray is
/// in the beam if its origin and its direction are combinations, with weights >= 0, of those of the corners,
/// up to 16 roundings of the largest component. Directions may have any lengths. The axis is the mean of the
/// corners' directions of length 1, and a hit at t on a ray has the depth t·(direction·axis). The beam
/// reaches from the least depth of a corner's t_min to the greatest of a t_max.
///
/// Frustum (geometry/frustum.h) is the region between such planes, a closed set that `overlapping` decides
/// exactly. A beam has an order and a limit, and holds what its rays hit, with their errors.
template <std::floating_point T, int D>
class FrustumRays {
public:
    using Scalar = T;
    static constexpr int dimension = D;
    using Point = Vec<double, D>;
    static constexpr std::size_t corner_count = D == 3 ? 4 : 2, face_count = corner_count;
    using Corners = std::array<Ray<T, D>, corner_count>;

    /// Throws InputError for a corner that cannot hit anything (RayProbe::usable), and for corners that are
    /// not all within 89 degrees of their mean.
    explicit FrustumRays(const Corners& corners) : corners_(corners) {
        for (std::size_t i = 0; i < corner_count; ++i) {
            const RayProbe<T, D> probe(corners[i], {corners[i].origin, corners[i].origin});
            if (!probe.usable())
                throw InputError("corner " + std::to_string(i) +
                                 " of a beam is no usable ray: give it finite numbers, a direction that is "
                                 "not 0 and t_min <= t_max");
            origin_[i] = Point(corners[i].origin);
            const Point d(probe.ray().direction);
            direction_[i] = normalized(d / max_component(abs(d)));
            axis_ = axis_ + direction_[i];
        }
        axis_ = normalized(axis_);
        depths_ = {std::numeric_limits<double>::infinity(), 0};
        for (std::size_t i = 0; i < corner_count; ++i) {
            const double forward = dot(direction_[i], axis_);
            if (!(forward > 0x1p-6))
                throw InputError(
                    "corner " + std::to_string(i) +
                    " of a beam is no less than 89 degrees from the beam's axis: split the beam");
            direction_[i] = direction_[i] / forward;
            const auto depth = [&](T t) { return t > 0 ? depth_of(corners[i], t) : 0; };
            depths_ = {std::min(depths_.entry, depth(corners[i].t_min)),
                       std::max(depths_.exit, depth(corners[i].t_max))};
        }
    }

    const Point& axis() const { return axis_; }
    Interval<double> depths() const { return depths_; }
    /// The depth of the point at t on a ray of the beam.
    double depth_of(const Ray<T, D>& ray, T t) const {
        return static_cast<double>(t) * dot(Point(ray.direction), axis_);
    }
    Extent origins(const Point& normal) const { return extent(origin_, normal); }
    Extent directions(const Point& normal) const { return extent(direction_, normal); }

    double slack(const Box<T, D>& scene) const {
        double most = 0;
        for (const auto& corner : corners_)
            most = std::max(most, static_cast<double>(RayProbe<T, D>(corner, scene).slack()));
        return 4 * most;
    }
    /// A face through each pair of neighbours among the corners. Where rounding or a twist tilts it, so that
    /// the beam crosses it with the depth, it is moved to where the beam ends in the scene.
    std::array<Slab<D>, face_count> faces(const Box<T, D>& scene, double slack) const {
        std::array<Slab<D>, face_count> all;
        Point farthest;
        for (const Point& o : origin_)
            farthest = max(farthest, max(abs(Point(scene.low) - o), abs(Point(scene.high) - o)));
        const double depth = (dot(abs(axis_), farthest) + slack * D) * (1 + 0x1p-20);
        for (std::size_t i = 0; i < face_count; ++i) {
            Point n = normalized(normal(i));
            // Outward: away from most of the other corners.
            double side = 0;
            for (std::size_t k = 0; k < corner_count; ++k)
                side += dot(n, direction_[k]) + dot(n, origin_[k] - origin_[i]);
            if (side > 0) n = -n;
            const double reach = dot(abs(n), Point::all(1));
            const double rise = std::max(0.0, directions(n).high) + 0x1p-49 * length(direction_[i]) * reach;
            const double high = origins(n).high + product(rise, depth) + product(slack, reach);
            all[i] = {n, -std::numeric_limits<double>::infinity(), high};
        }
        return all;
    }

private:
    static Extent extent(const std::array<Point, corner_count>& points, const Point& normal) {
        Extent e{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
        for (const Point& p : points) {
            const double height = dot(normal, p);
            e.low = std::min(e.low, height), e.high = std::max(e.high, height);
        }
        return e;
    }
    /// A normal of the face between corner i and the next; in the plane, of corner i's own line.
    Point normal(std::size_t i) const {
        if constexpr (D == 2) {
            return {-direction_[i][1], direction_[i][0]};
        } else {
            const std::size_t next = (i + 1) % corner_count;
            const Point apart = origin_[next] - origin_[i];
            if (apart == Point()) return cross(direction_[i], direction_[next]);
            return cross(apart / max_component(abs(apart)), direction_[i]);
        }
    }

    Corners corners_;
    std::array<Point, corner_count> origin_, direction_;
    Point axis_;
    Interval<double> depths_;
};

template <std::floating_point T, int D>
using FrustumProbe = FamilyProbe<FrustumRays<T, D>>;

}  // namespace hedgerow
