/// The primitives that overlap a box, ascending, each once.
#pragma once

#include <algorithm>
#include <vector>

#include <hedgerow/walks/query.h>

namespace hedgerow {

/// Collects elements in the caller's vector, which is cleared and whose capacity is reused. O(k log k) for k
/// offered, beyond the walk.
template <class Set>
class Overlapping {
public:
    using Scalar = typename Set::Scalar;
    using Probe = BoxProbe<Scalar, Set::dimension>;
    static constexpr Order order = Order::none;

    template <class Index>
    Overlapping(const Index&, const Box<Scalar, Set::dimension>& box, std::vector<IdOf<Set>>& found)
        : probe_(box), found_(found) {
        found_.clear();
    }

    const Probe& probe() const { return probe_; }
    Scalar limit() const { return std::numeric_limits<Scalar>::max(); }
    Flow offer(const OverlapCandidate& c) {
        found_.push_back(Identity<Set>::of(c));
        return Flow::go_on;
    }
    std::size_t answer() {
        std::sort(found_.begin(), found_.end());
        found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
        return found_.size();
    }

private:
    Probe probe_;
    std::vector<IdOf<Set>>& found_;
};

}  // namespace hedgerow
