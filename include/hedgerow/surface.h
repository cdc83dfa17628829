/// The position of a hit in the world, and the surface's normal there. Everything is computed in double and
/// rounded once.
#pragma once

#include <hedgerow/geometry/entry.h>
#include <hedgerow/geometry/exact_sum.h>
#include <hedgerow/instances/instance_set.h>
#include <hedgerow/primitives/triangle_mesh.h>
#include <hedgerow/queries/hit.h>

namespace hedgerow {

namespace detail {

template <class P>
concept OfTriangles = requires(const P& set) {
    set.triangle(0);
};
template <class P>
concept OfSegments = requires(const P& set) {
    set.segment(0);
};
template <class P>
concept OfSpheres = requires(const P& set) {
    set.sphere(0);
};
/// Whether a hit's u and v give its position: true on triangles and segments, and on instances of these.
template <class P>
inline constexpr bool has_coordinates = OfTriangles<P> || OfSegments<P>;
template <Instanced P>
inline constexpr bool has_coordinates<P> =
    has_coordinates<typename std::remove_cvref_t<decltype(std::declval<const P&>()[0].index())>::Primitives>;

template <int D>
Vec<double, D> unit(const Vec<double, D>& a) {  // divides by the largest component first, so squares fit
    return normalized(a / max_component(abs(a)));
}
/// The unit normal of any triangle that rays can hit. On slivers, where the computed cross product cancels to
/// 0, the exact signs of its components are normalised instead.
inline Vec3d unit_normal(const Triangle<double, 3>& t) {
    Vec3d e1 = t.b - t.a, e2 = t.c - t.a, n;
    const double scale = scale_to_one(max_component(max(abs(e1), abs(e2))));
    e1 = e1 * scale, e2 = e2 * scale;
    const auto across = [&](auto component) {
        for (int k = 0; k < 3; ++k) n[k] = component((k + 1) % 3, (k + 2) % 3);
    };
    across([&](int i, int j) { return difference_of_products(e1[i], e2[j], e1[j], e2[i]); });
    if (max_component(abs(n)) == 0) across([&](int i, int j) { return exact_turn(t.a, t.b, t.c, i, j); });
    return unit(n);
}
/// The ray in the space of an instance.
template <class I, int D>
Ray<double, D> inside(const PlacedIndex<I>& placed, const Ray<double, D>& ray) {
    const auto& back = placed.transform().back();
    return {back.point(ray.origin), back.vector(ray.direction)};
}

template <class P, int D, class T>
Vec<double, D> normal_on(const P& set, const Ray<double, D>& ray, const Hit<T>& hit) {
    using V = Vec<double, D>;
    if constexpr (Instanced<P>) {
        const auto& placed = set[hit.instance];
        const V own = normal_on(placed.index().primitives(), inside(placed, ray), hit);
        V there;  // normals transform by the inverse transposed
        for (int k = 0; k < D; ++k)
            for (int j = 0; j < D; ++j)
                there[j] += product(placed.transform().back().linear[static_cast<std::size_t>(k)][j], own[k]);
        return unit(there);
    } else if constexpr (OfTriangles<P>) {
        const auto t = set.triangle(hit.element);
        return unit_normal({V(t.a), V(t.b), V(t.c)});
    } else if constexpr (OfSegments<P>) {
        const auto s = set.segment(hit.element);
        const V along = V(s.b) - V(s.a);
        return unit(V(-along[1], along[0]));
    } else {
        static_assert(OfSpheres<P>, "the normal of a type of your own is for you to say");
        const auto s = set.sphere(hit.element);
        const Sphere<double, D> ball{V(s.center), static_cast<double>(s.radius)};
        double t = static_cast<double>(hit.t);  // rounded in proportion to the distance: intersected again
        if (const auto both = meet_line(ray.origin, ray.direction, ball))
            t = std::abs(both->entry - t) < std::abs(both->exit - t) ? both->entry : both->exit;
        const V outward = ray.at(t) - ball.center;
        return unit(max_component(abs(outward)) > 0 ? outward : -ray.direction);  // a ball may be a point
    }
}

template <class P, int D, class T>
Vec<double, D> position_on(const P& set, const Ray<double, D>& ray, const Hit<T>& hit) {
    using V = Vec<double, D>;
    const double u = static_cast<double>(hit.u), v = static_cast<double>(hit.v);
    if constexpr (Instanced<P>) {
        const auto& placed = set[hit.instance];
        return placed.transform().there().point(
            position_on(placed.index().primitives(), inside(placed, ray), hit));
    } else if constexpr (OfTriangles<P>) {
        const auto t = set.triangle(hit.element);
        const V a(t.a);
        return a + (V(t.b) - a) * u + (V(t.c) - a) * v;
    } else if constexpr (OfSegments<P>) {
        const auto s = set.segment(hit.element);
        const V a(s.a);
        return a + (V(s.b) - a) * u;
    } else if constexpr (OfSpheres<P>) {
        const auto ball = set.sphere(hit.element);
        return V(ball.center) + normal_on(set, ray, hit) * static_cast<double>(ball.radius);
    } else {
        return ray.at(static_cast<double>(hit.t));
    }
}

/// The primitives of an index, or the view of a set.
template <class Of>
auto primitives_of(const Of& of) {
    if constexpr (requires { of.primitives(); })
        return of.primitives();
    else
        return view_of(of);
}
template <class Of>
using PrimitivesOf = decltype(primitives_of(std::declval<const Of&>()));
template <class T, int D>
Ray<double, D> line_of(const Ray<T, D>& ray) {
    return {Vec<double, D>(ray.origin), Vec<double, D>(ray.direction)};
}

}  // namespace detail

/// The hit point of a ray. `of` is the index that was queried, or its primitives. On triangles and segments
/// the point comes from u and v, and errs by some roundings of the primitive's coordinates, however far the
/// ray came. On a sphere the ray is intersected again in double, and the point is on the surface to some
/// roundings of the coordinates. On primitives of your own type it is ray.at(t), which errs by some roundings
/// of the distance travelled. O(1).
template <class Of, class T, int D>
Vec<T, D> position(const Of& of, const Ray<T, D>& ray, const Hit<T>& hit) {
    return Vec<T, D>(detail::position_on(detail::primitives_of(of), detail::line_of(ray), hit));
}
/// The unit normal at a hit. On a triangle it points to the side from which the corners go counterclockwise,
/// on a sphere outward, on a segment to the left of the way from a to b. An instance transforms it with the
/// surface, and a mirror does not flip it. O(1).
template <class Of, class T, int D>
Vec<T, D> normal(const Of& of, const Ray<T, D>& ray, const Hit<T>& hit) {
    return Vec<T, D>(detail::normal_on(detail::primitives_of(of), detail::line_of(ray), hit));
}
/// The position and the normal on triangles and segments, where the ray is not needed.
template <class Of, class T>
requires detail::has_coordinates<detail::PrimitivesOf<Of>>
auto position(const Of& of, const Hit<T>& hit) {
    return position(of, Ray<T, Of::dimension>(), hit);
}
template <class Of, class T>
requires detail::has_coordinates<detail::PrimitivesOf<Of>>
auto normal(const Of& of, const Hit<T>& hit) {
    return normal(of, Ray<T, Of::dimension>(), hit);
}

}  // namespace hedgerow
