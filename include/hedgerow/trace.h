/// What an index does to find a ray's closest hit, step by step.
#pragma once

#include <unordered_map>

#include <hedgerow/ask.h>
#include <hedgerow/structures/outline.h>

namespace hedgerow {

/// A primitive of a visited leaf.
template <std::floating_point T>
struct TraceTest {
    PrimitiveId id;
    /// It had been tested in an earlier leaf: a mailbox knew.
    bool skipped = false;
    /// Where it is met, if it is met within the limit.
    std::optional<T> t = std::nullopt;
};

/// A visit of a cell.
template <std::floating_point T, int D>
struct TraceStep {
    OutlineCell<D> cell;
    /// The ray's part in the cell as the walk sees it, up to the limit: some roundings longer than it is.
    Interval<T> inside{};
    /// Where the nearest hit so far lies (or the ray ends): what begins beyond is passed over.
    T limit = T(0);
    /// Of a leaf that was looked into.
    std::vector<TraceTest<T>> tests;
};

template <std::floating_point T, int D>
struct Trace {
    std::vector<TraceStep<T, D>> steps;
    std::optional<Hit<T>> hit;
    Visits visits;
};

namespace detail {

/// The Count that listens, and what the query tells it.
template <std::floating_point T, int D>
class TraceLog {
public:
    struct Entry {
        Place place;
        std::optional<Interval<T>> inside;
        T limit;
        bool looked_into = false;  // its primitives were tested
        std::vector<PrimitiveId> skipped = {};
        std::vector<std::pair<PrimitiveId, T>> offered = {};
    };

    void node(const Place& place) { visits.node(), add(place, std::nullopt); }
    void node(const Place& place, const Interval<T>& inside) { visits.node(), add(place, inside); }
    void leaf(std::uint64_t count, const Place& place) { visits.leaf(count), look_into(place, std::nullopt); }
    void leaf(std::uint64_t count, const Place& place, const Interval<T>& inside) {
        visits.leaf(count), look_into(place, inside);
    }
    void own(PrimitiveId id) { visits.own(id), entries.back().looked_into = true; }
    void skip(PrimitiveId id) { visits.skip(id), entries.back().skipped.push_back(id); }

    Visits visits;
    T limit = T(0);
    std::vector<Entry> entries;

private:
    void add(const Place& place, const std::optional<Interval<T>>& inside) {
        entries.push_back({place, inside, limit});
    }
    /// A grid counts a cell as a node, and then as a leaf if something stands in it: one step.
    void look_into(const Place& place, const std::optional<Interval<T>>& inside) {
        if (entries.empty() || entries.back().place != place) add(place, inside);
        entries.back().looked_into = true;
    }
};

template <class Set>
class TracedClosestHit : public ClosestHit<Set> {
public:
    using Base = ClosestHit<Set>;
    using Scalar = typename Base::Scalar;
    using Log = TraceLog<Scalar, Set::dimension>;

    template <class Index, class Ray>
    TracedClosestHit(const Index& index, const Ray& ray, Log& log) : Base(index, ray), log_(log) {
        log_.limit = this->limit();
    }
    Flow offer(const RayCandidate<Scalar>& c) {
        if (c.t <= this->limit()) log_.entries.back().offered.push_back({c.element, c.t});
        const Flow flow = Base::offer(c);
        log_.limit = this->limit();
        return flow;
    }

private:
    Log& log_;
};

/// What the walk's places stand for. Only cells that were visited, and those beside them, are looked at.
template <class S, class T, int D>
std::vector<TraceStep<T, D>> steps_of(const S& structure, const RayProbe<T, D>& probe,
                                      const TraceLog<T, D>& log, const OutlineLimits<D>& limits) {
    const auto key = [](const Place& p) { return std::uint64_t(p.first) << 32 | p.second; };
    std::unordered_map<std::uint64_t, std::optional<OutlineCell<D>>> visited;
    for (const auto& e : log.entries) visited[key(e.place)] = std::nullopt;
    visit_outline(structure, limits, [&](const OutlineCell<D>& cell) {
        const auto found = visited.find(key(cell.place));
        if (found == visited.end() || found->second) return false;
        found->second = cell;
        return true;
    });
    std::vector<TraceStep<T, D>> steps;
    for (const auto& e : log.entries) {
        const auto& cell = visited[key(e.place)];
        if (!cell) return {};
        TraceStep<T, D> step{*cell, {}, e.limit, {}};
        const Box<T, D> box{Vec<T, D>(cell->box.low), Vec<T, D>(cell->box.high)};
        step.inside = e.inside ? *e.inside : probe.inside(box, e.limit);
        step.inside.exit = std::min(step.inside.exit, e.limit);
        for (const PrimitiveId id : e.looked_into ? cell->items : std::span<const PrimitiveId>()) {
            TraceTest<T> test{id};
            test.skipped = std::find(e.skipped.begin(), e.skipped.end(), id) != e.skipped.end();
            for (const auto& [offered, t] : e.offered)
                if (offered == id) test.t = t;
            step.tests.push_back(test);
        }
        steps.push_back(std::move(step));
    }
    return steps;
}

/// Around the ray's part in a scene: of a grid, the cells there are few among all.
template <class T, int D>
Box<double, D> around(const RayProbe<T, D>& probe, const Box<T, D>& scene) {
    const Interval<T> in = probe.inside(scene, probe.ray().t_max);
    Box<double, D> box;
    for (const T t : {in.entry, in.exit})
        box.expand(Vec<double, D>(probe.ray().origin) +
                   Vec<double, D>(probe.ray().direction) * static_cast<double>(t));
    const auto margin = Vec<double, D>::all(8 * static_cast<double>(probe.slack()));
    return {box.low - margin, box.high + margin};
}

}  // namespace detail

/// The walk is the one that `closest_hit` takes, and visits are counted alike. A step's cell points into the
/// structure. Costs some times what the query does; allocates.
template <class S, class P>
Trace<typename P::Scalar, P::dimension> trace(const Index<S, P>& index,
                                              const Ray<typename P::Scalar, P::dimension>& ray) {
    using T = typename P::Scalar;
    constexpr int D = P::dimension;
    detail::TraceLog<T, D> log;
    Trace<T, D> found;
    found.hit = index.template answer<detail::TracedClosestHit<P>>(log, ray, log);
    found.visits = log.visits;
    if (log.entries.empty()) return found;
    in_ieee_mode([&] {
        const RayProbe<T, D> probe(ray, index.bounds());
        OutlineLimits<D> near;
        near.within = detail::around(probe, index.bounds());
        found.steps = detail::steps_of(index.structure(), probe, log, near);
        // A ray from very far visits cells beside its own.
        if (found.steps.empty()) found.steps = detail::steps_of(index.structure(), probe, log, {});
    });
    return found;
}

}  // namespace hedgerow
