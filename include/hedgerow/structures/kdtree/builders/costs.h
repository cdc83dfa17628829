/// The surface area heuristic for cells that a plane divides.
#pragma once

#include <hedgerow/structures/kdtree/builders/cutter.h>

namespace hedgerow {

/// Costs for the SAH (MacDonald and Booth 1990): an inner node costs `traversal_cost`, a test of a primitive
/// `intersection_cost`. Pharr, Jakob and Humphreys use 1 to 5. Here a node costs as much as four triangles,
/// as measured, since a packed leaf tests triangles fast (docs/design/004-plane-trees.md).
struct KdCosts {
    double traversal_cost = 4;
    double intersection_cost = 1;
    /// The fraction by which the tests below a plane cost less if the plane cuts off empty space.
    double empty_bonus = 0.2;

    /// Lists the options (option.h).
    template <class Option>
    void list(Option& option) {
        option("traversal_cost", traversal_cost, 0, 1e6, "of an inner node, for the SAH");
        option("intersection_cost", intersection_cost, 1e-6, 1e6, "of a primitive, for the SAH");
        option("empty_bonus", empty_bonus, 0, 0.99, "how much less a plane costs that cuts off empty space");
    }
};

/// The plane of least cost so far.
template <std::floating_point T>
struct KdBest {
    double cost = std::numeric_limits<double>::infinity();
    AxisPlane<T> plane;
};

/// The costs of planes across one axis of a cell. The areas of the halves are linear in the plane's position.
template <std::floating_point T, int D>
class KdAxisCosts {
public:
    KdAxisCosts(const KdCosts& costs, const Box<T, D>& cell, int axis)
        : costs_(costs),
          axis_(axis),
          low_(static_cast<double>(cell.low[axis])),
          high_(static_cast<double>(cell.high[axis])) {
        const Vec<double, D> e = Vec<double, D>(cell.high) - Vec<double, D>(cell.low);
        if constexpr (D == 2) {
            caps_ = e[1 - axis], around_ = 1;
        } else {
            const double a = e[(axis + 1) % 3], b = e[(axis + 2) % 3];
            caps_ = product(a, b), around_ = a + b;
        }
        whole_ = area(high_ - low_);
    }

    /// Offers a plane with `on_low` and `on_high` primitives on its sides. `best` keeps it if it costs less.
    void offer(T position, std::uint32_t on_low, std::uint32_t on_high, KdBest<T>& best) const {
        const double x = static_cast<double>(position);
        if (!(low_ < x && x < high_)) return;
        const double tests =
            product(area(x - low_), double(on_low)) + product(area(high_ - x), double(on_high));
        const double bonus = on_low == 0 || on_high == 0 ? 1 - costs_.empty_bonus : 1;
        const double cost = costs_.traversal_cost + product(costs_.intersection_cost * bonus, tests / whole_);
        if (cost < best.cost) best = {cost, {axis_, position}};
    }

private:
    double area(double width) const { return caps_ + product(around_, width); }

    const KdCosts& costs_;
    int axis_;
    double low_, high_, caps_, around_, whole_;
};

/// The best plane, if it costs less than testing all primitives of the cell.
template <std::floating_point T, int D>
std::optional<AxisPlane<T>> if_it_pays(const KdBest<T>& best, const KdCell<T, D>& cell,
                                       const KdCosts& costs) {
    if (best.cost < costs.intersection_cost * cell.size()) return best.plane;
    return std::nullopt;
}

}  // namespace hedgerow
