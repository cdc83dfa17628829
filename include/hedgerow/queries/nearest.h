/// The k nearest primitives, in the order of (distance², instance, element), each once.
#pragma once

#include <algorithm>
#include <vector>

#include <hedgerow/queries/closest_point.h>

namespace hedgerow {

/// Stores the k nearest so far as a heap in the caller's vector, which is cleared and whose capacity is
/// reused. A candidate that counts costs O(log k) for the heap, and a search through the k, since structures
/// may offer a primitive twice.
template <class Set>
class Nearest {
public:
    using Scalar = typename Set::Scalar;
    static constexpr int dimension = Set::dimension;
    using Probe = PointProbe<Scalar, dimension>;
    using Found = Near<Scalar, dimension>;
    static constexpr Order order = Order::nearest;

    template <class Index>
    Nearest(const Index& index, const Vec<Scalar, dimension>& p, std::size_t k, Scalar max_distance2,
            std::vector<Found>& found)
        : probe_(p), set_(index.primitives()), k_(k), max_(max_distance2), found_(found) {
        found_.clear();
    }

    const Probe& probe() const { return probe_; }
    Scalar limit() const {
        return k_ == 0 ? Scalar(-1) : (found_.size() < k_ ? max_ : found_.front().distance2);
    }
    Flow offer(const PointCandidate<Scalar, dimension>& c) {
        const Found f{c.distance2, reported_id(set_, c.element, c.instance), c.element, c.point, c.instance};
        if (k_ == 0 || !(c.distance2 <= max_)) return Flow::go_on;
        if (found_.size() == k_ && !nearer(f, found_.front())) return Flow::go_on;
        for (const Found& g : found_)
            if (same_primitive(g, c)) return Flow::go_on;
        if (found_.size() == k_) {
            std::pop_heap(found_.begin(), found_.end(), nearer<Found>);
            found_.pop_back();
        }
        found_.push_back(f);
        std::push_heap(found_.begin(), found_.end(), nearer<Found>);
        return Flow::go_on;
    }
    std::size_t answer() {
        std::sort_heap(found_.begin(), found_.end(), nearer<Found>);
        return found_.size();
    }

private:
    Probe probe_;
    const Set& set_;
    std::size_t k_;
    Scalar max_;
    std::vector<Found>& found_;
};

}  // namespace hedgerow
