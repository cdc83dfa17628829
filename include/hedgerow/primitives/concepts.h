/// What a primitive set is: things with boxes that probes can be held against. A set of your own needs
/// `size`, `bounds` and those of `meet`, `closest_point` and `overlaps` whose questions it is to answer.
#pragma once

#include <cstdint>
#include <optional>

#include <hedgerow/geometry/entry.h>
#include <hedgerow/geometry/overlap.h>
#include <hedgerow/probes/box.h>
#include <hedgerow/probes/point.h>
#include <hedgerow/probes/ray.h>

namespace hedgerow {

/// The position of a primitive in its set.
using PrimitiveId = std::uint32_t;
/// In a list of places: none stands here.
inline constexpr PrimitiveId no_primitive = 0xFFFFFFFFu;

template <class P>
concept PrimitiveSet = requires(const P& p, std::size_t i) {
    typename P::Scalar;
    { P::dimension } -> std::convertible_to<int>;
    { p.size() } -> std::convertible_to<std::size_t>;
    { p.bounds(i) } -> std::same_as<Box<typename P::Scalar, P::dimension>>;
};
/// Answers rays: the meeting of least t within the ray's interval, with any t that its arithmetic gives.
template <class P>
concept MeetsRays = PrimitiveSet<P> &&
    requires(const P& p, std::size_t i, const Ray<typename P::Scalar, P::dimension>& ray) {
    { p.meet(i, ray) } -> std::same_as<std::optional<Meeting<typename P::Scalar>>>;
};
/// Answers distances: the closest point of a primitive, within the primitive's bounds.
template <class P>
concept HasClosestPoint = PrimitiveSet<P> &&
    requires(const P& p, std::size_t i, const Vec<typename P::Scalar, P::dimension>& x) {
    { p.closest_point(i, x) } -> std::same_as<Vec<typename P::Scalar, P::dimension>>;
};
/// Answers regions; a yes implies that the primitive's bounds overlap the box.
template <class P>
concept OverlapsBoxes = PrimitiveSet<P> &&
    requires(const P& p, std::size_t i, const Box<typename P::Scalar, P::dimension>& box) {
    { p.overlaps(i, box) } -> std::same_as<bool>;
};

/// A set that promises more of its hits: they lie within the probe's slack of the primitive itself, not only
/// of its box. It may be left out of cells that it does not overlap (structures/cells.h).
template <class P>
concept HitsLieOnPrimitives = OverlapsBoxes<P> && P::hits_lie_on_primitives;

/// A set of points and nothing else.
template <class P>
concept PointSet = PrimitiveSet<P> && requires(const P& set, std::size_t i) {
    { set.point(i) } -> std::convertible_to<Vec<typename P::Scalar, P::dimension>>;
};

/// What a ray query is offered. `instance` names the placed index that the element is in; 0 where there are
/// no instances.
template <std::floating_point T>
struct RayCandidate {
    T t, u, v;
    PrimitiveId element;
    std::uint32_t instance = 0;
};
/// What a distance query is offered.
template <std::floating_point T, int D>
struct PointCandidate {
    T distance2;
    PrimitiveId element;
    Vec<T, D> point;
    std::uint32_t instance = 0;
};
/// What a region query is offered.
struct OverlapCandidate {
    PrimitiveId element;
    std::uint32_t instance = 0;
};

/// The order that equal answers go by, and what they are told apart by: (instance, element).
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
/// Primitives that are whole indexes, placed (instance_set.h): what they answer is named by two numbers.
template <class P>
concept Instanced = P::instanced;
/// What a region query names primitives of P by.
template <class P>
struct Identity {
    using Type = PrimitiveId;
    static Type of(const OverlapCandidate& c) { return c.element; }
};
template <Instanced P>
struct Identity<P> {
    using Type = PlacedId;
    static Type of(const OverlapCandidate& c) { return {c.instance, c.element}; }
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

/// How much farther than RayProbe knows of itself a hit may lie from its primitive's box: 0 but for
/// instances.
template <class P, class Ray>
auto hit_error(const P& set, const Ray& ray) {
    if constexpr (requires { set.hit_error(ray); })
        return set.hit_error(ray);
    else
        return typename Ray::Scalar(0);
}
/// Where a packed copy of the primitives stands: in the order of the leaves, for structures that hold each
/// about once; the same, each leaf a block of its own; or by id.
enum class PackedOrder { of_leaves, of_blocks, of_ids };

/// Some primitives, by id: `ids[first]` to `ids[first + count − 1]`.
struct Leaf {
    const PrimitiveId* ids;
    std::uint32_t first, count;
};

/// Holds one primitive against the query's probe and offers what comes of it.
template <class P, class Query>
Flow test_one(const P& set, const RayProbe<typename P::Scalar, P::dimension>& probe, PrimitiveId id,
              Query& query) {
    if constexpr (MeetsRays<P>) {
        const auto m = set.meet(id, probe.ray());
        if (!m) return Flow::go_on;
        // A structure only knows the box: a meeting outside of it would depend on the structure.
        if (!probe.meets_within_error(set.bounds(id), m->t)) return Flow::go_on;
        return query.offer({m->t, m->u, m->v, id});
    } else {
        return Flow::go_on;  // rays pass between points
    }
}
template <HasClosestPoint P, class Query>
Flow test_one(const P& set, const PointProbe<typename P::Scalar, P::dimension>& probe, PrimitiveId id,
              Query& query) {
    const auto q = set.closest_point(id, probe.point());
    return query.offer({distance2(probe.point(), q), id, q});
}
template <OverlapsBoxes P, class Query>
Flow test_one(const P& set, const BoxProbe<typename P::Scalar, P::dimension>& probe, PrimitiveId id,
              Query& query) {
    return set.overlaps(id, probe.box()) ? query.offer({id}) : Flow::go_on;
}

/// A whole leaf, one by one. A set with something faster has a member `test_leaf(probe, leaf, query)`.
template <PrimitiveSet P, class Probe, class Query>
Flow test_leaf(const P& set, const Probe& probe, const Leaf& leaf, Query& query) {
    if constexpr (requires { set.test_leaf(probe, leaf, query); }) {
        return set.test_leaf(probe, leaf, query);
    } else {
        for (std::uint32_t i = 0; i < leaf.count; ++i)
            if (test_one(set, probe, leaf.ids[leaf.first + i], query) == Flow::stop) return Flow::stop;
        return Flow::go_on;
    }
}

/// The id that a hit reports for a primitive: its own, or what the set says (a triangle's face in its file).
template <class P>
std::uint32_t reported_id(const P& set, PrimitiveId i, std::uint32_t instance) {
    if constexpr (Instanced<P>)
        return set.id(i, instance);
    else if constexpr (requires { set.id(i); })
        return set.id(i);
    else
        return i;
}

/// The geometry that a hit reports: of instances what their owner gave them, else 0.
template <class P>
std::uint32_t reported_geometry(const P& set, std::uint32_t instance) {
    if constexpr (requires { set.geometry(instance); })
        return set.geometry(instance);
    else
        return 0;
}

/// A set that only looks at arrays: `view()` of an owner, or the set itself. Indexes hold views.
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
