/// A query behind virtual calls, so that a walk is compiled once for all queries of a probe.
#pragma once

#include <hedgerow/walks/query.h>

namespace hedgerow {

/// What a walk sees of any query of probe P. The limit is stored here, so that only offers are virtual calls.
template <class P>
class VirtualQuery {
public:
    using Probe = P;
    using Scalar = typename Probe::Scalar;
    /// Box queries need no order: none of their candidates is nearer than another.
    static constexpr Order order =
        std::same_as<CandidateOf<Probe>, OverlapCandidate> ? Order::none : Order::nearest;

    VirtualQuery(const VirtualQuery&) = delete;
    VirtualQuery& operator=(const VirtualQuery&) = delete;

    const Probe& probe() const { return probe_; }
    Scalar limit() const { return limit_; }
    virtual Flow offer(const CandidateOf<Probe>& candidate) = 0;

protected:
    /// The probe has to outlive the walk.
    VirtualQuery(const Probe& probe, Scalar limit) : probe_(probe), limit_(limit) {}
    ~VirtualQuery() = default;

    void set_limit(Scalar limit) { limit_ = limit; }

private:
    const Probe& probe_;
    Scalar limit_;
};

/// A query as a VirtualQuery. The query must outlive the VirtualQuery.
template <Query Q>
class Virtual final : public VirtualQuery<typename Q::Probe> {
public:
    using Base = VirtualQuery<typename Q::Probe>;

    explicit Virtual(Q& query) : Base(std::as_const(query).probe(), query.limit()), query_(query) {}

    Flow offer(const CandidateOf<typename Q::Probe>& candidate) override {
        const Flow flow = query_.offer(candidate);
        Base::set_limit(query_.limit());
        return flow;
    }

private:
    Q& query_;
};

}  // namespace hedgerow
