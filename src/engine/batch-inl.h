/// Rays of a batch that share no path, up to 32 in flight: while one ray waits for memory the others
/// compute. Each step of a phase is the same for all rays in it. It has few branches that depend on data,
/// since a mispredicted branch would cost the other rays their work too.
#if defined(HEDGEROW_ENGINE_BATCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_BATCH_INL_H
#undef HEDGEROW_ENGINE_BATCH_INL_H
#else
#define HEDGEROW_ENGINE_BATCH_INL_H
#endif

#include <algorithm>

#include <hwy/highway.h>

#include "core/caches.h"

#include "prefetch-inl.h"
#include "reader-inl.h"
#include "tests-inl.h"
#include "walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <int W, Wanted wanted>
class Batch {
public:
    /// For the rays from `begin` to `end`, without `end`.
    Batch(const WideScene& scene, const RayArray<float, 3>& rays, std::size_t begin, std::size_t end)
        : scene_(scene),
          nodes_(scene.tree.nodes.data()),
          prefetch_(scene),
          prefetches_(scene.tree.nodes.bytes() > nodes_at_hand()),
          asked_(rays),
          next_(begin),
          end_(end) {
        room_ = Stack::room(scene.tree.depth);
        slots_ = std::min(most_slots, stack_places / room_);
    }

    template <class Answer>
    void answer(Answer* answers) {
        scene_.filter.keeps == nullptr ? cast_all<false>(answers) : cast_all<true>(answers);
    }

private:
    // Rays in flight, and how many of them must be at a leaf before leaves are tested. 16 to 64 rays and 6
    // to 48 leaves differ by no more than noise (docs/design/008-wide-bvh.md).
    static constexpr int most_slots = 32, enough_leaves = 16;
    static constexpr int stack_places = most_slots * 256;
    using Stack = WalkStack<W, wanted>;

    /// Whether there is a filter is a template parameter, since checking it at each leaf makes any hit 3%
    /// slower.
    template <bool filtered, class Answer>
    void cast_all(Answer* answers) {
        int inner = 0, leaf = 0;
        // Start a ray in each slot.
        for (int s = 0; s < slots_; ++s)
            if (begin(s, answers)) inner_[inner++] = s;
        while (inner + leaf > 0) {
            // Open the node of each ray that is at one. A ray whose next word is a leaf (or the end) changes
            // to the other list. Both lists are written and one of them grows, so there is no branch.
            int still = 0;
            for (int i = 0; i < inner; ++i) {
                const int s = inner_[i];
                open_node(s);
                inner_[still] = leaf_[leaf] = s;
                const bool at_leaf = (word_[s] & WideChild::leaf_bit) != 0;
                still += !at_leaf, leaf += at_leaf;
            }
            inner = still;
            // Open more nodes until there are enough leaves.
            if (leaf < enough_leaves && inner > 0) continue;
            // Test the leaf of each ray that is at one. A ray that ends leaves its slot to the next ray.
            const int leaves = leaf;
            leaf = 0;
            for (int i = 0; i < leaves; ++i) {
                const int s = leaf_[i];
                bool goes_on = word_[s] != Stack::end && test_leaf<filtered>(s);
                if (!goes_on) {
                    end(s, answers);
                    goes_on = begin(s, answers);
                }
                if (!goes_on) continue;
                const bool at_leaf = (word_[s] & WideChild::leaf_bit) != 0;
                leaf_[leaf] = inner_[inner] = s;
                leaf += at_leaf, inner += !at_leaf;
            }
        }
    }

    /// Starts the next usable ray in slot s. Rays that are not usable get their answers at once. False if no
    /// ray is left.
    template <class Answer>
    HWY_INLINE bool begin(int s, Answer* answers) {
        do {
            if (next_ == end_) return false;
            index_[s] = next_;
            prepare<W>(asked_.at(next_++), scene_.tree.bounds, 0.0f, ray_[s]);
            if (!ray_[s].usable) end(s, answers);
        } while (!ray_[s].usable);
        Stack stack = stack_of(s);
        stack.clear();
        top_[s] = stack.top();
        word_[s] = 0;
        return true;
    }
    template <class Answer>
    HWY_INLINE void end(int s, Answer* answers) {
        if constexpr (wanted == Wanted::closest)
            answers[index_[s]] = hit_of(scene_, ray_[s]);
        else
            answers[index_[s]] = ray_[s].element != Hit<float>::none;
    }

    HWY_INLINE Stack stack_of(int s) { return {stack_, s * room_, top_[s]}; }
    HWY_INLINE void pop(int s, Stack& stack) {
        word_[s] = stack.pop();
        top_[s] = stack.top();
        if (prefetches_) prefetch_(word_[s]);
    }
    HWY_INLINE void open_node(int s) {
        const std::byte* const node = nodes_ + word_[s] * WideNodes<float, 3>::stride_of(W);
        Stack stack = stack_of(s);
        const Boxes<W> boxes(node, Slabs<W>(ray_[s]));
        stack.push(boxes, children_of<W>(node));
        pop(s, stack);
    }
    /// Tests the leaf of slot s and pops the next word. False if the ray has its answer.
    template <bool filtered>
    HWY_INLINE bool test_leaf(int s) {
        Stack stack = stack_of(s);
        const std::uint32_t leaf = word_[s] & ~WideChild::leaf_bit;
        if (filtered ? test_block_filtered(scene_, leaf, ray_[s], index_[s])
                     : test_block<wanted>(scene_.blocks[leaf], ray_[s])) {
            if constexpr (wanted == Wanted::any)
                return false;
            else
                stack.sweep(ray_[s].s_limit);
        }
        pop(s, stack);
        return word_[s] != Stack::end;
    }

    const WideScene& scene_;
    const std::byte* const nodes_;
    const Prefetch<W> prefetch_;
    const bool prefetches_;
    RayReader asked_;
    std::size_t next_, end_;
    int slots_, room_;
    alignas(64) WideRay ray_[most_slots];
    std::uint32_t word_[most_slots];
    int top_[most_slots];
    std::size_t index_[most_slots];
    int inner_[2 * most_slots], leaf_[2 * most_slots];
    typename Stack::Place stack_[stack_places];
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
