/// The base of the queries of a point: the probe, and the answer that a candidate becomes.
#pragma once

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/radius.h>
#include <hedgerow/walks/query.h>

namespace hedgerow {

/// A primitive's closest point and its squared distance. `element` is the primitive's position in its set,
/// `primitive` its id. Equal distances go to the lowest (instance, element).
template <std::floating_point T, int D>
struct Near {
    T distance2 = std::numeric_limits<T>::infinity();
    std::uint32_t primitive = no_primitive, element = no_primitive;
    Vec<T, D> point;
    std::uint32_t instance = 0;

    /// False for the answer of a query that found nothing; its distance is infinite.
    explicit operator bool() const { return element != no_primitive; }
    friend bool operator==(const Near&, const Near&) = default;
};

/// The order of answers and candidates: by (distance², instance, element).
template <class A, class B>
bool nearer(const A& a, const B& b) {
    return a.distance2 != b.distance2 ? a.distance2 < b.distance2 : comes_before(a, b);
}

/// The limit of a walk for primitives within `distance2`. A primitive's distance is rounded once, but squares
/// and sums of its distance to a box are rounded in T, six times, and where they underflow by subnormal
/// steps; so the box may seem farther away than the primitive in it. Negative limits stay negative.
template <std::floating_point T>
T limit_of_boxes(T distance2) {
    constexpr T more = std::is_same_v<T, float> ? T(0x1p-20) : T(0x1p-48);
    return distance2 + product(distance2, more) + 4 * std::numeric_limits<T>::denorm_min();
}

/// How far questions of a point look, and how exactly: `closest_point(index, p, {.radius = 2})`.
template <std::floating_point T>
struct NearOptions {
    static constexpr T anywhere = std::numeric_limits<T>::max();

    /// The largest distance, included, by the rule of geometry/radius.h; and the largest squared one. Both
    /// hold. Nothing is within what is negative or NaN.
    T radius = anywhere, radius2 = anywhere;
    /// At least 1. The closest point, and each of the k nearest, is at most this many times as far away as
    /// the exact one of its place; distances are those of what is found. Parts that could only improve on an
    /// answer by less are not looked at (Arya et al. 1998). The answer depends on the structure alone, and is
    /// found by a walk.
    T factor = 1;

    /// The largest squared distance. Throws InputError for a factor that is not at least 1.
    T max_distance2() const {
        if (!(factor >= 1)) throw InputError("the factor of a point's question is below 1: give 1 or more");
        const T squared = largest_square_within(radius);
        return squared < radius2 ? squared : radius2;
    }
    /// The limit of a walk that has found something at a squared distance.
    T limit(T found_distance2) const {
        return factor == 1 ? found_distance2 : found_distance2 / product(factor, factor);
    }
};

/// `Set` gives the ids that answers report.
template <class Set>
class PointQuery {
public:
    using Scalar = typename Set::Scalar;
    static constexpr int dimension = Set::dimension;
    using Probe = PointProbe<Scalar, dimension>;
    using Candidate = PointCandidate<Scalar, dimension>;
    using Found = Near<Scalar, dimension>;

    template <class Index>
    PointQuery(const Index& index, const Vec<Scalar, dimension>& p) : probe_(p), set_(index.primitives()) {}

    const Probe& probe() const { return probe_; }

protected:
    Found found(const Candidate& c) const {
        return {c.distance2, reported_id(set_, c.element, c.instance), c.element, c.point, c.instance};
    }

private:
    Probe probe_;
    const Set& set_;
};

}  // namespace hedgerow
