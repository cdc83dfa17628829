/// Forces within a stated error: the plan, the cells, and the steps of the fast multipole method over them.
#include <hedgerow/nbody/forces.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <hedgerow/index.h>
#include <hedgerow/nbody/kernels.h>
#include <hedgerow/nbody/plain_fmm.h>
#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/structures/orthtree/point_orthtree.h>

#include "cells.h"
#include "rows.h"

namespace hedgerow {
namespace {

/// How an accuracy is reached: the order of multipoles, whether expansions and pairs are in float, and at
/// most what the rms error of the gradients is to the bound that each conversion keeps. That was measured: it
/// is largest for Plummer spheres, whose outskirts are large and sparse cells, and several times less for a
/// cube. Leaves are as long as makes pairs and conversions take about as long.
struct Plan {
    double least_accuracy;
    int order;
    bool in_float;
    double error_per_bound;
    std::uint32_t leaf_size;
};
constexpr Plan plans[] = {{3e-3, 3, true, 2.2, 48},
                          {2e-4, 4, true, 2.0, 48},
                          {1e-5, 6, true, 7, 64},
                          {1e-6, 8, false, 5, 64},
                          {1e-7, 11, false, 4, 64}};
constexpr double most_accuracy = 0.1;

const Plan& plan_for(double accuracy) {
    if (accuracy <= most_accuracy)
        for (const Plan& plan : plans)
            if (accuracy >= plan.least_accuracy) return plan;
    char given[32];
    std::snprintf(given, sizeof given, "%g", accuracy);
    throw UsageError(std::string("an accuracy of ") + given + " is not from 1e-7 to 0.1");
}

/// Copies the cells of an octree to rows, numbered by level.
template <class R, class Tree>
void number_cells(const Tree& tree, FmmCells<R>& cells) {
    constexpr unsigned width = Tree::width;
    const std::size_t groups = (tree.node_count() - 1) / width;
    std::vector<std::uint32_t> parent_of_group(groups), level;
    const auto add = [&](OrthantNode node, std::uint32_t at) {
        const Leaf all = tree.below(node);
        if (node.inner()) parent_of_group[node.first] = static_cast<std::uint32_t>(cells.size());
        if (level.empty() || level.back() != at)
            cells.levels.push_back(static_cast<std::uint32_t>(cells.size()));
        cells.first.push_back(all.first), cells.count.push_back(all.count);
        cells.child.push_back(0), cells.children.push_back(0);
        level.push_back(at);
    };
    add(tree.root(), 0);
    for (std::uint32_t g = 0; g < groups; ++g) {
        const std::uint32_t parent = parent_of_group[g];
        cells.child[parent] = static_cast<std::uint32_t>(cells.size());
        const OrthantNode* const children = tree.children(OrthantNode::inner_over(g, 0));
        for (unsigned i = 0; i < width; ++i)
            if (!children[i].empty()) add(children[i], level[parent] + 1), ++cells.children[parent];
    }
    cells.levels.push_back(static_cast<std::uint32_t>(cells.size()));
}
template <class R>
void make_room(FmmCells<R>& cells, std::size_t charges, std::size_t multipole_stride) {
    const std::size_t rows = cells.size() + row_padding, places = charges + row_padding;
    for (auto* row : {&cells.cx, &cells.cy, &cells.cz}) row->resize(rows);
    for (auto* row : {&cells.radius, &cells.reach, &cells.weight, &cells.scale, &cells.tolerance})
        row->resize(rows);
    for (auto* row : {&cells.x, &cells.y, &cells.z}) row->resize(places);
    for (auto* row :
         {&cells.dx, &cells.dy, &cells.dz, &cells.charge, &cells.potential, &cells.gx, &cells.gy, &cells.gz})
        row->resize(places), std::fill(row->end() - row_padding, row->end(), R(0));
    cells.multipole_stride = multipole_stride;
    cells.multipoles.resize(cells.size() * multipole_stride);
}

/// About the least gradient in a leaf: that of all other cells as single charges (Barnes and Hut), each
/// farther away by the leaf's radius, or a hundredth of the sum of their sizes.
template <class R>
double strength_in(const FmmCells<R>& cells, std::uint32_t leaf, std::vector<std::uint32_t>& stack) {
    constexpr double opening_angle = 0.7;
    const double own = static_cast<double>(cells.radius[leaf]);
    double x = 0, y = 0, z = 0, size = 0;
    stack.assign(1, 0);
    while (!stack.empty()) {
        const std::uint32_t other = stack.back();
        stack.pop_back();
        const double dx = cells.cx[other] - cells.cx[leaf], dy = cells.cy[other] - cells.cy[leaf],
                     dz = cells.cz[other] - cells.cz[leaf];
        const double distance = std::sqrt(dx * dx + dy * dy + dz * dz);
        if (!cells.is_leaf(other) && !(static_cast<double>(cells.radius[other]) < opening_angle * distance)) {
            for (std::uint32_t i = 0; i < cells.children[other]; ++i) stack.push_back(cells.child[other] + i);
            continue;
        }
        if (!(distance > 0)) continue;
        const double per_d2 = 1 / ((distance + own) * (distance + own)), along = per_d2 / distance;
        const double charge = static_cast<double>(cells.multipoles[other * cells.multipole_stride]);
        x += charge * along * dx, y += charge * along * dy, z += charge * along * dz;
        size += static_cast<double>(cells.weight[other]) * per_d2;
    }
    return std::max(std::sqrt(x * x + y * y + z * z), 0.01 * size);
}
/// Sets how large an error a conversion may make in each cell: a share of the gradient in a leaf, and the
/// least of its children's in any other cell.
template <class R>
void set_tolerances(FmmCells<R>& cells, double share, Executor& executor) {
    executor.for_each_piece(cells.size(), 64, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t> stack;
        for (std::size_t c = begin; c < end; ++c)
            if (cells.is_leaf(c))
                cells.tolerance[c] =
                    static_cast<R>(share * strength_in(cells, static_cast<std::uint32_t>(c), stack));
    });
    for (std::size_t c = cells.size(); c-- > 0;)
        if (!cells.is_leaf(c))
            cells.tolerance[c] =
                *std::min_element(cells.tolerance.begin() + cells.child[c],
                                  cells.tolerance.begin() + cells.child[c] + cells.children[c]);
}

template <class R, class T>
void multipole_forces(const Charges<T>& charges, std::span<PotentialAt<T>> found, const Plan& plan,
                      double accuracy, const FmmKernel<R>& kernel, const detail::Extremes<T>& extremes,
                      Executor& executor) {
    const std::size_t n = charges.places.size();
    const double scale = static_cast<double>(detail::to_unit(extremes.coordinate)),
                 of_charge = static_cast<double>(detail::to_unit(extremes.charge));
    // Sort the charges into cells.
    const PointCloudView<T, 3> cloud(charges.places);
    const auto tree = PointOrthtree<T, 3>::build(cloud, {.leaf_size = plan.leaf_size}, executor);
    FmmCells<R> cells;
    number_cells(tree, cells);
    make_room(cells, n, kernel.multipole_stride);
    executor.for_each_piece(n, worth_a_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const PrimitiveId id = tree.items()[i];
            const Vec3d p = Vec3d(charges.places[id]) * scale;
            cells.x[i] = p[0], cells.y[i] = p[1], cells.z[i] = p[2];
            cells.charge[i] = static_cast<R>(static_cast<double>(charges.charges[id]) * of_charge);
        }
    });
    // Upward: multipoles, the deepest cells first.
    for (std::size_t level = cells.levels.size() - 1; level-- > 0;) {
        const std::uint32_t first = cells.levels[level];
        executor.for_each_piece(cells.levels[level + 1] - first, 64, [&](std::size_t begin, std::size_t end) {
            kernel.upward(cells, first + static_cast<std::uint32_t>(begin),
                          first + static_cast<std::uint32_t>(end));
        });
    }
    set_tolerances(cells, accuracy / plan.error_per_bound, executor);
    // Down: each target's walk.
    std::vector<FmmTask<R>> tasks;
    kernel.walk_above(cells, static_cast<std::uint32_t>(n / 128 + 1), tasks);
    executor.for_each_piece(tasks.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) kernel.walk_below(cells, tasks[i]), executor.look();
    });
    // In the caller's order and units.
    const double of_potential = scale / of_charge, of_gradient = of_potential * scale;
    const auto in_units = [](R x, double unit) { return static_cast<T>(static_cast<double>(x) * unit); };
    executor.for_each_piece(n, worth_a_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            found[tree.items()[i]] = {in_units(cells.potential[i], of_potential),
                                      {in_units(cells.gx[i], of_gradient), in_units(cells.gy[i], of_gradient),
                                       in_units(cells.gz[i], of_gradient)}};
    });
}
template <class Kernels>
const auto& of_order(const Kernels& kernels, int order) {
    return *std::find_if(kernels.begin(), kernels.end(), [&](const auto& k) { return k.order >= order; });
}

/// Without kernels: as the method is described.
template <class T>
void plain_forces(const Charges<T>& charges, std::span<PotentialAt<T>> found, double accuracy,
                  Executor& executor) {
    if (charges.places.size() < 2000 || accuracy < 1e-4)
        return direct_sum(charges, charges.places, found, executor);
    const Index<PointOrthtree<T, 3>, PointCloudView<T, 3>> index(PointCloudView<T, 3>(charges.places),
                                                                 {.leaf_size = 32}, executor);
    std::vector<double> all(charges.charges.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<double>(charges.charges[i]);
    const auto sums = PlainFmm<6>(0.5)(index, all);
    for (std::size_t i = 0; i < sums.size(); ++i)
        found[i] = {static_cast<T>(sums[i].potential), Vec<T, 3>(sums[i].gradient)};
}

}  // namespace

template <std::floating_point T>
void forces(const Charges<T>& charges, std::span<PotentialAt<T>> found, const ForceOptions& options,
            Threads threads) {
    const Plan& plan = plan_for(options.accuracy);
    detail::expect_room(found.size(), charges.places.size());
    const detail::Extremes<T> extremes(charges);  // throws for bad numbers
    if (found.empty()) return;
    Executor& executor = threads.over(found.size());
    in_ieee_mode([&] {
        IeeeExecutor ieee(executor);
        const NbodyKernels* const kernels = nbody_kernels();
        if (kernels == nullptr)
            plain_forces(charges, found, options.accuracy, ieee);
        else if (plan.in_float)
            multipole_forces(charges, found, plan, options.accuracy,
                             of_order(*kernels->fmm_float, plan.order), extremes, ieee);
        else
            multipole_forces(charges, found, plan, options.accuracy,
                             of_order(*kernels->fmm_double, plan.order), extremes, ieee);
    });
}

template void forces(const Charges<float>&, std::span<PotentialAt<float>>, const ForceOptions&, Threads);
template void forces(const Charges<double>&, std::span<PotentialAt<double>>, const ForceOptions&, Threads);

}  // namespace hedgerow
