/// The walk of an index to a ray's closest hit, step by step.
#pragma once

#include <optional>
#include <unordered_map>

#include <hedgerow/ask.h>
#include <hedgerow/walks/outline.h>
#include <hedgerow/walks/trace_log.h>

namespace hedgerow {

/// A primitive of a visited leaf.
template <std::floating_point T>
struct TraceTest {
    PrimitiveId id;
    /// Whether a mailbox skipped the primitive, since an earlier leaf had tested it.
    bool skipped = false;
    /// The hit's t, if the primitive is hit within the limit.
    std::optional<T> t = std::nullopt;
};

/// A visit of a cell.
template <std::floating_point T, int D>
struct TraceStep {
    OutlineCell<D> cell;
    /// The ray's interval in the cell as the walk computes it, up to the limit: some roundings longer than
    /// the true one.
    Interval<T> inside{};
    /// The t of the nearest hit so far, or the ray's end: cells that begin beyond are pruned.
    T limit = T(0);
    /// The tests of a leaf, if its primitives were tested.
    std::vector<TraceTest<T>> tests;
};

template <std::floating_point T, int D>
struct Trace {
    std::vector<TraceStep<T, D>> steps;
    Hit<T> hit;
    Visits visits;
};

namespace detail {

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

/// Calls a function for the cells of a structure within limits (`visit_outline`).
template <int D>
using CellLister = FunctionRef<void(const OutlineLimits<D>&, CellVisitor<D>)>;

/// The steps of a recorded walk, with the cells that its places identify. Only visited cells and their
/// siblings are listed. Empty if a visited cell is not within the limits.
template <class T, int D>
std::vector<TraceStep<T, D>> steps_of(const CellLister<D>& visit_cells, const RayProbe<T, D>& probe,
                                      const TraceLog<T, D>& log, const OutlineLimits<D>& limits) {
    const auto key = [](const Place& p) { return std::uint64_t(p.first) << 32 | p.second; };
    std::unordered_map<std::uint64_t, std::optional<OutlineCell<D>>> visited;
    for (const auto& e : log.entries) visited[key(e.place)] = std::nullopt;
    // Find the cell of each visited place.
    visit_cells(limits, [&](const OutlineCell<D>& cell) {
        const auto found = visited.find(key(cell.place));
        if (found == visited.end() || found->second) return false;
        found->second = cell;
        return true;
    });
    // Each entry becomes a step.
    std::vector<TraceStep<T, D>> steps;
    for (const auto& e : log.entries) {
        const auto& cell = visited[key(e.place)];
        if (!cell) return {};
        TraceStep<T, D> step{*cell, {}, e.limit, {}};
        const Box<T, D> box{Vec<T, D>(cell->box.low), Vec<T, D>(cell->box.high)};
        step.inside = e.inside ? *e.inside : probe.inside(box, e.limit);
        step.inside.exit = std::min(step.inside.exit, e.limit);
        // List what became of each primitive of a tested leaf.
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

/// A box around the ray's part in a scene. Only few of a grid's cells are in it.
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

/// Traces the query of a ray's closest hit on an index whose cells `visit_cells` lists.
template <class Index, std::floating_point T, int D>
Trace<T, D> trace_over(const Index& index, const Ray<T, D>& ray,
                       const std::type_identity_t<CellLister<D>>& visit_cells) {
    TraceLog<T, D> log;
    Trace<T, D> found;
    found.hit = index.template answer<TracedClosestHit<typename Index::Primitives>>(log, ray, log);
    found.visits = log.visits;
    if (log.entries.empty()) return found;
    in_ieee_mode([&] {
        const RayProbe<T, D> probe(ray, index.bounds());
        OutlineLimits<D> near;
        near.within = around(probe, index.bounds());
        found.steps = steps_of<T, D>(visit_cells, probe, log, near);
        // A ray from very far visits cells outside that box: search all cells.
        if (found.steps.empty()) found.steps = steps_of<T, D>(visit_cells, probe, log, {});
    });
    return found;
}

}  // namespace detail

/// Traces the query of a ray's closest hit. The walk and its visits are those of `closest_hit` without a
/// kernel. The cells of the steps point into the structure. Costs several times as much as the query;
/// allocates.
template <class S, class P>
Trace<typename P::Scalar, P::dimension> trace(const Index<S, P>& index,
                                              const Ray<typename P::Scalar, P::dimension>& ray) {
    constexpr int D = P::dimension;
    return detail::trace_over(index, ray, [&](const OutlineLimits<D>& limits, CellVisitor<D> visit) {
        visit_outline(index.structure(), limits, visit);
    });
}

}  // namespace hedgerow
