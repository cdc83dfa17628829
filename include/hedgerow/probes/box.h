/// A box as a probe. It enters every volume that it overlaps, in no particular order.
#pragma once

#include <hedgerow/geometry/box_rows.h>
#include <hedgerow/geometry/lattice.h>
#include <hedgerow/geometry/overlap.h>
#include <hedgerow/probes/concepts.h>

namespace hedgerow {

template <std::floating_point T, int D>
class BoxProbe {
public:
    using Scalar = T;
    static constexpr int dimension = D;
    struct State {
        bool here;
    };

    explicit BoxProbe(const Box<T, D>& box) : box_(box) {}
    const Box<T, D>& box() const { return box_; }

    bool enter(const Box<T, D>& box, T, T& at) const {
        at = T(0);
        return overlap(box_, box);
    }
    unsigned enter(const BoxRows<T, D>& boxes, T, T* at) const {
        using L = Lanes<T>;
        return boxes.by_fours([&](int k) {
            unsigned overlapping = 15;
            for (int i = 0; i < D; ++i)
                overlapping &= less_equal(L::load(boxes.low(i) + k), L::all(box_.high[i])) &
                               less_equal(L::all(box_.low[i]), L::load(boxes.high(i) + k));
            L::all(T(0)).store(at + k);
            return overlapping;
        });
    }
    /// Tests any other volume (geometry/volumes.h).
    template <class Volume>
    requires requires(const Box<double, D>& b, const Volume& v) { may_overlap(b, v); }
    bool enter(const Volume& volume, T, T& at) const {
        at = T(0);
        return may_overlap(Box<double, D>{Vec<double, D>(box_.low), Vec<double, D>(box_.high)}, volume);
    }
    template <class Pack>
    requires(Pack::width > 0) unsigned enter(const Pack& pack, T limit, T* at) const {
        return enter_each(*this, pack, limit, at);
    }
    State root(const Box<T, D>& box) const { return {overlap(box_, box)}; }
    bool within(const State& s, T) const { return s.here; }
    Cut<State> cut(const State& s, const AxisPlane<T>& plane, T) const {
        return {false, s, s, box_.low[plane.axis] <= plane.position, box_.high[plane.axis] >= plane.position};
    }

    /// Cuts by any plane: compares the heights of the box's extreme corners along the normal. An unbounded
    /// box is on both sides.
    Cut<State> cut(const State& s, const CutPlane<D>& plane, T) const {
        double low = -plane.offset, high = -plane.offset, error = std::abs(plane.offset);
        for (int k = 0; k < D; ++k) {
            const double a = product(plane.normal[k], static_cast<double>(box_.low[k]));
            const double b = product(plane.normal[k], static_cast<double>(box_.high[k]));
            low += std::min(a, b), high += std::max(a, b);
            error += std::max(std::abs(a), std::abs(b));
        }
        const double tolerance = plane.margin + product(8 * unit_roundoff<double>, error);
        return {false, s, s, !(low > tolerance), !(high < -tolerance)};
    }

    template <class Limit, class Visit>
    void sweep(const Lattice<D>& lattice, Limit, Visit visit) const {
        if (box_.empty()) return;
        typename Lattice<D>::Cell first{}, last{};
        for (int a = 0; a < D; ++a) {
            first[static_cast<std::size_t>(a)] = lattice.coordinate(static_cast<double>(box_.low[a]), a);
            last[static_cast<std::size_t>(a)] = lattice.coordinate(static_cast<double>(box_.high[a]), a);
        }
        for_each_cell(first, last, [&](const auto& cell) { return visit(cell).flow == Flow::go_on; });
    }

private:
    Box<T, D> box_;
};

}  // namespace hedgerow
