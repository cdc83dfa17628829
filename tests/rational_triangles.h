/// Pairs of triangles in rational numbers (GMP): what they have in common, and how far they are apart.
#pragma once

#include <algorithm>
#include <optional>

#include "rational.h"

namespace hedgerow::rational {

inline Point operator-(const Point& p, const Point& q) {
    return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}
inline Number dot(const Point& p, const Point& q) {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}
inline Point cross(const Point& p, const Point& q) {
    return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}
inline bool zero(const Point& p) {
    return p == Point{};
}
using Corners = std::array<Point, 3>;
template <class T>
Corners corners(const Triangle<T, 3>& t) {
    return {point(t.a), point(t.b), point(t.c)};
}

/// The points x with normal · x <= offset.
struct HalfSpace {
    Point normal;
    Number offset;
};
/// Half spaces whose intersection is a triangle, with area or without.
inline std::vector<HalfSpace> half_spaces(const Corners& t) {
    std::vector<HalfSpace> all;
    const auto add = [&](const Point& normal, const Point& on) { all.push_back({normal, dot(normal, on)}); };
    const auto add_both = [&](const Point& normal, const Point& on) {
        add(normal, on);
        add(Point{} - normal, on);
    };
    const Point normal = cross(t[1] - t[0], t[2] - t[0]);
    if (!zero(normal)) {
        add_both(normal, t[0]);
        for (std::size_t i = 0; i < 3; ++i) add(cross(t[(i + 1) % 3] - t[i], normal), t[i]);
        return all;
    }
    // The ends of a segment are the corners that are farthest apart.
    std::size_t p = 0, q = 1;
    for (std::size_t i = 0; i < 3; ++i) {
        const Point e = t[(i + 1) % 3] - t[i], f = t[q] - t[p];
        if (dot(e, e) > dot(f, f)) p = i, q = (i + 1) % 3;
    }
    const Point along = t[q] - t[p];
    for (std::size_t k = 0; k < 3; ++k) {
        Point axis;
        axis[k] = 1;
        add_both(zero(along) ? axis : cross(along, axis), t[p]);
    }
    add(along, t[q]);
    add(Point{} - along, t[p]);
    return all;
}

/// Corners of what a convex polygon, segment or point has in common with all half-spaces (Sutherland and
/// Hodgman 1974).
inline std::vector<Point> clipped(std::vector<Point> polygon, const std::vector<HalfSpace>& planes) {
    for (const HalfSpace& h : planes) {
        std::vector<Point> kept;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
            const Number from = dot(h.normal, p) - h.offset, to = dot(h.normal, q) - h.offset;
            if (from <= 0) kept.push_back(p);
            if (sgn(from) * sgn(to) >= 0) continue;
            const Number share = from / (from - to);
            Point crossing;
            for (std::size_t a = 0; a < 3; ++a) crossing[a] = p[a] + (q[a] - p[a]) * share;
            kept.push_back(crossing);
        }
        polygon.swap(kept);
    }
    return polygon;
}
/// Corners of the common part of two triangles; none if they are disjoint.
inline std::vector<Point> common(const Corners& s, const Corners& t) {
    return clipped({s.begin(), s.end()}, half_spaces(t));
}

template <class T>
bool meet(const Triangle<T, 3>& s, const Triangle<T, 3>& t) {
    return !common(corners(s), corners(t)).empty();
}
/// Whether the common part has a corner that is on no segment between corners of both.
template <class T>
bool meet_beyond_shared(const Triangle<T, 3>& s, const Triangle<T, 3>& t) {
    const Corners p = corners(s), q = corners(t);
    std::vector<Point> shared;
    for (const Point& c : p)
        if (std::ranges::count(q, c) > 0) shared.push_back(c);
    const auto part = common(p, q);
    if (shared.size() == 3 && !zero(cross(p[1] - p[0], p[2] - p[0]))) return true;
    return std::ranges::any_of(part, [&](const Point& x) {
        for (const Point& u : shared)
            for (const Point& v : shared)
                if (zero(cross(v - u, x - u)) && dot(x - u, x - v) <= 0) return false;
        return true;
    });
}

/// The squared distance from a point to a segment.
inline Number distance2(const Point& x, const Point& p, const Point& q) {
    const Point along = q - p;
    const Number length2 = dot(along, along);
    Number t = length2 > 0 ? Number(dot(x - p, along) / length2) : Number(0);
    if (t < 0) t = 0;
    if (t > 1) t = 1;
    Point away = x - p;
    for (std::size_t k = 0; k < 3; ++k) away[k] -= along[k] * t;
    return dot(away, away);
}
/// The squared distance of two triangles: 0 if they meet, else the least between edges and between a corner
/// and a face.
template <class T>
Number distance2(const Triangle<T, 3>& s, const Triangle<T, 3>& t) {
    const Corners all[] = {corners(s), corners(t)};
    if (!common(all[0], all[1]).empty()) return 0;
    std::optional<Number> least;
    const auto offer = [&](const Number& d) {
        if (!least || d < *least) least = d;
    };
    for (int side = 0; side < 2; ++side) {
        const Corners &p = all[side], &q = all[1 - side];
        const Point n = cross(q[1] - q[0], q[2] - q[0]);
        for (std::size_t i = 0; i < 3; ++i) {
            bool inside = !zero(n);
            for (std::size_t j = 0; j < 3; ++j) {
                const std::size_t k = (j + 1) % 3;
                offer(distance2(p[i], q[j], q[k]));
                inside = inside && dot(cross(n, q[k] - q[j]), p[i] - q[j]) >= 0;
                // The feet of the common perpendicular of two edges, if both are on the edges.
                const std::size_t next = (i + 1) % 3;
                const Point d = p[next] - p[i], e = q[k] - q[j], r = p[i] - q[j];
                const Number a = dot(d, d), b = dot(d, e), c = dot(e, e), f = dot(d, r), g = dot(e, r);
                const Number det = a * c - b * b;
                if (det == 0) continue;
                const Number u = (b * g - c * f) / det, v = (a * g - b * f) / det;
                if (u < 0 || u > 1 || v < 0 || v > 1) continue;
                Point away = r;
                for (std::size_t x = 0; x < 3; ++x) away[x] += d[x] * u - e[x] * v;
                offer(dot(away, away));
            }
            const Number height = dot(n, p[i] - q[0]);
            if (inside) offer(height * height / dot(n, n));
        }
    }
    return *least;
}

}  // namespace hedgerow::rational
