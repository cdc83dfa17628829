/// Tests of probes against bounding volumes: the part of a line inside a volume, a lower bound of the
/// distance to it, and whether it may overlap a box. All are computed in double, and are conservative: none
/// ever rules out a volume wrongly.
///
/// Volumes are dilated when they are built (bvh/volumes/fit.h); the margins here cover the errors of
/// computing. A volume is an intersection of slabs (oriented boxes, k-DOPs, hulls), a ball, or both combined
/// (cylinders).
#pragma once

#include <algorithm>

#include <hedgerow/geometry/cylinder.h>
#include <hedgerow/geometry/distance.h>
#include <hedgerow/geometry/entry.h>
#include <hedgerow/geometry/hull.h>
#include <hedgerow/geometry/kdop.h>
#include <hedgerow/geometry/obb.h>
#include <hedgerow/geometry/region.h>

namespace hedgerow {

namespace detail {
/// Squares of smaller numbers may underflow. Added to radii and subtracted from distances.
inline constexpr double negligible = 0x1p-500;

inline constexpr Interval<double> whole_line{-std::numeric_limits<double>::infinity(),
                                             std::numeric_limits<double>::infinity()};

/// Clips a line to a slab (Kay and Kajiya 1986). The line's thickness is the error in heights. A line along
/// the slab has slope 0, whose reciprocal is infinite: the interval then stays as it is or becomes empty.
template <int D>
Interval<double> clipped(const Interval<double>& in, const ThickLine<D>& line, const Slab<D>& s) {
    const double at = dot(s.normal, line.origin), thick = product(line.thickness, s.reach());
    const double low = (s.low - thick) - at, high = (s.high + thick) - at;
    const double slope = dot(s.normal, line.direction) + 0.0, inverse = 1 / slope;  // −0 becomes 0
    const double near = (slope >= 0 ? low : high) * inverse, far = (slope >= 0 ? high : low) * inverse;
    return {near > in.entry ? near : in.entry, far < in.exit ? far : in.exit};
}

/// The part of origin + s·direction within `radius` of 0 (computed like meet_line of a sphere). If the
/// direction is too short to lead anywhere, the result is the whole line or nothing.
template <int D>
Interval<double> part_within(double radius, const Vec<double, D>& origin, const Vec<double, D>& direction) {
    constexpr Interval<double> none{1, -1};
    const double a = length2(direction), b = -dot(origin, direction);
    if (a < 0x1p-1000) return length2(origin) > product(radius, radius) ? none : whole_line;
    const Vec<double, D> nearest = origin + direction * (b / a);
    const double room = product(radius, radius) - length2(nearest);
    if (room < 0) return none;
    const double half = std::sqrt(room / a);
    return {b / a - half, b / a + half};
}
inline Interval<double> intersection(const Interval<double>& a, const Interval<double>& b) {
    return {std::max(a.entry, b.entry), std::min(a.exit, b.exit)};
}
/// The radius to use for a ball so that no point of a thick line is missed. In a ball of R instead of r, a
/// line is inside for at least (R − r)/|direction| longer at both ends, which covers the error of
/// `part_within`: twice the thickness is 8e (e of RayProbe), of which hits and the rounding of the vectors
/// use less than half.
template <int D>
double thick_radius(double radius, const ThickLine<D>& line) {
    return radius + 2 * line.thickness + negligible;
}

/// A lower bound of how far p is outside of a slab, times the normal's length; 0 inside.
template <int D>
double gap(const Vec<double, D>& p, const Slab<D>& s) {
    const double at = dot(s.normal, p);
    const double error = product(4 * unit_roundoff<double>, product(s.reach(), max_component(abs(p))));
    return std::max(0.0, std::max(s.low - at, at - s.high) - error);
}
/// A lower bound of how far p is outside of a ball around 0; 0 inside. The rounding errors of p are relative
/// to `size`.
template <int D>
double gap(const Vec<double, D>& p, double radius, double size) {
    return std::max(0.0, length(p) - radius - product(8 * unit_roundoff<double>, size) - negligible);
}

/// Whether the box misses the slab, by the box's extent along the slab's normal. An unbounded box gives NaN,
/// which counts as no miss.
template <int D>
bool beside(const Box<double, D>& box, const Slab<D>& s) {
    double low = 0, high = 0, size = 0;
    for (int k = 0; k < D; ++k) {
        const double a = product(s.normal[k], box.low[k]), b = product(s.normal[k], box.high[k]);
        low += std::min(a, b), high += std::max(a, b);
        size += std::max(std::abs(a), std::abs(b));
    }
    const double error = product(4 * unit_roundoff<double>, size) + negligible;
    return low - error > s.high || high + error < s.low;
}
}  // namespace detail

template <SlabVolume V>
Interval<double> part_in(const ThickLine<V::dimension>& line, const V& volume) {
    Interval<double> in = detail::whole_line;
    for (int i = 0; i < volume.slab_count(); ++i) in = detail::clipped(in, line, volume.slab(i));
    return in;
}
template <class T, int D>
Interval<double> part_in(const ThickLine<D>& line, const Sphere<T, D>& s) {
    return detail::part_within(detail::thick_radius(static_cast<double>(s.radius), line),
                               line.origin - Vec<double, D>(s.center), line.direction);
}
template <class T>
Interval<double> part_in(const ThickLine<3>& line, const Cylinder<T>& c) {
    const double radius = detail::thick_radius(static_cast<double>(c.radius), line);
    const auto round =
        detail::part_within(radius, c.across(line.origin - Vec3d(c.point)), c.across(line.direction));
    return detail::clipped(round, line, c.ends());
}

/// A lower bound of the squared distance from p to a volume. Distances to orthonormal slabs add up in
/// squares; of the other slabs only the farthest counts. Axes rounded to float stretch a distance by less
/// than 2^-20, which the factor 1 − 2^-18 covers.
template <SlabVolume V>
double least_distance2(const Vec<double, V::dimension>& p, const V& volume) {
    double sum = 0, most = 0;
    for (int i = 0; i < volume.slab_count(); ++i) {
        const auto slab = volume.slab(i);
        const double gap = detail::gap(p, slab), gap2 = product(gap, gap);
        if (i < V::orthonormal)
            sum += gap2;
        else
            most = std::max(most, gap2 / length2(slab.normal));
    }
    return std::max(sum, most) * (1 - 0x1p-18);
}
template <class T, int D>
double least_distance2(const Vec<double, D>& p, const Sphere<T, D>& s) {
    const Vec<double, D> from = p - Vec<double, D>(s.center);
    const double gap = detail::gap(from, static_cast<double>(s.radius), length(from));
    return product(gap, gap) * (1 - 0x1p-18);
}
template <class T>
double least_distance2(const Vec3d& p, const Cylinder<T>& c) {
    const Vec3d from = p - Vec3d(c.point);
    const double out = detail::gap(c.across(from), static_cast<double>(c.radius), length(from));
    const double along = detail::gap(p, c.ends());
    return (product(out, out) + product(along, along)) * (1 - 0x1p-18);
}

/// Whether a box may overlap a volume. Tests only the slabs' normals, not the box's own axes nor products of
/// edges, so it may accept boxes that a full separating-axis test (Gottschalk 1996) would reject.
template <SlabVolume V>
bool may_overlap(const Box<double, V::dimension>& box, const V& volume) {
    for (int i = 0; i < volume.slab_count(); ++i)
        if (detail::beside(box, volume.slab(i))) return false;
    return true;
}
template <class T, int D>
bool may_overlap(const Box<double, D>& box, const Sphere<T, D>& s) {
    const double away = length(offset_outside(Vec<double, D>(s.center), box));
    return !(away * (1 - 0x1p-40) > static_cast<double>(s.radius) + detail::negligible);
}
// Boxes around volumes, rounded outward.

/// A point is the sum of its heights along orthonormal axes. Axes rounded to float err by less than 2^-20.
/// Hulls, which have no such axes, may be anywhere.
template <SlabVolume V>
Box<double, V::dimension> box_around(const V& volume) {
    constexpr int D = V::dimension;
    if constexpr (V::orthonormal < D) {
        const auto infinite = Vec<double, D>::all(std::numeric_limits<double>::infinity());
        return {-infinite, infinite};
    } else {
        Box<double, D> box{Vec<double, D>(), Vec<double, D>()};
        double size = 0;
        for (int i = 0; i < D; ++i) {
            const auto slab = volume.slab(i);
            for (int k = 0; k < D; ++k) {
                const double a = product(slab.normal[k], slab.low), b = product(slab.normal[k], slab.high);
                box.low[k] += std::min(a, b), box.high[k] += std::max(a, b);
            }
            size += std::max(std::abs(slab.low), std::abs(slab.high));
        }
        const auto error = Vec<double, D>::all(product(0x1p-18, size) + detail::negligible);
        return {box.low - error, box.high + error};
    }
}
template <class T, int D>
Box<double, D> box_around(const Sphere<T, D>& s) {
    return detail::in_double(s.bounds());
}
template <class T>
Box3d box_around(const Cylinder<T>& c) {
    const Vec3d a(c.axis), p(c.point);
    const double a2 = length2(a), here = dot(a, p), r = static_cast<double>(c.radius);
    // The centers of the two ends.
    const Vec3d first = p + a * ((static_cast<double>(c.low) - here) / a2);
    const Vec3d last = p + a * ((static_cast<double>(c.high) - here) / a2);
    const double error =
        product(0x1p-48, max_component(max(abs(first), abs(last))) + max_component(abs(p)) + r);
    Box3d box;
    for (int k = 0; k < 3; ++k) {
        // Half the width of an end's disc along axis k.
        const double wide =
            r * std::sqrt(std::max(0.0, 1 - product(a[k], a[k]) / a2)) * (1 + 0x1p-20) + error + r * 0x1p-20;
        box.low[k] = std::min(first[k], last[k]) - wide, box.high[k] = std::max(first[k], last[k]) + wide;
    }
    return box;
}

/// Whether a box may overlap a cylinder. Tests the slab between the cylinder's ends, then its axis-aligned
/// bounds.
template <class T>
bool may_overlap(const Box3d& box, const Cylinder<T>& c) {
    return !detail::beside(box, c.ends()) && overlap(box, box_around(c));
}

namespace detail {
/// Whether a region misses a slab, by the region's extent along the slab's normal. The tests of primitives in
/// the slab err less than the error here (region.h).
template <class R, int D>
bool region_beside(const R& region, const Slab<D>& s) {
    const Extent heights = extent(region, s.normal);
    const double above = product(scene_margin, std::abs(s.high)),
                 below = product(scene_margin, std::abs(s.low));
    return heights.low - above > s.high || heights.high + below < s.low;
}
}  // namespace detail

/// Whether a region may overlap a volume, by the box around the volume, and by the region's extents along the
/// volume's normals.
template <Region R, class V>
bool may_meet(const R& region, const V& volume) {
    if (containment(region, box_around(volume)) == Containment::outside) return false;
    if constexpr (SlabVolume<V>) {
        for (int i = 0; i < volume.slab_count(); ++i)
            if (detail::region_beside(region, volume.slab(i))) return false;
    } else if constexpr (requires { volume.ends(); }) {
        return !detail::region_beside(region, volume.ends());
    }
    return true;
}

}  // namespace hedgerow
