/// The importance of groups of lights, compiled for each instruction set: Highway's foreach_target includes
/// this file once for each.
#include "light_kernels.h"

#if HEDGEROW_HAS_HIGHWAY
#include "core/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/light_kernels.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR
HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

inline void write_importances_in_lanes(const LightGroups& groups, const Vec3f& point, const Vec3f& receiver,
                                       double* found) {
    write_importances(groups, point, receiver, found);
}
inline constexpr LightKernels light_kernels{write_importances_in_lanes};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif  // HEDGEROW_HAS_HIGHWAY

#if HWY_ONCE || !HEDGEROW_HAS_HIGHWAY
#include "core/in_use.h"

HEDGEROW_KERNELS_IN_USE(LightKernels, light_kernels)
#endif
