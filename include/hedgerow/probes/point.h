/// A point as a probe: volumes are entered at their squared distance.
#pragma once

#include <algorithm>

#include <hedgerow/geometry/box_rows.h>
#include <hedgerow/geometry/distance.h>
#include <hedgerow/geometry/lattice.h>
#include <hedgerow/probes/concepts.h>

namespace hedgerow {

/// A point as a probe. Distances to boxes are exact but for roundings in T. A query's limit must leave room
/// for these (`limit_of_boxes`). The distance to a box is never more than that to a box inside it: squares
/// are summed in one order, and rounding is monotone.
template <std::floating_point T, int D>
class PointProbe {
public:
    using Scalar = T;
    static constexpr int dimension = D;
    /// The distance to the cell along each axis, and the squared distance to the cell.
    struct State {
        Vec<T, D> offset;
        T distance2;
    };

    explicit PointProbe(const Vec<T, D>& point) : point_(point) {}
    const Vec<T, D>& point() const { return point_; }

    bool enter(const Box<T, D>& box, T limit, T& at) const {
        at = distance2(point_, box);
        return at <= limit;
    }
    /// Computes the squared distances to the boxes, four at a time; each equals distance2.
    unsigned enter(const BoxRows<T, D>& boxes, T limit, T* at) const {
        using L = Lanes<T>;
        return boxes.by_fours([&](int k) {
            L sum = L::all(T(0));
            for (int i = 0; i < D; ++i) {
                const L p = L::all(point_[i]);
                const L below = L::load(boxes.low(i) + k) - p, above = p - L::load(boxes.high(i) + k);
                const L outside = max(below, max(above, L::all(T(0))));
                sum = sum + outside * outside;
            }
            sum.store(at + k);
            return less_equal(sum, L::all(limit));
        });
    }
    /// Tests any other volume (geometry/volumes.h) by a bound in double. The bound is lowered by more than
    /// the error of the distance to a result, and by a few subnormal steps of T, in which squares in tiny
    /// scenes underflow.
    template <class Volume>
    requires requires(const Vec<double, D>& p, const Volume& v) { least_distance2(p, v); }
    bool enter(const Volume& volume, T limit, T& at) const {
        const double least = least_distance2(Vec<double, D>(point_), volume) * (1 - 0x1p-20);
        const double most = static_cast<double>(std::numeric_limits<T>::max());
        at = static_cast<T>(std::min(least, most)) - 4 * std::numeric_limits<T>::denorm_min();
        return at <= limit;
    }
    template <class Pack>
    requires(Pack::width > 0) unsigned enter(const Pack& pack, T limit, T* at) const {
        return enter_each(*this, pack, limit, at);
    }
    State root(const Box<T, D>& box) const {
        const auto offset = offset_outside(point_, box);
        return {offset, length2(offset)};
    }
    bool within(const State& s, T limit) const { return s.distance2 <= limit; }
    Cut<State> cut(const State& s, const AxisPlane<T>& plane, T limit) const {
        const T x = point_[plane.axis];
        State far = s;
        far.offset[plane.axis] = std::abs(x - plane.position);
        far.distance2 = std::max(s.distance2, length2(far.offset));
        return {x >= plane.position, s, far, true, far.distance2 <= limit};
    }

    /// Cuts by any plane, in double. The far side is at least as far away as the plane, less the plane's
    /// margin and the error of the height. Rounded down to T.
    Cut<State> cut(const State& s, const CutPlane<D>& plane, T limit) const {
        const Vec<double, D> p(point_);
        const double height = plane.height(p);
        const double error = product(8 * unit_roundoff<double>,
                                     product(plane.reach(), max_component(abs(p))) + std::abs(plane.offset));
        const double clear = std::max(0.0, std::abs(height) - plane.margin - error) / length(plane.normal);
        State far = s;
        const T beyond =
            static_cast<T>(product(clear, clear) * (1 - 0x1p-20)) - 4 * std::numeric_limits<T>::denorm_min();
        far.distance2 = std::max(s.distance2, beyond);
        return {height >= 0, s, far, true, far.distance2 <= limit};
    }

    /// Visits shells of cells around the point's own cell, until every cell of a shell is beyond the limit.
    /// Skips those cells of a shell that are beyond the limit, and does not look at cells that are beyond it
    /// along one axis: of a far point's shells only a thin part is near.
    template <class Limit, class Visit>
    void sweep(const Lattice<D>& lattice, Limit limit, Visit visit) const {
        // Find the point's own cell, and the outermost shell that has cells.
        typename Lattice<D>::Cell center{};
        std::int32_t last = 0;
        const Vec<double, D> p(point_);
        for (int a = 0; a < D; ++a) {
            const auto i = static_cast<std::size_t>(a);
            center[i] = lattice.coordinate(p[a], a);
            last = std::max({last, center[i], lattice.resolution[i] - 1 - center[i]});
        }
        for (std::int32_t r = 0; r <= last; ++r) {
            // Visit the cells of a shell that are within the limit.
            bool any = false;
            const auto [low, high] = reached(lattice, p, limit());
            const bool go_on = for_each_in_shell(low, high, center, r, [&](const auto& cell) {
                auto box = lattice.bounds(cell);
                box.low = box.low - lattice.pad, box.high = box.high + lattice.pad;
                // In T, in which distances in tiny scenes underflow. Rounded down by more than distances in T
                // are rounded up.
                const T at = static_cast<T>(distance2(p, box) * (1 - 0x1p-20));
                if (at - 4 * std::numeric_limits<T>::denorm_min() > limit()) return true;
                any = true;
                return visit(cell).flow == Flow::go_on;
            });
            if (!go_on || !any) return;
        }
    }

private:
    /// The first and the last cell of the block that the limit reaches along each axis. It has the point's
    /// own cell. The reach is larger than the limit's root by more than the test of a cell rounds.
    static auto reached(const Lattice<D>& lattice, const Vec<double, D>& p, T limit) {
        const double reach = std::sqrt(static_cast<double>(limit) +
                                       16 * static_cast<double>(std::numeric_limits<T>::denorm_min())) *
                             (1 + 0x1p-18);
        std::pair<typename Lattice<D>::Cell, typename Lattice<D>::Cell> block;
        for (int a = 0; a < D; ++a) {
            const auto i = static_cast<std::size_t>(a);
            block.first[i] = lattice.coordinate(p[a] - reach - 2 * lattice.pad[a], a);
            block.second[i] = lattice.coordinate(p[a] + reach + 2 * lattice.pad[a], a);
        }
        return block;
    }
    /// Calls f for the cells from `least` to `most` with |cell − center| = r in the largest component, one
    /// side of the shell after the other. Returns false if f did, else true.
    template <class Cell, class F>
    static bool for_each_in_shell(const Cell& least, const Cell& most, const Cell& center, std::int32_t r,
                                  F f) {
        Cell first = center, last = center;
        // Clip the block of the cells within r.
        for (std::size_t a = 0; a < first.size(); ++a) {
            first[a] = std::max(least[a], center[a] - r);
            last[a] = std::min(most[a], center[a] + r);
        }
        if (r == 0) return f(center);
        // Visit the two sides of the block across each axis.
        for (std::size_t a = 0; a < first.size(); ++a) {
            for (const std::int32_t side : {center[a] - r, center[a] + r}) {
                if (side < least[a] || side > most[a]) continue;
                Cell low = first, high = last;
                low[a] = high[a] = side;
                // Leave out the sides across earlier axes, so that each cell is visited once.
                bool some = true;
                for (std::size_t b = 0; b < a; ++b) {
                    low[b] = std::max(low[b], center[b] - r + 1);
                    high[b] = std::min(high[b], center[b] + r - 1);
                    some = some && low[b] <= high[b];
                }
                if (some && !for_each_cell(low, high, f)) return false;
            }
        }
        return true;
    }

    Vec<T, D> point_;
};

}  // namespace hedgerow
