/// The base of the queries of a region: the probe, and when a subtree is taken whole.
#pragma once

#include <hedgerow/walks/query.h>

namespace hedgerow {

/// `Set` names the primitives. A query of an empty region is done before it begins.
template <class Set, Region R>
class RegionQuery {
public:
    using Scalar = typename Set::Scalar;
    using Probe = RegionProbe<R>;
    static constexpr Order order = Order::none;
    static_assert(std::same_as<Scalar, typename R::Scalar> && Set::dimension == R::dimension,
                  "a region has the scalar and the dimension of the index");

    template <class Index>
    RegionQuery(const Index& index, const R& region, Finds finds)
        : probe_(region, index.bounds(), finds), done_(is_empty(region)) {
        takes_subtrees_ = !Instanced<Set> && index.exclusive();
    }

    const Probe& probe() const { return probe_; }
    Scalar limit() const { return done_ ? Scalar(-1) : std::numeric_limits<Scalar>::max(); }
    bool done() const { return done_; }
    /// Whether subtrees in the region are taken whole: the index holds each primitive once.
    bool takes_subtrees() const { return takes_subtrees_; }

protected:
    /// Whether a subtree is taken whole: its volume lies in the region, and no primitive below it is anywhere
    /// else in the structure. Instances are always asked what is in them.
    template <class Node>
    bool takes(const Node& node) const {
        if constexpr (requires { node.volume(); })
            return takes_subtrees_ && takes_whole(probe_.region(), node.volume());
        else
            return false;
    }
    /// Ends the walk.
    void finish() { done_ = true; }

private:
    Probe probe_;
    bool done_, takes_subtrees_ = false;
};

}  // namespace hedgerow
