/// Regions: closed sets of points that a query is asked about. A box, a ball (geometry/ball.h), what lies
/// between planes (geometry/slab_region.h) and a cone (geometry/cone.h) are regions; so is any type with the
/// functions of the concept `Region`.
#pragma once

#include <hedgerow/geometry/overlap.h>

namespace hedgerow {

/// How a box lies to a region: apart from it, across its boundary, or inside of it.
enum class Containment { outside, across, inside };

/// The least and the greatest height of a region along a normal.
struct Extent {
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
};

/// What the test of a primitive against a region may err by, as a share of the largest coordinate of the
/// scene: at most this.
inline constexpr double scene_margin = 0x1p-34;

/// A region R: closed and convex. The functions are found by the arguments' namespace.
/// - `is_empty` is true if the region has NaN, or is known to have no points. Queries of it find nothing, and
///   call nothing else.
/// - `containment` tells how a box lies to the region. It may say across of a box that is outside or inside,
///   but never outside of a box with a primitive that `overlap` finds, nor inside of one with a primitive
///   that `overlap` or `lies_in` does not.
/// - `bounds_in` returns a box around the part in a box of the region, widened by a margin. It is no larger
///   than that box.
/// - `extent` returns numbers that normal·x is never beyond for any point x of the region.
/// - `lies_in` tells whether a shape lies in the region wholly, and `overlap` whether it has a point in it.
///   Both are needed for the primitives of the sets that are asked: points (`Vec`, which need `lies_in`
///   alone), Triangle, Segment, Sphere (a solid ball). What lies in a region overlaps it.
template <class R>
concept Region = std::is_trivially_copyable_v<R> &&
    requires(const R& region, const Box<typename R::Scalar, R::dimension>& box,
             const Box<double, R::dimension>& wide, const Vec<double, R::dimension>& normal,
             const Vec<typename R::Scalar, R::dimension>& point) {
    { is_empty(region) } -> std::same_as<bool>;
    { containment(region, box) } -> std::same_as<Containment>;
    { containment(region, wide) } -> std::same_as<Containment>;
    { bounds_in(region, wide, 0.0) } -> std::same_as<Box<double, R::dimension>>;
    { extent(region, normal) } -> std::same_as<Extent>;
    { lies_in(point, region) } -> std::same_as<bool>;
};

// Shapes that are the hull of their corners lie in a region if their corners do.

template <class T, int D, Region R>
bool lies_in(const Segment<T, D>& s, const R& region) {
    return lies_in(s.a, region) && lies_in(s.b, region);
}
template <class T, int D, Region R>
bool lies_in(const Triangle<T, D>& t, const R& region) {
    return lies_in(t.a, region) && lies_in(t.b, region) && lies_in(t.c, region);
}

namespace detail {
template <class T, int D>
Box<double, D> in_double(const Box<T, D>& b) {
    return {Vec<double, D>(b.low), Vec<double, D>(b.high)};
}
}  // namespace detail

// A box as a region. All answers are exact (overlap.h).

template <class T, int D>
bool is_empty(const Box<T, D>& region) {
    return region.empty();
}
template <class T, class U, int D>
Containment containment(const Box<T, D>& region, const Box<U, D>& box) {
    bool inside = true;
    for (int k = 0; k < D; ++k) {
        if (!(region.low[k] <= box.high[k] && box.low[k] <= region.high[k])) return Containment::outside;
        inside = inside && region.low[k] <= box.low[k] && box.high[k] <= region.high[k];
    }
    return inside ? Containment::inside : Containment::across;
}
template <class T, int D>
Box<double, D> bounds_in(const Box<T, D>& region, const Box<double, D>& box, double) {
    return intersection(detail::in_double(region), box);
}
/// The heights of the box's extreme corners, rounded outward. NaN where an unbounded side meets a 0 of the
/// normal.
template <class T, int D>
Extent extent(const Box<T, D>& region, const Vec<double, D>& normal) {
    double low = 0, high = 0, size = 0;
    for (int k = 0; k < D; ++k) {
        const double a = product(normal[k], static_cast<double>(region.low[k]));
        const double b = product(normal[k], static_cast<double>(region.high[k]));
        low += std::min(a, b), high += std::max(a, b);
        size += std::max(std::abs(a), std::abs(b));
    }
    const double error = product(8 * unit_roundoff<double>, size) + detail::underflow;
    return {low - error, high + error};
}
template <class T, int D>
bool lies_in(const Vec<T, D>& p, const Box<T, D>& region) {
    return region.contains(p);
}
/// Exact, since rounding a ball's bounds outward passes no number of T.
template <class T, int D>
bool lies_in(const Sphere<T, D>& s, const Box<T, D>& region) {
    return region.contains(s.bounds());
}

}  // namespace hedgerow
