/// Spheres (circles in 2D).
#pragma once

#include <vector>

#include <hedgerow/base/strided.h>
#include <hedgerow/geometry/shapes.h>
#include <hedgerow/primitives/concepts.h>

namespace hedgerow {

/// A view of spheres in the caller's array. Nothing is copied.
template <std::floating_point T, int D>
class SphereSetView {
public:
    using Scalar = T;
    static constexpr int dimension = D;

    SphereSetView() = default;
    explicit SphereSetView(Strided<Sphere<T, D>> spheres) : spheres_(spheres) {}

    std::size_t size() const { return spheres_.size(); }
    Sphere<T, D> sphere(std::size_t i) const { return spheres_[i]; }
    Box<T, D> bounds(std::size_t i) const { return spheres_[i].bounds(); }
    Foot<T, D> closest_point(std::size_t i, const Vec<T, D>& p) const {
        return hedgerow::closest_point(p, spheres_[i]);
    }
    Foot<T, D> farthest_point(std::size_t i, const Vec<T, D>& p) const {
        return hedgerow::farthest_point(p, spheres_[i]);
    }
    /// Spheres are solid here.
    template <Region R>
    bool overlaps(std::size_t i, const R& region) const {
        return overlap(spheres_[i], region);
    }
    template <Region R>
    bool lies_within(std::size_t i, const R& region) const {
        return lies_in(spheres_[i], region);
    }
    /// The ray's first crossing of the surface within its interval: the entry, or the exit if the entry lies
    /// before the interval.
    std::optional<Meeting<T>> meet(std::size_t i, const Ray<T, D>& ray) const {
        const auto both = meet_line(ray.origin, ray.direction, spheres_[i]);
        if (!both) return std::nullopt;
        for (const T t : {both->entry, both->exit})
            if (ray.t_min <= t && t <= ray.t_max) return Meeting<T>{t, T(0), T(0)};
        return std::nullopt;
    }

private:
    Strided<Sphere<T, D>> spheres_;
};

/// Spheres in an array that the set owns. The id of a sphere is its position. Radii are >= 0.
template <std::floating_point T, int D>
struct SphereSet {
    using Scalar = T;
    static constexpr int dimension = D;

    std::vector<Sphere<T, D>> spheres;

    std::size_t size() const { return spheres.size(); }
    SphereSetView<T, D> view() const { return SphereSetView<T, D>(std::span(spheres)); }
};

}  // namespace hedgerow
