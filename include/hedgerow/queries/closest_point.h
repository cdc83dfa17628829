/// The point of the primitives closest to a given point.
#pragma once

#include <optional>

#include <hedgerow/walks/query.h>

namespace hedgerow {

/// A primitive's closest point and its squared distance. `element` is the primitive's position in its set,
/// `primitive` its id. Equal distances go to the lowest (instance, element).
template <std::floating_point T, int D>
struct Near {
    T distance2 = std::numeric_limits<T>::infinity();
    std::uint32_t primitive = 0xFFFFFFFFu, element = 0xFFFFFFFFu;
    Vec<T, D> point;
    std::uint32_t instance = 0;

    friend bool operator==(const Near&, const Near&) = default;
};

/// The order of answers: by (distance², instance, element).
template <class N>
bool nearer(const N& a, const N& b) {
    return a.distance2 != b.distance2 ? a.distance2 < b.distance2 : comes_before(a, b);
}

/// The closest point within max_distance2 (squared, included).
template <class Set>
class ClosestPoint {
public:
    using Scalar = typename Set::Scalar;
    static constexpr int dimension = Set::dimension;
    using Probe = PointProbe<Scalar, dimension>;
    static constexpr Order order = Order::nearest;

    template <class Index>
    ClosestPoint(const Index& index, const Vec<Scalar, dimension>& p, Scalar max_distance2)
        : probe_(p), set_(index.primitives()) {
        best_.distance2 = max_distance2;
        best_.instance = best_.element;  // none, so any candidate comes before it
    }

    const Probe& probe() const { return probe_; }
    Scalar limit() const { return best_.distance2; }
    Flow offer(const PointCandidate<Scalar, dimension>& c) {
        if (c.distance2 < best_.distance2 || (c.distance2 == best_.distance2 && comes_before(c, best_)))
            best_ = {c.distance2, 0, c.element, c.point, c.instance};
        return Flow::go_on;
    }
    std::optional<Near<Scalar, dimension>> answer() const {
        if (best_.element == Near<Scalar, dimension>{}.element) return std::nullopt;
        auto found = best_;
        found.primitive = reported_id(set_, best_.element, best_.instance);
        return found;
    }

private:
    Probe probe_;
    const Set& set_;
    Near<Scalar, dimension> best_;
};

}  // namespace hedgerow
