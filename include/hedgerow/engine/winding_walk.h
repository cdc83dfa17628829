/// The walk that sums the expansions of a wide BVH's clusters: those with large bounds are opened until all
/// bounds together are within the error.
#pragma once

#include <bit>

#include <hedgerow/base/bare_vector.h>
#include <hedgerow/base/scratch.h>
#include <hedgerow/engine/wide_tree.h>
#include <hedgerow/structures/bvh/build_tree.h>

namespace hedgerow {

/// Memory of a walk: for each node that was opened the terms of its children, a row as wide as the node, and
/// the node's number. A term that was taken back, since its cluster was opened, is 0.
struct WindingTerms {
    double *values, *errors;
    std::uint32_t* nodes;
};

/// A point, and the point in the units of the clusters; the power of two that brings offsets of primitives
/// from it to about 1; how far its winding number may be off.
struct WindingQuery {
    Vec<double, 3> point, scaled;
    double to_unit, error;
    WindingTerms terms;
};

/// Memory for the terms of all nodes of a tree. Pages that no walk uses take none.
class WindingMemory {
public:
    WindingTerms terms(std::size_t nodes, int width) {
        const std::size_t lines = (nodes * static_cast<std::size_t>(width) + 7) / 8;
        if (kept_.size() < 2 * lines) kept_.clear(), kept_.resize(2 * lines);
        if (opened_.size() < nodes) opened_.clear(), opened_.resize(nodes);
        return {kept_.data()->numbers, kept_[lines].numbers, opened_.data()};
    }

private:
    struct alignas(64) Line {
        double numbers[8];
    };
    SparseVector<Line> kept_;
    SparseVector<std::uint32_t> opened_;
};

/// How a walk lowers its threshold, and when it ends.
struct WindingThresholds {
    /// The first threshold as a share of the error, and each next one as a share of the one before.
    static constexpr double first = 0x1p-3, next = 0x1p-2;
    /// Clusters with smaller bounds stay: all of a tree of 2³² primitives together have less than the error.
    static constexpr double last = 0x1p-44;
    /// The share of the error that bounds may sum up to in double.
    static constexpr double sum = 1 - 0x1p-20;
};

/// Opens all clusters with bounds above a threshold, which sinks until the sum of the other bounds is within
/// the error: the largest bounds first, but in any order between two thresholds. Which clusters are opened
/// depends on the tree, the point and the error alone. Returns the number of rows of terms.
///
/// The machine computes and keeps the terms. `expand(node, row, threshold, sum)` writes the terms of the
/// node's children, `open(row, threshold, sum)` looks at a row again; each takes back the terms with bounds
/// above the threshold, returns them as bits, and adds to `sum` the change of the row's bounds.
/// `add_leaf(block, count)` adds exact terms and returns a bound of their roundings.
template <std::floating_point T, class Machine, class Count>
std::size_t sum_windings(const WideTree<T, 3>& tree, Machine& machine, double error,
                         const WindingTerms& terms, Count& count) {
    using Share = WindingThresholds;
    double threshold = error * Share::first, left = error * Share::sum, sum = 0;
    NodeRef stack[most_wide * bvh_max_depth];
    std::size_t depth = 0, rows = 0;
    const auto push = [&](std::uint32_t node, unsigned children) {
        for (; children != 0; children &= children - 1) {
            const int i = std::countr_zero(children);
            const WideChild child = tree.nodes.child(node, i);
            stack[depth++] = child.leaf() ? NodeRef{wide_leaf_size * child.block(), tree.nodes.count(node, i)}
                                          : NodeRef{child.word, 0};
        }
    };
    const auto open_all = [&] {
        while (depth > 0) {
            const NodeRef r = stack[--depth];
            if (r.leaf()) {
                count.leaf(r.count, r.place());
                left -= machine.add_leaf(r.first / wide_leaf_size, r.count);
            } else {
                count.node(r.place());
                terms.nodes[rows] = r.first;
                push(r.first, machine.expand(r.first, rows++, threshold, sum));
            }
        }
    };
    stack[depth++] = {0, 0};
    open_all();
    while (!(sum <= left) && threshold > error * Share::last) {
        threshold *= Share::next;
        const std::size_t end = rows;
        for (std::size_t row = 0; row < end && !(sum <= left); ++row) {
            push(terms.nodes[row], machine.open(row, threshold, sum));
            open_all();
        }
    }
    return rows;
}

}  // namespace hedgerow
