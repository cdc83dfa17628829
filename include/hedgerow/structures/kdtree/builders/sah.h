/// The SAH over every plane that bounds some part, in O(n log n) (Wald and Havran, RT 2006).
#pragma once

#include <hedgerow/parallel/sort.h>
#include <hedgerow/structures/kdtree/builders/sweep.h>

namespace hedgerow {

/// Events are sorted once for the whole tree. A divided cell passes its lists on in order. Only the events of
/// straddlers, whose parts are new, are sorted again and merged in.
template <std::floating_point T, int D>
class KdSahPlanes {
public:
    using Cell = KdCell<T, D>;
    using List = std::vector<KdEvent<T>>;
    using Lists = std::array<List, static_cast<std::size_t>(D)>;

    KdSahPlanes(const KdCosts& costs, std::uint32_t leaf_size) : costs_(costs), leaf_size_(leaf_size) {}

    Lists begin(const Cell& root, Executor& executor) const {
        Lists lists;
        const auto make = [&](int axis) {
            List& list = lists[static_cast<std::size_t>(axis)];
            list.reserve(2 * root.inside.size());
            for (std::uint32_t i = 0; i < root.size(); ++i) add(list, root, i, axis);
            sort_watched(list.begin(), list.end(), executor);
        };
        executor.both([&] { make(0); },
                      [&] {
                          if constexpr (D == 2)
                              make(1);
                          else
                              executor.both([&] { make(1); }, [&] { make(2); });
                      });
        return lists;
    }

    std::optional<AxisPlane<T>> choose(const Cell& cell, const Lists& lists, int) const {
        if (cell.size() <= leaf_size_) return std::nullopt;
        KdBest<T> best;
        for (int axis = 0; axis < D; ++axis)
            sweep_events(lists[static_cast<std::size_t>(axis)], cell.size(),
                         KdAxisCosts<T, D>(costs_, cell.box, axis), best);
        return if_it_pays(best, cell, costs_);
    }

    void divide(const Lists& lists, const std::vector<KdPlaces>& places, const Cell& low, const Cell& high,
                Lists& low_lists, Lists& high_lists) const {
        for (int axis = 0; axis < D; ++axis) {
            const auto k = static_cast<std::size_t>(axis);
            hand_on(lists[k], places, &KdPlaces::low, low, axis, low_lists[k]);
            hand_on(lists[k], places, &KdPlaces::high, high, axis, high_lists[k]);
        }
    }

private:
    static void add(List& list, const Cell& cell, std::uint32_t i, int axis) {
        list.emplace_back(cell.inside[i].low[axis], i, true);
        list.emplace_back(cell.inside[i].high[axis], i, false);
    }

    static void hand_on(const List& list, const std::vector<KdPlaces>& places, std::uint32_t KdPlaces::*side,
                        const Cell& cell, int axis, List& result) {
        List uncut, anew;
        uncut.reserve(2 * cell.inside.size());
        for (const KdEvent<T>& e : list) {
            const KdPlaces& p = places[e.reference()];
            if (p.*side == KdPlaces::nowhere) continue;
            if (!p.cut)
                uncut.emplace_back(e.position, p.*side, e.begins());
            else if (e.begins())
                add(anew, cell, p.*side, axis);
        }
        if (anew.empty()) return result.swap(uncut);
        std::sort(anew.begin(), anew.end());
        result.reserve(uncut.size() + anew.size());
        std::merge(uncut.begin(), uncut.end(), anew.begin(), anew.end(), std::back_inserter(result));
    }

    KdCosts costs_;
    std::uint32_t leaf_size_;
};

}  // namespace hedgerow
