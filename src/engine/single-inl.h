/// One ray against triangles.
#if defined(HEDGEROW_ENGINE_SINGLE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_SINGLE_INL_H
#undef HEDGEROW_ENGINE_SINGLE_INL_H
#else
#define HEDGEROW_ENGINE_SINGLE_INL_H
#endif

#include <cstdint>

#include <hwy/highway.h>

#include "tests-inl.h"
#include "walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A ray as an asker (see `walk`). `test(leaf)` tests the ray against the contents of a leaf and returns
// whether that gave it a hit.
template <int W, class Test>
class RayAsker {
public:
    HWY_INLINE RayAsker(WideRay& ray, Test test) : ray_(ray), test_(test) {}

    // What the test of boxes needs, as long as no leaf is tested.
    HWY_INLINE Slabs<W> slabs() const { return Slabs<W>(ray_); }
    HWY_INLINE bool test(std::uint32_t leaf) { return test_(leaf); }
    // The walk skips children that the ray enters beyond this s.
    HWY_INLINE float limit() const { return ray_.s_limit; }
    HWY_INLINE bool found() const { return ray_.element != Hit<float>::none; }

private:
    WideRay& ray_;
    Test test_;
};

template <int W, Wanted wanted>
bool trace_one(const WideScene& scene, WideRay& ray) {
    const auto test = [&](std::uint32_t leaf) __attribute__((always_inline)) {
        return test_triangles<wanted>(scene, leaf, ray, 0);
    };
    return walk<W, wanted>(scene.tree, RayAsker<W, decltype(test)>(ray, test));
}

template <int W, Wanted wanted>
HWY_INLINE auto cast_one(const WideScene& scene, const Ray<float, 3>& asked) {
    WideRay ray;
    prepare<W>(reinterpret_cast<const std::byte*>(&asked), scene.tree.bounds, 0.0f, ray);
    const bool hit = ray.usable && !scene.tree.empty() && trace_one<W, wanted>(scene, ray);
    if constexpr (wanted == Wanted::closest)
        return hit_of(scene, ray);
    else
        return hit;
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
