/// The pairs of points that are within a distance of each other: of two sets, or of one.
#pragma once

#include <algorithm>
#include <compare>
#include <utility>

#include <hedgerow/queries/point_query.h>
#include <hedgerow/walks/pairs.h>

namespace hedgerow {

/// A pair of points, by their positions in their sets, and their squared distance.
template <std::floating_point T>
struct PairWithin {
    PrimitiveId a, b;
    T distance2;
    friend auto operator<=>(const PairWithin&, const PairWithin&) = default;
};

/// The pairs within a squared distance (included), measured as `closest_point` does: in double, and rounded
/// once. Calls `found(i, j, distance2)`, which returns whether to go on; of one set with i < j. Structures
/// that hold a point in several leaves may call it several times for a pair.
template <class A, class B, class Found = Flow (*)(PrimitiveId, PrimitiveId, typename A::Scalar)>
class PairsWithin {
public:
    using Scalar = typename A::Scalar;
    using BoxType = Box<Scalar, A::dimension>;
    using Boxed = BoxedLeaf<Scalar, A::dimension>;
    static constexpr Order order = Order::none;

    /// With `one`, a and b are one set, which is walked with itself.
    PairsWithin(const A& a, const B& b, Scalar max_distance2, Found found, bool one = false)
        : a_(a),
          b_(b),
          max_(max_distance2),
          limit_(limit_of_boxes(max_)),
          found_(std::move(found)),
          one_(one) {}

    static Scalar bound(const BoxType& a, const BoxType& b) { return distance2(a, b); }
    Scalar limit() const { return limit_; }
    Flow offer(const Boxed& a, const Boxed& b) {
        for (std::uint32_t i = 0; i < a.items.count; ++i) {
            const PrimitiveId of_a = a.items.ids[a.items.first + i];
            const auto p = a_.point(of_a);
            if (distance2(p, b.box) <= limit_ && offer(of_a, p, b.items, 0) == Flow::stop) return Flow::stop;
        }
        return Flow::go_on;
    }
    Flow offer(const Boxed& leaf) {
        for (std::uint32_t i = 0; i < leaf.items.count; ++i) {
            const PrimitiveId id = leaf.items.ids[leaf.items.first + i];
            if (offer(id, a_.point(id), leaf.items, i + 1) == Flow::stop) return Flow::stop;
        }
        return Flow::go_on;
    }

private:
    /// Tests a point against those of a leaf from number `first` on.
    Flow offer(PrimitiveId of_a, const Vec<Scalar, A::dimension>& p, const Leaf& leaf, std::uint32_t first) {
        for (std::uint32_t j = leaf.first + first; j < leaf.first + leaf.count; ++j) {
            PrimitiveId x = of_a, y = leaf.ids[j];
            const Scalar d2 = closest_point(p, b_.point(y)).distance2;
            if (!(d2 <= max_)) continue;
            if (one_ && x == y) continue;
            if (one_ && y < x) std::swap(x, y);
            if (found_(x, y, d2) == Flow::stop) return Flow::stop;
        }
        return Flow::go_on;
    }

    const A& a_;
    const B& b_;
    Scalar max_, limit_;
    Found found_;
    bool one_;
};

}  // namespace hedgerow
