/// The answer of a ray query, and filters that refuse hits.
#pragma once

#include <hedgerow/walks/query.h>

namespace hedgerow {

/// A hit: t in units of the ray's direction, the surface's own coordinates u and v (see Meeting), and the
/// primitive. `element` is the primitive's position in its set; `primitive` is its id, which differs where a
/// polygon of a file became several triangles. Among instances both belong to the index that `instance`
/// places, and `geometry` is the number that the instance was given; elsewhere `geometry` and `instance` are
/// 0.
template <std::floating_point T>
struct Hit {
    T t = std::numeric_limits<T>::infinity();
    T u = T(0), v = T(0);
    std::uint32_t primitive = none, geometry = 0, instance = 0, element = none;

    static constexpr std::uint32_t none = 0xFFFFFFFFu;
    /// False for the answer of a query that hit nothing; its t is infinite.
    explicit operator bool() const { return element != none; }
    friend bool operator==(const Hit&, const Hit&) = default;
};

/// The filter that keeps every hit, and costs nothing.
///
/// A filter decides whether a Hit counts. It is callable with the Hit, or with the number of the ray in its
/// batch and the Hit. A refused hit changes nothing. A filter is only called for hits that would count, in
/// any order, perhaps again for the same hit, and by several threads at once if the executor has them. So it
/// must be callable as const, and always return the same for the same hit. Its exceptions reach the caller of
/// the query; a batch has then written some of its answers. Among instances, a filter's member
/// `enters(mask)`, if it has one, decides which instances are queried at all.
struct KeepAll {
    template <class H>
    constexpr bool operator()(const H&) const {
        return true;
    }
};
/// Refuses one element (of one instance), such as the surface that the ray starts on.
struct Except {
    PrimitiveId element;
    std::uint32_t instance = 0;
    template <class H>
    bool operator()(const H& h) const {
        return h.element != element || h.instance != instance;
    }
};
/// Refuses triangles seen from behind (with a normal along the ray) and triangles seen edge-on.
template <class View>
struct CullBackFaces {
    View mesh;
    Vec<typename View::Scalar, 3> direction;
    template <class H>
    bool operator()(const H& h) const {
        return dot(Vec3d(mesh.normal(h.element)), Vec3d(direction)) < 0;
    }
};
template <class View, class T>
CullBackFaces(View, Vec<T, 3>) -> CullBackFaces<View>;

}  // namespace hedgerow
