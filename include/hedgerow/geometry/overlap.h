/// Overlap tests of shapes and boxes. Sets are closed: touching counts. The results are those of exact
/// arithmetic on the given coordinates (orientation.h). So a box that overlaps a shape always
/// overlaps the shape's own box, and the cells that contain a common point of a shape and a box are always
/// among the cells that the shape is inserted into.
#pragma once

#include <hedgerow/geometry/distance.h>
#include <hedgerow/geometry/orientation.h>

namespace hedgerow {

template <class T, int D>
constexpr bool overlap(const Box<T, D>& a, const Box<T, D>& b) {
    for (int i = 0; i < D; ++i)
        if (!(a.low[i] <= b.high[i] && b.low[i] <= a.high[i])) return false;
    return true;
}

namespace detail {
/// An edge from p to q, for tests in the planes across the axes.
template <int D>
struct Edge {
    Vec<double, D> p, q, along;

    Edge(const Vec<double, D>& from, const Vec<double, D>& to) : p(from), q(to), along(to - from) {}

    /// 1 if p, q, x turn counterclockwise in the plane of axes u and v, −1 if clockwise, 0 if x is on the
    /// line.
    int turn(const Vec<double, D>& x, int u, int v) const { return hedgerow::turn(p, q, along, x, u, v); }
    /// Whether the whole box is beyond the edge's line: clockwise of it (sign 1) or counterclockwise (sign
    /// −1). Tests the box's corner that is farthest the other way (Schwarz and Seidel 2010).
    bool beyond(const Box<double, D>& box, int u, int v, int sign) const {
        Vec<double, D> corner = box.low;
        if ((along[u] > 0) == (sign > 0)) corner[v] = box.high[v];
        if ((along[v] > 0) != (sign > 0)) corner[u] = box.high[u];
        return turn(corner, u, v) * sign < 0;
    }
};
}  // namespace detail

/// A triangle, prepared for overlap tests with many boxes. Triangle and box overlap unless one of these
/// separates them: an axis, the triangle's plane, or an edge of the triangle in the plane across an axis
/// (Akenine-Möller 2001; with edge functions Schwarz and Seidel 2010). Only the part of the box inside the
/// triangle's own box matters. Exact for all coordinates, also for triangles without area.
template <class T>
class TriangleOverlap {
public:
    explicit TriangleOverlap(const Triangle<T, 3>& tri)
        : tri_(tri),
          bounds_(tri.bounds()),
          edges_{{{Vec3d(tri.a), Vec3d(tri.b)}, {Vec3d(tri.b), Vec3d(tri.c)}, {Vec3d(tri.c), Vec3d(tri.a)}}} {
        const Vec3d &e = edges_[0].along, &f = edges_[2].along;
        for (int k = 0; k < 3; ++k) {
            const int u = (k + 1) % 3, v = (k + 2) % 3;
            const double left = product(e[v], f[u]), right = product(e[u], f[v]);
            normal_[k] = left - right;
            size_[k] = std::abs(left) + std::abs(right);
            turn_[k] = edges_[0].turn(edges_[1].q, u, v);
        }
    }

    bool operator()(const Box<T, 3>& whole) const {
        const Box<T, 3> part = intersection(whole, bounds_);
        if (part.empty()) return false;
        if (part.contains(tri_.a) || part.contains(tri_.b) || part.contains(tri_.c)) return true;
        const Box3d box{Vec3d(part.low), Vec3d(part.high)};
        if (beside_plane(box)) return false;
        for (int k = 0; k < 3; ++k) {
            const int u = (k + 1) % 3, v = (k + 2) % 3;
            for (const auto& edge : edges_) {
                // A triangle seen edge-on (turn 0) is a line, and both of its sides are outside.
                if (turn_[k] >= 0 && edge.beyond(box, u, v, 1)) return false;
                if (turn_[k] <= 0 && edge.beyond(box, u, v, -1)) return false;
            }
        }
        return true;
    }

private:
    /// Whether the box is strictly on one side of the triangle's plane. The height of a corner errs by less
    /// than 7u + 56u² of its products' magnitudes, where u is the unit roundoff (Shewchuk 1997, section 4.3).
    /// The filter takes 16u of the greatest magnitudes of any corner. It therefore also holds for a corner
    /// that was found by a normal whose sign is in doubt.
    bool beside_plane(const Box3d& box) const {
        const Vec3d low = box.low - edges_[0].p, high = box.high - edges_[0].p;
        // Bound the heights of all corners, and the magnitudes of their products.
        double least = 0, most = 0, magnitude = 0, reach = 0;
        for (int k = 0; k < 3; ++k) {
            const double from = product(normal_[k], low[k]), to = product(normal_[k], high[k]);
            const double farther = std::max(std::abs(low[k]), std::abs(high[k]));
            least += std::min(from, to), most += std::max(from, to);
            magnitude += product(size_[k], farther);
            reach += farther;
        }
        // Filter: the heights decide if they are clear of the error.
        const double error = product(16 * unit_roundoff<double>, magnitude) +
                             product(detail::underflow, reach) + detail::underflow;
        if (least > error || most < -error) return true;
        if (least < -error && most > error) [[likely]]
            return false;
        // In doubt: decide exactly by the lowest and the highest corner.
        if (magnitude == 0 && lies_in_plane(low, high)) return false;
        return exact_height(box, -1) > 0 || exact_height(box, 1) < 0;
    }
    /// Whether every product of the corners' heights has a factor of exactly 0, as for a flat box in the
    /// plane of a triangle across an axis.
    bool lies_in_plane(const Vec3d& low, const Vec3d& high) const {
        for (int k = 0; k < 3; ++k)
            if (turn_[k] != 0 && (low[k] != 0 || high[k] != 0)) return false;
        return true;
    }
    /// The side of the plane on which the box's lowest (sign −1) or highest (1) corner lies.
    int exact_height(const Box3d& box, int sign) const {
        Vec3d corner = box.low;
        for (int k = 0; k < 3; ++k)
            if (turn_[k] * sign > 0) corner[k] = box.high[k];
        return exact_side(edges_[0].p, edges_[0].q, edges_[1].q, corner);
    }

    Triangle<T, 3> tri_;
    Box<T, 3> bounds_;
    std::array<detail::Edge<3>, 3> edges_;
    Vec3d normal_, size_;  // the normal, and the magnitudes of the products that it is made of
    int turn_[3];          // exact signs of the normal's components
};
template <class T>
bool overlap(const Triangle<T, 3>& tri, const Box<T, 3>& box) {
    return TriangleOverlap<T>(tri)(box);
}

template <class T>
bool overlap(const Segment<T, 2>& s, const Box<T, 2>& whole) {
    const Box<T, 2> part = intersection(whole, s.bounds());
    if (part.empty()) return false;
    const Box2d box{Vec2d(part.low), Vec2d(part.high)};
    const detail::Edge<2> edge{Vec2d(s.a), Vec2d(s.b)};
    return !edge.beyond(box, 0, 1, 1) && !edge.beyond(box, 0, 1, -1);
}

/// Whether the solid ball overlaps the box.
template <class T, int D>
bool overlap(const Sphere<T, D>& s, const Box<T, D>& box) {
    if (!overlap(s.bounds(), box)) return false;
    const Vec<double, D> center(s.center);
    const double radius = static_cast<double>(s.radius), radius2 = product(radius, radius);
    const Vec<double, D> nearest =
        clamped(center, Box<double, D>{Vec<double, D>(box.low), Vec<double, D>(box.high)});
    const double away2 = distance2(center, nearest);
    const double error = product(8 * unit_roundoff<double>, away2 + radius2) + detail::underflow;
    if (std::abs(away2 - radius2) > error) [[likely]]
        return away2 < radius2;
    // In doubt: the exact sign of |nearest − center|² − radius².
    ExactSum sum;
    for (int k = 0; k < D; ++k) {
        const double c = center[k], x = nearest[k];
        sum.add(x, x).subtract(2, x, c).add(c, c);
    }
    return sum.subtract(radius, radius).sign() <= 0;
}

}  // namespace hedgerow
