/// The point of the primitives closest to a given point.
#pragma once

#include <hedgerow/queries/point_query.h>

namespace hedgerow {

/// The closest point within the options' distance.
template <class Set>
class ClosestPoint : public PointQuery<Set> {
public:
    using Base = PointQuery<Set>;
    using typename Base::Candidate, typename Base::Found, typename Base::Scalar;
    static constexpr Order order = Order::nearest;

    template <class Index>
    ClosestPoint(const Index& index, const Vec<Scalar, Base::dimension>& p,
                 const NearOptions<Scalar>& options)
        : Base(index, p),
          options_(options),
          best_{options.max_distance2(), no_primitive, {}, no_primitive},
          limit_(limit_of_boxes(best_.distance2)) {}

    Scalar limit() const { return limit_; }
    Flow offer(const Candidate& c) {
        if (!nearer(c, best_)) return Flow::go_on;
        best_ = c;
        limit_ = limit_of_boxes(options_.limit(c.distance2));
        return Flow::go_on;
    }
    /// False if no primitive is within the distance.
    Found answer() const { return best_.element == no_primitive ? Found{} : this->found(best_); }

private:
    NearOptions<Scalar> options_;
    Candidate best_;  // at first behind every candidate within the distance
    Scalar limit_;
};

}  // namespace hedgerow
