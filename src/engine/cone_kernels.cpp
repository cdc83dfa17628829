/// The kernel of cones, compiled for each instruction set: Highway's foreach_target includes this file once
/// for each.
#include <hedgerow/engine/cone_kernels.h>

#if HEDGEROW_HAS_HIGHWAY
#include "core/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/cone_kernels.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR
#include "cone-inl.h"
#include "width-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

template <int W>
struct LookBy {
    static void answer(const WideScene& scene, const ConeProbe<float, 3>* probe, ConeView* view) {
        look_along_cone<W>(scene, *probe, *view);
    }
};
inline void look_along(const WideScene& scene, const ConeProbe<float, 3>& probe, ConeView& view) {
    if (!scene.tree.empty()) by_width<LookBy>(scene, &probe, &view);
}

inline constexpr ConeKernels cone_kernels{look_along, share_of};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif  // HEDGEROW_HAS_HIGHWAY

#if HWY_ONCE || !HEDGEROW_HAS_HIGHWAY
#include "core/in_use.h"

HEDGEROW_KERNELS_IN_USE(ConeKernels, cone_kernels)
#endif
