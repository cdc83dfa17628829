/// The corners of a set's primitives.
#pragma once

#include <hedgerow/geometry/triangle_distance.h>
#include <hedgerow/primitives/concepts.h>

namespace hedgerow::detail {

/// The corners of A's primitives: a mesh's vertices once each, though several triangles share them.
template <class A>
struct Corners {
    const A& set;

    static constexpr bool shared = requires(const A& a) {
        a.vertex(a.vertex_count());
        a.indices(a.size())[0];
    };
    static constexpr std::size_t per_element = PointSet<A> ? 1 : 3;
    std::size_t size() const {
        if constexpr (shared)
            return set.vertex_count();
        else
            return per_element * set.size();
    }
    /// The number of an element's corner k.
    std::size_t number(std::size_t element, std::size_t k) const {
        if constexpr (shared)
            return set.indices(element)[k];
        else
            return per_element * element + k;
    }
    Vec<typename A::Scalar, A::dimension> operator[](std::size_t i) const {
        if constexpr (shared)
            return set.vertex(i);
        else if constexpr (PointSet<A>)
            return set.point(i);
        else
            return corner(set.triangle(i / 3), static_cast<int>(i % 3));
    }
};

}  // namespace hedgerow::detail
