/// What building a wide BVH takes at most, known before any of it is spent.
#pragma once

#include <algorithm>
#include <string>

#include <hedgerow/error.h>
#include <hedgerow/structures/bvh/build_tree.h>
#include <hedgerow/structures/bvh/wide/build.h>

namespace hedgerow {

/// Bytes at the worst moment of a build over n primitives, with options that are `resolved`: what is built
/// and what is put aside on the way. It is a bound for any primitives, derived from the arrays there are: 752
/// bytes a triangle of float at width 16, 464 at width 8. Where leaves hold several triangles a build takes a
/// sixth to a third of it, and by the builder `high` more. What an index keeps beside its structure, like the
/// packed triangles, is not in it.
///
/// A primitive has a reference of 8 numbers, and a binary tree of 2n − 1 nodes and n items.
/// - Binary, medium: references and tree. Fast: the references stay, and there are sorted codes (and room to
///   sort them in), later leaves that are halved. High: two trees, another that can be moved about (a box and
///   16 bytes a node), and either the nodes by their area (16 bytes each, in an array that has just doubled)
///   or a third tree.
/// - Collapsed, to L <= n leaves and less than L inner nodes, since each has two children or more: the binary
///   tree, width − 1 costs a leaf, 2L children and L beginnings in arrays that may be half empty, and the
///   tree itself: items by eights, and nodes.
template <std::floating_point T, int D>
double most_bytes_to_build(std::size_t n, const WideOptions& resolved) {
    constexpr std::size_t reference = sizeof(Reference<T, D>), id = sizeof(PrimitiveId),
                          box = sizeof(LaneBox<T>);
    constexpr std::size_t tree = 2 * sizeof(BuildNode<T, D>) + id, code = 8, halves = 24, place = 16;
    std::size_t binary = reference + tree;
    if (resolved.builder == WideBuilder::fast) binary += 2 * code + halves;
    if (resolved.builder == WideBuilder::high)
        binary = std::max(binary, 2 * tree + 2 * (box + place) + std::max(6 * place + 2, tree + halves));
    const auto width = static_cast<std::size_t>(resolved.width);
    const std::size_t children = 4 * 12, beginnings = 2 * 8, costs = (width - 1) * sizeof(float);
    const std::size_t wide = wide_leaf_size * id + WideNodes<T, D>::stride_of(resolved.width);
    const std::size_t each = std::max(binary, tree + costs + children + beginnings + wide);
    return 65536 + static_cast<double>(n) * static_cast<double>(each);
}

/// Throws InputError where that is beyond the budget, if there is one.
template <std::floating_point T, int D>
void refuse_beyond_budget(std::size_t n, const WideOptions& resolved) {
    const double bytes = most_bytes_to_build<T, D>(n, resolved);
    if (resolved.budget > 0 && bytes > resolved.budget)
        throw InputError("the wide BVH of " + std::to_string(n) + " primitives may take " +
                         std::to_string(bytes * 1e-6) + " MB to build, and its budget is " +
                         std::to_string(resolved.budget * 1e-6) +
                         ": choose a lesser width or another builder, or raise the budget");
}

}  // namespace hedgerow
