/// The signed crossings of a ray along an axis: the winding number of a closed surface about its origin.
#pragma once

#include <algorithm>
#include <bit>
#include <optional>
#include <vector>

#include <hedgerow/base/scratch.h>
#include <hedgerow/geometry/axis_ray.h>
#include <hedgerow/primitives/boundary.h>
#include <hedgerow/walks/query.h>

namespace hedgerow {

/// The sum of the crossings' signs, how many there are, and whether the ray's origin is on a primitive. Where
/// it is, the search ends, unless told otherwise.
struct CrossingCount {
    std::int64_t winding = 0;
    std::size_t crossings = 0;
    bool on = false;

    void add(int sign) {
        winding += sign;
        ++crossings;
    }
};

/// A ray along an axis, and the box without width from its origin to where it leaves the bounds of a set: a
/// walk to what the ray crosses compares coordinates, and nothing is rounded.
template <std::floating_point T, int D>
struct RayInBounds {
    AxisRay<D> ray;
    Box<T, D> box;

    const Vec<T, D>& origin() const { return ray.direction > 0 ? box.low : box.high; }
};
/// The ray from a point that leaves bounds soonest.
template <std::floating_point T, int D>
RayInBounds<T, D> soonest_out(const Vec<T, D>& p, const Box<T, D>& bounds) {
    // Way 2k leads up along axis k, way 2k + 1 down. Found without branches, which would often be mistaken.
    T length[2 * D], least = std::numeric_limits<T>::infinity();
    for (int k = 0; k < D; ++k)
        length[2 * k] = bounds.high[k] - p[k], length[2 * k + 1] = p[k] - bounds.low[k];
    for (const T l : length) least = std::min(least, l);
    unsigned soonest = 1u << (2 * D - 1);  // any way from a point that is NaN
    for (int i = 0; i < 2 * D; ++i) soonest |= static_cast<unsigned>(length[i] == least) << i;
    const int way = std::countr_zero(soonest);
    const int axis = way / 2, downward = way % 2;
    RayInBounds<T, D> out{{Vec<double, D>(p), axis, 1 - 2 * downward}, {p, p}};
    Vec<T, D>* const ends[] = {&out.box.high, &out.box.low};
    const Vec<T, D>* const bounds_there[] = {&bounds.high, &bounds.low};
    (*ends[downward])[axis] = (*bounds_there[downward])[axis];
    return out;
}

/// Sums the crossings of a ray with primitives of D corners.
template <class Set>
class SignedCrossings {
public:
    using Scalar = typename Set::Scalar;
    static constexpr int dimension = Set::dimension;
    using V = Vec<Scalar, dimension>;
    using Probe = BoxProbe<Scalar, dimension>;
    static constexpr Order order = Order::none;

    /// Where structures offer a primitive several times, crossings are collected, and repeated ones are
    /// removed. With `past_surface` the search does not end where the origin is
    /// on a primitive, which then counts as behind it.
    template <class I>
    SignedCrossings(const I& index, const RayInBounds<Scalar, dimension>& asked, bool past_surface)
        : set_(index.primitives()), ray_(asked.ray), probe_(asked.box), past_surface_(past_surface) {
        if (!index.structure().exclusive()) several_.emplace()->clear();
    }

    const Probe& probe() const { return probe_; }
    Scalar limit() const { return std::numeric_limits<Scalar>::max(); }
    Flow offer(const OverlapCandidate& c) { return offer(set_.corners(c.element), c.element); }
    /// A primitive whose box overlaps the ray.
    Flow offer(const std::array<V, static_cast<std::size_t>(dimension)>& corners, PrimitiveId id) {
        std::array<Vec<double, dimension>, static_cast<std::size_t>(dimension)> wide;
        for (std::size_t i = 0; i < wide.size(); ++i) wide[i] = Vec<double, dimension>(corners[i]);
        const AxisCrossing found = crossing(ray_, wide);
        if (found.on) {
            count_.on = true;
            return past_surface_ ? Flow::go_on : Flow::stop;
        }
        if (found.sign == 0) return Flow::go_on;
        if (several_)
            (*several_)->push_back({id, found.sign});
        else
            count_.add(found.sign);
        return Flow::go_on;
    }
    CrossingCount answer() {
        if (several_) {
            auto& all = **several_;
            std::sort(all.begin(), all.end());
            all.erase(std::unique(all.begin(), all.end()), all.end());
            for (const auto& [id, sign] : all) count_.add(sign);
        }
        return count_;
    }

private:
    const Set& set_;
    AxisRay<dimension> ray_;
    Probe probe_;
    std::optional<Scratch<std::vector<std::pair<PrimitiveId, int>>>> several_;
    bool past_surface_;
    CrossingCount count_;
};

namespace detail {

/// The leaves of an index, as crossings are counted in them: by the corners of primitives whose boxes overlap
/// the ray.
template <class I>
class CrossedLeaves {
public:
    explicit CrossedLeaves(const I& index) : index_(index) {}

    template <class Probe, class Query>
    Flow test_leaf(const Probe& probe, const Leaf& leaf, Query& query) const {
        const auto& box = probe.box();
        if constexpr (requires {
                          index_.packed().for_each_overlapping(leaf, box, [](const auto&, auto) {});
                      }) {
            Flow flow = Flow::go_on;
            index_.packed().for_each_overlapping(leaf, box, [&](const auto& t, PrimitiveId id) {
                if (flow == Flow::go_on) flow = query.offer({t.a, t.b, t.c}, id);
            });
            return flow;
        } else {
            for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
                const auto corners = index_.primitives().corners(leaf.ids[i]);
                Box<typename I::Scalar, I::dimension> around;
                for (const auto& c : corners) around.expand(c);
                if (overlap(around, box) && query.offer(corners, leaf.ids[i]) == Flow::stop)
                    return Flow::stop;
            }
            return Flow::go_on;
        }
    }

private:
    const I& index_;
};

}  // namespace detail

}  // namespace hedgerow
