/// Orthonormal frames in which points have a small extent: principal axes, and those of a small oriented box.
#pragma once

#include <span>

#include <hedgerow/geometry/box.h>
#include <hedgerow/geometry/calipers.h>
#include <hedgerow/geometry/distance.h>
#include <hedgerow/geometry/eigen.h>

namespace hedgerow {

template <int D>
using PointSpan = std::span<const Vec<double, D>>;

template <int D>
Rows<D> coordinate_axes() {
    Rows<D> axes{};
    for (int k = 0; k < D; ++k) axes[static_cast<std::size_t>(k)][k] = 1;
    return axes;
}

namespace detail {

template <int D>
using Points = std::vector<Vec<double, D>>;

/// The points moved and scaled so that their box is centred and its longest side is 1. All points become 0
/// where that side is so short that its reciprocal might overflow.
template <int D>
Points<D> brought_to_one(PointSpan<D> points) {
    Box<double, D> box;
    for (const auto& p : points) box.expand(p);
    const Vec<double, D> middle = box.center();
    const double extent = max_component(box.extent());
    const double scale = extent > 0x1p-1000 ? 1 / extent : 0;
    Points<D> brought;
    brought.reserve(points.size());
    for (const auto& p : points) brought.push_back((p - middle) * scale);
    return brought;
}

/// The eigenvectors of the covariance of points whose extent is about 1.
template <int D>
Rows<D> axes_of_covariance(const Points<D>& points) {
    Vec<double, D> mean;
    for (const auto& p : points) mean = mean + p / static_cast<double>(points.size());
    Rows<D> covariance{};
    for (const auto& p : points) {
        const Vec<double, D> x = p - mean;
        for (std::size_t k = 0; k < covariance.size(); ++k)
            covariance[k] = covariance[k] + x * x[static_cast<int>(k)];
    }
    return eigen_of_symmetric(covariance).vectors;
}

template <int D>
Vec<double, D> coordinates_in(const Rows<D>& frame, const Vec<double, D>& p) {
    Vec<double, D> x;
    for (int k = 0; k < D; ++k) x[k] = dot(frame[static_cast<std::size_t>(k)], p);
    return x;
}
/// The extent of the points along each axis.
template <int D>
Vec<double, D> extent_in(const Rows<D>& frame, const Points<D>& points) {
    Box<double, D> box;
    for (const auto& p : points) box.expand(coordinates_in(frame, p));
    return box.extent();
}
template <int D>
double half_area(const Vec<double, D>& extent) {
    return Box<double, D>{Vec<double, D>(), extent}.half_area();
}

/// The heights of a point along evenly spread directions: in space, towards the faces, corners and edges of a
/// cube.
inline auto heights(const Vec3d& p) {
    const double x = p[0], y = p[1], z = p[2];
    return std::array{x,     y,     z,     x + y + z, x + y - z, x - y + z, x - y - z,
                      x + y, x - y, x + z, x - z,     y + z,     y - z};
}
inline auto heights(const Vec2d& p) {
    const double x = p[0], y = p[1];
    return std::array{x, y, x + y, x - y, x + x + y, x + x - y, x + y + y, x - y - y};
}

/// The points of greatest and least height along each direction of `heights`, after the points' box in a
/// frame is scaled to a cube. The scaling samples rods and plates like balls.
template <int D>
Points<D> extreme(const Points<D>& points, Rows<D> frame) {
    constexpr std::size_t slabs = decltype(heights(Vec<double, D>()))().size();
    if (points.size() <= 2 * slabs) return points;
    // Scale the frame, so that the points' box in it is a cube.
    const Vec<double, D> extent = extent_in(frame, points);
    for (int k = 0; k < D; ++k)
        if (extent[k] > 0)
            frame[static_cast<std::size_t>(k)] = frame[static_cast<std::size_t>(k)] / extent[k];
    // Find the lowest and the highest point along each direction.
    struct Farthest {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        std::size_t lowest = 0, highest = 0;
    } farthest[slabs];
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto height = heights(coordinates_in(frame, points[i]));
        for (std::size_t s = 0; s < slabs; ++s) {
            Farthest& f = farthest[s];
            if (height[s] < f.low) f.low = height[s], f.lowest = i;
            if (height[s] > f.high) f.high = height[s], f.highest = i;
        }
    }
    // Return each of these points once, in the order given.
    std::vector<std::size_t> places;
    for (const Farthest& f : farthest) places.push_back(f.lowest), places.push_back(f.highest);
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    Points<D> found;
    for (const std::size_t i : places) found.push_back(points[i]);
    return found;
}

/// The first of the points for which f is greatest.
template <int D, class F>
Vec<double, D> greatest(PointSpan<D> points, F f) {
    const Vec<double, D>* best = &points[0];
    double most = f(points[0]);
    for (const auto& p : points)
        if (const double x = f(p); x > most) most = x, best = &p;
    return *best;
}
template <int D>
Vec<double, D> farthest(PointSpan<D> points, const Vec<double, D>& from) {
    return greatest<D>(points, [&](const Vec<double, D>& p) { return distance2(p, from); });
}
/// A frame with one axis along two points that lie far apart, and one across that axis and across two points
/// that lie far apart as seen along it. The box of least volume often lies so: in that of a regular
/// tetrahedron, two opposite edges of the tetrahedron are diagonals of faces.
inline Rows<3> spanning_axes(const Points<3>& points) {
    const Vec3d a = farthest<3>(points, points[0]), b = farthest<3>(points, a), along = normalized(b - a);
    const auto far_across = [&](const Vec3d& c) {
        return greatest<3>(points, [&](const Vec3d& p) { return length2(cross(along, p - c)); });
    };
    const Vec3d c = far_across(a), d = far_across(c), across = cross(along, d - c);
    if (!(length2(across) > 0x1p-80)) return coordinate_axes<3>();  // all lie on a line
    // Where the points nearly lie on a line, `across` is a small difference, and its rounding error may point
    // along the axis: take that part out again.
    const Vec3d leaning = normalized(across), normal = normalized(leaning - along * dot(leaning, along));
    return {along, cross(normal, along), normal};
}

/// A frame that is turned about each axis in turn to where its box around the points has the least surface,
/// until no turn gains.
template <int D>
class TurnedFrame {
public:
    TurnedFrame(const Points<D>& points, const Rows<D>& frame)
        : points_(points), frame_(frame), extent_(extent_in(frame, points)) {
        constexpr int planes = D == 2 ? 1 : 3, most_turns = 12;
        for (int turns = 0, in_vain = 0; turns < most_turns && in_vain < planes; ++turns)
            in_vain = turn(turns % planes) ? 0 : in_vain + 1;
    }
    const Rows<D>& frame() const { return frame_; }
    double half_area() const { return detail::half_area(extent_); }

private:
    /// Turns an axis and the next one in their plane. Returns false where that gains less than a thousandth.
    bool turn(int first) {
        const int second = (first + 1) % D;
        auto& x = frame_[static_cast<std::size_t>(first)];
        auto& y = frame_[static_cast<std::size_t>(second)];
        // Measure the rectangles around the points as seen in that plane.
        flat_.clear();
        for (const auto& p : points_) flat_.push_back({dot(x, p), dot(y, p)});
        double least = half_area() * (1 - 0x1p-10);
        Vec2d side(1, 0);
        Vec<double, D> extent = extent_;
        calipers_.for_each_rectangle(flat_, [&](const Rectangle& r) {
            extent[first] = r.along, extent[second] = r.across;
            if (const double area = detail::half_area(extent); area < least)
                least = area, side = r.side, extent_ = extent;
        });
        // Turn both axes to the side of the best rectangle.
        const Vec<double, D> old = x;
        x = normalized(x * side[0] + y * side[1]);
        y = normalized(y * side[0] - old * side[1]);
        return side[1] != 0;
    }

    const Points<D>& points_;
    Rows<D> frame_;
    Vec<double, D> extent_;
    std::vector<Vec2d> flat_;
    Calipers calipers_;
};

}  // namespace detail

/// The principal axes of the points: the eigenvectors of their covariance.
template <int D>
Rows<D> principal_axes(PointSpan<D> points) {
    return detail::axes_of_covariance(detail::brought_to_one(points));
}

/// The frame of a box around the points with a small surface: mostly within some percent of the least.
///
/// Principal axes (Gottschalk, Lin and Manocha 1996) say nothing where their variances are equal: those of a
/// cube may lie anyhow. So the principal frame is turned about each of its axes to where the box is least,
/// which calipers find. In space a second frame, across two pairs of points far apart, is turned likewise,
/// and the better frame is returned. Only points that are extreme in 26 directions (in the plane 16) are
/// measured, as by Larsson and Källberg (Fast Computation of Tight-Fitting Oriented Bounding Boxes, 2011).
/// O(points), and some microseconds.
template <int D>
Rows<D> frame_of_small_box(PointSpan<D> points) {
    const auto all = detail::brought_to_one(points);
    const Rows<D> principal = detail::axes_of_covariance(all);
    const auto some = detail::extreme(all, principal);
    const detail::TurnedFrame<D> turned(some, principal);
    if constexpr (D == 3) {
        const detail::TurnedFrame<D> spanned(some, detail::spanning_axes(some));
        if (spanned.half_area() < turned.half_area()) return spanned.frame();
    }
    return turned.frame();
}

}  // namespace hedgerow
