/// The kernels of crossings, compiled for each instruction set: Highway's foreach_target includes this file
/// once for each.
#include <hedgerow/engine/kernels.h>

#if HEDGEROW_HAS_HIGHWAY
#include "core/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/crossing_kernels.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#include "compiled.h"
#if HWY_TARGET != HWY_SCALAR
#include "crossings-inl.h"
#include "width-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

template <class Scene>
struct CrossingsBy {
    using T = typename Scene::Scalar;
    using Rays = std::span<const RayInBounds<T, 3>>;

    template <int W>
    struct Answer {
        static CrossingCount answer(const Scene& scene, const RayInBounds<T, 3>* asked, bool past_surface) {
            return crossings_of_one<W>(scene, *asked, past_surface);
        }
        static void answer(const Scene& scene, Rays rays, bool past_surface, CrossingCount* counts) {
            crossings_of_many<W>(scene, rays, past_surface, counts);
        }
    };
    static CrossingCount one(const Scene& scene, const RayInBounds<T, 3>& asked, bool past_surface) {
        return by_width<Answer>(scene, &asked, past_surface);
    }
    static void many(const Scene& scene, Rays rays, bool past_surface, CrossingCount* counts) {
        by_width<Answer>(scene, rays, past_surface, counts);
    }
};

inline constexpr AllCrossingKernels crossing_kernels{
    {CrossingsBy<WideScene>::one, CrossingsBy<WideScene>::many},
    {CrossingsBy<WideDoubles>::one, CrossingsBy<WideDoubles>::many}};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET != HWY_SCALAR

#if HWY_ONCE
namespace hedgerow::detail {

template <std::floating_point T>
AxisCrossing crossing_of(const AxisRay<3>& ray, const TriangleBlock<T>& block, int place) {
    const auto corner = [&](int c) {
        const auto at = [&](int axis) { return static_cast<double>(block.corner[axis][c][place]); };
        return Vec3d(at(0), at(1), at(2));
    };
    return crossing(ray, {corner(0), corner(1), corner(2)});
}
template AxisCrossing crossing_of(const AxisRay<3>&, const TriangleBlock<float>&, int);
template AxisCrossing crossing_of(const AxisRay<3>&, const TriangleBlock<double>&, int);

}  // namespace hedgerow::detail
#endif
#endif  // HEDGEROW_HAS_HIGHWAY

#if HWY_ONCE || !HEDGEROW_HAS_HIGHWAY
#include "core/in_use.h"

HEDGEROW_KERNELS_IN_USE(AllCrossingKernels, crossing_kernels)
#endif
