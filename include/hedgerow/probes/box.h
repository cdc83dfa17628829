/// A box as a probe: it enters what it overlaps, in no order.
#pragma once

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
    template <class Pack>
    requires(Pack::width > 0) unsigned enter(const Pack& pack, T limit, T* at) const {
        return enter_each(*this, pack, limit, at);
    }
    State root(const Box<T, D>& box) const { return {overlap(box_, box)}; }
    bool within(const State& s, T) const { return s.here; }
    Cut<State> cut(const State& s, const AxisPlane<T>& plane) const {
        return {false,
                {s.here && box_.low[plane.axis] <= plane.position},
                {s.here && box_.high[plane.axis] >= plane.position}};
    }

    template <class Limit, class Visit>
    void sweep(const Lattice<D>& lattice, Limit, Visit visit) const {
        if (box_.empty()) return;
        typename Lattice<D>::Cell first{}, last{};
        for (int a = 0; a < D; ++a) {
            first[static_cast<std::size_t>(a)] = lattice.coordinate(static_cast<double>(box_.low[a]), a);
            last[static_cast<std::size_t>(a)] = lattice.coordinate(static_cast<double>(box_.high[a]), a);
        }
        for_each_cell(first, last, [&](const auto& cell) { return visit(cell) == Flow::go_on; });
    }

private:
    Box<T, D> box_;
};

}  // namespace hedgerow
