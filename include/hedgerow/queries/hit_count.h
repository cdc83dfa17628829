/// How many primitives a ray hits.
#pragma once

#include <hedgerow/queries/ray_query.h>

namespace hedgerow {

/// Counts the hits that it is offered. Right only for structures that offer each primitive once.
template <class Set, class Filter = KeepAll>
class HitCount : public RayQuery<Set, Filter> {
public:
    using Base = RayQuery<Set, Filter>;
    using Scalar = typename Base::Scalar;
    static constexpr Order order = Order::none;

    template <class Index, class Ray>
    HitCount(const Index& index, const Ray& ray, const Filter& filter = {}) : Base(index, ray, filter) {}

    Flow offer(const RayCandidate<Scalar>& c) {
        found_ += this->counts(c);
        return Flow::go_on;
    }
    std::size_t answer() const { return found_; }

private:
    std::size_t found_ = 0;
};

}  // namespace hedgerow
