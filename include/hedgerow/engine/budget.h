/// A bound on the memory that a wide BVH takes to build, known before the build allocates any.
#pragma once

#include <algorithm>
#include <string>

#include <hedgerow/base/error.h>
#include <hedgerow/engine/build.h>
#include <hedgerow/structures/bvh/build_tree.h>

namespace hedgerow {

/// An upper bound, in bytes, of the memory at the worst moment of a build over n primitives: the tree and
/// everything temporary. `resolved` are options with a width (see `resolved()`). The bound holds for any
/// primitives, since it is derived from the arrays of the build: 752 bytes a triangle of float at width 16,
/// 464 at width 8. Where leaves have several triangles a build takes a sixth to a third of it, and more with
/// the builder `high`. The bound leaves out what an index stores beside its structure, such as the packed
/// triangles.
///
/// A primitive takes a reference of 8 numbers. A binary tree takes 2n − 1 nodes and n items.
/// - Binary tree by `medium` and `high`: the references and the tree; after that, the tree and, for
///   reinsertion, a parent, a place in a list and an area a node (24 bytes), and a move for a part of them.
/// - Binary tree by `fast`: the references, which stay, and the tree; sorted codes and room to sort them in;
///   later, lists of the leaves of subtrees that are halved by count.
/// - Collapse, to L <= n leaves and fewer than L inner nodes, since each has two children or more: the
///   binary tree; width − 1 costs a leaf; 2L children and L beginnings in arrays that may be half empty; and
///   the wide tree, which is items in blocks of eight, and nodes.
template <std::floating_point T, int D>
double most_bytes_to_build(std::size_t n, const WideOptions& resolved) {
    constexpr std::size_t reference = sizeof(Reference<T, D>), id = sizeof(PrimitiveId);
    constexpr std::size_t tree = 2 * sizeof(BuildNode<T, D>) + id, code = 8, halves = 24;
    std::size_t binary = reference + tree;
    if (resolved.builder == WideBuilder::fast)
        binary += 2 * code + halves;
    else
        binary = std::max(binary, tree + 2 * (24 + 24));
    const auto width = static_cast<std::size_t>(resolved.width);
    const std::size_t children = 4 * 12, beginnings = 2 * 8, costs = (width - 1) * sizeof(float);
    const std::size_t wide = wide_leaf_size * id + WideNodes<T, D>::stride_of(resolved.width);
    const std::size_t each = std::max(binary, tree + costs + children + beginnings + wide);
    return 65536 + static_cast<double>(n) * static_cast<double>(each);
}

/// Throws InputError if `most_bytes_to_build` exceeds the budget. A budget of 0 refuses nothing.
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
