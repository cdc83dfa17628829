/// Rectangles around points in the plane.
#pragma once

#include <algorithm>
#include <vector>

#include <hedgerow/geometry/box.h>

namespace hedgerow {

/// A rectangle: the direction of one side, of length 1, and the lengths of that side and of the other.
struct Rectangle {
    Vec2d side;
    double along, across;
};

namespace detail {
/// Twice the area of the triangle o, a, b: positive if it turns left.
inline double turn(const Vec2d& o, const Vec2d& a, const Vec2d& b) {
    return product(a[0] - o[0], b[1] - o[1]) - product(a[1] - o[1], b[0] - o[0]);
}
}  // namespace detail

/// Finds the rectangles around points in the plane that have a side along an edge of the points' convex hull.
/// An object reuses its memory for the next points.
class Calipers {
public:
    /// Calls f(rectangle) for each edge of the hull (Freeman and Shapira 1975). The rectangles of least area
    /// and of least perimeter are among them. Their sides may be too short by some roundings. Makes no call
    /// if all points are equal. Sorts the points and drops repeated ones. O(n log n + h²) for h corners of
    /// the hull: each edge measures all corners, since pointers that only move forward (Toussaint 1983) get
    /// stuck at corners that exist by rounding alone.
    template <class F>
    void for_each_rectangle(std::vector<Vec2d>& points, F f) {
        find_hull(points);
        const std::size_t n = hull_.size();
        if (n < 2) return;
        for (std::size_t i = 0; i < n; ++i) {
            const Vec2d edge = hull_[(i + 1) % n] - hull_[i];
            const double l = length(edge);
            if (!(l > 0)) continue;
            const Vec2d x = edge / l, y(-x[1], x[0]);
            Box2d box;
            for (const Vec2d& p : hull_) box.expand({dot(x, p), dot(y, p)});
            f(Rectangle{x, box.extent()[0], box.extent()[1]});
        }
    }

private:
    /// Stores the corners of the hull in counterclockwise order (Andrew 1979).
    void find_hull(std::vector<Vec2d>& points) {
        std::sort(points.begin(), points.end(), [](const Vec2d& a, const Vec2d& b) {
            return a[0] < b[0] || (a[0] == b[0] && a[1] < b[1]);
        });
        points.erase(std::unique(points.begin(), points.end()), points.end());
        hull_.clear();
        if (points.size() < 2) return;
        const auto add = [&](const Vec2d& p, std::size_t first) {
            while (hull_.size() > first + 1 && !(detail::turn(hull_[hull_.size() - 2], hull_.back(), p) > 0))
                hull_.pop_back();
            hull_.push_back(p);
        };
        // The lower chain, then the upper chain back to the first point.
        for (const Vec2d& p : points) add(p, 0);
        const std::size_t top = hull_.size() - 1;
        for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], top);
        hull_.pop_back();  // the first corner again
    }

    std::vector<Vec2d> hull_;
};

}  // namespace hedgerow
