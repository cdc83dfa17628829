/// A region of any shape behind one type, so that a walk is compiled once for all shapes.
#pragma once

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/region.h>

namespace hedgerow {

namespace detail {
template <std::floating_point T, int D>
using FacetOf = std::conditional_t<D == 3, Triangle<T, 3>, Segment<T, 2>>;

/// The functions of a region's type, which take the region by its address.
template <std::floating_point T, int D>
struct RegionFunctions {
    template <class Shape>
    using Test = bool (*)(const void*, const Shape&);
    using Facet = FacetOf<T, D>;

    Containment (*containment)(const void*, const Box<T, D>&);
    Containment (*containment_wide)(const void*, const Box<double, D>&);
    Box<double, D> (*bounds_in)(const void*, const Box<double, D>&, double);
    Extent (*extent)(const void*, const Vec<double, D>&);
    bool (*is_empty)(const void*);
    Test<Vec<T, D>> point_lies_in;
    Test<Sphere<T, D>> ball_lies_in, ball_overlaps;
    Test<Facet> facet_lies_in, facet_overlaps;
};

[[noreturn]] inline void refuse_shape() {
    throw InputError(
        "the region does not tell whether it overlaps primitives of this kind: add `overlap` and `lies_in` "
        "for them (geometry/region.h)");
}
template <Region R, class Shape>
bool lies_in_region(const void* region, const Shape& shape) {
    if constexpr (requires(const R& r) { lies_in(shape, r); })
        return lies_in(shape, *static_cast<const R*>(region));
    else
        refuse_shape();
}
template <Region R, class Shape>
bool overlaps_region(const void* region, const Shape& shape) {
    if constexpr (requires(const R& r) { overlap(shape, r); })
        return overlap(shape, *static_cast<const R*>(region));
    else
        refuse_shape();
}

template <Region R>
inline constexpr RegionFunctions<typename R::Scalar, R::dimension> functions_of_region = {
    [](const void* r, const Box<typename R::Scalar, R::dimension>& box) {
        return containment(*static_cast<const R*>(r), box);
    },
    [](const void* r, const Box<double, R::dimension>& box) {
        return containment(*static_cast<const R*>(r), box);
    },
    [](const void* r, const Box<double, R::dimension>& box, double margin) {
        return bounds_in(*static_cast<const R*>(r), box, margin);
    },
    [](const void* r, const Vec<double, R::dimension>& normal) {
        return extent(*static_cast<const R*>(r), normal);
    },
    [](const void* r) { return is_empty(*static_cast<const R*>(r)); },
    lies_in_region<R, Vec<typename R::Scalar, R::dimension>>,
    lies_in_region<R, Sphere<typename R::Scalar, R::dimension>>,
    overlaps_region<R, Sphere<typename R::Scalar, R::dimension>>,
    lies_in_region<R, FacetOf<typename R::Scalar, R::dimension>>,
    overlaps_region<R, FacetOf<typename R::Scalar, R::dimension>>};
}  // namespace detail

/// A reference to a region, which must outlive it. It is a region itself, of points, solid balls, triangles
/// in space and segments in the plane, and costs a call through a pointer wherever a region is asked. Throws
/// InputError where it is asked of primitives that its region has no test for.
template <std::floating_point T, int D>
class AnyRegion {
public:
    using Scalar = T;
    static constexpr int dimension = D;

    template <Region R>
    requires(!std::same_as<R, AnyRegion> && std::same_as<typename R::Scalar, T> &&
             R::dimension == D) explicit AnyRegion(const R& region)
        : region_(&region), functions_(&detail::functions_of_region<R>) {}

    friend bool is_empty(const AnyRegion& r) { return r.functions_->is_empty(r.region_); }
    friend Containment containment(const AnyRegion& r, const Box<T, D>& box) {
        return r.functions_->containment(r.region_, box);
    }
    template <std::same_as<double> U>
    requires(!std::same_as<U, T>) friend Containment containment(const AnyRegion& r, const Box<U, D>& box) {
        return r.functions_->containment_wide(r.region_, box);
    }
    friend Box<double, D> bounds_in(const AnyRegion& r, const Box<double, D>& box, double margin) {
        return r.functions_->bounds_in(r.region_, box, margin);
    }
    friend Extent extent(const AnyRegion& r, const Vec<double, D>& normal) {
        return r.functions_->extent(r.region_, normal);
    }
    friend bool lies_in(const Vec<T, D>& p, const AnyRegion& r) {
        return r.functions_->point_lies_in(r.region_, p);
    }
    friend bool lies_in(const Sphere<T, D>& s, const AnyRegion& r) {
        return r.functions_->ball_lies_in(r.region_, s);
    }
    friend bool overlap(const Sphere<T, D>& s, const AnyRegion& r) {
        return r.functions_->ball_overlaps(r.region_, s);
    }
    friend bool lies_in(const detail::FacetOf<T, D>& s, const AnyRegion& r) {
        return r.functions_->facet_lies_in(r.region_, s);
    }
    friend bool overlap(const detail::FacetOf<T, D>& s, const AnyRegion& r) {
        return r.functions_->facet_overlaps(r.region_, s);
    }

private:
    const void* region_;
    const detail::RegionFunctions<T, D>* functions_;
};

}  // namespace hedgerow
