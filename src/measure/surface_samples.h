/// Random places on the surfaces of a set of primitives.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <hedgerow/geometry/box.h>
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

/// The area of a primitive (in the plane, its length) in units of `unit`, up to a factor that all primitives
/// of its type have in common.
template <class T>
double measure_of(const Triangle<T, 3>& t, double unit) {
    const Vec<double, 3> a(t.a);
    return length(cross((Vec<double, 3>(t.b) - a) / unit, (Vec<double, 3>(t.c) - a) / unit));
}
template <class T>
double measure_of(const Sphere<T, 3>& s, double unit) {
    const double r = static_cast<double>(s.radius) / unit;
    return product(r, r);
}
template <class T>
double measure_of(const Segment<T, 2>& s, double unit) {
    return length((Vec<double, 2>(s.b) - Vec<double, 2>(s.a)) / unit);
}

/// Draws random places on all primitives, evenly by area (in the plane by length). `shape(i)` is primitive i.
template <class Shape>
class SurfaceSamples {
public:
    /// `unit` is a length of the order of the scene's size. O(n) time, 8 bytes a primitive.
    SurfaceSamples(Shape shape, std::size_t size, double unit) : shape_(std::move(shape)) {
        double sum = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const double share = measure_of(shape_(i), unit);
            if (share > 0) sum += share;
            until_.push_back(sum);
        }
    }
    /// Whether no primitive has an area (a length).
    bool empty() const { return until_.empty() || !(until_.back() > 0); }
    /// A random place. O(log n) time. Not if `empty()`.
    auto place(Random& random) const {
        const double at = product(random.uniform(), until_.back());
        const auto found = std::upper_bound(until_.begin(), until_.end(), at);
        const auto i =
            std::min<std::size_t>(static_cast<std::size_t>(found - until_.begin()), until_.size() - 1);
        return place_on(shape_(i), random);
    }

private:
    Shape shape_;
    std::vector<double> until_;
};

}  // namespace hedgerow::measure
