/// Shapes as data only: plane, triangle, segment, sphere.
#pragma once

#include <hedgerow/geometry/box.h>
#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// The points x with dot(normal, x) == offset. The normal need not have length 1.
template <std::floating_point T, int D>
struct Plane {
    Vec<T, D> normal;
    T offset = T(0);
};

/// The points x with x[axis] == position.
template <std::floating_point T>
struct AxisPlane {
    int axis = 0;
    T position = T(0);
};

/// A plane that cuts space, with a thickness, in double whatever the scene's scalar. A point whose height is
/// within `margin` may count for either side. Heights and `margin` are distances times the normal's length.
template <int D>
struct CutPlane {
    Vec<double, D> normal;
    double offset = 0, margin = 0;

    /// The distance of a point from the plane times the normal's length, positive on the high side.
    double height(const Vec<double, D>& x) const { return dot(normal, x) - offset; }
    /// The most that a height changes when every coordinate changes by 1: the sum of the normal's magnitudes.
    double reach() const {
        double sum = 0;
        for (int k = 0; k < D; ++k) sum += std::abs(normal[k]);
        return sum;
    }
};

template <std::floating_point T, int D>
struct Triangle {
    Vec<T, D> a, b, c;

    constexpr Box<T, D> bounds() const {
        Box<T, D> box;
        return box.expand(a).expand(b).expand(c);
    }
    /// (b − a) × (c − a). Its length is twice the area; seen from its tip, a, b, c turn counterclockwise.
    constexpr Vec<T, D> normal() const requires(D == 3) { return cross(b - a, c - a); }
};

template <std::floating_point T, int D>
struct Segment {
    Vec<T, D> a, b;

    constexpr Box<T, D> bounds() const {
        Box<T, D> box;
        return box.expand(a).expand(b);
    }
};

template <std::floating_point T, int D>
struct Sphere {
    using Scalar = T;
    static constexpr int dimension = D;

    Vec<T, D> center;
    T radius = T(0);

    /// Rounded outward, so that the whole ball is inside.
    Box<T, D> bounds() const {
        return {map(center, [r = radius](T c) { return -sum_rounded_up(-c, r); }),
                map(center, [r = radius](T c) { return sum_rounded_up(c, r); })};
    }
};

}  // namespace hedgerow
