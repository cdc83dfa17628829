/// Bounds of the part of a shape that lies in a box.
#pragma once

#include <array>

#include <hedgerow/geometry/shapes.h>

namespace hedgerow {

namespace detail {
/// A convex polygon of few corners.
struct ClipPolygon {
    std::array<Vec3d, 9> corner;  // enough for a triangle cut by six planes
    std::size_t size = 0;

    void add(const Vec3d& p) { corner[size++] = p; }
    /// The part with sign·(x[axis] − position) <= 0 (Sutherland and Hodgman 1974).
    ClipPolygon cut(int axis, double position, double sign) const {
        ClipPolygon kept;
        for (std::size_t i = 0; i < size; ++i) {
            const Vec3d &p = corner[i], &q = corner[i + 1 < size ? i + 1 : 0];
            const double a = sign * (p[axis] - position), b = sign * (q[axis] - position);
            if (a <= 0) kept.add(p);
            if ((a < 0 && b > 0) || (a > 0 && b < 0)) kept.add(crossing(p, a, q, b, axis, position));
        }
        return kept;
    }

private:
    /// The point at which the edge from p (at height a) to q (at height b, of the other sign) crosses the
    /// plane. Starts from the end nearer to the plane, so that the point errs by fewer than 8 roundings of
    /// the largest coordinate.
    static Vec3d crossing(const Vec3d& p, double a, const Vec3d& q, double b, int axis, double position) {
        if (std::abs(a) > std::abs(b)) return crossing(q, b, p, a, axis, position);
        Vec3d at = p + (q - p) * (a / (a - b));
        at[axis] = position;
        return at;
    }
};
}  // namespace detail

/// Bounds of a triangle's part in a box; empty if there is none. Computed in double and rounded to T. A
/// corner of the part may be a crossing of crossings, at most six deep. Each side of the bounds therefore
/// errs by fewer than 48 roundings of double of the largest coordinate, and one of T.
template <class T>
Box<T, 3> clipped_bounds(const Triangle<T, 3>& tri, const Box<T, 3>& box) {
    const Box<T, 3> whole = tri.bounds();
    detail::ClipPolygon part;
    for (const auto& p : {tri.a, tri.b, tri.c}) part.add(Vec3d(p));
    for (int k = 0; k < 3; ++k) {
        if (whole.low[k] < box.low[k]) part = part.cut(k, static_cast<double>(box.low[k]), -1);
        if (whole.high[k] > box.high[k]) part = part.cut(k, static_cast<double>(box.high[k]), 1);
    }
    Box<T, 3> bounds;
    for (std::size_t i = 0; i < part.size; ++i) bounds.expand(Vec<T, 3>(part.corner[i]));
    return intersection(bounds, intersection(whole, box));
}

/// Bounds of a segment's part in a box; empty if there is none (Liang and Barsky 1984). Computed in double
/// and rounded to T.
template <class T, int D>
Box<T, D> clipped_bounds(const Segment<T, D>& s, const Box<T, D>& box) {
    const Vec<double, D> a(s.a), along = Vec<double, D>(s.b) - a;
    // Intersect, over all axes, the intervals of the parameter that lie between the box's planes.
    double first = 0, last = 1;
    for (int k = 0; k < D; ++k) {
        const double low = static_cast<double>(box.low[k]) - a[k];
        const double high = static_cast<double>(box.high[k]) - a[k];
        if (along[k] == 0) {
            if (low > 0 || high < 0) return {};
            continue;
        }
        const double enter = (along[k] > 0 ? low : high) / along[k];
        const double leave = (along[k] > 0 ? high : low) / along[k];
        first = enter > first ? enter : first;
        last = leave < last ? leave : last;
    }
    Box<T, D> bounds;
    if (first > last) return bounds;
    bounds.expand(Vec<T, D>(a + along * first)).expand(Vec<T, D>(a + along * last));
    return intersection(bounds, intersection(s.bounds(), box));
}

}  // namespace hedgerow
