/// The base of the queries of a point: the probe, and the answer that a candidate becomes.
#pragma once

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/radius.h>
#include <hedgerow/parallel/executor.h>
#include <hedgerow/queries/filter.h>
#include <hedgerow/queries/leave_out.h>
#include <hedgerow/queries/mask.h>
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

/// How far questions of a point look, how exactly, and by which threads: `closest_point(index, p, {.radius =
/// 2})`.
struct PointOptions {
    static constexpr double anywhere = std::numeric_limits<double>::infinity();

    /// The largest distance, included, by the rule of geometry/radius.h; and the largest squared one. Both
    /// hold. Nothing is within what is negative or NaN.
    double radius = anywhere, radius2 = anywhere;
    /// At least 1. The closest point, and each of the k nearest, is at most this many times as far away as
    /// the exact one of its place; distances are those of what is found. Parts that could only improve on an
    /// answer by less are not looked at (Arya et al. 1998). The answer depends on the structure alone, and is
    /// found by a walk.
    double factor = 1;
    LeaveOut leave_out = {};
    Mask mask = {};
    Threads threads = {};  ///< of a batch
};

/// The options of one query, as its walk reads them. Views their mask.
template <std::floating_point T>
struct NearLimits {
    T distance2;  ///< the largest squared distance, finite; nothing is within what is negative or NaN
    T factor;
    PrimitiveId leave_out;
    const Mask* mask;  ///< null if there is none

    /// Throws InputError for a factor that is not at least 1.
    explicit NearLimits(const PointOptions& options = {}, std::size_t query = 0)
        : NearLimits(options, Without{options.leave_out.of(query)}) {}
    /// Those of a batch, which leave out nothing.
    static NearLimits of_batch(const PointOptions& options) {
        return NearLimits(options, Without{no_primitive});
    }
    /// Whether all that is near is answered, and exactly.
    bool plain() const { return factor == 1 && leave_out == no_primitive && mask == nullptr; }
    /// Whether nothing is within them.
    bool nothing() const { return !(distance2 >= 0); }
    /// The limit of a walk that has found something at a squared distance.
    T after(T found_distance2) const {
        return factor == 1 ? found_distance2 : found_distance2 / product(factor, factor);
    }

private:
    struct Without {
        PrimitiveId element;
    };
    NearLimits(const PointOptions& options, Without without)
        : distance2(square_within<T>(options.radius)),
          factor(options.factor == 1 ? T(1) : greatest_at_most<T>(options.factor)),
          leave_out(without.element),
          mask(options.mask.none() ? nullptr : &options.mask) {
        if (!(factor >= 1)) throw InputError("the factor of a point's question is below 1: give 1 or more");
        if (!(static_cast<double>(distance2) < options.radius2))
            distance2 = greatest_at_most<T>(options.radius2);
    }
};

/// `Set` gives the ids that answers report; the filter may refuse answers (queries/hit.h).
template <class Set, class Filter = KeepAll, class AsProbe = PointProbe<typename Set::Scalar, Set::dimension>>
class PointQuery {
public:
    using Scalar = typename Set::Scalar;
    static constexpr int dimension = Set::dimension;
    using Probe = AsProbe;
    using Candidate = PointCandidate<Scalar, dimension>;
    using Found = Near<Scalar, dimension>;

    template <class Index>
    PointQuery(const Index& index, const Vec<Scalar, dimension>& p, const NearLimits<Scalar>& limits,
               const Filter& filter)
        : probe_(p), set_(index.primitives()), limits_(limits), filter_(filter) {}

    const Probe& probe() const { return probe_; }
    bool done() const { return limits_.nothing(); }
    /// Whether the options and the filter let an instance with this mask be queried.
    bool enters(std::uint32_t mask) const {
        return (limits_.mask == nullptr || limits_.mask->enters(mask)) && hedgerow::enters(filter_, mask);
    }

protected:
    const NearLimits<Scalar>& limits() const { return limits_; }
    Found found(const Candidate& c) const {
        return {c.distance2, reported_id(set_, c.element, c.instance), c.element, c.point, c.instance};
    }
    /// Whether a candidate counts that is near enough.
    bool counts(const Candidate& c) const {
        if (c.element == limits_.leave_out) return false;
        if (limits_.mask != nullptr && !limits_.mask->sees(c.element)) return false;
        if constexpr (std::same_as<Filter, KeepAll>)
            return true;
        else
            return keeps(filter_, 0, found(c));
    }

private:
    Probe probe_;
    const Set& set_;
    NearLimits<Scalar> limits_;
    [[no_unique_address]] Filter filter_;
};

}  // namespace hedgerow
