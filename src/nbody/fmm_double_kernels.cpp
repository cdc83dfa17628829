/// The fast multipole method in double, compiled for each instruction set: Highway's foreach_target includes
/// this file once for each.
#include <hedgerow/nbody/kernels.h>

#if HEDGEROW_HAS_HIGHWAY
// High orders are not unrolled into one piece of code, which is a sixth slower.
#define HEDGEROW_UNROLLED HWY_ATTR
#include "core/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nbody/fmm_double_kernels.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR
#include "fmm_table-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

inline constexpr FmmDoubleKernels fmm_double_kernels = fmm_table<double, 8, 11>();

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
#endif  // HEDGEROW_HAS_HIGHWAY

#if HWY_ONCE || !HEDGEROW_HAS_HIGHWAY
#include "core/in_use.h"

HEDGEROW_KERNELS_IN_USE(FmmDoubleKernels, fmm_double_kernels)
#endif
