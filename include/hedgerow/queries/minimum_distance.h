/// The least distance between the primitives of two sets, and where it is.
#pragma once

#include <hedgerow/geometry/triangle_distance.h>
#include <hedgerow/queries/crossings.h>
#include <hedgerow/queries/point_query.h>

namespace hedgerow {

/// The closest points of two sets, their squared distance, and the positions of the primitives that they are
/// on. Equal distances go to the lowest (element_a, element_b).
template <std::floating_point T, int D>
struct Apart {
    T distance2 = std::numeric_limits<T>::infinity();
    PrimitiveId element_a = no_primitive, element_b = no_primitive;
    Vec<T, D> point_a, point_b;

    /// False where nothing was found; the distance is infinite then.
    explicit operator bool() const { return element_a != no_primitive; }
    friend bool operator==(const Apart&, const Apart&) = default;
};

/// The closest points of two primitives: of triangles, or of a point and any primitive that has a closest
/// point.
template <TriangleSet A, TriangleSet B>
auto gap_between(const A& a, PrimitiveId i, const B& b, PrimitiveId j) {
    return closest_points(a.triangle(i), b.triangle(j));
}
template <PointSet A, HasClosestPoint B>
auto gap_between(const A& a, PrimitiveId i, const B& b, PrimitiveId j) {
    using V = Vec<typename A::Scalar, A::dimension>;
    const V p = a.point(i);
    const auto foot = foot_of(p, b.closest_point(j, p));
    return Gap<typename A::Scalar, A::dimension>{foot.distance2, p, foot.point};
}
template <HasClosestPoint A, PointSet B>
requires(!PointSet<A>) auto gap_between(const A& a, PrimitiveId i, const B& b, PrimitiveId j) {
    const auto gap = gap_between(b, j, a, i);
    return decltype(gap){gap.distance2, gap.b, gap.a};
}

namespace detail {
/// Whether two triangles are surely farther apart than the root of `limit`, by how far they are apart along a
/// direction. The error allowed for is some 30 roundings of the largest product, more than distances err by.
template <class T>
bool surely_farther(const Triangle<T, 3>& a, const Triangle<T, 3>& b, const Vec3d& from, const Vec3d& along,
                    double limit) {
    double last_of_a = -std::numeric_limits<double>::infinity(), first_of_b = -last_of_a, reach = 0;
    for (int i = 0; i < 3; ++i) {
        const Vec3d x = Vec3d(corner(a, i)) - from, y = Vec3d(corner(b, i)) - from;
        last_of_a = std::max(last_of_a, dot(x, along));
        first_of_b = std::min(first_of_b, dot(y, along));
        reach = std::max({reach, max_component(abs(x)), max_component(abs(y))});
    }
    const double error = product(0x1p-48 * reach, max_component(abs(along)) * 3);
    const double gap = first_of_b - last_of_a - error;
    return gap > 0 && product(gap, gap) > product(limit, length2(along)) * (1 + 0x1p-48);
}
}  // namespace detail

/// Finds the closest pair within the limits.
template <class A, class B>
class MinimumDistance {
public:
    using Scalar = typename A::Scalar;
    static constexpr int dimension = A::dimension;
    using BoxType = Box<Scalar, dimension>;
    using Boxed = BoxedLeaf<Scalar, dimension>;
    static constexpr Order order = Order::nearest;

    MinimumDistance(const A& a, const B& b, const NearLimits<Scalar>& limits)
        : a_(a), b_(b), limits_(limits) {}

    static Scalar bound(const BoxType& a, const BoxType& b) { return distance2(a, b); }
    bool done() const { return limits_.nothing(); }
    Scalar limit() const {
        return limit_of_boxes(best_ ? limits_.after(best_.distance2) : limits_.distance2);
    }
    Flow offer(const Boxed& a, const Boxed& b) {
        for (std::uint32_t i = a.items.first; i < a.items.first + a.items.count; ++i) {
            const PrimitiveId of_a = a.items.ids[i];
            const BoxType box = a_.bounds(of_a);
            if (!(bound(box, b.box) <= limit())) continue;
            for (std::uint32_t j = b.items.first; j < b.items.first + b.items.count; ++j) {
                const PrimitiveId of_b = b.items.ids[j];
                if (bound(box, b_.bounds(of_b)) <= limit()) offer(of_a, of_b);
            }
        }
        return Flow::go_on;
    }
    const Apart<Scalar, dimension>& answer() const { return best_; }

private:
    void offer(PrimitiveId i, PrimitiveId j) {
        const bool lower = i != best_.element_a ? i < best_.element_a : j < best_.element_b;
        if (best_.distance2 == 0 && !lower) return;
        if constexpr (TriangleSet<A> && TriangleSet<B>)
            if (best_ && surely_farther(a_.triangle(i), b_.triangle(j))) return;
        const auto gap = gap_between(a_, i, b_, j);
        if (!(gap.distance2 <= limits_.distance2)) return;
        if (gap.distance2 < best_.distance2 || (gap.distance2 == best_.distance2 && lower))
            best_ = {gap.distance2, i, j, gap.a, gap.b};
    }

    /// Whether two triangles are plainly farther apart than the closest so far: by the direction between its
    /// points, which is about that of any pair as close; or, if it is at distance 0, since they do not meet.
    bool surely_farther(const Triangle<Scalar, 3>& a, const Triangle<Scalar, 3>& b) const {
        if (best_.distance2 == 0)
            return !triangles_meet(Triangle<double, 3>{Vec3d(a.a), Vec3d(a.b), Vec3d(a.c)},
                                   Triangle<double, 3>{Vec3d(b.a), Vec3d(b.b), Vec3d(b.c)});
        const Vec3d from(best_.point_a), along = Vec3d(best_.point_b) - from;
        return detail::surely_farther(a, b, from, along, static_cast<double>(limit()));
    }

    const A& a_;
    const B& b_;
    NearLimits<Scalar> limits_;
    Apart<Scalar, dimension> best_;
};

}  // namespace hedgerow
