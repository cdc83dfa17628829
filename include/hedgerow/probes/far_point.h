/// A point as a probe for what is farthest from it.
#pragma once

#include <hedgerow/geometry/box_rows.h>
#include <hedgerow/geometry/distance.h>
#include <hedgerow/geometry/lattice.h>
#include <hedgerow/geometry/slab.h>
#include <hedgerow/probes/concepts.h>

namespace hedgerow {

/// Volumes are entered at minus the squared distance to their farthest corner, so the farthest are nearest.
/// Boxes are measured in T, with the roundings of PointProbe. A tree of planes cuts the cell along its axes;
/// a plane askew leaves both sides the whole cell.
template <std::floating_point T, int D>
class FarProbe {
public:
    using Scalar = T;
    static constexpr int dimension = D;
    struct State {
        Box<T, D> cell;
        T at;
    };

    explicit FarProbe(const Vec<T, D>& point) : point_(point) {}
    const Vec<T, D>& point() const { return point_; }

    bool enter(const Box<T, D>& box, T limit, T& at) const {
        at = -farthest_distance2(point_, box);
        return at <= limit;
    }
    /// Computes four boxes at a time.
    unsigned enter(const BoxRows<T, D>& boxes, T limit, T* at) const {
        using L = Lanes<T>;
        return boxes.by_fours([&](int k) {
            L sum = L::all(T(0));
            for (int i = 0; i < D; ++i) {
                const L p = L::all(point_[i]);
                const L farther =
                    max(abs(p - L::load(boxes.low(i) + k)), abs(L::load(boxes.high(i) + k) - p));
                sum = sum + farther * farther;
            }
            (L::all(T(0)) - sum).store(at + k);
            return less_equal(L::all(T(0)) - sum, L::all(limit));
        });
    }
    /// Tests the box around any other volume (geometry/volumes.h).
    template <class Volume>
    requires requires(const Volume& v) { box_around(v); }
    bool enter(const Volume& volume, T limit, T& at) const {
        at = in_double(box_around(volume));
        return at <= limit;
    }
    template <class Pack>
    requires(Pack::width > 0) unsigned enter(const Pack& pack, T limit, T* at) const {
        return enter_each(*this, pack, limit, at);
    }

    State root(const Box<T, D>& box) const { return {box, -farthest_distance2(point_, box)}; }
    bool within(const State& s, T limit) const { return s.at <= limit; }
    Cut<State> cut(const State& s, const AxisPlane<T>& plane, T limit) const {
        Box<T, D> low = s.cell, high = s.cell;
        low.high[plane.axis] = high.low[plane.axis] = plane.position;
        const State of_low = root(low), of_high = root(high);
        const bool near_is_high = of_high.at < of_low.at;
        const State &near = near_is_high ? of_high : of_low, &far = near_is_high ? of_low : of_high;
        return {near_is_high, near, far, within(near, limit), within(far, limit)};
    }
    Cut<State> cut(const State& s, const CutPlane<D>&, T) const { return {false, s, s, true, true}; }

    /// Visits the cells of the lattice that reach beyond the limit, in their order.
    template <std::derived_from<Lattice<D>> Cells, class Limit, class Visit>
    void sweep(const Cells& lattice, Limit limit, Visit visit) const {
        typename Lattice<D>::Cell first{}, last{};
        for (std::size_t a = 0; a < D; ++a) last[a] = lattice.resolution[a] - 1;
        const auto reaches = [&](const auto& cell) {
            auto box = lattice.bounds(cell);
            box.low = box.low - lattice.pad, box.high = box.high + lattice.pad;
            return in_double(box) <= limit();
        };
        for_each_reached_cell(lattice, first, last, reaches,
                              [&](const auto& cell) { return visit(cell).flow == Flow::go_on; });
    }

private:
    /// The entry of a box in double, rounded away by more than roundings in T.
    T in_double(const Box<double, D>& box) const {
        const double most = farthest_distance2(Vec<double, D>(point_), box) * (1 + 0x1p-20);
        return -static_cast<T>(std::min(most, static_cast<double>(std::numeric_limits<T>::max()))) -
               4 * std::numeric_limits<T>::denorm_min();
    }

    Vec<T, D> point_;
};

}  // namespace hedgerow
