/// The first hits of a ray after a place (queries/first_hits.h), among triangles.
#if defined(HEDGEROW_ENGINE_FIRST_HITS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_FIRST_HITS_INL_H
#undef HEDGEROW_ENGINE_FIRST_HITS_INL_H
#else
#define HEDGEROW_ENGINE_FIRST_HITS_INL_H
#endif

#include <algorithm>
#include <cstddef>
#include <span>

#include <hwy/highway.h>

#include <hedgerow/queries/first_hits.h>

#include "single-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

// Tests leaves for the first hits. Once the array is full its last hit takes the place that the closest hit
// has in other walks: the ray's limit, and the element that wins a tie.
class FirstHitsTest {
public:
    HWY_INLINE FirstHitsTest(const WideScene& scene, WideRay& ray, SortedHits<float>& hits)
        : scene_(scene), ray_(ray), hits_(hits) {}

    // Whether the limit has shrunk.
    HWY_INLINE bool operator()(std::uint32_t leaf) {
        const float before = ray_.t_limit;
        const auto offer = [&](float t, float u, float v, std::uint32_t id) {
            insert(t, u, v, id);
            return false;  // the ray keeps its limit, which `insert` has set
        };
        test_block<Wanted::closest>(scene_.blocks[leaf], ray_, offer);
        if (ray_.t_limit == before) return false;
        ray_.s_limit = s_limit_of(ray_.t_limit, ray_.z_length);
        return true;
    }

private:
    HWY_INLINE void insert(float t, float u, float v, std::uint32_t id) {
        const std::size_t place = hits_.place_of(RayCandidate<float>{t, u, v, id, scene_.instance});
        if (place == SortedHits<float>::nowhere) return;
        if (scene_.filter.keeps != nullptr && !kept(scene_, 0, t, u, v, id)) return;
        hits_.insert(place, hit_of(scene_, t, u, v, id));
        if (!hits_.full()) return;
        ray_.t_limit = hits_.back().t;
        ray_.element = hits_.back().element;
    }

    const WideScene& scene_;
    WideRay& ray_;
    SortedHits<float>& hits_;
};

template <int W>
std::size_t first_hits_of(const WideScene& scene, Ray<float, 3> asked, std::span<Hit<float>> hits,
                          const PlaceOfHit<float>& after) {
    if (hits.empty() || after.at_end() || scene.tree.empty()) return 0;
    asked.t_min = std::max(asked.t_min, after.t);
    WideRay ray;
    prepare<W>(reinterpret_cast<const std::byte*>(&asked), scene.tree.bounds, 0.0f, ray);
    if (!ray.usable) return 0;
    SortedHits<float> found(hits, after);
    const FirstHitsTest test(scene, ray, found);
    walk<W, Wanted::closest>(scene.tree, RayAsker<W, FirstHitsTest>(ray, test));
    return found.size();
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
