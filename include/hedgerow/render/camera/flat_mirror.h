/// Flat mirrors: what an eye sees in one is what the eye's image sees through it.
#pragma once

#include <algorithm>

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/shapes.h>

namespace hedgerow {

/// A mirror without bounds: the plane of all p with dot(normal, p) = height. The normal has length 1.
struct FlatMirror {
    Vec3d normal;
    double height = 0;
    /// The largest coordinate of the triangle that it was made from. Rays leave the mirror by 2⁻¹⁷ of it, and
    /// of the eye's, so that they do not meet that triangle: more than a hit on it errs by (probes/ray.h).
    double reach = 0;

    /// The mirror that a triangle lies in. Throws InputError for a triangle without area.
    template <class T>
    static FlatMirror through(const Triangle<T, 3>& t) {
        const Vec3d a(t.a), b(t.b), c(t.c);
        const Vec3d across = cross(b - a, c - a);
        if (!(length2(across) > 0)) throw InputError("a triangle without area is no mirror");
        const Vec3d normal = normalized(across);
        return {normal, dot(normal, a), max_component(max(abs(a), max(abs(b), abs(c))))};
    }

    double above(const Vec3d& p) const { return dot(normal, p) - height; }
    Vec3d image_of_point(const Vec3d& p) const { return p - normal * (2 * above(p)); }
    Vec3d image_of_direction(const Vec3d& d) const { return d - normal * (2 * dot(normal, d)); }
};

}  // namespace hedgerow
