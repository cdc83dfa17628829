/// The angle under which a point sees what closes an open surface towards infinity, in whole turns.
#pragma once

#include <algorithm>
#include <numbers>
#include <span>
#include <vector>

#include <hedgerow/geometry/axis_ray.h>

namespace hedgerow {

/// A sum of angles in (−π, π], kept as a product of complex numbers and a count of whole turns: one
/// arctangent for all of them.
class SumOfAngles {
public:
    /// Adds the angle of x + iy; 0 for 0.
    void add(double x, double y) {
        double size = std::abs(x) + std::abs(y);
        if (!(size > 0)) return;
        if (!(size > 0x1p-100 && size < 0x1p100)) {
            const int down = -std::ilogb(size);
            x = std::ldexp(x, down), y = std::ldexp(y, down);
        }
        const double real = product(re_, x) - product(im_, y), imaginary = product(re_, y) + product(im_, x);
        // Two angles of one sign make a whole turn more if their sum has the other sign.
        const bool up = im_ >= 0;
        if (up == (y >= 0) && up != (imaginary >= 0)) turns_ += up ? 1 : -1;
        re_ = real, im_ = imaginary;
        size = std::abs(re_) + std::abs(im_);
        if (!(size > 0x1p-200 && size < 0x1p200)) re_ /= size, im_ /= size;
    }
    /// In whole turns.
    double turns() const {
        return std::atan2(im_ + 0.0, re_) / (2 * std::numbers::pi) + static_cast<double>(turns_);
    }

private:
    double re_ = 1, im_ = 0;
    std::int64_t turns_ = 0;
};

namespace detail {
/// A power of two by which all offsets from x to points of a box become at most 2.
template <int D>
double scale_of_offsets(const Vec<double, D>& x, const Box<double, D>& box) {
    const double most = max_component(max(abs(box.low - x), abs(box.high - x)));
    return most > 0 ? std::ldexp(1.0, std::clamp(-std::ilogb(most), -1000, 1000)) : 1;
}
/// A number of the magnitude of x, but not 0, with a sign.
inline double with_sign(double x, int sign) {
    return sign * std::max(std::abs(x), underflow);
}
}  // namespace detail

/// The closed loops that bound a surface in space, as lists of points, the first again as the last.
///
/// The surface that follows a loop from infinity in the direction −r is seen from x under the sum of
/// Ω(−r, a, b) over the loop's edges. With ζ the stereographic projection of directions from r (so that −r
/// becomes 0), tan(Ω/2) is the argument of 1 + conj(ζ(a))·ζ(b), the oriented area of a spherical triangle
/// with a corner at 0. Angles in (−π, π] are cut along r: an edge counts as passing on that side of the ray
/// on which half_open_turn has it, so that crossings and angles never disagree about a whole turn.
class BoundingLoops {
public:
    BoundingLoops() = default;
    /// Edges that together begin at each point as often as they end there. O(n log n).
    explicit BoundingLoops(std::vector<std::array<Vec3d, 2>> edges) {
        const auto before = [](const Vec3d& a, const Vec3d& b) {
            return std::lexicographical_compare(std::begin(a.data), std::end(a.data), std::begin(b.data),
                                                std::end(b.data));
        };
        std::stable_sort(edges.begin(), edges.end(),
                         [&](const auto& e, const auto& f) { return before(e[0], f[0]); });
        // The next edge to take of those that begin where edge i does, kept at the first of these.
        std::vector<std::size_t> next(edges.size());
        for (std::size_t i = 0; i < edges.size(); ++i) next[i] = i;
        const auto first_from = [&](const Vec3d& p) {
            return static_cast<std::size_t>(
                std::lower_bound(edges.begin(), edges.end(), p,
                                 [&](const auto& e, const Vec3d& q) { return before(e[0], q); }) -
                edges.begin());
        };
        for (std::size_t i = 0; i < edges.size();) {
            const std::size_t first = first_from(edges[i][0]), at = next[first];
            if (at == edges.size() || edges[at][0] != edges[i][0]) {
                ++i;
                continue;
            }
            // Follow edges until there is none left at the end of the last: back where the loop began.
            Vec3d p = edges[i][0];
            points_.push_back(p);
            while (true) {
                const std::size_t group = first_from(p);
                if (group == edges.size() || next[group] == edges.size() || edges[next[group]][0] != p) break;
                p = edges[next[group]++][1];
                points_.push_back(p);
            }
            ends_.push_back(points_.size());
        }
        for (const Vec3d& p : points_) box_.expand(p);
    }

    bool empty() const { return points_.empty(); }
    /// The number of edges of all loops.
    std::size_t edges() const { return points_.size() - ends_.size(); }
    /// Calls f(points) for each loop.
    template <class F>
    void for_each(F f) const {
        std::size_t begin = 0;
        for (const std::size_t end : ends_) {
            f(std::span<const Vec3d>(points_).subspan(begin, end - begin));
            begin = end;
        }
    }
    /// How much the crossings of a ray lack of the winding number about its origin: the sum of Ω(−r, a, b),
    /// over 4π. About 20 ns an edge.
    double missing(const AxisRay<3>& ray) const {
        if (empty()) return 0;
        const double scale = detail::scale_of_offsets(ray.origin, box_);
        SumOfAngles halves;
        std::size_t i = 0;
        for (const std::size_t end : ends_) {
            Seen a(points_[i++], ray, scale);
            for (; i < end; ++i) {
                const Seen b(points_[i], ray, scale);
                add_half(halves, a, b, i, ray);
                a = b;
            }
        }
        return halves.turns();
    }
    std::size_t bytes() const {
        return points_.capacity() * sizeof(Vec3d) + ends_.capacity() * sizeof(std::size_t);
    }

private:
    /// A point in the stereographic projection from r: ζ = (u + iv)/w, with w = |p| − p·r free of
    /// cancellation.
    struct Seen {
        double u, v, w;

        Seen(const Vec3d& point, const AxisRay<3>& ray, double scale) {
            const Vec3d p = (point - ray.origin) * scale;
            u = p[ray.u()], v = p[ray.v()];
            const double along = p[ray.axis] * ray.direction;
            const double across2 = product(u, u) + product(v, v);
            const double length = std::sqrt(across2 + product(along, along));
            w = along > 0 ? across2 / (length + along) : length - along;
            // The ray passes a point that it meets as half_open_turn has it: the point is seen to be off the
            // ray by −ε along u.
            if (u == 0 && v == 0 && along > 0) u = -1, w = 0;
        }
    };
    void add_half(SumOfAngles& halves, const Seen& a, const Seen& b, std::size_t i,
                  const AxisRay<3>& ray) const {
        const double left = product(a.u, b.v), right = product(a.v, b.u);
        double turned = left - right;
        const double error =
            product(4 * unit_roundoff<double>, std::abs(left) + std::abs(right)) + detail::underflow;
        if (!(std::abs(turned) > error)) {
            const int sign = half_open_turn(points_[i - 1], points_[i], ray);
            if (sign == 0) return;  // along the ray, where it is seen as a point
            turned = detail::with_sign(turned, sign);
        }
        halves.add(product(a.u, b.u) + product(a.v, b.v) + product(a.w, b.w), -ray.direction * turned);
    }

    std::vector<Vec3d> points_;
    std::vector<std::size_t> ends_;  // behind each loop's last point
    Box3d box_;
};

/// The ends of open curves in the plane: what BoundingLoops are in space. An end counts +1, a beginning −1.
class OpenEnds {
public:
    struct End {
        Vec2d point;
        std::int64_t times;
    };

    OpenEnds() = default;
    explicit OpenEnds(std::vector<End> ends) : ends_(std::move(ends)) {
        for (const End& e : ends_) box_.expand(e.point);
    }

    bool empty() const { return ends_.empty(); }
    /// The sum of the angles from −r to the ends, less those to the beginnings, over 2π.
    double missing(const AxisRay<2>& ray) const {
        if (empty()) return 0;
        const double scale = detail::scale_of_offsets(ray.origin, box_);
        SumOfAngles angles;
        double more = 0;
        for (const auto& [point, times] : ends_) {
            const Vec2d p = (point - ray.origin) * scale;
            const double along = -p[ray.axis] * ray.direction;
            // An end on the line of the ray is below it, as for crossings.
            const double across =
                detail::with_sign(p[ray.u()], point[ray.u()] > ray.origin[ray.u()] ? 1 : -1);
            const double y = (ray.axis == 0 ? -across : across) * ray.direction;
            if (times == 1 || times == -1)
                angles.add(along, y * static_cast<double>(times));
            else
                more += product(std::atan2(y, along), static_cast<double>(times));
        }
        return angles.turns() + more / (2 * std::numbers::pi);
    }
    std::size_t bytes() const { return ends_.capacity() * sizeof(End); }

private:
    std::vector<End> ends_;
    Box2d box_;
};

}  // namespace hedgerow
