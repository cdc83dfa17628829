/// The table of the fast multipole method's kernels, an order each.
#if defined(HEDGEROW_NBODY_FMM_TABLE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_NBODY_FMM_TABLE_INL_H
#undef HEDGEROW_NBODY_FMM_TABLE_INL_H
#else
#define HEDGEROW_NBODY_FMM_TABLE_INL_H
#endif

#include "fmm-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

template <class T, int p>
void walk_above(const FmmCells<T>& sources, FmmCells<T>& targets, std::uint32_t most,
                std::vector<FmmTask<T>>& tasks) {
    Fmm<T, p>(sources, targets).walk_above(most, tasks);
}
template <class T, int p>
void walk_below(const FmmCells<T>& sources, FmmCells<T>& targets, const FmmTask<T>& task) {
    Fmm<T, p>(sources, targets).walk_below(task);
}
template <class T, int p>
void walk_groups(const FmmCells<T>& sources, FmmCells<T>& targets, std::uint32_t first, std::uint32_t end,
                 double opening_angle, bool by_multipoles) {
    Fmm<T, p> walk(sources, targets);
    for (std::uint32_t c = first; c < end; ++c)
        if (targets.is_leaf(c)) walk.walk_group(c, opening_angle, by_multipoles);
}
template <class T, int p>
void acting(const FmmCells<T>& sources, FmmCells<T>& targets, std::uint32_t place,
            std::vector<CellThatActs>& found) {
    Fmm<T, p>(sources, targets).acting(place, found);
}
template <class T, int... orders>
constexpr std::array<FmmKernel<T>, sizeof...(orders)> fmm_table() {
    return {{{orders, Expansions<T, orders>::stride, Moments<T, orders>::upward, walk_above<T, orders>,
              walk_below<T, orders>, walk_groups<T, orders>, acting<T, orders>}...}};
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
