/// The record of a walk, from which a trace is made (trace.h).
#pragma once

#include <concepts>
#include <optional>
#include <utility>
#include <vector>

#include <hedgerow/walks/visits.h>

namespace hedgerow::detail {

/// A Count that records the walk too, unless recording is switched off. The query adds the limit and the
/// candidates that it is offered.
template <std::floating_point T, int D>
class TraceLog {
public:
    explicit TraceLog(bool recording = true) : recording_(recording) {}

    struct Entry {
        Place place;
        std::optional<Interval<T>> inside;
        T limit;
        bool looked_into = false;  // its primitives were tested
        std::vector<PrimitiveId> skipped = {};
        std::vector<std::pair<PrimitiveId, T>> offered = {};
    };

    void node(const Place& place) {
        visits.node();
        if (recording_) add(place, std::nullopt);
    }
    void node(const Place& place, const Interval<T>& inside) {
        visits.node();
        if (recording_) add(place, inside);
    }
    void leaf(std::uint64_t count, const Place& place) {
        visits.leaf(count);
        if (recording_) look_into(place, std::nullopt);
    }
    void leaf(std::uint64_t count, const Place& place, const Interval<T>& inside) {
        visits.leaf(count);
        if (recording_) look_into(place, inside);
    }
    void own(PrimitiveId id) {
        visits.own(id);
        if (recording_) entries.back().looked_into = true;
    }
    void skip(PrimitiveId id) {
        visits.skip(id);
        if (recording_) entries.back().skipped.push_back(id);
    }

    Visits visits;
    T limit = T(0);
    std::vector<Entry> entries;

private:
    void add(const Place& place, const std::optional<Interval<T>>& inside) {
        entries.push_back({place, inside, limit});
    }
    /// A grid counts a cell as a node, and again as a leaf if the cell has primitives: both are one entry.
    void look_into(const Place& place, const std::optional<Interval<T>>& inside) {
        if (entries.empty() || entries.back().place != place) add(place, inside);
        entries.back().looked_into = true;
    }

    bool recording_;
};

/// Calls walk(count) with what counts behind virtual calls: a TraceLog for rays, whose visits are added, and
/// Visits for all else. Nobody reads those of a NoVisits.
template <class Probe, class Count, class Walk>
void count_virtually(Count& count, Walk walk) {
    using Log = TraceLog<typename Probe::Scalar, Probe::dimension>;
    constexpr bool of_rays = std::same_as<Probe, RayProbe<typename Probe::Scalar, Probe::dimension>>;
    if constexpr (std::same_as<std::remove_const_t<Count>, NoVisits>) {
        Visits nobodys;
        count_virtually<Probe>(nobodys, walk);
    } else if constexpr (of_rays && std::same_as<Count, Visits>) {
        Log log(false);
        walk(log);
        count += log.visits;
    } else {
        walk(count);
    }
}

}  // namespace hedgerow::detail
