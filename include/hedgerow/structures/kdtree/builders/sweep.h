/// A sweep over every plane across an axis at which some part begins or ends (Wald and Havran, RT 2006).
#pragma once

#include <vector>

#include <hedgerow/structures/kdtree/builders/costs.h>

namespace hedgerow {

/// Where the part of a reference begins or ends along an axis. At equal positions ends come first: a part
/// that ends at a plane and a part that begins there are on different sides of the plane.
template <std::floating_point T>
struct KdEvent {
    T position;
    std::uint32_t reference_and_kind;

    KdEvent(T at, std::uint32_t reference, bool begins)
        : position(at), reference_and_kind(reference << 1 | static_cast<std::uint32_t>(begins)) {}
    std::uint32_t reference() const { return reference_and_kind >> 1; }
    bool begins() const { return (reference_and_kind & 1u) != 0; }
    friend bool operator<(const KdEvent& a, const KdEvent& b) {
        if (a.position != b.position) return a.position < b.position;
        return a.begins() != b.begins() ? b.begins() : a.reference() < b.reference();
    }
};

/// Offers the planes at all sorted events of `count` parts. O(events).
template <std::floating_point T, class AxisCosts>
void sweep_events(const std::vector<KdEvent<T>>& events, std::uint32_t count, const AxisCosts& costs,
                  KdBest<T>& best) {
    std::uint32_t on_low = 0, on_high = count;
    for (std::size_t i = 0; i < events.size();) {
        const T position = events[i].position;
        for (; i < events.size() && events[i].position == position && !events[i].begins(); ++i) --on_high;
        costs.offer(position, on_low, on_high, best);
        for (; i < events.size() && events[i].position == position; ++i) ++on_low;
    }
}

}  // namespace hedgerow
