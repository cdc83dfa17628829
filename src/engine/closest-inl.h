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

// The nearest primitive that has been tested, at first one behind all that are within the distance. Members
// are set one by one: a copy of the whole would wait for the stores of its parts.
template <class T>
HWY_INLINE void begin(Near<T, 3>& best, T max_distance2) {
    best.distance2 = max_distance2;
    best.primitive = best.element = no_primitive;
    best.point.data[0] = best.point.data[1] = best.point.data[2] = 0;
    best.instance = no_primitive;
}

// The closest of the triangles that leaves offer. Lanes only bound the distances: triangles that may be
// closest wait, and are tested exactly when all leaves are seen, if they still may be. An exact test takes as
// long as a leaf, and the first leaves have many triangles that later ones put out of reach.
template <class S>
class ClosestTriangle : public PointSearch<S> {
public:
    using Scene = S;
    using T = typename Scene::Scalar;
    // Keeps the nearer of what is tested.
    struct Best {
        Near<T, 3>* best;

        HWY_INLINE void take(std::uint32_t id, T distance2, const Vec<T, 3>& foot) const {
            if (distance2 > best->distance2 || (distance2 == best->distance2 && id > best->element)) return;
            best->distance2 = distance2;
            best->element = id;
            best->point = foot;
        }
    };
    struct Shared {
        const TriangleBlock<T>* blocks;
        ExactTests<T, Best> tests;

        HWY_INLINE explicit Shared(const Scene& scene) : blocks(scene.blocks), tests(scene.blocks) {}
        HWY_INLINE void end() { tests.flush(); }
    };

    ClosestTriangle() = default;
    HWY_INLINE ClosestTriangle(const Vec<T, 3>& p, Near<T, 3>& best)
        : PointSearch<S>(p, best.distance2), best_(&best) {}

    template <bool alone>
    HWY_INLINE void test(Shared& shared, std::uint32_t leaf) {
        if (count_ > most - 8) [[unlikely]]
            make_room(shared);
        V limit = hn::Set(d, limit_.distance2());
        for (int at = 0; at < 8; at += lanes) {
            const TriangleDistances<D> distances(d, shared.blocks[leaf], at, all_lanes(d, p_));
            const V upper = distances.least_most(d);
            if constexpr (alone) {
                if (hn::GetLane(upper) < hn::GetLane(limit)) limit = upper;
            } else {
                limit = hn::Min(limit, upper);
            }
            const FloatBounds<D> bounds(distances, limit);
            const auto near = hn::RebindMask(i, bounds.within);
            keep(hn::BitCast(i, bounds.least), near, least_);
            keep(hn::Add(hn::Set(i, static_cast<std::int32_t>(8 * leaf) + at), hn::Iota(i, 0)), near, place_);
            count_ += static_cast<int>(hn::CountTrue(i, near));
        }
        limit_.set(hn::GetLane(limit));
    }
    // Hands what waits and may still be closest to the exact tests.
    HWY_INLINE void end(Shared& shared) {
        const auto limit = hn::Set(f, limit_.as_float());
        for (int first = 0; first < count_; first += lanes) {
            const auto far = hn::Gt(hn::Load(f, reinterpret_cast<const float*>(least_ + first)), limit);
            unsigned near = ~bits_of(f, far) & ((1u << std::min(count_ - first, lanes)) - 1);
            for (; near != 0; near &= near - 1)
                shared.tests.add(p_, static_cast<std::uint32_t>(place_[first + std::countr_zero(near)]),
                                 {best_});
        }
        count_ = 0;
    }

private:
    using PointSearch<S>::p_, PointSearch<S>::limit_;
    static constexpr int most = 64;
    using D = hn::CappedTag<T, 8>;
    using V = hn::Vec<D>;
    static constexpr D d{};
    static constexpr hn::Rebind<float, D> f{};
    static constexpr hn::Rebind<std::int32_t, D> i{};
    static constexpr int lanes = static_cast<int>(hn::MaxLanes(d));

    // Appends the lanes of a mask to what waits.
    HWY_INLINE void keep(hn::Vec<decltype(i)> v, hn::Mask<decltype(i)> which, std::int32_t* all) {
        hn::StoreU(compressed(i, v, which), i, all + count_);
    }
    HWY_NOINLINE void make_room(Shared& shared) {
        end(shared);
        shared.tests.flush();
        if (best_->distance2 < limit_.distance2()) limit_.set(best_->distance2);
    }

    Near<T, 3>* best_ = nullptr;
    int count_ = 0;
    // Triangles that wait: the bits of a lower bound of the squared distance, and the place among those of
    // all blocks.
    alignas(32) std::int32_t least_[most], place_[most];
};

// The closest point of a cloud: lanes compute exactly.
class ClosestOfCloud : public PointSearch<WidePoints> {
public:
    struct Shared {
        const PointBlock<float, 3>* blocks;

        HWY_INLINE explicit Shared(const WidePoints& scene) : blocks(scene.blocks) {}
        HWY_INLINE void end() {}
    };

    ClosestOfCloud() = default;
    HWY_INLINE ClosestOfCloud(const Vec<float, 3>& p, Near<float, 3>& best)
        : PointSearch(p, best.distance2), best_(&best), key_(key_of(best.distance2, no_primitive)) {}

    template <bool alone>
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
        best_->distance2 = distance2_of(key_);
        best_->element = element_of(key_);
        best_->point = {at(0), at(1), at(2)};
    }

private:
    Near<float, 3>* best_ = nullptr;
    NearKey key_ = 0;
    std::uint32_t place_ = 0;
};

// Makes what a search has found its answer, when all is tested.
template <class Scene, class T>
HWY_INLINE void finish(const Scene& scene, Near<T, 3>& best) {
    if (best.element == no_primitive)
        best.distance2 = std::numeric_limits<T>::infinity();
    else
        best.primitive = scene.faces.empty() ? best.element : scene.faces[best.element];
    best.instance = 0;
}
HWY_INLINE void finish(const WidePoints&, Near<float, 3>& best) {
    if (best.element == no_primitive) best.distance2 = std::numeric_limits<float>::infinity();
    best.primitive = best.element;
    best.instance = 0;
}

template <int W, class Search, class T>
Near<T, 3> closest_one(const typename Search::Scene& scene, const Vec<T, 3>& p, T max_distance2) {
    Near<T, 3> best;
    begin(best, max_distance2);
    typename Search::Shared shared(scene);
    Search search(p, best);
    search_through<W>(scene, search, shared);
    shared.end();
    finish(scene, best);
    return best;
}
template <int W, class Search, class T>
void closest_many(const typename Search::Scene& scene, const PointBatch<T, 3>& points, T max_distance2,
                  Near<T, 3>* found) {
    for (std::size_t i = 0; i < points.size(); ++i) begin(found[points.number(i)], max_distance2);
    if (!scene.tree.empty() && max_distance2 >= 0) {
        typename Search::Shared shared(scene);
        Flights<W, Search>(scene, shared)
            .make(
                points.size(), [&](std::size_t i, int) __attribute__((always_inline)) {
                    return Search(points[i], found[points.number(i)]);
                });
        shared.end();
    }
    for (std::size_t i = 0; i < points.size(); ++i) finish(scene, found[points.number(i)]);
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
