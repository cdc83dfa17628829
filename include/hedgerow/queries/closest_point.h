/// The point of the primitives closest to a given point.
#pragma once

#include <hedgerow/queries/point_query.h>

namespace hedgerow {

/// The closest point within the limits.
template <class Set, class Filter = KeepAll>
class ClosestPoint : public PointQuery<Set, Filter> {
public:
    using Base = PointQuery<Set, Filter>;
    using typename Base::Candidate, typename Base::Found, typename Base::Scalar;
    static constexpr Order order = Order::nearest;

    template <class Index>
    ClosestPoint(const Index& index, const Vec<Scalar, Base::dimension>& p, const NearLimits<Scalar>& limits,
                 const Filter& filter = {})
        : Base(index, p, limits, filter),
          best_{limits.distance2, no_primitive, {}, no_primitive},
          limit_(limit_of_boxes(best_.distance2)) {}

    Scalar limit() const { return limit_; }
    Flow offer(const Candidate& c) {
        if (!nearer(c, best_) || !this->counts(c)) return Flow::go_on;
        best_ = c;
        limit_ = limit_of_boxes(this->limits().after(c.distance2));
        return Flow::go_on;
    }
    /// False if no primitive is within the distance.
    Found answer() const { return best_.element == no_primitive ? Found{} : this->found(best_); }

private:
    Candidate best_;  // at first behind every candidate within the distance
    Scalar limit_;
};

}  // namespace hedgerow
