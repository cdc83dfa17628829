/// Every primitive within a distance of a point, in the order of (distance², instance, element), each once.
#pragma once

#include <algorithm>
#include <vector>

#include <hedgerow/queries/point_query.h>

namespace hedgerow {

/// Collects primitives in the caller's vector, which is cleared and whose capacity is reused. O(k log k) for
/// k found, beyond the walk.
template <class Set, class Filter = KeepAll>
class Within : public PointQuery<Set, Filter> {
public:
    using Base = PointQuery<Set, Filter>;
    using typename Base::Candidate, typename Base::Found, typename Base::Scalar;
    static constexpr Order order = Order::none;

    template <class Index>
    Within(const Index& index, const Vec<Scalar, Base::dimension>& p, const NearLimits<Scalar>& limits,
           std::vector<Found>& found, const Filter& filter = {})
        : Base(index, p, limits, filter), found_(found) {
        found_.clear();
    }

    Scalar limit() const { return limit_of_boxes(this->limits().distance2); }
    Flow offer(const Candidate& c) {
        if (c.distance2 <= this->limits().distance2 && this->counts(c)) found_.push_back(this->found(c));
        return Flow::go_on;
    }
    std::size_t answer() {
        // A structure that holds a primitive in several cells offers it several times.
        std::sort(found_.begin(), found_.end(), nearer<Found, Found>);
        found_.erase(std::unique(found_.begin(), found_.end(), same_primitive<Found, Found>), found_.end());
        return found_.size();
    }

private:
    std::vector<Found>& found_;
};

}  // namespace hedgerow
