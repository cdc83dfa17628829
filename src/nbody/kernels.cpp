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

extern const FmmFloatKernels fmm_float_kernels;    // in fmm_float_kernels.cpp
extern const FmmDoubleKernels fmm_double_kernels;  // in fmm_double_kernels.cpp

inline constexpr NbodyKernels nbody_kernels{
    direct<float>, direct<double>, direct<double, Pairs::exact>, &fmm_float_kernels, &fmm_double_kernels,
    add_multipole, add_local};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE
#include "core/kernel_tables.h"

const hedgerow::NbodyKernels* hedgerow::nbody_kernels() {
    static constexpr KernelTables<NbodyKernels> tables = HEDGEROW_KERNEL_TABLES(nbody_kernels);
    return in_use(tables);
}
#endif

#else

const hedgerow::NbodyKernels* hedgerow::nbody_kernels() {
    return nullptr;
}

#endif
