/// The questions of two indexes, or of one and itself, of an AnyIndex: as ask/pairs.h and ask/hausdorff.h
/// have them of an Index, with the same answers.
///
/// What is in an index is known when it is asked. InputError is thrown where a question is not of such sets:
/// crossings are of triangles, pairs within a radius of points, distances of what `minimum_distance` and
/// `hausdorff_distance` say. This header compiles all pairs of sets; a program that knows its sets had better
/// ask an Index of AnyStructure (any_structure.h).
#pragma once

#include <hedgerow/any_index.h>
#include <hedgerow/ask/hausdorff.h>
#include <hedgerow/ask/pairs.h>

namespace hedgerow {

namespace detail {

/// An AnyIndex whose set is known, as what walks over pairs and Hausdorff distances read of an Index.
template <class P>
class IndexOver {
public:
    using Scalar = typename P::Scalar;
    static constexpr int dimension = P::dimension;
    using Primitives = P;
    using Any = AnyIndex<Scalar, dimension>;

    IndexOver(const Any& any, P set) : any_(any), set_(std::move(set)) {}

    const Any& any() const { return any_; }
    const P& primitives() const { return set_; }
    std::size_t size() const { return any_.size(); }
    std::size_t bytes() const { return any_.bytes(); }
    const Box<Scalar, dimension>& bounds() const { return any_.bounds(); }
    /// Of closest points alone.
    template <class Q, class Count, class... Arguments>
    auto answer(Count&, const Arguments&... arguments) const {
        return EngineFor<Q, IndexOver>(*this).answer(arguments...);
    }
    struct Structure {
        const Any& any;
        AnyHierarchy<Scalar, dimension> hierarchy(const P&) const { return any.hierarchy(); }
        bool holds(PrimitiveId element) const { return any.holds(element); }
    };
    Structure structure() const { return {any_}; }

private:
    const Any& any_;
    P set_;
};

[[noreturn]] inline void refuse_pairs(const std::string& what) {
    throw InputError(what + ": give an index of such a set");
}
/// Calls f(index) with the index as one over the set that it holds.
template <std::floating_point T, int D, class F>
auto over_its_set(const AnyIndex<T, D>& any, F f) {
    return std::visit([&]<class P>(const P& set) { return f(IndexOver<P>(any, set)); }, any.set());
}
template <std::floating_point T>
IndexOver<TriangleMeshView<T>> over_triangles(const AnyIndex<T, 3>& any) {
    const auto set = any.set();
    if (const auto* const mesh = std::get_if<TriangleMeshView<T>>(&set)) return {any, *mesh};
    refuse_pairs("crossings are those of triangles");
}
template <std::floating_point T, int D>
IndexOver<PointCloudView<T, D>> over_points(const AnyIndex<T, D>& any) {
    const auto set = any.set();
    if (const auto* const cloud = std::get_if<PointCloudView<T, D>>(&set)) return {any, *cloud};
    refuse_pairs("pairs within a radius are those of points");
}

}  // namespace detail

/// The closest points of such an index are those of the AnyIndex.
template <class P>
struct EngineFor<ClosestPoint<P>, detail::IndexOver<P>>
    : EngineFor<ClosestPoint<typename detail::IndexOver<P>::Any>, typename detail::IndexOver<P>::Any> {
    explicit EngineFor(const detail::IndexOver<P>& index)
        : EngineFor<ClosestPoint<typename detail::IndexOver<P>::Any>, typename detail::IndexOver<P>::Any>(
              index.any()) {}
};

template <std::floating_point T>
std::size_t crossing_pairs(const AnyIndex<T, 3>& a, const AnyIndex<T, 3>& b, std::vector<ElementPair>& found,
                           const PairOptions& options = {}) {
    return detail::list_crossings(detail::over_triangles(a), detail::over_triangles(b), found,
                                  options.threads);
}
template <std::floating_point T>
std::vector<ElementPair> crossing_pairs(const AnyIndex<T, 3>& a, const AnyIndex<T, 3>& b,
                                        const PairOptions& options = {}) {
    std::vector<ElementPair> found;
    crossing_pairs(a, b, found, options);
    return found;
}
template <std::floating_point T>
bool any_crossing(const AnyIndex<T, 3>& a, const AnyIndex<T, 3>& b) {
    return detail::has_crossing(detail::over_triangles(a), detail::over_triangles(b));
}
template <std::floating_point T>
std::size_t self_intersections(const AnyIndex<T, 3>& index, std::vector<ElementPair>& found,
                               const PairOptions& options = {}) {
    return detail::list_self_intersections(detail::over_triangles(index), found, options.threads);
}
template <std::floating_point T>
std::vector<ElementPair> self_intersections(const AnyIndex<T, 3>& index, const PairOptions& options = {}) {
    std::vector<ElementPair> found;
    self_intersections(index, found, options);
    return found;
}
template <std::floating_point T>
bool any_self_intersection(const AnyIndex<T, 3>& index) {
    return detail::has_self_intersection(detail::over_triangles(index));
}

template <std::floating_point T, int D>
std::size_t pairs_within(const AnyIndex<T, D>& index, double radius, std::vector<PairWithin<T>>& found,
                         const PairOptions& options = {}) {
    return detail::list_pairs_within(detail::over_points(index), radius, found, options.threads);
}
template <std::floating_point T, int D>
std::size_t pairs_within(const AnyIndex<T, D>& a, const AnyIndex<T, D>& b, double radius,
                         std::vector<PairWithin<T>>& found, const PairOptions& options = {}) {
    return detail::list_pairs_within(detail::over_points(a), detail::over_points(b), radius, found,
                                     options.threads);
}

template <std::floating_point T, int D>
std::vector<PairWithin<T>> pairs_within(const AnyIndex<T, D>& index, double radius,
                                        const PairOptions& options = {}) {
    std::vector<PairWithin<T>> found;
    pairs_within(index, radius, found, options);
    return found;
}
template <std::floating_point T, int D>
std::vector<PairWithin<T>> pairs_within(const AnyIndex<T, D>& a, const AnyIndex<T, D>& b, double radius,
                                        const PairOptions& options = {}) {
    std::vector<PairWithin<T>> found;
    pairs_within(a, b, radius, found, options);
    return found;
}

template <std::floating_point T, int D, class Count = const NoVisits>
Apart<T, D> minimum_distance(const AnyIndex<T, D>& a, const AnyIndex<T, D>& b,
                             const DistanceOptions& options = {}, Count& count = no_visits) {
    return detail::over_its_set(a, [&](const auto& of_a) {
        return detail::over_its_set(b, [&](const auto& of_b) -> Apart<T, D> {
            if constexpr (requires { gap_between(of_a.primitives(), 0, of_b.primitives(), 0); })
                return detail::least_distance(of_a, of_b, options, count);
            else
                detail::refuse_pairs("distances are those of triangles, or of points and any primitives");
        });
    });
}

template <std::floating_point T, int D>
Hausdorff<T, D> directed_hausdorff_distance(const AnyIndex<T, D>& a, const AnyIndex<T, D>& b,
                                            const HausdorffOptions& options = {}) {
    return detail::over_its_set(a, [&]<class IA>(const IA& of_a) {
        return detail::over_its_set(b, [&]<class IB>(const IB& of_b) -> Hausdorff<T, D> {
            detail::expect_tolerances(options);
            if constexpr (FarFrom<typename IA::Primitives, typename IB::Primitives>)
                return detail::directed_hausdorff(of_a, of_b, options, options.threads.over(a.size()), 0);
            else
                detail::refuse_pairs(
                    "distances of the farthest are those of triangles to triangles or points, "
                    "or of points");
        });
    });
}
template <std::floating_point T, int D>
Hausdorff<T, D> hausdorff_distance(const AnyIndex<T, D>& a, const AnyIndex<T, D>& b,
                                   const HausdorffOptions& options = {}) {
    return detail::over_its_set(a, [&]<class IA>(const IA& of_a) {
        return detail::over_its_set(b, [&]<class IB>(const IB& of_b) -> Hausdorff<T, D> {
            using A = typename IA::Primitives;
            using B = typename IB::Primitives;
            if constexpr (FarFrom<A, B> && FarFrom<B, A>)
                return detail::symmetric_hausdorff(of_a, of_b, options);
            else
                detail::refuse_pairs(
                    "distances of the farthest both ways are those of triangles, or of points");
        });
    });
}

}  // namespace hedgerow
