/// Cones as regions: round in space, wedges in the plane.
///
/// All tests are computed in double. Heights and distances from the side err by at most 2^-47 of the
/// distances from the apex, of triangles and segments to the side of finding them.
#pragma once

#include <array>

#include <hedgerow/geometry/region.h>

namespace hedgerow {

/// The points x within slope·h of the axis, where h is their height above the apex along the axis, from 0 to
/// `height`, which may be infinite. `slope` is the tangent of the angle between the axis and the side, at
/// most 2^10. The axis may have any length but 0. What tests need is computed once, in double.
template <std::floating_point T, int D>
class Cone {
public:
    using Scalar = T;
    static constexpr int dimension = D;
    using Point = Vec<double, D>;

    /// An empty cone.
    Cone() : Cone({}, {}, T(0)) {}
    Cone(const Vec<T, D>& apex, const Vec<T, D>& axis, T slope, T height = std::numeric_limits<T>::infinity())
        : apex_(apex), slope_(static_cast<double>(slope)), height_(static_cast<double>(height)) {
        empty_ = !finite(apex) || !finite(axis) || axis == Vec<T, D>() ||
                 !(slope >= 0 && slope <= T(0x1p10)) || !(height >= 0);
        const Point a(axis), scaled = a * scale_to_one(max_component(abs(a)));
        axis_ = scaled / length(scaled);
        cosine_ = 1 / std::sqrt(1 + product(slope_, slope_));
        sine_ = product(slope_, cosine_);
    }

    const Point& apex() const { return apex_; }
    /// The axis, of length 1.
    const Point& axis() const { return axis_; }
    double slope() const { return slope_; }
    double height() const { return height_; }
    /// Whether a number is NaN, a vector is not finite, the axis has length 0, the slope or height is below
    /// 0, or the slope is above 2^10.
    bool empty() const { return empty_; }

    /// A place seen from the apex: its height along the axis, and its distance from the axis.
    struct Seen {
        double height, across;
    };
    Point from_apex(const Point& x) const { return x - apex_; }
    Seen seen(const Point& v) const {
        double across;
        if constexpr (D == 2)
            across = std::abs(product(axis_[0], v[1]) - product(axis_[1], v[0]));
        else
            across = length(cross(axis_, v));
        return {dot(axis_, v), across};
    }
    /// How far a place is outside of the side, and inside of it if negative.
    double beyond_side(const Seen& s) const { return product(s.across, cosine_) - product(s.height, sine_); }
    /// Whether a place is in the cone, which is widened by `error`.
    bool holds(const Seen& s, double error) const {
        return beyond_side(s) <= error && s.height >= -error && s.height <= height_ + error;
    }
    /// The distance from the cone; 0 inside.
    double distance(const Seen& s) const {
        if (holds(s, 0)) return 0;
        // The closest place of the side's line, from the apex to the rim.
        const double rim = height_ / cosine_;
        const double along =
            std::min(rim, std::max(0.0, product(s.height, cosine_) + product(s.across, sine_)));
        double away = length(Vec2d(s.height - product(along, cosine_), s.across - product(along, sine_)));
        if (s.height > height_)
            away = std::min(
                away, length(Vec2d(s.height - height_, std::max(0.0, s.across - product(height_, slope_)))));
        return away;
    }
    /// Where q(t) = (slope·height)² − across², on the line p + t·along, has its maximum within [0, 1].
    double deepest(const Point& p, const Point& along) const {
        const double h = dot(axis_, p), g = dot(axis_, along), s2 = product(sine_, sine_),
                     c2 = product(cosine_, cosine_);
        double square, mixed;
        if constexpr (D == 2) {
            const double x = product(axis_[0], p[1]) - product(axis_[1], p[0]);
            const double y = product(axis_[0], along[1]) - product(axis_[1], along[0]);
            square = product(y, y), mixed = product(x, y);
        } else {
            const Point x = cross(axis_, p), y = cross(axis_, along);
            square = length2(y), mixed = dot(x, y);
        }
        const double a = product(s2, product(g, g)) - product(c2, square);
        const double b = product(s2, product(h, g)) - product(c2, mixed);
        return a < 0 ? std::clamp(-b / a, 0.0, 1.0) : 0;
    }

private:
    Point apex_, axis_;
    double slope_, height_, cosine_, sine_;
    bool empty_;
};

namespace detail {
/// Whether a triangle or segment, given by its corners, has a point in the cone. Clips it to the heights of
/// the cone; then a corner lies in the cone, or the deepest place of an edge, or the axis meets the inside:
/// a plane's section of a cone that touches no edge is an ellipse, and has the axis in it.
template <class T, int D, std::size_t n>
bool hull_overlaps(const std::array<Vec<double, D>, n>& corners, const Cone<T, D>& cone) {
    using Point = Vec<double, D>;
    std::array<Point, n + 2> polygon, clipped;
    std::size_t size = n;
    double reach = 0;
    for (std::size_t i = 0; i < n; ++i) {
        polygon[i] = cone.from_apex(corners[i]);
        reach = std::max(reach, length(polygon[i]));
    }
    const double error = 0x1p-48 * reach + 0x1p-500;
    for (const bool at_apex : {true, false}) {
        const auto beyond = [&](const Point& v) {
            const double h = dot(cone.axis(), v);
            return at_apex ? -h - error : h - cone.height() - error;
        };
        if (!at_apex && !(cone.height() < std::numeric_limits<double>::infinity())) break;
        std::size_t kept = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const Point &p = polygon[i], &q = polygon[(i + 1) % size];
            const double from = beyond(p), to = beyond(q);
            if (from <= 0) clipped[kept++] = p;
            if ((from < 0 && to > 0) || (from > 0 && to < 0))
                clipped[kept++] = p + (q - p) * (from / (from - to));
        }
        polygon = clipped, size = kept;
        if (size == 0) return false;
    }
    bool left = true, right = true;  // of the axis, all edges
    double turns = 0, around = 0;
    for (std::size_t i = 0; i < size; ++i) {
        const Point &p = polygon[i], &q = polygon[(i + 1) % size];
        const Point along = q - p;
        for (const double t : {0.0, cone.deepest(p, along)})
            if (cone.holds(cone.seen(p + along * t), 2 * error)) return true;
        if constexpr (D == 3) {
            // Of `along` rather than q, so that roundings are small beside the edge.
            const double turn = dot(cone.axis(), cross(p, along));
            turns += turn, around += length(along);
            left = left && turn >= 0, right = right && turn <= 0;
        }
    }
    if (D == 2 || size < 3 || !(left || right)) return false;
    // The axis's line meets the polygon: at a height of the cone, since the polygon is clipped to these. Of a
    // polygon that has no area along the axis, but for roundings, an edge would have been found.
    return left != right && std::abs(turns) > product(0x1p-50, product(reach, around));
}
}  // namespace detail

template <class T, int D>
bool is_empty(const Cone<T, D>& region) {
    return region.empty();
}
/// A box is outside if the ball around it is, or if it is beyond the apex or the base.
template <class T, class U, int D>
Containment containment(const Cone<T, D>& cone, const Box<U, D>& box) {
    const Vec<double, D> low = cone.from_apex(Vec<double, D>(box.low)),
                         high = cone.from_apex(Vec<double, D>(box.high));
    const Vec<double, D> middle = low * 0.5 + high * 0.5;
    const double radius = length(high - low) * 0.5;
    const double reach = length(max(abs(low), abs(high)));
    // A place that errs in height and side may be farther away, by the slope.
    const double error = 0x1p-34 * reach + 0x1p-480;
    double least = 0, most = 0;
    for (int k = 0; k < D; ++k) {
        const double a = product(cone.axis()[k], low[k]), b = product(cone.axis()[k], high[k]);
        least += std::min(a, b), most += std::max(a, b);
    }
    if (most < -error || least > cone.height() + error || cone.distance(cone.seen(middle)) > radius + error)
        return Containment::outside;
    if (!(reach < std::numeric_limits<double>::infinity())) return Containment::across;
    for (unsigned c = 0; c < 1u << D; ++c) {
        Vec<double, D> corner = low;
        for (int k = 0; k < D; ++k)
            if (c >> k & 1u) corner[k] = high[k];
        if (!cone.holds(cone.seen(corner), -error)) return Containment::across;
    }
    return Containment::inside;
}
template <class T, int D>
Extent extent(const Cone<T, D>& cone, const Vec<double, D>& normal) {
    // Along the axis a unit of height changes the height along the normal by `along`, and the rim by `aside`.
    const double along = dot(cone.axis(), normal);
    const auto across = normal - cone.axis() * along;
    const double aside = product(cone.slope(), length(across));
    const double at = dot(normal, cone.apex()), error = 0x1p-40 * (length(normal) + aside);
    const auto reach = [&](double rate) { return rate > 0 ? product(rate, cone.height()) : 0; };
    const double rounding = 0x1p-34 * dot(abs(normal), abs(cone.apex())) + 0x1p-480;
    return {at - reach(aside - along + error) - rounding, at + reach(aside + along + error) + rounding};
}
template <class T, int D>
Box<double, D> bounds_in(const Cone<T, D>& cone, const Box<double, D>& box, double margin) {
    Box<double, D> part = box;
    for (int k = 0; k < D; ++k) {
        Vec<double, D> axis;
        axis[k] = 1;
        const Extent e = extent(cone, axis);
        part.low[k] = std::max(part.low[k], e.low - margin);
        part.high[k] = std::min(part.high[k], e.high + margin);
    }
    return part;
}

template <class T, int D>
bool lies_in(const Vec<T, D>& p, const Cone<T, D>& cone) {
    return cone.holds(cone.seen(cone.from_apex(Vec<double, D>(p))), 0);
}
template <class T, int D>
bool lies_in(const Sphere<T, D>& s, const Cone<T, D>& cone) {
    return cone.holds(cone.seen(cone.from_apex(Vec<double, D>(s.center))), -static_cast<double>(s.radius));
}
template <class T, int D>
bool overlap(const Sphere<T, D>& s, const Cone<T, D>& cone) {
    return cone.distance(cone.seen(cone.from_apex(Vec<double, D>(s.center)))) <=
           static_cast<double>(s.radius);
}
template <class T, int D>
bool overlap(const Triangle<T, D>& t, const Cone<T, D>& cone) {
    using Point = Vec<double, D>;
    return detail::hull_overlaps(std::array{Point(t.a), Point(t.b), Point(t.c)}, cone);
}
template <class T, int D>
bool overlap(const Segment<T, D>& s, const Cone<T, D>& cone) {
    using Point = Vec<double, D>;
    return detail::hull_overlaps(std::array{Point(s.a), Point(s.b)}, cone);
}

}  // namespace hedgerow
