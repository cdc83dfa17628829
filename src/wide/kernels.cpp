/// The kernels, compiled for each instruction set: Highway's foreach_target reads this file once a set. Of
/// Highway the headers are used alone, and nothing is linked.
#if HEDGEROW_HAS_HIGHWAY
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wide/kernels.cpp"
// Not worth their code: SSSE3 beside SSE4, and what AVX-512 has gained since its beginnings. And vectors
// whose length is not known (SVE) cannot be members.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <numeric>

#include <hedgerow/primitives/placed_index.h>
#include <hedgerow/structures/bvh/build_tree.h>
#include <hedgerow/structures/bvh/wide/kernels.h>

#include "compiled.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {
#if HWY_TARGET != HWY_SCALAR

namespace hn = hwy::HWY_NAMESPACE;
// Each builds on those before it.
// clang-format off
#include "width-inl.h"
#include "rays-inl.h"
#include "reader-inl.h"
#include "picture-inl.h"
#include "tests-inl.h"
#include "stack-inl.h"
#include "single-inl.h"
#include "instances-inl.h"
#include "packet_rays-inl.h"
#include "packet_hits-inl.h"
#include "packet-inl.h"
#include "batch-inl.h"
#include "many-inl.h"
// clang-format on

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

Hit<float> closest_hit(const WideScene& scene, const Ray<float, 3>& ray) {
    return by_width<Answering<Wanted::closest>::template One>(scene, &ray);
}
bool any_hit(const WideScene& scene, const Ray<float, 3>& ray) {
    return by_width<Answering<Wanted::any>::template One>(scene, &ray);
}
KernelUse closest_hits(const WideScene& scene, const RayArray<float, 3>& rays, Hit<float>* hits) {
    return by_width<Answering<Wanted::closest>::template Many>(scene, &rays, hits);
}
KernelUse any_hits(const WideScene& scene, const RayArray<float, 3>& rays, bool* hits) {
    return by_width<Answering<Wanted::any>::template Many>(scene, &rays, hits);
}

Hit<float> closest_hit_of_instances(const WideInstances& scene, const Ray<float, 3>& ray) {
    return by_width<Answering<Wanted::closest>::template One>(scene, &ray);
}
bool any_hit_of_instances(const WideInstances& scene, const Ray<float, 3>& ray) {
    return by_width<Answering<Wanted::any>::template One>(scene, &ray);
}

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
        closest_hit, any_hit, closest_hits, any_hits, closest_hit_of_instances, any_hit_of_instances
};

#endif  // HWY_TARGET != HWY_SCALAR
}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

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
