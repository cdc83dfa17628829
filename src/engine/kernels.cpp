/// The kernels of rays, compiled for each instruction set: Highway's foreach_target includes this file once
/// for each.
#include <hedgerow/engine/kernels.h>

#if HEDGEROW_HAS_HIGHWAY
#include "core/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/kernels.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#include "compiled.h"
#if HWY_TARGET != HWY_SCALAR
#include "first_hits-inl.h"
#include "instances-inl.h"
#include "many-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

template <Wanted wanted>
struct Answering {
    template <int W>
    struct One {
        static auto answer(const WideScene& scene, const Ray<float, 3>* asked) {
            return cast_one<W, wanted>(scene, *asked);
        }
        static auto answer(const WideInstances& scene, const Ray<float, 3>* asked) {
            return cast_one_among_instances<W, wanted>(scene, *asked);
        }
    };
    template <int W>
    struct Many {
        template <class Answer>
        static KernelUse answer(const WideScene& scene, const RayArray<float, 3>* rays, Answer* answers) {
            return cast_many<W, wanted>(scene, *rays, answers);
        }
    };
};

// Answers one ray in a scene of triangles or of instances.
template <Wanted wanted, class Answer, class Scene>
Answer cast_ray(const Scene& scene, const Ray<float, 3>& ray) {
    return by_width<Answering<wanted>::template One>(scene, &ray);
}
template <Wanted wanted, class Answer>
KernelUse cast_rays(const WideScene& scene, const RayArray<float, 3>& rays, Answer* answers) {
    return by_width<Answering<wanted>::template Many>(scene, &rays, answers);
}

template <Wanted wanted, class Answer>
inline constexpr RayKernels<Answer> ray_kernels = {cast_ray<wanted, Answer>, cast_ray<wanted, Answer>,
                                                   cast_rays<wanted, Answer>};

template <int W>
struct FirstOnes {
    static std::size_t answer(const WideScene& scene, const Ray<float, 3>* ray, std::span<Hit<float>> hits,
                              const PlaceOfHit<float>* after) {
        return first_hits_of<W>(scene, *ray, hits, *after);
    }
};
inline std::size_t find_first_hits(const WideScene& scene, const Ray<float, 3>& ray,
                                   std::span<Hit<float>> hits, const PlaceOfHit<float>& after) {
    return by_width<FirstOnes>(scene, &ray, hits, &after);
}

inline constexpr int best_width = HWY_TARGET == HWY_AVX3 ? 16 : HWY_TARGET == HWY_AVX2 ? 8 : 4;
inline constexpr AllRayKernels all_ray_kernels{best_width, ray_kernels<Wanted::closest, Hit<float>>,
                                               ray_kernels<Wanted::any, bool>, find_first_hits};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET != HWY_SCALAR

#endif  // HEDGEROW_HAS_HIGHWAY

#if HWY_ONCE || !HEDGEROW_HAS_HIGHWAY
#include "core/in_use.h"

HEDGEROW_KERNELS_IN_USE(AllRayKernels, all_ray_kernels)
#endif
