/// kd-tree building: how a cell is cut, independent of how planes are chosen.
#pragma once

#include <optional>

#include <hedgerow/structures/cells.h>
#include <hedgerow/structures/kdtree/kd_node.h>

namespace hedgerow {

/// A cell and the references in it. A reference has the bounds of its primitive's part in the cell, enlarged
/// on every side by the margin (cells.h).
template <std::floating_point T, int D>
struct KdCell {
    Box<T, D> box;
    ReferenceList<T, D> inside;

    std::uint32_t size() const { return static_cast<std::uint32_t>(inside.size()); }
};

/// Whether a reference goes to the low or the high side of a plane: its part reaches beyond the plane. A
/// reference that straddles the plane goes to both sides. A primitive on the plane straddles it, since parts
/// are enlarged.
template <std::floating_point T, int D>
bool goes_low(const Reference<T, D>& r, const AxisPlane<T>& plane) {
    return r.low[plane.axis] < plane.position;
}
template <std::floating_point T, int D>
bool goes_high(const Reference<T, D>& r, const AxisPlane<T>& plane) {
    return r.high[plane.axis] > plane.position;
}

/// The indexes of a cell's reference in the two halves of the cell.
struct KdPlaces {
    static constexpr std::uint32_t nowhere = 0xFFFFFFFFu;
    std::uint32_t low = nowhere, high = nowhere;
    bool cut = false;  // straddled the plane: its parts are new
};

/// Cuts cells by the planes that `Planes` chooses: `choose(cell, lists, depth) -> std::optional<AxisPlane>`
/// (none: the cell becomes a leaf). `Planes` may keep `Lists` of its own for each cell: `begin(root,
/// executor)` makes them, and `divide(lists, places, low, high, low_lists, high_lists)` passes them on to the
/// halves. Straddlers are clipped anew (perfect splits, Havran 2000; Wald and Havran 2006), and dropped from
/// a half where nothing of them is left.
template <std::floating_point T, int D, class Planes>
class KdCutter {
public:
    struct Cell : KdCell<T, D> {
        typename Planes::Lists lists;

        template <class F>
        void for_each_id(F f) const {
            for (const auto& r : this->inside) f(r.id());
        }
    };

    KdCutter(PartIn<T, D> part_in, const Planes& planes, T margin)
        : part_in_(part_in), planes_(planes), margin_(margin) {}

    Cell root(KdCell<T, D> cell, Executor& executor) const {
        for (auto& r : cell.inside) r = Reference<T, D>(enlarged(r.box(), margin_), r.id());
        Cell root{std::move(cell), {}};
        root.lists = planes_.begin(root, executor);
        return root;
    }
    std::optional<AxisPlane<T>> choose(const Cell& cell, int depth) const {
        return planes_.choose(cell, cell.lists, depth);
    }
    std::pair<Cell, Cell> cut(const Cell& cell, const AxisPlane<T>& plane) const {
        std::pair<Cell, Cell> sides;
        auto& [low, high] = sides;
        low.box = high.box = cell.box;
        low.box.high[plane.axis] = high.box.low[plane.axis] = plane.position;
        std::vector<KdPlaces> places(cell.inside.size());
        for (std::size_t i = 0; i < places.size(); ++i) {
            const auto& r = cell.inside[i];
            const bool to_low = goes_low(r, plane), to_high = goes_high(r, plane);
            places[i].cut = to_low && to_high;
            if (to_low) places[i].low = add(low, r, places[i].cut);
            if (to_high) places[i].high = add(high, r, places[i].cut);
        }
        planes_.divide(cell.lists, places, low, high, low.lists, high.lists);
        return sides;
    }

private:
    std::uint32_t add(Cell& to, const Reference<T, D>& r, bool cut) const {
        if (!cut) {
            to.inside.push_back(r);
        } else {
            const Box<T, D> part = part_in_(r.id(), enlarged(to.box, margin_));
            if (part.empty()) return KdPlaces::nowhere;
            to.inside.emplace_back(enlarged(part, margin_), r.id());
        }
        return to.size() - 1;
    }

    PartIn<T, D> part_in_;
    const Planes& planes_;
    T margin_;
};

}  // namespace hedgerow
