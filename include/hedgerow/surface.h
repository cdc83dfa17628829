/// The position of a hit in the world, and the surface's normal there; and where on its primitive a closest
/// point is. Everything is computed in double and rounded once.
#pragma once

#include <variant>

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/closest_feature.h>
#include <hedgerow/geometry/entry.h>
#include <hedgerow/geometry/exact_sum.h>
#include <hedgerow/instances/instance_set.h>
#include <hedgerow/primitives/boundary.h>
#include <hedgerow/primitives/triangle_mesh.h>
#include <hedgerow/queries/hit.h>
#include <hedgerow/queries/point_query.h>

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
/// An index whose set is known when it is asked.
template <class P>
concept OfAnySet = requires(const P& index) {
    index.set().index();
};
/// Whether a hit's u and v give its position: true on triangles and segments, and on instances of these.
template <class P>
inline constexpr bool has_coordinates = OfTriangles<P> || OfSegments<P>;
template <Instanced P>
inline constexpr bool has_coordinates<P> =
    has_coordinates<typename std::remove_cvref_t<decltype(std::declval<const P&>()[0].index())>::Primitives>;

/// a / |a|, and 0 for 0. Divides by the largest component first, so squares fit.
template <int D>
Vec<double, D> unit(const Vec<double, D>& a) {
    const double most = max_component(abs(a));
    return most > 0 ? normalized(a / most) : a;
}
/// The unit normal of a triangle; 0 if it has no area, which no ray hits. On slivers, where the computed
/// cross product cancels to 0, the exact signs of its components are normalised instead.
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
    } else if constexpr (OfAnySet<P>) {
        return std::visit([&](const auto& known) { return normal_on(known, ray, hit); }, set.set());
    } else if constexpr (PointSet<P>) {
        throw InputError("points have no normal: no ray hits them");
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
    } else if constexpr (OfAnySet<P>) {
        return std::visit([&](const auto& known) { return position_on(known, ray, hit); }, set.set());
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
decltype(auto) primitives_of(const Of& of) {
    if constexpr (requires { of.primitives(); })
        return of.primitives();
    else
        return view_of(of);
}
template <class Of>
using PrimitivesOf = std::remove_cvref_t<decltype(primitives_of(std::declval<const Of&>()))>;
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

/// What a closest point lies on: the inside of its primitive, a side, or a corner.
enum class Feature : std::uint8_t { face, edge, vertex };
/// Where a closest point is on its triangle, or its segment in the plane. `number` is that of the corner, or
/// of the edge from that corner to the next; 0 for a face. The closest point is the sum of the corners by
/// their weights, which are 0 for corners that the feature lacks. `normal` is that of the primitive, of
/// length one, or zero where the primitive has no area (in the plane: no length). Neighbors share their edges
/// and vertices, so which of them is the closest primitive says nothing there.
template <std::floating_point T, int D>
struct FeatureOfNear {
    Feature feature = Feature::face;
    int number = 0;
    std::array<T, static_cast<std::size_t>(D)> weights{};
    Vec<T, D> normal;
};

namespace detail {
template <class P, class T, int D>
std::array<Vec<double, D>, static_cast<std::size_t>(D)> corners_of(const P& set, const Near<T, D>& near) {
    if constexpr (Instanced<P>) {
        const auto& placed = set[near.instance];
        auto corners = corners_of(placed.index().primitives(), near);
        for (auto& corner : corners) corner = placed.transform().there().point(corner);
        return corners;
    } else if constexpr (OfAnySet<P>) {
        return std::visit([&](const auto& known) { return corners_of(known, near); }, set.set());
    } else if constexpr (!FacetSet<P>) {
        throw InputError("features are those of triangles in space or segments in the plane");
    } else {
        const auto own = set.corners(near.element);
        std::array<Vec<double, D>, static_cast<std::size_t>(D)> corners;
        for (std::size_t i = 0; i < own.size(); ++i) corners[i] = Vec<double, D>(own[i]);
        return corners;
    }
}
/// The weights of a and b in the point of the line through them that is closest to p.
template <int D>
std::array<double, 2> weights_on_line(const Vec<double, D>& p, const Vec<double, D>& a,
                                      const Vec<double, D>& b) {
    const double scale = scale_to_one(std::max(max_component(abs(b - a)), max_component(abs(p - a))));
    const Vec<double, D> along = (b - a) * scale;
    const double t = std::clamp(dot((p - a) * scale, along) / length2(along), 0.0, 1.0);
    return {1 - t, t};
}
}  // namespace detail

/// Where on its primitive the closest point is that a question of `point` found. `of` is the index that was
/// asked, or its primitives: triangles in space, segments in the plane, or instances of these. The weights
/// err by some roundings of double for each of the triangle's coordinates, more where it is a sliver. O(1).
template <class Of, class T, int D>
FeatureOfNear<T, D> feature(const Of& of, const Vec<T, D>& point, const Near<T, D>& near) {
    using V = Vec<double, D>;
    const auto& primitives = detail::primitives_of(of);
    const auto corners = detail::corners_of(primitives, near);
    const V p(point);
    const int closest = closest_feature(p, corners).number;
    FeatureOfNear<T, D> found;
    Hit<T> hit;
    hit.element = near.element, hit.instance = near.instance;
    found.normal = Vec<T, D>(detail::normal_on(primitives, Ray<double, D>(), hit));
    std::array<double, static_cast<std::size_t>(D)> weights{};
    const auto on_edge = [&](std::size_t i) {
        const std::size_t next = (i + 1) % D;
        const auto ends = detail::weights_on_line(p, corners[i], corners[next]);
        weights[i] = ends[0], weights[next] = ends[1];
    };
    if (closest >= D) {
        found.feature = Feature::edge, found.number = closest - D;
        on_edge(static_cast<std::size_t>(found.number));
    } else if (closest >= 0) {
        found.feature = Feature::vertex, found.number = closest;
        weights[static_cast<std::size_t>(closest)] = 1;
    } else if constexpr (D == 2) {
        on_edge(0);
    } else {
        // Areas that the sides enclose with the foot of the perpendicular, over the triangle's.
        const double scale = detail::safe_scale<double>(corners[1] - corners[0], corners[2] - corners[0]);
        const auto area = [&](const V& x, std::size_t i, std::size_t j, const V& normal) {
            return dot(cross((corners[i] - x) * scale, (corners[j] - x) * scale), normal);
        };
        const V normal = detail::unit_normal({corners[0], corners[1], corners[2]});
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            weights[i] = std::max(area(p, (i + 1) % 3, (i + 2) % 3, normal), 0.0);
            sum += weights[i];
        }
        for (double& weight : weights) weight /= sum;
    }
    for (std::size_t i = 0; i < weights.size(); ++i) found.weights[i] = static_cast<T>(weights[i]);
    return found;
}

}  // namespace hedgerow
