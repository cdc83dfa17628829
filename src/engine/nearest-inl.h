/// The searches for several primitives: the k nearest, and all within a distance.
#if defined(HEDGEROW_ENGINE_NEAREST_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_NEAREST_INL_H
#undef HEDGEROW_ENGINE_NEAREST_INL_H
#else
#define HEDGEROW_ENGINE_NEAREST_INL_H
#endif

#include <cstddef>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>

#include <hedgerow/engine/kernels.h>

#include "distances-inl.h"
#include "exact_tests-inl.h"
#include "search-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The k least keys, ascending, in memory of the caller. A key that counts is inserted from the end on: k is
// small as a rule, and most keys that count late in a search are among the last.
class LeastKeys {
public:
    LeastKeys() = default;
    HWY_INLINE LeastKeys(std::size_t k, float max_distance2, NearKey* keys)
        : keys_(keys), k_(k), max_(key_of(max_distance2, no_primitive)) {}

    HWY_INLINE std::size_t size() const { return size_; }
    HWY_INLINE float distance2() const { return distance2_of(last()); }
    HWY_INLINE void take(NearKey key) {
        if (key >= last()) return;
        std::size_t place = size_ < k_ ? size_++ : k_ - 1;
        for (; place > 0 && keys_[place - 1] > key; --place) keys_[place] = keys_[place - 1];
        keys_[place] = key;
    }
    HWY_INLINE void end() const {}

protected:
    NearKey* keys_ = nullptr;
    std::size_t k_ = 0, size_ = 0;

private:
    // What a key must be less than.
    HWY_INLINE NearKey last() const { return size_ < k_ ? max_ : keys_[k_ - 1]; }

    NearKey max_ = 0;
};
// The k least keys, which are written to a row of each of a caller's columns at the end.
class LeastKeysInRow : public LeastKeys {
public:
    LeastKeysInRow() = default;
    HWY_INLINE LeastKeysInRow(std::size_t k, float max_distance2, NearKey* keys, PrimitiveId* ids,
                              float* distances2)
        : LeastKeys(k, max_distance2, keys), ids_(ids), distances2_(distances2) {}

    HWY_INLINE void end() const {
        const NearKey none = key_of(std::numeric_limits<float>::infinity(), no_primitive);
        for (std::size_t i = size_; i < k_; ++i) keys_[i] = none;
        if (ids_ != nullptr)
            for (std::size_t i = 0; i < k_; ++i) ids_[i] = element_of(keys_[i]);
        if (distances2_ != nullptr)
            for (std::size_t i = 0; i < k_; ++i) distances2_[i] = distance2_of(keys_[i]);
    }

private:
    PrimitiveId* ids_ = nullptr;
    float* distances2_ = nullptr;
};
// All keys within a distance.
class KeysWithin {
public:
    HWY_INLINE KeysWithin(float max_distance2, NearKeys& keys) : keys_(keys), distance2_(max_distance2) {}

    HWY_INLINE float distance2() const { return distance2_; }
    HWY_INLINE void take(NearKey key) {
        if (keys_.size == keys_.room) keys_.grow(keys_);
        keys_.keys[keys_.size++] = key;
    }
    HWY_INLINE void end() const {}

private:
    NearKeys& keys_;
    float distance2_;
};

// A search that gives the keys of the points within its limit to a sink: LeastKeys or KeysWithin.
template <class Sink>
class KeysOfCloud {
public:
    using Scene = WidePoints;
    struct Shared {
        const PointBlock<float, 3>* blocks;

        HWY_INLINE explicit Shared(const WidePoints& scene) : blocks(scene.blocks) {}
    };

    KeysOfCloud() = default;
    HWY_INLINE KeysOfCloud(const Vec<float, 3>& p, const Sink& sink) : p_(p), sink_(sink) {
        limit_.set(sink.distance2());
    }
    HWY_INLINE const Vec<float, 3>& point() const { return p_; }
    HWY_INLINE const Limit& limit() const { return limit_; }
    HWY_INLINE const Sink& sink() const { return sink_; }
    HWY_INLINE void test(Shared& shared, std::uint32_t leaf) {
        for_each_within(
            shared.blocks[leaf], p_,
            limit_.distance2(), [&](NearKey key, int) __attribute__((always_inline)) { sink_.take(key); });
        if (sink_.distance2() < limit_.distance2()) limit_.set(sink_.distance2());
    }
    HWY_INLINE void end(Shared&) { sink_.end(); }

private:
    Vec<float, 3> p_;
    Sink sink_;
    Limit limit_;
};

// The same of triangles: those whose bounds are within the limit are tested exactly.
template <class Sink>
class KeysOfTriangles {
public:
    using Scene = WideScene;
    struct Taker {
        Sink* sink;

        HWY_INLINE void take(const TriangleBlock<float>& block, std::uint32_t place, float distance2,
                             const Vec<double, 3>&) const {
            if (distance2 <= sink->distance2()) sink->take(key_of(distance2, block.id[place]));
        }
    };
    struct Shared {
        const TriangleBlock<float>* blocks;
        ExactTests<Taker> tests;

        HWY_INLINE explicit Shared(const WideScene& scene) : blocks(scene.blocks), tests(scene.blocks) {}
    };

    KeysOfTriangles() = default;
    HWY_INLINE KeysOfTriangles(const Vec<float, 3>& p, const Sink& sink) : p_(p), sink_(sink) {
        limit_.set(sink.distance2());
    }
    HWY_INLINE const Vec<float, 3>& point() const { return p_; }
    HWY_INLINE const Limit& limit() const { return limit_; }
    HWY_INLINE const Sink& sink() const { return sink_; }
    HWY_INLINE void test(Shared& shared, std::uint32_t leaf) {
        using F = Floats<8>;
        constexpr F f;
        constexpr int lanes = static_cast<int>(hn::MaxLanes(f));
        for (int at = 0; at < 8; at += lanes) {
            const TriangleDistances<F> distances(f, shared.blocks[leaf], at, all_lanes(f, p_));
            for (unsigned near = distances.within(f, limit_.distance2()); near != 0; near &= near - 1)
                shared.tests.add(p_, 8 * leaf + static_cast<std::uint32_t>(at + std::countr_zero(near)),
                                 {&sink_});
        }
        shared.tests.flush();
        if (sink_.distance2() < limit_.distance2()) limit_.set(sink_.distance2());
    }
    HWY_INLINE void end(Shared&) { sink_.end(); }

private:
    Vec<float, 3> p_;
    Sink sink_;
    Limit limit_;
};

// The sink when a search for a point is over.
template <int W, template <class> class Search, class Sink, class Scene>
Sink search_keys(const Scene& scene, const Vec<float, 3>& p, const Sink& sink) {
    typename Search<Sink>::Shared shared(scene);
    Search<Sink> search(p, sink);
    search_through<W>(scene, search, shared);
    return search.sink();
}
template <int W, template <class> class Search, class Scene>
void nearest_many(const Scene& scene, const PointBatch<float, 3>& points, std::size_t k, float max_distance2,
                  PrimitiveId* ids, float* distances2) {
    using Searches = Flights<W, Search<LeastKeysInRow>>;
    NearKey keys[Searches::most][most_nearest];
    const auto sink = [&](std::size_t i, int flight) __attribute__((always_inline)) {
        const std::size_t first = k * points.number(i);
        return LeastKeysInRow(k, max_distance2, keys[flight], ids == nullptr ? nullptr : ids + first,
                              distances2 == nullptr ? nullptr : distances2 + first);
    };
    if (scene.tree.empty() || !(max_distance2 >= 0)) {
        for (std::size_t i = 0; i < points.size(); ++i) sink(i, 0).end();
        return;
    }
    typename Search<LeastKeysInRow>::Shared shared(scene);
    Searches(scene, shared).make(
        points.size(), [&](std::size_t i, int flight) __attribute__((always_inline)) {
            return Search<LeastKeysInRow>(points[i], sink(i, flight));
        });
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
