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

// The nearest float, or the largest.
template <class T>
HWY_INLINE float float_limit(T distance2) {
    return static_cast<float>(std::min(distance2, T(std::numeric_limits<float>::max())));
}

// The squared distance up to which a search looks, and that up to which its walk does. The distances of boxes
// are compared as floats; the nearest float never puts two numbers in the wrong order.
template <class T>
class Limit {
public:
    HWY_INLINE T distance2() const { return distance2_; }
    HWY_INLINE float as_float() const {
        if constexpr (std::is_same_v<T, float>)
            return distance2_;
        else
            return float_limit(distance2_);
    }
    HWY_INLINE float of_boxes() const { return of_boxes_; }
    HWY_INLINE void set(T distance2) {
        distance2_ = distance2;
        of_boxes_ = float_limit(limit_of_boxes(distance2));
    }

private:
    T distance2_ = 0;
    float of_boxes_ = 0;
};

// A search looks at the leaves that a walk brings it to. It has
// - Scene and Shared: the tree and its leaves, and what all searches of a batch have in common;
// - wanted: of near ones also limit_of_walk(), the `entry` beyond which no box can change its answer, of any
//   also ended(), whether it has its answer;
// - slabs<W>(), which tells what boxes it enters;
// - test(shared, leaf), which looks at the primitives of a leaf, and end(shared), when there are no more.

// What searches around a point have in common.
template <class S>
class PointSearch {
public:
    using Scene = S;
    using T = typename Scene::Scalar;
    static constexpr Wanted wanted = Wanted::near;

    PointSearch() = default;
    HWY_INLINE PointSearch(const Vec<T, 3>& p, T distance2) : p_(p) { limit_.set(distance2); }

    HWY_INLINE float limit_of_walk() const { return limit_.of_boxes(); }
    template <int W>
    HWY_INLINE auto slabs() const {
        return Reach<W, T>(p_, limit_.of_boxes());
    }

protected:
    Vec<T, 3> p_;
    Limit<T> limit_;
};

// A search as an asker (see `walk`).
template <int W, class Search>
class Searching {
public:
    HWY_INLINE Searching(Search& search, typename Search::Shared& shared)
        : search_(search), shared_(shared) {}

    HWY_INLINE auto slabs() const { return search_.template slabs<W>(); }
    HWY_INLINE bool test(std::uint32_t leaf) { return search_.template test<true>(shared_, leaf), found(); }
    HWY_INLINE float limit() const { return search_.limit_of_walk(); }
    HWY_INLINE bool found() const {
        if constexpr (Search::wanted == Wanted::any)
            return search_.ended();
        else
            return false;
    }

private:
    Search& search_;
    typename Search::Shared& shared_;
};
template <int W, class Search>
HWY_INLINE void search_through(const typename Search::Scene& scene, Search& search,
                               typename Search::Shared& shared) {
    bool begins = !scene.tree.empty();
    if constexpr (Search::wanted == Wanted::near) begins = begins && search.limit_of_walk() >= 0;
    if (begins) walk<W, Search::wanted>(scene.tree, Searching<W, Search>(search, shared));
    search.end(shared);
}

// A walk to leaves of any primitives, as an asker. A leaf takes longer than the sort of a node's children, so
// they are opened in their order.
template <int W, class T>
class LeavesAsker {
public:
    HWY_INLINE LeavesAsker(const WideLeaves<T>& leaves, const Vec<T, 3>& p, T limit)
        : leaves_(leaves), p_(p), limit_(limit) {}

    HWY_INLINE auto slabs() const { return Reach<W, T>(p_, limit()); }
    HWY_INLINE bool test(std::uint32_t leaf) {
        const T before = limit_;
        limit_ = leaves_.test(leaves_.asker, leaf);
        return limit_ < before;
    }
    HWY_INLINE float limit() const { return float_limit(limit_); }
    HWY_INLINE bool found() const { return false; }

private:
    const WideLeaves<T>& leaves_;
    const Vec<T, 3> p_;
    T limit_;
};
template <int W, class T>
void walk_to_leaves(const WideLeaves<T>& leaves, const Vec<T, 3>& p, T limit) {
    if (!leaves.tree.empty() && limit >= 0)
        walk<W, Wanted::closest>(leaves.tree, LeavesAsker<W, T>(leaves, p, limit));
}

// Several searches in flight, which advance in turns: all that stand at a node look at its boxes, then all
// that stand at a leaf look at its primitives, then all that have to go back pop a child. So no branch
// depends on what one search meets, the processor overlaps the searches' chains of operations, and what a
// search reads next is prefetched while the others compute.
template <int W, class Search>
class Flights {
public:
    static constexpr int most = 16;

    HWY_INLINE Flights(const typename Search::Scene& scene, typename Search::Shared& shared)
        : scene_(scene), shared_(shared), prefetch_(scene) {}

    // Makes `count` searches of a tree that is not empty: `begin(i, flight)` is search i, in the flight of
    // that number, of which there are `most`.
    template <class Begin>
    HWY_INLINE void make(std::size_t count, Begin begin) {
        const auto take_off = [&](int i) __attribute__((always_inline)) {
            flights_[i].stack.clear();
            flights_[i].word = 0;
            flights_[i].search = begin(next_++, i);
            at_nodes_.add(i, true);
        };
        for (int i = 0; i < most && next_ < count; ++i) take_off(i);
        while (at_nodes_.size + at_leaves_.size > 0) {
            at_nodes_.take_each([&](int i) __attribute__((always_inline)) { open(i); });
            at_leaves_.take_each([&](int i) __attribute__((always_inline)) {
                test(flights_[i]);
                back_.add(i, true);
            });
            back_.take_each([&](int i) __attribute__((always_inline)) { pop(i); });
            ended_.take_each([&](int i) __attribute__((always_inline)) {
                flights_[i].search.end(shared_);
                if (next_ < count) take_off(i);
            });
        }
    }

private:
    using T = typename Search::Scene::Scalar;
    using Stack = WalkStack<W, Search::wanted>;
    struct Flight {
        typename Stack::Place places[Stack::room(bvh_max_depth + 1)];
        Stack stack;
        std::uint32_t word;
        Search search;

        HWY_INLINE Flight() : stack(places, Stack::below, 0) {}
        HWY_INLINE std::uint32_t pop() {
            if constexpr (Search::wanted == Wanted::near)
                return stack.pop_lanes_within(search.limit_of_walk());
            else
                return stack.pop();
        }
    };
    // The numbers of some flights.
    struct Some {
        int size = 0;
        int all[most + 1];

        HWY_INLINE void add(int i, bool whether) {
            all[size] = i;
            size += whether;
        }
        // Calls f for each after it has been removed; f may add up to one for each.
        template <class F>
        HWY_INLINE void take_each(F f) {
            const int count = size;
            size = 0;
            for (int i = 0; i < count; ++i) f(all[i]);
        }
    };

    HWY_INLINE void open(int i) {
        Flight& flight = flights_[i];
        const std::byte* const node = scene_.tree.nodes.data() + flight.word * WideNodes<T, 3>::stride_of(W);
        const Boxes<W> boxes(node, flight.search.template slabs<W>());
        if constexpr (Search::wanted == Wanted::any) {
            return go_to(i, flight.stack.push_and_pop(boxes, children_of<W, T>(node)));
        }
        const bool entered = boxes.bits() != 0;
        std::uint32_t word = 0;
        if constexpr (Boxes<W>::parts == 1)
            word = flight.stack.push_others(boxes, children_of<W, T>(node));
        else if (entered)
            word = flight.stack.push_others(boxes, children_of<W, T>(node));
        flight.word = word;
        prefetch_(word);
        const bool leaf = (word & WideChild::leaf_bit) != 0;
        at_nodes_.add(i, entered && !leaf);
        at_leaves_.add(i, entered && leaf);
        back_.add(i, !entered);
    }
    HWY_INLINE void test(Flight& flight) {
        flight.search.template test<false>(shared_, flight.word & ~WideChild::leaf_bit);
        if constexpr (Search::wanted == Wanted::any)
            if (flight.search.ended()) [[unlikely]]
                flight.stack.clear();
    }
    HWY_INLINE void pop(int i) { go_to(i, flights_[i].pop()); }
    HWY_INLINE void go_to(int i, std::uint32_t word) {
        flights_[i].word = word;
        prefetch_(word == Stack::end ? 0 : word);  // without a branch
        const bool leaf = (word & WideChild::leaf_bit) != 0;
        at_nodes_.add(i, !leaf);
        at_leaves_.add(i, leaf && word != Stack::end);
        ended_.add(i, word == Stack::end);
    }

    const typename Search::Scene& scene_;
    typename Search::Shared& shared_;
    const Prefetch<W, typename Search::Scene> prefetch_;
    std::size_t next_ = 0;
    Some at_nodes_, at_leaves_, back_, ended_;
    Flight flights_[most];
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
