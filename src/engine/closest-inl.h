/// The searches for a closest point: of triangles, and among points.
#if defined(HEDGEROW_ENGINE_CLOSEST_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_CLOSEST_INL_H
#undef HEDGEROW_ENGINE_CLOSEST_INL_H
#else
#define HEDGEROW_ENGINE_CLOSEST_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>

#include <hedgerow/engine/kernels.h>
#include <hedgerow/queries/point_query.h>

#include "compiled.h"
#include "distances-inl.h"
#include "exact_tests-inl.h"
#include "search-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The nearest primitive that has been tested, at first one behind all that are within the distance.
HWY_INLINE Near<float, 3> nothing_within(float max_distance2) {
    return {max_distance2, no_primitive, no_primitive, {}, no_primitive};
}

// The closest of the triangles that leaves offer. Lanes only bound the distances: triangles that may be
// closest wait, and are tested exactly when all leaves are seen, if they still may be. An exact test takes as
// long as a leaf, and the first leaves have many triangles that later ones put out of reach.
class ClosestTriangle {
public:
    using Scene = WideScene;
    // Keeps the nearer of what is tested.
    struct Best {
        Near<float, 3>* best;

        HWY_INLINE void take(const TriangleBlock<float>& block, std::uint32_t place, float distance2,
                             const Vec<double, 3>& foot) const {
            const Near<float, 3> found{distance2, 0, block.id[place], {}};
            if (!nearer(found, *best)) return;
            *best = found;
            best->point = detail::clamped_into(block, place, foot);
        }
    };
    struct Shared {
        const TriangleBlock<float>* blocks;
        ExactTests<Best> tests;

        HWY_INLINE explicit Shared(const WideScene& scene) : blocks(scene.blocks), tests(scene.blocks) {}
        HWY_INLINE void end() { tests.flush(); }
    };

    ClosestTriangle() = default;
    HWY_INLINE ClosestTriangle(const Vec<float, 3>& p, Near<float, 3>& best) : p_(p), best_(&best) {
        limit_.set(best.distance2);
    }

    HWY_INLINE const Vec<float, 3>& point() const { return p_; }
    HWY_INLINE const Limit& limit() const { return limit_; }
    HWY_INLINE void test(Shared& shared, std::uint32_t leaf) {
        using F = Floats<8>;
        constexpr F f;
        constexpr int lanes = static_cast<int>(hn::MaxLanes(f));
        if (count_ > most - 8) [[unlikely]]
            make_room(shared);
        for (int at = 0; at < 8; at += lanes) {
            const TriangleDistances<F> distances(f, shared.blocks[leaf], at, all_lanes(f, p_));
            const float least = distances.least_most(f);
            if (least < limit_.distance2()) limit_.set(least);
            unsigned near = distances.within(f, limit_.distance2());
            if (near == 0) continue;
            alignas(64) float bounds[lanes];
            hn::Store(distances.least(), f, bounds);
            for (; near != 0; near &= near - 1) {
                const int i = std::countr_zero(near);
                waiting_[count_++] = {bounds[i], 8 * leaf + static_cast<std::uint32_t>(at + i)};
            }
        }
    }
    // Hands what waits and may still be closest to the exact tests.
    HWY_INLINE void end(Shared& shared) {
        for (int i = 0; i < count_; ++i)
            if (!(waiting_[i].least > limit_.distance2())) shared.tests.add(p_, waiting_[i].place, {best_});
        count_ = 0;
    }

private:
    static constexpr int most = 64;
    struct Waiting {
        float least;          // a lower bound of its squared distance
        std::uint32_t place;  // among the places of all blocks
    };

    HWY_NOINLINE void make_room(Shared& shared) {
        end(shared);
        shared.tests.flush();
        if (best_->distance2 < limit_.distance2()) limit_.set(best_->distance2);
    }

    Vec<float, 3> p_;
    Near<float, 3>* best_ = nullptr;
    Limit limit_;
    int count_ = 0;
    Waiting waiting_[most];
};

// The closest point of a cloud: lanes compute exactly.
class ClosestOfCloud {
public:
    using Scene = WidePoints;
    struct Shared {
        const PointBlock<float, 3>* blocks;

        HWY_INLINE explicit Shared(const WidePoints& scene) : blocks(scene.blocks) {}
        HWY_INLINE void end() {}
    };

    ClosestOfCloud() = default;
    HWY_INLINE ClosestOfCloud(const Vec<float, 3>& p, Near<float, 3>& best)
        : p_(p), best_(&best), key_(key_of(best.distance2, no_primitive)) {
        limit_.set(best.distance2);
    }

    HWY_INLINE const Vec<float, 3>& point() const { return p_; }
    HWY_INLINE const Limit& limit() const { return limit_; }
    HWY_INLINE void test(Shared& shared, std::uint32_t leaf) {
        const PointBlock<float, 3>& block = shared.blocks[leaf];
        for_each_within(
            block, p_, limit_.distance2(), [&](NearKey key, int i) __attribute__((always_inline)) {
                if (key >= key_) return;
                key_ = key;
                place_ = 8 * leaf + static_cast<std::uint32_t>(i);
            });
        if (distance2_of(key_) < limit_.distance2()) limit_.set(distance2_of(key_));
    }
    HWY_INLINE void end(Shared& shared) {
        if (element_of(key_) == no_primitive) return;
        const PointBlock<float, 3>& block = shared.blocks[place_ / 8];
        const auto at = [&](int axis) { return block.at[axis][place_ % 8]; };
        *best_ = {distance2_of(key_), 0, element_of(key_), {at(0), at(1), at(2)}};
    }

private:
    Vec<float, 3> p_;
    Near<float, 3>* best_ = nullptr;
    Limit limit_;
    NearKey key_ = 0;
    std::uint32_t place_ = 0;
};

// What a search reports, when all is tested.
HWY_INLINE Near<float, 3> reported(const WideScene& scene, Near<float, 3> best) {
    if (best.element == no_primitive) return {};
    best.primitive = scene.faces.empty() ? best.element : scene.faces[best.element];
    return best;
}
HWY_INLINE Near<float, 3> reported(const WidePoints&, Near<float, 3> best) {
    if (best.element == no_primitive) return {};
    best.primitive = best.element;
    return best;
}

template <int W, class Search>
Near<float, 3> closest_one(const typename Search::Scene& scene, const Vec<float, 3>& p, float max_distance2) {
    Near<float, 3> best = nothing_within(max_distance2);
    typename Search::Shared shared(scene);
    Search search(p, best);
    search_through<W>(scene, search, shared);
    shared.end();
    return reported(scene, best);
}
template <int W, class Search>
void closest_many(const typename Search::Scene& scene, const PointBatch<float, 3>& points,
                  float max_distance2, Near<float, 3>* found) {
    for (std::size_t i = 0; i < points.size(); ++i) found[points.number(i)] = nothing_within(max_distance2);
    if (!scene.tree.empty() && max_distance2 >= 0) {
        typename Search::Shared shared(scene);
        Flights<W, Search>(scene, shared)
            .make(
                points.size(), [&](std::size_t i, int) __attribute__((always_inline)) {
                    return Search(points[i], found[points.number(i)]);
                });
        shared.end();
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        Near<float, 3>& near = found[points.number(i)];
        near = reported(scene, near);
    }
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
