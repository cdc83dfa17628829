/// kd-tree building: one recursion, whatever chooses the planes.
#pragma once

#include <optional>

#include <hedgerow/structures/cells.h>
#include <hedgerow/structures/kdtree/kd_nodes.h>

namespace hedgerow {

/// A cell and what stands in it: of each primitive the bounds of its part in the cell, enlarged on every side
/// by the margin (cells.h).
template <std::floating_point T, int D>
struct KdCell {
    Box<T, D> box;
    std::vector<Reference<T, D>> inside;

    std::uint32_t size() const { return static_cast<std::uint32_t>(inside.size()); }
};

/// Which side of a plane a reference goes to: its part reaches beyond the plane by more than nothing. Both,
/// if it straddles. What lies on a plane reaches to both sides, since parts are enlarged.
template <std::floating_point T, int D>
bool goes_low(const Reference<T, D>& r, const AxisPlane<T>& plane) {
    return r.low[plane.axis] < plane.position;
}
template <std::floating_point T, int D>
bool goes_high(const Reference<T, D>& r, const AxisPlane<T>& plane) {
    return r.high[plane.axis] > plane.position;
}

/// Where a reference of a divided cell stands in its halves.
struct KdPlaces {
    static constexpr std::uint32_t nowhere = 0xFFFFFFFFu;
    std::uint32_t low = nowhere, high = nowhere;
    bool cut = false;  // it straddled the plane: its parts are new
};

/// `Planes` chooses: `choose(cell, lists, depth) -> std::optional<AxisPlane>` (none: a leaf). It may carry
/// `Lists` of its own beside each cell: `begin(root)` makes them, and `divide(lists, places, low, high)`
/// hands them on. Straddlers are clipped anew (perfect splits, Havran 2000; Wald and Havran 2006), and
/// dropped where nothing of them is left. The tree is the same however many threads build it.
template <PrimitiveSet P, class Planes>
class KdGrowth {
public:
    using T = typename P::Scalar;
    static constexpr int D = P::dimension;
    using Cell = KdCell<T, D>;
    using Lists = typename Planes::Lists;

    KdGrowth(const P& set, const Planes& planes, T margin, int deepest, Executor& executor)
        : set_(set), planes_(planes), margin_(margin), deepest_(deepest), executor_(executor) {}

    KdNodes<T> grow(Cell root) {
        KdNodes<T> tree;
        for (auto& r : root.inside) r = Reference<T, D>(enlarged(r.box(), margin_), r.id());
        Lists lists = planes_.begin(root, executor_);
        grow(std::move(root), std::move(lists), 1, tree);
        return tree;
    }

private:
    void grow(Cell cell, Lists lists, int depth, KdNodes<T>& tree) {
        tree.depth = std::max(tree.depth, depth);
        std::optional<AxisPlane<T>> plane;
        if (depth < deepest_) plane = planes_.choose(cell, lists, depth);
        if (!plane) return add_leaf(cell, tree);

        const auto at = tree.nodes.size();
        tree.nodes.push_back(KdNode<T>::inner(*plane));
        Cell low, high;
        Lists low_lists, high_lists;
        divide(cell, lists, *plane, low, high, low_lists, high_lists);
        const bool large = cell.inside.size() > 4096;
        cell = {}, lists = {};
        const auto grow_low = [&] { grow(std::move(low), std::move(low_lists), depth + 1, tree); };
        if (large) {
            KdNodes<T> high_tree;
            executor_.both(grow_low,
                           [&] { grow(std::move(high), std::move(high_lists), depth + 1, high_tree); });
            tree.nodes[at].set_link(static_cast<std::uint32_t>(tree.nodes.size()));
            tree.append(high_tree);
        } else {
            grow_low();
            tree.nodes[at].set_link(static_cast<std::uint32_t>(tree.nodes.size()));
            grow(std::move(high), std::move(high_lists), depth + 1, tree);
        }
    }

    void add_leaf(const Cell& cell, KdNodes<T>& tree) {
        tree.nodes.push_back(KdNode<T>::leaf(static_cast<std::uint32_t>(tree.items.size()), cell.size()));
        for (const auto& r : cell.inside) tree.items.push_back(r.id());
    }

    void divide(const Cell& cell, const Lists& lists, const AxisPlane<T>& plane, Cell& low, Cell& high,
                Lists& low_lists, Lists& high_lists) {
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
        planes_.divide(lists, places, low, high, low_lists, high_lists);
    }
    std::uint32_t add(Cell& to, const Reference<T, D>& r, bool cut) {
        if (!cut) {
            to.inside.push_back(r);
        } else {
            const Box<T, D> part = part_in(set_, r.id(), enlarged(to.box, margin_));
            if (part.empty()) return KdPlaces::nowhere;
            to.inside.emplace_back(enlarged(part, margin_), r.id());
        }
        return to.size() - 1;
    }

    const P& set_;
    const Planes& planes_;
    T margin_;
    int deepest_;
    Executor& executor_;
};

}  // namespace hedgerow
