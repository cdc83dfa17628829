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
void walk_above(FmmCells<T>& cells, std::uint32_t most, std::vector<FmmTask<T>>& tasks) {
    Fmm<T, p>(cells).walk_above(
        most, [&](std::uint32_t cell, const std::vector<std::uint32_t>& undecided, const T* local) {
            tasks.push_back({cell, undecided, {local, local + Fmm<T, p>::of_local}});
        });
}
template <class T, int p>
void walk_below(FmmCells<T>& cells, const FmmTask<T>& task) {
    Fmm<T, p>(cells).walk_below(task.cell, task.undecided, task.local.data());
}
template <class T, int... orders>
constexpr std::array<FmmKernel<T>, sizeof...(orders)> fmm_table() {
    return {{{orders, Fmm<T, orders>::stride, Fmm<T, orders>::upward, walk_above<T, orders>,
              walk_below<T, orders>}...}};
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
