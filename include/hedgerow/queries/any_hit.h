/// Whether a ray hits anything.
#pragma once

#include <hedgerow/queries/ray_query.h>

namespace hedgerow {

/// Stops at the first hit found. Opening near cells first still pays, since what occludes is often near.
template <class Set, class Filter = KeepAll>
class AnyHit : public RayQuery<Set, Filter> {
public:
    using Base = RayQuery<Set, Filter>;
    using Scalar = typename Base::Scalar;
    static constexpr Order order = Order::nearest;

    template <class Index, class Ray>
    AnyHit(const Index& index, const Ray& ray, const Filter& filter = {}) : Base(index, ray, filter) {}

    Flow offer(const RayCandidate<Scalar>& c) {
        found_ = this->counts(c);
        return found_ ? Flow::stop : Flow::go_on;
    }
    /// A kernel has found a hit that counts; stops the walk.
    Flow found() {
        found_ = true;
        return Flow::stop;
    }
    bool answer() const { return found_; }

private:
    bool found_ = false;
};

}  // namespace hedgerow
