/// The kernels of flows, compiled for each instruction set: Highway's foreach_target includes this file once
/// for each.
#include "flow_kernels.h"

#if HEDGEROW_HAS_HIGHWAY
#include "core/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fluid/flow_kernels.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR
#include "sixteen-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

#include "pair_sums-inl.h"

inline constexpr detail::FlowKernels flow_kernels{flow_kernels_of<2>, flow_kernels_of<3>};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif  // HEDGEROW_HAS_HIGHWAY

#if HWY_ONCE || !HEDGEROW_HAS_HIGHWAY
#include "core/in_use.h"

HEDGEROW_KERNELS_IN_USE(detail::FlowKernels, flow_kernels)
#endif
