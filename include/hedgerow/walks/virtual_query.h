/// A query behind virtual calls, so that a walk is compiled once for all queries of a probe.
#pragma once

#include <hedgerow/parallel/executor.h>
#include <hedgerow/walks/query.h>

namespace hedgerow {

namespace detail {
template <class Probe>
inline constexpr bool is_region_probe = false;
template <Region R>
inline constexpr bool is_region_probe<RegionProbe<R>> = true;

/// Whether a query may take subtrees whole.
template <class Q>
bool takes_subtrees(const Q& query) {
    if constexpr (requires { query.takes_subtrees(); })
        return query.takes_subtrees();
    else
        return SubtreeQuery<Q>;
}
}  // namespace detail

/// A node of any tree, as the `accept` of a query behind virtual calls sees it (WalkedNode).
template <int D>
class SubtreeRef {
public:
    using ForEachLeaf = FunctionRef<void(FunctionRef<void(const Leaf&)>)>;

    SubtreeRef(NodeId id, const Box<double, D>& volume, FunctionRef<std::size_t()> count,
               ForEachLeaf for_each_leaf)
        : id_(id), volume_(volume), count_(count), for_each_leaf_(for_each_leaf) {}

    NodeId id() const { return id_; }
    /// The box around the node's volume.
    const Box<double, D>& volume() const { return volume_; }
    std::size_t count() const { return count_(); }
    template <class F>
    void for_each_leaf(F f) const {
        for_each_leaf_(f);
    }

private:
    NodeId id_;
    Box<double, D> volume_;
    FunctionRef<std::size_t()> count_;
    ForEachLeaf for_each_leaf_;
};

/// What a walk sees of any query of probe P. The limit is stored here, so that only offers are virtual calls.
/// A query of a region is also asked whether it takes a subtree, but only one that lies in the region: the
/// walk itself tests that.
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
    bool done() const { return done_; }
    bool takes_subtrees() const { return takes_subtrees_; }
    virtual Flow offer(const CandidateOf<Probe>& candidate) = 0;
    template <class Node>
    Verdict accept(const Node& node) requires detail::is_region_probe<Probe> {
        if constexpr (requires { node.volume(); }) {
            if (!takes_subtrees_) return Verdict::open;
            if (done_) return Verdict::prune;
            const auto& volume = node.volume();
            if (!takes_whole(probe_.region(), volume)) return Verdict::open;
            const auto count = [&] { return node.count(); };
            const auto for_each_leaf = [&](FunctionRef<void(const Leaf&)> f) { node.for_each_leaf(f); };
            return take({node.id(), wide_box(volume), count, for_each_leaf});
        } else {
            return Verdict::open;
        }
    }

protected:
    /// The probe has to outlive the walk.
    template <class Q>
    VirtualQuery(const Probe& probe, const Q& query)
        : probe_(probe), takes_subtrees_(detail::takes_subtrees(query)) {
        follow(query);
    }
    ~VirtualQuery() = default;

    /// What the query says of a subtree that lies in its region.
    virtual Verdict take(const SubtreeRef<Probe::dimension>& node) = 0;

    /// Copies what the query has become. One that is done has no limit.
    template <class Q>
    void follow(const Q& query) {
        done_ = hedgerow::done(query);
        if (!done_) limit_ = query.limit();
    }

private:
    template <class V>
    static Box<double, Probe::dimension> wide_box(const V& volume) {
        if constexpr (requires { box_around(volume); })
            return box_around(volume);
        else
            return detail::in_double(volume);
    }

    const Probe& probe_;
    Scalar limit_ = 0;
    bool done_ = false, takes_subtrees_;
};

/// A query as a VirtualQuery. The query must outlive the VirtualQuery.
template <Query Q>
class Virtual final : public VirtualQuery<typename Q::Probe> {
public:
    using Base = VirtualQuery<typename Q::Probe>;

    explicit Virtual(Q& query) : Base(std::as_const(query).probe(), query), query_(query) {}

    Flow offer(const CandidateOf<typename Q::Probe>& candidate) override {
        const Flow flow = query_.offer(candidate);
        Base::follow(query_);
        return flow;
    }

private:
    Verdict take(const SubtreeRef<Q::Probe::dimension>& node) override {
        if constexpr (SubtreeQuery<Q>) {
            const Verdict verdict = query_.accept(node);
            Base::follow(query_);
            return verdict;
        } else {
            return Verdict::open;
        }
    }

    Q& query_;
};

/// A query behind virtual calls that tests leaves itself: one call a leaf, inside which both the set and the
/// query are known at compile time. The limit is what it is after the leaf.
template <class P>
class LeafQuery : public VirtualQuery<P> {
public:
    virtual Flow test(const Leaf& leaf) = 0;
    virtual void prefetch(const Leaf& leaf) const = 0;

protected:
    using VirtualQuery<P>::VirtualQuery;
    ~LeafQuery() = default;
};

/// A query over the leaves of a set as a LeafQuery, with the query's own probe or another that enters the
/// same cells. All three must outlive it.
template <Query Q, class Leaves, class Probe = typename Q::Probe>
class LeafTests final : public LeafQuery<Probe> {
public:
    using Base = LeafQuery<Probe>;

    LeafTests(const Probe& probe, Q& query, const Leaves& leaves)
        : Base(probe, query), query_(query), leaves_(leaves) {}

    Flow test(const Leaf& leaf) override {
        return after(test_leaf(leaves_, std::as_const(query_).probe(), leaf, query_));
    }
    void prefetch(const Leaf& leaf) const override {
        if constexpr (requires { leaves_.prefetch(leaf); }) leaves_.prefetch(leaf);
    }
    Flow offer(const CandidateOf<Probe>& candidate) override { return after(query_.offer(candidate)); }

private:
    Verdict take(const SubtreeRef<Probe::dimension>& node) override {
        if constexpr (SubtreeQuery<Q>)
            return after(query_.accept(node));
        else
            return Verdict::open;
    }
    template <class Said>
    Said after(Said said) {
        Base::follow(query_);
        return said;
    }

    Q& query_;
    const Leaves& leaves_;
};

/// The leaves of a walk whose query tests them itself.
template <class Probe>
struct LeavesOfQuery {
    LeafQuery<Probe>& query;

    Flow test_leaf(const Probe&, const Leaf& leaf, LeafQuery<Probe>&) const { return query.test(leaf); }
    void prefetch(const Leaf& leaf) const { query.prefetch(leaf); }
};

}  // namespace hedgerow
