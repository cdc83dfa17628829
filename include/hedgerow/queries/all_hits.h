/// Every hit along a ray, each primitive once, in the order of (t, instance, element), and how many there
/// are.
#pragma once

#include <algorithm>
#include <vector>

#include <hedgerow/queries/ray_query.h>

namespace hedgerow {

/// Collects hits in the caller's vector, which is cleared. Its capacity is reused, so a warm call allocates
/// nothing. O(k log k) in the hits found. A structure that holds a primitive in several cells offers it
/// several times with the same bits; the sort makes these hits neighbours, and all but one are removed.
template <class Set, class Filter = KeepAll>
class AllHits : public RayQuery<Set, Filter> {
public:
    using Base = RayQuery<Set, Filter>;
    using Scalar = typename Base::Scalar;
    static constexpr Order order = Order::none;

    template <class Index, class Ray>
    AllHits(const Index& index, const Ray& ray, std::vector<Hit<Scalar>>& hits, const Filter& filter = {})
        : Base(index, ray, filter), hits_(hits) {
        hits_.clear();
    }

    Flow offer(const RayCandidate<Scalar>& c) {
        if (this->counts(c)) hits_.push_back(this->hit(c));
        return Flow::go_on;
    }
    std::size_t answer() {
        std::sort(hits_.begin(), hits_.end(),
                  [](const auto& a, const auto& b) { return a.t != b.t ? a.t < b.t : comes_before(a, b); });
        const auto same = [](const auto& a, const auto& b) { return same_primitive(a, b); };
        hits_.erase(std::unique(hits_.begin(), hits_.end(), same), hits_.end());
        return hits_.size();
    }

private:
    std::vector<Hit<Scalar>>& hits_;
};

}  // namespace hedgerow
