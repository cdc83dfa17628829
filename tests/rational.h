/// Overlaps of shapes and boxes in rational numbers (GMP): the results of exact arithmetic on the given
/// coordinates.
#pragma once

#include <array>
#include <vector>

#include <gmpxx.h>

#include <hedgerow/geometry/shapes.h>

namespace hedgerow::rational {

using Number = mpq_class;
using Point = std::array<Number, 3>;  // 2D points have z = 0

template <class T, int D>
Point point(const Vec<T, D>& v) {
    Point p;
    for (int k = 0; k < D; ++k) p[static_cast<std::size_t>(k)] = static_cast<double>(v[k]);
    return p;
}

/// The part of a convex polygon inside a box, clipped by one plane after the other (Sutherland and Hodgman
/// 1974).
template <class T, int D>
std::vector<Point> clipped(std::vector<Point> polygon, const Box<T, D>& box) {
    for (int k = 0; k < D; ++k)
        for (const int sign : {-1, 1}) {
            const auto axis = static_cast<std::size_t>(k);
            const Number plane = static_cast<double>(sign < 0 ? box.low[k] : box.high[k]);
            std::vector<Point> kept;
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
                const Number from = sign * (p[axis] - plane), to = sign * (q[axis] - plane);
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

template <class T>
bool overlap(const Triangle<T, 3>& t, const Box<T, 3>& box) {
    return !clipped({point(t.a), point(t.b), point(t.c)}, box).empty();
}
template <class T>
bool overlap(const Segment<T, 2>& s, const Box<T, 2>& box) {
    return !clipped({point(s.a), point(s.b)}, box).empty();
}
template <class T, int D>
bool overlap(const Sphere<T, D>& s, const Box<T, D>& box) {
    Number sum = 0;
    for (int k = 0; k < D; ++k) {
        const Number c = static_cast<double>(s.center[k]);
        const Number below = static_cast<double>(box.low[k]) - c,
                     above = c - static_cast<double>(box.high[k]);
        const Number away = below > above ? below : above;
        if (away > 0) sum += away * away;
    }
    const Number radius = static_cast<double>(s.radius);
    return sum <= radius * radius;
}

}  // namespace hedgerow::rational
