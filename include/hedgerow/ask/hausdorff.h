/// Hausdorff distances of meshes and clouds, within bounds that are certain.
///
/// The directed distance from A to B is that of the point of A that is farthest from B. Any point of A gives
/// a lower bound. Upper bounds hold for whole triangles of A: the one with the greatest is divided, and
/// triangles are dropped whose bound cannot change the answer (Tang, Lee and Kim 2009; Kang et al. 2018;
/// Sacht and Jacobson 2024). Closest points come in batches (ask/points.h), so whatever answers these fast
/// makes this fast.
#pragma once

#include <algorithm>
#include <limits>

#include <hedgerow/ask/hausdorff/directed.h>

namespace hedgerow {

namespace detail {

inline void expect_tolerances(const HausdorffOptions& options) {
    if (!(options.absolute >= 0) || !(options.relative >= 0))
        throw UsageError("the tolerances of a Hausdorff distance are not negative");
}
template <class IA, class IB>
auto directed_hausdorff(const IA& a, const IB& b, const HausdorffOptions& options, Executor& executor,
                        double at_least) {
    using Result = typename DirectedHausdorff<IA, IB>::Result;
    constexpr auto infinity = std::numeric_limits<typename IA::Scalar>::infinity();
    if (a.bounds().empty()) return Result{};
    if (b.bounds().empty()) return Result{.lower = infinity, .upper = infinity};
    return in_ieee_mode([&] { return DirectedHausdorff<IA, IB>(a, b, options, executor, at_least).run(); });
}

template <class IA, class IB>
auto symmetric_hausdorff(const IA& a, const IB& b, const HausdorffOptions& options) {
    expect_tolerances(options);
    Executor& executor = options.threads.over(std::max(a.size(), b.size()));
    auto result = directed_hausdorff(a, b, options, executor, 0);
    // What is no farther than the distance found is of no interest in the other direction.
    const auto back = directed_hausdorff(b, a, options, executor, static_cast<double>(result.lower));
    if (back && back.lower > result.lower) {
        const auto upper = std::max(result.upper, back.upper);
        result = {back.lower, upper, back.element_b, back.element_a, back.point_b, back.point_a, true};
    }
    result.upper = std::max(result.upper, back.upper);
    result.lower = std::max(result.lower, back.lower);
    return result;
}

}  // namespace detail

/// The directed (one-sided) Hausdorff distance from A to B: how far the points of A are from B at most, not
/// only its corners. Triangles to triangles or points, in space; points to whatever has closest points.
///
/// A may be any index, since only its primitives are read: `build<BruteForce>(mesh)` costs least. The
/// distance from an empty set is 0, and that from any other to an empty set is infinite. Throws UsageError
/// for tolerances that are negative or NaN.
///
/// Triangles of A that B has too, with equal corners, cost O(1) each. Others cost a closest point for each
/// vertex, and some of them a dozen or more, by how alike the sets are and how narrow the tolerance is; where
/// the sets are far apart, most vertices are not asked for. Takes up to 24 bytes for each vertex of both sets
/// and 40 for each triangle, and 160 for each part of a triangle that may be the farthest. Large sets are
/// asked on all cores, or the threads of the options; the result is the same.
template <class SA, class A, class SB, class B>
requires FarFrom<A, B> Hausdorff<typename A::Scalar, A::dimension> directed_hausdorff_distance(
    const Index<SA, A>& a, const Index<SB, B>& b, const HausdorffOptions& options = {}) {
    detail::expect_tolerances(options);
    return detail::directed_hausdorff(a, b, options, options.threads.over(a.size()), 0);
}

/// The (symmetric) Hausdorff distance: the greater of the directed ones. It is 0 for two empty sets, and
/// infinite if one is empty.
template <class SA, class A, class SB, class B>
requires(FarFrom<A, B>&& FarFrom<B, A>) Hausdorff<typename A::Scalar, A::dimension> hausdorff_distance(
    const Index<SA, A>& a, const Index<SB, B>& b, const HausdorffOptions& options = {}) {
    return detail::symmetric_hausdorff(a, b, options);
}

}  // namespace hedgerow
