/// What is asked of a Hausdorff distance, and the answer: an interval and its witnesses.
#pragma once

#include <concepts>
#include <cstddef>

#include <hedgerow/parallel/executor.h>
#include <hedgerow/primitives/concepts.h>
#include <hedgerow/queries/crossings.h>

namespace hedgerow {

/// When to stop: the interval may be as wide as the larger of `absolute`, a length, and `relative` times the
/// lower bound. It is never narrowed below the rounding of coordinates (see Hausdorff).
struct HausdorffOptions {
    double absolute = 0;
    double relative = 1e-3;
    /// Parts of triangles that may wait to be divided, beyond the triangles themselves; they take up to 160
    /// bytes each. If there would be more, the interval is returned as wide as it is then.
    std::size_t most_parts = std::size_t(1) << 22;
    Threads threads = {};
};

/// The distance lies in [lower, upper]. The witnesses are a point of one set that is at least `lower` away
/// from all of the other, and the other's point closest to it, with the positions of their primitives.
/// `point_a` is on A always; `from_b` says that it is the point on B that is far away.
///
/// Both bounds allow for all roundings: those of a distance, and those of points where a triangle was
/// divided, which are rounded to T as queries are. So the interval can be as wide as 2⁻¹⁹ of the distance
/// plus 2⁻²⁰ of the largest coordinate (in double 2⁻⁴⁵ and 2⁻⁴²), whatever tolerance is asked for.
template <std::floating_point T, int D>
struct Hausdorff {
    T lower = 0, upper = 0;
    PrimitiveId element_a = no_primitive, element_b = no_primitive;
    Vec<T, D> point_a = {}, point_b = {};
    bool from_b = false;

    /// False where there are no witnesses: a set is empty.
    explicit operator bool() const { return element_a != no_primitive; }
    friend bool operator==(const Hausdorff&, const Hausdorff&) = default;
};

/// Sets from which there is a directed distance to a set B: points to whatever has closest points, and
/// triangles to triangles and points.
template <class A, class B>
concept FarFrom = std::same_as<typename A::Scalar, typename B::Scalar> && A::dimension == B::dimension &&
                  ((PointSet<A> && HasClosestPoint<B>) ||
                   (TriangleSet<A> && (TriangleSet<B> || PointSet<B>)));

}  // namespace hedgerow
