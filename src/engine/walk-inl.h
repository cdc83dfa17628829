/// The walk of the kernels: opens the nearest entered child first and keeps the others on a stack, sorted by
/// distance. For any hit the order is free.
#if defined(HEDGEROW_ENGINE_WALK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_WALK_INL_H
#undef HEDGEROW_ENGINE_WALK_INL_H
#else
#define HEDGEROW_ENGINE_WALK_INL_H
#endif

#include <bit>
#include <cstdint>

#include <hwy/highway.h>

#include <hedgerow/structures/bvh/build_tree.h>

#include "stack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Whether the asker wants the nearest of all answers, or stops at the first.
enum class Wanted { closest, any };

// Tests the leaves that can have an asker's answer, and returns whether it found one. An asker has
// - boxes(node): which children of a node it enters, and at which distance;
// - test(leaf): whether the leaf's primitives changed its answer;
// - limit(): the distance beyond which nothing changes its answer;
// - found(): whether it has an answer.
template <int W, Wanted wanted, class Asker>
HWY_INLINE bool walk(const WideTree<float, 3>& tree, Asker asker) {
    // The stack, with room for the deepest tree.
    using Stack = WalkStack<W>;
    constexpr int room = Stack::room(bvh_max_depth + 1);
    std::int32_t entries[room];
    std::uint32_t words[room];
    Stack stack(entries, words, 0, 0);
    stack.clear();
    const std::byte* const nodes = tree.nodes.data();
    std::uint32_t word = 0;
    while (true) {
        // An inner node: find the children that are entered.
        if ((word & WideChild::leaf_bit) == 0) {
            const std::byte* const node = nodes + word * WideNodes<float, 3>::stride_of(W);
            const std::uint32_t* const children = children_of<W>(node);
            __builtin_prefetch(children);
            const Boxes<W> boxes = asker.boxes(node);
            const unsigned entered = boxes.bits(), others = entered & (entered - 1);
            if (entered != 0) {
                // One or two children are entered more often than not: branches that are predicted well cost
                // less than the sort.
                const int first = std::countr_zero(entered);
                if (others == 0) {
                    word = children[first];
                    continue;
                }
                // Any hit: the order of the children does not matter.
                if constexpr (wanted == Wanted::any) {
                    word = stack.push_others_unsorted(boxes, children);
                    continue;
                }
                // Two children: continue with the nearer one and push the other.
                if ((others & (others - 1)) == 0) {
                    alignas(64) float at[W];
                    boxes.store(at);
                    const int second = std::countr_zero(others);
                    const bool swap = at[second] < at[first];
                    stack.push(at[swap ? first : second], children[swap ? first : second]);
                    word = children[swap ? second : first];
                    continue;
                }
                // More: sort them, continue with the nearest and push the others.
                word = stack.push_others(boxes, children);
                continue;
            }
        } else {
            // A leaf, or the end of the stack.
            if (word == Stack::end) return asker.found();
            if (asker.test(word & ~WideChild::leaf_bit)) {
                if (wanted == Wanted::any) return true;
                // The limit has shrunk: drop the children beyond it.
                stack.sweep(asker.limit());
            }
        }
        // Continue with the next child on the stack.
        word = stack.pop();
    }
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
