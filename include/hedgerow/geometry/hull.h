/// Convex hulls, given by the half-spaces of their facets.
#pragma once

#include <span>
#include <vector>

#include <hedgerow/geometry/slab.h>

namespace hedgerow {

/// The points x with normal·x <= offset.
template <std::floating_point T>
struct HalfSpace {
    Vec<T, 3> normal;
    T offset;
};

/// A convex hull: the intersection of half-spaces, which are stored elsewhere. Their normals have length 1 up
/// to their rounding to T.
template <std::floating_point T>
struct Hull {
    using Scalar = T;
    static constexpr int dimension = 3;

    std::span<const HalfSpace<T>> faces;

    static constexpr int orthonormal = 0;
    int slab_count() const { return static_cast<int>(faces.size()); }
    Slab<3> slab(int i) const {
        const auto& f = faces[static_cast<std::size_t>(i)];
        return {Vec3d(f.normal), -std::numeric_limits<double>::infinity(), static_cast<double>(f.offset)};
    }
};

/// The outward unit normals of the facets of the points' convex hull, by Qhull (Barber, Dobkin and Huhdanpaa
/// 1996; O(n log n)). Empty if the hull has no volume, or so little that rounding decides; the caller must
/// then do without. Throws InputError if the library was built without Qhull.
std::vector<Vec3d> hull_normals(std::span<const Vec3d> points);

}  // namespace hedgerow
