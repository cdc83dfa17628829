/// The random numbers of many paths, compiled for each instruction set: Highway's foreach_target includes
/// this file once for each.
#include "sample_kernels.h"

#if HEDGEROW_HAS_HIGHWAY
#include "core/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/sample_kernels.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR
HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

inline void fill_pairs_in_lanes(Sampler sampler, const PairKeys& of, std::uint32_t pair, std::uint32_t* x,
                                std::uint32_t* y) {
    fill_pairs(sampler, of, pair, x, y);
}
inline constexpr SampleKernels sample_kernels{fill_pairs_in_lanes};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif  // HEDGEROW_HAS_HIGHWAY

#if HWY_ONCE || !HEDGEROW_HAS_HIGHWAY
#include "core/in_use.h"

HEDGEROW_KERNELS_IN_USE(SampleKernels, sample_kernels)
#endif
