/// The kernels of winding numbers, compiled for each instruction set: Highway's foreach_target includes this
/// file once for each.
#include <hedgerow/engine/kernels.h>

#if HEDGEROW_HAS_HIGHWAY
#include "core/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/winding_kernels.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#include "compiled.h"
#if HWY_TARGET != HWY_SCALAR
#include "width-inl.h"
#include "winding-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

inline double winding_number(const WideExpansion& all, const WindingQuery& query) {
    return by_width<WindingNumber>(all, &query);
}
inline constexpr WindingKernels winding_kernels{winding_number};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET != HWY_SCALAR

#if HWY_ONCE
namespace hedgerow::detail {

HalfAngle settled_half_angle(const HalfAngle& h, double size, const TriangleBlock<float>& block, int place,
                             const Vec<double, 3>& x) {
    const auto corner = [&](int c) {
        return Vec<double, 3>(block.corner[0][c][place], block.corner[1][c][place],
                              block.corner[2][c][place]);
    };
    return HalfAngles::settled(h, size, {corner(0), corner(1), corner(2)}, x);
}

}  // namespace hedgerow::detail
#endif
#endif  // HEDGEROW_HAS_HIGHWAY

#if HWY_ONCE || !HEDGEROW_HAS_HIGHWAY
#include "core/in_use.h"

HEDGEROW_KERNELS_IN_USE(WindingKernels, winding_kernels)
#endif
