/// Every primitive within a distance of a point, in the order of (distance², instance, element), each once.
#pragma once

#include <algorithm>
#include <vector>

#include <hedgerow/queries/closest_point.h>

namespace hedgerow {

/// Collects primitives in the caller's vector, which is cleared and whose capacity is reused. O(k log k) for
/// k found, beyond the walk.
template <class Set>
class Within {
public:
    using Scalar = typename Set::Scalar;
    static constexpr int dimension = Set::dimension;
    using Probe = PointProbe<Scalar, dimension>;
    using Found = Near<Scalar, dimension>;
    static constexpr Order order = Order::none;

    template <class Index>
    Within(const Index& index, const Vec<Scalar, dimension>& p, Scalar max_distance2,
           std::vector<Found>& found)
        : probe_(p), set_(index.primitives()), max_(max_distance2), found_(found) {
        found_.clear();
    }

    const Probe& probe() const { return probe_; }
    Scalar limit() const { return max_; }
    Flow offer(const PointCandidate<Scalar, dimension>& c) {
        if (c.distance2 <= max_)
            found_.push_back(
                {c.distance2, reported_id(set_, c.element, c.instance), c.element, c.point, c.instance});
        return Flow::go_on;
    }
    std::size_t answer() {
        // A structure that holds a primitive in several cells offers it several times.
        std::sort(found_.begin(), found_.end(), nearer<Found>);
        found_.erase(std::unique(found_.begin(), found_.end(), same_primitive<Found, Found>), found_.end());
        return found_.size();
    }

private:
    Probe probe_;
    const Set& set_;
    Scalar max_;
    std::vector<Found>& found_;
};

}  // namespace hedgerow
