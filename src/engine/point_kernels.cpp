/// The kernels of points, compiled for each instruction set: Highway's foreach_target includes this file once
/// for each.
#include <hedgerow/engine/kernels.h>

#if HEDGEROW_HAS_HIGHWAY
#include "core/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/point_kernels.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#include "compiled.h"
#if HWY_TARGET != HWY_SCALAR
#include "closest-inl.h"
#include "count-inl.h"
#include "nearest-inl.h"
#include "width-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

template <class Search>
struct Closest {
    using Scene = typename Search::Scene;
    using T = typename Scene::Scalar;

    template <int W>
    struct Answer {
        static Near<T, 3> answer(const Scene& scene, const Vec<T, 3>* p, T max_distance2) {
            return closest_one<W, Search>(scene, *p, max_distance2);
        }
        static void answer(const Scene& scene, const PointBatch<T, 3>* points, T max_distance2,
                           Near<T, 3>* found) {
            closest_many<W, Search>(scene, *points, max_distance2, found);
        }
    };
    static Near<T, 3> one(const Scene& scene, const Vec<T, 3>& p, T max_distance2) {
        return by_width<Answer>(scene, &p, max_distance2);
    }
    static void many(const Scene& scene, const PointBatch<T, 3>& points, T max_distance2, Near<T, 3>* found) {
        by_width<Answer>(scene, &points, max_distance2, found);
    }
};

template <int W>
struct WalkToLeaves {
    template <class T>
    static void answer(const WideLeaves<T>& leaves, const Vec<T, 3>* p, T limit) {
        walk_to_leaves<W>(leaves, *p, limit);
    }
};
template <class T>
void walk_by_width(const WideLeaves<T>& leaves, const Vec<T, 3>& p, T limit) {
    by_width<WalkToLeaves>(leaves, &p, limit);
}
template <template <class> class Search, class Scene>
struct Keys {
    template <int W>
    struct Answer {
        template <class Sink>
        static Sink answer(const Scene& scene, const Vec<float, 3>* p, const Sink* sink) {
            return search_keys<W, Search>(scene, *p, *sink);
        }
        static void answer(const Scene& scene, const PointBatch<float, 3>* points, std::size_t k,
                           float max_distance2, PrimitiveId* ids, float* distances2) {
            nearest_many<W, Search>(scene, *points, k, max_distance2, ids, distances2);
        }
    };
    static std::size_t nearest(const Scene& scene, const Vec<float, 3>& p, std::size_t k, float max_distance2,
                               NearKey* keys) {
        if (k == 0 || !(max_distance2 >= 0)) return 0;
        const LeastKeys sink(k, max_distance2, keys, most_ties(scene));
        return by_width<Answer>(scene, &p, &sink).size();
    }
    static void nearest_of_many(const Scene& scene, const PointBatch<float, 3>& points, std::size_t k,
                                float max_distance2, PrimitiveId* ids, float* distances2) {
        by_width<Answer>(scene, &points, k, max_distance2, ids, distances2);
    }
    static void within(const Scene& scene, const Vec<float, 3>& p, float max_distance2, NearKeys& keys) {
        if (!(max_distance2 >= 0)) return;
        const KeysWithin sink(max_distance2, keys);
        by_width<Answer>(scene, &p, &sink);
    }
};

template <int W>
struct CountInBall {
    static std::size_t answer(const WidePoints& scene, const Sphere<float, 3>* ball) {
        return count_in_ball<W>(scene, *ball);
    }
};
std::size_t points_in_ball(const WidePoints& scene, const Sphere<float, 3>& ball) {
    return by_width<CountInBall>(scene, &ball);
}

template <class Search>
inline constexpr ClosestKernels<typename Search::Scene> closest_kernels = {Closest<Search>::one,
                                                                           Closest<Search>::many};
template <class Search, class Keys>
inline constexpr PointKernels<typename Search::Scene> kernels_of = {closest_kernels<Search>, Keys::nearest,
                                                                    Keys::nearest_of_many, Keys::within};

inline constexpr AllPointKernels point_kernels{
    kernels_of<ClosestTriangle<WideScene>, Keys<KeysOfTriangles, WideScene>>,
    kernels_of<ClosestOfCloud, Keys<KeysOfCloud, WidePoints>>,
    closest_kernels<ClosestTriangle<WideDoubles>>,
    walk_by_width<float>,
    walk_by_width<double>,
    points_in_ball};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET != HWY_SCALAR
#endif  // HEDGEROW_HAS_HIGHWAY

#if HWY_ONCE || !HEDGEROW_HAS_HIGHWAY
#include "core/in_use.h"

HEDGEROW_KERNELS_IN_USE(AllPointKernels, point_kernels)
#endif
