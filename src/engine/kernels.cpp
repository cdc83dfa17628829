/// The kernels of rays, compiled for each instruction set: Highway's foreach_target includes this file once
/// for each. The table of each instruction set, with the kernels of the other sources.
#if HEDGEROW_HAS_HIGHWAY
#include "targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/kernels.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#include "compiled.h"
#if HWY_TARGET != HWY_SCALAR
#include "instances-inl.h"
#include "many-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

template <Wanted wanted>
struct Answering {
    template <int W>
    struct One {
        static auto answer(const WideScene& scene, const Ray<float, 3>* asked) {
            return answer_one<W, wanted>(scene, *asked);
        }
        static auto answer(const WideInstances& scene, const Ray<float, 3>* asked) {
            return answer_one_of_instances<W, wanted>(scene, *asked);
        }
    };
    template <int W>
    struct Many {
        template <class Answer>
        static KernelUse answer(const WideScene& scene, const RayArray<float, 3>* rays, Answer* answers) {
            return answer_many<W, wanted>(scene, *rays, answers);
        }
    };
};

// Answers one ray in a scene of triangles or of instances.
template <Wanted wanted, class Answer, class Scene>
Answer answer_ray(const Scene& scene, const Ray<float, 3>& ray) {
    return by_width<Answering<wanted>::template One>(scene, &ray);
}
template <Wanted wanted, class Answer>
KernelUse answer_rays(const WideScene& scene, const RayArray<float, 3>& rays, Answer* answers) {
    return by_width<Answering<wanted>::template Many>(scene, &rays, answers);
}

template <Wanted wanted, class Answer>
inline constexpr RayKernels<Answer> ray_kernels = {answer_ray<wanted, Answer>, answer_ray<wanted, Answer>,
                                                   answer_rays<wanted, Answer>};

extern const AllPointKernels point_kernels;        // in point_kernels.cpp
extern const ElementKernels element_kernels;       // in near_element_kernels.cpp
extern const WindingKernel winding_kernel;         // in winding_kernels.cpp
extern const AllCrossingKernels crossing_kernels;  // in crossing_kernels.cpp

inline constexpr WideKernels kernels {
#if HWY_TARGET == HWY_AVX3
    "avx512", 16,
#elif HWY_TARGET == HWY_AVX2
    "avx2", 8,
#elif HWY_TARGET == HWY_SSE4
    "sse4", 4,
#else
    "neon", 4,
#endif
        ray_kernels<Wanted::closest, Hit<float>>, ray_kernels<Wanted::any, bool>, &point_kernels,
        &element_kernels, &winding_kernel, &crossing_kernels
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET != HWY_SCALAR

#if HWY_ONCE
namespace hedgerow::detail {

std::vector<const WideKernels*> compiled_wide_kernels() {
    std::vector<const WideKernels*> all;
#if HWY_TARGETS & HWY_AVX3
    all.push_back(&N_AVX3::kernels);
#endif
#if HWY_TARGETS & HWY_AVX2
    all.push_back(&N_AVX2::kernels);
#endif
#if HWY_TARGETS & HWY_SSE4
    all.push_back(&N_SSE4::kernels);
#endif
#if HWY_TARGETS & HWY_NEON
    all.push_back(&N_NEON::kernels);
#endif
    return all;
}

}  // namespace hedgerow::detail
#endif

#else
#include "compiled.h"

std::vector<const hedgerow::WideKernels*> hedgerow::detail::compiled_wide_kernels() {
    return {};
}
#endif
