/// The surface area heuristic for planes across an axis of a convex cell.
#pragma once

#include <array>

#include <hedgerow/geometry/polytope.h>
#include <hedgerow/structures/kdtree/builders/costs.h>

namespace hedgerow {

/// The costs of planes across one axis of a cell, as KdAxisCosts has them of a box. The surfaces of the two
/// sides are measured in a few places and interpolated between these. Of a box they are linear in the plane's
/// position, so two places do.
template <std::floating_point T, int D>
class BspAxisCosts {
public:
    BspAxisCosts(const KdCosts& costs, const Polytope<D>& cell, double whole, bool is_box, int axis)
        : costs_(costs), axis_(axis), places_(is_box ? 2 : most_places) {
        Vec<double, D> along;
        along[axis] = 1;
        std::tie(low_, high_) = cell.heights({along, 0, 0});
        const double apart = width() / static_cast<double>(places_);
        for (std::size_t i = 0; i < places_; ++i) {
            const double x = low_ + product(apart, static_cast<double>(i) + 0.5);
            const auto [low, high] = cell.surfaces({along, x, 0}, whole);
            shares_[i] = {low / whole, high / whole};
            volume_ += product(apart, std::max(0.0, low + high - whole) / 2);
        }
        scale_ = static_cast<double>(places_) / width();
    }
    double low() const { return low_; }
    double width() const { return high_ - low_; }
    /// The volume of the cell, or in the plane its area, by the sections in the same places.
    double volume() const { return volume_; }

    /// Offers a plane with `on_low` and `on_high` primitives on its sides. `best` keeps it if it costs less.
    void offer(T position, std::uint32_t on_low, std::uint32_t on_high, KdBest<T>& best) const {
        const double x = static_cast<double>(position);
        if (!(low_ < x && x < high_)) return;
        const double place = product(x - low_, scale_) - 0.5;
        const auto first = static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(places_ - 2)));
        const double part = place - static_cast<double>(first);
        const auto& [a, b] = std::tie(shares_[first], shares_[first + 1]);
        const double tests = product(a[0] + product(b[0] - a[0], part), static_cast<double>(on_low)) +
                             product(a[1] + product(b[1] - a[1], part), static_cast<double>(on_high));
        const double bonus = on_low == 0 || on_high == 0 ? 1 - costs_.empty_bonus : 1;
        const double cost = costs_.traversal_cost + product(costs_.intersection_cost * bonus, tests);
        if (cost < best.cost) best = {cost, {axis_, position}};
    }

private:
    static constexpr std::size_t most_places = 4;

    KdCosts costs_;
    int axis_;
    std::size_t places_;
    double low_ = 0, high_ = 0, scale_ = 0, volume_ = 0;
    /// The surfaces of the low and the high side over that of the cell, in the middles of equal intervals.
    std::array<std::array<double, 2>, most_places> shares_{};
};

}  // namespace hedgerow
