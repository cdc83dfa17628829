/// The hit of least t; equal t goes to the lowest (instance, element).
#pragma once

#include <hedgerow/queries/ray_query.h>

namespace hedgerow {

/// Every closer hit that counts lowers the limit, so the walk soon prunes what lies behind.
template <class Set, class Filter = KeepAll>
class ClosestHit : public RayQuery<Set, Filter> {
public:
    using Base = RayQuery<Set, Filter>;
    using Scalar = typename Base::Scalar;
    static constexpr Order order = Order::nearest;

    template <class Index, class Ray>
    ClosestHit(const Index& index, const Ray& ray, const Filter& filter = {})
        : Base(index, ray, filter), best_{ray.t_max, 0, 0, Hit<Scalar>::none, Hit<Scalar>::none} {}

    Scalar limit() const { return best_.t; }
    Flow offer(const RayCandidate<Scalar>& c) {
        if (c.t <= best_.t && (c.t < best_.t || comes_before(c, best_)) && this->counts(c)) best_ = c;
        return Flow::go_on;
    }
    /// False if nothing was hit.
    Hit<Scalar> answer() const {
        return best_.element == Hit<Scalar>::none ? Hit<Scalar>{} : this->hit(best_);
    }

private:
    RayCandidate<Scalar> best_;
};

}  // namespace hedgerow
