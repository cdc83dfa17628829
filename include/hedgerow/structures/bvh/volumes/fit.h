/// Volumes fitted around points: in double, dilated by a margin, and rounded outward to T.
///
/// A fitted volume need not be the least of its kind. It contains the points, because its heights and radii
/// are measured at the end, with the very normals, axes and centers that are stored.
#pragma once

#include <hedgerow/geometry/volumes.h>
#include <hedgerow/structures/bvh/volumes/frames.h>

namespace hedgerow {

namespace detail {
/// The slab along a normal that contains the points, enlarged by the margin and by the rounding error of the
/// heights.
template <int D>
Slab<D> slab_around(PointSpan<D> points, const Vec<double, D>& normal, double margin) {
    Slab<D> s{normal, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    double size = 0;
    for (const auto& p : points) {
        const double height = dot(normal, p);
        s.low = std::min(s.low, height), s.high = std::max(s.high, height);
        size = std::max(size, max_component(abs(p)));
    }
    const double by = product(s.reach(), margin + product(4 * unit_roundoff<double>, size));
    s.low -= by, s.high += by;
    return s;
}

/// The center of a ball around the points that is about as small as possible. It starts from the middle of
/// two points that lie far apart (Ritter 1990), and moves towards the farthest point in ever shorter steps
/// (Bădoiu and Clarkson 2003). With 32 steps the radius is within some percent of the least.
template <int D>
Vec<double, D> center_of(PointSpan<D> points) {
    const Vec<double, D> a = farthest(points, points[0]), b = farthest(points, a);
    Vec<double, D> center = a * 0.5 + b * 0.5, best = center;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 32; ++i) {
        const Vec<double, D> far = farthest(points, center);
        if (const double d2 = distance2(far, center); d2 < least) least = d2, best = center;
        center = center + (far - center) / (i + 4.0);
    }
    return best;
}
}  // namespace detail

/// Fits a volume around at least one point. O(points).
template <class V>
struct VolumeFit;

template <class T, int D>
struct VolumeFit<Sphere<T, D>> {
    static Sphere<T, D> around(PointSpan<D> points, double margin) {
        Sphere<T, D> s;
        s.center = Vec<T, D>(detail::center_of(points));
        const Vec<double, D> center(s.center);
        const double r = length(detail::farthest(points, center) - center);
        const double sides = std::sqrt(static_cast<double>(D));  // the margin is along each axis
        s.radius = rounded_up<T>(r * (1 + 0x1p-45) + sides * margin + detail::negligible);
        return s;
    }
};

/// A box in the frame of `frame_of_small_box`, or in that of the coordinates if its box there is no larger.
template <class T, int D>
struct VolumeFit<Obb<T, D>> {
    static Obb<T, D> around(PointSpan<D> points, double margin) {
        const Obb<T, D> turned = in_frame(points, frame_of_small_box(points), margin);
        const Obb<T, D> straight = in_frame(points, coordinate_axes<D>(), margin);
        return half_area(turned) < half_area(straight) ? turned : straight;
    }

private:
    static Obb<T, D> in_frame(PointSpan<D> points, const Rows<D>& axes, double margin) {
        Obb<T, D> b;
        for (int k = 0; k < D; ++k) {
            b.axis[k] = Vec<T, D>(axes[static_cast<std::size_t>(k)]);
            const auto s = detail::slab_around(points, Vec<double, D>(b.axis[k]), margin);
            b.low[k] = rounded_down<T>(s.low), b.high[k] = rounded_up<T>(s.high);
        }
        return b;
    }
    static double half_area(const Obb<T, D>& b) {
        return Box<double, D>{Vec<double, D>(b.low), Vec<double, D>(b.high)}.half_area();
    }
};

template <class T, int D, int k>
struct VolumeFit<Kdop<T, D, k>> {
    static Kdop<T, D, k> around(PointSpan<D> points, double margin) {
        Kdop<T, D, k> b;
        for (int i = 0; i < b.slab_count(); ++i) {
            const auto s = detail::slab_around(points, b.direction(i), margin);
            b.low[i] = rounded_down<T>(s.low), b.high[i] = rounded_up<T>(s.high);
        }
        return b;
    }
};

/// The cylinder of least surface along one of the principal axes or the coordinate axes.
template <class T>
struct VolumeFit<Cylinder<T>> {
    static Cylinder<T> around(PointSpan<3> points, double margin) {
        Cylinder<T> best{};
        double least = std::numeric_limits<double>::infinity();
        for (const auto& frame : {principal_axes(points), coordinate_axes<3>()})
            for (const Vec3d& axis : frame) {
                const Cylinder<T> c = along(points, axis, margin);
                const double r = static_cast<double>(c.radius);
                const double h = static_cast<double>(c.high) - static_cast<double>(c.low);
                if (const double area = product(r, r + h); !(area >= least)) least = area, best = c;
            }
        return best;
    }

private:
    static Cylinder<T> along(PointSpan<3> points, const Vec3d& axis, double margin) {
        // Measure the ends along the axis.
        Cylinder<T> c{};
        c.axis = Vec<T, 3>(axis);
        const auto s = detail::slab_around(points, Vec3d(c.axis), margin);
        c.low = rounded_down<T>(s.low), c.high = rounded_up<T>(s.high);
        // Center the cylinder on the points as seen along its axis.
        std::vector<Vec3d> flat;
        for (const auto& p : points) flat.push_back(c.across(p - points[0]));
        c.point = Vec<T, 3>(points[0] + detail::center_of(PointSpan<3>(flat)));
        // Measure the radius. 1.75 is above √3: the margin is along each coordinate axis.
        double r = 0, size = 0;
        for (const auto& p : points) {
            const Vec3d from = p - Vec3d(c.point);
            r = std::max(r, length(c.across(from)));
            size = std::max(size, max_component(abs(from)));
        }
        c.radius = rounded_up<T>(r * (1 + 0x1p-45) + size * 0x1p-45 + 1.75 * margin + detail::negligible);
        return c;
    }
};

/// The faces of the convex hull of the points or, if there are more than `most_corners`, of the extreme
/// points in that many directions. The faces are then pushed out until they contain all points. Where the
/// points have next to no volume, the faces are those of an oriented box.
template <class T>
struct HullFit {
    static constexpr std::size_t most_corners = 64;

    static void add_faces(PointSpan<3> points, double margin, std::vector<HalfSpace<T>>& faces) {
        std::vector<Vec3d> normals =
            hull_normals(points.size() > most_corners ? extreme(points) : copy(points));
        if (normals.empty())
            for (const Vec3d& axis : frame_of_small_box(points))
                normals.push_back(axis), normals.push_back(-axis);
        for (const Vec3d& n : normals) {
            const Vec<T, 3> normal(n);
            const auto s = detail::slab_around(points, Vec3d(normal), margin);
            faces.push_back({normal, rounded_up<T>(s.high)});
        }
    }

private:
    static std::vector<Vec3d> copy(PointSpan<3> points) { return {points.begin(), points.end()}; }
    /// The extreme points in directions that a spiral spreads evenly over the sphere (Saff and Kuijlaars
    /// 1997).
    static std::vector<Vec3d> extreme(PointSpan<3> points) {
        std::vector<Vec3d> found;
        for (std::size_t i = 0; i < most_corners; ++i) {
            const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(most_corners);
            // 2.3999… is the golden angle, π(3 − √5).
            const double turn = 2.399963229728653 * static_cast<double>(i), r = std::sqrt(1 - product(z, z));
            const Vec3d direction(r * std::cos(turn), r * std::sin(turn), z);
            found.push_back(*std::max_element(
                points.begin(), points.end(),
                [&](const Vec3d& a, const Vec3d& b) { return dot(direction, a) < dot(direction, b); }));
        }
        return found;
    }
};

}  // namespace hedgerow
