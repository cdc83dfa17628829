/// The point of the primitives closest to a given point.
#pragma once

#include <hedgerow/queries/point_query.h>

namespace hedgerow {

/// The closest point within max_distance2 (squared, included).
template <class Set>
class ClosestPoint : public PointQuery<Set> {
public:
    using Base = PointQuery<Set>;
    using typename Base::Candidate, typename Base::Found, typename Base::Scalar;
    static constexpr Order order = Order::nearest;

    template <class Index>
    ClosestPoint(const Index& index, const Vec<Scalar, Base::dimension>& p, Scalar max_distance2)
        : Base(index, p), best_{max_distance2, no_primitive, {}, no_primitive} {}

    Scalar limit() const { return limit_of_boxes(best_.distance2); }
    Flow offer(const Candidate& c) {
        if (nearer(c, best_)) best_ = c;
        return Flow::go_on;
    }
    /// False if no primitive is within the distance.
    Found answer() const { return best_.element == no_primitive ? Found{} : this->found(best_); }

private:
    Candidate best_;  // at first behind every candidate within the distance
};

}  // namespace hedgerow
