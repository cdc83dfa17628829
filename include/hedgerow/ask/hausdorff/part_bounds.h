/// Upper bounds of parts of triangles, by the elements of a set B that are near.
#pragma once

#include <algorithm>

#include <hedgerow/ask/hausdorff/distance_error.h>
#include <hedgerow/ask/hausdorff/interval.h>
#include <hedgerow/ask/hausdorff/triangle_part.h>
#include <hedgerow/engine/near_elements.h>

namespace hedgerow::detail {

/// What bounds are for: one of `wanted` or less is low enough, and `slack` is how far from the best place a
/// cut may be. Lengths are scaled as coordinates are.
struct BoundAim {
    double wanted, slack;
    DistanceMargin margin;
};
/// A bound, and where to cut what it does not suffice for: at the part `at` of the edge that begins at corner
/// `edge`, or anywhere if that is 3.
struct BoundByElements {
    double bound, at;
    std::uint8_t edge;
};
/// A bound of a triangle's distance by elements alone. The triangle is cut for that, in places where two
/// elements are equally near, until each part has an element that is near enough or there were too many cuts.
BoundByElements bound_by_elements(const Vec3d (&corner)[3], NearElements& near, const BoundAim& aim);

/// Lowers bounds of parts, by the elements of `set` that they remember. `lower` is a lower bound of the
/// distance, and a bound of `wanted` or less is low enough.
template <class B>
class PartBounds {
public:
    using T = typename B::Scalar;

    /// `scale` is a power of two that brings coordinates to about 1.
    PartBounds(const B& set, const DistanceError<T>& error, double scale, double lower, double wanted)
        : set_(set),
          scale_(scale),
          wanted_(wanted),
          aim_{wanted * scale, (wanted - lower) * scale / 4, {error.relative, error.absolute * scale}} {
        near_.points = PointSet<B>;
    }

    /// Lowers the bound of a part, until it is low enough or nothing is left to try, and chooses where to cut
    /// the part next.
    void bound(TrianglePart& part) {
        part.bound_by_corners(wanted_);
        part.at = 0.5;
        if (part.bound <= wanted_) return;
        near_.count = 0;
        for (const PrimitiveId element : part.nearest) add(element);
        for (const PrimitiveId element : part.others) add(element);
        const Vec3d corner[3] = {part.corner[0] * scale_, part.corner[1] * scale_, part.corner[2] * scale_};
        const auto found = bound_by_elements(corner, near_, aim_);
        part.bound = std::min(part.bound, found.bound / scale_);
        if (part.age != 2 && found.edge < 3) part.edge = found.edge, part.at = found.at;
    }

private:
    void add(PrimitiveId element) {
        if (element == no_primitive) return;
        for (int i = 0; i < near_.count; ++i)
            if (tried_[i] == element) return;
        tried_[near_.count] = element;
        near_.set(near_.count++, scaled(element));
    }
    Triangle<double, 3> scaled(PrimitiveId element) const {
        if constexpr (PointSet<B>) {
            const Vec3d p = Vec3d(set_.point(element)) * scale_;
            return {p, p, p};
        } else {
            const auto t = set_.triangle(element);
            return {Vec3d(t.a) * scale_, Vec3d(t.b) * scale_, Vec3d(t.c) * scale_};
        }
    }

    const B& set_;
    double scale_, wanted_;
    BoundAim aim_;
    NearElements near_ = {};
    PrimitiveId tried_[NearElements::most];
};

}  // namespace hedgerow::detail
