/// A ray or a piece of it: origin + t·direction for t_min <= t <= t_max.
#pragma once

#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// t is in units of the direction's length, which need not be 1. t_min >= 0; both ends are included.
template <std::floating_point T, int D>
struct Ray {
    using Scalar = T;
    static constexpr int dimension = D;

    Vec<T, D> origin;
    Vec<T, D> direction;
    T t_min = T(0);
    T t_max = std::numeric_limits<T>::infinity();

    constexpr Vec<T, D> at(T t) const { return origin + direction * t; }
};

/// A ray's line in double: all points within `thickness`, along every axis, of a point origin + s·direction.
/// The largest component of the direction is about 1. The ray's t is s·unit.
template <int D>
struct ThickLine {
    Vec<double, D> origin, direction;
    double thickness, unit;
};

using Ray2f = Ray<float, 2>;
using Ray2d = Ray<double, 2>;
using Ray3f = Ray<float, 3>;
using Ray3d = Ray<double, 3>;

}  // namespace hedgerow
