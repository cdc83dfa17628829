/// Sets of primitives for tests of regions, and their corners in rational numbers.
#pragma once

#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/random.h>

#include "exact.h"
#include "rational.h"

namespace hedgerow {

/// A set of `count` primitives whose corners a function draws.
template <class P, class Draw>
P set_of(std::size_t count, Draw draw) {
    using T = typename P::Scalar;
    P set;
    for (std::uint32_t i = 0; i < count; ++i) {
        if constexpr (std::is_same_v<P, TriangleMesh<T>>) {
            for (int k = 0; k < 3; ++k) set.vertices.push_back(draw());
            set.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        } else if constexpr (requires { set.spheres; }) {
            const auto center = draw();
            set.spheres.push_back({center, std::abs(draw()[0])});
        } else if constexpr (requires { set.segments; }) {
            const auto a = draw();
            set.segments.push_back({a, draw()});
        } else {
            set.points.push_back(draw());
        }
    }
    return set;
}
/// Primitives of about `size` in the unit cube.
template <class P>
P small_things(std::size_t count, double size, std::uint64_t seed) {
    using V = Vec<typename P::Scalar, P::dimension>;
    Random random(seed, 0);
    Vec<double, P::dimension> at;
    std::size_t drawn = 0, corners = 1;
    if constexpr (std::is_same_v<P, TriangleMesh<typename P::Scalar>>) corners = 3;
    if constexpr (requires(P p) { p.segments; }) corners = 2;
    if constexpr (requires(P p) { p.spheres; }) corners = 2;
    return set_of<P>(count, [&] {
        if (drawn++ % corners == 0) at = random.in_cube<P::dimension>();
        if constexpr (requires(P p) { p.spheres; })
            if (drawn % corners == 0) return V(random.in_cube<P::dimension>() * size);
        return V(at + (random.in_cube<P::dimension>() - Vec<double, P::dimension>::all(0.5)) * size);
    });
}
template <class P>
P on_integers(std::size_t count, int reach, std::uint64_t seed, int exponent = 0) {
    Random random(seed, 0);
    return set_of<P>(
        count, [&] { return exact::integers<typename P::Scalar, P::dimension>(random, reach, exponent); });
}

/// The corners of a primitive, and how far its points reach beyond them.
template <class P>
std::vector<rational::Point> corners_of(const P& set, std::size_t i, rational::Number& radius) {
    radius = 0;
    if constexpr (requires { set.triangle(i); }) {
        const auto t = set.triangle(i);
        return {rational::point(t.a), rational::point(t.b), rational::point(t.c)};
    } else if constexpr (requires { set.segment(i); }) {
        return {rational::point(set.segment(i).a), rational::point(set.segment(i).b)};
    } else if constexpr (requires { set.sphere(i); }) {
        radius = double(set.sphere(i).radius);
        return {rational::point(set.sphere(i).center)};
    } else {
        return {rational::point(set.point(i))};
    }
}
}  // namespace hedgerow
