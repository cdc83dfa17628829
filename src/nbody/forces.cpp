/// Forces within a stated error: the plan, the cells, and the steps of the fast multipole method over them.
#include <hedgerow/nbody/forces.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <optional>
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

/// How an accuracy is reached: the order of multipoles, whether expansions and pairs are in float, at most
/// what the rms error of the gradients is to the bound that each conversion keeps, how long leaves are, so
/// that pairs and conversions take about as long, and below how many charges a direct sum is faster. Errors
/// were measured on a cube, a lattice, Plummer's and Hernquist's spheres, a disc, two unlike clusters, and
/// charges that cancel.
struct Plan {
    double least_accuracy;
    int order;
    bool in_float;
    double error_per_bound;
    std::uint32_t leaf_size;
    std::size_t least_charges;
};
constexpr Plan plans[] = {
    {3e-3, 3, true, 0.6, 48, 1000},   {2e-4, 4, true, 0.75, 48, 1500},  {1e-5, 6, true, 0.6, 64, 2500},
    {1e-6, 8, false, 0.85, 64, 6000}, {1e-8, 11, false, 0.4, 64, 8000}, {1e-9, 11, false, 0.7, 64, 12000},
};
/// Targets that are fewer are summed directly, since the charges' cells take longer.
constexpr std::size_t least_targets = 256;
constexpr double most_accuracy = 0.1;

const Plan& plan_for(double accuracy) {
    if (accuracy <= most_accuracy)
        for (const Plan& plan : plans)
            if (accuracy >= plan.least_accuracy) return plan;
    char given[32];
    std::snprintf(given, sizeof given, "%g", accuracy);
    throw UsageError(std::string("an accuracy of ") + given + " is not from 1e-9 to 0.1");
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

/// About the least gradient in a leaf: that of all other cells as single charges (Barnes and Hut), each
/// farther away by the leaf's radius, or a hundredth of the sum of their sizes.
template <class R>
double strength_in(const FmmCells<R>& sources, const FmmCells<R>& targets, std::uint32_t leaf) {
    thread_local std::vector<std::uint32_t> stack;
    constexpr double opening_angle = 0.7;
    const double own = static_cast<double>(targets.radius[leaf]);
    double x = 0, y = 0, z = 0, size = 0;
    stack.assign(1, 0);
    while (!stack.empty()) {
        const std::uint32_t other = stack.back();
        stack.pop_back();
        const double dx = sources.cx[other] - targets.cx[leaf], dy = sources.cy[other] - targets.cy[leaf],
                     dz = sources.cz[other] - targets.cz[leaf];
        const double distance = std::sqrt(dx * dx + dy * dy + dz * dz);
        if (!sources.is_leaf(other) &&
            !(static_cast<double>(sources.reach[other]) < opening_angle * distance)) {
            for (std::uint32_t i = 0; i < sources.children[other]; ++i)
                stack.push_back(sources.child[other] + i);
            continue;
        }
        if (!(distance > 0)) continue;
        const double per_d2 = 1 / ((distance + own) * (distance + own)), along = per_d2 / distance;
        const double charge = static_cast<double>(sources.multipoles[other * sources.multipole_stride]);
        x += charge * along * dx, y += charge * along * dy, z += charge * along * dz;
        size += static_cast<double>(sources.weight[other]) * per_d2;
    }
    return std::max(std::sqrt(x * x + y * y + z * z), 0.01 * size);
}
/// What counts of the errors in a cell: the mean of some power of them as shares of the gradients, so that a
/// few targets that are far out or where gradients are small count as they should.
constexpr double error_power = 4;

/// The tolerance and the spread of a leaf whose gradients are known, of sizes in the units of the cells.
template <class R, class F>
void set_leaf_by(const FmmCells<R>& sources, FmmCells<R>& targets, std::uint32_t leaf, int order, F size_of) {
    // No charge is farther away than the far side of all of them.
    const double dx = sources.cx[0] - targets.cx[leaf], dy = sources.cy[0] - targets.cy[leaf],
                 dz = sources.cz[0] - targets.cz[leaf];
    const double farthest = std::sqrt(dx * dx + dy * dy + dz * dz) + static_cast<double>(sources.radius[0]) +
                            static_cast<double>(targets.radius[leaf]);
    const double least = 0.01 * static_cast<double>(sources.weight[0]) / (farthest * farthest);
    const std::size_t first = targets.first[leaf], end = first + targets.count[leaf];
    const double per_radius = targets.radius[leaf] > 0 ? 1 / static_cast<double>(targets.radius[leaf]) : 0;
    double inverse = 0, spread = 0;
    for (std::size_t i = first; i < end; ++i) {
        const double size = std::max(size_of(i), least), inverse2 = 1 / (size * size),
                     x = static_cast<double>(targets.dx[i]) * per_radius,
                     y = static_cast<double>(targets.dy[i]) * per_radius,
                     z = static_cast<double>(targets.dz[i]) * per_radius, r2 = x * x + y * y + z * z;
        double power = 1;
        for (int k = 0; k < order; ++k) power *= r2;
        inverse += inverse2 * inverse2, spread += inverse2 * inverse2 * power * power;
    }
    targets.spread[leaf] =
        targets.radius[leaf] * static_cast<R>(std::pow(spread / inverse, 1 / (error_power * order)));
    targets.tolerance[leaf] =
        static_cast<R>(std::pow(static_cast<double>(targets.count[leaf]) / inverse, 1 / error_power));
}
/// The same by an estimate that is less than all gradients in the leaf.
template <class R>
void set_leaf(const FmmCells<R>& sources, FmmCells<R>& targets, std::uint32_t leaf, int order) {
    targets.tolerance[leaf] = static_cast<R>(strength_in(sources, targets, leaf));
    const R radius = targets.radius[leaf], per_radius = radius > 0 ? 1 / radius : 0;
    const std::size_t first = targets.first[leaf], end = first + targets.count[leaf];
    R spread = 0;
    for (std::size_t i = first; i < end; ++i) {
        const R x = targets.dx[i] * per_radius, y = targets.dy[i] * per_radius,
                z = targets.dz[i] * per_radius;
        const R r2 = x * x + y * y + z * z;
        R power = 1;
        for (int k = 0; k < order; ++k) power *= r2;
        spread += power * power;
    }
    targets.spread[leaf] = radius * std::pow(spread / static_cast<R>(targets.count[leaf]),
                                             static_cast<R>(1 / (error_power * order)));
}
/// Sets tolerances and spreads of all cells above the leaves, as if the targets of a cell were all on its far
/// side, and takes the share of the tolerances that a conversion may err by.
template <class R>
void set_cells(FmmCells<R>& targets, double share, int order) {
    for (std::size_t c = targets.size(); c-- > 0;) {
        if (targets.is_leaf(c)) continue;
        double count = 0, spread = 0, least = static_cast<double>(targets.tolerance[targets.child[c]]);
        const std::uint32_t first = targets.child[c], end = first + targets.children[c];
        for (std::uint32_t k = first; k < end; ++k)
            least = std::min(least, static_cast<double>(targets.tolerance[k]));
        for (std::uint32_t k = first; k < end; ++k) {
            const double dx = targets.cx[k] - targets.cx[c], dy = targets.cy[k] - targets.cy[c],
                         dz = targets.cz[k] - targets.cz[c];
            const double far =
                std::sqrt(dx * dx + dy * dy + dz * dz) + static_cast<double>(targets.spread[k]);
            const double inverse = least / static_cast<double>(targets.tolerance[k]);
            const double weight = targets.count[k] * inverse * inverse * inverse * inverse;
            count += weight;
            spread += weight * std::pow(far / static_cast<double>(targets.radius[c]), error_power * order);
        }
        targets.tolerance[c] = static_cast<R>(least * std::pow(targets.count[c] / count, 1 / error_power));
        targets.spread[c] =
            std::min(targets.radius[c],
                     targets.radius[c] * static_cast<R>(std::pow(spread / count, 1 / (error_power * order))));
    }
    for (R& tolerance : targets.tolerance) tolerance *= static_cast<R>(share);
}
template <class R, class F>
void set_tolerances(FmmCells<R>& targets, double share, int order, Executor& executor, F set) {
    executor.for_each_piece(targets.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c)
            if (targets.is_leaf(c)) set(static_cast<std::uint32_t>(c));
    });
    set_cells(targets, share, order);
}

/// Charges in cells, in the order of the leaves, with their multipoles.
template <class R, class T>
struct Sorted {
    PointOrthtree<T, 3> tree;
    FmmCells<R> cells;

    /// charge_of and reach_of tell of a charge by its number; the second is asked if charges are softened.
    template <class Charge, class Reach>
    Sorted(const Strided<Vec<T, 3>>& places, double scale, bool softened, const Plan& plan,
           const FmmKernel<R>& kernel, Executor& executor, Charge charge_of, Reach reach_of)
        : tree(PointOrthtree<T, 3>::build(PointCloudView<T, 3>(places), {.leaf_size = plan.leaf_size},
                                          executor)) {
        number_cells(tree, cells);
        make_room(cells, places.size(), kernel.multipole_stride);
        if (softened) cells.soft.resize(places.size() + row_padding, R(0));
        executor.for_each_piece(places.size(), worth_a_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const PrimitiveId id = tree.items()[i];
                const Vec3d p = Vec3d(places[id]) * scale;
                cells.x[i] = p[0], cells.y[i] = p[1], cells.z[i] = p[2];
                cells.charge[i] = static_cast<R>(charge_of(id));
                if (softened) cells.soft[i] = static_cast<R>(static_cast<double>(reach_of(id)) * scale);
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

/// At targets, or at the charges themselves.
template <class R, class T>
void multipole_forces(const Charges<T>& charges, const Targets<T>* targets, std::span<PotentialAt<T>> found,
                      const Plan& plan, const ForceOptions& options, const FmmKernel<R>& kernel,
                      const detail::Extremes<T>& extremes, Executor& executor) {
    const double scale = static_cast<double>(detail::to_unit(extremes.coordinate)),
                 of_charge = static_cast<double>(detail::to_unit(extremes.charge));
    const bool softened = detail::softened(charges);
    Sorted<R, T> sources(
        charges.places, scale, softened, plan, kernel, executor,
        [&](PrimitiveId i) { return static_cast<double>(charges.charges[i]) * of_charge; },
        [&](PrimitiveId i) { return detail::reach_of(charges, i); });
    sources.cells.softening = charges.softening.kernel;
    std::optional<Sorted<R, T>> others;
    if (targets != nullptr) {
        others.emplace(
            targets->places, scale, softened, plan, kernel, executor, [](PrimitiveId) { return 1.0; },
            [&](PrimitiveId i) { return detail::reach_of(*targets, charges.softening, i); });
        // Nothing acts on the sources.
        std::fill(sources.cells.tolerance.begin(), sources.cells.tolerance.end(),
                  std::numeric_limits<R>::infinity());
    }
    const auto& tree = targets != nullptr ? others->tree : sources.tree;
    FmmCells<R>& cells = targets != nullptr ? others->cells : sources.cells;
    const double of_potential = scale / of_charge, of_gradient = of_potential * scale;
    const int order = kernel.order + 1;  // of the errors
    set_tolerances(cells, options.accuracy / plan.error_per_bound, order, executor, [&](std::uint32_t leaf) {
        if (options.sizes.empty()) return set_leaf(sources.cells, cells, leaf, order);
        set_leaf_by(sources.cells, cells, leaf, order,
                    [&](std::size_t i) { return options.sizes[tree.items()[i]] / of_gradient; });
    });
    // Down: each target's walk.
    const std::size_t n = found.size();
    executor.expect(n);
    std::vector<FmmTask<R>> tasks;
    kernel.walk_above(sources.cells, cells, static_cast<std::uint32_t>(n / 128 + 1), tasks);
    executor.for_each_piece(tasks.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            kernel.walk_below(sources.cells, cells, tasks[i]), executor.advance(cells.count[tasks[i].cell]);
    });
    // In the caller's order and units.
    const auto in_units = [](double x, double unit) { return static_cast<T>(x * unit); };
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
void plain_forces(const Charges<T>& charges, std::span<PotentialAt<T>> found, Executor& executor) {
    const Index<PointOrthtree<T, 3>, PointCloudView<T, 3>> index(PointCloudView<T, 3>(charges.places),
                                                                 {.leaf_size = 32}, executor);
    std::vector<double> all(charges.charges.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<double>(charges.charges[i]);
    const auto sums = PlainFmm<6>(0.5)(index, all);
    for (std::size_t i = 0; i < sums.size(); ++i)
        found[i] = {static_cast<T>(sums[i].potential), Vec<T, 3>(sums[i].gradient)};
}

template <class T>
void forces_at(const Charges<T>& charges, const Targets<T>* targets, std::span<PotentialAt<T>> found,
               const ForceOptions& options, Threads threads) {
    const Plan& plan = plan_for(options.accuracy);
    detail::expect_room(found.size(), targets != nullptr ? targets->places.size() : charges.places.size());
    detail::Extremes<T> extremes(charges);  // throws for bad numbers
    if (targets != nullptr) extremes.expand(*targets);
    if (!options.sizes.empty() && options.sizes.size() != found.size())
        throw InputError(std::to_string(options.sizes.size()) + " sizes of gradients for " +
                         std::to_string(found.size()) + " targets: give one each, or none");
    if (found.empty()) return;
    Executor& executor = threads.over(found.size());
    const NbodyKernels* const kernels = nbody_kernels();
    const bool plain = kernels == nullptr && targets == nullptr && !detail::softened(charges) &&
                       found.size() >= 2000 && options.accuracy >= 1e-4;
    // A direct sum in float errs by 2⁻²¹ a pair.
    const bool direct_is_exact = std::same_as<T, double> || plan.in_float || kernels == nullptr;
    const bool few = charges.places.empty() ||
                     (direct_is_exact && (charges.places.size() < plan.least_charges ||
                                          (targets != nullptr && targets->places.size() < least_targets)));
    if (few || (kernels == nullptr && !plain))
        return direct_sum(charges,
                          targets != nullptr ? *targets : Targets<T>(charges.places, charges.lengths), found,
                          threads);
    in_ieee_mode([&] {
        IeeeExecutor ieee(executor);
        const auto by = [&](const auto& kernel) {
            multipole_forces(charges, targets, found, plan, options, kernel, extremes, ieee);
        };
        if (plain)
            plain_forces(charges, found, ieee);
        else if (plan.in_float)
            by(of_order(*kernels->fmm_float, plan.order));
        else
            by(of_order(*kernels->fmm_double, plan.order));
    });
}

}  // namespace

template <std::floating_point T>
void forces(const Charges<T>& charges, std::span<PotentialAt<T>> found, const ForceOptions& options,
            Threads threads) {
    forces_at<T>(charges, nullptr, found, options, threads);
}
template <std::floating_point T>
void forces(const Charges<T>& charges, const Targets<T>& targets, std::span<PotentialAt<T>> found,
            const ForceOptions& options, Threads threads) {
    forces_at<T>(charges, &targets, found, options, threads);
}

template void forces(const Charges<float>&, std::span<PotentialAt<float>>, const ForceOptions&, Threads);
template void forces(const Charges<double>&, std::span<PotentialAt<double>>, const ForceOptions&, Threads);
template void forces(const Charges<float>&, const Targets<float>&, std::span<PotentialAt<float>>,
                     const ForceOptions&, Threads);
template void forces(const Charges<double>&, const Targets<double>&, std::span<PotentialAt<double>>,
                     const ForceOptions&, Threads);

}  // namespace hedgerow
