/// The searches of points: one, and several in flight.
#if defined(HEDGEROW_ENGINE_SEARCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_SEARCH_INL_H
#undef HEDGEROW_ENGINE_SEARCH_INL_H
#else
#define HEDGEROW_ENGINE_SEARCH_INL_H
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include <hwy/highway.h>

#include <hedgerow/engine/kernels.h>

#include "distances-inl.h"
#include "prefetch-inl.h"
#include "walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The squared distance up to which a search looks, and that up to which its walk does.
class Limit {
public:
    HWY_INLINE float distance2() const { return distance2_; }
    HWY_INLINE float of_boxes() const { return of_boxes_; }
    HWY_INLINE void set(float distance2) {
        distance2_ = distance2;
        of_boxes_ = std::min(limit_of_boxes(distance2), std::numeric_limits<float>::max());
    }

private:
    float distance2_ = 0, of_boxes_ = 0;
};

// A search looks at the leaves that a walk brings it to. It has
// - Scene and Shared: the tree and its leaves, and what all searches of a batch have in common;
// - point(), and limit(), which is a Limit;
// - test(shared, leaf), which looks at the primitives of a leaf, and end(shared), when there are no more.

// A search as an asker (see `walk`).
template <int W, class Search>
class Searching {
public:
    HWY_INLINE Searching(Search& search, typename Search::Shared& shared)
        : search_(search), shared_(shared) {}

    HWY_INLINE Reach<W> slabs() const { return Reach<W>(search_.point(), search_.limit().of_boxes()); }
    HWY_INLINE bool test(std::uint32_t leaf) { return search_.test(shared_, leaf), false; }
    HWY_INLINE float limit() const { return search_.limit().of_boxes(); }
    HWY_INLINE bool found() const { return false; }

private:
    Search& search_;
    typename Search::Shared& shared_;
};
template <int W, class Search>
HWY_INLINE void search_through(const typename Search::Scene& scene, Search& search,
                               typename Search::Shared& shared) {
    if (!scene.tree.empty() && search.limit().distance2() >= 0)
        walk<W, Wanted::near>(scene.tree, Searching<W, Search>(search, shared));
    search.end(shared);
}

// Several searches in flight. Each goes down to its next leaf, one after the other, and then each tests its
// leaf: a leaf's test is a long chain of operations that wait for each other, which the processor overlaps
// with those of the other searches; and what a search reads next is prefetched while the others compute.
template <int W, class Search>
class Flights {
public:
    static constexpr int most = 8;

    HWY_INLINE Flights(const typename Search::Scene& scene, typename Search::Shared& shared)
        : scene_(scene), shared_(shared), prefetch_(scene) {}

    // Makes `count` searches of a tree that is not empty: `begin(i, flight)` is search i, in the flight of
    // that number, of which there are `most`.
    template <class Begin>
    HWY_INLINE void make(std::size_t count, Begin begin) {
        const auto take_off = [&](int i) __attribute__((always_inline)) {
            Flight& flight = flights_[i];
            flight.stack.clear();
            flight.word = 0;
            flight.search = begin(next_++, i);
        };
        for (int i = 0; i < most && next_ < count; ++i) order_[active_++] = i, take_off(i);
        while (active_ > 0) {
            for (int i = 0; i < active_; ++i) go_down(flights_[order_[i]]);
            for (int i = active_; i-- > 0;) {
                Flight& flight = flights_[order_[i]];
                if (flight.word != Stack::end) {
                    look(flight);
                    continue;
                }
                flight.search.end(shared_);
                if (next_ < count)
                    take_off(order_[i]);
                else
                    std::swap(order_[i], order_[--active_]);
            }
        }
    }

private:
    using Stack = WalkStack<W, Wanted::near>;
    struct Flight {
        typename Stack::Place places[Stack::room(bvh_max_depth + 1)];
        Stack stack;
        std::uint32_t word;
        Search search;

        HWY_INLINE Flight() : stack(places, 0, 0) {}
        HWY_INLINE float limit() const { return search.limit().of_boxes(); }
    };

    HWY_INLINE void go_down(Flight& flight) {
        const Reach<W> reach(flight.search.point(), flight.limit());
        flight.word = down<W, Wanted::near>(
            scene_.tree.nodes.data(), reach, flight.stack, flight.word, [&]() __attribute__((always_inline)) {
                return flight.stack.pop_within(flight.limit());
            });
        prefetch(flight.word);
    }
    HWY_INLINE void look(Flight& flight) {
        flight.search.test(shared_, flight.word & ~WideChild::leaf_bit);
        flight.word = flight.stack.pop_within(flight.limit());
        prefetch(flight.word);
    }
    HWY_INLINE void prefetch(std::uint32_t word) const {
        if (word != Stack::end) prefetch_(word);
    }

    const typename Search::Scene& scene_;
    typename Search::Shared& shared_;
    const Prefetch<W, typename Search::Scene> prefetch_;
    std::size_t next_ = 0;
    int active_ = 0;
    int order_[most];  // the active flights first
    Flight flights_[most];
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
