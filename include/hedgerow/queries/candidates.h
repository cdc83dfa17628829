/// What the rays of a beam or a cone may hit, nearest first.
#pragma once

#include <algorithm>
#include <vector>

#include <hedgerow/probes/cone.h>
#include <hedgerow/probes/frustum.h>
#include <hedgerow/walks/query.h>

namespace hedgerow {

/// A primitive that rays of a family may hit, at this depth or beyond.
template <std::floating_point T>
struct FamilyCandidate {
    T depth;
    PrimitiveId element;
    friend bool operator==(const FamilyCandidate&, const FamilyCandidate&) = default;
};
template <class Rays>
struct CandidateOfProbe<FamilyProbe<Rays>> {
    using Type = FamilyCandidate<typename Rays::Scalar>;
};
/// A primitive is a candidate if the family enters its bounds.
template <class P, class Rays, class Query>
Flow test_one(const P& set, const FamilyProbe<Rays>& probe, PrimitiveId id, Query& query) {
    typename P::Scalar depth;
    return probe.enter(set.bounds(id), query.limit(), depth) ? query.offer({depth, id}) : Flow::go_on;
}

/// Collects the candidates of a family in the caller's vector, which is cleared: ascending by (depth,
/// element), each once. Every primitive that a ray of the family hits at a depth within `limit` is among
/// them, at a depth that is no more than the hit's. Others may be, too, and which of those are depends on the
/// structure. O(k log k) for k offered, beyond the walk.
template <class Set, RayFamily Rays>
class Candidates {
public:
    using Probe = FamilyProbe<Rays>;
    using Scalar = typename Set::Scalar;
    static constexpr Order order = Order::nearest;
    static_assert(std::same_as<Scalar, typename Rays::Scalar> && Set::dimension == Rays::dimension,
                  "a beam has the scalar and the dimension of the index");
    static_assert(!Instanced<Set>, "beams and cones are asked of the index that is placed, not of instances");

    template <class Index>
    Candidates(const Index& index, const Rays& rays, std::vector<FamilyCandidate<Scalar>>& found,
               Scalar limit = std::numeric_limits<Scalar>::max())
        : probe_(rays, index.bounds()), limit_(limit), found_(found) {
        found_.clear();
    }

    const Probe& probe() const { return probe_; }
    Scalar limit() const { return limit_; }
    bool done() const { return limit_ < 0; }
    Flow offer(const FamilyCandidate<Scalar>& c) {
        found_.push_back(c);
        return Flow::go_on;
    }
    std::size_t answer() {
        std::sort(found_.begin(), found_.end(), [](const auto& a, const auto& b) {
            return a.depth != b.depth ? a.depth < b.depth : a.element < b.element;
        });
        found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
        return found_.size();
    }

private:
    Probe probe_;
    Scalar limit_;
    std::vector<FamilyCandidate<Scalar>>& found_;
};

}  // namespace hedgerow
