/// What a primitive set is: primitives with boxes, which can be tested against probes. A set of your own
/// needs `size` and `bounds`; for ray queries also `meet`, for distance queries `closest_point` and
/// `farthest_point`, for queries of a region `overlaps` and `lies_within`.
#pragma once

#include <cstdint>
#include <optional>

#include <hedgerow/geometry/entry.h>
#include <hedgerow/geometry/overlap.h>
#include <hedgerow/probes/far_point.h>
#include <hedgerow/probes/point.h>
#include <hedgerow/probes/ray.h>
#include <hedgerow/probes/region.h>

namespace hedgerow {

/// The position of a primitive in its set.
using PrimitiveId = std::uint32_t;
/// Fills places of a list that hold no primitive.
inline constexpr PrimitiveId no_primitive = 0xFFFFFFFFu;

template <class P>
concept PrimitiveSet = requires(const P& p, std::size_t i) {
    typename P::Scalar;
    { P::dimension } -> std::convertible_to<int>;
    { p.size() } -> std::convertible_to<std::size_t>;
    { p.bounds(i) } -> std::same_as<Box<typename P::Scalar, P::dimension>>;
};
/// A set that answers ray queries. `meet` returns the hit of least t within the ray's interval, where t may
/// be whatever the test's arithmetic gives.
template <class P>
concept MeetsRays = PrimitiveSet<P> &&
    requires(const P& p, std::size_t i, const Ray<typename P::Scalar, P::dimension>& ray) {
    { p.meet(i, ray) } -> std::same_as<std::optional<Meeting<typename P::Scalar>>>;
};
/// What a set's `closest_point` may return: a Foot, or a point alone, whose distance is then measured in T.
template <std::floating_point T, int D>
constexpr Foot<T, D> foot_of(const Vec<T, D>& p, const Vec<T, D>& closest) {
    return {distance2(p, closest), closest};
}
template <std::floating_point T, int D>
constexpr const Foot<T, D>& foot_of(const Vec<T, D>&, const Foot<T, D>& closest) {
    return closest;
}
/// A set that answers distance queries. `closest_point` returns the closest point of a primitive, which must
/// lie within the primitive's bounds, or a Foot, whose distance may be at most some roundings less than that
/// to the bounds.
template <class P>
concept HasClosestPoint = PrimitiveSet<P> &&
    requires(const P& p, std::size_t i, const Vec<typename P::Scalar, P::dimension>& x) {
    { foot_of(x, p.closest_point(i, x)) } -> std::convertible_to<Foot<typename P::Scalar, P::dimension>>;
};
/// A set that tells the farthest point of a primitive, which must lie within the primitive's bounds.
template <class P>
concept HasFarthestPoint = PrimitiveSet<P> &&
    requires(const P& p, std::size_t i, const Vec<typename P::Scalar, P::dimension>& x) {
    { p.farthest_point(i, x) } -> std::convertible_to<Foot<typename P::Scalar, P::dimension>>;
};
/// A set that answers box queries. `overlaps` may be true only if the primitive's bounds overlap the box.
template <class P>
concept OverlapsBoxes = PrimitiveSet<P> &&
    requires(const P& p, std::size_t i, const Box<typename P::Scalar, P::dimension>& box) {
    { p.overlaps(i, box) } -> std::same_as<bool>;
};

/// A set that answers queries of a region: `overlaps` tells whether a primitive has a point in the region.
template <class P, class R>
concept OverlapsRegions = PrimitiveSet<P> && requires(const P& p, std::size_t i, const R& region) {
    { p.overlaps(i, region) } -> std::same_as<bool>;
};
/// A set that tells which primitives lie in a region wholly.
template <class P, class R>
concept LiesWithinRegions = OverlapsRegions<P, R> && requires(const P& p, std::size_t i, const R& region) {
    { p.lies_within(i, region) } -> std::same_as<bool>;
};

/// A set whose hits lie within the probe's slack of the primitive itself, not only of its box. Structures may
/// leave its primitives out of cells that they do not overlap (structures/cells.h).
template <class P>
concept HitsLieOnPrimitives = OverlapsBoxes<P> && P::hits_lie_on_primitives;

/// A set of points and nothing else.
template <class P>
concept PointSet = PrimitiveSet<P> && requires(const P& set, std::size_t i) {
    { set.point(i) } -> std::convertible_to<Vec<typename P::Scalar, P::dimension>>;
};

/// A candidate of a ray query. `instance` is the number of the placed index that the element is in; 0 where
/// there are no instances.
template <std::floating_point T>
struct RayCandidate {
    T t, u, v;
    PrimitiveId element;
    std::uint32_t instance = 0;
};
/// A candidate of a distance query.
template <std::floating_point T, int D>
struct PointCandidate {
    T distance2;
    PrimitiveId element;
    Vec<T, D> point;
    std::uint32_t instance = 0;
};
/// A candidate of a query of a region.
struct OverlapCandidate {
    PrimitiveId element;
    std::uint32_t instance = 0;
};

/// The type of candidate that the walks of a probe offer to its queries.
template <class Probe>
struct CandidateOfProbe;
template <std::floating_point T, int D>
struct CandidateOfProbe<RayProbe<T, D>> {
    using Type = RayCandidate<T>;
};
template <std::floating_point T, int D>
struct CandidateOfProbe<PointProbe<T, D>> {
    using Type = PointCandidate<T, D>;
};
template <std::floating_point T, int D>
struct CandidateOfProbe<FarProbe<T, D>> {
    using Type = PointCandidate<T, D>;
};
template <Region R>
struct CandidateOfProbe<RegionProbe<R>> {
    using Type = OverlapCandidate;
};
template <class Probe>
using CandidateOf = typename CandidateOfProbe<Probe>::Type;

/// Equal answers are ordered by (instance, element), and primitives are the same if both are equal.
template <class A, class B>
constexpr bool comes_before(const A& a, const B& b) {
    return a.instance != b.instance ? a.instance < b.instance : a.element < b.element;
}
template <class A, class B>
constexpr bool same_primitive(const A& a, const B& b) {
    return a.instance == b.instance && a.element == b.element;
}

/// A primitive of an instance.
struct PlacedId {
    std::uint32_t instance;
    PrimitiveId element;
    friend auto operator<=>(const PlacedId&, const PlacedId&) = default;
};
/// A set whose primitives are whole indexes, placed (instances/instance_set.h). Its answers are named by two
/// numbers, the instance and the element.
template <class P>
concept Instanced = P::instanced;
/// The name of a primitive of P in lists and columns of ids.
template <class P>
struct Identity {
    using Type = PrimitiveId;
    template <class Candidate>
    static Type of(const Candidate& c) {
        return c.element;
    }
};
template <Instanced P>
struct Identity<P> {
    using Type = PlacedId;
    template <class Candidate>
    static Type of(const Candidate& c) {
        return {c.instance, c.element};
    }
};
template <class P>
using IdOf = typename Identity<P>::Type;

/// Whether a test of one primitive offers each candidate once.
template <class P>
bool offers_once(const P& set) {
    if constexpr (Instanced<P>)
        return set.offers_once();
    else
        return true;
}

/// How much farther than RayProbe's own error bound a hit may lie from its primitive's box: 0 except for
/// instances.
template <class P, class Ray>
auto hit_error(const P& set, const Ray& ray) {
    if constexpr (requires { set.hit_error(ray); })
        return set.hit_error(ray);
    else
        return typename Ray::Scalar(0);
}
/// The order of a packed copy of the primitives: by leaves, for structures that hold each primitive about
/// once, or by id.
enum class PackedOrder { of_leaves, of_ids };

/// The primitives of a leaf, by id: `ids[first]` to `ids[first + count − 1]`.
struct Leaf {
    const PrimitiveId* ids;
    std::uint32_t first, count;
};

/// Tests one primitive against the query's probe, and offers the candidate that results, if any.
template <class P, class Query>
Flow test_one(const P& set, const RayProbe<typename P::Scalar, P::dimension>& probe, PrimitiveId id,
              Query& query) {
    if constexpr (MeetsRays<P>) {
        const auto m = set.meet(id, probe.ray());
        if (!m) return Flow::go_on;
        // Drop hits outside the primitive's box. A structure only knows the box, so finding such a hit would
        // depend on the structure.
        if (!probe.meets_within_error(set.bounds(id), m->t)) return Flow::go_on;
        return query.offer({m->t, m->u, m->v, id});
    } else {
        return Flow::go_on;  // rays pass between points
    }
}
template <HasClosestPoint P, class Query>
Flow test_one(const P& set, const PointProbe<typename P::Scalar, P::dimension>& probe, PrimitiveId id,
              Query& query) {
    const auto foot = foot_of(probe.point(), set.closest_point(id, probe.point()));
    return query.offer({foot.distance2, id, foot.point});
}
template <HasFarthestPoint P, class Query>
Flow test_one(const P& set, const FarProbe<typename P::Scalar, P::dimension>& probe, PrimitiveId id,
              Query& query) {
    const auto foot = set.farthest_point(id, probe.point());
    return query.offer({foot.distance2, id, foot.point});
}
template <class P, Region R, class Query>
requires OverlapsRegions<P, R> Flow test_one(const P& set, const RegionProbe<R>& probe, PrimitiveId id,
                                             Query& query) {
    return probe.takes(set, id) ? query.offer({id}) : Flow::go_on;
}

/// Tests the primitives of a leaf one by one. A set with a way of its own has a member `test_leaf(probe,
/// leaf, query)`, which is called instead.
template <class P, class Probe, class Query>
Flow test_leaf(const P& set, const Probe& probe, const Leaf& leaf, Query& query) {
    if constexpr (requires { set.test_leaf(probe, leaf, query); }) {
        return set.test_leaf(probe, leaf, query);
    } else {
        for (std::uint32_t i = 0; i < leaf.count; ++i)
            if (test_one(set, probe, leaf.ids[leaf.first + i], query) == Flow::stop) return Flow::stop;
        return Flow::go_on;
    }
}

/// The id that a hit reports for a primitive: its position, unless the set gives ids (for a triangle, its
/// face in the file).
template <class P>
std::uint32_t reported_id(const P& set, PrimitiveId i, std::uint32_t instance) {
    if constexpr (Instanced<P>)
        return set.id(i, instance);
    else if constexpr (requires { set.id(i); })
        return set.id(i);
    else
        return i;
}

/// The geometry that a hit reports: the number that its instance was given; 0 where there are no instances.
template <class P>
std::uint32_t reported_geometry(const P& set, std::uint32_t instance) {
    if constexpr (requires { set.geometry(instance); })
        return set.geometry(instance);
    else
        return 0;
}

/// A set that only looks at arrays: the `view()` of a set that owns its arrays, or the set itself. Indexes
/// store views.
template <class P>
auto view_of(const P& set) {
    if constexpr (requires { set.view(); })
        return set.view();
    else
        return set;
}
template <class P>
using ViewOf = decltype(view_of(std::declval<const P&>()));

}  // namespace hedgerow
