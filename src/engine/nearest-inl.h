/// The searches for several primitives: the k nearest, and all within a distance.
#if defined(HEDGEROW_ENGINE_NEAREST_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_NEAREST_INL_H
#undef HEDGEROW_ENGINE_NEAREST_INL_H
#else
#define HEDGEROW_ENGINE_NEAREST_INL_H
#endif

#include <algorithm>
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

// The lanes moved up by one, and the last to the first.
template <class D>
HWY_INLINE hn::Vec<D> turned(D d, hn::Vec<D> v) {
    alignas(64) constexpr hn::TFromD<D> from[] = {hn::MaxLanes(d) - 1, 0, 1, 2, 3, 4, 5, 6};
    return hn::TableLookupLanes(v, hn::SetTableIndices(d, from));
}

// The k least keys, ascending, in aligned memory of the caller: `room(k)` places, which are filled with a key
// that stands for none. A key is inserted in vectors: place i then has the greater of the key and what was at
// i − 1, or what was at i if that is less. No branch depends on where it belongs.
class LeastKeys {
public:
    using K = hn::CappedTag<std::int64_t, 8>;  // keys have no sign
    static constexpr std::size_t lanes = hn::MaxLanes(K());
    static constexpr std::size_t room(std::size_t k) { return (k + lanes - 1) / lanes * lanes; }
    static_assert(most_nearest % lanes == 0);

    LeastKeys() = default;
    HWY_INLINE LeastKeys(std::size_t k, float max_distance2, NearKey* keys, int most_ties)
        : keys_(keys), k_(k), none_(key_of(max_distance2, no_primitive)), ties_left_(most_ties) {
        std::fill(keys_, keys_ + room(k), none_);
    }

    // Whether too many points were as far away as the last key, and behind it. The search then soon ends,
    // since nothing is within a distance of NaN.
    HWY_INLINE bool given_up() const { return ties_left_ < 0; }
    HWY_INLINE std::size_t size() const {
        if (given_up()) return gave_up;
        return static_cast<std::size_t>(std::lower_bound(keys_, keys_ + k_, none_) - keys_);
    }
    HWY_INLINE float distance2() const {
        return given_up() ? std::numeric_limits<float>::quiet_NaN() : distance2_of(keys_[k_ - 1]);
    }
    HWY_INLINE void take(NearKey key) {
        if (const NearKey last = keys_[k_ - 1]; key >= last) {
            ties_left_ -= (key ^ last) >> 32 == 0;
            return;
        }
        constexpr K d;
        const auto first = hn::FirstN(d, 1);
        const auto inserted = hn::Set(d, static_cast<std::int64_t>(key));
        std::size_t at = room(k_) - lanes;
        auto here = hn::Load(d, place(at)), up = turned(d, here);
        for (; at > 0; at -= lanes) {
            const auto before = hn::Load(d, place(at - lanes));
            const auto up_before = turned(d, before);
            const auto shifted = hn::IfThenElse(first, up_before, up);
            hn::Store(hn::Min(here, hn::Max(shifted, inserted)), d, place(at));
            here = before, up = up_before;
        }
        const auto shifted = hn::IfThenElse(first, inserted, up);
        hn::Store(hn::Min(here, hn::Max(shifted, inserted)), d, place(0));
    }
    HWY_INLINE void end() const {}

protected:
    HWY_INLINE bool none(std::size_t i) const { return keys_[i] == none_; }
    HWY_INLINE NearKey key(std::size_t i) const { return keys_[i]; }
    HWY_INLINE std::size_t k() const { return k_; }

private:
    HWY_INLINE std::int64_t* place(std::size_t i) const { return reinterpret_cast<std::int64_t*>(keys_ + i); }
    NearKey* keys_ = nullptr;
    std::size_t k_ = 0;
    NearKey none_ = 0;
    int ties_left_ = 0;
};
// The k least keys, which are written to a row of each of a caller's columns at the end.
class LeastKeysInRow : public LeastKeys {
public:
    LeastKeysInRow() = default;
    HWY_INLINE LeastKeysInRow(std::size_t k, float max_distance2, NearKey* keys, PrimitiveId* ids,
                              float* distances2, int most_ties)
        : LeastKeys(k, max_distance2, keys, most_ties), ids_(ids), distances2_(distances2) {}

    HWY_INLINE void end() const {
        if (given_up()) {
            *ids_ = gave_up_id;
            return;
        }
        for (std::size_t i = 0; i < k(); ++i) ids_[i] = element_of(key(i));
        for (std::size_t i = 0; i < k(); ++i)
            distances2_[i] = none(i) ? std::numeric_limits<float>::infinity() : distance2_of(key(i));
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
class KeysOfCloud : public PointSearch<WidePoints> {
public:
    struct Shared {
        const PointBlock<float, 3>* blocks;

        HWY_INLINE explicit Shared(const WidePoints& scene) : blocks(scene.blocks) {}
    };

    KeysOfCloud() = default;
    HWY_INLINE KeysOfCloud(const Vec<float, 3>& p, const Sink& sink)
        : PointSearch(p, sink.distance2()), sink_(sink) {}
    HWY_INLINE const Sink& sink() const { return sink_; }
    template <bool alone>
    HWY_INLINE void test(Shared& shared, std::uint32_t leaf) {
        for_each_within(
            shared.blocks[leaf], p_,
            limit_.distance2(), [&](NearKey key, int) __attribute__((always_inline)) { sink_.take(key); });
        if (!(sink_.distance2() >= limit_.distance2())) limit_.set(sink_.distance2());
    }
    HWY_INLINE void end(Shared&) { sink_.end(); }

private:
    Sink sink_;
};

// The same of triangles: those whose bounds are within the limit are tested exactly.
template <class Sink>
class KeysOfTriangles : public PointSearch<WideScene> {
public:
    struct Taker {
        Sink* sink;

        HWY_INLINE void take(std::uint32_t id, float distance2, const Vec<float, 3>&) const {
            if (distance2 <= sink->distance2()) sink->take(key_of(distance2, id));
        }
    };
    struct Shared {
        const TriangleBlock<float>* blocks;
        ExactTests<float, Taker> tests;

        HWY_INLINE explicit Shared(const WideScene& scene) : blocks(scene.blocks), tests(scene.blocks) {}
    };

    KeysOfTriangles() = default;
    HWY_INLINE KeysOfTriangles(const Vec<float, 3>& p, const Sink& sink)
        : PointSearch(p, sink.distance2()), sink_(sink) {}
    HWY_INLINE const Sink& sink() const { return sink_; }
    template <bool alone>
    HWY_INLINE void test(Shared& shared, std::uint32_t leaf) {
        using F = Floats<8>;
        constexpr F f;
        constexpr int lanes = static_cast<int>(hn::MaxLanes(f));
        for (int at = 0; at < 8; at += lanes) {
            const TriangleDistances<F> distances(f, shared.blocks[leaf], at, all_lanes(f, p_));
            for (unsigned near = bits_of(f, distances.within(hn::Set(f, limit_.distance2()))); near != 0;
                 near &= near - 1)
                shared.tests.add(p_, 8 * leaf + static_cast<std::uint32_t>(at + std::countr_zero(near)),
                                 {&sink_});
        }
        shared.tests.flush();
        if (sink_.distance2() < limit_.distance2()) limit_.set(sink_.distance2());
    }
    HWY_INLINE void end(Shared&) { sink_.end(); }

private:
    Sink sink_;
};

HWY_INLINE int most_ties(const WidePoints& scene) {
    return scene.most_ties();
}
HWY_INLINE int most_ties(const WideScene&) {
    return std::numeric_limits<int>::max();
}

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
    alignas(64) NearKey keys[Searches::most][most_nearest];
    const auto sink = [&](std::size_t i, int flight) __attribute__((always_inline)) {
        const std::size_t first = k * points.number(i);
        return LeastKeysInRow(k, max_distance2, keys[flight], ids + first, distances2 + first,
                              most_ties(scene));
    };
    if (scene.tree.empty() || !(max_distance2 >= 0)) {
        for (std::size_t i = 0; i < points.size(); ++i) sink(i, 0).end();
        return;
    }
    typename Search<LeastKeysInRow>::Shared shared(scene);
    Searches(scene, shared)
        .make(
            points.size(), [&](std::size_t i, int flight) __attribute__((always_inline)) {
                return Search<LeastKeysInRow>(points[i], sink(i, flight));
            });
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
