/// The walk of the kernels, for rays and points: opens the nearest entered child first and keeps the others
/// on a stack, sorted by distance. For any hit the order is free.
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

// Goes down from a node to the next leaf, or to the end of the stack, whose word is returned. `next()` pops a
// child.
template <int W, class T, Wanted wanted, class Slabs, class Next>
HWY_INLINE std::uint32_t down(const std::byte* nodes, const Slabs& slabs, WalkStack<W, wanted>& stack,
                              std::uint32_t word, Next next) {
    while ((word & WideChild::leaf_bit) == 0) {
        const std::byte* const node = nodes + word * WideNodes<T, 3>::stride_of(W);
        const std::uint32_t* const children = children_of<W, T>(node);
        __builtin_prefetch(children);
        const Boxes<W> boxes(node, slabs);
        const unsigned entered = boxes.bits(), others = entered & (entered - 1);
        if (entered == 0) {
            word = next();
            continue;
        }
        // One or two children are entered more often than not: branches that are predicted well cost less
        // than the sort.
        const int first = std::countr_zero(entered);
        if (others == 0) {
            word = children[first];
            continue;
        }
        if constexpr (wanted != Wanted::any) {
            if ((others & (others - 1)) == 0) {
                alignas(64) float at[W];
                boxes.store(at);
                const int second = std::countr_zero(others);
                std::uint64_t nearer = waiting(at[first], children[first]),
                              farther = waiting(at[second], children[second]);
                order(nearer, farther);
                stack.push(farther);
                word = static_cast<std::uint32_t>(nearer);
                continue;
            }
        }
        word = stack.push_others(boxes, children);
    }
    return word;
}

// Tests the leaves that can have an asker's answer, and returns whether it found one. An asker has
// - slabs(): what the test of a node's boxes needs, until a leaf is tested;
// - test(leaf): whether the leaf's primitives changed its answer;
// - limit(): the distance beyond which nothing changes its answer;
// - found(): whether it has an answer.
template <int W, Wanted wanted, class T, class Asker>
HWY_INLINE bool walk(const WideTree<T, 3>& tree, Asker asker) {
    // The stack, with room for the deepest tree.
    using Stack = WalkStack<W, wanted>;
    typename Stack::Place places[Stack::room(bvh_max_depth + 1)];
    Stack stack(places, Stack::below, 0);
    stack.clear();
    const auto next = [&]() __attribute__((always_inline)) {
        if constexpr (wanted == Wanted::near)
            return stack.pop_within(asker.limit());
        else
            return stack.pop();
    };
    std::uint32_t word = 0;
    while (true) {
        word = down<W, T>(tree.nodes.data(), asker.slabs(), stack, word, next);
        // A leaf, or the end of the stack.
        if (word == Stack::end) return asker.found();
        if (asker.test(word & ~WideChild::leaf_bit)) {
            if constexpr (wanted == Wanted::any)
                return true;
            else if constexpr (wanted == Wanted::closest)
                stack.sweep(asker.limit());
        }
        word = next();
    }
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
