/// The kernels of the rasteriser, compiled for each instruction set: Highway's foreach_target includes this
/// file once for each.
#include <hedgerow/render/visibility/raster_kernels.h>

#if HEDGEROW_HAS_HIGHWAY
#include "core/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/raster_kernels.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR
#include "bounds-inl.h"
#include "tile-inl.h"
#include "visible_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

inline constexpr RasterKernels raster_kernels{pixel_bounds, triangle_functions, draw_tile, see_tile,
                                              resolve_tile};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif  // HEDGEROW_HAS_HIGHWAY

#if HWY_ONCE || !HEDGEROW_HAS_HIGHWAY
#include "core/in_use.h"

HEDGEROW_KERNELS_IN_USE(RasterKernels, raster_kernels)
#endif
