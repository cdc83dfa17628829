/// What a ray query answers with, and the filters that refuse candidates.
#pragma once

#include <hedgerow/primitives/strided.h>
#include <hedgerow/queries/concepts.h>

namespace hedgerow {

/// A hit: t in units of the ray's direction, the surface's own coordinates u and v (see Meeting), and what
/// was hit. `element` is the position in the primitive set; `primitive` its id, which differs where a polygon
/// of a file became several triangles. Among instances both are of the index that `instance` places, and
/// `geometry` is the number that the instance was given; elsewhere it is 0.
template <std::floating_point T>
struct Hit {
    T t = std::numeric_limits<T>::infinity();
    T u = T(0), v = T(0);
    std::uint32_t primitive = none, geometry = 0, instance = 0, element = none;

    static constexpr std::uint32_t none = 0xFFFFFFFFu;
    /// False for what a batch writes where nothing was hit.
    explicit operator bool() const { return element != none; }
    friend bool operator==(const Hit&, const Hit&) = default;
};

/// A filter is anything that says of a Hit whether it counts: callable with the Hit, or with the number of
/// the ray in its batch and the Hit. A hit that is refused changes nothing. The filter is asked of hits that
/// would count, in any order, perhaps again of the same, and by several threads at once where the executor
/// has them; so it has to say the same of the same hit, and to be called as const. What it throws comes out
/// of the query; of a batch some answers are written then. Among instances it may also say, by a member
/// `enters(mask)`, which of them are looked into at all. This one keeps all, and costs nothing.
struct KeepAll {
    template <class H>
    constexpr bool operator()(const H&) const {
        return true;
    }
};
/// Refuses one element (of one instance): the surface that the ray starts on.
struct Except {
    PrimitiveId element;
    std::uint32_t instance = 0;
    template <class H>
    bool operator()(const H& h) const {
        return h.element != element || h.instance != instance;
    }
};
/// Refuses triangles seen from behind (their normal along the ray) and those seen edge-on.
template <class View>
struct CullBackFaces {
    View mesh;
    Vec<typename View::Scalar, 3> direction;
    template <class H>
    bool operator()(const H& h) const {
        return dot(Vec3d(mesh.normal(h.element)), Vec3d(direction)) < 0;
    }
};
/// Keeps elements of whose mask some bit is among the wanted ones.
struct Masked {
    Strided<std::uint32_t> masks;
    std::uint32_t wanted;
    template <class H>
    bool operator()(const H& h) const {
        return (masks[h.element] & wanted) != 0;
    }
};

/// Of instances enters those of whose mask some bit is among the wanted ones, and keeps what is hit there.
struct InMasks {
    std::uint32_t wanted;
    bool enters(std::uint32_t mask) const { return (mask & wanted) != 0; }
    template <class H>
    constexpr bool operator()(const H&) const {
        return true;
    }
};

}  // namespace hedgerow
