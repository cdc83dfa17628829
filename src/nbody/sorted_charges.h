/// Charges in the cells of an octree, in rows, with the multipoles of the cells; and answers in the caller's
/// order.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <span>
#include <vector>

#include <hedgerow/index.h>
#include <hedgerow/nbody/kernels.h>
#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/structures/orthtree/point_orthtree.h>

#include "cells.h"
#include "far_images.h"
#include "rows.h"

namespace hedgerow::detail {

/// Copies the cells of an octree to rows, numbered by level. Sibling leaves that lie side by side along the
/// Morton curve, two or four of them, become one if it is not longer than `leaf_size`: so leaves are about
/// half as long at least, where eighths of a cell would be shorter.
template <class R, class Tree>
void number_cells(const Tree& tree, std::uint32_t leaf_size, FmmCells<R>& cells) {
    constexpr unsigned width = Tree::width;
    const std::size_t groups = (tree.node_count() - 1) / width;
    std::vector<std::uint32_t> parent_of_group(groups), level;
    const auto add = [&](const Leaf& all, std::uint32_t at) {
        if (level.empty() || level.back() != at)
            cells.levels.push_back(static_cast<std::uint32_t>(cells.size()));
        cells.first.push_back(all.first), cells.count.push_back(all.count);
        cells.child.push_back(0), cells.children.push_back(0);
        level.push_back(at);
    };
    const auto add_node = [&](OrthantNode node, std::uint32_t at) {
        if (node.inner()) parent_of_group[node.first] = static_cast<std::uint32_t>(cells.size());
        add(tree.below(node), at);
    };
    add_node(tree.root(), 0);
    for (std::uint32_t g = 0; g < groups; ++g) {
        const std::uint32_t parent = parent_of_group[g], at = level[parent] + 1;
        cells.child[parent] = static_cast<std::uint32_t>(cells.size());
        const OrthantNode* const children = tree.children(OrthantNode::inner_over(g, 0));
        // The leaves from number i on, `count` of them, as one: none if it is too long or they are no leaves.
        const auto joined = [&](unsigned i, unsigned count) {
            Leaf all{};
            for (unsigned k = i; k < i + count; ++k) {
                if (children[k].inner()) return Leaf{};
                const Leaf leaf = tree.below(children[k]);
                if (leaf.count > 0 && all.count == 0) all.first = leaf.first;
                all.count += leaf.count;
            }
            return 2 * all.count <= leaf_size ? all : Leaf{};
        };
        for (unsigned i = 0; i < width;) {
            unsigned taken = i % 4 == 0 ? 4 : i % 2 == 0 ? 2 : 1;
            Leaf all{};
            for (; taken > 1 && all.count == 0; taken /= 2) all = joined(i, taken);
            if (all.count > 0)
                add(all, at), ++cells.children[parent], taken *= 2;
            else if (!children[i].empty())
                add_node(children[i], at), ++cells.children[parent];
            i += taken;
        }
    }
    cells.levels.push_back(static_cast<std::uint32_t>(cells.size()));
}
template <class R>
void make_room(FmmCells<R>& cells, std::size_t charges, std::size_t multipole_stride) {
    const std::size_t rows = cells.size() + row_padding, places = charges + row_padding;
    for (auto* row : {&cells.cx, &cells.cy, &cells.cz}) row->resize(rows);
    for (auto* row : {&cells.radius, &cells.reach, &cells.spread, &cells.weight, &cells.scale, &cells.softest,
                      &cells.tolerance})
        row->resize(rows);
    for (auto* row : {&cells.x, &cells.y, &cells.z}) row->resize(places);
    for (auto* row : {&cells.dx, &cells.dy, &cells.dz, &cells.charge})
        row->resize(places), std::fill(row->end() - row_padding, row->end(), R(0));
    for (auto* row : {&cells.potential, &cells.gx, &cells.gy, &cells.gz}) row->resize(charges);
    cells.multipole_stride = multipole_stride;
    cells.multipoles.resize(cells.size() * multipole_stride);
}

/// What brings coordinates and charges to about 1: powers of two.
struct Units {
    double length, charge;

    template <class T>
    explicit Units(const Extremes<T>& extremes)
        : length(static_cast<double>(to_unit(extremes.coordinate))),
          charge(static_cast<double>(to_unit(extremes.charge))) {}
    double potential() const { return length / charge; }
    double gradient() const { return length * length / charge; }
};

/// Charges in cells, in the order of the leaves, with their multipoles.
template <class R, class T>
struct Sorted {
    PointOrthtree<T, 3> tree;
    FmmCells<R> cells;

    Sorted(const Charges<T>& charges, const RepeatingCube& cube, const Units& units, std::uint32_t leaf_size,
           const FmmKernel<R>& kernel, Executor& executor)
        : Sorted(
              charges.places, units, softened(charges), leaf_size, kernel, executor,
              [&](PrimitiveId i) { return static_cast<double>(charges.charges[i]) * units.charge; },
              [&](PrimitiveId i) { return reach_of(charges, i); }) {
        cells.softening = charges.softening.kernel;
        if (cube.side > 0) {
            cells.side = cube.side * units.length, cells.middle = cube.middle * units.length;
            cells.images = near_image_places(cells.side);
        }
    }
    /// Targets of charges, as if they were charges of 1.
    Sorted(const Targets<T>& targets, const Charges<T>& charges, const Units& units, std::uint32_t leaf_size,
           const FmmKernel<R>& kernel, Executor& executor)
        : Sorted(
              targets.places, units, softened(charges), leaf_size, kernel, executor,
              [](PrimitiveId) { return 1.0; },
              [&](PrimitiveId i) { return reach_of(targets, charges.softening, i); }) {}

    /// Whether R has the distances of the deepest cells, which those of a cluster are beside a body far out.
    bool precise_enough() const {
        constexpr int most_depth_in_float = 40;
        return std::same_as<R, double> || tree.depth() <= most_depth_in_float;
    }

private:
    template <class Charge, class Reach>
    Sorted(const Strided<Vec<T, 3>>& places, const Units& units, bool are_softened, std::uint32_t leaf_size,
           const FmmKernel<R>& kernel, Executor& executor, Charge charge_of, Reach reach)
        : tree(PointOrthtree<T, 3>::build(PointCloudView<T, 3>(places), {.leaf_size = leaf_size}, executor)) {
        number_cells(tree, leaf_size, cells);
        if (cells.size() > FmmSource::most_cells)
            throw InputError(std::to_string(places.size()) + " charges are more than fit in " +
                             std::to_string(FmmSource::most_cells) + " cells");
        make_room(cells, places.size(), kernel.multipole_stride);
        if (are_softened) cells.soft.resize(places.size() + row_padding, R(0));
        executor.for_each_piece(places.size(), worth_a_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const PrimitiveId id = tree.items()[i];
                const Vec3d p = Vec3d(places[id]) * units.length;
                cells.x[i] = p[0], cells.y[i] = p[1], cells.z[i] = p[2];
                cells.charge[i] = static_cast<R>(charge_of(id));
                if (are_softened)
                    cells.soft[i] = static_cast<R>(static_cast<double>(reach(id)) * units.length);
            }
        });
        // Upward: multipoles, the deepest cells first.
        for (std::size_t level = cells.levels.size() - 1; level-- > 0;) {
            const std::uint32_t first = cells.levels[level];
            executor.for_each_piece(cells.levels[level + 1] - first, 64,
                                    [&](std::size_t begin, std::size_t end) {
                                        kernel.upward(cells, first + static_cast<std::uint32_t>(begin),
                                                      first + static_cast<std::uint32_t>(end));
                                    });
        }
    }
};

/// Writes tidal tensors in the caller's order and units.
template <class R, class T>
void hand_out(Sorted<R, T>& sorted, const Units& units, std::span<Tides> found, Executor& executor) {
    const TideRows rows = sorted.cells.tide_rows();
    const double unit = units.gradient() * units.length;
    executor.for_each_piece(found.size(), worth_a_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) found[sorted.tree.items()[i]] = rows[i] * unit;
    });
}
/// Writes what was found in the caller's order and units.
template <class R, class T>
void hand_out(const Sorted<R, T>& sorted, const Units& units, std::span<PotentialAt<T>> found,
              Executor& executor) {
    const FmmCells<R>& cells = sorted.cells;
    const double of_potential = units.potential(), of_gradient = units.gradient();
    const auto in_units = [](double x, double unit) { return static_cast<T>(x * unit); };
    executor.for_each_piece(found.size(), worth_a_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            found[sorted.tree.items()[i]] = {
                in_units(cells.potential[i], of_potential),
                {in_units(cells.gx[i], of_gradient), in_units(cells.gy[i], of_gradient),
                 in_units(cells.gz[i], of_gradient)}};
    });
}

}  // namespace hedgerow::detail
