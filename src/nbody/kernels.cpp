/// The kernels of forces, compiled for each instruction set: Highway's foreach_target includes this file once
/// for each.
#include <hedgerow/nbody/kernels.h>

#if HEDGEROW_HAS_HIGHWAY
#define HEDGEROW_UNROLLED HWY_ATTR
#include "core/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nbody/kernels.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR
#include "any_order-inl.h"
#include "direct-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

inline constexpr NbodyKernels nbody_kernels{direct<float>, direct<double>, direct<double, Pairs::exact>,
                                            add_multipole, add_local};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif  // HEDGEROW_HAS_HIGHWAY

#if HWY_ONCE || !HEDGEROW_HAS_HIGHWAY
#include "core/in_use.h"

HEDGEROW_KERNELS_IN_USE(NbodyKernels, nbody_kernels)
#endif
