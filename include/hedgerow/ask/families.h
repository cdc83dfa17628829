/// The questions of a family of rays: what the rays of a beam or a cone may hit, and what a cone sees.
#pragma once

#include <vector>

#include <hedgerow/ask/asking.h>
#include <hedgerow/engine/cone_kernels.h>
#include <hedgerow/queries/candidates.h>
#include <hedgerow/queries/cone_fragments.h>

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

/// Writes what a cone sees of the triangles of an index to `found`, from front to back: each triangle that is
/// the nearest at some of 64 samples of the cross section, with these samples. Returns how many there are.
template <class S, class P, class Count = const NoVisits>
std::size_t cone_fragments(const Index<S, P>& index, const ConeRays<typename P::Scalar, 3>& cone,
                           std::vector<ConeFragment<typename P::Scalar>>& found, Count& count = no_visits) {
    return index.template answer<ConeFragments<P>>(count, cone, found);
}

}  // namespace hedgerow
