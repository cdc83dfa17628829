/// The question of a family of rays: what the rays of a beam or a cone may hit.
#pragma once

#include <vector>

#include <hedgerow/ask/asking.h>
#include <hedgerow/queries/candidates.h>

namespace hedgerow {

/// Writes what the rays of a beam (FrustumRays) or a cone (ConeRays) may hit, at depths of up to `limit`, to
/// `found`: ascending by the least depth, each primitive once. Returns how many there are. No primitive that
/// a ray hits is missing.
template <class S, class P, RayFamily Rays, class Count = const NoVisits>
std::size_t candidates(const Index<S, P>& index, const Rays& rays,
                       std::vector<FamilyCandidate<typename P::Scalar>>& found,
                       typename P::Scalar limit = std::numeric_limits<typename P::Scalar>::max(),
                       Count& count = no_visits) {
    return index.template answer<Candidates<P, Rays>>(count, rays, found, limit);
}

}  // namespace hedgerow
