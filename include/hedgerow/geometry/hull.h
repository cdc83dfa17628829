/// Convex hulls, given by the half-spaces of their facets.
#pragma once

#include <span>
#include <vector>

#include <hedgerow/geometry/half_space.h>

namespace hedgerow {

/// A convex hull, or what any planes bound: the intersection of half-spaces, which are stored elsewhere. As a
/// bounding volume its normals have length 1 up to their rounding to T; as a region they may have any length.
template <std::floating_point T, int D = 3>
struct Hull {
    using Scalar = T;
    static constexpr int dimension = D;

    std::span<const HalfSpace<T, D>> faces;

    static constexpr int orthonormal = 0;
    int slab_count() const { return static_cast<int>(faces.size()); }
    Slab<D> slab(int i) const { return faces[static_cast<std::size_t>(i)].slab(0); }
};

/// The outward unit normals of the facets of the points' convex hull, by Qhull (Barber, Dobkin and Huhdanpaa
/// 1996; O(n log n)). Empty if the hull has no volume, or so little that rounding decides; the caller must
/// then do without. Throws InputError if the library was built without Qhull.
std::vector<Vec3d> hull_normals(std::span<const Vec3d> points);

}  // namespace hedgerow
