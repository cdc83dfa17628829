/// The shape of a bounding volume, for pictures: a polytope in double.
#pragma once

#include <numbers>

#include <hedgerow/geometry/kdop.h>
#include <hedgerow/geometry/polytope.h>
#include <hedgerow/structures/bvh/volumes/volume.h>

namespace hedgerow {

namespace detail {

/// Calls f(normal, offset) for half-spaces normal·x <= offset that each contain the volume. Round volumes
/// give some of their tangent planes.
template <SlabVolume V, class F>
void for_each_tangent(const V& v, F f) {
    for (int i = 0; i < v.slab_count(); ++i) {
        const auto s = v.slab(i);
        f(s.normal, s.high);
        if (s.low > -std::numeric_limits<double>::infinity()) f(-s.normal, -s.low);
    }
}
template <class T, class F>
void for_each_tangent(const Sphere<T, 2>& s, F f) {
    constexpr int sides = 32;
    for (int i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        const Vec2d n(std::cos(angle), std::sin(angle));
        f(n, dot(n, Vec2d(s.center)) + static_cast<double>(s.radius));
    }
}
template <class T, class F>
void for_each_tangent(const Sphere<T, 3>& s, F f) {
    for (const Vec3d& direction : KdopDirections<3>::all)
        for (const double side : {-1., 1.}) {
            const Vec3d n = normalized(direction) * side;
            f(n, dot(n, Vec3d(s.center)) + static_cast<double>(s.radius));
        }
}
template <class T, class F>
void for_each_tangent(const Cylinder<T>& c, F f) {
    constexpr int sides = 16;
    const auto ends = c.ends();
    f(ends.normal, ends.high);
    f(-ends.normal, -ends.low);
    // Make two axes across the cylinder's, by the coordinate axis that is least parallel to it.
    Vec3d beside;
    int least = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(ends.normal[k]) < std::abs(ends.normal[least])) least = k;
    beside[least] = 1;
    const Vec3d x = normalized(cross(ends.normal, beside)), y = normalized(cross(ends.normal, x));
    // Cover the round side by planes that touch it.
    for (int i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        const Vec3d n = x * std::cos(angle) + y * std::sin(angle);
        f(n, dot(n, Vec3d(c.point)) + static_cast<double>(c.radius));
    }
}

}  // namespace detail

/// The part of a volume in a box. Round volumes are replaced by the polytope of some of their tangent planes.
template <class T, int D>
Polytope<D> region_in(const AnyVolume<T, D>& volume, const Box<double, D>& box) {
    Polytope<D> region(box);
    volume.visit([&](const auto& v) {
        detail::for_each_tangent(v, [&](const Vec<double, D>& normal, double offset) {
            region = region.cut(CutPlane<D>{normal, offset, 0}).first;
        });
    });
    return region;
}

}  // namespace hedgerow
