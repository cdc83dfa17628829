/// The fast multipole method in float, compiled for each instruction set: Highway's foreach_target includes
/// this file once for each.
#include <hedgerow/nbody/kernels.h>

#if HEDGEROW_HAS_HIGHWAY
// Low orders are unrolled into one piece of code, which is a sixth faster; it takes a compiler that sanitizes
// half an hour.
#ifdef HEDGEROW_SANITIZED
#define HEDGEROW_UNROLLED HWY_ATTR
#else
#define HEDGEROW_UNROLLED HWY_ATTR __attribute__((always_inline))
#endif
#include "core/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nbody/fmm_float_kernels.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR
#include "fmm_table-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

inline constexpr FmmFloatKernels fmm_float_kernels = fmm_table<float, 2, 3, 4, 6>();

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
#endif  // HEDGEROW_HAS_HIGHWAY

#if HWY_ONCE || !HEDGEROW_HAS_HIGHWAY
#include "core/in_use.h"

HEDGEROW_KERNELS_IN_USE(FmmFloatKernels, fmm_float_kernels)
#endif
