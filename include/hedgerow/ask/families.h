/// The questions of a family of rays: what the rays of a beam or a cone may hit, and what a cone sees.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include <hedgerow/ask/asking.h>
#include <hedgerow/engine/cone_kernels.h>
#include <hedgerow/geometry/radius.h>
#include <hedgerow/queries/candidates.h>
#include <hedgerow/queries/cone_fragments.h>

namespace hedgerow {

/// How deep questions of a family of rays look.
struct FamilyOptions {
    double limit = std::numeric_limits<double>::infinity();
};

/// Writes what the rays of a beam (FrustumRays) or a cone (ConeRays) may hit, at depths of up to the options'
/// limit, to `found`: ascending by the least depth, each primitive once. Returns how many there are. No
/// primitive that a ray hits is missing.
template <class I, RayFamily Rays, class Count = const NoVisits>
std::size_t candidates(const I& index, const Rays& rays,
                       std::vector<FamilyCandidate<typename I::Scalar>>& found,
                       const FamilyOptions& options = {}, Count& count = no_visits) {
    using T = typename I::Scalar;
    const T limit = std::min(greatest_at_most<T>(options.limit), std::numeric_limits<T>::max());
    return index.template answer<Candidates<typename I::Primitives, Rays>>(count, rays, found, limit);
}
template <class I, RayFamily Rays>
std::vector<FamilyCandidate<typename I::Scalar>> candidates(const I& index, const Rays& rays,
                                                            const FamilyOptions& options = {}) {
    std::vector<FamilyCandidate<typename I::Scalar>> found;
    candidates(index, rays, found, options);
    return found;
}

/// Writes what a cone sees of the triangles of an index to `found`, from front to back: each triangle that is
/// the nearest at some of 64 samples of the cross section, with these samples. Returns how many there are.
template <class I, class Count = const NoVisits>
std::size_t cone_fragments(const I& index, const ConeRays<typename I::Scalar, 3>& cone,
                           std::vector<ConeFragment<typename I::Scalar>>& found, Count& count = no_visits) {
    return index.template answer<ConeFragments<typename I::Primitives>>(count, cone, found);
}
template <class I>
std::vector<ConeFragment<typename I::Scalar>> cone_fragments(const I& index,
                                                             const ConeRays<typename I::Scalar, 3>& cone) {
    std::vector<ConeFragment<typename I::Scalar>> found;
    cone_fragments(index, cone, found);
    return found;
}

}  // namespace hedgerow
