/// The base of the ray queries: the options, the probe, the interval and the filter.
#pragma once

#include <hedgerow/parallel/executor.h>
#include <hedgerow/queries/filter.h>
#include <hedgerow/queries/leave_out.h>
#include <hedgerow/queries/mask.h>

namespace hedgerow {

/// What a question of rays leaves out or does not see, and by which threads a batch is answered. A ray has
/// its own `t_min` and `t_max`.
struct RayOptions {
    LeaveOut leave_out = {};
    Mask mask = {};
    Threads threads = {};
};

/// `Set` gives the ids that hits report, and `Filter` decides which candidates count. The query of an
/// unusable ray is done before it begins.
template <class Set, class Filter>
class RayQuery {
public:
    using Scalar = typename Set::Scalar;
    using Probe = RayProbe<Scalar, Set::dimension>;

    template <class Index, class Ray>
    RayQuery(const Index& index, const Ray& ray, const Filter& filter)
        : probe_(ray, index.bounds(), hit_error(index.primitives(), ray)),
          set_(index.primitives()),
          filter_(filter) {}

    const Probe& probe() const { return probe_; }
    bool done() const { return !probe_.usable(); }
    /// The end of the ray, unless a query has found a nearer one.
    Scalar limit() const { return probe_.ray().t_max; }
    /// Whether the filter lets an instance with this mask be queried.
    bool enters(std::uint32_t mask) const { return hedgerow::enters(filter_, mask); }
    /// Whether the filter keeps every hit, and whether it keeps this one.
    static constexpr bool keeps_all = std::is_same_v<Filter, KeepAll>;
    bool keeps(const Hit<Scalar>& hit) const { return hedgerow::keeps(filter_, 0, hit); }

protected:
    /// Whether a candidate is in the ray's interval, has a finite t and is not refused.
    bool counts(const RayCandidate<Scalar>& c) const {
        if (!(c.t >= probe_.ray().t_min && c.t <= probe_.ray().t_max) ||
            c.t > std::numeric_limits<Scalar>::max())
            return false;
        if constexpr (keeps_all)
            return true;
        else
            return keeps(hit(c));
    }
    Hit<Scalar> hit(const RayCandidate<Scalar>& c) const {
        return {c.t,
                c.u,
                c.v,
                reported_id(set_, c.element, c.instance),
                reported_geometry(set_, c.instance),
                c.instance,
                c.element};
    }

private:
    Probe probe_;
    const Set& set_;
    [[no_unique_address]] Filter filter_;
};

}  // namespace hedgerow
