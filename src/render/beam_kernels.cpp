/// The kernels of beams, compiled for each instruction set: Highway's foreach_target includes this file once
/// for each.
#include <hedgerow/render/visibility/beam_kernels.h>

#if HEDGEROW_HAS_HIGHWAY
#include "core/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/beam_kernels.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR
#include "beams-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

inline constexpr BeamKernels beam_kernels{trace_beams};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE
#include "core/kernel_tables.h"

const hedgerow::BeamKernels* hedgerow::beam_kernels() {
    static constexpr KernelTables<BeamKernels> tables = HEDGEROW_KERNEL_TABLES(beam_kernels);
    return in_use(tables);
}
#endif

#else

const hedgerow::BeamKernels* hedgerow::beam_kernels() {
    return nullptr;
}

#endif
