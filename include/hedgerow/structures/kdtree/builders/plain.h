/// The two plain ways to choose a plane: the median, with the axes in turn, and the middle of the cell.
#pragma once

#include <hedgerow/structures/kdtree/builders/cutter.h>

namespace hedgerow {

/// The canonical kd-tree (Bentley 1975): the axes take turns from level to level, and the plane is the median
/// of the centers. Without `median`, the plane is the middle of the cell's widest axis. A cell becomes a leaf
/// if it has few enough primitives, or if a plane would leave about seven eighths of them on both sides; with
/// `median` all axes are tried first.
template <std::floating_point T, int D>
class KdPlainPlanes {
public:
    using Cell = KdCell<T, D>;
    struct Lists {};

    KdPlainPlanes(bool median, std::uint32_t leaf_size) : median_(median), leaf_size_(leaf_size) {}

    Lists begin(const Cell&, Executor&) const { return {}; }
    void divide(const Lists&, const std::vector<KdPlaces>&, const Cell&, const Cell&, Lists&, Lists&) const {}

    std::optional<AxisPlane<T>> choose(const Cell& cell, const Lists&, int depth) const {
        if (cell.size() <= leaf_size_) return std::nullopt;
        if (!median_) {
            const int axis = max_axis(cell.box.extent());
            return if_it_divides(cell, {axis, cell.box.center()[axis]});
        }
        for (int turn = 0; turn < D; ++turn) {
            const int axis = (depth - 1 + turn) % D;
            if (const auto plane = if_it_divides(cell, {axis, median(cell, axis)})) return plane;
        }
        return std::nullopt;
    }

private:
    static T median(const Cell& cell, int axis) {
        std::vector<T> centers;
        centers.reserve(cell.inside.size());
        for (const auto& r : cell.inside) centers.push_back(r.low[axis] / 2 + r.high[axis] / 2);
        const auto middle = centers.begin() + static_cast<std::ptrdiff_t>(centers.size() / 2);
        std::nth_element(centers.begin(), middle, centers.end());
        return *std::max_element(centers.begin(), middle) / 2 +
               *middle / 2;  // between two centers, not through one
    }
    static std::optional<AxisPlane<T>> if_it_divides(const Cell& cell, const AxisPlane<T>& plane) {
        if (!(cell.box.low[plane.axis] < plane.position && plane.position < cell.box.high[plane.axis]))
            return std::nullopt;
        std::size_t both = 0;
        for (const auto& r : cell.inside) both += goes_low(r, plane) && goes_high(r, plane);
        if (both + cell.inside.size() / 8 >= cell.inside.size()) return std::nullopt;
        return plane;
    }

    bool median_;
    std::uint32_t leaf_size_;
};

}  // namespace hedgerow
