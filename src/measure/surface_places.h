/// Random places on primitives, and what share of a surface each primitive is.
#pragma once

#include <hedgerow/geometry/shapes.h>
#include <hedgerow/scenes/random.h>
#include <hedgerow/surface.h>

namespace hedgerow::measure {

/// A place on a primitive, and the normal there: a triangle's front, a sphere's outside, either side of a
/// segment.
template <class T, int D>
struct SurfacePlace {
    Vec<T, D> point;
    Vec<double, D> normal;
};

template <class T>
SurfacePlace<T, 3> place_on(const Triangle<T, 3>& t, Random& random) {
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Vec<double, 3> a(t.a), e1 = Vec<double, 3>(t.b) - a, e2 = Vec<double, 3>(t.c) - a;
    return {Vec<T, 3>(a + e1 * u + e2 * v),
            detail::unit_normal({a, Vec<double, 3>(t.b), Vec<double, 3>(t.c)})};
}
template <class T>
SurfacePlace<T, 3> place_on(const Sphere<T, 3>& s, Random& random) {
    const Vec<double, 3> n = random.direction<3>();
    return {Vec<T, 3>(Vec<double, 3>(s.center) + n * static_cast<double>(s.radius)), n};
}
template <class T>
SurfacePlace<T, 2> place_on(const Segment<T, 2>& s, Random& random) {
    const Vec<double, 2> a(s.a), along = Vec<double, 2>(s.b) - a;
    const Vec<double, 2> n = normalized(Vec<double, 2>(-along[1], along[0]));
    const Vec<T, 2> point(a + along * random.uniform());
    return {point, random.uniform() < 0.5 ? n : -n};
}

/// A point has no surface; the place is the point.
template <class T, int D>
SurfacePlace<T, D> place_on(const Vec<T, D>& p, Random&) {
    return {p, {}};
}

/// The area of a primitive (in the plane, its length) in units of `unit`, up to a factor that all primitives
/// of its type have in common.
template <class T>
double area_of(const Triangle<T, 3>& t, double unit) {
    const Vec<double, 3> a(t.a);
    return length(cross((Vec<double, 3>(t.b) - a) / unit, (Vec<double, 3>(t.c) - a) / unit));
}
template <class T>
double area_of(const Sphere<T, 3>& s, double unit) {
    const double r = static_cast<double>(s.radius) / unit;
    return product(r, r);
}
template <class T>
double area_of(const Segment<T, 2>& s, double unit) {
    return length((Vec<double, 2>(s.b) - Vec<double, 2>(s.a)) / unit);
}
template <class T, int D>
double area_of(const Vec<T, D>&, double) {
    return 0;
}

}  // namespace hedgerow::measure
