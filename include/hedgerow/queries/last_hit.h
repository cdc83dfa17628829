/// The hit of greatest t; equal t goes to the lowest (instance, element).
#pragma once

#include <hedgerow/queries/ray_query.h>

namespace hedgerow {

/// Looks at all that the ray meets, since what a hit hides is what is asked for.
template <class Set, class Filter = KeepAll>
class LastHit : public RayQuery<Set, Filter> {
public:
    using Base = RayQuery<Set, Filter>;
    using Scalar = typename Base::Scalar;
    static constexpr Order order = Order::none;

    template <class Index, class Ray>
    LastHit(const Index& index, const Ray& ray, const Filter& filter = {}) : Base(index, ray, filter) {}

    Flow offer(const RayCandidate<Scalar>& c) {
        const bool later =
            last_.element == Hit<Scalar>::none || c.t > last_.t || (c.t == last_.t && comes_before(c, last_));
        if (later && this->counts(c)) last_ = c;
        return Flow::go_on;
    }
    /// False if nothing was hit.
    Hit<Scalar> answer() const {
        return last_.element == Hit<Scalar>::none ? Hit<Scalar>{} : this->hit(last_);
    }

private:
    RayCandidate<Scalar> last_{0, 0, 0, Hit<Scalar>::none, Hit<Scalar>::none};
};

}  // namespace hedgerow
