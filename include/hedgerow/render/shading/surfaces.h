/// The surface at a hit: its normal, and where rays leave it.
#pragma once

#include <hedgerow/geometry/offset.h>
#include <hedgerow/surface.h>

namespace hedgerow {

/// The surfaces of a set, or of an index's primitives, behind one type. Const use is thread-safe.
template <std::floating_point T>
class Surfaces {
public:
    virtual ~Surfaces() = default;
    /// The box of all surfaces, in O(n).
    virtual Box<T, 3> bounds() const = 0;
    /// The normal at a hit of a ray, of length 1, on the side that the ray comes from. O(1).
    virtual Vec<T, 3> normal(const Ray<T, 3>& ray, const Hit<T>& hit) const = 0;
    /// The box of the primitive that was hit, or of its instance. O(1).
    virtual Box<T, 3> bounds(const Hit<T>& hit) const = 0;
    /// The origin of rays that leave a hit on the side of this normal (geometry/offset.h). O(1).
    Vec<T, 3> origin(const Ray<T, 3>& ray, const Hit<T>& hit, const Vec<T, 3>& normal) const {
        return offset_origin(ray, hit.t, bounds(hit), normal, normal);
    }
};

/// Surfaces of a set of primitives, or of instances. Borrows a set, keeps a view.
template <class P>
class SurfacesOf final : public Surfaces<typename P::Scalar> {
public:
    using T = typename P::Scalar;

    explicit SurfacesOf(const P& primitives) : primitives_(view_of(primitives)) {}
    Box<T, 3> bounds() const override {
        Box<T, 3> box;
        for (std::size_t i = 0; i < primitives_.size(); ++i) box.expand(primitives_.bounds(i));
        return box;
    }
    Vec<T, 3> normal(const Ray<T, 3>& ray, const Hit<T>& hit) const override {
        const Vec<T, 3> n = hedgerow::normal(primitives_, ray, hit);
        return dot(n, ray.direction) > 0 ? -n : n;
    }
    Box<T, 3> bounds(const Hit<T>& hit) const override {
        if constexpr (Instanced<ViewOf<P>>)
            return primitives_.bounds(hit.instance);
        else
            return primitives_.bounds(hit.element);
    }

private:
    ViewOf<P> primitives_;
};

}  // namespace hedgerow
