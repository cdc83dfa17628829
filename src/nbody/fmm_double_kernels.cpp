/// The fast multipole method in double, compiled for each instruction set: Highway's foreach_target includes
/// this file once for each. The tables of kernels.cpp point to it.
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

extern const FmmDoubleKernels fmm_double_kernels;  // for kernels.cpp
const FmmDoubleKernels fmm_double_kernels = fmm_table<double, 8, 11>();

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
#endif
