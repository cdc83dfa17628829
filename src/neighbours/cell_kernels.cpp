/// The kernels of neighbours in cells, compiled for each instruction set: Highway's foreach_target includes
/// this file once for each.
#include "cell_kernels.h"

#if HEDGEROW_HAS_HIGHWAY
#include "core/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "neighbours/cell_kernels.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR
#include "list_cell-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

template <class T, int D>
inline constexpr detail::CellKernelsOf<T, D> of = {list_cell<T, D>, measure<T, D>};
inline constexpr detail::CellKernels cell_kernels{
    {of<float, 2>, of<float, 3>, of<double, 2>, of<double, 3>}, number, rank};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif  // HEDGEROW_HAS_HIGHWAY

#if HWY_ONCE || !HEDGEROW_HAS_HIGHWAY
#include "core/in_use.h"

HEDGEROW_KERNELS_IN_USE(detail::CellKernels, cell_kernels)
#endif
